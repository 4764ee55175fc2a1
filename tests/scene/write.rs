//! Scenes that are written: every byte that is not asked to change stays, and what is added is what was baked.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use brdfbake::cancel::Cancel;
use brdfbake::pipeline::write_scene::{self, Bake, Request, SceneOutcome, SceneWriteError};
use brdfbake::pipeline::{self, Manifest, Settings, Silent};
use brdfbake::recipe;
use brdfbake::scene::write::tables::{LOOKUP_TABLES_SCHEMA, NAME, Place};
use brdfbake::scene::write::{EditError, Parts, Patch, edit};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::fixture;
use crate::common::shared;

/// Two small tables, baked once.
fn baked() -> &'static (tempfile::TempDir, Manifest) {
    static BAKED: OnceLock<(tempfile::TempDir, Manifest)> = OnceLock::new();
    BAKED.get_or_init(|| {
        let text = "name = 'small'\n[[table]]\nkind = 'fresnel-schlick'\nname = 'one'\n[[table.axis]]\nid = 'mu'\nlength = 4\n\
                    [[table]]\nkind = 'fresnel-schlick'\nname = 'two'\noutputs = ['png:unorm8', 'exr:float']\n[[table.axis]]\nid = 'mu'\nlength = 5\n";
        let plan = recipe::parse(text, "small.toml").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let settings = Settings::new(folder.path());
        let done = pipeline::run(&plan, &settings, &Cancel::new(), &Silent).unwrap();
        (folder, done.manifest)
    })
}

fn request(scene: &Path, to: &Path) -> Request {
    let serves = vec![(Some(0), vec!["two".to_owned(), "one".to_owned()]), (None, vec!["one".to_owned()])];
    Request { serves, ..Request::new(scene, to) }
}

fn write(request: &Request) -> Result<SceneOutcome, SceneWriteError> {
    let (folder, manifest) = baked();
    let bake = Bake { manifest, folder: folder.path() };
    write_scene::write(request, Some(bake), &Settings::new(""), &Cancel::new())
}

fn open(path: &Path) -> Parts {
    Parts::open(&fs::read(path).unwrap()).unwrap()
}

fn value(parts: &Parts) -> Value {
    serde_json::from_str(&parts.text).unwrap()
}

/// Words of a JSON text: strings, numbers, signs. No parser of this program.
fn words(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let mut word = c.to_string();
        if c == '"' {
            while let Some(c) = rest.next() {
                word.push(c);
                match c {
                    '\\' => word.extend(rest.next()),
                    '"' => break,
                    _ => {}
                }
            }
        } else if c.is_whitespace() {
            continue;
        } else if !"{}[]:,".contains(c) {
            while let Some(c) = rest.next_if(|c| !"{}[]:,\"".contains(*c) && !c.is_whitespace()) {
                word.push(c);
            }
        }
        words.push(word);
    }
    words
}

/// The words of a text that do not come in another one, in their order.
fn lost(old: &[String], new: &str) -> Vec<String> {
    let mut new = words(new).into_iter();
    let mut lost = old.to_vec();
    lost.retain(|word| !new.by_ref().any(|w| w == *word));
    lost
}

/// The words of a text without the length of its first buffer.
fn without_length(text: &str) -> Vec<String> {
    let mut words = words(text);
    let key = |words: &[String], name: &str, from: usize| {
        words[from..].iter().position(|w| *w == format!("\"{name}\"")).map(|i| from + i)
    };
    let length = key(&words, "buffers", 0).and_then(|at| key(&words, "byteLength", at));
    length.into_iter().for_each(|at| drop(words.remove(at + 2)));
    words
}

/// Everything that writing promises of one scene.
fn check(scene: &Path) {
    let out = tempfile::tempdir().unwrap();
    let done = write(&request(scene, out.path())).unwrap_or_else(|e| panic!("{}: {e}", scene.display()));
    let (old, new) = (open(scene), open(&done.scene));
    let name = scene.display();
    let (before, mut after) = (value(&old), value(&new));
    let object = after["extensions"][NAME].clone();
    assert_eq!(object["tables"].as_array().unwrap().len(), 2, "{name}");
    assert_eq!(
        object["materials"],
        json!([{ "tables": [0] }, { "material": 0, "tables": [0, 1] }]),
        "{name}"
    );
    assert!(after["extensionsUsed"].as_array().unwrap().contains(&json!(NAME)), "{name}");
    assert_eq!(after["extensionsRequired"], before["extensionsRequired"], "{name}");
    // without what was added it is the old one
    let root = after.as_object_mut().unwrap();
    root["extensions"].as_object_mut().unwrap().shift_remove(NAME);
    root["extensionsUsed"].as_array_mut().unwrap().retain(|n| n != NAME);
    for empty in ["extensions", "extensionsUsed"] {
        if before.get(empty).is_none() {
            root.shift_remove(empty);
        }
    }
    let files: Vec<&Value> =
        object["tables"].as_array().unwrap().iter().flat_map(|t| t["files"].as_array().unwrap()).collect();
    if old.binary {
        let (bin, was) = (new.bin.as_ref().unwrap(), old.bin.clone().unwrap_or_default());
        assert!(bin.starts_with(&was), "{name}");
        let views = after["bufferViews"].as_array().unwrap().clone();
        for file in &files {
            let view = &views[usize::try_from(file["bufferView"].as_u64().unwrap()).unwrap()];
            let start = usize::try_from(view["byteOffset"].as_u64().unwrap()).unwrap();
            let end = start + usize::try_from(view["byteLength"].as_u64().unwrap()).unwrap();
            assert_eq!(blake3::hash(&bin[start..end]).to_hex().as_str(), file["blake3"].as_str().unwrap());
        }
        let root = after.as_object_mut().unwrap();
        root["bufferViews"]
            .as_array_mut()
            .unwrap()
            .truncate(before["bufferViews"].as_array().map_or(0, Vec::len));
        root["buffers"][0]["byteLength"] = before["buffers"][0]["byteLength"].clone();
        assert_eq!(lost(&without_length(&old.text), &new.text), Vec::<String>::new(), "{name}");
    } else {
        for file in &files {
            let path = out.path().join(file["uri"].as_str().unwrap());
            assert_eq!(
                blake3::hash(&fs::read(path).unwrap()).to_hex().as_str(),
                file["blake3"].as_str().unwrap()
            );
        }
        assert_eq!(lost(&words(&old.text), &new.text), Vec::<String>::new(), "{name}");
    }
    assert_eq!(after, before, "{name}");
    // a loader that is not ours takes it as it took the old one; it gives up on meshes without attributes, as our texts have
    if old.binary {
        let foreign =
            |path: &Path| gltf::Gltf::from_slice(&fs::read(path).unwrap()).map(|g| g.materials().len()).ok();
        assert_eq!(foreign(&done.scene), foreign(scene), "{name}");
    }
    // every file that the old one names is where the new one looks
    for image in before["images"].as_array().into_iter().flatten().filter_map(|i| i["uri"].as_str()) {
        let there = scene.parent().unwrap().join(image);
        if !image.starts_with("data:") && there.exists() {
            assert_eq!(fs::read(out.path().join(image)).unwrap(), fs::read(there).unwrap(), "{name}");
        }
    }
    // written again it is the same, and without a bake it is the old one
    let again = tempfile::tempdir().unwrap();
    let second = write(&request(&done.scene, again.path())).unwrap();
    assert_eq!(fs::read(second.scene).unwrap(), fs::read(&done.scene).unwrap(), "{name}");
    let bare = tempfile::tempdir().unwrap();
    let without =
        write_scene::write(&request(&done.scene, bare.path()), None, &Settings::new(""), &Cancel::new());
    let left = value(&open(&without.unwrap().scene));
    assert_eq!(left.get("extensions").and_then(|e| e.get(NAME)), None);
    assert!(!left.to_string().contains(NAME), "{name}");
}

#[test]
fn what_is_not_asked_to_change_stays() {
    for name in ["four_materials.gltf", "four_materials.glb", "everything_off.gltf", "not_supported.gltf"] {
        check(&fixture(name));
    }
}

#[test]
fn real_scenes_keep_their_bytes() {
    let Some(shared) = shared() else { return };
    let mut count = 0;
    for folder in ["assets", "cases/scenes"] {
        let mut files: Vec<PathBuf> =
            fs::read_dir(shared.join(folder)).unwrap().map(|e| e.unwrap().path()).collect();
        files.retain(|p| p.extension().is_some_and(|e| e == "glb" || e == "gltf"));
        files.iter().for_each(|file| check(file));
        count += files.len();
    }
    assert!(count >= 20, "{count}");
}

#[test]
fn extras_hold_the_same_object() {
    for (place, extension, extras) in
        [(Place::Both, true, true), (Place::Extras, false, true), (Place::Extension, true, false)]
    {
        let out = tempfile::tempdir().unwrap();
        let done = write(&Request { place, ..request(&fixture("four_materials.gltf"), out.path()) }).unwrap();
        let root = value(&open(&done.scene));
        let at = |key: &str| root[key].get(NAME).cloned();
        assert_eq!((at("extensions").is_some(), at("extras").is_some()), (extension, extras));
        assert_eq!(root["extensionsUsed"].to_string().contains(NAME), extension);
        if place == Place::Both {
            assert_eq!(at("extensions"), at("extras"));
        }
    }
    let out = tempfile::tempdir().unwrap();
    let path = out.path().join("s.gltf");
    fs::write(&path, r#"{"asset":{"version":"2.0"},"extras":"text"}"#).unwrap();
    let refused = write(&Request { place: Place::Both, ..request(&path, &out.path().join("new")) });
    assert!(refused.unwrap_err().to_string().contains("extras is no object"));
    assert!(!out.path().join("new").exists());
}

#[test]
fn a_scene_changes_its_container() {
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().join("in");
    fs::create_dir(&folder).unwrap();
    let text = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":3,"uri":"a.bin"},{"byteLength":1,"uri":"data:;base64,AQ=="}]}"#;
    fs::write(folder.join("s.gltf"), text).unwrap();
    fs::write(folder.join("a.bin"), [1, 2, 3]).unwrap();
    let glb = write(&request(&folder.join("s.gltf"), &out.path().join("x/s.GLB"))).unwrap();
    assert_eq!(glb.files, ["s.GLB"], "the buffer is inside, and so are the tables");
    let parts = open(&glb.scene);
    assert!(parts.binary && parts.bin.as_ref().unwrap().starts_with(&[1, 2, 3, 0]));
    assert_eq!(value(&parts)["buffers"][0].get("uri"), None);
    let back = write(&request(&glb.scene, &out.path().join("y/t.gltf"))).unwrap();
    let parts = open(&back.scene);
    assert_eq!(value(&parts)["buffers"][0]["uri"], "t.bin");
    assert!(fs::read(out.path().join("y/t.bin")).unwrap().starts_with(&[1, 2, 3]));
    assert!(out.path().join("y/t-tables/one.exr").exists());
}

#[test]
fn files_that_are_read_are_not_written_over() {
    let out = tempfile::tempdir().unwrap();
    let scene = out.path().join("s.gltf");
    let text = r#"{"asset":{"version":"2.0"},"images":[{"uri":"tex/a%20b.png"},{"uri":"gone.png"}],"extensions":{"X":{"uri":"more/x.bin","other":{"schemaUri":"http://x/y"}}}}"#;
    fs::write(&scene, text).unwrap();
    fs::create_dir_all(out.path().join("tex")).unwrap();
    fs::create_dir_all(out.path().join("more")).unwrap();
    fs::write(out.path().join("tex/a b.png"), b"picture").unwrap();
    fs::write(out.path().join("more/x.bin"), b"x").unwrap();
    for to in [scene.clone(), out.path().to_path_buf()] {
        assert!(matches!(write(&request(&scene, &to)), Err(SceneWriteError::Itself { .. })));
    }
    // beside the old one nothing is copied
    let beside = write(&request(&scene, &out.path().join("new.gltf"))).unwrap();
    assert_eq!(beside.files[0], "new.gltf");
    assert!(beside.files[1..].iter().all(|f| f.starts_with("new-tables/")), "{:?}", beside.files);
    let away = write(&request(&scene, &out.path().join("far"))).unwrap();
    let far = out.path().join("far");
    assert_eq!(fs::read(far.join("tex/a b.png")).unwrap(), b"picture");
    assert_eq!(fs::read(far.join("more/x.bin")).unwrap(), b"x");
    let notes: Vec<String> = away.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "images[1].uri: there is no file gone.png, and none was copied",
            "extensions.X.other.schemaUri: http://x/y was not copied: scheme `http:`, allowed `data:` and paths in the scene's folder",
        ]
    );
    assert_eq!(fs::read_to_string(&scene).unwrap(), text);
    // a folder of the bake inside that of the scene is named, not copied
    let (folder, manifest) = baked();
    let tables = far.join("my tables");
    fs::create_dir(&tables).unwrap();
    for entry in fs::read_dir(folder.path()).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), tables.join(entry.file_name())).unwrap();
    }
    let bake = Bake { manifest, folder: &tables };
    let named =
        write_scene::write(&request(&scene, &far), Some(bake), &Settings::new(""), &Cancel::new()).unwrap();
    assert_eq!(
        value(&open(&named.scene))["extensions"][NAME]["tables"][0]["files"][0]["uri"],
        "my%20tables/one.exr"
    );
    fs::write(tables.join("one.exr"), b"other").unwrap();
    let bake = Bake { manifest, folder: &tables };
    let changed = write_scene::write(&request(&scene, &far), Some(bake), &Settings::new(""), &Cancel::new());
    assert!(matches!(changed, Err(SceneWriteError::Changed { .. })));
}

/// The few words of JSON Schema that the file uses; a validator proper is run in CI.
fn keeps(schema: &Value, root: &Value, value: &Value, at: &str) {
    if let Some(target) = schema["$ref"].as_str() {
        if let Some(name) = target.strip_prefix("#/$defs/") {
            keeps(&root["$defs"][name], root, value, at);
        }
        return;
    }
    for key in schema["required"].as_array().into_iter().flatten() {
        assert!(value.get(key.as_str().unwrap()).is_some(), "{at}: no {key}");
    }
    if let (Some(properties), Some(members)) = (schema["properties"].as_object(), value.as_object()) {
        for (key, member) in members {
            let inner = properties.get(key).unwrap_or_else(|| panic!("{at}: {key} is not in the schema"));
            keeps(inner, root, member, &format!("{at}.{key}"));
        }
    }
    for item in value.as_array().into_iter().flatten() {
        keeps(&schema["items"], root, item, at);
    }
    let is = match schema["type"].as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("integer") => value.is_u64(),
        Some("number") => value.is_number(),
        Some("boolean") => value.is_boolean(),
        _ => true,
    };
    assert!(is, "{at}: {value} is no {}", schema["type"]);
}

#[test]
fn the_object_keeps_its_schema() {
    let schema: Value = serde_json::from_str(LOOKUP_TABLES_SCHEMA).unwrap();
    for name in ["four_materials.gltf", "four_materials.glb"] {
        let out = tempfile::tempdir().unwrap();
        let done = write(&request(&fixture(name), out.path())).unwrap();
        keeps(&schema, &schema, &value(&open(&done.scene))["extensions"][NAME], NAME);
    }
}

/// JSON texts as nobody would write them: any blanks, any spelling of numbers, escapes.
fn any_json() -> impl Strategy<Value = String> {
    let blank = "[ \\t\\n\\r]{0,3}";
    let leaf = prop_oneof![
        "-?(0|[1-9][0-9]{0,6})(\\.[0-9]{1,8})?([eE][+-]?[0-9]{1,2})?".prop_map(|s| s),
        Just("true".to_owned()),
        Just("null".to_owned()),
        "\"([a-zA-Z ,:{}\\[\\]é]|\\\\u00e9|\\\\\"|\\\\\\\\){0,8}\"".prop_map(|s| s),
    ];
    leaf.prop_recursive(4, 40, 5, move |inner| {
        let item = (blank, inner.clone(), blank).prop_map(|(a, v, b)| format!("{a}{v}{b}"));
        let member = (blank, "[a-d]{1,3}", blank, blank, inner, blank)
            .prop_map(|(a, k, b, c, v, d)| (k.clone(), format!("{a}\"{k}\"{b}:{c}{v}{d}")));
        prop_oneof![
            prop::collection::vec(item, 0..5).prop_map(|v| format!("[{}]", v.join(","))),
            prop::collection::vec(member, 0..5).prop_map(|v| {
                // a key once
                let members: BTreeMap<String, String> = v.into_iter().collect();
                format!("{{{}}}", members.into_values().collect::<Vec<_>>().join(","))
            }),
        ]
    })
}

/// Bytes at the start and at the end that two texts share, without overlap.
fn common(a: &[u8], b: &[u8]) -> usize {
    let head = a.iter().zip(b).take_while(|(x, y)| x == y).count();
    let tail = a[head..].iter().rev().zip(b[head..].iter().rev()).take_while(|(x, y)| x == y).count();
    head + tail
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    /// One change leaves all bytes before and behind it.
    #[test]
    fn every_other_byte_stays(inner in any_json(), lead in "[ \\n\\t]{0,3}", key in "[a-d]{1,3}", depth in 0_usize..3) {
        let text = format!("{lead}{{ \"x\" :\n\t{inner} , \"y\":[1.50,{{ }} ,{inner}]}}\n");
        prop_assert_eq!(&edit(&text, &Patch::default()).unwrap(), &text);
        let before: Value = serde_json::from_str(&text).unwrap();
        let mut patch = Patch::default();
        match depth {
            0 => patch.member(&format!("{key}z")).set(json!({ "new": [1, 2] })),
            1 => patch.member("y").push(json!("new")),
            _ => patch.member("y").element(1).member(&key).member("deep").set(json!(1)),
        }
        let new = edit(&text, &patch).unwrap();
        prop_assert_eq!(common(text.as_bytes(), new.as_bytes()) , text.len(), "{}", new);
        let mut after: Value = serde_json::from_str(&new).unwrap();
        prop_assert!(after != before);
        match depth {
            0 => drop(after.as_object_mut().unwrap().shift_remove(&format!("{key}z"))),
            1 => drop(after["y"].as_array_mut().unwrap().pop()),
            _ => drop(after["y"][1].as_object_mut().unwrap().shift_remove(&key)),
        }
        prop_assert_eq!(after, before.clone());
        // what is taken away leaves the rest, and what is replaced too
        for (index, replaced) in [(0, true), (1, true), (2, true), (0, false), (1, false), (2, false)] {
            let mut patch = Patch::default();
            let element = patch.member("y").element(index);
            if replaced { element.set(json!("new")) } else { element.remove() }
            let new = edit(&text, &patch).unwrap();
            let mut wanted = before.clone();
            let list = wanted["y"].as_array_mut().unwrap();
            if replaced { list[index] = json!("new") } else { drop(list.remove(index)) }
            prop_assert_eq!(serde_json::from_str::<Value>(&new).unwrap(), wanted);
            let added = if replaced { 5 } else { 0 };
            prop_assert!(common(text.as_bytes(), new.as_bytes()) + added >= new.len(), "{}", new);
        }
    }
}

#[test]
fn changes_that_do_not_fit_are_refused() {
    let fault = |text: &str, change: &dyn Fn(&mut Patch)| {
        let mut patch = Patch::default();
        change(&mut patch);
        edit(text, &patch).unwrap_err()
    };
    assert!(matches!(fault("{", &|_| {}), EditError::Json(_)));
    let at = |e: EditError| e.to_string();
    assert!(
        at(fault(r#"{"a":[1]}"#, &|p| p.member("a").member("b").set(json!(1)))).starts_with("a is no object")
    );
    assert!(at(fault(r#"{"a":{}}"#, &|p| p.member("a").push(json!(1)))).starts_with("a is no array"));
    assert!(
        at(fault(r#"{"a":[1]}"#, &|p| p.member("a").element(1).remove())).starts_with("a[1] is not there")
    );
}
