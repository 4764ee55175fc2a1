//! The images of a map that is judged: what they hold, and that they are of one size.

use super::input::{Facts, Unknown, facts};
use super::sbrdf::BRDF;
use super::{Source, fault};
use crate::encode::{Encoder, ReadError, merl};
use crate::picture::MAX_PIXELS;
use crate::plan::fault::Fault;
use crate::plan::faults::Faults;
use crate::plan::identity;
use crate::plan::place::Path;

/// Images that were looked at.
#[derive(Default)]
pub(super) struct Images<'a> {
    pub(super) inputs: Vec<identity::Input>,
    /// Texels times channels, of all of them.
    pub(super) numbers: u64,
    sizes: Vec<(&'a Source, [usize; 2], Path)>,
}

impl<'a> Images<'a> {
    /// Looks at an image, of which channels are read that are named at their places; grey serves for any colour, but for no
    /// direction. Returns how many it has.
    pub(super) fn look(
        &mut self,
        role: &str,
        image: &'a Source,
        named: &[(&str, Path)],
        place: &Path,
        faults: &mut Faults,
    ) -> Option<usize> {
        let facts = known(image, place, faults)?;
        let grey = role != NORMAL && role != ANISOTROPY;
        named.iter().for_each(|(name, place)| has(&facts, name, grey, place, faults));
        self.count(&facts);
        self.sizes.push((image, facts.size, place.clone()));
        self.inputs.push(identity::Input { role: role.to_owned(), content: facts.blake3 });
        Some(facts.names.len())
    }

    /// Looks at a tabulated BRDF, which has no size.
    pub(super) fn table(&mut self, source: &'a Source, place: &Path, faults: &mut Faults) {
        let Some(facts) = known(source, place, faults) else { return };
        if facts.format != merl::Merl.id() {
            let why = format!("{} is no table of the MERL database", source.path().display());
            faults.value(place.clone(), fault(why, None, Some("bake one with the container `merl`")));
        }
        self.count(&facts);
        self.inputs.push(identity::Input { role: BRDF.to_owned(), content: facts.blake3 });
    }

    fn count(&mut self, facts: &Facts) {
        let [w, h] = facts.size.map(|n| u64::try_from(n).unwrap_or(u64::MAX));
        let channels = u64::try_from(facts.names.len()).unwrap_or(u64::MAX);
        self.numbers = self.numbers.saturating_add(w.saturating_mul(h).saturating_mul(channels));
    }

    /// The largest size: that of all, unless they may be resampled. None without images.
    pub(super) fn size(&self, resample: bool, faults: &mut Faults) -> Option<[usize; 2]> {
        let (first, own, _) = self.sizes.first()?;
        let size = self.sizes.iter().fold(*own, |a, (_, b, _)| [a[0].max(b[0]), a[1].max(b[1])]);
        if let Some((other, different, place)) = self.sizes.iter().find(|(_, s, _)| s != own)
            && !resample
        {
            let told =
                |image: &Source, [w, h]: [usize; 2]| format!("{} has {w} x {h}", image.path().display());
            let why = format!(
                "{} texels, {}: maps of one surface have one size",
                told(other, *different),
                told(first, *own)
            );
            let remedy = "resample one of them, or ask for it: `resample = \"on\"`";
            faults.value(place.clone(), fault(why, None, Some(remedy)));
        } else if size[0] * size[1] > MAX_PIXELS {
            let why = format!("the larger of both sizes is {} x {} texels", size[0], size[1]);
            let place = self.sizes.last().map_or_else(Path::root, |s| s.2.clone());
            faults.value(place, fault(why, Some(format!("allowed: {MAX_PIXELS} texels")), None));
        }
        Some(size)
    }
}

/// What is known of an image, or a fault.
fn known(image: &Source, place: &Path, faults: &mut Faults) -> Option<Facts> {
    let unknown = match facts(image) {
        Ok(facts) => return Some(facts),
        Err(unknown) => unknown,
    };
    let (why, io) = match &unknown {
        // the path is told once, and in the same words on every system
        Unknown::Read(ReadError::Io { source, .. }) => (source.kind().to_string(), true),
        other => (other.to_string(), false),
    };
    let file = image.path().display().to_string();
    faults.value(place.key("file"), Fault::Image { file, why, io });
    None
}

/// What normals are to a map.
pub(super) const NORMAL: &str = "normal";

/// What directions and strengths of facets are to a map.
pub(crate) const ANISOTROPY: &str = "anisotropy";

/// An image must have a channel, which grey may serve for.
fn has(facts: &Facts, name: &str, grey: bool, place: &Path, faults: &mut Faults) {
    let grey = grey && ["R", "G", "B"].contains(&name) && facts.names.iter().any(|n| n == "Y");
    if !grey && !facts.names.iter().any(|n| n == name) {
        let why = format!("no channel `{name}`; there is {}", facts.names.join(", "));
        faults.value(place.clone(), fault(why, None, Some("name one of them")));
    }
}
