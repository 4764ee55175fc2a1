//! Whether a map can be made: its numbers, what goes with what, and its images.

use super::input::{Facts, Unknown, facts};
use super::{Input, MapRequest, RoughnessInput, Source, fault};
use crate::encode::{ReadError, mips};
use crate::maps::{Centre, Objective, Shape, rules};
use crate::picture::MAX_PIXELS;
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
            let (_, bounds) = from.conversion.numbers[0];
            let place = path.key("roughness").key("from").key("range");
            let least = if from.log { bounds[0].max(LEAST_LOG) } else { bounds[0] };
            for (i, end) in from.range.iter().enumerate() {
                range(place.index(i), "range", *end, [least, bounds[1]]);
            }
            range(path.key("factor"), "factor", request.factor, [1.0, 1.0]);
        }
        RoughnessInput::Image { .. } => {}
    }
    outputs(request, path, faults);
}

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

/// Size and images of a map that can be made of them.
pub(super) fn images(
    request: &MapRequest,
    path: &Path,
    faults: &mut Faults,
) -> Option<([usize; 2], Vec<identity::Input>)> {
    let (mut inputs, mut sizes, mut packed) = (Vec::new(), Vec::new(), 1);
    let before = faults.len();
    if let RoughnessInput::Image { image, channel, .. } = &request.roughness {
        let place = path.key("roughness");
        if let Some(facts) = look(image, &place, faults) {
            has(&facts, channel, &place.key("channel"), faults);
            packed = facts.names.len();
            sizes.push((image, facts.size));
            inputs.push(identity::Input { role: "roughness".to_owned(), content: facts.blake3 });
        }
    }
    if let Some(normal) = &request.normal {
        let place = path.key("normal");
        if let Some(facts) = look(&normal.image, &place, faults) {
            for (i, name) in normal.used().iter().enumerate() {
                has(&facts, name, &place.key("channels").index(i), faults);
            }
            sizes.push((&normal.image, facts.size));
            inputs.push(identity::Input { role: "normal".to_owned(), content: facts.blake3 });
        }
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
    let Some(&(_, first)) = sizes.first() else {
        let why = "neither a normal map nor a roughness map is given: there is nothing to filter".to_owned();
        faults.value(path.clone(), fault(why, None, Some("add `normal = \"normal.png\"`")));
        return None;
    };
    let size = sizes.iter().fold(first, |a, (_, b)| [a[0].max(b[0]), a[1].max(b[1])]);
    if let Some((other, own)) = sizes.iter().find(|(_, own)| *own != first)
        && !request.normal.as_ref().is_some_and(|n: &Input| n.resample)
    {
        let told = |image: &Source, [w, h]: [usize; 2]| format!("{} has {w} x {h}", image.path().display());
        let why = format!(
            "{} texels, {}: maps of one surface have one size",
            told(other, *own),
            told(sizes[0].0, first)
        );
        faults.value(
            path.key("normal"),
            fault(why, None, Some("resample one of them, or ask for it: `resample = \"on\"`")),
        );
    } else if size[0] * size[1] > MAX_PIXELS {
        let why = format!("the larger of both sizes is {} x {} texels", size[0], size[1]);
        faults.value(path.key("normal"), fault(why, Some(format!("allowed: {MAX_PIXELS} texels")), None));
    }
    (faults.len() == before).then_some((size, inputs))
}

/// What is known of an image, or a fault.
fn look(image: &Source, place: &Path, faults: &mut Faults) -> Option<Facts> {
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

/// An image must have a channel; grey serves for any colour.
fn has(facts: &Facts, name: &str, place: &Path, faults: &mut Faults) {
    let grey = ["R", "G", "B"].contains(&name) && facts.names.iter().any(|n| n == "Y");
    if !grey && !facts.names.iter().any(|n| n == name) {
        let why = format!("no channel `{name}`; there is {}", facts.names.join(", "));
        faults.value(place.clone(), fault(why, None, Some("name one of them")));
    }
}
