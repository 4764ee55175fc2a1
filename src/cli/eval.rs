//! `brdfbake eval`: reads `model,params_json,wi_theta,wi_phi,wo_theta,wo_phi` as CSV and adds a column with the value.
//!
//! `model` names a model or a function (`list models`, `list functions`); text after its first space is a remark. Angles
//! are in radians: polar ones in [0, pi], azimuths within a turn either way. The value of a model is f in 1/sr without the
//! cosine, 0 where a direction is at or below the horizon; a function says what it reads from the angle columns
//! (`describe ID`), and columns that it does not read may be blank. Other columns are passed through; one that has the name
//! of the result already, as in a file that was evaluated before, gets new values.
//!
//! With `--texel` a texel of a map that `brdfbake map` wrote tells parameters of every row, and the frame of its lobes.
//!
//! Every row is written before the next one is read. The first that cannot be evaluated ends the run; into a file
//! (`--out`) only all of them are written.

use super::texel::Texels;
use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::functions::{Angles, EvalError, Subject};
use crate::pipeline::map::texel::MapTexel;
use crate::pipeline::{PipelineError, transaction};
use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, Visitor};
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake eval directions.csv",
    "\n  brdfbake eval directions.csv -o values.csv",
    "\n  brdfbake eval directions.csv --texel maps/map:3,1,1",
);

/// Arguments of `eval`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// CSV file; stdin if not given.
    file: Option<PathBuf>,
    /// Name of the column of the result; one that is there already gets new values.
    #[arg(long, default_value = "brdfbake")]
    column: String,
    #[command(flatten)]
    texels: Texels,
    /// Write into this file, all rows or nothing; to stdout, row by row, if not given.
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

const COLUMNS: [&str; 6] = ["model", "params_json", "wi_theta", "wi_phi", "wo_theta", "wo_phi"];

/// Models and functions that are kept, each with its parameters: rows repeat them, and files may be long.
const KEPT: usize = 1024;

/// Runs it.
///
/// # Errors
/// [`Failure`] with the line of the first row that cannot be evaluated; the rows before it are written to stdout.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let column = args.column.trim();
    if column.is_empty() || COLUMNS.contains(&column) {
        let why = "the column of the result has a name of its own";
        return Err(Failure::usage(format!("--column `{column}`: {why}")));
    }
    let name = args.file.as_ref().map_or_else(|| "stdin".to_owned(), |p| p.display().to_string());
    let input: Box<dyn io::Read> = match &args.file {
        Some(path) => Box::new(std::fs::File::open(path).map_err(|e| Failure::io(&name, &e))?),
        None => Box::new(io::stdin().lock()),
    };
    if let Some(out) = &args.out {
        let name = out.file_name().map(|n| n.to_string_lossy().into_owned());
        transaction::check(out.parent().unwrap_or(Path::new("")), name.as_slice())
            .map_err(PipelineError::from)?;
    }
    let texel = args.texels.read(cancel)?;
    let mut reader = csv::Reader::from_reader(input);
    let headers = reader.headers().map_err(|e| unreadable(&name, e))?.clone();
    let header = Header::new(&headers, column).map_err(|why| Failure::input(format!("{name}: {why}")))?;
    if header.result.is_some() {
        output::talk(&format!("{name}: column `{column}` is there already: its values are replaced"));
    }
    let mut sink = Sink::new(args.out.as_deref());
    if sink.row(header.with(&headers, column))? == output::Reader::Gone {
        return Ok(Exit::Done);
    }
    let mut cache = HashMap::new();
    for record in reader.records() {
        cancel.check()?;
        let record = record.map_err(|e| unreadable(&name, e))?;
        let line = record.position().map_or(0, csv::Position::line);
        let value = evaluate(&record, &header, texel.as_ref(), &mut cache).map_err(|f| {
            let message = format!("{name}:{line}: {}", f.message);
            let told = f.message.clone();
            Failure { message, ..f }.at("file", name.as_str()).at("line", line).at("message", told)
        })?;
        if sink.row(header.with(&record, &format!("{value:e}")))? == output::Reader::Gone {
            return Ok(Exit::Done);
        }
    }
    sink.finish(cancel)
}

/// A row that is no CSV is a bad input; one that cannot be read at all is not.
fn unreadable(name: &str, error: csv::Error) -> Failure {
    match error.kind() {
        csv::ErrorKind::Io(e) => Failure::io(name, e),
        _ => Failure::input(format!("{name}: {error}")),
    }
}

/// Where the columns are.
struct Header {
    /// Of [`COLUMNS`].
    inputs: [usize; COLUMNS.len()],
    /// Of the result, if the file has it.
    result: Option<usize>,
}

impl Header {
    fn new(headers: &csv::StringRecord, column: &str) -> Result<Header, String> {
        let names: Vec<&str> = headers.iter().map(str::trim).collect();
        for (i, name) in names.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
            if let Some(first) = names.iter().take(i).position(|n| n == name) {
                let places = format!("column {} and column {}", first + 1, i + 1);
                return Err(format!("column `{name}` is there twice ({places}); rename or drop one"));
            }
        }
        let mut inputs = [0; COLUMNS.len()];
        for (slot, wanted) in inputs.iter_mut().zip(COLUMNS) {
            *slot = names.iter().position(|n| *n == wanted).ok_or_else(|| {
                format!("no column `{wanted}`; the header must have {}", COLUMNS.join(", "))
            })?;
        }
        Ok(Header { inputs, result: names.iter().position(|n| *n == column) })
    }

    /// A row with its result, in its place or at the end.
    fn with<'a>(&self, record: &'a csv::StringRecord, value: &'a str) -> Vec<&'a str> {
        let mut row: Vec<&str> = record.iter().collect();
        match self.result.and_then(|i| row.get_mut(i)) {
            Some(slot) => *slot = value,
            None => row.push(value),
        }
        row
    }
}

/// Where rows go: each to stdout at once, or all into a file at the end.
struct Sink<'a> {
    out: Option<&'a Path>,
    rows: csv::Writer<Target>,
}

enum Target {
    Stdout,
    Memory(Vec<u8>),
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Target::Stdout => output::stdout().write(bytes),
            Target::Memory(held) => held.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Target::Stdout => output::stdout().flush(),
            Target::Memory(_) => Ok(()),
        }
    }
}

impl<'a> Sink<'a> {
    fn new(out: Option<&'a Path>) -> Sink<'a> {
        let target = if out.is_some() { Target::Memory(Vec::new()) } else { Target::Stdout };
        Sink { out, rows: csv::Writer::from_writer(target) }
    }

    fn row(&mut self, row: Vec<&str>) -> Result<output::Reader, Failure> {
        match self.rows.write_record(row).map_err(csv::Error::into_kind) {
            Ok(()) => output::judge(self.rows.flush()),
            Err(csv::ErrorKind::Io(e)) => output::judge(Err(e)),
            Err(e) => Err(Failure::new(Exit::Internal, format!("{e:?}"))),
        }
    }

    fn finish(self, cancel: &Cancel) -> Result<Exit, Failure> {
        let target = self.rows.into_inner().map_err(|e| Failure::io("rows", e.error()))?;
        if let (Some(out), Target::Memory(held)) = (self.out, target) {
            atomic::write_all(&[(out.to_owned(), held)], cancel)?;
        }
        Ok(Exit::Done)
    }
}

fn evaluate(
    record: &csv::StringRecord,
    header: &Header,
    texel: Option<&MapTexel>,
    cache: &mut HashMap<(String, String), Subject>,
) -> Result<f64, Failure> {
    let field = |i: usize| record.get(header.inputs[i]).unwrap_or("").trim();
    let key = (field(0).to_owned(), field(1).to_owned());
    if !cache.contains_key(&key) {
        if cache.len() >= KEPT {
            cache.clear();
        }
        let given = parameters(&key.1)?;
        let subject = match texel {
            Some(texel) => texel.subject(&key.0, &given).map_err(Failure::input)?,
            None => Subject::new(&key.0, &given).map_err(Failure::input)?,
        };
        cache.insert(key.clone(), subject);
    }
    let Some(subject) = cache.get(&key) else { return Err(Failure::new(Exit::Internal, "cache")) };
    let angle = |i: usize| {
        let text = field(i);
        match text.parse::<f64>() {
            Ok(v) if v.is_finite() => Ok(Some(v)),
            _ if text.is_empty() => Ok(None),
            _ => Err(Failure::input(format!("{} = `{text}` is not a finite number (radians)", COLUMNS[i]))),
        }
    };
    let (wi_theta, wi_phi, wo_theta, wo_phi) = (angle(2)?, angle(3)?, angle(4)?, angle(5)?);
    subject.value(&Angles { wi_theta, wi_phi, wo_theta, wo_phi }).map_err(|e| match e {
        EvalError::Delta { .. } => Failure::new(Exit::Unsupported, e),
        _ => Failure::input(e),
    })
}

/// The parameters of a cell; none if it is blank.
fn parameters(text: &str) -> Result<Map<String, Json>, Failure> {
    if text.is_empty() {
        return Ok(Map::new());
    }
    let fault = |e| Failure::input(format!("params_json: {e}: {text}"));
    serde_json::from_str::<Unique>(text).map(|unique| unique.0).map_err(fault)
}

/// A JSON object that has every key once.
struct Unique(Map<String, Json>);

impl<'de> Deserialize<'de> for Unique {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Unique, D::Error> {
        deserializer.deserialize_map(Unique(Map::new()))
    }
}

impl<'de> Visitor<'de> for Unique {
    type Value = Unique;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an object of parameters")
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut map: A) -> Result<Unique, A::Error> {
        while let Some((key, value)) = map.next_entry::<String, Json>()? {
            if self.0.contains_key(&key) {
                return Err(A::Error::custom(format!("key `{key}` is there twice")));
            }
            self.0.insert(key, value);
        }
        Ok(self)
    }
}
