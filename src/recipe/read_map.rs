//! `[[map]]`: the keys of a map, each of its type. What they mean together is judged by the plan.

use super::keys::{ANISOTROPY, FROM, MAP, NORMAL, ROUGHNESS};
use super::read_sbrdf;
use super::section::{Section, as_number, wrong};
use crate::functions::conversion::{By, CONVERSIONS, Conversion};
use crate::maps::{Convention, RULES};
use crate::picture::{Space, Wrap};
use crate::plan::Path;
use crate::plan::fault::{Fault, unknown_word};
use crate::plan::faults::Faults;
use crate::plan::map::{
    AnisotropyInput, FromLobe, Input, MapDraft, MapRequest, Output, Packing, RoughnessInput, Second, Source,
    words,
};
use std::path::Path as File;
use toml::de::{DeTable, DeValue};

const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

/// Reads a map whose images lie in `folder`.
pub(super) fn read(table: &DeTable<'_>, path: &Path, folder: &File, faults: &mut Faults) -> MapDraft {
    let before = faults.len();
    let section = Section::new(table, path, &MAP, faults);
    let name = section.text("name", faults);
    let named = faults.len();
    let normal =
        section.get("normal").and_then(|value| normal(value, &section.path("normal"), folder, faults));
    let roughness = match section.get("roughness") {
        Some(value) => roughness(value, &section.path("roughness"), folder, faults),
        None => Some(RoughnessInput::Constant(1.0)),
    };
    let unread = RoughnessInput::Constant(1.0);
    let mut request = MapRequest::new(name.clone().unwrap_or_default(), normal, roughness.unwrap_or(unread));
    let mut outputs = Vec::new();
    let list = section.list("outputs", "a list, such as [\"ktx2\"]", faults);
    // a list far too long is refused by its containers, of which there are few
    for (i, item) in list.unwrap_or_default().iter().enumerate().take(64) {
        let output = match item.get_ref().as_str() {
            Some(text) => Output::parse(text),
            None => Err(wrong(&format!("outputs[{i}]"), item.get_ref(), "a string, such as \"ktx2\"")),
        };
        let output = output.map_err(|fault| faults.value(section.path("outputs").index(i), fault));
        outputs.extend(output);
    }
    if list.is_some() {
        request.outputs = outputs;
    }
    let filter = &mut request.filter;
    let rules: Vec<_> = RULES.iter().map(|r| (r.id, *r)).collect();
    set(&mut filter.rule, section.word("rule", &rules, faults));
    set(&mut filter.centre, section.word("normals", &words::CENTRES, faults));
    set(&mut filter.shape, section.word("shape", &words::SHAPES, faults));
    set(&mut filter.effort, section.word("effort", &words::EFFORTS, faults));
    set(&mut filter.objective, section.word("objective", &words::OBJECTIVES, faults));
    if let Some(value) = section.get("anisotropy") {
        request.anisotropy = anisotropy(value, &section.path("anisotropy"), folder, faults);
    }
    if let Some(value) = section.get("sbrdf") {
        request.sbrdf = read_sbrdf::sbrdf(value, &section.path("sbrdf"), folder, faults);
    }
    set(&mut request.packing, section.word("packing", &Packing::ALL, faults));
    set(&mut request.factor, section.number("factor", faults));
    set(&mut request.check, section.count("check", faults));
    set(&mut request.compare, section.word("compare", &SWITCH, faults));
    let holes = faults.len() > named || (name.is_some() && faults.len() > before);
    MapDraft { request, no_name: name.is_none(), holes }
}

pub(super) fn set<T>(to: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *to = value;
    }
}

/// The file of an image, relative to the folder of the recipe.
pub(super) fn image_of(section: &Section<'_>, folder: &File, faults: &mut Faults) -> Option<Source> {
    section.text("file", faults).map(|name| Source::File(folder.join(name)))
}

fn normal(value: &DeValue<'_>, path: &Path, folder: &File, faults: &mut Faults) -> Option<Input> {
    if let Some(name) = value.as_str() {
        return Some(Input::new(folder.join(name)));
    }
    let Some(table) = value.as_table() else {
        faults.value(
            path.clone(),
            wrong("normal", value, "a file, or a table such as { file = \"n.png\", green = \"down\" }"),
        );
        return None;
    };
    let section = Section::new(table, path, &NORMAL, faults);
    let mut input = Input::new(image_of(&section, folder, faults)?);
    let Convention { green_down, derive_z, scale, mend } = &mut input.convention;
    set(green_down, section.word("green", &[("up", false), ("down", true)], faults));
    set(derive_z, section.word("z", &[("stored", false), ("derived", true)], faults));
    set(scale, section.number("scale", faults));
    set(mend, section.word("mend", &SWITCH, faults));
    let derived = *derive_z;
    set(&mut input.signed, section.word("signed", &SWITCH, faults));
    set(&mut input.resample, section.word("resample", &SWITCH, faults));
    if let Some(wrap) = section.get("wrap") {
        set(&mut input.wrap, wraps(wrap, &section, faults));
    }
    if let Some(names) = section.list("channels", "a list, such as [\"R\", \"G\", \"B\"]", faults) {
        let least = if derived { 2 } else { 3 };
        if !(least..=3).contains(&names.len()) {
            let allowed = if derived { "2 or 3" } else { "3; 2 with z = \"derived\"" }.to_owned();
            faults
                .value(section.path("channels"), Fault::Count { key: "channels", got: names.len(), allowed });
        }
        for (i, (name, own)) in names.iter().zip(&mut input.channels).enumerate() {
            match name.get_ref().as_str() {
                Some(name) => name.clone_into(own),
                None => {
                    let fault = wrong(&format!("channels[{i}]"), name.get_ref(), "a word in quotes");
                    faults.value(section.path("channels").index(i), fault);
                }
            }
        }
    }
    Some(input)
}

fn anisotropy(
    value: &DeValue<'_>,
    path: &Path,
    folder: &File,
    faults: &mut Faults,
) -> Option<AnisotropyInput> {
    let Some(table) = value.as_table() else {
        let expected = "a table, such as { file = \"direction.png\", strength = 1.0 }";
        faults.value(path.clone(), wrong("anisotropy", value, expected));
        return None;
    };
    let section = Section::new(table, path, &ANISOTROPY, faults);
    let image = section.text("file", faults).map(|name| Source::File(folder.join(name)));
    let mut input = AnisotropyInput { image, ..AnisotropyInput::default() };
    set(&mut input.strength, section.number("strength", faults));
    set(&mut input.rotation, section.number("rotation", faults));
    set(&mut input.resample, section.word("resample", &SWITCH, faults));
    Some(input)
}

/// One word for both axes, or one each.
fn wraps(value: &DeValue<'_>, section: &Section<'_>, faults: &mut Faults) -> Option<[Wrap; 2]> {
    if value.as_str().is_some() {
        return section.word("wrap", &words::WRAPS, faults).map(|w| [w; 2]);
    }
    let items = section.list("wrap", "a word, or two, such as [\"repeat\", \"clamp\"]", faults)?;
    let word = |i: usize, faults: &mut Faults| {
        let got = items.get(i)?.get_ref().as_str()?;
        let found = words::WRAPS.iter().find(|(w, _)| *w == got).map(|(_, w)| *w);
        if found.is_none() {
            let fault = unknown_word("wrap", got, words::WRAPS.iter().map(|(w, _)| *w));
            faults.value(section.path("wrap").index(i), fault);
        }
        found
    };
    if items.len() != 2 || items.iter().any(|i| i.get_ref().as_str().is_none()) {
        let allowed = "two words, such as [\"repeat\", \"clamp\"]".to_owned();
        faults.value(section.path("wrap"), Fault::Count { key: "wrap", got: items.len(), allowed });
        return None;
    }
    let both = [word(0, faults), word(1, faults)];
    Some([both[0]?, both[1]?])
}

fn roughness(value: &DeValue<'_>, path: &Path, folder: &File, faults: &mut Faults) -> Option<RoughnessInput> {
    if let Some(name) = value.as_str() {
        return Some(RoughnessInput::new(folder.join(name)));
    }
    if let Some(number) = as_number(value) {
        return Some(RoughnessInput::Constant(number));
    }
    let Some(table) = value.as_table() else {
        let expected = "a number, a file, or a table such as { file = \"mr.png\", channel = \"G\" }";
        faults.value(path.clone(), wrong("roughness", value, expected));
        return None;
    };
    let section = Section::new(table, path, &ROUGHNESS, faults);
    let image = image_of(&section, folder, faults)?;
    let channel = section.text("channel", faults).unwrap_or_else(|| "G".to_owned());
    let space = section.word("space", &words::SPACES, faults).unwrap_or(Space::Linear);
    let gloss = section.word("holds", &[("roughness", false), ("gloss", true)], faults).unwrap_or(false);
    let from = section.get("from").and_then(|value| from(value, &section.path("from"), faults));
    Some(RoughnessInput::Image { image, channel, space, gloss, from })
}

fn from(value: &DeValue<'_>, path: &Path, faults: &mut Faults) -> Option<FromLobe> {
    let Some(table) = value.as_table() else {
        let expected = "a table, such as { lobe = \"blinn-phong\", range = [1, 1024], log = \"on\" }";
        faults.value(path.clone(), wrong("from", value, expected));
        return None;
    };
    let section = Section::new(table, path, &FROM, faults);
    let lobes: Vec<(&'static str, &'static Conversion)> = CONVERSIONS.iter().map(|c| (c.id, c)).collect();
    let conversion = section.word("lobe", &lobes, faults);
    let range = section.pair("range", faults);
    let log = section.word("log", &SWITCH, faults).unwrap_or(false);
    let by = section.word("rule", &words::RULES, faults).unwrap_or(By::Nearest);
    let angle = section.text("angle", faults);
    let second = match (section.text("second", faults), angle) {
        (Some(channel), angle) => Some(Second { channel, angle }),
        (None, None) => None,
        (None, Some(_)) => {
            let why = "an angle turns lobes of two numbers".to_owned();
            let remedy = Some("name the channel of the second number too: `second = \"G\"`");
            faults.value(section.path("angle"), Fault::Map { why, allowed: None, remedy });
            return None;
        }
    };
    Some(FromLobe { conversion: conversion?, range: range?, log, by, second })
}
