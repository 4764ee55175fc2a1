//! HLSL, shader model 4 and later.

use super::{Call, Glsl, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Hlsl;

impl Syntax for Hlsl {
    fn id(&self) -> &'static str {
        "hlsl"
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
        Glsl.int(name, value)
    }

    fn float(&self, name: &str, value: &str, double: bool) -> String {
        Glsl.float(name, value, double)
    }

    fn truncate(&self, x: &str) -> String {
        Glsl.truncate(x)
    }

    fn widen(&self, i: &str, double: bool) -> String {
        Glsl.widen(i, double)
    }

    fn least(&self, i: &str, last: usize) -> String {
        Glsl.least(i, last)
    }

    fn vector(&self, components: usize) -> Option<&'static str> {
        ["float", "float2", "float3", "float4"].get(components.checked_sub(1)?).copied()
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, count) = (p.name, p.count);
        let kind = ["float", "float2", "float3", "float4"][p.results.len().clamp(1, 4) - 1];
        let arguments = p.arguments("float ", "");
        format!(
            "static const float {name}_table[{count}] = {{\n{}\n}};\n\n\
             {kind} {name}_lookup({arguments})\n{{\n{}    return {kind}(\n{}\n    );\n}}\n",
            p.numbers,
            p.body,
            p.results()
        )
    }
}
