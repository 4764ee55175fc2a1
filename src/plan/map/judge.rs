//! Whether a map can be made: its numbers, what goes with what, and its images.

use super::images::{ANISOTROPY, Images, NORMAL};
use super::{AnisotropyInput, FromLobe, MapRequest, RoughnessInput, fault, sbrdf};
use crate::encode::mips;
use crate::maps::{Centre, Objective, Shape, rules};
use crate::plan::fault::Fault;
use crate::plan::faults::Faults;
use crate::plan::identity;
use crate::plan::place::Path;

/// Most texels of a level that can be asked to be measured.
const MOST_CHECKED: usize = 1 << 20;

/// Least end of a range that is spread over the logarithm.
const LEAST_LOG: f64 = 1e-9;

/// Judges what can be judged without the images.
pub(super) fn judge(request: &MapRequest, path: &Path, faults: &mut Faults) {
    let filter = &request.filter;
    let rule = filter.rule;
    let fits = matches!(rule.method, rules::Method::Fit);
    let mut wrong =
        |key: &str, why: String, remedy| faults.value(path.key(key), fault(why, None, Some(remedy)));
    if filter.shape == Shape::Anisotropic && !rule.anisotropic {
        wrong(
            "shape",
            format!("rule {} knows one width", rule.id),
            "take the rule fit, or the isotropic shape",
        );
    }
    if filter.shape == Shape::Two && !fits {
        wrong(
            "shape",
            format!("rule {} writes one lobe", rule.id),
            "take the rule fit, or the isotropic shape",
        );
    }
    if filter.shape == Shape::Two && filter.objective == Objective::Reflected {
        let why = "two lobes are fitted to the distribution of normals".to_owned();
        wrong("shape", why, "leave the objective out, or take the isotropic shape");
    }
    if filter.centre == Centre::Free && !fits {
        let why = format!("rule {} stands about the mean normal", rule.id);
        wrong("normals", why, "take the rule fit, or leave it at the mean");
    }
    if filter.objective == Objective::Reflected && !fits {
        wrong(
            "objective",
            format!("rule {} is no search", rule.id),
            "take the rule fit, or leave the objective out",
        );
    }
    let mut range = |path: Path, key: &str, got: f64, [min, max]: [f64; 2]| {
        if !(min..=max).contains(&got) {
            faults.value(path, Fault::Range { key: key.to_owned(), got, min, max });
        }
    };
    range(path.key("factor"), "factor", request.factor, [0.0, 1.0]);
    range(path.key("check"), "check", request.check as f64, [0.0, MOST_CHECKED as f64]);
    if let Some(input) = &request.normal {
        range(path.key("normal").key("scale"), "scale", input.convention.scale, [-1e3, 1e3]);
    }
    match &request.roughness {
        RoughnessInput::Constant(r) => range(path.key("roughness"), "roughness", *r, [0.0, 1.0]),
        RoughnessInput::Image { from: Some(from), .. } => {
            let whole = |[lo, hi]: [f64; 2], (_, [a, b]): &(&str, [f64; 2])| [lo.max(*a), hi.min(*b)];
            let [lo, hi] = from.conversion.numbers.iter().fold([f64::MIN, f64::MAX], whole);
            let place = path.key("roughness").key("from").key("range");
            let least = if from.log { lo.max(LEAST_LOG) } else { lo };
            for (i, end) in from.range.iter().enumerate() {
                range(place.index(i), "range", *end, [least, hi]);
            }
            range(path.key("factor"), "factor", request.factor, [1.0, 1.0]);
            second(request, from, &path.key("roughness").key("from"), faults);
        }
        RoughnessInput::Image { .. } => {}
    }
    if let Some(stretched) = &request.anisotropy {
        anisotropy(request, stretched, path, faults);
    }
    if let Some(sbrdf) = &request.sbrdf {
        sbrdf::judge(request, sbrdf, path, faults);
    }
    outputs(request, path, faults);
}

/// Facets of two widths are written with two widths, and told once.
fn anisotropy(request: &MapRequest, input: &AnisotropyInput, path: &Path, faults: &mut Faults) {
    let place = path.key(ANISOTROPY);
    for (key, got, [min, max]) in
        [("strength", input.strength, [0.0, 1.0]), ("rotation", input.rotation, [-1e3, 1e3])]
    {
        if !(min..=max).contains(&got) {
            faults.value(place.key(key), Fault::Range { key: key.to_owned(), got, min, max });
        }
    }
    let (why, remedy) = match () {
        () if request.filter.shape != Shape::Anisotropic => {
            ("facets of two widths are written with two widths", "ask for the shape anisotropic")
        }
        () if request.roughness.from().is_some_and(|f| f.second.is_some()) => {
            ("lobes of two numbers have widths of their own", "leave the anisotropy out, or `second`")
        }
        () => return,
    };
    faults.value(place, fault(why.to_owned(), None, Some(remedy)));
}

/// A parametrisation of two numbers has a second channel, and is written with two widths.
fn second(request: &MapRequest, from: &FromLobe, path: &Path, faults: &mut Faults) {
    let (id, two) = (from.conversion.id, from.conversion.numbers.get(1));
    let (why, remedy) = match (two, &from.second) {
        (None, None) => return,
        (None, Some(_)) => (format!("{id} has one number"), "leave `second` out"),
        (Some((name, _)), None) => {
            (format!("{id} has two numbers, and the channel of {name} is not named"), SECOND)
        }
        (Some(_), Some(_)) if request.filter.shape != Shape::Anisotropic => {
            (format!("{id} tells of two widths"), "ask for the shape anisotropic")
        }
        (Some(_), Some(_)) => return,
    };
    faults.value(path.key("second"), fault(why, None, Some(remedy)));
}

const SECOND: &str = "name the channel of the second one: `second = \"G\"`";

/// At least one output, and no container twice: both would write the same files.
fn outputs(request: &MapRequest, path: &Path, faults: &mut Faults) {
    let path = path.key("outputs");
    if request.outputs.is_empty() {
        faults.value(path.clone(), Fault::Count { key: "outputs", got: 0, allowed: "1 or more".to_owned() });
    }
    for (i, output) in request.outputs.iter().enumerate() {
        let same = |other: &super::Output| other.encoder.id() == output.encoder.id();
        if request.outputs.iter().take(i).any(same) {
            let (got, why) = (output.encoder.id().to_owned(), "both would write the same files".to_owned());
            faults.value(path.index(i), Fault::Twice { what: "container", got, why });
        }
    }
}

/// What is known of the images of a map that can be made of them.
pub(super) struct Looked {
    pub(super) size: [usize; 2],
    /// Texels times channels, of all of them.
    pub(super) numbers: u64,
    /// Channels of that of the roughness.
    pub(super) packed: usize,
    pub(super) inputs: Vec<identity::Input>,
}

/// Looks at the images of a map.
pub(super) fn images(request: &MapRequest, path: &Path, faults: &mut Faults) -> Option<Looked> {
    let before = faults.len();
    let (mut images, mut packed) = (Images::default(), 1);
    if let RoughnessInput::Image { image, channel, from, .. } = &request.roughness {
        let place = path.key("roughness");
        let mut named = vec![(channel.as_str(), place.key("channel"))];
        if let Some(second) = from.as_ref().and_then(|f| f.second.as_ref()) {
            let from = place.key("from");
            named.push((second.channel.as_str(), from.key("second")));
            named.extend(second.angle.iter().map(|a| (a.as_str(), from.key("angle"))));
        }
        packed = images.look("roughness", image, &named, &place, faults).unwrap_or(1);
    }
    if let Some(normal) = &request.normal {
        let place = path.key("normal");
        let at = |i: usize| place.key("channels").index(i);
        let named: Vec<_> = normal.used().iter().enumerate().map(|(i, n)| (n.as_str(), at(i))).collect();
        images.look(NORMAL, &normal.image, &named, &place, faults);
    }
    if let Some(AnisotropyInput { image: Some(image), .. }) = &request.anisotropy {
        let place = path.key(ANISOTROPY);
        let named = AnisotropyInput::CHANNELS.map(|c| (c, place.clone()));
        images.look(ANISOTROPY, image, &named, &place, faults);
    }
    if let Some(sbrdf) = &request.sbrdf {
        sbrdf::look(sbrdf, path, &mut images, faults);
    }
    if faults.len() > before {
        return None;
    }
    for kind in request.kinds() {
        for (i, output) in request.outputs.iter().enumerate() {
            let count = request.channels(kind, packed);
            if let Err(e) = mips::check(output.encoder, output.storage(kind), count) {
                let why = format!("map {}: {e}", kind.id());
                let remedy = Some("take another storage, or packing = \"single\" where channels are packed");
                faults.value(path.key("outputs").index(i), fault(why, None, remedy));
            }
        }
    }
    let stretched = request.anisotropy.as_ref().is_some_and(|a| a.resample);
    let resample = stretched || request.normal.as_ref().is_some_and(|n| n.resample);
    let size = match images.size(resample, faults) {
        Some(size) => size,
        // of numbers alone one texel is fitted
        None if request.sbrdf.is_some() => [1, 1],
        None => {
            let why =
                "neither a normal map nor a roughness map is given: there is nothing to filter".to_owned();
            faults.value(path.clone(), fault(why, None, Some("add `normal = \"normal.png\"`")));
            return None;
        }
    };
    (faults.len() == before).then_some(Looked {
        size,
        numbers: images.numbers,
        packed,
        inputs: images.inputs,
    })
}
