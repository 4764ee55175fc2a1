//! WGSL: a module constant and a function.

use super::{Call, Parts, Syntax, reader};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Wgsl;

impl Syntax for Wgsl {
    fn id(&self) -> &'static str {
        "wgsl"
    }

    fn has_double(&self) -> bool {
        false
    }

    fn most_channels(&self) -> usize {
        4
    }

    fn call(&self, call: &Call<'_>) -> String {
        call.common("")
    }

    fn int(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn float(&self, name: &str, value: &str, _: bool) -> String {
        format!("let {name} = {value};")
    }

    fn truncate(&self, x: &str) -> String {
        format!("i32({x})")
    }

    fn widen(&self, i: &str, _: bool) -> String {
        format!("f32({i})")
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("min({i}, {last})")
    }

    fn vector(&self, components: usize) -> Option<&'static str> {
        ["f32", "vec2<f32>", "vec3<f32>", "vec4<f32>"].get(components.checked_sub(1)?).copied()
    }

    fn function(&self, f: &reader::Lines) -> Option<String> {
        let kind = self.vector(f.results.len())?;
        let arguments: Option<Vec<String>> =
            f.arguments.iter().map(|(name, n)| Some(format!("{name}: {}", self.vector(*n)?))).collect();
        Some(format!(
            "fn {}({}) -> {kind} {{\n{}    return {kind}({});\n}}\n",
            f.name,
            arguments?.join(", "),
            f.body,
            f.results.join(", ")
        ))
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, count) = (p.name, p.count);
        let kind = ["f32", "vec2<f32>", "vec3<f32>", "vec4<f32>"][p.results.len().clamp(1, 4) - 1];
        let arguments = p.arguments("", ": f32");
        format!(
            "const {name}_table = array<f32, {count}>(\n{}\n);\n\n\
             fn {name}_lookup({arguments}) -> {kind} {{\n{}    return {kind}(\n{}\n    );\n}}\n",
            p.numbers,
            p.body,
            p.results()
        )
    }
}
