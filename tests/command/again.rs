//! What is not baked twice: by the folder, by the cache, and what is.

use super::support::{SMALL, brdfbake, code, command, err, folder, names, out, text, write};
use std::collections::BTreeMap;
use std::path::Path;

/// Three tables, two of them in one file, and one without metadata.
fn recipe() -> String {
    let table = |name: &str, more: &str| {
        format!(
            "[[table]]\nkind = \"fresnel-dielectric\"\nname = \"{name}\"\n{more}\n\
             [[table.axis]]\nid = \"mu\"\nlength = 4\n[[table.axis]]\nid = \"eta\"\nlength = 4\ndomain = [1.1, 2.0]\n"
        )
    };
    let shared = "file = \"both.h\"\noutputs = [\"text:half\"]";
    format!(
        "name = \"again\"\n{}{}{}",
        table("one", shared),
        table("two", &format!("{shared}\ntolerance = 1e-7")),
        table("alone", "outputs = [\"exr:half\", \"npy:float\"]")
    )
}

/// Tables that a bake made and those that it kept, and where from.
fn bake(args: &[&str]) -> (Vec<String>, Vec<(String, String)>) {
    let o = brdfbake(&[&["bake", "--message-format", "json"], args].concat());
    assert_eq!(code(&o), 0, "{args:?}: {}", err(&o));
    let (mut made, mut kept) = (Vec::new(), Vec::new());
    let mut counted = None;
    for line in out(&o).lines() {
        let event: serde_json::Value = serde_json::from_str(line).unwrap();
        let word = |key: &str| event[key].as_str().unwrap_or_default().to_owned();
        match event["reason"].as_str().unwrap() {
            "table-finished" => made.push(word("table")),
            "map-finished" => made.push(word("map")),
            "table-kept" => kept.push((word("table"), word("from"))),
            "map-kept" => kept.push((word("map"), word("from"))),
            "summary" => counted = event["kept"].as_u64(),
            _ => {}
        }
    }
    assert_eq!(counted, Some(kept.len() as u64));
    (made, kept)
}

/// Every file of a folder.
fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    names(dir).into_iter().map(|n| (n.clone(), std::fs::read(dir.join(n)).unwrap())).collect()
}

fn from(place: &str, tables: &[&str]) -> Vec<(String, String)> {
    tables.iter().map(|t| ((*t).to_owned(), place.to_owned())).collect()
}

#[test]
fn a_folder_that_holds_a_table_keeps_it() {
    let dir = folder();
    let file = write(dir.path(), "r.toml", &recipe());
    let to = dir.path().join("out");
    let again = |more: &[&str]| bake(&[&[text(&file), "-o", text(&to)], more].concat());
    assert_eq!(again(&[]).0, ["one", "two", "alone"]);
    let fresh = files(&to);
    assert_eq!(again(&[]), (vec![], from("folder", &["one", "two", "alone"])));
    assert_eq!(files(&to), fresh);
    assert_eq!(again(&["--force"]).0, ["one", "two", "alone"]);
    // an edited file, a file that is gone, one that is longer: its tables are baked again, and no others
    let edit = |f: &Path| std::fs::write(f, "x");
    let remove = |f: &Path| std::fs::remove_file(f);
    let lengthen = |f: &Path| std::fs::write(f, [&std::fs::read(f)?[..], b"x"].concat());
    let mends = |name: &str, harm: &dyn Fn(&Path) -> std::io::Result<()>, tables: &[&str]| {
        harm(&to.join(name)).unwrap();
        assert_eq!(again(&[]).0, tables, "{name}");
        assert_eq!(files(&to), fresh, "{name}");
    };
    mends("both.h", &edit, &["one", "two"]);
    mends("alone.npy", &remove, &["alone"]);
    mends("alone.exr", &lengthen, &["alone"]);
    // a manifest that says the right hash of a wrong file is no proof
    let other = String::from_utf8(fresh["both.h"].clone()).unwrap() + " ";
    std::fs::write(to.join("both.h"), other).unwrap();
    assert_eq!(again(&[]).0, ["one", "two"]);
    // one table of three has changed; the file that it shares is made anew
    write(dir.path(), "r.toml", &recipe().replace("1e-7", "1e-8"));
    assert_eq!(again(&[]), (vec!["one".to_owned(), "two".to_owned()], from("folder", &["alone"])));
    // without a manifest nothing is known of the files
    std::fs::remove_file(to.join("manifest.json")).unwrap();
    assert_eq!(again(&[]).0, ["one", "two", "alone"]);
}

#[test]
fn folders_share_a_cache() {
    let dir = folder();
    let file = write(dir.path(), "r.toml", &recipe());
    let cache = dir.path().join("cache");
    let into = |to: &str, more: &[&str]| {
        bake(&[&[text(&file), "--cache-dir", text(&cache), "-o", text(&dir.path().join(to))], more].concat())
    };
    assert_eq!(into("a", &[]).0.len(), 3);
    let units = names(&cache);
    assert_eq!(units.len(), 2, "{units:?}");
    assert_eq!(into("b", &[]), (vec![], from("cache", &["one", "two", "alone"])));
    assert_eq!(files(&dir.path().join("a")), files(&dir.path().join("b")));
    assert_eq!(code(&brdfbake(&["verify", text(&dir.path().join("b"))])), 0);
    // as from a bake of its own, under other names
    let renamed = recipe().replace("\"again\"", "\"other\"").replace("\"one\"", "\"first\"");
    write(dir.path(), "r.toml", &renamed);
    into("c", &[]);
    into("d", &["--force"]);
    assert_eq!(files(&dir.path().join("c")), files(&dir.path().join("d")));
    write(dir.path(), "r.toml", &recipe());
    // entries that are damaged in any way count as none, and are mended
    for harm in [&b""[..], b"x", b"00\n{}\n"] {
        for unit in names(&cache) {
            let whole = std::fs::read(cache.join(&unit)).unwrap();
            let damaged = if harm == b"x" {
                [&whole[..whole.len().saturating_sub(1)], b"?"].concat()
            } else {
                harm.to_vec()
            };
            std::fs::write(cache.join(&unit), damaged).unwrap();
        }
        assert_eq!(into(&format!("e{}", harm.len()), &[]).0, ["one", "two", "alone"]);
        assert_eq!(into(&format!("f{}", harm.len()), &[]).1.len(), 3);
    }
    assert_eq!(into("g", &["--force"]).0.len(), 3);
}

/// Tables of three sizes into one small cache.
#[test]
fn a_cache_is_bounded_and_cleared() {
    let dir = folder();
    let cache = dir.path().join("cache");
    for i in 0..6 {
        let text_of = SMALL.replace("[1.0", &format!("[1.0{i}"));
        let file = write(dir.path(), "r.toml", &text_of.replace("\"test\"", &format!("\"t{i}\"")));
        let to = dir.path().join(format!("o{i}"));
        let args =
            ["bake", text(&file), "-q", "-o", text(&to), "--cache-dir", text(&cache), "--cache-size", "30kB"];
        let o = brdfbake(&args);
        assert_eq!(code(&o), 0, "{}", err(&o));
    }
    write(&cache, "mine.txt", "not of the cache");
    let show = brdfbake(&["cache", "--cache-dir", text(&cache), "--json"]);
    let shown: serde_json::Value = serde_json::from_str(&out(&show)).unwrap();
    let (units, bytes) = (shown["units"].as_u64().unwrap(), shown["bytes"].as_u64().unwrap());
    assert!((1..6).contains(&units) && bytes <= 30_000, "{shown}");
    let clear = brdfbake(&["cache", "clear", "--cache-dir", text(&cache)]);
    assert!(code(&clear) == 0 && out(&clear).contains("removed"), "{}", out(&clear));
    assert_eq!(names(&cache), ["mine.txt"]);
    // a folder that cannot be one is told of, and the bake goes on
    let file = write(dir.path(), "r.toml", SMALL);
    let at = cache.join("mine.txt");
    let o = brdfbake(&["bake", text(&file), "-o", text(&dir.path().join("p")), "--cache-dir", text(&at)]);
    assert!(code(&o) == 0 && err(&o).contains("warning: the cache in"), "{}", err(&o));
    let none = command(&["cache"]).env("BRDFBAKE_CACHE_DIR", "").output().unwrap();
    assert_eq!(code(&none), 2, "{}", err(&none));
}

#[test]
fn processes_share_a_cache_at_once() {
    let dir = folder();
    let file = write(dir.path(), "r.toml", &recipe());
    let cache = dir.path().join("cache");
    let start = |i: usize| {
        let to = dir.path().join(format!("o{}", i % 4));
        let args = ["bake", text(&file), "-q", "-o", text(&to), "--cache-dir", text(&cache)];
        command(&args).spawn().unwrap()
    };
    let running: Vec<_> = (0..8).map(start).collect();
    running.into_iter().for_each(|mut child| assert!(child.wait().unwrap().success()));
    let first = files(&dir.path().join("o0"));
    (1..4).for_each(|i| assert_eq!(files(&dir.path().join(format!("o{i}"))), first));
    assert_eq!(names(&cache).len(), 2);
}

/// What `strict` refuses is refused from the folder too.
#[test]
fn what_is_in_doubt_is_kept_but_not_where_nothing_may_be() {
    let dir = folder();
    let missed = "name = \"m\"\n[[table]]\nkind = \"albedo\"\nmodel = \"velvet-ashikhmin\"\nname = \"t\"\ntolerance = 1e-12\n\
                  on-miss = \"report\"\nreconstruction = \"off\"\noutputs = [\"npy:double\"]\n\
                  [[table.axis]]\nid = \"mu\"\nlength = 2\ndomain = [0.1, 0.2]\n";
    let file = write(dir.path(), "r.toml", missed);
    let to = dir.path().join("out");
    let args = [text(&file), "-o", text(&to)];
    assert_eq!(bake(&args).0, ["t"]);
    assert_eq!(bake(&args).1, from("folder", &["t"]));
    let o = brdfbake(&[&["bake", "--strict"], &args[..]].concat());
    assert_eq!(code(&o), 4, "{}", err(&o));
}

#[test]
fn maps_are_kept_too() {
    let dir = folder();
    let image =
        std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/footprints/normal.png")).unwrap();
    std::fs::write(dir.path().join("n.png"), &image).unwrap();
    let map = "name = \"m\"\n[[map]]\nname = \"bumps\"\nnormal = \"n.png\"\nroughness = 0.3\n";
    let file = write(dir.path(), "r.toml", map);
    let (to, cache) = (dir.path().join("out"), dir.path().join("cache"));
    let args = [text(&file), "-o", text(&to), "--cache-dir", text(&cache)];
    assert_eq!(bake(&args).0, ["bumps"]);
    let fresh = files(&to);
    assert_eq!(bake(&args).1, from("folder", &["bumps"]));
    std::fs::remove_dir_all(&to).unwrap();
    assert_eq!(bake(&args).1, from("cache", &["bumps"]));
    assert_eq!(files(&to), fresh);
    // another name of the image is in the files
    std::fs::rename(dir.path().join("n.png"), dir.path().join("other.png")).unwrap();
    write(dir.path(), "r.toml", &map.replace("n.png", "other.png"));
    assert_eq!(bake(&args).0, ["bumps"]);
}
