//! What Make, Ninja and their like need of a bake: is it stale, when did it run, on what does it depend.

use super::progress::Format;
use super::{Exit, Failure, output};
use crate::pipeline::fresh;
use crate::plan::Plan;
use std::path::{Path, PathBuf};

/// Arguments of a step of a build.
#[derive(Debug, Clone, clap::Args)]
pub(super) struct BuildStep {
    /// Bake nothing: end with 0 if the folder holds what would be baked, with 7 and the reasons if not.
    #[arg(long, conflicts_with_all = ["dry_run", "suggest", "write", "stamp", "depfile", "report", "lock_timeout", "memory", "yes_large", "force", "no_cache", "cache_dir", "cache_size"])]
    check: bool,
    /// Write this file after every bake that succeeds: unchanged outputs keep their time, the stamp is always new.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["dry_run", "suggest"])]
    stamp: Option<PathBuf>,
    /// Write what the outputs depend on as a rule of Make, for the stamp if there is one; Ninja reads it, too.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["dry_run", "suggest", "scene"])]
    depfile: Option<PathBuf>,
}

impl BuildStep {
    /// With `--check`, how it ends; are there jobs, and a scene?
    pub(super) fn check(
        &self,
        plan: &Plan,
        out: &Path,
        format: Format,
        quiet: bool,
        [jobs, scene]: [bool; 2],
    ) -> Result<Option<Exit>, Failure> {
        if !self.check {
            return Ok(None);
        }
        if jobs && !scene {
            let why =
                "--check bakes nothing; --jobs has an effect with --scene alone, whose textures are read";
            return Err(Failure::usage(why.to_owned()));
        }
        let why: Vec<String> = fresh::stale(plan, out).iter().map(ToString::to_string).collect();
        let lines: Vec<String> = why.iter().map(|w| format!("stale: {w}")).collect();
        match format {
            Format::Json => {
                let reason = if why.is_empty() { "fresh" } else { "stale" };
                let line = serde_json::json!({ "reason": reason, "folder": out, "why": why });
                output::data(&line.to_string())?;
            }
            Format::Human if quiet || why.is_empty() => {}
            Format::Human => output::data(&lines.join("\n")).map(|_| ())?,
        }
        Ok(Some(if why.is_empty() { Exit::Done } else { Exit::Stale }))
    }

    /// After a bake: the rule, then the stamp.
    pub(super) fn done(&self, plan: &Plan, recipe: Option<&str>, out: &Path) -> Result<(), Failure> {
        let write = |path: &Path, text: String| {
            std::fs::write(path, text).map_err(|e| Failure::new(Exit::Io, format!("{}: {e}", path.display())))
        };
        if let Some(path) = &self.depfile {
            let targets = match &self.stamp {
                Some(stamp) => vec![stamp.clone()],
                None => plan.files().iter().map(|f| out.join(f)).collect(),
            };
            let recipe = recipe.filter(|r| r.contains(['/', '\\', '.'])).map(PathBuf::from);
            let images = plan.maps.iter().flat_map(|m| m.asked.files_read());
            let needed: Vec<PathBuf> = recipe.into_iter().chain(images).collect();
            write(path, rule(&targets, &needed))?;
        }
        self.stamp.as_ref().map_or(Ok(()), |path| write(path, format!("{}\n", plan.units_hash())))
    }
}

/// `targets: needed`, with the escapes of GNU Make's prerequisites.
fn rule(targets: &[PathBuf], needed: &[PathBuf]) -> String {
    let escaped =
        |all: &[PathBuf]| all.iter().map(|p| escape(&p.to_string_lossy())).collect::<Vec<_>>().join(" ");
    let mut unique: Vec<PathBuf> = Vec::new();
    for path in needed {
        if !unique.contains(path) {
            unique.push(path.clone());
        }
    }
    format!("{}: {}\n", escaped(targets), escaped(&unique))
}

/// A space and `#` behind a backslash, `$` twice; a backslash before them doubles.
fn escape(path: &str) -> String {
    let mut text = String::with_capacity(path.len());
    let mut slashes = 0;
    for c in path.chars() {
        match c {
            ' ' | '#' => {
                text.push_str(&"\\".repeat(slashes + 1));
                text.push(c);
            }
            '$' => text.push_str("$$"),
            c => text.push(c),
        }
        slashes = if c == '\\' { slashes + 1 } else { 0 };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_escaped_as_make_reads_them() {
        assert_eq!(escape("a b#c$d"), "a\\ b\\#c$$d");
        assert_eq!(escape("C:\\x y"), "C:\\x\\ y");
        assert_eq!(escape("a\\ b"), "a\\\\\\ b");
        let paths = |all: &[&str]| all.iter().map(PathBuf::from).collect::<Vec<_>>();
        assert_eq!(rule(&paths(&["o"]), &paths(&["r.toml", "n.png", "n.png"])), "o: r.toml n.png\n");
    }
}
