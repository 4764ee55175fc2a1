//! A name has one meaning for a model: as a parameter and on an axis.

use brdfbake::plan::Plan;
use brdfbake::recipe::parse;
use brdfbake::tables::TABLES;

/// The first value of a table.
fn value(source: &str) -> f64 {
    let plan: Plan = parse(source, "names.toml").unwrap_or_else(|e| panic!("{e}"));
    let bound = &plan.tables[0].bound;
    let e = bound.baker.texel(bound.spec.grid.texel(0).values(), 1e-10).unwrap();
    e.value[0]
}

fn fixed(model: &str, params: &str) -> f64 {
    value(&format!(
        "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 't'\nmodel = '{model}'\nparams = {{ {params} }}\n\
         [[table.axis]]\nid = 'mu'\nlength = 2\ndomain = [0.5, 1.0]\n"
    ))
}

fn swept(model: &str, axis: &str, at: f64) -> f64 {
    value(&format!(
        "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 't'\nmodel = '{model}'\n\
         [[table.axis]]\nid = 'mu'\nlength = 2\ndomain = [0.5, 1.0]\n\
         [[table.axis]]\nid = '{axis}'\nlength = 2\ndomain = [{at}, 1.0]\n"
    ))
}

#[test]
fn an_axis_means_what_the_parameter_of_its_name_means() {
    for (model, param, axes) in [
        // roughness of Charlie is r; glTF's sheen has its square root
        (
            "charlie",
            "roughness",
            &[("roughness", 0.36), ("r", 0.36), ("alpha", 0.36), ("sheen_roughness", 0.6)][..],
        ),
        ("charlie-neubelt", "roughness", &[("roughness", 0.36), ("sheen_roughness", 0.6)]),
        // the diffuse lobes take it as they are given it
        ("eon", "roughness", &[("roughness", 0.36), ("r", 0.36)]),
        ("fujii", "r", &[("roughness", 0.36)]),
        ("gltf", "roughness", &[("roughness", 0.36)]),
        // facets have alpha, and roughness is its square root
        ("ggx", "alpha", &[("alpha", 0.36), ("roughness", 0.6)]),
        ("kelemen-skin", "alpha", &[("m", 0.36), ("roughness", 0.6)]),
    ] {
        let expected = fixed(model, &format!("{param} = 0.36"));
        for (axis, at) in axes {
            let got = swept(model, axis, *at);
            assert!(
                (got - expected).abs() < 1e-9,
                "{model}: {param} = 0.36 gives {expected}, axis {axis} at {at} gives {got}"
            );
        }
    }
}

#[test]
fn an_exponent_is_no_width() {
    // `alpha` is another spelling of the exponent in `params`, but an axis alpha is a width
    let error = parse(
        "name = 'x'\n[[table]]\nkind = 'albedo'\nname = 't'\nmodel = 'phong'\n[[table.axis]]\nid = 'mu'\nlength = 4\n\
         [[table.axis]]\nid = 'roughness'\nlength = 4\n",
        "x.toml",
    )
    .unwrap_err()
    .to_string();
    assert!(error.contains("nothing in it depends on axis roughness; it can sweep mu, phi, n"), "{error}");
}

#[test]
fn what_a_refusal_offers_is_an_axis() {
    for kind in TABLES {
        let source = format!(
            "name = 'x'\n[[table]]\nkind = '{}'\nname = 't'\n[[table.axis]]\nid = 'gaussian'\nlength = 4\n\
             [[table.axis]]\nid = 'theta_d'\nlength = 4\n[[table.axis]]\nid = 'temperature'\nlength = 4\n",
            kind.id
        );
        let error = parse(&source, "x.toml").unwrap_err().to_string();
        for list in error.split("it can sweep ").skip(1) {
            let list = list.lines().next().unwrap();
            for id in list.split(", ").filter(|id| *id != "nothing") {
                assert!(brdfbake::grid::Quantity::find(id).is_some(), "{}: `{id}` in {list}", kind.id);
            }
        }
    }
}
