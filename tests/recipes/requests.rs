//! Plans made by a program, without a file.

use brdfbake::plan::scene;
use brdfbake::plan::{Output, Plan, TableRequest};
use brdfbake::recipe::{parse, preset};
use brdfbake::scene::{AREA_LIGHT, Asks, EXTENSIONS, GGX, Need, Needs, Range};
use brdfbake::tables::spec::Request;

fn request(kind: &str) -> Request {
    Request { kind: kind.to_owned(), ..Request::default() }
}

#[test]
fn requests_and_files_make_the_same_plan() {
    let file = parse("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n", "x.toml").unwrap();
    let made = Plan::from_requests("x", vec![TableRequest::new("a", request("dfg"))]).unwrap();
    assert_eq!(made.hash, file.hash);
    assert_eq!(made.tables[0].canonical(), file.tables[0].canonical());
}

#[test]
fn requests_are_checked_like_files() {
    let mut bad = TableRequest::new("a/b", request("dgf"));
    bad.tolerance = Some(2.0);
    bad.outputs = Some(vec![Output::parse("exr:half").unwrap(), Output::parse("exr:half").unwrap()]);
    let error = Plan::from_requests("X", vec![bad]).unwrap_err();
    let paths: Vec<String> = error.faults.iter().map(|(p, _)| p.to_string()).collect();
    assert_eq!(
        paths,
        ["name", "table[0].name", "table[0].tolerance", "table[0].outputs[1]", "table[0].kind"]
    );
    let text = error.to_string();
    assert!(text.contains("table[0].kind: unknown table kind `dgf`; did you mean `dfg`?"), "{text}");
    let none = Plan::from_requests("x", Vec::new()).unwrap_err();
    assert!(none.to_string().contains("allowed: 1 to 256"), "{none}");
}

#[test]
fn a_scene_asks_for_what_the_preset_of_its_family_holds() {
    let range = |lo, hi| Range { lo, hi, values: None };
    let ranges = [("roughness".into(), range(0.0, 1.0)), ("f0".into(), range(0.04, 1.0))].into();
    let need = Need { table: GGX.into(), ranges, asked_by: Vec::new() };
    let needs = Needs { needs: vec![need], left_out: Vec::new() };
    let plan = scene::plan(&needs).unwrap().unwrap();
    assert_eq!(plan.name, scene::NAME);
    let preset = preset(GGX).unwrap().plan().unwrap();
    let tables = |plan: &Plan| plan.tables.iter().map(|t| t.canonical()).collect::<Vec<_>>();
    assert_eq!(tables(&plan), tables(&preset));
    assert!(scene::plan(&Needs::default()).unwrap().is_none());
}

#[test]
fn every_family_that_a_scene_can_ask_for_is_baked() {
    let families = EXTENSIONS.iter().flat_map(|e| match e.asks {
        Asks::Layer(families, _) => families.iter().copied(),
        _ => [].iter().copied(),
    });
    for family in families.chain([GGX, AREA_LIGHT]) {
        assert!(
            scene::FAMILIES.iter().any(|f| f.id == family),
            "write a line for `{family}` in FAMILIES of src/plan/scene/mod.rs"
        );
    }
    // and what a family says that it serves is there
    for (kind, model) in scene::FAMILIES.iter().flat_map(|f| f.serves) {
        assert!(brdfbake::tables::find(kind).is_some(), "{kind}");
        assert!(model.is_none_or(|m| brdfbake::models::find(m).is_some()), "{model:?}");
    }
    for extension in EXTENSIONS {
        if let Asks::NotYet { kind, .. } = extension.asks {
            assert!(
                brdfbake::tables::find(kind).is_none(),
                "there is a kind `{kind}` now: let {} ask for it in src/scene/asks",
                extension.name
            );
        }
    }
    let none = Need { table: "nothing".into(), ranges: [].into(), asked_by: Vec::new() };
    let error = scene::plan(&Needs { needs: vec![none], left_out: Vec::new() }).unwrap_err().to_string();
    assert!(
        error.starts_with("nothing bakes the nothing tables that the scene needs; there is ggx, "),
        "{error}"
    );
}

#[test]
fn what_a_plan_asked_for_makes_it_again() {
    let plan = preset("default").unwrap().plan().unwrap();
    let again = Plan::from_requests(&plan.name, plan.requests()).unwrap();
    assert_eq!(again.hash, plan.hash);
    assert_eq!(again.files(), plan.files());
}
