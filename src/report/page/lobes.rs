//! The lobe of a table's model as a polar plot.

use super::colour::uri;
use super::view::View;
use crate::math::figures::short;
use crate::models::{self, Params};
use crate::report::plot::{self, Look, Scale, Subject};
use maud::{Markup, html};

/// Angles of incidence, in degrees.
const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 80.0];
/// The width that is shown, where an axis sweeps it.
const ALPHA: f64 = 0.3;

/// The lobe, if the table has a model whose lobe can be drawn.
pub(super) fn lobes(view: &View) -> Option<Markup> {
    let subject = view.provenance.model.as_ref()?;
    let (info, implied) = models::find(&subject.id)?;
    let mut given = subject.params.clone();
    let mut shown = Vec::new();
    for record in &view.provenance.axes {
        let base = record.axis.quantity.base_id();
        let Some(param) = info.measured(base).filter(|_| base != "mu") else { continue };
        let [lo, hi] = record.axis.domain.map(|v| record.axis.quantity.to_base(v));
        let [lo, hi] = [lo.min(hi), lo.max(hi)];
        let value = if base == "alpha" { ALPHA } else { 0.5 * (lo + hi) }.clamp(lo, hi);
        given.insert(param.id.to_owned(), value.into());
        shown.push(format!("{} = {}", param.id, short(value)));
    }
    let params = Params::resolve_over(info.id, info.params, &models::implied_values(implied), &given).ok()?;
    let model = (info.build)(&params).ok()?;
    if model.mirror(1.0).is_some() {
        return None;
    }
    let subject = Subject { name: shown.join(", "), model: &*model };
    let look = Look { degrees: ANGLES.to_vec(), azimuth: 0.0, scale: Scale::Log };
    let svg = plot::polar(info.title, &[subject], &look).svg();
    let what = format!("{}, {}", info.title, shown.join(", "));
    Some(html! {
        figure.lobe {
            img src=(uri("image/svg+xml", svg.as_bytes()))
                alt=(format!("{what}: polar plot in the plane of incidence for light from 0, 30, 60 and 80 degrees; logarithmic radius"));
            figcaption { (what) "; logarithmic radius" }
        }
    })
}
