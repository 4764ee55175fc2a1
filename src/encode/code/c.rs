//! C99: a header with an array and a `static inline` function that writes the channels to its last argument.

use super::{Call, Function, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct C;

pub(super) const fn float(double: bool) -> &'static str {
    if double { "double" } else { "float" }
}

/// A call of a function of the C library.
pub(super) fn call(call: &Call<'_>, namespace: &str) -> String {
    let name = match call.function {
        Function::Sqrt => "sqrt",
        Function::Pow => "pow",
        Function::Cos => "cos",
        Function::Min => "fmin",
        Function::Max => "fmax",
    };
    let single = if call.double { "" } else { "f" };
    format!("{namespace}{name}{single}({})", call.arguments.join(", "))
}

impl Syntax for C {
    fn id(&self) -> &'static str {
        "c"
    }

    fn extension(&self) -> &'static str {
        "h"
    }

    fn has_double(&self) -> bool {
        true
    }

    fn most_channels(&self) -> usize {
        64
    }

    fn suffix(&self, double: bool) -> &'static str {
        if double { "" } else { "f" }
    }

    fn call(&self, c: &Call<'_>) -> String {
        call(c, "")
    }

    fn int(&self, name: &str, value: &str) -> String {
        format!("const int {name} = {value};")
    }

    fn float(&self, name: &str, value: &str, double: bool) -> String {
        format!("const {} {name} = {value};", float(double))
    }

    fn truncate(&self, x: &str) -> String {
        format!("(int){x}")
    }

    fn widen(&self, i: &str, double: bool) -> String {
        format!("({}){i}", float(double))
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("{i} < {last} ? {i} : {last}")
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let (name, kind, count) = (p.name, float(p.double), p.count);
        let guard = format!("{}_TABLE_H", name.to_ascii_uppercase());
        let arguments = p.arguments(&format!("{kind} "), "");
        let results: String =
            p.results.iter().enumerate().map(|(c, r)| format!("    out[{c}] = {r};\n")).collect();
        format!(
            "#ifndef {guard}\n#define {guard}\n\n#include <math.h>\n\n\
             static const {kind} {name}_table[{count}] = {{\n{}\n}};\n\n\
             static inline void {name}_lookup({arguments}, {kind} out[{}])\n{{\n{}{results}}}\n\n#endif\n",
            p.numbers,
            p.results.len(),
            p.body
        )
    }
}
