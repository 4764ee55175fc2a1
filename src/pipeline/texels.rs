//! What the texels of a file hold: the integrals, or values fitted to the reader; and which of them, where the recipe leaves
//! that open.

use super::fit::{Blend, Figures, Fitted, WHOLE, pure, weights};
use crate::cancel::Cancel;
use crate::encode::{self, Quantised, Storage, Unstored};
use crate::grid::Table;
use crate::grid::fit::{Objective, Texels};
use crate::grid::provenance::{ChannelTexels, ChoiceRecord, Reconstruction, Spread, TexelRecord};
use crate::grid::table::named;
use crate::math::figures::exact;
use crate::tables::Bound;
use crate::verify::reconstruction::Probe;

/// What a fit must leave of the errors of the exact values, in the geometric mean of its four figures, to be worth that a texel
/// is no sample any more.
const WORTH: f64 = 0.9;
/// Errors below this count as equal.
const NEGLIGIBLE: f64 = 1e-12;

/// The integrals of a table, what was fitted to them, and what measures how either reads.
pub(super) struct Source<'a> {
    pub(super) bound: &'a Bound,
    pub(super) table: &'a Table,
    pub(super) fitted: Option<&'a Fitted>,
    pub(super) probe: Option<&'a Probe<'a>>,
    pub(super) cancel: &'a Cancel,
}

/// The numbers of a file.
pub(super) struct Chosen {
    pub(super) stored: Quantised,
    pub(super) reconstruction: Option<Reconstruction>,
    pub(super) texels: Option<TexelRecord>,
}

/// Values for all channels as they are stored, and how they read at the points of the fit.
struct Candidate {
    stored: Quantised,
    figures: Vec<[Figures; 2]>,
}

impl Source<'_> {
    /// Rounds and measures what is asked for, and all choices where texels are fitted. Minimax that reads no better than
    /// the integrals, as stored, gives way to them.
    pub(super) fn choose(&self, asked: Texels, storage: Storage) -> Result<Chosen, Unstored> {
        let Some(fitted) = self.fitted else {
            let stored = encode::quantise_table_until(self.cancel, self.table, storage)?;
            let reconstruction = self.probe.map(|p| p.measure(&stored.values));
            return Ok(Chosen { stored, reconstruction, texels: None });
        };
        let n = self.table.channels.len();
        let [exact, squares, minimax] =
            Objective::ALL.map(|o| self.candidate(fitted, &vec![pure(o); n], storage));
        let mut all = vec![exact?, squares?, minimax?];
        let measured = [0, 1, 2].map(|i| self.measure(fitted, &all[i], i > 0));
        let held = match asked {
            Texels::Held(Objective::Minimax) if no_better(&measured) => vec![pure(Objective::Exact); n],
            Texels::Held(objective) => vec![pure(objective); n],
            Texels::Better => self.better(fitted, &all, storage)?,
        };
        let mut record = self.record(fitted, asked, &held);
        for (objective, r) in Objective::ALL.iter().zip(&measured).filter_map(|(o, r)| Some((o, r.as_ref()?)))
        {
            record.choices.push(ChoiceRecord {
                texels: objective.id().to_owned(),
                whole: r.whole.clone(),
                practical: r.practical.clone(),
            });
        }
        let index = Objective::ALL.iter().position(|o| held.iter().all(|h| *h == pure(*o)));
        let (stored, reconstruction) = match index {
            Some(i) => (all.swap_remove(i).stored, measured[i].clone()),
            None => {
                let mixed = self.candidate(fitted, &held, storage)?;
                let reconstruction = self.measure(fitted, &mixed, true);
                (mixed.stored, reconstruction)
            }
        };
        Ok(Chosen { stored, reconstruction, texels: Some(record) })
    }

    fn record(&self, fitted: &Fitted, asked: Texels, held: &[Blend]) -> TexelRecord {
        let values = self.mix(fitted, held);
        let change = values.iter().zip(&self.table.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let first = held.first().copied().unwrap_or(pure(Objective::Exact));
        let plain = Objective::ALL.into_iter().find(|o| pure(*o) == first);
        let mut record = TexelRecord {
            asked: asked.id().to_owned(),
            held: named_blend(first),
            by_channel: Vec::new(),
            meaning: plain.map_or(BLENDED, Objective::meaning).to_owned(),
            samples: fitted.points(),
            largest_change: change,
            choices: Vec::new(),
        };
        if held.iter().any(|h| *h != first) {
            "by-channel".clone_into(&mut record.held);
            BLENDED.clone_into(&mut record.meaning);
            let channels = self.table.channels.iter().zip(held);
            record.by_channel = channels
                .map(|(c, h)| ChannelTexels { channel: c.id.clone(), held: named_blend(*h) })
                .collect();
        }
        record
    }

    /// `[texel][channel]`, each channel a blend.
    fn mix(&self, fitted: &Fitted, held: &[Blend]) -> Vec<f64> {
        let (exact, n) = (&self.table.values, held.len());
        let channel = |(c, blend): (usize, &Blend)| fitted.blended(*blend, c, n, exact);
        let channels: Vec<Vec<f64>> = held.iter().enumerate().map(channel).collect();
        (0..exact.len()).map(|i| channels[i % n][i / n]).collect()
    }

    fn candidate(&self, fitted: &Fitted, held: &[Blend], storage: Storage) -> Result<Candidate, Unstored> {
        let table = Table { values: self.mix(fitted, held), ..self.table.clone() };
        let stored = encode::quantise_table_until(self.cancel, &table, storage)?;
        let figures = fitted.figures(self.bound, &stored.values);
        Ok(Candidate { stored, figures })
    }

    /// What the probe finds between the texels; with `everywhere` also at the points of the fit: fitted texels are off at their
    /// own places too.
    fn measure(&self, fitted: &Fitted, candidate: &Candidate, everywhere: bool) -> Option<Reconstruction> {
        let mut found = self.probe?.measure(&candidate.stored.values);
        if everywhere {
            found.points += fitted.points();
            self.raise(fitted, candidate, 0, &mut found.whole);
            if let Some(practical) = &mut found.practical {
                self.raise(fitted, candidate, 1, practical);
            }
        }
        Some(found)
    }

    /// Takes the largest error at the points of the fit if it is larger.
    fn raise(&self, fitted: &Fitted, candidate: &Candidate, part: usize, spread: &mut Spread) {
        let channels = self.bound.baker.decoded().unwrap_or(&self.bound.spec.layout.channels);
        for (channel, figures) in channels.iter().zip(&candidate.figures) {
            let Figures { largest, at, .. } = figures[part];
            if largest > spread.largest.value {
                spread.largest.value = largest;
                channel.id.clone_into(&mut spread.largest.channel);
                spread.largest.at = named(&self.table.grid, fitted.point(at));
            }
        }
    }

    /// What each channel should hold: the best of what is better than the exact values, a blend for each by itself where the shader
    /// takes them as they are; if channels that are stored together then spoil each other, one choice for all of them.
    fn better(&self, fitted: &Fitted, all: &[Candidate], storage: Storage) -> Result<Vec<Blend>, Unstored> {
        let n = self.table.channels.len();
        if self.bound.baker.decoded().is_none() {
            let ranked: Vec<Vec<Blend>> = (0..n).map(|c| self.ranked(fitted, c)).collect();
            let mut at = vec![0; n];
            loop {
                let held: Vec<Blend> = ranked.iter().zip(&at).map(|(blends, i)| blends[*i]).collect();
                let mixed = self.candidate(fitted, &held, storage)?;
                let worse = |c: &usize| gain(&all[0].figures[*c], &mixed.figures[*c], LUCK).is_none();
                let worse: Vec<usize> = (0..n).filter(worse).collect();
                if worse.is_empty() {
                    return Ok(held);
                }
                // rounding may have spoilt what was gained: the next blend then; exact values have none
                let blended = |c: &usize| held[*c] != pure(Objective::Exact);
                let spoilt: Vec<usize> = worse.into_iter().filter(blended).collect();
                if spoilt.is_empty() {
                    break;
                }
                spoilt.into_iter().for_each(|c| at[c] = (at[c] + SKIPPED).min(ranked[c].len() - 1));
            }
        }
        let last = all[0].figures.len().saturating_sub(1);
        Ok(vec![pure(best(all, 0..=last)); n])
    }

    /// The blends of a channel that are worse than the exact values by no measure, the best one first and the exact values last.
    fn ranked(&self, fitted: &Fitted, channel: usize) -> Vec<Blend> {
        let blends: Vec<Blend> = blends();
        let n = self.table.channels.len();
        let figures = fitted.figures_of_blends((channel, n), &self.table.values, &blends);
        let gains = figures.iter().map(|f| gain(&figures[0], f, 0.0));
        let mut better: Vec<(f64, Blend)> =
            gains.zip(&blends).filter_map(|(gain, blend)| Some((gain?, *blend))).collect();
        better.retain(|(gain, _)| *gain < libm::log(WORTH));
        better.sort_by(|a, b| a.0.total_cmp(&b.0));
        better.into_iter().map(|(_, blend)| blend).chain([blends[0]]).collect()
    }
}

/// How many blends are passed over after one that rounding has spoilt: its neighbours are much like it.
const SKIPPED: usize = 3;

/// What is said of texels that are no one objective's.
const BLENDED: &str =
    "texels of fitted channels are not samples: together they read, interpolated, closest to the truth";

/// The blends that are tried, the exact values first.
fn blends() -> Vec<Blend> {
    let of = |i: u8| (0..=i).map(move |j| [WHOLE - i, i - j, j]);
    (0..=WHOLE).flat_map(of).collect()
}

/// `least-squares`, or `0.25 exact + 0.75 minimax`.
fn named_blend(blend: Blend) -> String {
    let parts = Objective::ALL.into_iter().zip(weights(blend)).filter(|(_, part)| *part > 0.0);
    let one = |(o, part): (Objective, f64)| {
        if blend == pure(o) { o.id().to_owned() } else { format!("{} {}", exact(part), o.id()) }
    };
    parts.map(one).collect::<Vec<_>>().join(" + ")
}

/// The objective that gains most on channels of which it is worse by no measure; exact if none gains enough.
fn best(all: &[Candidate], channels: std::ops::RangeInclusive<usize>) -> Objective {
    let mut best = (libm::log(WORTH), Objective::Exact);
    for (objective, candidate) in Objective::ALL.into_iter().zip(all).skip(1) {
        let gains: Option<Vec<f64>> =
            channels.clone().map(|c| gain(&all[0].figures[c], &candidate.figures[c], 0.0)).collect();
        let Some(gains) = gains else { continue };
        let mean = gains.iter().sum::<f64>() / gains.len().max(1) as f64;
        if mean < best.0 {
            best = (mean, objective);
        }
    }
    best.1
}

/// By how much a figure may be worse after rounding, which falls on either side, of a blend that gains without it.
const LUCK: f64 = 0.02;

/// Mean logarithm of the ratios of the four figures of a channel; none if one of them is worse by more than a part of `luck`.
fn gain(exact: &[Figures; 2], fitted: &[Figures; 2], luck: f64) -> Option<f64> {
    let mut sum = 0.0;
    for (e, f) in exact.iter().zip(fitted) {
        for (e, f) in [(e.largest, f.largest), (e.mean, f.mean)] {
            if f > e * (1.0 + luck) + NEGLIGIBLE {
                return None;
            }
            sum += libm::log((f + NEGLIGIBLE) / (e + NEGLIGIBLE));
        }
    }
    Some(0.25 * sum)
}

fn no_better(measured: &[Option<Reconstruction>; 3]) -> bool {
    let largest = |i: usize| measured[i].as_ref().map(|r| r.whole.largest.value);
    largest(0).zip(largest(2)).is_some_and(|(exact, minimax)| minimax >= exact)
}
