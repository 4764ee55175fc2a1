//! `brdfbake eval`: reads `model,params_json,wi_theta,wi_phi,wo_theta,wo_phi` as CSV and appends `value`.
//!
//! `model` names a model or a function (`list models`, `list functions`); text after its first space is a remark. Angles
//! are in radians. The value of a model is f in 1/sr without the cosine, 0 where a direction is at or below the horizon; a
//! function says what it reads from the angle columns (`describe ID`), and columns that it does not read may be blank.
//! Other columns are passed through.

use super::{Exit, Failure, output};
use crate::functions::{Angles, EvalError, Subject};
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use std::path::PathBuf;

/// Arguments of `eval`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// CSV file; stdin if not given.
    file: Option<PathBuf>,
    /// Name of the appended column.
    #[arg(long, default_value = "brdfbake")]
    column: String,
}

const COLUMNS: [&str; 6] = ["model", "params_json", "wi_theta", "wi_phi", "wo_theta", "wo_phi"];

/// Runs it.
///
/// # Errors
/// [`Failure`] with the line of the first row that cannot be evaluated.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let name = args.file.as_ref().map_or_else(|| "stdin".to_owned(), |p| p.display().to_string());
    let input: Box<dyn std::io::Read> = match &args.file {
        Some(path) => Box::new(std::fs::File::open(path).map_err(|e| Failure::io(&name, &e))?),
        None => Box::new(std::io::stdin().lock()),
    };
    let mut reader = csv::Reader::from_reader(input);
    let headers = reader.headers().map_err(|e| Failure::input(format!("{name}: {e}")))?.clone();
    let mut columns = [0; COLUMNS.len()];
    for (slot, column) in columns.iter_mut().zip(COLUMNS) {
        *slot = headers.iter().position(|h| h.trim() == column).ok_or_else(|| {
            Failure::input(format!(
                "{name}: no column `{column}`; the header must have {}",
                COLUMNS.join(", ")
            ))
        })?;
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    let fault = |e: csv::Error| Failure::new(Exit::Internal, e);
    writer.write_record(headers.iter().chain([args.column.as_str()])).map_err(fault)?;
    let mut cache: HashMap<(String, String), Subject> = HashMap::new();
    for record in reader.records() {
        let record = record.map_err(|e| Failure::input(format!("{name}: {e}")))?;
        let line = record.position().map_or(0, csv::Position::line);
        let value = evaluate(&record, &columns, &mut cache)
            .map_err(|f| Failure { message: format!("{name}:{line}: {}", f.message), ..f })?;
        writer.write_record(record.iter().chain([format!("{value:e}").as_str()])).map_err(fault)?;
    }
    let bytes = writer.into_inner().map_err(|e| Failure::new(Exit::Internal, e))?;
    output::data(&String::from_utf8_lossy(&bytes));
    Ok(Exit::Done)
}

fn evaluate(
    record: &csv::StringRecord,
    columns: &[usize; 6],
    cache: &mut HashMap<(String, String), Subject>,
) -> Result<f64, Failure> {
    let field = |i: usize| record.get(columns[i]).unwrap_or("").trim();
    let key = (field(0).to_owned(), field(1).to_owned());
    if !cache.contains_key(&key) {
        let params: Map<String, Json> = if key.1.is_empty() {
            Map::new()
        } else {
            serde_json::from_str(&key.1)
                .map_err(|e| Failure::input(format!("params_json: {e}: {}", key.1)))?
        };
        cache.insert(key.clone(), Subject::new(&key.0, &params).map_err(Failure::input)?);
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
