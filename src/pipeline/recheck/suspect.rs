//! What is wrong with numbers that are not those of the table: each suspicion is the table as it would be if that were so, and is
//! confirmed by the same rules that refuted the file.

use super::stored::Stored;
use super::{Asked, Kind};
use crate::grid::{Axis, Direction, Grid, Quantity, Texel};
use crate::models::{self, MODELS};
use crate::tables::spec::{Bound, Request};
use crate::verify::Case;
use crate::verify::honest::{self, Row};

/// Least number of texels that must confirm a suspicion.
const CONFIRMED: usize = 8;

/// Part of the texels from which on a fault counts as one of the whole table.
const WHOLE: f64 = 0.5;

/// The name of what is wrong, and words for it.
pub(super) fn name(
    stored: &Stored,
    asked: Asked<'_>,
    rows: &[Row],
    bad: usize,
    judged: usize,
) -> (Kind, String) {
    let search = Search { stored, asked, rows, least: CONFIRMED.min(judged) };
    if let Some(found) = search.moved().or_else(|| search.labels()) {
        return found;
    }
    if (bad as f64) < WHOLE * judged as f64 {
        let words = format!("{bad} of {judged} texels hold other numbers");
        return (Kind::Corrupted, words);
    }
    let words = format!(
        "{bad} of {judged} texels hold other numbers: the file is not of the model, the parameters or the axes that it names, or of \
         other numbers altogether"
    );
    (Kind::Mislabelled, words)
}

struct Search<'a> {
    stored: &'a Stored,
    asked: Asked<'a>,
    rows: &'a [Row],
    least: usize,
}

impl Search<'_> {
    /// Texels or channels in other places.
    fn moved(&self) -> Option<(Kind, String)> {
        let grid = &self.stored.table.grid;
        let axes = grid.axes();
        let id = |i: usize| axes[i].quantity.id;
        for i in 0..axes.len() {
            if self.holds(|t, c| (flip(grid, t, &[i]), c)) {
                return Some((Kind::Flipped, format!("texels run the other way along {}", id(i))));
            }
        }
        for i in 0..axes.len() {
            for j in i + 1..axes.len() {
                if self.holds(|t, c| (flip(grid, t, &[i, j]), c)) {
                    let words = format!("texels run the other way along {} and {}", id(i), id(j));
                    return Some((Kind::Flipped, words));
                }
                if axes[i].len == axes[j].len && self.holds(|t, c| (swap(grid, t, i, j), c)) {
                    return Some((Kind::AxesSwapped, format!("{} runs along {}", id(i), id(j))));
                }
            }
        }
        let channels = &self.stored.table.channels;
        for a in 0..channels.len() {
            for b in a + 1..channels.len() {
                let other = |c: usize| {
                    if c == a {
                        b
                    } else if c == b {
                        a
                    } else {
                        c
                    }
                };
                if self.holds(|t, c| (t, other(c))) {
                    let words =
                        format!("`{}` holds `{}`, and the other way round", channels[a].id, channels[b].id);
                    return Some((Kind::ChannelsSwapped, words));
                }
            }
        }
        None
    }

    fn holds(&self, from: impl Fn(usize, usize) -> (usize, usize)) -> bool {
        let numbers = self.stored.moved(from);
        let bound = &self.stored.bound;
        let case = Case {
            bound,
            table: &numbers.table,
            tolerance: self.stored.tolerance,
            cancel: self.asked.cancel,
        };
        honest::agree(&case, &numbers.slack, self.rows, self.least)
    }

    /// Other axes, choices or models than the file names.
    fn labels(&self) -> Option<(Kind, String)> {
        let spec = &self.stored.bound.spec;
        let told = spec.request();
        let axes = spec.grid.axes();
        for (i, axis) in axes.iter().enumerate() {
            for (other, words) in other_axes(axis) {
                let changed =
                    axes.iter().enumerate().map(|(j, a)| if i == j { other.clone() } else { a.clone() });
                let request = Request { axes: Some(changed.collect()), ..told.clone() };
                if self.is(&request) {
                    return Some((
                        Kind::Mislabelled,
                        format!("axis {}: the texels are {words}", axis.quantity.id),
                    ));
                }
            }
        }
        for (key, words) in self.choices() {
            for word in words {
                let mut request = told.clone();
                request.params.insert(key.to_owned(), word.into());
                if self.is(&request) {
                    return Some((Kind::Mislabelled, format!("the numbers are those of {key} = {word}")));
                }
            }
        }
        let named = spec.model.as_ref().map(|(info, _)| info.id)?;
        for info in MODELS.iter().filter(|m| m.id != named) {
            let own = |key: &String| spec.kind.params.iter().any(|p| p.id == key.as_str());
            let taken = |key: &String| own(key) || info.params.iter().any(|p| p.is_called(key));
            let mut request = Request { model: Some(info.id.to_owned()), ..told.clone() };
            request.params.retain(|key, _| taken(key));
            if self.is(&request) {
                return Some((
                    Kind::Mislabelled,
                    format!("the numbers are those of model {}, not of {named}", info.id),
                ));
            }
        }
        None
    }

    /// Parameters that are words, with those that are not chosen.
    fn choices(&self) -> Vec<(&'static str, Vec<&'static str>)> {
        let spec = &self.stored.bound.spec;
        let model = spec.model.iter().flat_map(|(info, params)| info.params.iter().map(move |p| (p, params)));
        let all = model.chain(spec.kind.params.iter().map(|p| (p, &spec.params)));
        let words = |(p, params): (&'static models::Param, &models::Params)| match p.kind {
            models::Kind::Choice(words) => {
                let held = params.choice(p.id).ok()?;
                Some((p.id, words.iter().copied().filter(|w| *w != held).collect()))
            }
            _ => None,
        };
        all.filter_map(words).collect()
    }

    fn is(&self, request: &Request) -> bool {
        let Ok(bound) = request.bind() else { return false };
        self.is_of(&bound).unwrap_or(false)
    }

    fn is_of(&self, bound: &Bound) -> Option<bool> {
        let numbers = self.stored.labelled(&bound.spec)?;
        let case = Case {
            bound,
            table: &numbers.table,
            tolerance: self.stored.tolerance,
            cancel: self.asked.cancel,
        };
        Some(honest::agree(&case, &numbers.slack, self.rows, self.least))
    }
}

fn other_axes(axis: &Axis) -> Vec<(Axis, String)> {
    let mut all = Vec::new();
    let (texel, words) = match axis.texel {
        Texel::Center => (Texel::Endpoint, "on the ends of the domain, not at centres"),
        Texel::Endpoint => (Texel::Center, "at centres, not on the ends of the domain"),
    };
    all.push((Axis { texel, ..axis.clone() }, words.to_owned()));
    for offset in [0.0, 1.0, -1.0, 0.5, -0.5] {
        if (axis.offset - offset).abs() > 0.0 {
            all.push((
                Axis { offset, ..axis.clone() },
                format!("shifted by {offset}, not by {}", axis.offset),
            ));
        }
    }
    let other = match axis.quantity.id {
        "roughness" => Quantity::find("alpha"),
        "alpha" => Quantity::find("roughness"),
        "mu" => Quantity::find("theta"),
        "theta" => Quantity::find("mu"),
        _ => None,
    };
    if let Some(quantity) = other {
        let whole = axis.domain.iter().zip(axis.quantity.domain).all(|(a, b)| (a - b).abs() == 0.0);
        let domain = if whole { quantity.domain } else { axis.domain };
        all.push((Axis { quantity, domain, ..axis.clone() }, format!("those of {}", quantity.id)));
    }
    if axis.direction == Direction::Descending {
        all.push((Axis { direction: Direction::Ascending, ..axis.clone() }, "ascending".to_owned()));
    }
    all
}

/// The texel at the other end of some axes.
fn flip(grid: &Grid, texel: usize, axes: &[usize]) -> usize {
    let mut index = grid.unravel(texel);
    for &i in axes {
        index[i] = grid.axes()[i].len - 1 - index[i];
    }
    ravel(grid, &index)
}

fn swap(grid: &Grid, texel: usize, i: usize, j: usize) -> usize {
    let mut index = grid.unravel(texel);
    index.swap(i, j);
    ravel(grid, &index)
}

fn ravel(grid: &Grid, index: &[usize]) -> usize {
    grid.axes().iter().zip(index).rev().fold(0, |n, (axis, i)| n * axis.len + i)
}
