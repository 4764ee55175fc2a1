//! The faults of a map as those of the options of `brdfbake map`, and its other errors with their exit codes.

use super::{Exit, Failure};
use crate::pipeline::map::MapError;
use crate::plan::{Fault, PlanError, Step};

/// Options of the keys of a request.
const OPTIONS: &[(&[&str], &str)] = &[
    (&["normal", "channels"], "--normal-channels"),
    (&["normal", "scale"], "--normal-scale"),
    (&["normal"], "--normal"),
    (&["roughness", "channel"], "--channel"),
    (&["roughness", "from", "range"], "--range"),
    (&["roughness", "from", "second"], "--second-channel"),
    (&["roughness", "from", "angle"], "--angle-channel"),
    (&["roughness"], "--roughness"),
    (&["anisotropy", "strength"], "--anisotropy-strength"),
    (&["anisotropy", "rotation"], "--anisotropy-rotation"),
    (&["anisotropy"], "--anisotropy"),
    (&["sbrdf", "lobes"], "--lobes"),
    (&["sbrdf", "residual"], "--residual"),
    (&["sbrdf", "base"], "--base-color"),
    (&["sbrdf", "metallic", "channel"], "--metallic-channel"),
    (&["sbrdf", "metallic"], "--metallic"),
    (&["sbrdf", "brdf"], "--brdf"),
    (&["sbrdf"], "--sbrdf"),
    (&["shape"], "--anisotropic or --two-lobes"),
    (&["normals"], "--normals fit"),
    (&["objective"], "--objective"),
    (&["outputs"], "--format"),
    (&["factor"], "--factor"),
    (&["check"], "--check"),
    (&["name"], "--name"),
];

/// The faults of a request as those of options.
fn refused(error: &PlanError) -> Failure {
    let line = |(place, fault): &(crate::plan::Place, Fault)| {
        let keys = place.path.steps().iter().filter_map(|s| match s {
            Step::Key(key) => Some(key.as_str()),
            Step::Index(_) => None,
        });
        let keys: Vec<&str> = keys.skip(1).collect();
        let option = OPTIONS.iter().find(|(start, _)| keys.starts_with(start)).map_or("map", |(_, o)| o);
        let remedy = match fault {
            Fault::Image { io: true, .. } => None,
            _ if keys == ["normal"] => Some("--resample brings both to the larger size".to_owned()),
            other => other.remedy(),
        };
        let more = [fault.allowed(), remedy];
        more.into_iter().flatten().fold(format!("{option}: {fault}"), |text, more| format!("{text}; {more}"))
    };
    let exit = error.faults.iter().map(|(_, fault)| match fault {
        Fault::Image { io: true, .. } => Exit::Io,
        Fault::Image { io: false, .. } => Exit::Input,
        Fault::Map { .. } | Fault::Range { .. } | Fault::Count { .. } | Fault::Twice { .. } => Exit::Usage,
        Fault::Name { .. } => Exit::Usage,
        _ => Exit::Input,
    });
    let lines: Vec<String> = error.faults.iter().map(line).collect();
    let object = |((place, _), line): (&(crate::plan::Place, Fault), &String)| serde_json::json!({ "key": place.to_string(), "message": line });
    let faults = error.faults.iter().zip(&lines).map(object).collect();
    let exit = exit.max_by_key(|e| *e as u8).unwrap_or(Exit::Internal);
    Failure { faults, ..Failure::new(exit, lines.join("\nerror: ")) }
}

impl From<MapError> for Failure {
    fn from(error: MapError) -> Failure {
        use crate::encode::{EncodeError, ReadError};
        use crate::maps::FilterError;
        let error = match error {
            MapError::Run(e) => return Failure::from(e),
            other => other,
        };
        let exit = match &error {
            MapError::Filter(FilterError::Cancelled(_))
            | MapError::Read { source: ReadError::Cancelled(_), .. }
            | MapError::Encode { source: EncodeError::Cancelled(_), .. } => {
                return Failure::new(Exit::Interrupted, "interrupted; nothing was written");
            }
            MapError::Read { source: ReadError::Io { .. }, .. } => Exit::Io,
            MapError::Plan(e) => return refused(e),
            MapError::Changed { .. } => Exit::Io,
            MapError::Encode { source, .. } => Exit::of_encode(source),
            _ => Exit::Input,
        };
        Failure::new(exit, error)
    }
}
