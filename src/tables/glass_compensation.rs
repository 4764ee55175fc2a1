//! Energy compensation of a rough interface, from both sides, with the share that is reflected.
//!
//! With `m = 1 - (R + T)` from above, `m'` from inside (at 1 / eta), and their cosine-weighted means, the added lobes are
//!
//! ```text
//! reflect  from above:  a m(o) m(i) / (pi m_avg),          from inside:  a' m'(o) m'(i) / (pi m'_avg)
//! transmit from above:  (1 - a) m(o) m'(i) / (pi m'_avg),  from inside:  (1 - a') m'(o) m(i) / (pi m_avg)
//! 1 - a = x (1 - F_avg),  1 - a' = (1 - x)(1 - F'_avg),  x = m'_avg / (m_avg + m'_avg)
//! ```
//! x follows from reciprocity of f / n_o²: `(1 - a) m_avg = eta² (1 - a') m'_avg`, since `eta² (1 - F'_avg) = 1 - F_avg`.

use super::average_albedo::{Range, average_of};
use super::memo::Memo;
use super::refine::{Refinement, largest, refined};
use super::role::{Lobe, Side};
use super::sides::{crossing, reflected};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS, View};
use crate::models::Brdf;
use crate::terms::fresnel;

const fn channel(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role }
}

const MISSING: ChannelInfo =
    channel("ms.missing", "1 - (R + T)(mu) from above", Role::Complement(Lobe::Model, Side::Above));
const MISSING_INSIDE: ChannelInfo = channel(
    "ms.missing.inside",
    "1 - (R + T)(mu) from inside, at 1 / eta",
    Role::Complement(Lobe::Model, Side::Inside),
);
const AVG: ChannelInfo =
    channel("ms.missing-avg", "2 int ms.missing mu dmu", Role::AverageComplement(Lobe::Model, Side::Above));
const AVG_INSIDE: ChannelInfo = channel(
    "ms.missing-avg.inside",
    "2 int ms.missing.inside mu dmu",
    Role::AverageComplement(Lobe::Model, Side::Inside),
);
const REFLECT: ChannelInfo = channel(
    "ms.reflect",
    "a = 1 - x (1 - F_avg(eta)), the reflected share of what is added from above",
    Role::ReflectedShare(Lobe::Model, Side::Above),
);
const REFLECT_INSIDE: ChannelInfo = channel(
    "ms.reflect.inside",
    "a' = 1 - (1 - x)(1 - F_avg(1 / eta))",
    Role::ReflectedShare(Lobe::Model, Side::Inside),
);

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "glass-compensation",
    title: "Energy compensation of a rough interface",
    formula: "1 - (R + T) from both sides, their means, and the reflected shares a, a'; x = m'_avg / (m_avg + m'_avg)",
    sources: &[
        Source::new(cite::KULLA_CONTY_2017, "the slides on dielectrics (the split is derived here)"),
        Source::new(cite::WALTER_2007, "Eq. 20 and 21 (f of the interface)"),
    ],
    coordinates: &["mu"],
    layouts: &[
        Layout {
            id: "missing",
            doc: "what is missing, from both sides",
            channels: &[MISSING, MISSING_INSIDE],
        },
        Layout {
            id: "full",
            doc: "all that the four added lobes need",
            channels: &[MISSING, MISSING_INSIDE, AVG, AVG_INSIDE, REFLECT, REFLECT_INSIDE],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::Any("ggx-glass"),
    params: &[],
    laws: &["finite", "range", "reciprocity", "complement", "honest"],
    axes: default_axes,
    least_tolerance: |_| 1e-3,
    blended: true,
    notes: "Wants a model with eta that transmits (ggx-glass, beckmann-glass). Means and shares do not depend on mu: a table of them \
        alone is `average-albedo`, layout both-sides. At eta = 1 both sides are the same and x = 1/2.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axis = |id: &str, len, domain: Option<[f64; 2]>| {
        let axis = Quantity::find(id).map(|q| Axis::new(q, len, Texel::Endpoint));
        axis.map(|a| domain.map_or(a.clone(), |d| a.over(d)))
    };
    let mu = axis("mu", 8, None).map(|a| a.warped(Warp::Power(0.5)));
    [mu, axis("roughness", 6, Some([0.2, 1.0])), axis("f0_root4", 4, Some([0.3, 0.7]))]
        .into_iter()
        .flatten()
        .collect()
}

/// What a channel is made of.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Missing,
    Average,
    Share,
}

struct Glass {
    sweep: Sweep,
    parts: Vec<(Part, Side)>,
    averages: Memo<Estimate>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let sweep = Sweep::new(spec, false)?;
    if sweep.info().param("eta").is_none() || !sweep.transmits()? {
        let why = "is no interface; use one that transmits, such as `ggx-glass`";
        return Err(BindError::Model { kind: spec.kind.id, model: sweep.info().id.to_owned(), why });
    }
    let parts = spec.each(|role| match role {
        Role::Complement(_, side) => Some((Part::Missing, side)),
        Role::AverageComplement(_, side) => Some((Part::Average, side)),
        Role::ReflectedShare(_, side) => Some((Part::Share, side)),
        _ => None,
    })?;
    Ok(Box::new(Glass { sweep, parts, averages: Memo::new() }))
}

/// 1 - (R + T) of a model at a view.
fn missing(model: &dyn Brdf, view: View, tolerance: f64) -> Result<Estimate, TexelError> {
    let r = reflected(model, view, 0.5 * tolerance)?;
    let mut e = crossing(model, view, 0.5 * tolerance)?;
    e.value[0] = (1.0 - (r.value[0] + e.value[0])).max(0.0);
    e.error[0] += r.error[0];
    e.evaluations = e.evaluations.saturating_add(r.evaluations);
    Ok(e)
}

impl Glass {
    fn wants(&self, part: Part) -> bool {
        self.parts.iter().any(|p| p.0 == part)
    }

    /// Means from above and from inside.
    fn means(&self, at: &[f64], models: [&dyn Brdf; 2], tolerance: f64) -> Result<Estimate, TexelError> {
        let params = self.sweep.params(at)?;
        self.averages.get(&params, tolerance, || {
            let range = Range::of(params.optional("alpha"), params.optional("eta"), true);
            let turns = models.iter().any(|m| m.turns());
            average_of(&range, turns, 2, tolerance, |view, tolerance| {
                let mut both = missing(models[0], view, tolerance)?;
                let inside = missing(models[1], view, tolerance)?;
                (both.value[1], both.error[1]) = (inside.value[0], inside.error[0]);
                both.evaluations = both.evaluations.saturating_add(inside.evaluations);
                Ok(both)
            })
        })
    }
}

/// The reflected shares from above and from inside, with their errors.
///
/// Guard: where nothing is missing from either side, x = 1/2.
fn shares(means: &Estimate, eta: f64) -> [(f64, f64); 2] {
    let [above, inside] = [means.value[0], means.value[1]];
    let sum = above + inside;
    let x = if sum > 0.0 { inside / sum } else { 0.5 };
    let dx = if sum > 0.0 { (x * means.error[0] + (1.0 - x) * means.error[1]) / sum } else { 0.0 };
    let pass = |eta: f64| 1.0 - fresnel::dielectric_average(eta);
    [(1.0 - x * pass(eta), dx), (1.0 - (1.0 - x) * pass(1.0 / eta), dx)]
}

impl Glass {
    /// The channels, with means to `inner`.
    fn at(&self, at: &[f64], tolerance: f64, inner: f64) -> Result<Estimate, TexelError> {
        let models = [self.sweep.model_from(at, Side::Above)?, self.sweep.model_from(at, Side::Inside)?];
        let view = self.sweep.view(at);
        let nothing = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };
        let one = |side: Side, model: &dyn Brdf| {
            if self.parts.contains(&(Part::Missing, side)) {
                missing(model, view, tolerance)
            } else {
                Ok(nothing)
            }
        };
        let above = one(Side::Above, &*models[0])?;
        let inside = one(Side::Inside, &*models[1])?;
        let averages = self.wants(Part::Average) || self.wants(Part::Share);
        let means = if averages { self.means(at, [&*models[0], &*models[1]], inner)? } else { nothing };
        let shares = shares(&means, self.sweep.params(at)?.number("eta")?);
        let mut all = nothing;
        // means are shared by the texels of a row and counted by none: who computed them depends on the threads
        all.evaluations = above.evaluations.saturating_add(inside.evaluations);
        for (c, &(part, side)) in self.parts.iter().enumerate() {
            let i = side as usize;
            (all.value[c], all.error[c]) = match (part, side) {
                (Part::Missing, Side::Above) => (above.value[0], above.error[0]),
                (Part::Missing, Side::Inside) => (inside.value[0], inside.error[0]),
                (Part::Average, _) => (means.value[i], means.error[i]),
                (Part::Share, _) => shares[i],
            };
        }
        Ok(all)
    }
}

impl Baker for Glass {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let how = Refinement { tolerance, first: tolerance, share: 0.5, least: 1e-9 };
        // a share is a quotient of means: they need more digits where little is missing; other channels magnify nothing
        let error = |e: &Estimate| if self.wants(Part::Share) { largest(e, self.parts.len()) } else { 0.0 };
        refined(how, |inner| self.at(at, tolerance, inner), error)
    }

    fn rule(&self) -> String {
        format!("product Gauss-Legendre, chart of refraction; {}", self.sweep.rule())
    }
}
