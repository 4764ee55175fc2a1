//! `--suggest`: the printed recipe bakes, and the printed lines read what it bakes.

use crate::engines::compare::truth;
use crate::engines::support::{Texture, bake, picture};
use brdfbake::cancel::Cancel;
use brdfbake::pipeline::suggest::{Ranges, Suggestion, Want, suggest, suggest_within};
use brdfbake::recipe::{Reader, engine, parse};
use naga::front::{glsl, wgsl};
use naga::{BinaryOperator, Expression, Function, Handle, Literal, MathFunction, Module, Statement};

fn suggested(id: &str, table: &str, error: f64, practical: bool) -> Suggestion {
    let engine = engine(id).unwrap();
    let mut plan = engine.plan().unwrap();
    plan.tables.retain(|t| t.name() == table);
    let want = Want { error, practical, longest: 96 };
    suggest(engine, &plan, want, &Cancel::new()).unwrap().remove(0)
}

/// The same for what a scene holds: a part of the roughness.
fn suggested_for(roughness: [f64; 2], error: f64) -> Suggestion {
    let engine = engine("bevy").unwrap();
    let mut plan = engine.plan().unwrap();
    plan.tables.retain(|t| t.name() == "bevy-dfg");
    let want = Want { error, practical: false, longest: 96 };
    let ranges = Ranges::from([("bevy-dfg".to_owned(), roughness)]);
    suggest_within(engine, &plan, want, &ranges, &Cancel::new()).unwrap().remove(0)
}

/// What a function of a module returns: its expressions walked by hand, as a GPU would.
struct Shader {
    module: Module,
}

impl Shader {
    fn call(&self, name: &str, arguments: &[Vec<f32>]) -> Vec<f32> {
        let (_, f) = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name)).unwrap();
        let value = f.body.iter().find_map(|s| match s {
            Statement::Return { value } => *value,
            _ => None,
        });
        evaluate(f, value.unwrap(), arguments)
    }
}

fn evaluate(f: &Function, e: Handle<Expression>, arguments: &[Vec<f32>]) -> Vec<f32> {
    let of = |e: Handle<Expression>| evaluate(f, e, arguments);
    match f.expressions[e] {
        Expression::FunctionArgument(i) => arguments[i as usize].clone(),
        Expression::Literal(Literal::F32(v)) => vec![v],
        Expression::Compose { ref components, .. } => components.iter().flat_map(|c| of(*c)).collect(),
        Expression::AccessIndex { base, index } => vec![of(base)[index as usize]],
        Expression::Binary { op, left, right } => {
            let (a, b) = (of(left)[0], of(right)[0]);
            vec![match op {
                BinaryOperator::Add => a + b,
                BinaryOperator::Subtract => a - b,
                BinaryOperator::Multiply => a * b,
                BinaryOperator::Divide => a / b,
                other => panic!("{other:?}"),
            }]
        }
        Expression::Math { fun, arg, arg1, .. } => {
            let (a, b) = (of(arg)[0], arg1.map(|b| of(b)[0]));
            vec![match fun {
                MathFunction::Sqrt => a.sqrt(),
                MathFunction::Pow => libm::powf(a, b.unwrap()),
                MathFunction::Min => a.min(b.unwrap()),
                MathFunction::Max => a.max(b.unwrap()),
                other => panic!("{other:?}"),
            }]
        }
        ref other => panic!("{other:?}"),
    }
}

/// The printed recipe, baked; and the largest error of what the printed WGSL reads from it.
fn read_by_the_lines(s: &Suggestion, name: &str, error: f64) {
    read_by_the_lines_at(s, name, error, &|j| 0.01 + 0.99 * (f64::from(j) + 0.57) / 40.0);
}

fn read_by_the_lines_at(s: &Suggestion, name: &str, error: f64, rough: &dyn Fn(i32) -> f64) {
    let found = s.found.as_ref().unwrap_or_else(|| panic!("{:?}", s.notes));
    let out = tempfile::tempdir().unwrap();
    let plan = parse(&found.recipe, "suggested.toml").unwrap_or_else(|e| panic!("{e}\n{}", found.recipe));
    let files = bake(&plan, out.path());
    let channels = plan.tables[0].bound.spec.layout.channels.len();
    let texture: Texture = picture(&files[0], channels);
    assert_eq!(vec![texture.width, texture.height], found.size.texels);
    let source = &found.lines;
    let module = wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let shader = Shader { module };
    let bound = truth("dfg", &["dfg.scale", "dfg.bias"]);
    let mut worst: f64 = 0.0;
    for i in 0..40 {
        for j in 0..40 {
            let (mu, r) = ((f64::from(i) + 0.31) / 40.0, rough(j));
            let [mu, r] = [mu as f32, r as f32];
            let uv = shader.call(&format!("{name}_uv"), &[vec![mu], vec![r]]);
            let mut texel: Vec<f32> =
                texture.sample([f64::from(uv[0]), f64::from(uv[1])]).iter().map(|v| *v as f32).collect();
            texel.resize(4, 0.0);
            let arguments =
                if found.recipe.contains("dfg.loss") { vec![texel, vec![mu]] } else { vec![texel] };
            let read = shader.call(&format!("{name}_decode"), &arguments);
            let [mu, r] = [f64::from(mu), f64::from(r)];
            let exact = bound.baker.texel(&[mu, r * r], 1e-7).unwrap().value;
            for c in 0..2 {
                worst = worst.max((f64::from(read[c]) - exact[c]).abs());
            }
        }
    }
    println!(
        "{name}: {:?}, {} bytes, off by {worst:.1e} as the lines read it",
        found.size.texels, found.size.bytes
    );
    assert!(worst <= error + 1e-5, "{worst:e} > {error:e}\n{}\n{source}", found.recipe);
}

#[test]
fn a_suggested_table_is_smaller_and_its_lines_read_it() {
    let error = 3e-3;
    let s = suggested("bevy", "bevy-dfg", error, false);
    read_by_the_lines(&s, "bevy_dfg", error);
    let (own, found) = (s.own.unwrap(), s.found.unwrap());
    assert!(own.whole[0] > error, "the engine's axes cannot: {own:?}");
    assert!(found.size.whole[0] <= error && found.size.bytes < own.bytes / 4, "{found:?}");
    assert_eq!(found.language, "wgsl");
}

#[test]
fn a_scene_makes_the_suggestion_smaller() {
    let error = 3e-3;
    let whole = suggested("bevy", "bevy-dfg", error, false).found.unwrap();
    let s = suggested_for([0.4, 0.6], error);
    let found = s.found.as_ref().unwrap();
    assert!(2 * found.size.bytes <= whole.size.bytes, "{found:?} {whole:?}");
    // read by its lines inside the range, and nowhere else
    let rough = |j: i32| 0.4 + 0.2 * (f64::from(j) + 0.57) / 40.0;
    read_by_the_lines_at(&s, "bevy_dfg", error, &rough);
}

#[test]
fn glsl_lines_are_valid() {
    let s = suggested("three", "three-dfg", 1e-2, true);
    let found = s.found.unwrap_or_else(|| panic!("{:?}", s.notes));
    assert_eq!(found.language, "glsl");
    let source = format!("#version 450\n{}\nvoid main() {{}}\n", found.lines);
    let options = glsl::Options::from(naga::ShaderStage::Fragment);
    glsl::Frontend::default().parse(&options, &source).unwrap_or_else(|e| panic!("{e:?}\n{source}"));
    let plan = parse(&found.recipe, "suggested.toml").unwrap();
    assert_eq!(plan.tables[0].bound.spec.model.as_ref().unwrap().0.id, model("three"), "the integral stays");
}

fn model(id: &str) -> &'static str {
    engine(id).unwrap().plan().unwrap().tables[0].bound.spec.model.as_ref().unwrap().0.id
}

#[test]
fn readers_that_cannot_be_told_say_so() {
    let s = suggested("cycles", "cycles-ggx-E", 1e-3, false);
    assert!(s.found.is_none() && s.notes[0].contains("cannot be told another axis"), "{s:?}");
    let s = suggested("three", "three-ltc-magnitude", 1e-3, false);
    assert!(s.found.is_none() && s.notes[0].contains("ltc-magnitude"), "{s:?}");
    let s = suggested("bevy", "bevy-dfg", 1e-6, true);
    assert!(s.found.is_none() && s.notes.iter().any(|n| n.contains("alone leaves")), "{s:?}");
    for e in brdfbake::recipe::ENGINES {
        match e.reader {
            Reader::Shader(language) => assert!(["glsl", "hlsl", "wgsl"].contains(&language), "{}", e.id),
            Reader::Fixed(why) => assert!(!why.is_empty(), "{}", e.id),
        }
    }
}
