//! Numbers in messages are readable, faults say where, and one fault has one exit code in every verb.

use super::support::{brdfbake, code, err, folder, out, text, write};

/// Arguments, exit code, part of the message.
const CASES: &[(&[&str], i32, &str)] = &[
    (&["albedo", "ggx", "-p", "alpha=nan"], 3, "alpha = \"nan\" is not a number"),
    (&["albedo", "ggx", "-p", "alpha=inf"], 3, "alpha = \"inf\" is not a number"),
    (&["plot", "ggx", "-p", "alpha=NaN"], 3, "alpha = \"NaN\" is not a number"),
    (&["fit", "ggx", "-p", "f0=nan"], 3, "f0 = \"nan\""),
    (&["albedo", "ggx", "-p", "alpha=-1e-300"], 3, "alpha = -1e-300 outside [0, 2]"),
    (&["albedo", "ggx", "-p", "alpha=1e300"], 3, "alpha = 1e300 outside [0, 2]"),
    (&["albedo", "phong", "-p", "n=1e30"], 3, "1e30 outside"),
    (&["albedo", "ggx", "--mu", "1e300"], 3, "mu = 1e300 outside [0, 1]"),
    (&["albedo", "ggx", "--mu=-1e-300"], 3, "mu = -1e-300 outside [0, 1]"),
    (&["albedo", "ggx", "-t=-1e-300"], 2, "--tolerance -1e-300"),
    (&["fit", "ggx", "-e=-1e-300"], 2, "--error -1e-300"),
    (&["plot", "ggx", "--angles", "1e300"], 2, "--angles 1e300 outside"),
    (&["diff", "a", "b", "--tolerance=-1e300"], 2, "--tolerance -1e300"),
    (&["bake", "--engine", "three", "--suggest", "1e-300"], 2, "--suggest 1e-300 outside 1e-7 to 0.5"),
    (&["albedo", "ggx", "-p", "alpha=0.1", "-p", "alpha=0.2"], 3, "`alpha` is given twice"),
    (&["albedo", "ggx", "-p", "f0=0.1", "-p", "F0=0.2"], 3, "`f0` and `F0` are the same parameter"),
    (&["fit", "ggx", "-p", "f90=0.1", "-p", "f90=0.2"], 3, "`f90` is given twice"),
    (&["albedo", "ggx", "-p", "alpha_x=0", "-p", "alpha_y=1e-300"], 3, "alpha_y = 1e-300"),
];

/// The longest run of digits.
fn digits(text: &str) -> usize {
    text.split(|c: char| !c.is_ascii_digit()).map(str::len).max().unwrap_or(0)
}

#[test]
fn numbers_are_as_they_were_given() {
    for (args, expected, message) in CASES {
        let o = brdfbake(args);
        assert_eq!(code(&o), *expected, "{args:?}: {}", err(&o));
        assert!(err(&o).contains(message), "{args:?}: {}", err(&o));
        assert!(digits(&err(&o)) < 20 && !err(&o).contains("null"), "{args:?}: {}", err(&o));
    }
}

#[test]
fn recipes_show_numbers_in_the_same_way() {
    let dir = folder();
    for (axis, message) in [
        ("domain = [1e-300, 1e300]", "1e300"),
        ("domain = [0.5, 1e-300]", "1e-300"),
        ("clamp = [1e-300, 1e300]", "1e300"),
        ("offset = 1e300", "1e300"),
        ("warp = { power = 1e-300 }", "1e-300"),
    ] {
        let recipe = format!(
            "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 'x'\n[[table.axis]]\nid = 'mu'\nlength = 2\n{axis}\n\
             [[table.axis]]\nid = 'alpha'\nlength = 2\n"
        );
        let o = brdfbake(&["bake", text(&write(dir.path(), "x.toml", &recipe)), "-o", text(dir.path())]);
        assert_eq!(code(&o), 3, "{axis}: {}", err(&o));
        assert!(err(&o).contains(message), "{axis}: {}", err(&o));
        assert!(digits(&err(&o)) < 20, "{axis}: {}", err(&o));
    }
}

#[test]
fn small_cosines_are_told_and_so_are_small_albedos() {
    let o = brdfbake(&["albedo", "lambert", "--mu", "3.3e-31,0.25", "-p", "rho=1e-30"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let lines: Vec<Vec<String>> =
        out(&o).lines().skip(1).map(|l| l.split('\t').map(str::to_owned).collect()).collect();
    assert_eq!(lines[0][0], "3.3e-31");
    assert_eq!(lines[1][0], "0.25");
    for line in &lines {
        let e: f64 = line[1].parse().unwrap();
        assert!((e / 1e-30 - 1.0).abs() < 1e-9, "{line:?}");
    }
}

/// A place of a table in words: of a texel far below the sixth decimal.
#[test]
fn places_are_told_however_small() {
    use brdfbake::grid::table::place;
    let at = [("mu".to_owned(), 3.3e-31), ("roughness".to_owned(), 0.25)];
    assert_eq!(place(&at), "mu = 3.3e-31, roughness = 0.25");
}

/// A texel without a value: by its place, by the id of its channel, and with one code in every verb.
#[test]
fn a_texel_without_a_value_is_the_same_fault_everywhere() {
    use brdfbake::cli::Exit;
    use brdfbake::models::{ParamError, Params};
    use brdfbake::tables::TexelError;
    use brdfbake::tables::driver::BakeError;
    let infinite = TexelError::NotFinite { channel: 1, value: f64::INFINITY };
    assert_eq!(infinite.of(["dfg.scale", "dfg.bias"].into_iter()), "dfg.bias is inf");
    let param = brdfbake::models::MODELS[0];
    let param: ParamError =
        Params::resolve(param.id, param.params, [("nonsense", &true.into())]).unwrap_err();
    for (error, exit) in [
        (infinite, Exit::Input),
        (TexelError::NoWidth, Exit::Unsupported),
        (TexelError::NoRule { what: "this" }, Exit::Unsupported),
        (TexelError::Param(param), Exit::Input),
    ] {
        let channels = vec!["dfg.scale".to_owned(), "dfg.bias".to_owned()];
        let texel = BakeError::Texel {
            texel: 7,
            place: "mu = 0".to_owned(),
            channels: channels.clone(),
            error: error.clone(),
        };
        let told = texel.to_string();
        assert!(told.contains("texel 7 (mu = 0)") && !told.contains("channel 1"), "{told}");
        let bake = brdfbake::pipeline::PipelineError::Bake { table: "t".to_owned(), error: texel };
        let fit = brdfbake::report::analytic::FitError::Texel {
            at: "mu = 0".to_owned(),
            channels,
            error: error.clone(),
        };
        let codes = [
            Exit::of_texel(&error),
            brdfbake::cli::Failure::from(bake).exit,
            brdfbake::cli::Failure::from(fit).exit,
        ];
        assert_eq!(codes, [exit; 3], "{error}");
    }
}

#[test]
fn a_mirror_has_no_lobe_in_any_verb() {
    let dir = folder();
    let rows = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,\"{\"\"alpha\"\": 0}\",0.5,0,0.5,3\n";
    let rows = write(dir.path(), "rows.csv", rows);
    let ltc = "name = 'x'\n[[table]]\nkind = 'ltc-matrix'\nname = 'x'\nreconstruction = 'off'\n\
               [[table.axis]]\nid = 'alpha'\nlength = 2\ntexel = 'endpoint'\n[[table.axis]]\nid = 'mu'\nlength = 2\n";
    let ltc = write(dir.path(), "ltc.toml", ltc);
    for args in [
        &["plot", "ggx", "-p", "alpha=0"][..],
        &["eval", text(&rows)],
        &["bake", text(&ltc), "-q", "-o", text(dir.path())],
    ] {
        let o = brdfbake(args);
        assert_eq!(code(&o), 6, "{args:?}: {}", err(&o));
        assert!(err(&o).contains("mirror"), "{args:?}: {}", err(&o));
    }
}
