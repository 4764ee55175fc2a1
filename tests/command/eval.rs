//! `eval`: rows stream, files are whole, and what is ambiguous is refused.

use super::support::{brdfbake, code, command, err, folder, names, out, text, write};
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;

const HEADER: &str = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi";

fn run(dir: &std::path::Path, csv: &str) -> std::process::Output {
    brdfbake(&["eval", text(&write(dir, "in.csv", csv))])
}

#[test]
fn a_row_is_answered_before_the_next_one_is_asked() {
    let mut child = command(&["eval"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut ask = child.stdin.take().unwrap();
    let mut answers = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut answer = || answers.next().unwrap().unwrap();
    writeln!(ask, "{HEADER}").unwrap();
    assert_eq!(answer(), format!("{HEADER},brdfbake"));
    for mu in [0.25, 0.5] {
        writeln!(ask, "lambert,,{mu},0,0.5,3").unwrap();
        // 1 / pi
        assert_eq!(answer(), format!("lambert,,{mu},0,0.5,3,3.183098861837907e-1"));
    }
    drop(ask);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn a_bad_row_comes_after_those_before_it() {
    let dir = folder();
    let csv = format!(
        "{HEADER}\nlambert,,0.5,0,0.5,3\nlambert,,0.25,0,0.5,3\nnothing,,0,0,0,0\nlambert,,0,0,0,0\n"
    );
    let o = run(dir.path(), &csv);
    assert_eq!(code(&o), 3);
    assert_eq!(out(&o).lines().count(), 3, "{}", out(&o));
    assert!(err(&o).contains(":4:"), "{}", err(&o));
    // into a file: all or nothing
    let target = dir.path().join("sub/out.csv");
    std::fs::create_dir(dir.path().join("sub")).unwrap();
    std::fs::write(&target, "old").unwrap();
    let input = dir.path().join("in.csv");
    let o = brdfbake(&["eval", text(&input), "-o", text(&target)]);
    assert_eq!(code(&o), 3);
    assert!(o.stdout.is_empty());
    assert_eq!(std::fs::read_to_string(&target).unwrap(), "old");
    assert_eq!(names(&dir.path().join("sub")), ["out.csv"]);
    let good = write(dir.path(), "in.csv", &csv.replace("nothing,,0,0,0,0\n", ""));
    let o = brdfbake(&["eval", text(&good), "-o", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(o.stdout.is_empty());
    assert_eq!(std::fs::read_to_string(&target).unwrap(), out(&brdfbake(&["eval", text(&good)])));
}

#[test]
fn a_file_that_cannot_be_written_is_found_before_the_work() {
    let dir = folder();
    let file = write(dir.path(), "file", "x");
    // nothing is read
    let o = brdfbake(&["eval", text(&dir.path().join("in.csv")), "-o", text(&file.join("out.csv"))]);
    assert_eq!(code(&o), 5, "{}", err(&o));
}

#[test]
fn angles_are_radians() {
    let dir = folder();
    let row = |model: &str, angles: &str| format!("{HEADER}\n{model},,{angles}\n");
    for (model, angles, message) in [
        ("ggx", "45,0,0.5,3", "wi_theta = 45 outside [0, 3.1416]: angles are in radians"),
        ("ggx", "-0.1,0,0.5,3", "wi_theta = -0.1 outside"),
        ("ggx", "0.5,180,0.5,3", "wi_phi = 180 outside [-6.2832, 6.2832]"),
        ("ggx", "0.5,0,1e300,3", "wo_theta = 1e300 outside"),
        ("ggx", "0.5,0,0.5,-7", "wo_phi = -7 outside"),
        ("fresnel-dielectric", "90,,,", "wi_theta = 90 outside"),
        ("phase-henyey-greenstein", "180,,,", "wi_theta = 180 outside"),
        ("fresnel-schlick", "2,,,", "wi_theta is outside [0, pi/2]"),
        ("fresnel-conductor", "3,,,", "wi_theta is outside [0, pi/2]"),
        // not read by the function, but given all the same
        ("fresnel-schlick", "1,,,400", "wo_phi = 400 outside"),
        ("ggx", "inf,0,0.5,3", "not a finite number"),
    ] {
        let o = run(dir.path(), &row(model, angles));
        assert_eq!(code(&o), 3, "{model} {angles}: {}", out(&o));
        assert!(err(&o).contains(message) && err(&o).contains(":2:"), "{model} {angles}: {}", err(&o));
    }
    for (model, angles) in [
        ("ggx", "0,0,1.5707963267948966,-3.14159"),
        ("ggx", "3.1416,6.2832,0.5,-6.2832"),
        ("phase-henyey-greenstein", "3.141592653589793,,,"),
        ("fresnel-schlick", "1.5707963267948966,,,"),
        // from below
        ("fresnel-dielectric", "2,,,"),
    ] {
        let o = run(dir.path(), &row(model, angles));
        assert_eq!(code(&o), 0, "{model} {angles}: {}", err(&o));
    }
}

#[test]
fn what_is_there_twice_is_refused() {
    let dir = folder();
    let twice = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi, wi_theta\nggx,,0.5,0,0.5,3,1\n";
    let o = run(dir.path(), twice);
    assert_eq!(code(&o), 3);
    assert!(err(&o).contains("column `wi_theta` is there twice (column 3 and column 7)"), "{}", err(&o));
    assert!(o.stdout.is_empty());
    for (params, message) in [
        (r#"{""alpha"": 0.1, ""alpha"": 0.2}"#, "key `alpha` is there twice"),
        (r#"{""f0"": 0.1, ""F0"": 0.2}"#, "`f0` and `F0` are the same parameter"),
        (r#"[1]"#, "an object of parameters"),
    ] {
        let o = run(dir.path(), &format!("{HEADER}\nggx,\"{params}\",0.5,0,0.5,3\n"));
        assert_eq!(code(&o), 3, "{params}");
        assert!(err(&o).contains(message) && err(&o).contains(":2:"), "{params}: {}", err(&o));
    }
    // columns without a name are nobody's
    let o = run(dir.path(), &format!("{HEADER},,\nggx,,0.5,0,0.5,3,a,b\n"));
    assert_eq!(code(&o), 0, "{}", err(&o));
}

#[test]
fn a_result_that_is_there_already_is_replaced() {
    let dir = folder();
    let csv =
        "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi,brdfbake,note\nlambert,,0.5,0,0.5,3,7,kept\n";
    let o = run(dir.path(), csv);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert_eq!(
        out(&o),
        "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi,brdfbake,note\n\
         lambert,,0.5,0,0.5,3,3.183098861837907e-1,kept\n"
    );
    assert!(err(&o).contains("column `brdfbake` is there already"), "{}", err(&o));
    // its own output gives itself again
    let again = run(dir.path(), &out(&o));
    assert_eq!(out(&again), out(&o));
    // another column is no result
    let o = brdfbake(&["eval", text(&write(dir.path(), "in.csv", csv)), "--column", "f"]);
    assert!(out(&o).starts_with(&format!("{HEADER},brdfbake,note,f\n")), "{}", out(&o));
    assert_eq!(code(&brdfbake(&["eval", "--column", "wi_theta"])), 2);
    assert_eq!(code(&brdfbake(&["eval", "--column", " "])), 2);
}
