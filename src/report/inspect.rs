//! Everything that a picture file holds, as text.

use super::text::{Lines, counted, number};
use crate::encode::{
    self,
    read::{Claim, Image, Plane},
};
use crate::grid::provenance::{AxisRecord, Integration, LawRecord, LawResult, Spread, Subject};
use crate::grid::table::{Extreme, place};
use crate::grid::{Direction, Provenance, Texel};

/// What a file holds. `name` is how the caller calls it. The text ends with a newline.
#[must_use]
pub fn inspect(name: &str, image: &Image) -> String {
    let mut lines = Lines::default();
    let channels = counted(image.channels.len(), "channel");
    lines.plain(&format!("{name}: {}, {} x {} pixels, {channels}", image.format, image.width, image.height));
    for warning in &image.warnings {
        lines.item("warning", warning);
    }
    match &image.provenance {
        Some(Claim::Known(p)) => {
            for contradiction in image.contradictions() {
                lines.item("warning", &contradiction);
            }
            provenance(&mut lines, p);
            planes(&mut lines, image, Some(p));
            quality(&mut lines, p);
        }
        Some(Claim::Several(tables)) => {
            planes(&mut lines, image, None);
            for (i, p) in tables.iter().enumerate() {
                lines.plain(&format!("Table {} of {}, {}", i + 1, tables.len(), p.name));
                provenance(&mut lines, p);
                quality(&mut lines, p);
            }
        }
        Some(Claim::Unknown { text, fault }) => {
            planes(&mut lines, image, None);
            if super::inspect_map::map(&mut lines, text) {
                super::inspect_map::histograms(&mut lines, image);
            } else {
                lines.plain("The file has brdfbake metadata that this version does not understand:");
                lines.item("reason", fault);
                lines.item("text", &text.chars().take(2000).collect::<String>());
            }
        }
        None => {
            planes(&mut lines, image, None);
            lines.plain("Nothing in the file says what it holds: no axes, no channels' meaning, no error.");
        }
    }
    lines.finish()
}

/// What the table is and where its texels are.
fn provenance(lines: &mut Lines, p: &Provenance) {
    lines.plain("Table");
    lines.item("name", &p.name);
    subject(lines, "kind", &p.table);
    if let Some(model) = &p.model {
        lines.plain("Model");
        subject(lines, "id", model);
    }
    lines.plain("Axes, fastest first");
    for (i, record) in p.axes.iter().enumerate() {
        axis(lines, ["x", "y", "z", "z (outer)"].get(i).unwrap_or(&"?"), record);
    }
}

fn subject(lines: &mut Lines, label: &str, s: &Subject) {
    lines.item(label, &format!("{}: {}", s.id, s.title));
    lines.item("formula", &s.formula);
    let params = s.params.iter().map(|(k, v)| format!("{k} = {v}")).collect::<Vec<_>>().join(", ");
    lines.item("parameters", if params.is_empty() { "none" } else { &params });
    lines.item("sources", &s.sources.join("\n"));
}

fn axis(lines: &mut Lines, letter: &str, r: &AxisRecord) {
    let a = &r.axis;
    let [lo, hi] = a.domain.map(number);
    let unit = if r.unit == "1" { String::new() } else { format!(" {}", r.unit) };
    lines.item(
        letter,
        &format!("{} ({}) in [{lo}, {hi}]{unit}, {}", a.quantity.id, r.symbol, a.quantity.meaning),
    );
    let texel = match a.texel {
        Texel::Center => "at their centres: index i is coordinate (i + 1/2) / n",
        Texel::Endpoint => "with the first and last on the ends: index i is coordinate i / (n - 1)",
    };
    let direction = match a.direction {
        Direction::Ascending => "the low end first",
        Direction::Descending => "the high end first",
    };
    lines.item("", &format!("{} {texel}, {direction}", counted(a.len, "texel")));
    lines.item("", &format!("texture coordinate {letter} = {}", r.coordinate));
    if let Some(base) = &r.base {
        lines.item("", base);
    }
    if a.offset.abs() > 0.0 {
        lines.item("", &format!("shifted by {} texels", number(a.offset)));
    }
    if let Some([lo, hi]) = a.clamp {
        lines.item("", &format!("values clamped to [{}, {}]", number(lo), number(hi)));
    }
}

/// What the samples are, measured, and what they mean if that is known.
fn planes(lines: &mut Lines, image: &Image, p: Option<&Provenance>) {
    lines.plain("Channels");
    // Most containers have no names: say which component of the pixel it is.
    let encoder = encode::encoder(image.format).filter(|_| p.is_some());
    let colours = encoder.map_or(&[][..], |e| e.colours(image.channels.len()));
    for (i, plane) in image.channels.iter().enumerate() {
        let colour = colours.get(i).map_or_else(String::new, |c| format!("{c}, "));
        lines.item(&plane.name, &format!("{colour}{}", measured(plane)));
        if let Some(channel) = p.and_then(|p| p.channels.iter().find(|c| c.id == plane.name)) {
            let [lo, hi] = channel.range.map(number);
            lines.item("", &format!("{}\nrange [{lo}, {hi}]", channel.meaning));
        }
    }
}

fn measured(plane: &Plane) -> String {
    let s = plane.statistics();
    let mut text = plane.sample.id().to_owned();
    if s.finite > 0 {
        text += &format!(", min {}, max {}, mean {}", number(s.min), number(s.max), number(s.mean));
    }
    if s.nan > 0 {
        text += &format!(", {}", counted(s.nan, "NaN"));
    }
    if s.infinite > 0 {
        text += &format!(", {} infinite", s.infinite);
    }
    text
}

/// How good the table is: errors, laws, and where it came from.
fn quality(lines: &mut Lines, p: &Provenance) {
    integration(lines, &p.integration);
    for r in &p.residuals {
        lines.item("fit", &format!("{}: {}", r.meaning, spread(&r.spread)));
    }
    if let Some(e) = &p.encoding {
        lines
            .item("stored as", &format!("{}, rounding error at most {}", e.storage, number(e.largest_error)));
        if !e.names.is_empty() {
            lines.item("", &format!("channels are named {} in the file", e.names.join(", ")));
        }
        if !e.fill.is_empty() {
            let fill = e.fill.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", ");
            lines.item("", &format!("components without channel hold {fill}"));
        }
    }
    if let Some(s) = &p.size {
        let warps = if s.warps_searched { ", with other warps tried" } else { "" };
        lines.item(
            "size",
            &format!(
                "found for an error of reading of {} over the {} domain{warps}; {} reached",
                number(s.error),
                s.domain,
                number(s.reached)
            ),
        );
    }
    if let Some(t) = &p.texels {
        lines.item("texels", &format!("{}: {}", t.held, t.meaning));
        for c in &t.by_channel {
            lines.item("", &format!("{}: {}", c.channel, c.held));
        }
        match t.asked.as_str() {
            "auto" => {
                lines.item("", "chosen because it reads better by every measure, or exact where nothing does")
            }
            asked if asked != t.held => lines.item("", &format!("{asked} was asked for and reads no better")),
            _ => {}
        }
        let (n, change) = (t.samples, number(t.largest_change));
        lines.item("", &format!("fitted to {n} integrals, at most {change} from the values at their places"));
        for c in &t.choices {
            lines.item("", &format!("{} texels, whole domain: {}", c.texels, spread(&c.whole)));
            if let Some(practical) = &c.practical {
                lines.item(
                    "",
                    &format!(
                        "{} texels, practical (mu >= 0.05, roughness >= 0.09): {}",
                        c.texels,
                        spread(practical)
                    ),
                );
            }
        }
    }
    if let Some(r) = &p.reconstruction {
        lines.plain("Reading between texels, against fresh integrals");
        lines.item("filter", &format!("{}, {} points", r.filter, r.points));
        lines.item("whole domain", &spread(&r.whole));
        if let Some(practical) = &r.practical {
            lines.item("practical", &format!("{} (mu >= 0.05, roughness >= 0.09)", spread(practical)));
        }
    }
    lines.plain("Laws");
    for l in &p.laws {
        lines.item(&l.law, &law(l, p));
    }
    if p.laws.is_empty() {
        lines.item("none", "no law was checked");
    }
    for w in p.waived.iter().filter(|w| p.laws.iter().all(|l| l.law != w.law)) {
        lines.item(&w.law, &format!("waived: {}", w.reason));
    }
    let met = match p.tolerance_met {
        Some(true) => "met by every texel",
        Some(false) => "missed by some texels",
        None => "not stated",
    };
    lines.item("tolerance", met);
    lines.item("verified", &verdict(p));
    lines.plain("Origin");
    lines.item("made by", &format!("{}, metadata version {}", p.tool, p.schema));
    lines.item("recipe", &format!("{}, hash {}", p.recipe.name, p.recipe.hash));
}

/// Is the table verified, and if not, why not?
fn verdict(p: &Provenance) -> String {
    let broken = p.laws.iter().any(|l| l.result == LawResult::Broken);
    if p.verified && (broken || !p.waived.is_empty()) {
        return "yes, although laws were waived: the file contradicts itself".to_owned();
    }
    if p.verified && p.schema < 2 {
        return "yes, as metadata version 1 means it: a law that found nothing to check counts as held"
            .to_owned();
    }
    if p.verified {
        return "yes".to_owned();
    }
    let mut why = Vec::new();
    if !p.waived.is_empty() {
        why.push("laws were waived, for the reasons above");
    }
    if p.tolerance_met == Some(false) {
        why.push("texels miss the tolerance");
    }
    if why.is_empty() {
        why.push("no law that says what the numbers mean was held");
    }
    format!("no: {}", why.join("; "))
}

fn integration(lines: &mut Lines, i: &Integration) {
    lines.plain("Integration");
    lines.item("rule", &i.rule);
    lines.item("tolerance", &number(i.tolerance));
    lines.item("largest error", &extreme(&i.largest_error));
    lines.item("evaluations", &i.evaluations.to_string());
    lines.item("missed", &format!("{} texels are above the tolerance", i.missed));
}

fn extreme(e: &Extreme) -> String {
    let at = if e.at.is_empty() { String::new() } else { format!(" at {}", place(&e.at)) };
    format!("{} in {}{at}", number(e.value), e.channel)
}

fn spread(s: &Spread) -> String {
    format!("largest {}, mean {}", extreme(&s.largest), number(s.mean))
}

fn law(l: &LawRecord, p: &Provenance) -> String {
    let at = if l.at.is_empty() { String::new() } else { format!(" at {}", l.at) };
    let waived = p.waived.iter().find(|w| w.law == l.law);
    let waived = waived.map_or(String::new(), |w| format!("; waived: {}", w.reason));
    let why = l.why.as_ref().map_or(String::new(), |why| format!(": {why}"));
    match l.result {
        LawResult::NotChecked => format!("NOT CHECKED{why}{waived}"),
        result => {
            let outcome = if result == LawResult::Held { "holds" } else { "BROKEN" };
            let margin = l.margin.map_or("beyond all numbers".to_owned(), number);
            let seen = if l.checked > 0 { format!(", {} judged", l.checked) } else { String::new() };
            let unseen = if l.unchecked > 0 { format!(", {} not{why}", l.unchecked) } else { String::new() };
            format!("{outcome}, margin {margin}{at}{seen}{unseen}{waived}")
        }
    }
}
