//! Errors as objects: with `--message-format json` and `--json` a program reads what is wrong, and where, from stdout.

use super::support::{SMALL, brdfbake, code, command, err, folder, out, text, write};
use serde_json::Value;

/// The objects of kind `error`.
fn errors(args: &[&str], exit: i32) -> Vec<Value> {
    let o = brdfbake(args);
    assert_eq!(code(&o), exit, "{args:?}: {}", err(&o));
    let lines: Vec<Value> = out(&o).lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let errors: Vec<Value> = lines.into_iter().filter(|l| l["reason"] == "error").collect();
    assert!(!errors.is_empty(), "{args:?}: {}", out(&o));
    for error in &errors {
        assert_eq!(error["exit"], exit, "{args:?}");
        assert!(!error["message"].as_str().unwrap().is_empty(), "{args:?}");
    }
    errors
}

#[test]
fn errors_are_objects_with_file_line_and_key() {
    let dir = folder();
    let wrong = SMALL.replace("length = 8", "length = 1").replace("exr:half", "exr:haf");
    let recipe = write(dir.path(), "wrong.toml", &wrong);
    let found = errors(&["bake", text(&recipe), "--message-format", "json"], 3);
    let places: Vec<(&str, u64, &str)> = found
        .iter()
        .map(|e| (e["file"].as_str().unwrap(), e["line"].as_u64().unwrap(), e["key"].as_str().unwrap()))
        .collect();
    let file = text(&recipe);
    assert_eq!(places, [(file, 6, "table[0].outputs[0]"), (file, 9, "table[0].axis[0].length")]);
    // no such file, no such preset, wrong usage, before the arguments are parsed
    let missing = dir.path().join("missing.toml");
    assert_eq!(errors(&["bake", text(&missing), "--message-format=json"], 5)[0]["file"], text(&missing));
    assert!(
        errors(&["bake", "ggxx", "--message-format", "json"], 3)[0]["message"]
            .as_str()
            .unwrap()
            .contains("ggx")
    );
    assert!(
        errors(&["bake", "--message-format", "json", "--wrong"], 2)[0]["message"]
            .as_str()
            .unwrap()
            .contains("--wrong")
    );
    assert_eq!(errors(&["plan", text(&missing), "--json"], 5)[0]["file"], "missing.toml");
    assert_eq!(errors(&["inspect", text(&missing), "--json"], 5)[0]["exit"], 5);
    // a law that is broken: its finding, and the error
    let broken = "name = 'b'\n[[table]]\nkind = 'albedo'\nname = 'b'\nmodel = 'cook-torrance-1982'\ntolerance = 1e-2\n\
                  [[table.axis]]\nid = 'mu'\nlength = 8\n[[table.axis]]\nid = 'roughness'\nlength = 4\n";
    let broken = write(dir.path(), "broken.toml", broken);
    errors(&["bake", text(&broken), "--message-format", "json", "-o", text(&dir.path().join("b"))], 4);
    // rows of a CSV
    let rows = write(
        dir.path(),
        "rows.csv",
        "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,,0.5,0,0.5,3\nggx,,9,0,0.5,3\n",
    );
    assert_eq!(code(&brdfbake(&["eval", text(&rows)])), 3);
}

#[test]
fn a_summary_names_the_folder_and_colour_is_asked_for() {
    let dir = folder();
    let recipe = write(dir.path(), "small.toml", SMALL);
    let to = dir.path().join("out");
    let bake = ["bake", text(&recipe), "-o", text(&to)];
    let o = brdfbake(&bake);
    assert!(err(&o).lines().last().unwrap().starts_with(text(&to)), "{}", err(&o));
    let o = brdfbake(&[&bake[..], &["--message-format", "json"]].concat());
    let last: Value = serde_json::from_str(out(&o).lines().last().unwrap()).unwrap();
    assert_eq!((last["reason"].as_str(), last["folder"].as_str()), (Some("summary"), Some(text(&to))));
    // stderr is no terminal here: plain, unless it is asked for; NO_COLOR does not outweigh what is asked for
    let wrong = write(dir.path(), "wrong.toml", "nmae = 'x'");
    let colours = |more: &[&str]| {
        let o = command(&[&["bake", text(&wrong)], more].concat()).env_remove("NO_COLOR").output().unwrap();
        assert_eq!(code(&o), 3);
        err(&o).contains("\x1b[")
    };
    assert!(!colours(&[]) && !colours(&["--color", "never"]) && colours(&["--color", "always"]));
    assert!(err(&brdfbake(&["bake", "--color=always", "--wrong"])).contains("\x1b["));
}

/// A stale folder is told to a program, too.
#[test]
fn a_check_is_never_silent_to_a_program() {
    let dir = folder();
    let recipe = write(dir.path(), "small.toml", SMALL);
    let to = dir.path().join("out");
    let bake = ["bake", text(&recipe), "-o", text(&to), "--message-format", "json"];
    let check = || {
        let o = brdfbake(&[&bake[..], &["--check"]].concat());
        (code(&o), serde_json::from_str::<Value>(&out(&o)).unwrap())
    };
    let (stale, told) = check();
    assert!(stale == 7 && told["reason"] == "stale" && !told["why"].as_array().unwrap().is_empty(), "{told}");
    assert_eq!(code(&brdfbake(&bake)), 0);
    let (fresh, told) = check();
    assert!(fresh == 0 && told["reason"] == "fresh", "{told}");
    // what would be baked
    let o = brdfbake(&[&bake[..], &["--dry-run"]].concat());
    let told: Value = serde_json::from_str(&out(&o)).unwrap();
    assert_eq!(told["planned"][0]["files"][0], "small.exr");
    let plain = brdfbake(&["bake", text(&recipe), "--dry-run"]);
    assert!(out(&plain).contains("small.exr") && out(&plain).contains("mu [0, 1] x 8"), "{}", out(&plain));
}

/// What a bar shows: the phases of a table in their order, each moved through to its end.
#[test]
fn a_table_tells_of_every_phase_to_its_end() {
    use brdfbake::cancel::Cancel;
    use brdfbake::pipeline::{Event, Phase, Progress, Settings, run};
    use std::sync::Mutex;

    #[derive(Default)]
    struct Seen(Mutex<Vec<(Phase, usize, usize)>>);
    impl Progress for Seen {
        fn event(&self, event: &Event<'_>) {
            if let Event::TableProgress { phase, done, steps, .. } = event {
                self.0.lock().unwrap().push((*phase, *done, *steps));
            }
        }
    }
    let fitted = SMALL.replace("outputs", "texels = \"least-squares\"\noutputs");
    let plan = brdfbake::recipe::parse(&fitted, "small.toml").unwrap();
    let (dir, seen) = (folder(), Seen::default());
    run(&plan, &Settings::new(dir.path()), &Cancel::new(), &seen).unwrap();
    let seen = seen.0.into_inner().unwrap();
    let mut phases: Vec<Phase> = seen.iter().map(|s| s.0).collect();
    phases.dedup();
    assert_eq!(phases, [Phase::Bake, Phase::Laws, Phase::Fit, Phase::Between]);
    for phase in phases {
        let of_phase = || seen.iter().filter(|s| s.0 == phase);
        let (done, steps) = (of_phase().map(|s| s.1).max().unwrap(), of_phase().next().unwrap().2);
        assert!(steps > 0 && done == steps, "{phase:?}: {done} of {steps}");
    }
}
