//! The five rules of URIs.

use brdfbake::scene::{Checked, Resolved, UriError, check_uri, resolve, resolve_uri};
use proptest::prelude::*;

fn message(uri: &str) -> String {
    check_uri(uri, 16).unwrap_err().to_string()
}

#[test]
fn paths_in_the_folder_are_allowed() {
    let inside = |uri: &str| match check_uri(uri, 0).unwrap() {
        Checked::Inside(names) => names.join("|"),
        other => panic!("{uri} is {other:?}"),
    };
    assert_eq!(inside("a.bin"), "a.bin");
    assert_eq!(inside("./tex//wood.png"), "tex|wood.png");
    assert_eq!(inside("my%20wood%C3%A9.png"), "my woodé.png");
    // Exporters forget to escape these; none of them leaves the folder.
    assert_eq!(inside("100%.png"), "100%.png");
    assert_eq!(inside("what?.png#1"), "what?.png#1");
    assert_eq!(inside("..a/b..c/...d"), "..a|b..c|...d");
    assert_eq!(inside("console.png"), "console.png");
}

#[test]
fn paths_out_of_the_folder_are_told_apart() {
    let above = |uri: &str| match check_uri(uri, 0).unwrap() {
        Checked::Above(names) => names.join("|"),
        other => panic!("{uri} is {other:?}"),
    };
    assert_eq!(above(".."), "..");
    assert_eq!(above("../shared/mr.png"), "..|shared|mr.png");
    assert_eq!(above("a/../../b"), "..|b");
    assert_eq!(above("%2e%2E/b"), "..|b");
    assert_eq!(above("..%2f..%2Fsecret"), "..|..|secret");
    let inside = |uri: &str| check_uri(uri, 0).unwrap();
    assert_eq!(inside("a/../b"), Checked::Inside(vec!["b".into()]));
    assert_eq!(inside("textures%2Fmr.png"), Checked::Inside(vec!["textures".into(), "mr.png".into()]));
}

#[test]
fn a_root_lets_files_of_a_parent_be_read_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().canonicalize().unwrap();
    std::fs::create_dir_all(root.join("scenes/inner")).unwrap();
    let names = |uri: &str| match check_uri(uri, 0).unwrap() {
        Checked::Inside(names) | Checked::Above(names) => names,
        Checked::Data { .. } => panic!("{uri} is data"),
    };
    let at = |root: &std::path::Path, uri: &str| resolve(&root_of(root), root, &names(uri));
    fn root_of(root: &std::path::Path) -> std::path::PathBuf {
        root.join("scenes/inner")
    }
    assert_eq!(at(&root, "../../a.png").unwrap(), root.join("a.png"));
    assert!(matches!(at(&root, "../../../a.png"), Err(UriError::Parent)));
    // a root beside the scene holds nothing of it
    let other = root.join("scenes/inner/deeper");
    std::fs::create_dir(&other).unwrap();
    assert!(matches!(resolve(&root.join("scenes"), &other, &names("a.png")), Err(UriError::Parent)));
    assert!(matches!(resolve_uri(&root.join("scenes"), "../a.png", 0), Err(UriError::Parent)));
}

#[test]
fn everything_else_is_refused() {
    let folder = "allowed paths in the scene's folder";
    let cases: &[(&str, &str)] = &[
        ("", "empty"),
        ("./.", "empty"),
        ("a/..", "empty"),
        ("/etc/passwd", &format!("absolute path, {folder}")),
        ("//host/share", &format!("absolute path, {folder}")),
        ("\\\\host\\share", "backslash, allowed `/` as the separator"),
        ("a\\..\\b", "backslash, allowed `/` as the separator"),
        ("..%5c..%5Csecret", "backslash, allowed `/` as the separator"),
        ("%252e%252e/secret", "escaped twice"),
        ("%25%32%65", "escaped twice"),
        ("file:///etc/passwd", "scheme `file:`, allowed `data:` and paths in the scene's folder"),
        ("HTTPS://a.b/c", "scheme `https:`, allowed `data:` and paths in the scene's folder"),
        ("C:\\secret", "scheme `c:`, allowed `data:` and paths in the scene's folder"),
        ("c:secret", "scheme `c:`, allowed `data:` and paths in the scene's folder"),
        ("C%3A/secret", "colon in a name"),
        ("a.png:stream", "scheme `a.png:`, allowed `data:` and paths in the scene's folder"),
        ("tex/a.png:stream", "colon in a name"),
        ("a\0.png", "control character U+0000"),
        ("a%00.png", "control character U+0000"),
        ("a%0ab", "control character U+000A"),
        ("a%ff", "escapes are not UTF-8"),
        ("nul", "name `nul` is read as another one on Windows"),
        ("tex/Com1.png", "name `Com1.png` is read as another one on Windows"),
        ("aux .bin", "name `aux .bin` is read as another one on Windows"),
        ("tex./a", "name `tex.` is read as another one on Windows"),
        (".. /a", "name `.. ` is read as another one on Windows"),
        ("a.png%20", "name `a.png ` is read as another one on Windows"),
        ("data:image/png;base64", "`data:` without a comma"),
        ("data:,seventeen letters!", "`data:` of 18 bytes, allowed 16"),
    ];
    for (uri, want) in cases {
        assert_eq!(message(uri), *want, "{uri:?}");
    }
    assert_eq!(message(&"a/".repeat(2049)), "4098 bytes long, allowed 4096");
}

#[test]
fn data_is_measured_and_not_decoded() {
    let size = |uri: &str| match check_uri(uri, 16).unwrap() {
        Checked::Data { bytes } => bytes,
        other => panic!("{uri} is {other:?}"),
    };
    assert_eq!(size("data:,hello"), 5);
    assert_eq!(size("DATA:application/octet-stream;BASE64,AAAAAAAA"), 6);
    assert_eq!(size("data:;base64,"), 0);
    // A data URI may be longer than a path may.
    assert!(check_uri(&format!("data:,{}", "a".repeat(5000)), 5000).is_ok());
}

#[test]
fn paths_resolve_below_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().canonicalize().unwrap();
    std::fs::create_dir(root.join("tex")).unwrap();
    std::fs::write(root.join("tex/a b.png"), b"x").unwrap();
    let file = |uri: &str| match resolve_uri(folder.path(), uri, 16).unwrap() {
        Resolved::File(path) => path,
        Resolved::Data { .. } => panic!("{uri} is a path"),
    };
    assert_eq!(file("tex/a%20b.png"), root.join("tex/a b.png"));
    assert_eq!(file("not/there.png"), root.join("not/there.png"));
    assert_eq!(file("tex/a%20b.png/below"), root.join("tex/a b.png/below"));
    assert_eq!(resolve_uri(folder.path(), "data:,abc", 16).unwrap(), Resolved::Data { bytes: 3 });
    assert!(matches!(resolve_uri(folder.path(), "../x", 16), Err(UriError::Parent)));
    assert!(matches!(resolve_uri(&root.join("missing"), "a", 16), Err(UriError::Io { .. })));
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_refused() {
    use std::os::unix::fs::symlink;
    let outer = tempfile::tempdir().unwrap();
    let scene = outer.path().join("scene");
    std::fs::create_dir_all(scene.join("real")).unwrap();
    std::fs::write(outer.path().join("secret"), b"x").unwrap();
    // A sibling whose name begins like the folder's is outside too.
    std::fs::create_dir(outer.path().join("scene2")).unwrap();
    symlink("real", scene.join("alias")).unwrap();
    for (link, target) in
        [("up", ".."), ("file", "../secret"), ("dead", "../later"), ("two", "../scene2"), ("loop", "loop")]
    {
        symlink(target, scene.join(link)).unwrap();
    }
    let inside = resolve_uri(&scene, "alias/a.png", 0).unwrap();
    assert_eq!(inside, Resolved::File(scene.canonicalize().unwrap().join("real/a.png")));
    for uri in ["up/secret", "file", "dead", "two/a.png", "loop", "real/../up"] {
        let got = resolve_uri(&scene, uri, 0);
        assert!(matches!(got, Err(UriError::LinkOutside { .. } | UriError::Parent)), "{uri}: {got:?}");
    }
    let text = resolve_uri(&scene, "up/secret", 0).unwrap_err().to_string();
    assert_eq!(text, "symbolic link `up` leads out of the scene's folder");
    // The folder itself may be reached by a link: that is the user's choice, not the file's.
    symlink("scene", outer.path().join("by_link")).unwrap();
    assert!(resolve_uri(&outer.path().join("by_link"), "real/a.png", 0).is_ok());
}

proptest! {
    #[test]
    fn no_uri_leaves_the_folder(uri in r"([./\\%:a-z0-9]|%2[eEfF5]|%5c|\PC){0,24}") {
        if let Ok(Checked::Inside(names)) = check_uri(&uri, 0) {
            for name in &names {
                prop_assert!(!name.is_empty() && name != "." && name != ".." && !name.contains(['/', '\\', ':', '\0']), "{uri:?}: {names:?}");
            }
            let path: std::path::PathBuf = names.iter().collect();
            prop_assert!(path.components().all(|c| matches!(c, std::path::Component::Normal(_))), "{uri:?}");
        }
    }
}
