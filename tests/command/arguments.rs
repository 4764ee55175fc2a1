//! Every argument acts or is refused: nothing that is typed is ignored. The arguments are those that clap knows.

use super::support::{SMALL, brdfbake, code, err, folder, text, write};
use brdfbake::cli::Cli;
use clap::error::ErrorKind;
use clap::{Arg, Command, CommandFactory, Parser};

/// Values, of which every argument takes one.
const VALUES: &[&str] =
    &["1", "0.5", "x", "8", "a=b", "R,G,B", "1,2,3", "bash", "models", "json", "on", "roughness", "whole"];

fn verbs() -> Vec<Command> {
    let mut all = Cli::command();
    all.build();
    all.get_subcommands().filter(|c| c.get_name() != "help").cloned().collect()
}

/// The arguments of a verb, without those of every verb.
fn arguments(verb: &Command) -> Vec<&Arg> {
    verb.get_arguments().filter(|a| !["help", "version", "color"].contains(&a.get_id().as_str())).collect()
}

fn parse(verb: &Command, words: &[String]) -> Result<(), ErrorKind> {
    let line = ["brdfbake".to_owned(), verb.get_name().to_owned()].into_iter().chain(words.iter().cloned());
    Cli::try_parse_from(line).map(|_| ()).map_err(|e| e.kind())
}

/// An argument with a value that it takes.
fn typed(verb: &Command, arg: &Arg) -> Vec<String> {
    let option = arg.get_long().map(|l| format!("--{l}"));
    if !arg.get_action().takes_values() {
        return option.into_iter().collect();
    }
    let possible = arg.get_possible_values();
    let own = possible.iter().map(|v| v.get_name().to_owned());
    if option.is_none() {
        // one of several in a row cannot be tried alone
        return vec![own.into_iter().next().unwrap_or_else(|| VALUES[0].to_owned())];
    }
    let form = |value: String| match &option {
        Some(option) => vec![format!("{option}={value}")],
        None => vec![value],
    };
    let wrong = [ErrorKind::InvalidValue, ErrorKind::ValueValidation];
    own.chain(VALUES.iter().map(|v| (*v).to_owned()))
        .map(form)
        .find(|words| parse(verb, words).err().is_none_or(|kind| !wrong.contains(&kind)))
        .unwrap_or_else(|| panic!("{} {}: add a value to the list", verb.get_name(), arg.get_id()))
}

/// What a verb cannot be without.
fn required(verb: &Command) -> Vec<String> {
    arguments(verb).into_iter().filter(|a| a.is_required_set()).flat_map(|a| typed(verb, a)).collect()
}

/// The same words, and those of arguments that are not among them.
fn with(base: &[String], more: &[&[String]]) -> Vec<String> {
    let more = more.iter().flat_map(|words| words.iter()).filter(|w| !base.contains(w));
    base.iter().chain(more).cloned().collect()
}

/// `requires` says nothing where what is required conflicts with something that is there: so each such conflict is tried.
#[test]
fn an_argument_that_needs_another_is_refused_with_anything_in_its_place() {
    let mut needy = 0;
    for verb in verbs() {
        let base = required(&verb);
        for arg in arguments(&verb) {
            let own = typed(&verb, arg);
            if parse(&verb, &with(&base, &[&own])) != Err(ErrorKind::MissingRequiredArgument) {
                continue;
            }
            needy += 1;
            let serves = |other: &&&Arg| parse(&verb, &with(&base, &[&own, &typed(&verb, other)])).is_ok();
            let all = arguments(&verb);
            let served: Vec<&str> = all.iter().filter(serves).map(|a| a.get_id().as_str()).collect();
            // one that is needed together with others has none
            assert!(served.len() <= 1, "{} {}: acts with any of {served:?}?", verb.get_name(), arg.get_id());
        }
    }
    assert!(needy > 15, "{needy} arguments need another one");
}

/// Where a verb can print JSON or nothing, it is not asked for both.
#[test]
fn silence_and_json_exclude_each_other() {
    let mut both = 0;
    for verb in verbs() {
        let find = |id: &str| arguments(&verb).into_iter().find(|a| a.get_id() == id);
        let json = find("json").or(find("message_format"));
        let (Some(quiet), Some(json)) = (find("quiet"), json) else { continue };
        both += 1;
        let words = with(&required(&verb), &[&typed(&verb, quiet), &typed(&verb, json)]);
        assert_eq!(parse(&verb, &words), Err(ErrorKind::ArgumentConflict), "{words:?}");
    }
    assert!(both >= 6, "{both}");
}

/// Verb, a mode that does something else than the verb usually does (with what it needs), and the arguments that act in it.
const MODES: &[(&str, &[&str], &[&str])] = &[
    // what says how scenes are read is refused later, when it is known that there are none
    (
        "bake",
        &["--engine=osl", "--suggest=1e-3"],
        &["scene", "domain", "jobs", "message_format", "root", "pixels", "texels", "margin", "keep"],
    ),
    (
        "bake",
        &["--check"],
        &[
            "recipe",
            "engine",
            "scene",
            "out",
            "jobs",
            "quiet",
            "message_format",
            "strict",
            "root",
            "pixels",
            "texels",
            "margin",
            "maps",
            "keep",
        ],
    ),
    (
        "bake",
        &["--dry-run"],
        &[
            "recipe",
            "engine",
            "scene",
            "out",
            "report",
            "jobs",
            "memory",
            "yes_large",
            "quiet",
            "message_format",
            "strict",
            "root",
            "pixels",
            "texels",
            "margin",
            "maps",
            "keep",
        ],
    ),
    ("verify", &["--engine=osl"], &["table", "json", "quiet"]),
    ("verify", &["--hashes"], &["strict", "json", "quiet"]),
    ("preview", &["--scene=x"], &["mesh", "engine", "furnace", "panel", "size", "out", "terminal", "json"]),
    (
        "preview",
        &["--scene=x", "--mesh"],
        &["turn", "engine", "furnace", "panel", "size", "out", "terminal", "json"],
    ),
    ("fit", &["--recipe=x"], &["table", "form", "degree", "error", "lang"]),
    ("man", &["--out=x"], &[]),
    (
        "map",
        &["--sbrdf=lafortune", "--brdf=x"],
        &[
            "lobes",
            "residual",
            "normalise",
            "format",
            "name",
            "check",
            "out",
            "jobs",
            "lock_timeout",
            "memory",
            "yes_large",
            "quiet",
            "json",
        ],
    ),
];

#[test]
fn what_does_not_act_in_a_mode_is_refused() {
    let verbs = verbs();
    for (name, mode, acting) in MODES {
        let verb = verbs.iter().find(|v| v.get_name() == *name).unwrap();
        let mode: Vec<String> = mode.iter().map(|w| (*w).to_owned()).collect();
        let base = with(&required(verb), &[&mode]);
        assert_eq!(parse(verb, &base), Ok(()), "{name} {mode:?}");
        for arg in arguments(verb) {
            let own = typed(verb, arg);
            let option = own[0].split('=').next().unwrap().to_owned();
            if arg.is_required_set() || mode.iter().any(|m| m.split('=').next() == Some(&option)) {
                continue;
            }
            let parsed = parse(verb, &with(&base, &[&own]));
            let acts = acting.contains(&arg.get_id().as_str());
            assert_eq!(parsed.is_ok(), acts, "{name} {mode:?} {own:?}: {parsed:?}");
        }
    }
}

/// What shows only in values, and in what is in files.
#[test]
fn arguments_without_effect_are_refused_by_their_values() {
    let dir = folder();
    let recipe = write(dir.path(), "small.toml", SMALL);
    let to = dir.path().join("out");
    assert_eq!(code(&brdfbake(&["bake", text(&recipe), "-q", "-o", text(&to)])), 0);
    let file = to.join("small.exr");
    let normal = "--normal=tests/footprints/normal.png";
    for (args, named) in [
        (&["bake", text(&recipe), "--suggest", "1e-3"][..], "--suggest"),
        (&["bake", text(&recipe), "--margin", "0.1"], "--margin"),
        (&["bake", text(&recipe), "--texels", "referenced"], "--texels"),
        (&["bake", text(&recipe), "-o", text(&to), "--check", "--jobs", "1"], "--jobs"),
        (&["plot", "ggx", "-p", "alpha=0.1", "-p", "alpha=0.2"], "alpha"),
        (&["albedo", "lambert", "--phi", "1"], "--phi"),
        (&["verify", text(&file), "--hashes"], "--hashes"),
        (&["verify", text(&file), "--strict"], "--strict"),
        (&["converge", "dfg", "--json", "--timings"], "--timings"),
        (&["converge", "dfg", "--json", "--bytes"], "--bytes"),
        (&["golden", "bless", text(&to), "--json"], "--json"),
        (&["golden", "bless", text(&to), "--draw", "x"], "--draw"),
        (&["check", "tests/scenes/four_materials.gltf", "--rule", "albedo=1", "--rule", "albedo=2"], "twice"),
        (&["map", normal, "--channel", "R"], "--channel"),
        (&["map", normal, "--srgb"], "--srgb"),
        (&["map", normal, "--single"], "--single"),
        (&["map", normal, "--resample"], "--resample"),
        (&["map", normal, "--from", "phong", "--range", "1,100"], "--from"),
        (&["map", normal, "--wrap", "clamp"], "--resample"),
        (&["inspect", text(&file), "--raw", "2x2x1:half"], "--raw"),
    ] {
        let o = brdfbake(args);
        assert!([2, 3].contains(&code(&o)), "{args:?}: {} {}", code(&o), err(&o));
        assert!(err(&o).contains(named), "{args:?}: {}", err(&o));
    }
    assert!(!to.join("recipe.toml").exists());
}
