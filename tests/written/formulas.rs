//! What files say of an axis, computed by an evaluator that is not ours, leads to the texel that holds the value.

use brdfbake::grid::provenance::AxisRecord;
use brdfbake::grid::{Axis, Direction, Grid, Quantity, Texel, Warp};
use brdfbake::recipe::{ENGINES, PRESETS, parse};
use brdfbake::tables::{TABLES, spec::Request};
use evalexpr::{ContextWithMutableFunctions, ContextWithMutableVariables, Function, Value};
use std::collections::BTreeMap;

type Context = evalexpr::HashMapContext;

/// The functions of the formulas, by their names in the mathematics of the evaluator.
fn context() -> Context {
    let mut context = Context::new();
    let one = |f: fn(f64) -> f64| Function::new(move |v| Ok(Value::Float(f(v.as_number()?))));
    let two = |f: fn(f64, f64) -> f64| {
        Function::new(move |v| {
            let t = v.as_fixed_len_tuple(2)?;
            Ok(Value::Float(f(t[0].as_number()?, t[1].as_number()?)))
        })
    };
    context.set_function("sqrt".into(), one(f64::sqrt)).unwrap();
    context.set_function("cos".into(), one(libm::cos)).unwrap();
    context.set_function("pow".into(), two(libm::pow)).unwrap();
    context.set_function("min".into(), two(f64::min)).unwrap();
    context.set_function("max".into(), two(f64::max)).unwrap();
    context
}

struct Written(evalexpr::Node, Context);

impl Written {
    fn new(formula: &str) -> Written {
        let node = evalexpr::build_operator_tree(formula).unwrap_or_else(|e| panic!("{formula}: {e}"));
        Written(node, context())
    }

    fn at(&mut self, names: &[(&str, f64)]) -> f64 {
        for (name, value) in names {
            self.1.set_value((*name).to_owned(), Value::Float(*value)).unwrap();
        }
        self.0.eval_number_with_context(&self.1).unwrap_or_else(|e| panic!("{:?} at {names:?}: {e}", self.0))
    }
}

/// Every axis of every preset, engine and kind, with the axis that it is coupled to, by what files say of it.
fn axes() -> BTreeMap<String, (Axis, Option<Axis>)> {
    let mut grids: Vec<Grid> = Vec::new();
    for preset in PRESETS {
        grids.extend(parse(preset.source, preset.id).unwrap().tables.into_iter().map(|t| t.bound.spec.grid));
    }
    for engine in ENGINES {
        grids.extend(engine.plan().unwrap().tables.into_iter().map(|t| t.bound.spec.grid));
    }
    for kind in TABLES {
        let request = Request { kind: kind.id.to_owned(), ..Request::default() };
        grids.push(request.bind().unwrap().spec.grid);
    }
    let mut found = BTreeMap::new();
    for grid in &grids {
        for axis in grid.axes() {
            let other = axis.warp.couples_to();
            let other = other.and_then(|to| grid.axes().iter().find(|a| a.quantity.base_id() == to));
            found.insert(format!("{axis:?} {other:?}"), (axis.clone(), other.cloned()));
        }
    }
    found
}

/// Compares what is written of an axis with its reader at seeded points; values are those of the axis' own quantity.
fn compare(axis: &Axis, other: Option<&Axis>, points: usize) {
    let record = AxisRecord::new(axis);
    let mut coordinate = Written::new(&record.coordinate);
    let mut base = record.base.as_ref().map(|b| Written::new(b.split_once(" = ").unwrap().1));
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    for i in 0..points {
        // the ends too
        let mut pick = |[lo, hi]: [f64; 2]| match i {
            0 => lo,
            1 => hi,
            _ => lo + (hi - lo) * random(),
        };
        let value = pick(axis.domain);
        let coupled = other.map_or(0.0, |o| o.quantity.to_base(pick(o.domain)));
        let names = [(axis.quantity.id, value), (axis.warp.couples_to().unwrap_or("unused"), coupled)];
        let got = coordinate.at(&names);
        let wanted = (axis.index(value, coupled) + 0.5) / axis.len as f64;
        assert!(
            (got - wanted).abs() < 1e-12,
            "{} at {names:?}: {got}, the reader {wanted}",
            record.coordinate
        );
        if let (Some(base), Some(text)) = (&mut base, &record.base) {
            let (got, wanted) = (base.at(&names[..1]), axis.quantity.to_base(value));
            let same =
                got.is_infinite() && wanted.is_infinite() || (got - wanted).abs() <= 1e-12 * wanted.abs();
            assert!(same, "{text} at {value}: {got}, not {wanted}");
        }
    }
}

#[test]
fn axes_of_every_preset_engine_and_kind_evaluate_as_they_are_written() {
    let axes = axes();
    assert!(axes.len() > 60, "only {} axes", axes.len());
    for (axis, other) in axes.values() {
        compare(axis, other.as_ref(), 1000);
    }
}

#[test]
fn a_texture_coordinate_leads_to_its_texel() {
    let coupled = |power, scale, exponent| Warp::Coupled { to: "alpha".to_owned(), power, scale, exponent };
    let warps = [
        Warp::Linear,
        Warp::Power(0.5),
        Warp::Power(3.0),
        Warp::OneMinusPower(0.5),
        Warp::OneMinusPower(2.5),
        coupled(2.0, 1.0, 1.0),
        coupled(3.0, 3.0, 1.0),
        coupled(4.0, 1.0, 0.5),
        coupled(2.5, 16.0, 0.5),
    ];
    let alpha = 0.3;
    let mut compared = 0;
    for (id, domain) in
        [("mu", [0.0, 1.0]), ("mu", [0.125, 0.75]), ("eta", [1.5, 4.0]), ("curvature", [0.0, 2.0])]
    {
        for warp in &warps {
            for texel in [Texel::Center, Texel::Endpoint] {
                for direction in [Direction::Ascending, Direction::Descending] {
                    for offset in [0.0, 1.0, -1.0, 0.25, -0.375] {
                        let quantity = Quantity::find(id).unwrap();
                        let mut axis = Axis::new(quantity, 9, texel).over(domain).warped(warp.clone());
                        (axis.direction, axis.offset) = (direction, offset);
                        axis.check().unwrap();
                        let mut formula = Written::new(&axis.coordinate_formula());
                        // rows that an offset pushes beyond the end hold the value of the end
                        for i in 2..7 {
                            let value = axis.value(i, alpha);
                            let got = formula.at(&[(id, value), ("alpha", alpha)]);
                            let wanted = (i as f64 + 0.5) / 9.0;
                            assert!(
                                (got - wanted).abs() < 1e-9,
                                "{} at {id} = {value}: {got}, not {wanted}",
                                axis.coordinate_formula()
                            );
                            compared += 1;
                        }
                    }
                }
            }
        }
    }
    assert_eq!(compared, 4 * 9 * 2 * 2 * 5 * 5);
}

#[test]
fn slopes_are_those_of_the_index() {
    let mut compared = 0;
    for (axis, other) in axes().values() {
        let [lo, hi] = axis.domain;
        for t in [0.11, 0.37, 0.73] {
            let value = lo + (hi - lo) * t;
            let coupled =
                other.as_ref().map_or(0.0, |o| o.quantity.to_base(0.5 * (o.domain[0] + o.domain[1])));
            let h = 1e-6 * (hi - lo);
            let [before, after] = [value - h, value + h].map(|v| axis.index(v, coupled));
            let wanted = (after - before) / (2.0 * h);
            let got = axis.slope(value, coupled);
            assert!((got - wanted).abs() <= 1e-5 * wanted.abs(), "{axis:?} at {value}: {got}, not {wanted}");
            compared += 1;
        }
    }
    assert!(compared > 180, "{compared}");
}

#[test]
fn every_quantity_has_a_map_that_leads_back() {
    for q in brdfbake::grid::quantity::QUANTITIES.iter().filter(|q| q.base.is_some()) {
        let text = q.base_formula().unwrap();
        let mut written = Written::new(text.split_once(" = ").unwrap().1);
        for t in [0.01, 0.3, 0.5, 0.77, 0.99] {
            let value = q.domain[0] + (q.domain[1] - q.domain[0]) * t;
            let base = written.at(&[(q.id, value)]);
            assert!(
                (q.from_base(base) - value).abs() < 1e-12,
                "{text} at {value}: back to {}",
                q.from_base(base)
            );
        }
    }
}
