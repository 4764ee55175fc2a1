//! Models by name and JSON parameters, their albedo by quadrature, and rows of `tests/values/*.csv`.

use brdfbake::integrate::{Estimate, View};
use brdfbake::models::{self, Brdf, Params};
use brdfbake::tables::average_albedo;
use brdfbake::tables::integral::{Functional, integrate};
use serde_json::{Map, Value};

/// A model by id or alias, with parameters as JSON.
pub(crate) fn model(name: &str, params: &str) -> Box<dyn Brdf> {
    let (info, implied) = models::find(name).unwrap_or_else(|| panic!("no model {name}"));
    let given: Map<String, Value> = serde_json::from_str(params).unwrap();
    let implied: Map<String, Value> =
        implied.iter().map(|(k, v)| ((*k).to_owned(), Value::from(*v))).collect();
    let all = implied.iter().chain(&given).map(|(k, v)| (k.as_str(), v));
    let params = Params::resolve(info.id, info.params, all).unwrap_or_else(|e| panic!("{e}"));
    (info.build)(&params).unwrap()
}

/// E by the chart, whatever closed form the model has: two channels leave a reduction no way in.
pub(crate) fn quadrature(model: &dyn Brdf, view: impl Into<View>, tolerance: f64) -> Estimate {
    integrate(model, view, &[Functional::One, Functional::One], tolerance).unwrap()
}

/// E as tables get it.
pub(crate) fn albedo(model: &dyn Brdf, view: impl Into<View>, tolerance: f64) -> f64 {
    integrate(model, view, &[Functional::One], tolerance).unwrap().value[0]
}

/// E_avg as tables get it.
pub(crate) fn average(name: &str, params: &str, tolerance: f64) -> f64 {
    average_albedo::average(&*model(name, params), Some(1.0), tolerance).unwrap().value[0]
}

/// Records of a CSV file below `tests/values`, by column name.
pub(crate) fn records(file: &str) -> Vec<std::collections::HashMap<String, String>> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/values").join(file);
    csv::Reader::from_path(path).unwrap().deserialize().map(Result::unwrap).collect()
}
