//! GLSL 3.30, ES 3.00 and later, without a `#version` line: to be included.

use super::{Call, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Glsl;

impl Syntax for Glsl {
    fn id(&self) -> &'static str {
        "glsl"
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
        format!("int {name} = {value};")
    }

    fn float(&self, name: &str, value: &str, _: bool) -> String {
        format!("float {name} = {value};")
    }

    fn truncate(&self, x: &str) -> String {
        format!("int({x})")
    }

    fn widen(&self, i: &str, _: bool) -> String {
        format!("float({i})")
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("min({i}, {last})")
    }

    fn vector(&self, components: usize) -> Option<&'static str> {
        ["float", "vec2", "vec3", "vec4"].get(components.checked_sub(1)?).copied()
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, count) = (p.name, p.count);
        let kind = ["float", "vec2", "vec3", "vec4"][p.results.len().clamp(1, 4) - 1];
        let arguments = p.arguments("float ", "");
        format!(
            "const float {name}_table[{count}] = float[{count}](\n{}\n);\n\n\
             {kind} {name}_lookup({arguments}) {{\n{}    return {kind}(\n{}\n    );\n}}\n",
            p.numbers,
            p.body,
            p.results()
        )
    }
}
