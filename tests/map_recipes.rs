//! Maps in recipes: the same request as that of the command, in the transaction and manifest of the tables.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "test")]

use crate::map_files::{normal_code, picture};
use brdfbake::cancel::Cancel;
use brdfbake::maps::{Centre, Shape};
use brdfbake::pipeline::audit::{State, audit};
use brdfbake::pipeline::map::{self, Input, MapRequest, Output, RoughnessInput};
use brdfbake::pipeline::{self, Manifest, PipelineError, Settings, Silent};
use brdfbake::plan::Plan;
use brdfbake::recipe;
use std::path::{Path, PathBuf};

const TABLE: &str = "[[table]]\nkind = 'average-albedo'\nname = 'e'\ntolerance = 1e-3\n";
const MAP: &str = "[[map]]\nname = 'bumps'\nnormal = 'images/n.png'\nroughness = { file = 'images/mr.png', channel = 'G' }\n\
                   factor = 0.5\nnormals = 'fit'\nshape = 'anisotropic'\noutputs = ['ktx2:normal=bc5', 'png']\ncheck = 4\n";

/// A folder with the images of [`MAP`].
fn images() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("images");
    std::fs::create_dir(&folder).unwrap();
    let slope =
        |x: u32, y: u32| [f64::from((x * 7 + y * 3) % 5) * 0.1 - 0.2, f64::from((x + y * y) % 3) * 0.05];
    picture(&folder, "n.png", [8, 4], 3, |x, y, c| normal_code(slope(x, y), c));
    picture(&folder, "mr.png", [8, 4], 3, |x, _, c| if c == 1 { 90 + 10 * (x % 3) as u8 } else { 200 });
    dir
}

fn load(dir: &Path, text: &str) -> Result<Plan, String> {
    let file = dir.join("recipe.toml");
    std::fs::write(&file, text).unwrap();
    recipe::load(&file).map_err(|e| e.to_string())
}

fn bake(plan: &Plan, out: &Path) -> Result<Manifest, PipelineError> {
    pipeline::run(plan, &Settings::new(out), &Cancel::new(), &Silent).map(|o| o.manifest)
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn maps_and_tables_are_one_bake() {
    let dir = images();
    let plan = load(dir.path(), &format!("name = 'both'\n{TABLE}{MAP}")).unwrap();
    let out = dir.path().join("out");
    let manifest = bake(&plan, &out).unwrap();
    // what was planned is what is there, level by level
    let mut planned = plan.files();
    planned.sort();
    assert_eq!(files(&out), planned);
    assert!(planned.contains(&"bumps.normal.mip3.png".to_owned()) && planned.contains(&"e.exr".to_owned()));
    assert_eq!(manifest.maps[0].record.recipe.hash, plan.maps[0].identity);
    let told = audit(&out).unwrap();
    assert_eq!(told.files.len() + 1, planned.len());
    assert!(told.files.iter().all(|f| f.state == State::Whole) && told.foreign.is_empty());
    // the loss of normals is told, from 16 bits to 8
    let measured = manifest.maps[0].record.levels[1].measured.as_ref().unwrap();
    let [wide, narrow] = &measured.normals[..] else { panic!("{measured:?}") };
    assert_eq!([wide.storage.as_str(), narrow.storage.as_str()], ["unorm16", "unorm8"]);
    assert!(wide.mean < narrow.mean + 0.001 && wide.mean >= measured.mean - 0.01, "{measured:?}");
    // a later bake without the maps calls their files stale
    let later = bake(&load(dir.path(), &format!("name = 'both'\n{TABLE}")).unwrap(), &out).unwrap();
    assert_eq!(later.stale.len(), planned.len() - 2);
}

/// The same maps by the command's request: the same bytes, but for what they say of their recipe.
#[test]
fn a_recipe_and_a_request_make_the_same_maps() {
    let dir = images();
    let plan = load(dir.path(), &format!("name = 'map'\n{MAP}")).unwrap();
    bake(&plan, &dir.path().join("a")).unwrap();
    let image = |name: &str| dir.path().join("images").join(name);
    let normal = Some(Input::new(image("n.png")));
    let mut request = MapRequest::new("bumps", normal, RoughnessInput::new(image("mr.png")));
    request.factor = 0.5;
    request.filter.centre = Centre::Free;
    request.filter.shape = Shape::Anisotropic;
    request.check = 4;
    request.outputs = ["ktx2:normal=bc5", "png"].map(|o| Output::parse(o).unwrap()).to_vec();
    let out = dir.path().join("b");
    let done = map::run(&request, &Settings::new(&out), &Cancel::new(), &|_, _| {}).unwrap();
    assert_eq!(done.record.recipe.hash, plan.maps[0].identity);
    for name in files(&out).into_iter().filter(|n| n != "manifest.json") {
        let [a, b] = ["a", "b"].map(|f| std::fs::read(dir.path().join(f).join(&name)).unwrap());
        assert!(a == b, "{name}");
    }
}

/// Identity is what is in the images, not where they lie.
#[test]
fn identities_follow_the_images() {
    let dir = images();
    let text = format!("name = 'm'\n{MAP}");
    let first = load(dir.path(), &text).unwrap();
    let moved = dir.path().join("images2");
    std::fs::create_dir(&moved).unwrap();
    for name in ["n.png", "mr.png"] {
        std::fs::copy(dir.path().join("images").join(name), moved.join(name)).unwrap();
    }
    let second = load(dir.path(), &text.replace("images/", "images2/")).unwrap();
    assert_eq!(first.hash, second.hash);
    assert_ne!(load(dir.path(), &text.replace("0.5", "0.6")).unwrap().hash, first.hash);
    // changed between plan and bake: nothing is written
    let slope = [0.1, 0.0];
    picture(&dir.path().join("images"), "n.png", [8, 4], 3, |_, _, c| normal_code(slope, c));
    let out = dir.path().join("out");
    let failed = bake(&first, &out).unwrap_err().to_string();
    assert!(failed.contains("n.png has changed since the map was planned"), "{failed}");
    assert!(!out.exists());
    assert_ne!(load(dir.path(), &text).unwrap().hash, first.hash);
}

/// A plan with maps is the text of a recipe, and the same plan again: every key of a map away from its default.
#[test]
fn maps_read_back_from_their_text() {
    let dir = images();
    let folder = dir.path().join("images");
    picture(&folder, "s.png", [8, 4], 3, |x, _, c| if c == 0 && x > 3 { 30 } else { 200 });
    let every = "[[map]]\nname = 'lobes'\nroughness = { file = 'images/mr.png', channel = 'R', space = 'srgb', holds = 'gloss' }\n\
                 normal = { file = 'images/n.png', channels = ['G', 'R'], green = 'down', z = 'derived', scale = 0.5, mend = 'on', \
                 signed = 'on', wrap = ['mirror', 'clamp'], resample = 'on' }\nnormals = 'fit'\neffort = 'exact'\n\
                 objective = 'reflected'\ncompare = 'on'\ncheck = 7\noutputs = ['dds:shape=half+albedo=float', 'png']\n\
                 sbrdf = { model = 'lafortune', lobes = 3, residual = 0.2, normalise = 'largest', \
                 base = { file = 'images/mr.png', space = 'linear' }, metallic = { file = 'images/mr.png', channel = 'G' } }\n\
                 [[map]]\nname = 'numbers'\nroughness = 0.3\nsbrdf = { model = 'lafortune', base = [1, 0.5, 0], metallic = 0 }\n\
                 [[map]]\nname = 'ward'\nshape = 'anisotropic'\nrule = 'lean'\npacking = 'gltf'\n\
                 roughness = { file = 'images/s.png', channel = 'R', from = { lobe = 'ward', range = [0.01, 1], log = 'on', \
                 rule = 'formula', second = 'G', angle = 'B' } }\n\
                 [[map]]\nname = 'brushed'\nroughness = 0.3\nshape = 'anisotropic'\n\
                 anisotropy = { file = 'images/s.png', strength = 0.5, rotation = 0.25, resample = 'on' }\n\
                 [[map]]\nname = 'scratched'\nnormal = 'images/n.png'\nroughness = 0.3\nshape = 'two'\noutputs = ['ktx2:wide=bc5']\n";
    let plan = load(dir.path(), &format!("name = 'both'\n{TABLE}{MAP}{every}")).unwrap();
    let asked: Vec<_> = plan.maps.iter().map(|m| m.asked.clone()).collect();
    let text = recipe::text_with_maps("both", &plan.requests(), &asked).unwrap();
    let again = recipe::parse(&text, "again.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(again.hash, plan.hash, "{text}");
    assert_eq!(again.maps.len(), 6);
    let twice: Vec<_> = again.maps.iter().map(|m| m.asked.clone()).collect();
    assert_eq!(recipe::text_with_maps("both", &again.requests(), &twice).unwrap(), text);
    // an image within another file has no path that a recipe could name
    let mut inside = asked[0].clone();
    let bytes = std::fs::read(folder.join("n.png")).unwrap().into();
    inside.normal.as_mut().unwrap().image = map::Source::Memory { name: "images[0]".into(), bytes };
    assert!(recipe::text_with_maps("m", &[], &[inside]).is_none());
}

/// Maps of other sizes: refused, or both brought to the larger size. Packed as glTF has it, whatever the images hold.
#[test]
fn sizes_and_packing() {
    let dir = images();
    picture(&dir.path().join("images"), "small.png", [4, 2], 1, |_, _, _| 100);
    let text = "name = 'm'\n[[map]]\nname = 'a'\nnormal = 'images/n.png'\nroughness = 'images/small.png'\npacking = 'gltf'\noutputs = ['png']\n";
    let refused = load(dir.path(), text).unwrap_err();
    assert!(refused.contains("n.png has 8 x 4 texels") && refused.contains("resample = \"on\""), "{refused}");
    let text = text.replace("'images/n.png'", "{ file = 'images/n.png', resample = 'on' }");
    let plan = load(dir.path(), &text).unwrap();
    assert_eq!(plan.maps[0].size, [8, 4]);
    let out: PathBuf = dir.path().join("out");
    bake(&plan, &out).unwrap();
    let level =
        brdfbake::picture::read_bytes(&std::fs::read(out.join("a.roughness.mip0.png")).unwrap()).unwrap();
    let code = |c: usize| (level.planes[c].values[0] * 255.0).round().to_string();
    // grey is every colour
    assert_eq!([code(0), code(1), code(2)], ["100"; 3]);
}
