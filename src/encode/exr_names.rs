//! Planes that are named by position, as the channels that they hold.

use super::read::Plane;
use crate::grid::Provenance;

/// The planes under the ids of the channels, without padding, and what is not as the provenance tells. Planes under other names than
/// it tells are left as they are.
pub(super) fn as_channels(planes: Vec<Plane>, p: &Provenance) -> (Vec<Plane>, Vec<String>) {
    let Some(encoding) = p.encoding.as_ref().filter(|e| !e.names.is_empty()) else {
        return (planes, Vec::new());
    };
    let n = p.channels.len();
    let found: Option<Vec<&Plane>> =
        encoding.names.iter().map(|name| planes.iter().find(|plane| plane.name == *name)).collect();
    let Some(found) = found.filter(|f| f.len() == planes.len() && (1..=f.len()).contains(&n)) else {
        return (planes, Vec::new());
    };
    let mut warnings = Vec::new();
    for (i, plane) in found.iter().enumerate().skip(n) {
        let (padded, told) = match encoding.fill.get(i - n) {
            Some(value) => (plane.values.iter().all(|v| (v - value).abs() == 0.0), format!("{value} only")),
            None => {
                (same(&plane.values, &found[n - 1].values), format!("what `{}` holds", found[n - 1].name))
            }
        };
        if !padded {
            warnings
                .push(format!("the metadata says that `{}` holds {told}, it holds other values", plane.name));
        }
    }
    let named = |(plane, channel): (&&Plane, &crate::grid::Channel)| Plane {
        name: channel.id.clone(),
        ..(*plane).clone()
    };
    (found.iter().zip(&p.channels).map(named).collect(), warnings)
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
}
