//! Is a baked file what it says of itself? Its numbers are re-integrated at seeded texels by the rules of the law `honest`, which share
//! nothing with the baker's; its laws, its axes and its stated error of reading are checked again. What is wrong is named.
//!
//! What is found: of faults in one texel of twenty, a sample of 135 texels misses less than one in a thousand; a single texel is met
//! with the probability that the sample has of the table ([`Sampled`]). Numbers count as wrong from three estimates plus the rounding of
//! their storage on.

mod between;
mod file;
mod lattice;
pub mod shipped;
mod stored;
mod suspect;

use crate::cancel::Cancel;
use crate::encode::read::{Claim, Image, Sample};
use crate::grid::Provenance;
use crate::grid::provenance::LawResult;
use crate::tables::{Role, place};
use crate::verify::honest::{self, LEAST, Looked};
use crate::verify::{self, Case, Outcome};
pub use file::{Beside, FileCheck, Verdict, check};
use serde::Serialize;
use stored::Stored;

/// How a file is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Which texels are looked at.
    pub seed: u64,
    /// Least number of texels; a smaller table is looked at as a whole.
    pub samples: usize,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
}

/// Texels that are looked at by default.
pub const SAMPLES: usize = LEAST;

/// What came of a table of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Recheck {
    /// Name of the table, if it has one.
    pub table: String,
    /// What is wrong, worst first.
    pub faults: Vec<Fault>,
    /// What was looked at.
    pub checks: Vec<Check>,
    /// Which texels were looked at, and what that finds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampled: Option<Sampled>,
}

/// Something that is wrong, by name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fault {
    /// Its name.
    pub fault: Kind,
    /// What was found, with the place of the worst texel.
    pub message: String,
}

/// What can be wrong with a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The file ends too early.
    Truncated,
    /// It cannot be read as a file of its container.
    Damaged,
    /// It has other bytes than its manifest lists.
    Changed,
    /// Numbers are not those of the table, and no rule is seen in it.
    Corrupted,
    /// The numbers have gone through a coarser storage.
    Requantised,
    /// Texels run the other way along an axis.
    Flipped,
    /// Two axes have changed places.
    AxesSwapped,
    /// Two channels have changed places.
    ChannelsSwapped,
    /// What the file says of itself is not so: other axes, channels, model or parameters.
    Mislabelled,
    /// A law that the file says was held is broken.
    Law,
    /// Reading between texels is further off than the file says.
    Reading,
}

impl Kind {
    /// In words, as in files.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Kind::Truncated => "truncated",
            Kind::Damaged => "damaged",
            Kind::Changed => "changed",
            Kind::Corrupted => "corrupted",
            Kind::Requantised => "requantised",
            Kind::Flipped => "flipped",
            Kind::AxesSwapped => "axes swapped",
            Kind::ChannelsSwapped => "channels swapped",
            Kind::Mislabelled => "mislabelled",
            Kind::Law => "law broken",
            Kind::Reading => "reading error above what is stated",
        }
    }
}

/// One thing that was looked at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What: `labels`, `values`, `laws`, `reading`, `hash`.
    pub check: &'static str,
    /// What came of it.
    pub result: LawResult,
    /// Figures, or why it was not checked.
    pub told: String,
}

/// Which texels were looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sampled {
    /// The seed.
    pub seed: u64,
    /// Texels that were judged.
    pub judged: usize,
    /// Texels of the table.
    pub texels: usize,
    /// The probability that a fault in one texel of twenty is found.
    pub finds_one_in_twenty: f64,
    /// The probability that a fault in a single texel is found.
    pub finds_one: f64,
}

impl Sampled {
    fn new(seed: u64, judged: usize, texels: usize) -> Sampled {
        // draws without replacement
        let missed = |bad: usize| -> f64 {
            (0..bad).map(|i| (texels - judged).saturating_sub(i) as f64 / (texels - i) as f64).product()
        };
        Sampled {
            seed,
            judged,
            texels,
            finds_one_in_twenty: 1.0 - missed(texels.div_ceil(20)),
            finds_one: judged as f64 / texels.max(1) as f64,
        }
    }
}

impl Recheck {
    /// A table of which nothing is known yet.
    #[must_use]
    pub fn new(table: &str) -> Recheck {
        Recheck { table: table.to_owned(), faults: Vec::new(), checks: Vec::new(), sampled: None }
    }

    /// One of which only a fault is known.
    #[must_use]
    pub fn fault(fault: Kind, message: String) -> Recheck {
        Recheck { faults: vec![Fault { fault, message }], ..Recheck::new("") }
    }

    /// One that was not looked at.
    #[must_use]
    pub fn unchecked(table: &str, why: &str) -> Recheck {
        let mut r = Recheck::new(table);
        r.note("values", LawResult::NotChecked, why.to_owned());
        r
    }

    /// Were numbers compared with others?
    #[must_use]
    pub fn is_checked(&self) -> bool {
        self.checks.iter().any(|c| c.check == "values" && c.result != LawResult::NotChecked)
    }

    /// Adds a fault.
    pub fn blame(&mut self, fault: Kind, message: String) {
        self.faults.push(Fault { fault, message });
    }

    /// Adds what came of a check.
    pub fn note(&mut self, check: &'static str, result: LawResult, told: String) {
        self.checks.push(Check { check, result, told });
    }
}

/// Checks every table of a picture that says what it holds. The result is of no use once the token is set.
#[must_use]
pub fn recheck(image: Image, asked: Asked<'_>) -> Vec<Recheck> {
    let named = matches!(&image.provenance, Some(Claim::Several(_)));
    if named && !image.channels.iter().all(|c| c.name.contains('.')) {
        return vec![Recheck::unchecked("", "several tables in one picture, which does not tell them apart")];
    }
    image.into_parts().into_iter().map(|image| table(&image, asked)).collect()
}

fn table(image: &Image, asked: Asked<'_>) -> Recheck {
    let Some(p) = image.known() else {
        let why = match &image.provenance {
            Some(Claim::Unknown { fault, .. }) => format!("its metadata are not understood: {fault}"),
            _ => "it does not say what it holds, and no manifest beside it does".to_owned(),
        };
        return Recheck::unchecked("", &why);
    };
    let mut r = Recheck::new(&p.name);
    let stored = match labels(image, p, &mut r) {
        Some(stored) => stored,
        None => return r,
    };
    if let Some((i, v)) = stored.table.values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        let n = stored.table.channels.len();
        let channel = &stored.table.channels[i % n].id;
        r.blame(Kind::Corrupted, format!("{channel} is {v} at {}", place(&stored.table.grid, i / n)));
        r.note("values", LawResult::Broken, "not finite".to_owned());
        return r;
    }
    let lattice = lattice::coarser(image, p);
    if let Some(message) = &lattice {
        r.blame(Kind::Requantised, message.clone());
    }
    values(&stored, asked, &mut r);
    if r.faults.is_empty() && asked.cancel.check().is_ok() {
        laws(&stored, p, asked, &mut r);
        between::check(&stored, p, asked, &mut r);
    } else {
        for check in ["laws", "reading"] {
            r.note(check, LawResult::NotChecked, "the numbers are not those of the table".to_owned());
        }
    }
    r
}

/// Does what the file says fit its picture and itself? Nothing where the numbers cannot be compared with anything.
fn labels(image: &Image, p: &Provenance, r: &mut Recheck) -> Option<Stored> {
    let told = p.encoding.as_ref().map_or("", |e| e.storage.as_str());
    let other = |s: Sample| s.id() != told && !told.is_empty();
    if let Some(plane) = image.channels.iter().find(|c| other(c.sample)) {
        let stored = plane.sample.id();
        r.blame(
            Kind::Requantised,
            format!("the metadata says {told}, channel `{}` is stored as {stored}", plane.name),
        );
    }
    let broken = |l: &&crate::grid::provenance::LawRecord| l.result == LawResult::Broken;
    if p.verified
        && (p.laws.iter().any(|l| broken(&l)) || !p.waived.is_empty() || p.tolerance_met == Some(false))
    {
        r.blame(
            Kind::Mislabelled,
            "it says that it is verified, although laws are broken or waived or the tolerance is missed"
                .to_owned(),
        );
    }
    for contradiction in image.contradictions().into_iter().filter(|c| !c.starts_with("the metadata says")) {
        r.blame(Kind::Mislabelled, contradiction);
    }
    let shape =
        r.faults.iter().any(|f| f.fault == Kind::Mislabelled && f.message.contains("the picture has"));
    let stored = (!shape).then(|| Stored::new(image, p));
    if let Some(Err(why)) = &stored {
        r.blame(Kind::Mislabelled, why.clone());
    }
    let stored = stored.and_then(Result::ok);
    if let Some(stored) = &stored {
        for lie in stored.lies(p) {
            r.blame(Kind::Mislabelled, lie);
        }
    }
    let result = if r.faults.is_empty() { LawResult::Held } else { LawResult::Broken };
    r.note("labels", result, "size, channels, storage, formulas of the axes".to_owned());
    if stored.is_none() {
        r.note("values", LawResult::NotChecked, "what the file says of itself cannot be followed".to_owned());
    }
    stored
}

fn case<'a>(stored: &'a Stored, asked: Asked<'a>) -> Case<'a> {
    Case { bound: &stored.bound, table: &stored.table, tolerance: stored.tolerance, cancel: asked.cancel }
}

/// One of so many texels is looked at first.
const FIRST: usize = 4;

/// Compares seeded texels with the independent rules, and names what is wrong.
fn values(stored: &Stored, asked: Asked<'_>, r: &mut Recheck) {
    let case = case(stored, asked);
    // the density is that of the direction before it was rounded
    let directions = stored.bound.spec.roles().iter().any(|r| matches!(r, Role::DirectionDensity(_)));
    if directions || !honest::concerns(&stored.bound.spec) {
        return refitted(stored, asked, r);
    }
    let rows = honest::rows(&stored.table.grid, asked.seed, asked.samples);
    // where half of a first part of the texels is wrong, the others need not be asked
    let (first, rest): (Vec<_>, Vec<_>) = rows.iter().cloned().enumerate().partition(|(i, _)| i % FIRST == 0);
    let of = |rows: Vec<(usize, honest::Row)>| {
        let rows: Vec<honest::Row> = rows.into_iter().map(|(_, row)| row).collect();
        honest::look(&case, &stored.slack, &rows)
    };
    let count = |looked: &[Looked]| {
        let broken = looked.iter().filter(|l| l.watch.is_broken()).count();
        (looked.iter().filter(|l| l.judged).count(), broken)
    };
    let mut looked = of(first);
    let (judged, bad) = count(&looked);
    if 2 * bad < judged || judged == 0 {
        looked.extend(of(rest));
    }
    let (judged, bad) = count(&looked);
    r.sampled = Some(Sampled::new(asked.seed, judged, stored.table.grid.len()));
    match honest::outcome(looked) {
        Outcome::Held(seen) => {
            r.note(
                "values",
                LawResult::Held,
                format!("{} numbers of {judged} texels re-integrated", seen.checked),
            );
        }
        Outcome::NotChecked(why) => r.note("values", LawResult::NotChecked, why),
        Outcome::Broken(seen) => {
            r.note("values", LawResult::Broken, format!("{bad} of {judged} texels: {}", seen.at));
            if r.faults.iter().any(|f| f.fault == Kind::Requantised) {
                return;
            }
            let (fault, words) = suspect::name(stored, asked, &rows, bad, judged);
            r.blame(fault, format!("{words}; worst: {}", seen.at));
        }
    }
}

/// Parameters of fits have no independent rule, and what is told of a rounded direction has none: the numbers are made again.
fn refitted(stored: &Stored, asked: Asked<'_>, r: &mut Recheck) {
    const TEXELS: usize = 16;
    let rows = honest::rows(&stored.table.grid, asked.seed, asked.samples.min(TEXELS));
    let texels: Vec<usize> =
        rows.iter().filter_map(|row| row.first().copied()).take(asked.samples.min(TEXELS)).collect();
    let looked: Vec<Looked> = stored.again(&texels, asked.cancel);
    let judged = looked.iter().filter(|l| l.judged).count();
    r.sampled = Some(Sampled::new(asked.seed, judged, stored.table.grid.len()));
    let told = "made again by the baker's own rule: no independent one judges rounded numbers";
    match honest::outcome(looked) {
        Outcome::Held(_) => r.note("values", LawResult::Held, format!("{judged} texels {told}")),
        Outcome::NotChecked(why) => r.note("values", LawResult::NotChecked, why),
        Outcome::Broken(seen) => {
            r.note("values", LawResult::Broken, format!("{}; {told}", seen.at));
            r.blame(
                Kind::Corrupted,
                format!("numbers are not those that the baker makes; worst: {}", seen.at),
            );
        }
    }
}

/// Laws of sums over texels, in which the rounding of all of them adds up: they are those of the integrals.
const OF_SUMS: [&str; 3] = ["total", "lobe", "normalised"];

/// The laws of the kind, on the numbers as they are stored.
fn laws(stored: &Stored, p: &Provenance, asked: Asked<'_>, r: &mut Recheck) {
    if stored.fitted {
        let why = "the texels are fitted to their reader: laws are those of the integrals".to_owned();
        return r.note("laws", LawResult::NotChecked, why);
    }
    // a stored number is as good as its estimate and its rounding
    let errors = stored.table.errors.iter().zip(&stored.slack).map(|(e, s)| e + s).collect();
    let table = crate::grid::Table { errors, ..stored.table.clone() };
    let case = Case { table: &table, ..case(stored, asked) };
    let (mut held, mut unchecked) = (0, Vec::new());
    for law in verify::declared(&stored.bound.spec).filter(|l| l.id != honest::LAW.id) {
        if OF_SUMS.contains(&law.id) {
            unchecked.push(law.id);
            continue;
        }
        match (law.check)(&case) {
            Outcome::Held(_) => held += 1,
            Outcome::NotChecked(_) => unchecked.push(law.id),
            Outcome::Broken(seen) => {
                let waived = p.waived.iter().any(|w| w.law == law.id);
                let known = p.laws.iter().any(|l| l.law == law.id && l.result == LawResult::Broken);
                if !(waived || known) {
                    r.blame(Kind::Law, format!("{}: {} at {}", law.id, law.statement, seen.at));
                }
            }
        }
    }
    let broken = r.faults.iter().any(|f| f.fault == Kind::Law);
    let mut told = format!("{held} held");
    if !unchecked.is_empty() {
        told += &format!(", not checked: {}", unchecked.join(", "));
    }
    r.note("laws", if broken { LawResult::Broken } else { LawResult::Held }, told);
}
