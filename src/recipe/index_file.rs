//! Wavelengths, n and k from a file of refractiveindex.info: its CSV (a block `wl,n`, a block `wl,k`, or three columns) and the tabulated
//! data of its YAML. Both are in micrometres unless the heading of a CSV says nm.
//!
//! A file without k is one of a material that does not absorb: k is 0. Where n and k have wavelengths of their own, both are read, linear,
//! at all of them as far as both reach. What lies outside of 360 to 830 nm is left out but for the row beside it.

use crate::terms::colour::VISIBLE_NM;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Most bytes of a file.
const MOST_BYTES: u64 = 4 << 20;

/// Why a file gives no rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reason {
    /// In words, with the line.
    pub(super) why: String,
    /// Is it the system that cannot read it?
    pub(super) io: bool,
}

/// Rows of wavelength in nm, n and k, in rising order.
type Rows = Vec<[f64; 3]>;

/// Wavelength in nm and a number; with the line of the file.
type Curve = Vec<([f64; 2], usize)>;

/// Reads a file.
pub(super) fn load(path: &Path) -> Result<Rows, Reason> {
    let io = |e: std::io::Error| Reason { why: e.to_string(), io: true };
    if !std::fs::metadata(path).map_err(io)?.is_file() {
        return Err(Reason { why: "it is not a regular file".to_owned(), io: true });
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(io)?.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(io)?;
    let wrong = |why: String| Reason { why, io: false };
    if bytes.len() as u64 > MOST_BYTES {
        return Err(wrong(format!("more than {MOST_BYTES} bytes")));
    }
    let text = std::str::from_utf8(&bytes).map_err(|_| wrong("it is not UTF-8 text".to_owned()))?;
    parse(text).map_err(wrong)
}

/// The rows of a text.
pub(super) fn parse(text: &str) -> Result<Rows, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let [n, k] = if text.lines().any(|l| l.starts_with("DATA:")) { yaml(text)? } else { csv(text)? };
    let [n, k] = [ordered(n, "n")?, ordered(k, "k")?];
    if n.len() < 2 {
        return Err("it has no two rows of wavelength and n".to_owned());
    }
    let rows = if k.is_empty() { n.into_iter().map(|[l, n]| [l, n, 0.0]).collect() } else { joined(&n, &k)? };
    Ok(visible(rows))
}

/// A wavelength in nm from its text in micrometres; exact, as shifting the point is.
fn nanometres(cell: &str, micrometres: bool) -> Option<f64> {
    let shifted =
        if micrometres && !cell.contains(['e', 'E']) { format!("{cell}e3") } else { cell.to_owned() };
    let factor = if micrometres && cell.contains(['e', 'E']) { 1e3 } else { 1.0 };
    shifted.parse::<f64>().ok().map(|v| v * factor).filter(|v| v.is_finite() && *v > 0.0)
}

fn number(cell: &str) -> Option<f64> {
    cell.parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0)
}

fn cells(line: &str) -> Vec<&str> {
    line.split([',', ';', '\t', ' ']).map(str::trim).filter(|c| !c.is_empty()).collect()
}

/// Curves of n and k.
fn csv(text: &str) -> Result<[Curve; 2], String> {
    let mut curves = [Curve::new(), Curve::new()];
    let mut columns: Vec<usize> = Vec::new();
    let mut micrometres = true;
    for (i, line) in text.lines().enumerate() {
        let cells = cells(line);
        let Some(first) = cells.first() else { continue };
        if first.starts_with('#') {
            continue;
        }
        if first.starts_with(|c: char| c.is_ascii_alphabetic() || c == 'λ' || c == '"') {
            let named = |name: &str| {
                cells
                    .iter()
                    .any(|c| c.trim_matches('"').eq_ignore_ascii_case(name))
                    .then_some(usize::from(name == "k"))
            };
            columns = ["n", "k"].into_iter().filter_map(named).collect();
            micrometres = !line.to_ascii_lowercase().contains("nm");
            if columns.is_empty() {
                return Err(format!(
                    "line {}: the heading names neither n nor k; expected `wl,n`, `wl,k` or `wl,n,k`",
                    i + 1
                ));
            }
            continue;
        }
        if columns.is_empty() {
            return Err(format!(
                "line {}: numbers without a heading; expected `wl,n`, `wl,k` or `wl,n,k`",
                i + 1
            ));
        }
        push(&mut curves, &columns, &cells, (i + 1, micrometres))?;
    }
    Ok(curves)
}

/// Curves of n and k.
fn yaml(text: &str) -> Result<[Curve; 2], String> {
    let mut curves = [Curve::new(), Curve::new()];
    let mut columns: Vec<usize> = Vec::new();
    let mut inside = false;
    for (i, line) in text.lines().enumerate() {
        let trimmed = line.trim().trim_start_matches("- ").trim_start();
        if let Some(kind) = trimmed.strip_prefix("type:") {
            columns = match kind.trim().trim_matches('"') {
                "tabulated nk" => vec![0, 1],
                "tabulated n" => vec![0],
                "tabulated k" => vec![1],
                other => {
                    return Err(format!(
                        "line {}: data of type `{other}`; only tabulated ones are read: take the CSV of that page",
                        i + 1
                    ));
                }
            };
            inside = false;
        } else if trimmed.strip_prefix("data:").is_some_and(|rest| rest.trim().starts_with('|')) {
            inside = !columns.is_empty();
        } else if inside && trimmed.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            push(&mut curves, &columns, &cells(trimmed), (i + 1, true))?;
        } else if !trimmed.is_empty() {
            inside = false;
        }
    }
    Ok(curves)
}

/// A line of numbers: the wavelength, then one for each column.
fn push(
    curves: &mut [Curve; 2],
    columns: &[usize],
    cells: &[&str],
    (line, micrometres): (usize, bool),
) -> Result<(), String> {
    let wrong =
        || format!("line {line}: expected a wavelength and {} more numbers, none negative", columns.len());
    let lambda = cells.first().and_then(|c| nanometres(c, micrometres)).ok_or_else(wrong)?;
    for (place, column) in columns.iter().enumerate() {
        let value = cells.get(place + 1).and_then(|c| number(c)).ok_or_else(wrong)?;
        curves[*column].push(([lambda, value], line));
    }
    Ok(())
}

/// In rising order, as files are but for some that fall.
fn ordered(mut curve: Curve, what: &str) -> Result<Vec<[f64; 2]>, String> {
    if curve.first().zip(curve.last()).is_some_and(|(a, b)| a.0[0] > b.0[0]) {
        curve.reverse();
    }
    for pair in curve.windows(2) {
        if pair[0].0[0] >= pair[1].0[0] {
            let line = pair[0].1.max(pair[1].1);
            return Err(format!(
                "line {line}: the wavelengths of {what} are out of order, or one is there twice"
            ));
        }
    }
    Ok(curve.into_iter().map(|(point, _)| point).collect())
}

/// Both at all wavelengths that lie within both.
fn joined(n: &[[f64; 2]], k: &[[f64; 2]]) -> Result<Rows, String> {
    let ends = |c: &[[f64; 2]]| c.first().zip(c.last()).map_or([0.0, 0.0], |(a, b)| [a[0], b[0]]);
    let ([a, b], [c, d]) = (ends(n), ends(k));
    let (low, high) = (a.max(c), b.min(d));
    let mut all: Vec<f64> = n.iter().chain(k).map(|p| p[0]).filter(|l| (low..=high).contains(l)).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    if all.len() < 2 {
        return Err(format!(
            "n reaches from {a} to {b} nm, k from {c} to {d} nm: they have no range in common"
        ));
    }
    Ok(all.into_iter().map(|l| [l, linear(n, l), linear(k, l)]).collect())
}

fn linear(curve: &[[f64; 2]], lambda: f64) -> f64 {
    let above = curve.partition_point(|p| p[0] < lambda).min(curve.len() - 1);
    let b = curve[above];
    if above == 0 || (b[0] - lambda).abs() == 0.0 {
        return b[1];
    }
    let a = curve[above - 1];
    a[1] + (lambda - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
}

/// The rows of the visible, and one beyond on either side.
fn visible(rows: Rows) -> Rows {
    let [low, high] = VISIBLE_NM;
    let first = rows.partition_point(|r| r[0] <= low).saturating_sub(1);
    let last = rows.partition_point(|r| r[0] < high).min(rows.len() - 1);
    let kept = rows.get(first..=last).unwrap_or_default().to_vec();
    if kept.len() < 2 { rows } else { kept }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CSV: &str = "wl,n\r\n0.3,1.5\r\n0.4,1.4\r\n0.7,0.2\r\n0.9,0.1\r\n1.2,0.3\r\n\r\nwl,k\r\n0.35,1.0\r\n0.7,4.5\r\n0.95,7.0\r\n";

    #[test]
    fn blocks_of_a_csv_meet_at_all_wavelengths() {
        let rows = parse(CSV).unwrap();
        let lambdas: Vec<f64> = rows.iter().map(|r| r[0]).collect();
        assert_eq!(lambdas, [350.0, 400.0, 700.0, 900.0]);
        assert!((rows[0][1] - 1.45).abs() < 1e-15 && (rows[1][2] - 1.5).abs() < 1e-15, "{rows:?}");
        assert_eq!(
            parse("Wavelength (nm);n;k\n400;1;2\n548.6;2;3\n"),
            Ok(vec![[400.0, 1.0, 2.0], [548.6, 2.0, 3.0]])
        );
    }

    #[test]
    fn yaml_is_read_as_its_database_writes_it() {
        let text = "# CC0\nREFERENCES: |\n    1) Someone\nDATA:\n  - type: tabulated nk\n    data: |\n        0.3542 1.50 1.866\n        0.5486 0.43 2.455\n        0.8920 0.17 5.663\n    comment: none\n";
        assert_eq!(parse(text), Ok(vec![[354.2, 1.5, 1.866], [548.6, 0.43, 2.455], [892.0, 0.17, 5.663]]));
        let glass = text.replace("tabulated nk", "tabulated n");
        assert_eq!(parse(&glass).unwrap().get(1), Some(&[548.6, 0.43, 0.0]));
        let two = "DATA:\n  - type: tabulated n\n    data: |\n        0.4 1\n        0.8 2\n  - type: tabulated k\n    data: |\n        0.8 3\n        0.4 1\n";
        assert_eq!(parse(two), Ok(vec![[400.0, 1.0, 1.0], [800.0, 2.0, 3.0]]));
    }

    #[test]
    fn faults_name_the_line() {
        for (text, part) in [
            ("", "no two rows"),
            ("0.4,1,2\n", "line 1: numbers without a heading"),
            ("a,b\n", "line 1: the heading names neither"),
            ("wl,n\n0.4,1\n0.5,x\n", "line 3: expected a wavelength"),
            ("wl,n\n0.4,1\n0.4,1\n0.5,2\n", "line 3: the wavelengths of n"),
            ("wl,n\n0.4,-1\n0.5,1\n", "line 2"),
            ("wl,n\n0.4,1\n0.5,1\nwl,k\n0.6,1\n0.7,1\n", "no range in common"),
            ("DATA:\n  - type: formula 2\n    coefficients: 1 2 3\n", "line 2: data of type `formula 2`"),
        ] {
            let why = parse(text).unwrap_err();
            assert!(why.contains(part), "{text:?}: {why}");
        }
    }
}
