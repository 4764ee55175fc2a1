//! A look at a few texels when a request is resolved: what is sure to stop a bake is said before it starts.
//!
//! Two things cannot be read off a request and yet are known before the work: that a model which does not claim a law breaks it on
//! these axes, and that values which have no bound of their own are too large for the storage. A handful of texels, those
//! of the corners and some between them, tells.

use super::fault::Fault;
use super::faults::Faults;
use super::place::Path;
use super::table::PlannedTable;
use crate::encode::Storage;
use crate::grid::layout::{Point, combination};
use crate::math::figures::significant;
use crate::models::Brdf;
use crate::tables::integral::{Functional, integrate};
use crate::tables::sweep::Sweep;
use crate::tables::{ModelUse, TexelError, place};
use crate::verify::reciprocity;

/// Texels along each axis that are looked at for laws, by the number of axes.
const LAWS: [usize; 4] = [9, 9, 4, 3];

/// The least tolerance of a look.
const COARSE: f64 = 1e-3;

/// Looks at a table that is resolved; a fault is that of the model, or of an output, if they are `listed`. Laws are looked at where
/// the axes are the kind's own: on axes that somebody chose, a law that breaks is a finding with all of its texels.
pub(super) fn look(path: &Path, [listed, own_axes]: [bool; 2], planned: &PlannedTable, faults: &mut Faults) {
    if let Some(fault) = own_axes.then(|| unclaimed(planned)).flatten() {
        faults.value(path.key("model"), fault);
        return;
    }
    let look = !planned.bound.baker.is_whole();
    if let Some((output, fault)) = look.then(|| too_large(planned)).flatten() {
        let path = if listed { path.key("outputs").index(output) } else { path.clone() };
        faults.value(path, fault);
    }
}

/// Numbers of texels, up to `per_axis` of them along each axis, the ends included.
fn texels(planned: &PlannedTable, per_axis: usize) -> Vec<usize> {
    let grid = &planned.bound.spec.grid;
    let mut stride = 1;
    let lists: Vec<Vec<usize>> = grid
        .axes()
        .iter()
        .map(|axis| {
            let (step, len) = (stride, axis.len);
            stride *= len;
            let count = len.min(per_axis).max(1);
            (0..count).map(|i| step * (i * (len - 1) / (count - 1).max(1))).collect()
        })
        .collect();
    let total: usize = lists.iter().map(Vec::len).product();
    (0..total).map(|n| combination(&lists, n)[..lists.len()].iter().sum()).collect()
}

/// A law that the model does not claim, that the kind checks and no waiver lets through, and that is broken.
fn unclaimed(planned: &PlannedTable) -> Option<Fault> {
    let spec = &planned.bound.spec;
    let (info, _) = spec.model.as_ref()?;
    if info.laws.passive && info.laws.reciprocal {
        return None;
    }
    let checked =
        |law: &str| spec.kind.laws.contains(&law) && planned.asked.waivers.iter().all(|w| w.law != law);
    let sweep = Sweep::new(spec, matches!(spec.kind.model, ModelUse::Split(_))).ok()?;
    let fault = |laws: &[&'static str], what: String| {
        let laws: Vec<&'static str> = laws.iter().copied().filter(|law| checked(law)).collect();
        (!laws.is_empty()).then_some(Fault::Unclaimed { model: info.id, kind: spec.kind.id, laws, what })
    };
    let per_axis = LAWS[spec.grid.axes().len().clamp(1, LAWS.len()) - 1];
    for texel in texels(planned, per_axis) {
        let point = spec.grid.texel(texel);
        let at = || place(&spec.grid, texel);
        let Ok(model) = sweep.model(point.values()) else { continue };
        if !info.laws.reciprocal
            && checked("reciprocity")
            && let Some((forth, back)) = reciprocity::asymmetry(&*model)
        {
            let what = format!("f(wo, wi) = {} and f(wi, wo) = {}, {}", figure(forth), figure(back), at());
            return fault(&["reciprocity"], what);
        }
        if info.laws.passive {
            continue;
        }
        let error = match values(planned, &point) {
            Look::NoValue(error) => {
                let what = format!("{}, {}", error.of(spec.layout.ids()), at());
                return Some(Fault::NoValue { model: info.id, what });
            }
            Look::Beyond(what, laws) => fault(&laws, format!("{what}, {}", at())),
            Look::Good => None,
        };
        let above = || {
            albedo(&*model, &sweep, &point).and_then(|(what, laws)| fault(&laws, format!("{what}, {}", at())))
        };
        if let Some(found) = error.or_else(above) {
            return Some(found);
        }
    }
    None
}

/// What a texel says.
enum Look {
    Good,
    /// There is no value; no waiver lets one through.
    NoValue(TexelError),
    /// A value beyond the range of its channel, and the laws that it breaks.
    Beyond(String, Vec<&'static str>),
}

fn values(planned: &PlannedTable, point: &Point) -> Look {
    let channels = &planned.bound.spec.layout.channels;
    let e = match planned.bound.baker.texel(point.values(), planned.tolerance.max(COARSE)) {
        Ok(e) => e,
        Err(error) => return Look::NoValue(error),
    };
    for (i, c) in channels.iter().enumerate() {
        let (value, error, [lo, hi]) = (e.value[i], e.error[i], c.range);
        if (value - hi).max(lo - value) > error {
            let mut laws = vec!["range", "energy"];
            if value < 0.0 && lo >= 0.0 {
                laws.push("finite");
            }
            return Look::Beyond(format!("{} = {}", c.id, figure(value)), laws);
        }
    }
    Look::Good
}

/// An albedo above 1, and the laws that it breaks.
fn albedo(model: &dyn Brdf, sweep: &Sweep, point: &Point) -> Option<(String, Vec<&'static str>)> {
    let e = integrate(model, sweep.view(point.values()), &[Functional::One], COARSE).ok()?;
    let above = e.value[0] - e.error[0] > 1.0;
    above.then(|| (format!("E = {}", figure(e.value[0])), vec!["energy", "complement"]))
}

fn figure(v: f64) -> String {
    significant(v, 5)
}

/// The first output that cannot hold a value at a corner of the table, where channels have wider ranges than a storage.
fn too_large(planned: &PlannedTable) -> Option<(usize, Fault)> {
    let spec = &planned.bound.spec;
    let channels = &spec.layout.channels;
    let narrow = |storage: &Storage| {
        let ends = channels.iter().flat_map(|c| c.range.map(|end| (end, c.range)));
        !storage.is_bounded() && ends.into_iter().any(|(end, range)| storage.quantise(end, range).is_err())
    };
    let storages = planned.outputs.iter().map(|o| o.storage).enumerate();
    let storages: Vec<(usize, Storage)> = storages.filter(|(_, storage)| narrow(storage)).collect();
    if storages.is_empty() {
        return None;
    }
    for texel in texels(planned, 2) {
        let point = spec.grid.texel(texel);
        let Ok(e) = planned.bound.baker.texel(point.values(), planned.tolerance.max(COARSE)) else {
            continue;
        };
        for (output, storage) in &storages {
            for (i, channel) in channels.iter().enumerate() {
                if let Err(error) = storage.quantise(e.value[i], channel.range) {
                    let why = format!("{}: {error} at {}", channel.id, place(&spec.grid, texel));
                    let remedy = "store it as float, or end the axis before";
                    return Some((*output, Fault::Container { why, remedy }));
                }
            }
        }
    }
    None
}
