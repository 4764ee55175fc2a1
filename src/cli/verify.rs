//! `brdfbake verify PATH...`: is a baked file what it says of itself, and does a folder hold what its manifest says?

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::ReadError;
use crate::encode::read::load_until;
use crate::grid::provenance::LawResult;
use crate::grid::table::{Extreme, place};
use crate::math::figures::significant;
use crate::pipeline::audit::{self, Activity, Audit, AuditError, Origin, State, Verdict as FolderVerdict};
use crate::pipeline::recheck::shipped::{Shipped, ShippedError, compare};
use crate::pipeline::recheck::{self, Asked, Beside, FileCheck, Recheck, SAMPLES, Verdict};
use std::path::{Path, PathBuf};

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake verify textures",
    "\n  brdfbake verify textures/small.exr --samples 500",
);

/// Arguments of `verify`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Baked files, and output folders with their manifest.json.
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// Seed of the texels that are re-integrated.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Least number of texels of each table that are re-integrated; a smaller table is as a whole.
    #[arg(long, value_name = "N", default_value_t = SAMPLES)]
    samples: usize,
    /// Compare files that an engine ships, as it reads them, with the integrals that they stand for.
    #[arg(long, value_name = "ENGINE", conflicts_with_all = ["hashes", "strict", "seed", "samples"])]
    engine: Option<String>,
    /// Which table of the engine, where several have the size of the file.
    #[arg(long, value_name = "NAME", requires = "engine", conflicts_with_all = ["hashes", "strict", "seed", "samples"])]
    table: Option<String>,
    /// Of folders, compare the bytes of the files alone.
    #[arg(long, conflicts_with_all = ["seed", "samples"])]
    hashes: bool,
    /// Files of a folder that its manifest does not name fail, too.
    #[arg(long)]
    strict: bool,
    /// Print the result as JSON, an object a line for each path.
    #[arg(long)]
    json: bool,
    /// Print nothing; the exit code tells.
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
}

/// Runs it: exit code 0 if nothing is wrong, 4 if something is, 3 if nothing of a file could be checked.
///
/// # Errors
/// [`Failure`] for a folder without manifest, a file of no container that is known, or what cannot be read.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    if args.samples == 0 {
        return Err(Failure::new(Exit::Usage, "--samples 0: at least one texel is looked at"));
    }
    if let Some(engine) = &args.engine {
        return shipped(engine, args, cancel);
    }
    if (args.hashes || args.strict) && args.paths.iter().all(|p| p.is_file()) {
        let option = if args.hashes { "--hashes" } else { "--strict" };
        return Err(Failure::usage(format!(
            "{option} says how folders are checked, but only files are given; name a folder"
        )));
    }
    let mut exit = Exit::Done;
    for path in &args.paths {
        let found = if path.is_file() { file(path, args, cancel)? } else { folder(path, args, cancel)? };
        exit = match (exit, found) {
            (Exit::Failed, _) | (_, Exit::Failed) => Exit::Failed,
            (Exit::Input, _) | (_, Exit::Input) => Exit::Input,
            _ => Exit::Done,
        };
    }
    Ok(exit)
}

fn asked<'a>(args: &Args, cancel: &'a Cancel) -> Asked<'a> {
    Asked { seed: args.seed, samples: args.samples, cancel }
}

fn file(path: &Path, args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let beside = Beside::load(path.parent().unwrap_or(Path::new("")));
    let check = recheck::check(path, &beside, asked(args, cancel)).map_err(|e| unread(path, e))?;
    cancel.check()?;
    if args.json {
        output::data(&json(&check)?)?;
    } else if !args.quiet {
        output::data(&file_text(&path.display().to_string(), &check))?;
    }
    Ok(match check.verdict {
        Verdict::Whole | Verdict::BytesWhole => Exit::Done,
        Verdict::Faulty => Exit::Failed,
        Verdict::NotChecked => Exit::Input,
    })
}

fn folder(path: &Path, args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let audit = audit::audit(path).map_err(failure)?;
    let mut checks = Vec::new();
    if !args.hashes {
        let beside = Beside::load(path);
        for listed in audit.files.iter().filter(|f| f.state != State::Missing) {
            let file = path.join(&listed.file);
            match recheck::check(&file, &beside, asked(args, cancel)) {
                Ok(check) => checks.push(check),
                // of no container any more: the hash tells
                Err(ReadError::Unknown(_)) => {}
                Err(e) => return Err(unread(&file, e)),
            }
            cancel.check()?;
        }
    }
    let verdict = audit.verdict();
    if args.json {
        let mut value = serde_json::to_value(&audit).map_err(|e| Failure::new(Exit::Internal, e))?;
        value["verdict"] = serde_json::to_value(verdict).map_err(|e| Failure::new(Exit::Internal, e))?;
        value["checked"] = serde_json::to_value(&checks).map_err(|e| Failure::new(Exit::Internal, e))?;
        output::data(&value.to_string())?;
    } else if !args.quiet {
        let mut lines = folder_lines(&audit);
        lines.extend(checks.iter().flat_map(|c| faults(&c.file, c)));
        lines.extend(summary(&checks));
        lines.push(verdict_line(&path.display().to_string(), &audit));
        output::data(&lines.join("\n"))?;
    }
    let foreign = args.strict && !audit.foreign.is_empty();
    let faulty = checks.iter().any(|c| c.verdict == Verdict::Faulty);
    Ok(if verdict != FolderVerdict::Whole || foreign || faulty { Exit::Failed } else { Exit::Done })
}

/// Files of an engine. How far off they are is told, not judged; a convention that is not the reader's fails.
fn shipped(engine: &str, args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let (engine, plan) = super::engine::plan(engine)?;
    let mut exit = Exit::Done;
    for path in &args.paths {
        let bytes = load_until(cancel, path).map_err(|e| unread(path, e))?;
        let found =
            compare((engine.id, &plan), &bytes, args.table.as_deref(), cancel).map_err(|e| match e {
                ShippedError::Cancelled(stopped) => stopped.into(),
                ShippedError::Read(e) => unread(path, e),
                e => Failure::input(format!("{}: {e}", path.display())),
            })?;
        if !found.conventions.is_empty() {
            exit = Exit::Failed;
        }
        if args.json {
            output::data(&json(&found)?)?;
        } else if !args.quiet {
            output::data(&shipped_text(&path.display().to_string(), &found))?;
        }
    }
    Ok(exit)
}

fn shipped_text(name: &str, s: &Shipped) -> String {
    let at = |e: &Extreme| format!("{} in {} at {}", significant(e.value, 3), e.channel, place(&e.at));
    let mut lines = vec![format!("{name}: {} of {}, blake3 {}", s.table, s.engine, s.blake3)];
    let whole = &s.read.whole;
    lines.push(format!(
        "  as the engine reads it: {}; mean {}",
        at(&whole.largest),
        significant(whole.mean, 3)
    ));
    if let Some(p) = &s.read.practical {
        let mean = significant(p.mean, 3);
        lines.push(format!("  mu >= 0.05, roughness >= 0.09: {}; mean {mean}", at(&p.largest)));
    }
    lines.push(format!("  at the texels: {}; mean {}", at(&s.texels), significant(s.mean, 3)));
    lines.extend(s.conventions.iter().map(|c| format!("  convention: {c}")));
    lines.join("\n")
}

fn json(value: &impl serde::Serialize) -> Result<String, Failure> {
    serde_json::to_string(value).map_err(|e| Failure::new(Exit::Internal, e))
}

/// Everything that is known of a file.
fn file_text(name: &str, check: &FileCheck) -> String {
    let verdict = match check.verdict {
        Verdict::Whole => "whole, as far as it was looked at",
        Verdict::BytesWhole => "its bytes are those of its manifest; its numbers were not looked at",
        Verdict::Faulty => "FAULTY",
        Verdict::NotChecked => "not checked",
    };
    let mut lines = vec![format!("{name}: {verdict}")];
    for table in &check.tables {
        if !table.table.is_empty() {
            lines.push(format!("  table {}", table.table));
        }
        lines.extend(table.faults.iter().map(|f| format!("  {}: {}", f.fault.words(), f.message)));
        for c in &table.checks {
            let result = if c.result == LawResult::Broken { "BROKEN" } else { c.result.words() };
            lines.push(format!("  {:<8} {result}: {}", c.check, c.told));
        }
        lines.extend(power(table).map(|p| format!("  {p}")));
    }
    lines.join("\n")
}

fn power(table: &Recheck) -> Option<String> {
    let s = table.sampled?;
    Some(format!(
        "seed {}: {} of {} texels judged; a fault in one texel of twenty is found with probability {}, in a single texel with {}",
        s.seed,
        s.judged,
        s.texels,
        probability(s.finds_one_in_twenty),
        probability(s.finds_one)
    ))
}

/// A probability, of which one that is nearly 1 is not rounded to it.
fn probability(p: f64) -> String {
    if p >= 1.0 {
        "1".to_owned()
    } else if p > 0.999 {
        "above 0.999".to_owned()
    } else {
        significant(p, 3)
    }
}

fn faults(name: &str, check: &FileCheck) -> Vec<String> {
    let all = check.tables.iter().flat_map(|t| &t.faults);
    all.map(|f| format!("{name}: {}: {}", f.fault.words(), f.message)).collect()
}

/// How many files were looked at, and why some were not.
fn summary(checks: &[FileCheck]) -> Vec<String> {
    let whole = checks.iter().filter(|c| c.verdict == Verdict::Whole).count();
    if checks.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![format!(
        "numbers of {whole} of {} files are those that they say, at seeded texels",
        checks.len()
    )];
    let mut why: Vec<(&str, usize)> = Vec::new();
    let unchecked = |c: &&FileCheck| !matches!(c.verdict, Verdict::Whole | Verdict::Faulty);
    for check in checks.iter().filter(unchecked) {
        let told =
            check.tables.iter().flat_map(|t| &t.checks).find(|c| c.check == "values").map_or("", |c| &c.told);
        match why.iter_mut().find(|(w, _)| *w == told) {
            Some((_, n)) => *n += 1,
            None => why.push((told, 1)),
        }
    }
    lines.extend(why.into_iter().map(|(w, n)| format!("not checked, {n}: {w}")));
    lines
}

fn folder_lines(audit: &Audit) -> Vec<String> {
    let mut lines = Vec::new();
    for checked in &audit.files {
        let name = &checked.file;
        match &checked.state {
            State::Whole => {}
            State::Missing => lines.push(format!("{name}: missing")),
            State::Changed { origin: Some(origin), .. } => {
                lines.push(format!("{name}: of another bake, {}", from(origin)));
            }
            State::Changed { bytes: [got, told], blake3: [hash, listed], origin: None } => {
                lines.push(format!(
                    "{name}: {got} bytes with hash {}, the manifest lists {told} with {}",
                    short(hash),
                    short(listed)
                ));
            }
        }
    }
    for foreign in &audit.foreign {
        let from = foreign.origin.as_ref().map_or_else(String::new, |o| format!(": {}", from(o)));
        lines.push(format!("{}: not in the manifest{from}", foreign.file));
    }
    match audit.activity {
        Activity::Idle => {}
        Activity::Running => lines.push("a bake is at work in the folder".to_owned()),
        Activity::Killed => {
            lines.push(
                "a bake was killed in the folder; the next one finishes or removes what it left".to_owned(),
            );
        }
    }
    lines
}

fn verdict_line(folder: &str, audit: &Audit) -> String {
    let all = audit.files.len();
    let whole = audit.files.iter().filter(|f| f.state == State::Whole).count();
    let verdict = match audit.verdict() {
        FolderVerdict::Whole => format!("all {all} files are those of its manifest"),
        FolderVerdict::Mixture => {
            format!("a mixture of bakes: {whole} of {all} files are those of its manifest")
        }
        FolderVerdict::Damaged => format!("{whole} of {all} files are those of its manifest"),
    };
    format!("{folder}: {verdict} (recipe {}, {})", audit.recipe, short(&audit.hash))
}

fn from(origin: &Origin) -> String {
    let Origin { recipe, table, hash, tool } = origin;
    format!("table {table} of recipe {recipe}, {}, by {tool}", short(hash))
}

/// The beginning of a hash.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn unread(path: &Path, error: ReadError) -> Failure {
    match error {
        ReadError::Cancelled(stopped) => stopped.into(),
        ReadError::Io { .. } => Failure::new(Exit::Io, error),
        error => Failure::new(Exit::Input, format!("{}: {error}", path.display()))
            .at("file", path.display().to_string()),
    }
}

fn failure(error: AuditError) -> Failure {
    let exit = match error {
        AuditError::NoManifest { .. } => Exit::Failed,
        AuditError::Manifest { .. } => Exit::Input,
        _ => Exit::Io,
    };
    Failure::new(exit, error)
}
