//! Texels of any table at any point.

use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::tables::{BindError, TexelError};
use serde_json::{Map, Value as Json};

/// An axis that holds a value; the texels asked for need not be on it.
fn axis_of(id: &str) -> Axis {
    let quantity = Quantity::find(id).unwrap_or_else(|| panic!("no quantity {id}"));
    let [lo, hi] = quantity.domain;
    Axis::new(quantity, 2, Texel::Endpoint).over([lo.max(-1e3), hi.min(1e3)])
}

/// The request for channels of a kind over axes of these quantities.
pub(crate) fn request(kind: &str, model: &str, params: &str, channels: &[&str], axes: &[&str]) -> Request {
    Request {
        kind: kind.to_owned(),
        model: (!model.is_empty()).then(|| model.to_owned()),
        params: serde_json::from_str::<Map<String, Json>>(params).unwrap(),
        channels: Some(channels.iter().map(|c| (*c).to_owned()).collect()),
        axes: Some(axes.iter().map(|id| axis_of(id)).collect()),
        ..Request::default()
    }
}

/// The table itself.
pub(crate) fn table(kind: &str, model: &str, params: &str, channels: &[&str], axes: &[&str]) -> Bound {
    request(kind, model, params, channels, axes).bind().unwrap()
}

/// Why it cannot be bound.
pub(crate) fn refused(kind: &str, model: &str, params: &str, channels: &[&str], axes: &[&str]) -> BindError {
    request(kind, model, params, channels, axes).bind().unwrap_err()
}

/// Value and error of the first channel at a point.
pub(crate) fn texel(bound: &Bound, at: &[f64], tolerance: f64) -> (f64, f64) {
    let e = bound.baker.texel(at, tolerance).unwrap_or_else(|e: TexelError| panic!("{at:?}: {e}"));
    (e.value[0], e.error[0])
}
