//! Python: a module that needs NumPy and nothing else. Its function takes numbers or arrays, which broadcast, and computes in 64-bit
//! floats, whatever the array holds; the channels are the last axis of what it returns. NaN reads as NaN.

use super::{Call, Function, Parts, Syntax};

/// The language. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Python;

impl Syntax for Python {
    fn id(&self) -> &'static str {
        "python"
    }

    fn extension(&self) -> &'static str {
        "py"
    }

    fn comment(&self) -> &'static str {
        "#"
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
            Function::Pow => "power",
            Function::Cos => "cos",
            Function::Min => "minimum",
            Function::Max => "maximum",
        };
        format!("np.{name}({})", call.arguments.join(", "))
    }

    fn int(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }

    fn float(&self, name: &str, value: &str, _: bool) -> String {
        format!("{name} = {value}")
    }

    /// NaN has no index: its texel is the first, and its weight makes NaN of it.
    fn truncate(&self, x: &str) -> String {
        format!("np.nan_to_num({x}).astype(np.intp)")
    }

    fn widen(&self, i: &str, _: bool) -> String {
        i.to_owned()
    }

    fn least(&self, i: &str, last: usize) -> String {
        format!("np.minimum({i}, {last})")
    }

    fn file(&self, p: &Parts<'_>) -> String {
        let kind = if p.double { "float64" } else { "float32" };
        let name = p.name;
        let numbers: String =
            p.arguments.iter().map(|a| format!("    {a} = np.asarray({a}, np.float64)\n")).collect();
        format!(
            "import numpy as np\n\n{name}_table = np.array([\n{}\n], np.{kind})\n\n\n\
             def {name}_lookup({}):\n{numbers}{}    return np.stack(np.broadcast_arrays(\n{},\n    ), axis=-1)\n",
            p.numbers,
            p.arguments("", ""),
            p.body,
            p.results()
        )
    }
}
