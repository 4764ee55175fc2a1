//! `brdfbake check SCENE...`: materials against rules.

use super::{Exit, Failure, output, scene};
use crate::cancel::Cancel;
use crate::math::figures::significant;
use crate::math::shown::show;
use crate::pipeline::materials::{self, Broken, Judging, Parts, RULES, Review};
use crate::pipeline::{InMemoryError, pool};
use crate::scene::Reader;
use serde_json::json;
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake check scene.glb",
    "\n  brdfbake check scene.glb --rule smooth-half=off --json",
);

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// glTF scenes: .gltf or .glb files, folders with all such files below them, or patterns.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    pictures: scene::Pictures,
    /// Another bound for a rule (`list checks`); `off` leaves it out.
    #[arg(long, value_name = "RULE=BOUND")]
    rule: Vec<String>,
    /// Masking of the GGX lobes: that of the tables and of glTF's appendix (correlated), or that of the appendix before 2026 (separable).
    #[arg(long, value_name = "MASKING", default_value = "correlated", value_parser = ["correlated", "separable"])]
    masking: String,
    /// End with 4 where a rule is broken, or a material could not be judged as it is.
    #[arg(long)]
    strict: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for a scene that is refused, or a rule that is not known.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let files = scene::files(&args.scenes)?;
    let judging = Judging { rules: rules(&args.rule)?, look: args.pictures.options(Reader::default()) };
    let pool = pool(None)?;
    let parts = pool.install(|| Parts::bake(cancel, &args.masking)).map_err(|e| match e {
        InMemoryError::Bake(e) => Failure::from(e),
        InMemoryError::Plan(e) => Failure::new(Exit::Internal, e),
    })?;
    let mut reviews = Vec::with_capacity(files.len());
    let mut faults = Vec::new();
    for file in &files {
        cancel.check()?;
        match pool.install(|| materials::review(file, &parts, &judging)) {
            Ok(review) => reviews.push(review),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(scene::refused(&faults));
    }
    if args.json {
        output::data(&json!({ "scenes": reviews }).to_string())?;
    } else {
        output::data(&text(&reviews, files.len() > 1))?;
    }
    let clean =
        reviews.iter().all(|r| r.broken.is_empty() && r.unknown.is_empty() && r.simplified.is_empty());
    Ok(if args.strict && !clean { Exit::Failed } else { Exit::Done })
}

/// The rules, with the bounds that were asked for.
fn rules(changes: &[String]) -> Result<Vec<(&'static materials::Rule, f64)>, Failure> {
    let mut rules: Vec<_> = RULES.iter().map(|r| (*r, r.bound)).collect();
    let mut changed = Vec::new();
    for change in changes {
        let (id, bound) =
            change.split_once('=').ok_or_else(|| Failure::usage(format!("{change}: it is RULE=BOUND")))?;
        if changed.contains(&id) {
            return Err(Failure::usage(format!("--rule {change}: `{id}` is given twice; leave one out")));
        }
        changed.push(id);
        let Some(place) = rules.iter().position(|(r, _)| r.id == id) else {
            let ids = RULES.iter().map(|r| r.id);
            return Err(Failure::usage(format!("no rule `{id}`{}", crate::math::nearest::offer(id, ids))));
        };
        if bound == "off" {
            rules.remove(place);
            continue;
        }
        let number = bound.parse::<f64>().ok().filter(|b| b.is_finite());
        rules[place].1 =
            number.ok_or_else(|| Failure::usage(format!("{change}: the bound is a number, or `off`")))?;
    }
    Ok(rules)
}

fn text(reviews: &[Review], with_files: bool) -> String {
    let mut lines = Vec::new();
    for review in reviews {
        lines.extend(review.broken.iter().map(|broken| line(broken, with_files)));
        for (material, why) in &review.unknown {
            lines.push(format!("{} {material}: not judged: {}", show(&material.file), show(why)));
        }
        for (material, how) in &review.simplified {
            lines.push(format!("{} {material}: simplified: {}", show(&material.file), show(how)));
        }
    }
    let count = |f: &dyn Fn(&Review) -> usize| reviews.iter().map(f).sum::<usize>();
    lines.push(format!(
        "{} materials, {} texels: {} rules broken, {} materials not judged",
        count(&|r| r.materials),
        count(&|r| r.texels),
        count(&|r| r.broken.len()),
        count(&|r| r.unknown.len())
    ));
    lines.join("\n")
}

fn line(broken: &Broken, with_file: bool) -> String {
    let Broken { material, rule, bound, count, share, texel: [x, y], value } = broken;
    let file = if with_file { format!("{} ", show(&material.file)) } else { String::new() };
    format!(
        "{file}{material}: {rule}: {count} texels ({} %), the worst at ({x}, {y}) is {}; the bound is {bound}",
        significant(share * 100.0, 3),
        significant(*value, 4)
    )
}
