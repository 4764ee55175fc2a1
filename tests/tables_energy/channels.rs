//! Any channels of a kind: the values are those of the layouts, the order is the one asked for, faults have their words.

use crate::common::bake;
use crate::tables_energy::support::{refused, request};
use brdfbake::grid::{Axis, Texel};
use brdfbake::recipe::parse;
use brdfbake::tables::spec::Request;
use brdfbake::tables::{Bound, Mix, TABLES, TableInfo};
use brdfbake::verify;

const TOLERANCE: f64 = 1e-4;

fn bound(
    kind: &'static TableInfo,
    model: Option<&str>,
    layout: Option<&str>,
    channels: Option<Vec<&str>>,
    axes: Option<&[Axis]>,
) -> Bound {
    let request = Request {
        kind: kind.id.to_owned(),
        model: model.map(str::to_owned),
        layout: layout.map(str::to_owned),
        channels: channels.map(|c| c.into_iter().map(str::to_owned).collect()),
        axes: axes.map(<[Axis]>::to_vec),
        ..Request::default()
    };
    request.bind().unwrap_or_else(|e| panic!("{}: {e}", kind.id))
}

#[test]
fn a_channel_has_the_same_value_wherever_it_stands() {
    // kinds whose layouts are different integrals refuse other sets
    for kind in TABLES.iter().filter(|k| matches!(k.mix, Mix::Free(_))) {
        for layout in kind.layouts {
            // the default model of albedos does not transmit
            let through = layout.channels.iter().any(|c| c.id.starts_with('t') || c.id.ends_with(".inside"));
            let model = (kind.id.contains("albedo") && through).then_some("ggx-glass");
            let whole = bound(kind, model, Some(layout.id), None, None);
            // default axes follow the channels
            let axes = Some(whole.spec.grid.axes());
            let reversed: Vec<&str> = layout.channels.iter().rev().map(|c| c.id).collect();
            let back = bound(kind, model, None, Some(reversed), axes);
            let grid = &whole.spec.grid;
            let n = layout.channels.len();
            for texel in [grid.len() / 3, grid.len() / 2 + 1] {
                let point = grid.texel(texel);
                let a = whole.baker.texel(point.values(), TOLERANCE).unwrap();
                let b = back.baker.texel(point.values(), TOLERANCE).unwrap();
                for c in 0..n {
                    let (x, y) = (a.value[c], b.value[n - 1 - c]);
                    let near = a.error[c] + b.error[n - 1 - c] + 1e-13;
                    assert!((x - y).abs() <= near, "{} {} channel {c}: {x} {y}", kind.id, layout.id);
                }
                for (c, channel) in layout.channels.iter().enumerate() {
                    let alone = bound(kind, model, None, Some(vec![channel.id]), axes);
                    let single = alone.baker.texel(point.values(), TOLERANCE).unwrap();
                    let near = a.error[c] + single.error[0] + 1e-13;
                    let (x, y) = (a.value[c], single.value[0]);
                    assert!((x - y).abs() <= near, "{} {}: {x}, alone {y}", kind.id, channel.id);
                }
            }
        }
    }
}

#[test]
fn channels_that_make_a_layout_are_that_layout() {
    let plan = |line: &str| {
        parse(&format!("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n{line}\n"), "x.toml").unwrap()
    };
    let named = plan("layout = 'multiscatter'");
    assert_eq!(named.hash, plan("channels = ['dfg.fc', 'dfg.total']").hash);
    let turned = plan("channels = ['dfg.total', 'dfg.fc']");
    assert_ne!(named.hash, turned.hash);
    assert_eq!(turned.canonical()["table"][0]["channels"][0], "dfg.total");
    assert!(turned.canonical()["table"][0].get("layout").is_none());
    assert_eq!(turned.tables[0].bound.spec.layout.title(), "channels dfg.total, dfg.fc");
}

#[test]
fn five_channels_are_baked_in_one_table_and_obey_the_laws() {
    let mut request = request(
        "dfg",
        "ggx",
        "{}",
        &["dfg.f82", "dfg.total", "dfg.cloth", "dfg.bias", "dfg.diffuse"],
        &["mu", "roughness"],
    );
    let axis = |id: &str| Axis { len: 6, texel: Texel::Center, ..crate::common::axis(id, 6, Texel::Center) };
    request.axes = Some(vec![axis("mu"), axis("roughness")]);
    let bound = request.bind().unwrap();
    let table = bake(&bound, 1e-5).unwrap();
    assert_eq!(table.channels.iter().map(|c| c.id.as_str()).next_back(), Some("dfg.diffuse"));
    let (verified, _) = verify::check(&bound, table.clone(), 1e-5, &[]).unwrap();
    assert!(verified.laws().iter().any(|l| l.law == "cross-check" && l.held()));
    let mut wrong = table;
    wrong.values.chunks_mut(5).for_each(|c| c[0] *= 1.2);
    let findings = verify::check(&bound, wrong, 1e-5, &[]).unwrap_err();
    assert!(findings.iter().any(|f| f.law == "cross-check"), "{findings:?}");
}

#[test]
fn wrong_channels_are_refused_with_words() {
    let says = |channels: &[&str], words: &str| {
        let e = refused("dfg", "", "{}", channels, &["mu", "alpha"]).to_string();
        assert!(e.contains(words), "{e}");
    };
    says(&["dfg.scale", "dfg.scale"], "`dfg.scale` is given twice");
    says(&["dfg.blue"], "no channel `dfg.blue`");
    says(&[], "0 channels; a table has 1 to 8");
    let all = [
        "dfg.scale",
        "dfg.bias",
        "dfg.fc",
        "dfg.total",
        "dfg.f82",
        "dfg.cloth",
        "dfg.diffuse",
        "dfg.f82-x16",
    ];
    let eight = request("dfg", "", "{}", &all, &["mu", "alpha"]).bind().unwrap();
    assert_eq!(eight.spec.channels().len(), 8);
    let e = refused("albedo", "ggx", "{}", &["t"], &["mu", "alpha"]).to_string();
    assert!(e.contains("ggx") && e.contains("does not transmit"), "{e}");
    let e = refused("albedo", "ggx", "{}", &["e.inside"], &["mu", "alpha"]).to_string();
    assert!(e.contains("no parameter eta"), "{e}");
    let e = refused("glass-compensation", "ggx", "{}", &["ms.missing"], &["mu", "alpha"]).to_string();
    assert!(e.contains("is no interface"), "{e}");
}
