//! Bakes as steps of a build: Make and Ninja.

use super::support::{SMALL, brdfbake, code, err, folder, out, text, write};
use std::process::Command;

#[test]
fn a_stale_folder_is_told_and_nothing_is_baked() {
    let dir = folder();
    let recipe = write(dir.path(), "r.toml", SMALL);
    let to = dir.path().join("out");
    let check = || brdfbake(&["bake", text(&recipe), "-o", text(&to), "--check"]);
    let o = check();
    assert_eq!(code(&o), 7, "{}", err(&o));
    assert!(out(&o).contains("manifest.json") && !to.exists(), "{}", out(&o));
    assert_eq!(code(&brdfbake(&["bake", text(&recipe), "-o", text(&to)])), 0);
    assert_eq!((code(&check()), out(&check())), (0, String::new()));
    // another request, other bytes, a file that is gone
    write(dir.path(), "r.toml", &SMALL.replace("exr:half", "exr:float"));
    assert!(code(&check()) == 7 && out(&check()).contains("another plan"));
    write(dir.path(), "r.toml", SMALL);
    let file = to.join("small.exr");
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, [&bytes[..], b"x"].concat()).unwrap();
    assert!(code(&check()) == 7 && out(&check()).contains("small.exr has other bytes"));
    std::fs::remove_file(&file).unwrap();
    assert!(code(&check()) == 7 && out(&check()).contains("small.exr"));
    for args in [
        ["--check", "--dry-run"],
        ["--check", "--stamp=x"],
        ["--dry-run", "--stamp=x"],
        ["--dry-run", "--depfile=x"],
    ] {
        assert_eq!(code(&brdfbake(&["bake", args[0], args[1]])), 2, "{args:?}");
    }
}

/// GNU Make bakes once, then nothing, and again when the recipe changes: although the outputs keep their time.
#[test]
fn make_bakes_once() {
    if Command::new("make").arg("--version").output().is_err() {
        eprintln!("SKIPPED: make is not installed");
        return;
    }
    let dir = folder();
    let recipe = write(dir.path(), "a #b.toml", SMALL);
    let program = env!("CARGO_BIN_EXE_brdfbake");
    write(
        dir.path(),
        "Makefile",
        &format!(
            "done.stamp: Makefile\n\t@echo baking\n\t@{program} bake 'a #b.toml' -o out --stamp $@ --depfile out.d --quiet\n-include out.d\n"
        ),
    );
    let make = || {
        let o = Command::new("make").current_dir(dir.path()).output().unwrap();
        assert!(o.status.success(), "{}", err(&o));
        out(&o).contains("baking")
    };
    assert!(make() && !make());
    assert_eq!(std::fs::read_to_string(dir.path().join("out.d")).unwrap(), "done.stamp: a\\ \\#b.toml\n");
    let stamp = dir.path().join("done.stamp");
    let later = std::fs::metadata(&stamp).unwrap().modified().unwrap() + std::time::Duration::from_secs(2);
    std::fs::File::options().write(true).open(&recipe).unwrap().set_modified(later).unwrap();
    assert!(make());
    assert_eq!(std::fs::read_to_string(&stamp).unwrap().trim().len(), 64);
}

/// CMake with Ninja, which takes the rule that was written and bakes again when the recipe changes.
#[test]
fn cmake_and_ninja_bake_once() {
    let has = |program: &str| Command::new(program).arg("--version").output().is_ok();
    if !has("cmake") || !has("ninja") {
        eprintln!("SKIPPED: cmake and ninja are not installed");
        return;
    }
    let dir = folder();
    let recipe = write(dir.path(), "luts.toml", SMALL);
    let program = env!("CARGO_BIN_EXE_brdfbake");
    write(
        dir.path(),
        "CMakeLists.txt",
        &format!(
            "cmake_minimum_required(VERSION 3.21)\nproject(luts NONE)\nadd_custom_command(OUTPUT luts.stamp COMMAND {program} bake \
             ${{CMAKE_SOURCE_DIR}}/luts.toml -o luts --quiet --stamp luts.stamp --depfile luts.d DEPENDS luts.toml DEPFILE luts.d)\n\
             add_custom_target(luts ALL DEPENDS luts.stamp)\n"
        ),
    );
    let run = |program: &str, args: &[&str]| {
        let o = Command::new(program).args(args).current_dir(dir.path()).output().unwrap();
        assert!(o.status.success(), "{}{}", out(&o), err(&o));
        out(&o)
    };
    run("cmake", &["-G", "Ninja", "-B", "b"]);
    run("ninja", &["-C", "b"]);
    assert!(dir.path().join("b/luts/small.exr").exists());
    assert!(run("ninja", &["-C", "b"]).contains("no work to do"));
    let later = std::time::SystemTime::now() + std::time::Duration::from_secs(2);
    std::fs::File::options().write(true).open(&recipe).unwrap().set_modified(later).unwrap();
    assert!(!run("ninja", &["-C", "b"]).contains("no work to do"));
}
