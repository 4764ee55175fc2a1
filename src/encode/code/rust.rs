//! Rust: a static array and a function that returns an array of the channels.

use super::{Call, Function, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Rust;

const fn float(double: bool) -> &'static str {
    if double { "f64" } else { "f32" }
}

impl Syntax for Rust {
    fn id(&self) -> &'static str {
        "rust"
    }

    fn extension(&self) -> &'static str {
        "rs"
    }

    fn has_double(&self) -> bool {
        true
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn call(&self, call: &Call<'_>) -> String {
        let name = match call.function {
            Function::Sqrt => "sqrt",
            Function::Pow => "powf",
            Function::Cos => "cos",
            Function::Min => "min",
            Function::Max => "max",
        };
        format!("{}::{name}({})", float(call.double), call.arguments.join(", "))
    }

    fn int(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn float(&self, name: &str, value: &str, _: bool) -> String {
        format!("let {name} = {value};")
    }

    fn truncate(&self, x: &str) -> String {
        format!("{x} as usize")
    }

    fn widen(&self, i: &str, double: bool) -> String {
        format!("{i} as {}", float(double))
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("({i}).min({last})")
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, kind, count, channels) = (p.name, float(p.double), p.count, p.results.len());
        let table = name.to_ascii_uppercase();
        let body = format!("{}    [\n{}\n    ]\n", p.body, p.results());
        let body = body.replace(&format!("{name}_table["), &format!("{table}_TABLE["));
        let arguments = p.arguments("", &format!(": {kind}"));
        format!(
            "/// The numbers, channels fastest.\n#[rustfmt::skip]\npub static {table}_TABLE: [{kind}; {count}] = [\n{}\n];\n\n\
             /// Reads between texels; see above.\n#[must_use]\npub fn {name}_lookup({arguments}) -> [{kind}; {channels}] {{\n{body}}}\n",
            p.numbers
        )
    }
}
