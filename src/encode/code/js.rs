//! JavaScript: a module that exports a typed array and a function. Numbers are 64-bit floats, whatever the array holds.

use super::{Call, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Js;

impl Syntax for Js {
    fn id(&self) -> &'static str {
        "js"
    }

    fn has_double(&self) -> bool {
        true
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn call(&self, call: &Call<'_>) -> String {
        call.common("Math.")
    }

    fn int(&self, name: &str, value: &str) -> String {
        format!("const {name} = {value};")
    }

    fn float(&self, name: &str, value: &str, _: bool) -> String {
        format!("const {name} = {value};")
    }

    fn truncate(&self, x: &str) -> String {
        format!("Math.floor({x})")
    }

    fn widen(&self, i: &str, _: bool) -> String {
        i.to_owned()
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("Math.min({i}, {last})")
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let kind = if p.double { "Float64Array" } else { "Float32Array" };
        let (name, arguments) = (p.name, p.arguments("", ""));
        format!(
            "export const {name}_table = new {kind}([\n{}\n]);\n\n\
             export function {name}_lookup({arguments}) {{\n{}    return [\n{}\n    ];\n}}\n",
            p.numbers,
            p.body,
            p.results()
        )
    }
}
