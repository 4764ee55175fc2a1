//! Progress for people: a bar per table and a total on a terminal, plain lines elsewhere, JSON lines on request.

use super::terminal::{Paint, paint};
use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::pipeline::{Event, KeptIn, Phase, Progress, Recovery};
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

/// How to report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Text on stderr.
    Human,
    /// One JSON object a line on stdout.
    Json,
}

/// The reporter that fits format, quietness and terminal.
#[must_use]
pub fn reporter(format: Format, quiet: bool, cancel: &Arc<Cancel>) -> Reporter {
    let progress: Box<dyn Progress> = match format {
        Format::Json => return Reporter::Json(Json { cancel: Arc::clone(cancel), fault: OnceLock::new() }),
        Format::Human if quiet => Box::new(crate::pipeline::Silent),
        Format::Human if std::io::stderr().is_terminal() => Box::new(Bars::default()),
        Format::Human => Box::new(Plain::default()),
    };
    Reporter::Talk(progress)
}

/// What tells of a run.
pub enum Reporter {
    /// Data on stdout.
    Json(Json),
    /// Talk on stderr.
    Talk(Box<dyn Progress>),
}

impl std::fmt::Debug for Reporter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if matches!(self, Reporter::Json(_)) { "Json" } else { "Talk" })
    }
}

impl Reporter {
    /// What takes the events.
    #[must_use]
    pub fn progress(&self) -> &dyn Progress {
        match self {
            Reporter::Json(json) => json,
            Reporter::Talk(talk) => &**talk,
        }
    }

    /// Why not all could be told, if so.
    ///
    /// # Errors
    /// [`Failure`] of the first message that could not be written.
    pub fn finish(self) -> Result<(), Failure> {
        match self {
            Reporter::Json(json) => json.fault.into_inner().map_or(Ok(()), Err),
            Reporter::Talk(_) => Ok(()),
        }
    }
}

/// One JSON object a line. The first that cannot be written stops the run: who waits for them would wait in vain.
#[derive(Debug)]
pub struct Json {
    cancel: Arc<Cancel>,
    fault: OnceLock<Failure>,
}

impl Progress for Json {
    fn event(&self, event: &Event<'_>) {
        if matches!(event, Event::TableProgress { .. } | Event::MapProgress { .. })
            || self.fault.get().is_some()
        {
            return;
        }
        let line = serde_json::to_string(event).map_err(|e| Failure::new(Exit::Internal, e));
        if let Err(fault) = line.and_then(|line| output::data(&line)) {
            self.cancel.set();
            // another thread's may have been first
            let _ = self.fault.set(fault);
        }
    }
}

/// Explains the words of a table's line behind the first one that has them.
#[derive(Default)]
struct Legend {
    given: AtomicBool,
}

impl Legend {
    /// The text of an event, if it deserves one.
    fn line(&self, event: &Event<'_>) -> Option<String> {
        let text = line(event)?;
        let reads =
            matches!(event, Event::TableFinished { reconstruction, .. } if !reconstruction.is_empty());
        if !reads || self.given.swap(true, Ordering::Relaxed) {
            return Some(text);
        }
        Some(format!("{text}\n{LEGEND}"))
    }
}

const LEGEND: &str = "    (as read: the largest error of what a shader gets between the texels; practical: where mu >= 0.05 and \
                      roughness >= 0.09; see `brdfbake guide accuracy`)";

#[derive(Default)]
struct Plain {
    legend: Legend,
}

impl Progress for Plain {
    fn event(&self, event: &Event<'_>) {
        if let Some(line) = self.legend.line(event) {
            output::talk(&line);
        }
    }
}

#[derive(Default)]
struct Bars {
    legend: Legend,
    all: MultiProgress,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    total: Option<ProgressBar>,
    table: Option<ProgressBar>,
    /// What the table is going through.
    phase: Option<Phase>,
}

impl Bars {
    fn on(&self, event: &Event<'_>, state: &mut State) {
        match event {
            Event::Plan { tables, maps, .. } => {
                let bar = self.all.add(ProgressBar::new((tables.len() + maps.len()) as u64));
                let what = if maps.is_empty() { "tables" } else { "tables and maps" };
                bar.set_style(style(&format!("total {{bar:30}} {{pos}}/{{len}} {what} {{elapsed}}")));
                state.total = Some(bar);
            }
            Event::TableProgress { table, phase, done, steps, .. } => {
                let (words, all) = (phase.words(), *steps as u64);
                let bar = state.table.get_or_insert_with(|| self.all.insert(0, ProgressBar::new(all)));
                if state.phase != Some(*phase) {
                    state.phase = Some(*phase);
                    bar.set_style(style(match steps {
                        0 => "{msg} {spinner} {elapsed}",
                        _ => "{msg} {bar:30} {pos}/{len}",
                    }));
                    bar.set_position(0);
                    bar.set_length(all);
                    bar.set_message(format!("{table}: {words}"));
                    // a phase whose end nobody knows turns by itself
                    bar.enable_steady_tick(Duration::from_millis(if all == 0 { 100 } else { 1000 }));
                }
                // rows may finish out of order; the bar only moves forward
                bar.set_position(bar.position().max(*done as u64));
            }
            Event::MapStarted { map, .. } => {
                let bar = self.all.insert(0, ProgressBar::new(0));
                bar.set_style(style("{msg} {bar:30} {percent}% {pos}/{len} texels, {eta}"));
                bar.set_message((*map).to_owned());
                state.table = Some(bar);
            }
            Event::MapProgress { done, texels, .. } => {
                if let Some(bar) = &state.table {
                    bar.set_length(*texels as u64);
                    bar.set_position(bar.position().max(*done as u64));
                }
            }
            Event::TableFinished { .. }
            | Event::MapFinished { .. }
            | Event::TableKept { .. }
            | Event::MapKept { .. } => {
                state.phase = None;
                if let Some(bar) = state.table.take() {
                    bar.finish_and_clear();
                }
                if let Some(bar) = &state.total {
                    bar.inc(1);
                }
            }
            Event::Summary { .. } => {
                if let Some(bar) = state.total.take() {
                    bar.finish_and_clear();
                }
            }
            _ => {}
        }
    }
}

impl Progress for Bars {
    fn event(&self, event: &Event<'_>) {
        let Ok(mut state) = self.state.lock() else { return };
        self.on(event, &mut state);
        if let Some(line) = self.legend.line(event) {
            // indicatif's own println is silent off a terminal; suspend always prints
            self.all.suspend(|| output::talk(&line));
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

fn kept(from: KeptIn) -> &'static str {
    match from {
        KeptIn::Folder => "unchanged, its files are there (--force bakes it again)",
        KeptIn::Cache => "from the cache (--force bakes it again)",
    }
}

/// One line of text for an event, if it deserves one.
fn line(event: &Event<'_>) -> Option<String> {
    Some(match event {
        Event::Plan { recipe, tables, maps } => {
            let texels: usize = tables.iter().map(|t| t.size.iter().product::<usize>()).sum();
            let open = tables.iter().filter(|t| t.size.contains(&0)).count();
            let more = if open > 0 { format!(", size of {open} to be found") } else { String::new() };
            let with = if maps.is_empty() { String::new() } else { format!(", {} maps", maps.len()) };
            format!("recipe {recipe}: {} tables, {texels} texels{more}{with}", tables.len())
        }
        Event::Waiting { folder, seconds } => format!(
            "waiting for another run that writes into {}, at most {seconds} s (--lock-timeout)",
            folder.display()
        ),
        Event::Recovered { folder, recovery } => {
            let done = match recovery {
                Recovery::Finished => "its files are in place now",
                Recovery::RolledBack => "the files before it are back",
                Recovery::Discarded => "it had replaced nothing, and its temporary files are removed",
            };
            format!("a run that was killed had left files in {}: {done}", folder.display())
        }
        Event::SizeFound { table, size, coordinates, record, seconds, .. } => {
            let size = size.iter().map(ToString::to_string).collect::<Vec<_>>().join(" x ");
            format!(
                "  {table}: {size} texels read to within {:.1e} (asked {:.1e}, {} domain); {}; {} trials, {:.1} s",
                record.reached,
                record.error,
                record.domain,
                coordinates.join(", "),
                record.trials,
                seconds
            )
        }
        Event::TableFinished {
            table,
            integration,
            tolerance,
            encoding,
            reconstruction,
            missed,
            laws,
            verified,
            bake_seconds,
            check_seconds,
            ..
        } => {
            let mut text =
                format!("  {table}: integration {:.1e} (asked {tolerance:.1e})", integration.largest);
            for (output, error) in encoding {
                text.push_str(&format!(", {output} rounding {error:.1e}"));
                if let Some(r) = reconstruction.iter().find(|r| r.output == *output) {
                    text.push_str(&format!(", as read {:.1e}", r.whole));
                    if let Some(p) = r.practical {
                        text.push_str(&format!(" (practical {p:.1e})"));
                    }
                    for c in &r.choices {
                        text.push_str(&format!("; {} {:.1e}, mean {:.1e}", c.texels, c.whole, c.whole_mean));
                    }
                }
            }
            if *missed > 0 {
                text.push_str(&format!(", {missed} texels above the tolerance"));
            }
            let held = laws.iter().filter(|l| l.held()).count();
            let verdict =
                if *verified { paint(Paint::Good, "verified") } else { paint(Paint::Bad, "NOT verified") };
            text.push_str(&format!("; {held} of {} laws held, {verdict}", laws.len()));
            text.push_str(&format!(" [{:.0} ms + {:.0} ms]", bake_seconds * 1e3, check_seconds * 1e3));
            // the same for every output, as a rule: said once
            if let Some(r) = reconstruction.iter().find(|r| !r.advice.is_empty()) {
                text.push_str(&format!(
                    "\n    a reader is {:.0} times further off than the tolerance; better:",
                    r.whole / tolerance
                ));
                for advice in &r.advice {
                    text.push_str(&format!("\n    * {advice}"));
                }
            }
            text
        }
        Event::TableKept { table, from, missed, laws, verified, .. } => {
            let held = laws.iter().filter(|l| l.held()).count();
            let misses =
                if *missed > 0 { format!(", {missed} texels above the tolerance") } else { String::new() };
            let verdict = if *verified { "verified" } else { "NOT verified" };
            format!("  {table}: {}{misses}; {held} of {} laws held, {verdict}", kept(*from), laws.len())
        }
        Event::MapKept { map, from, .. } => format!("  {map}: {}", kept(*from)),
        Event::CacheFault { folder, message } => {
            format!("  warning: the cache in {} cannot be written: {message}", folder.display())
        }
        Event::MapFinished { map, levels, largest, hopeless, normals, shape, seconds, .. } => {
            let hopeless =
                if *hopeless > 0 { format!(", {hopeless} texels with D >= 0.5") } else { String::new() };
            format!(
                "  {map}: {levels} levels, {shape}, normals {normals}, largest D {largest:.4}{hopeless} [{:.0} ms]",
                seconds * 1e3
            )
        }
        Event::Finding { table, finding } => {
            format!("  {} {table}: {finding}", paint(Paint::Doubtful, "warning:"))
        }
        Event::Summary { tables, maps, folder, written, unchanged, kept, bytes, seconds } => format!(
            "{}: {tables} tables{}, {} kB: {written} files written, {unchanged} unchanged{}, {seconds:.2} s",
            folder.display(),
            if *maps > 0 { format!(", {maps} maps") } else { String::new() },
            bytes.div_ceil(1000),
            if *kept > 0 { format!(", {kept} not baked again") } else { String::new() }
        ),
        _ => return None,
    })
}
