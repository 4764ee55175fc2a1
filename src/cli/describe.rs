//! `brdfbake describe ID`: everything that the registries know of a model, function, table, preset, engine, law, quantity
//! or container.

use super::{Exit, Failure, engine, output};
use crate::encode::{self, Encoder};
use crate::functions::{self, FunctionInfo};
use crate::grid::quantity::unit_words;
use crate::grid::{Axis, Quantity};
use crate::math::figures::exact;
use crate::models::{self, DefaultValue, Kind, ModelInfo, Param};
use crate::recipe::{self, ENGINES, PRESETS};
use crate::tables::{self, Layout, ModelUse, Selection, Setting, TableInfo, source};
use crate::verify;

/// Shown behind the help.
const EXAMPLES: &str = concat!("Examples:", "\n  brdfbake describe ggx", "\n  brdfbake describe dfg",);

/// Arguments of `describe`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Id of a model, function, table, preset, engine, law, quantity or container.
    id: String,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] if nothing has this id.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let id = args.id.as_str();
    let mut parts = Vec::new();
    parts.extend(models::find(id).map(|(m, _)| model(m)));
    parts.extend(functions::find(id).map(|(f, _)| function(f)));
    parts.extend(tables::find(id).map(table));
    parts.extend(
        PRESETS.iter().find(|p| p.id == id).map(|p| format!("preset {}\n{}\n\n{}", p.id, p.doc, p.source)),
    );
    parts.extend(recipe::engine(id).map(engine::page));
    parts.extend(verify::find(id).map(law));
    parts.extend(Quantity::find(id).map(quantity));
    parts.extend(encode::encoder(id).map(format));
    if parts.is_empty() {
        let ids = || {
            let models = models::MODELS.iter().map(|m| m.id).chain(functions::all().map(|f| f.id));
            let tables = tables::TABLES.iter().map(|t| t.id);
            let formats = encode::ENCODERS.iter().map(|e| e.id());
            let engines = ENGINES.iter().map(|e| e.id);
            let rest = PRESETS
                .iter()
                .map(|p| p.id)
                .chain(engines)
                .chain(verify::LAWS.iter().map(|l| l.id))
                .chain(formats);
            models.chain(tables).chain(rest)
        };
        let hint = crate::math::nearest::hint(id, ids());
        return Err(Failure::input(format!(
            "nothing is called `{id}`{hint}; `brdfbake list models` and `list functions` list what there is"
        )));
    }
    output::data(&parts.join("\n"))?;
    Ok(Exit::Done)
}

/// The page of a model.
#[must_use]
pub fn model(m: &ModelInfo) -> String {
    let claims = [
        (m.laws.reciprocal, "reciprocal"),
        (m.laws.passive, "passive (E <= 1)"),
        (m.laws.isotropic, "isotropic"),
    ];
    let yes: Vec<&str> = claims.iter().filter(|c| c.0).map(|c| c.1).collect();
    let no: Vec<String> = claims.iter().filter(|c| !c.0).map(|c| format!("not {}", c.1)).collect();
    let mut text = format!("model {}\n{}\n\n  {}\n\n", m.id, m.title, m.formula);
    text.push_str(&params(m.params));
    text.push_str(&format!(
        "laws: {}\n",
        yes.iter().map(|s| (*s).to_owned()).chain(no).collect::<Vec<_>>().join(", ")
    ));
    text.push_str(&format!("notes: {}\n", m.notes));
    if !m.also.is_empty() {
        let names: Vec<&str> = m.also.iter().map(|a| a.name).collect();
        text.push_str(&format!("also called: {}\n", names.join(", ")));
    }
    text.push_str(&known(m.known));
    text.push_str(&sources(&m.source_lines()));
    text
}

/// The page of a function.
#[must_use]
pub fn function(f: &FunctionInfo) -> String {
    let mut text = format!("function {}\n{}\n\n  {}\n\n", f.id, f.title, f.formula);
    text.push_str(&params(f.params));
    let inputs: Vec<String> = f
        .inputs
        .iter()
        .map(|i| i.columns())
        .map(|(columns, meaning)| format!("{} = {meaning}", columns.join(", ")))
        .collect();
    let inputs =
        if inputs.is_empty() { "none; the columns may be blank".to_owned() } else { inputs.join("; ") };
    text.push_str(&format!("angles, in radians: {inputs}\n"));
    let unit = unit_words(f.unit).unwrap_or("1");
    text.push_str(&format!("value: in {}, unit {unit}\n", interval(f.range)));
    text.push_str(&format!("notes: {}\n", f.notes));
    if !f.also.is_empty() {
        let names: Vec<&str> = f.also.iter().map(|a| a.name).collect();
        text.push_str(&format!("also called: {}\n", names.join(", ")));
    }
    text.push_str(&known(f.known));
    text.push_str(&sources(&f.source_lines()));
    text
}

/// The page of a table kind.
#[must_use]
pub fn table(t: &TableInfo) -> String {
    let mut text = format!("table {}\n{}\n\n  {}\n\nlayouts:\n", t.id, t.title, t.formula);
    for layout in t.layouts {
        text.push_str(&format!("  {}: {}\n", layout.id, layout.doc));
        for c in layout.channels {
            text.push_str(&format!("    {} in {}: {}\n", c.id, interval(c.range), c.meaning));
        }
    }
    if !t.mix.extra().is_empty() {
        text.push_str("more channels, to be named in `channels = [..]` with those above:\n");
        for c in t.mix.extra() {
            text.push_str(&format!("  {} in {}: {}\n", c.id, interval(c.range), c.meaning));
        }
    }
    text.push_str(&match t.model {
        ModelUse::None => "model: none\n".to_owned(),
        ModelUse::Any(default) => format!("model: any, default {default}\n"),
        ModelUse::Split(default) => {
            let all: Vec<&str> = models::MODELS.iter().filter(|m| m.splits).map(|m| m.id).collect();
            format!("model: one whose Fresnel factor splits off ({}), default {default}\n", all.join(", "))
        }
    });
    if !t.coordinates.is_empty() {
        text.push_str(&format!("needs axes for: {}\n", t.coordinates.join(", ")));
    }
    text.push_str(&default_axes(t));
    text.push_str(&params(t.params));
    text.push_str(&format!("laws checked: {}\nnotes: {}\n", t.laws.join(", "), t.notes));
    text.push_str(&sources(&source::all(t)));
    text
}

/// The axes of each layout, those of the first one for all that share them.
fn default_axes(t: &TableInfo) -> String {
    let model = match t.model {
        ModelUse::None => None,
        ModelUse::Any(id) | ModelUse::Split(id) => models::find(id).map(|(info, _)| info),
    };
    let lines = |layout: &Layout| -> String {
        let layout = Selection::from(layout);
        let axes = t.default_axes(Setting { layout: &layout, model, given: None });
        let line = |axis: &Axis| {
            let clamp = axis.clamp.map_or_else(String::new, |c| format!(", clamped to {}", interval(c)));
            format!(
                "  {} in {}{clamp}, {} texels, {:?}, texture coordinate {}\n",
                axis.quantity.id,
                interval(axis.domain),
                axis.len,
                axis.texel,
                axis.coordinate_formula()
            )
        };
        axes.iter().map(line).collect()
    };
    let first = t.layouts.first().map(lines).unwrap_or_default();
    let mut text = format!("default axes:\n{first}");
    for layout in t.layouts.iter().skip(1) {
        let own = lines(layout);
        if own != first {
            text.push_str(&format!("default axes of layout {}:\n{own}", layout.id));
        }
    }
    text
}

fn law(l: &'static verify::Law) -> String {
    format!("law {} (finding BB{:04})\n{}\nmargin: {}\n", l.id, l.code, l.statement, l.margin)
}

fn format(e: &'static dyn Encoder) -> String {
    let mut text = format!(
        "container {}\nfiles *.{}, at most {} channels\nstorages:\n",
        e.id(),
        e.extension(),
        e.most_channels()
    );
    for s in e.storages() {
        let limit = s.most_channels().map_or_else(String::new, |n| format!("at most {n} channels, "));
        text.push_str(&format!(
            "  {}:{} ({limit}default tolerance {}): {}\n",
            e.id(),
            s.id(),
            exact(s.default_tolerance()),
            s.meaning()
        ));
    }
    for o in e.options() {
        text.push_str(&format!("option +{}: {}\n", o.id(), o.meaning()));
    }
    let yes = |b: bool| if b { "yes" } else { "no" };
    text.push_str(&format!("holds the provenance: {}\n", yes(e.holds_metadata())));
    text.push_str(&format!("read by inspect and diff: {}\n", yes(!e.magic().is_empty())));
    text
}

fn quantity(q: &'static Quantity) -> String {
    let base = q.base_formula().map_or_else(String::new, |f| format!("\n{f}"));
    format!(
        "quantity {}, symbol {}, unit {}\n{}; domain {}{base}\n",
        q.id,
        q.symbol,
        q.unit_words().unwrap_or("1"),
        q.meaning,
        interval(q.domain)
    )
}

/// `[0, infinity]`: the largest number of f64 stands for no bound.
fn interval(range: [f64; 2]) -> String {
    let end = |v: f64| match v {
        _ if v.abs() < f64::MAX => exact(v),
        _ if v < 0.0 => "-infinity".to_owned(),
        _ => "infinity".to_owned(),
    };
    format!("[{}, {}]", end(range[0]), end(range[1]))
}

fn params(params: &[Param]) -> String {
    if params.is_empty() {
        return "parameters: none\n".to_owned();
    }
    let mut text = "parameters:\n".to_owned();
    for p in params {
        let range = match p.kind {
            Kind::Number { min, max, preset } => {
                let default = match preset {
                    DefaultValue::Value(v) => exact(v),
                    DefaultValue::Of(id) => id.to_owned(),
                };
                let unit = unit_words(p.unit).map_or_else(String::new, |u| format!(" {u}"));
                let list = if p.coloured { ", or a list of three: red, green, blue" } else { "" };
                format!("{}{unit}{list}, default {default}", interval([min, max]))
            }
            Kind::Choice(words) => format!("{}; default {}", words.join(" | "), words.first().unwrap_or(&"")),
            Kind::Rows { columns, preset } => {
                let columns: Vec<String> =
                    columns.iter().map(|c| format!("{} in {}", c.id, interval([c.min, c.max]))).collect();
                format!("list of rows ({}), default {preset:?}", columns.join(", "))
            }
        };
        text.push_str(&format!("  {} ({range}): {}\n", p.id, p.doc));
    }
    text
}

fn known(values: &[models::Known]) -> String {
    let mut text = "known values:\n".to_owned();
    for k in values {
        let set: Vec<String> = k.params.iter().map(|(a, b)| format!("{a} = {b}")).collect();
        text.push_str(&format!("  {:?} at {}: {} ({})\n", k.what, set.join(", "), exact(k.value), k.source));
    }
    text
}

fn sources(lines: &[String]) -> String {
    let mut text = "sources:\n".to_owned();
    for line in lines {
        text.push_str(&format!("  {line}\n"));
    }
    text
}
