//! C++17: a header with an `inline constexpr` array and a function that returns a `std::array`.

use super::{C, Call, Parts, Syntax, c};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Cpp;

impl Syntax for Cpp {
    fn id(&self) -> &'static str {
        "cpp"
    }

    fn extension(&self) -> &'static str {
        "hpp"
    }

    fn has_double(&self) -> bool {
        true
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn suffix(&self, double: bool) -> &'static str {
        C.suffix(double)
    }

    fn call(&self, call: &Call<'_>) -> String {
        // the overloads of <cmath> take the type of their arguments; not every library has the names of C in std
        c::call(&Call { double: true, ..*call }, "std::")
    }

    fn int(&self, name: &str, value: &str) -> String {
        C.int(name, value)
    }

    fn float(&self, name: &str, value: &str, double: bool) -> String {
        C.float(name, value, double)
    }

    fn truncate(&self, x: &str) -> String {
        format!("static_cast<int>({x})")
    }

    fn widen(&self, i: &str, double: bool) -> String {
        format!("static_cast<{}>({i})", c::float(double))
    }

    fn least(&self, i: &str, last: usize) -> String {
        C.least(i, last)
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, kind, count, channels) = (p.name, c::float(p.double), p.count, p.results.len());
        let arguments = p.arguments(&format!("{kind} "), "");
        format!(
            "#pragma once\n\n#include <array>\n#include <cmath>\n\n\
             inline constexpr {kind} {name}_table[{count}] = {{\n{}\n}};\n\n\
             inline std::array<{kind}, {channels}> {name}_lookup({arguments})\n{{\n{}    return {{{{\n{}\n    }}}};\n}}\n",
            p.numbers,
            p.body,
            p.results()
        )
    }
}
