//! `sbrdf` of a `[[map]]`: the keys of lobes, each of its type.

use super::keys::{COLOUR, NUMBER, SBRDF};
use super::read_map::{image_of, set};
use super::section::{Section, as_number, wrong};
use crate::picture::Space;
use crate::plan::Path;
use crate::plan::fault::Fault;
use crate::plan::faults::Faults;
use crate::plan::map::sbrdf::{BASE, BRDF, ColourInput, METALLIC, MODEL, NumberInput, Origin};
use crate::plan::map::{SbrdfRequest, Source, words};
use std::path::Path as File;
use toml::de::DeValue;

pub(super) fn sbrdf(
    value: &DeValue<'_>,
    path: &Path,
    folder: &File,
    faults: &mut Faults,
) -> Option<SbrdfRequest> {
    let Some(table) = value.as_table() else {
        let expected =
            "a table, such as { model = \"lafortune\", lobes = 2, base = \"c.png\", metallic = 0 }";
        faults.value(path.clone(), wrong("sbrdf", value, expected));
        return None;
    };
    let section = Section::new(table, path, &SBRDF, faults);
    let _: Option<()> = section.word("model", &[(MODEL, ())], faults);
    let mut out = SbrdfRequest::default();
    set(&mut out.lobes, section.count("lobes", faults));
    set(&mut out.normalise, section.word("normalise", &words::NORMALISE, faults));
    out.residual = section.number("residual", faults);
    if let Some(file) = section.text(BRDF, faults) {
        for key in [BASE, METALLIC] {
            if section.get(key).is_some() {
                let why = format!("a tabulated BRDF has colours of its own, and no `{key}`");
                let remedy = Some("leave it out, or the table");
                faults.value(section.path(key), Fault::Map { why, allowed: None, remedy });
            }
        }
        out.origin = Origin::Tabulated(Source::File(folder.join(file)));
        return Some(out);
    }
    if let Origin::Metallic { base, metallic } = &mut out.origin {
        if let Some(value) = section.get(BASE) {
            set(base, colour(value, &section, folder, faults));
        }
        if let Some(value) = section.get(METALLIC) {
            set(metallic, number(value, &section.path(METALLIC), folder, faults));
        }
    }
    Some(out)
}

/// Three numbers, one for all, a file, or a table with its coding.
fn colour(
    value: &DeValue<'_>,
    section: &Section<'_>,
    folder: &File,
    faults: &mut Faults,
) -> Option<ColourInput> {
    const EXPECTED: &str =
        "linear red, green and blue, one number, a file, or { file = \"c.png\", space = \"srgb\" }";
    let path = section.path(BASE);
    let image = |name: &str, space| ColourInput::Image { image: Source::File(folder.join(name)), space };
    if let Some(name) = value.as_str() {
        return Some(image(name, Space::Srgb));
    }
    if let Some(grey) = as_number(value) {
        return Some(ColourInput::Constant([grey; 3]));
    }
    if let Some(list) = value.as_array() {
        let numbers: Vec<f64> = list.iter().filter_map(|v| as_number(v.get_ref())).collect();
        let found = <[f64; 3]>::try_from(numbers).ok().filter(|_| list.len() == 3);
        if found.is_none() {
            faults.value(path, wrong(BASE, value, EXPECTED));
        }
        return found.map(ColourInput::Constant);
    }
    let Some(table) = value.as_table() else {
        faults.value(path, wrong(BASE, value, EXPECTED));
        return None;
    };
    let own = Section::new(table, &path, &COLOUR, faults);
    let image = image_of(&own, folder, faults)?;
    let space = own.word("space", &words::SPACES, faults).unwrap_or(Space::Srgb);
    Some(ColourInput::Image { image, space })
}

fn number(value: &DeValue<'_>, path: &Path, folder: &File, faults: &mut Faults) -> Option<NumberInput> {
    if let Some(number) = as_number(value) {
        return Some(NumberInput::Constant(number));
    }
    let Some(table) = value.as_table() else {
        let Some(name) = value.as_str() else {
            let expected = "a number, a file, or a table such as { file = \"mr.png\", channel = \"B\" }";
            faults.value(path.clone(), wrong(METALLIC, value, expected));
            return None;
        };
        let image = Source::File(folder.join(name));
        return Some(NumberInput::Image { image, channel: "B".to_owned() });
    };
    let own = Section::new(table, path, &NUMBER, faults);
    let image = image_of(&own, folder, faults)?;
    let channel = own.text("channel", faults).unwrap_or_else(|| "B".to_owned());
    Some(NumberInput::Image { image, channel })
}
