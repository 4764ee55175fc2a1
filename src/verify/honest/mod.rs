//! An estimate is honest: at seeded texels the baked value is compared with a rule that shares nothing with the baker's.
//!
//! Every row is met at least once, and 135 texels or all of them: a fault in 5 % of the texels, or in a whole row, of five times
//! estimate plus tolerance is found with a probability above 0.999 (`tests/laws/honest.rs`). A texel that the rule cannot judge (its
//! own error is above half of estimate plus tolerance) is replaced by another one of its row; where too few are left the law was not
//! checked, and says so.
//!
//! Each family of [`Role`]s has a rule of its own kind. The parameters of a fit have none, nor has the light in a layer of fibres, of
//! which random walks are all there is to compare with ([`cross_check`](super::cross_check)).

mod colour;
mod direction;
mod fresnel;
mod hemisphere;
mod integrals;
mod media;
mod models;
mod normals;
mod profiles;
mod quad;
mod sensitivity;
mod shapes;
mod sphere;
mod strata;
mod weight;

use super::{Case, Law, Outcome, Watch};
use crate::tables::{Role, Spec, place};
pub(super) use integrals::albedo;
use rayon::prelude::*;
pub use strata::{LEAST, Row, rows};

/// The law.
pub static LAW: Law = Law {
    id: "honest",
    statement: "at seeded texels, each row at least once, the value is that of an independent rule within three estimates",
    margin: "the larger of 3 estimates and 1e-13 max(1, E), plus the error of the rule, minus the difference",
    code: 4005,
    formal: false,
    concerns: |spec| spec.roles().into_iter().any(has_rule),
    check,
};

/// How many estimates a value may be off, and the rounding that nobody is blamed for.
const ESTIMATES: f64 = 3.0;
const ROUNDING: f64 = 1e-13;

/// How many times its own estimate the error of a rule is taken to be: at kinks that it does not know its two sums agree too soon.
const DOUBT: f64 = 2.0;

/// The part of its value that the error of a sum may be before the sum counts as not settled.
const UNSETTLED: f64 = 0.1;

/// Largest part of the texels that no rule could judge for which the law still counts as checked.
const LOST: f64 = 0.05;

/// A value by an independent rule, and how far it may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Truth {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// Is there an independent rule for a channel?
fn has_rule(role: Role) -> bool {
    !matches!(
        role,
        Role::Matrix(..)
            | Role::FitDistance(..)
            | Role::Variance
            | Role::GaussianWeight(_)
            | Role::GaussianResidual(_)
            | Role::FibreAlbedo(_)
            | Role::FibreLobe(..)
            | Role::FibreDistance
    )
}

/// By which route the integrals of lobes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Route {
    /// The sum that every value is compared with.
    First,
    /// In other panels, finer, lobe by lobe: asked where the first one refutes a value.
    Second,
    /// By drawing from the model: what a narrow lobe that both sums pass by would show in.
    Drawn,
}

/// One question to a rule.
#[derive(Debug, Clone, Copy)]
struct Asked<'a> {
    spec: &'a Spec,
    /// Base values of the point.
    at: &'a [f64],
    /// The baked values of the texel.
    baked: &'a [f64],
    /// For each channel the error that the rule should aim at.
    targets: &'a [f64],
    /// Index of the texel.
    texel: usize,
    route: Route,
}

/// The rules of a table.
struct Rules<'a> {
    case: &'a Case<'a>,
    /// What each stored number may be off besides its estimate, `[texel][channel]`; empty where nothing is.
    slack: &'a [f64],
    models: models::Models,
    profiles: Option<profiles::Profiles>,
    colour: Option<colour::Colour>,
    directions: direction::Directions,
}

impl<'a> Rules<'a> {
    fn new(case: &'a Case<'a>, slack: &'a [f64]) -> Rules<'a> {
        let spec = case.spec();
        Rules {
            case,
            slack,
            models: models::Models::new(spec),
            profiles: profiles::Profiles::new(spec),
            colour: colour::Colour::new(spec),
            directions: direction::Directions::new(spec),
        }
    }

    /// What the rules say of every channel of a texel; nothing where they cannot say.
    fn truths(&self, asked: &Asked<'_>) -> Vec<Option<Truth>> {
        let roles = asked.spec.roles();
        let mut truths = self.models.truths(asked, &roles);
        for (truth, other) in truths.iter_mut().zip(self.directions.truths(asked, &roles)) {
            *truth = truth.or(other);
        }
        for (c, (role, truth)) in roles.into_iter().zip(&mut truths).enumerate() {
            if truth.is_none() {
                *truth = fresnel::truth(role, asked.spec, asked.at)
                    .or_else(|| normals::truth(role, asked))
                    .or_else(|| sensitivity::truth(role, asked))
                    .or_else(|| media::truth(role, asked, c))
                    .or_else(|| sphere::truth(role, asked))
                    .or_else(|| own(role, asked, c))
                    .or_else(|| self.profiles.as_ref().and_then(|p| p.truth(role, asked, c)))
                    .or_else(|| self.colour.as_ref().and_then(|p| p.truth(role, asked, c)));
            }
        }
        truths
    }

    /// Judges every channel of a texel that has a rule; false where one of them could not be judged.
    fn judge(&self, texel: usize, watch: &mut Watch) -> bool {
        let (case, spec) = (self.case, self.case.spec());
        let point = case.table.grid.texel(texel);
        let n = case.table.channels.len();
        let targets: Vec<f64> = (0..n).map(|c| 0.9 / DOUBT * self.limit(texel, c)).collect();
        let ask = |route| {
            let asked = Asked {
                spec,
                at: point.values(),
                baked: case.table.at(texel),
                targets: &targets,
                texel,
                route,
            };
            self.truths(&asked)
        };
        let first = ask(Route::First);
        let (mut second, mut drawn) = (None, None);
        let mut judged = true;
        for (c, channel) in spec.layout.channels.iter().enumerate().filter(|(_, c)| has_rule(c.role)) {
            let mut verdict = self.verdict(texel, c, first[c]);
            // one sum may be short of a lobe: before a value is blamed another one is asked
            if matches!(verdict, Verdict::Margin(margin, _) if margin < 0.0) || first[c].is_none() {
                let again = second.get_or_insert_with(|| ask(Route::Second))[c];
                verdict = self.settle(verdict, self.verdict(texel, c, again));
            }
            if let Verdict::Margin(margin, truth) = &verdict
                && *margin < 0.0
            {
                let draws = drawn.get_or_insert_with(|| ask(Route::Drawn))[c];
                if let Some(draws) = draws.filter(|d| (d.value - truth.value).abs() > d.error + truth.error) {
                    let Truth { value, error } = draws;
                    let why = format!(
                        "the independent sum {:e} and draws from the model, {value:e} +- {error:.1e}, disagree",
                        truth.value
                    );
                    verdict = Verdict::Unknown(why);
                }
            }
            let place = || place(&case.table.grid, texel);
            match verdict {
                Verdict::Margin(margin, truth) => watch.see(margin, || {
                    let (v, e) = case.at(texel, c);
                    let Truth { value, error } = truth;
                    format!("{} = {v:e} +- {e:.1e} against {value:e} +- {error:.1e}, {}", channel.id, place())
                }),
                Verdict::Unknown(why) => {
                    watch.miss(|| format!("{}: {why}, {}", channel.id, place()));
                    judged = false;
                }
            }
        }
        judged
    }

    /// How far off a rule may be to judge a channel.
    fn limit(&self, texel: usize, channel: usize) -> f64 {
        let slack = self.slack(texel, channel);
        0.5 * (self.case.at(texel, channel).1 + self.case.tolerance + 0.5 * slack)
    }

    fn slack(&self, texel: usize, channel: usize) -> f64 {
        let i = texel * self.case.table.channels.len() + channel;
        self.slack.get(i).copied().unwrap_or(0.0)
    }

    /// Is every channel of a texel that can be judged as the first sum says? Nothing where none can.
    fn agrees(&self, texel: usize) -> Option<bool> {
        let (spec, table) = (self.case.spec(), self.case.table);
        let point = table.grid.texel(texel);
        let targets: Vec<f64> =
            (0..table.channels.len()).map(|c| 0.9 / DOUBT * self.limit(texel, c)).collect();
        let truths = self.truths(&Asked {
            spec,
            at: point.values(),
            baked: table.at(texel),
            targets: &targets,
            texel,
            route: Route::First,
        });
        let mut agrees = None;
        for (c, truth) in
            truths.into_iter().enumerate().filter(|(c, _)| has_rule(spec.layout.channels[*c].role))
        {
            if let Verdict::Margin(margin, _) = self.verdict(texel, c, truth) {
                agrees = Some(margin >= 0.0 && agrees.unwrap_or(true));
            }
        }
        agrees
    }

    fn verdict(&self, texel: usize, channel: usize, truth: Option<Truth>) -> Verdict {
        let (v, e) = self.case.at(texel, channel);
        match truth {
            Some(t) if t.value.is_finite() && DOUBT * t.error <= self.limit(texel, channel) => {
                let allowed = (ESTIMATES * e).max(ROUNDING * t.value.abs().max(1.0))
                    + self.slack(texel, channel)
                    + DOUBT * t.error;
                let off = (v - t.value).abs();
                // a sum that knows its own first digit hardly has not seen its integrand: it blames no value within the tolerance
                let unsettled = DOUBT * t.error >= UNSETTLED * t.value.abs();
                if off > allowed && unsettled && off <= self.limit(texel, channel) {
                    return Verdict::Unknown(format!(
                        "an independent sum is {:.1e} +- {:.1e}",
                        t.value, t.error
                    ));
                }
                Verdict::Margin(allowed - off, t)
            }
            Some(t) if t.value.is_finite() => {
                Verdict::Unknown(format!("the independent rule is only sure to {:.1e}", DOUBT * t.error))
            }
            _ => Verdict::Unknown("the independent rule has no value".to_owned()),
        }
    }

    /// What two sums say together: either may confirm a value, both must refute it, and agree with each other.
    fn settle(&self, first: Verdict, second: Verdict) -> Verdict {
        match (&first, &second) {
            (Verdict::Margin(_, a), Verdict::Margin(margin, b)) if *margin < 0.0 => {
                let apart = (a.value - b.value).abs();
                if apart <= a.error + b.error + ROUNDING * a.value.abs().max(1.0) {
                    return second;
                }
                Verdict::Unknown(format!("two independent sums differ by {apart:.1e}"))
            }
            (Verdict::Margin(..), Verdict::Unknown(_)) => {
                Verdict::Unknown("a finer independent sum does not bear the first one out".to_owned())
            }
            _ => second,
        }
    }
}

/// The rule that a kind has beside its formula.
fn own(role: Role, asked: &Asked<'_>, c: usize) -> Option<Truth> {
    let Role::Own(own) = role else { return None };
    let (value, error) = (own.truth)(asked.spec, asked.at, asked.targets[c], &quad::integral)?;
    Some(Truth { value, error })
}

/// What a rule says of a value.
enum Verdict {
    /// Distance to what is allowed, and the truth that it was measured from.
    Margin(f64, Truth),
    /// Nothing, for this reason.
    Unknown(String),
}

/// What came of a texel, or of those that stood in for it.
#[derive(Debug, Clone)]
pub struct Looked {
    /// What was seen of its channels.
    pub watch: Watch,
    /// False where no texel of the row could be judged.
    pub judged: bool,
}

/// Looks at the texels of `rows`. `slack` is what each stored number may be off besides its estimate, `[texel][channel]`, or empty.
#[must_use]
pub fn look(case: &Case<'_>, slack: &[f64], rows: &[Row]) -> Vec<Looked> {
    let rules = Rules::new(case, slack);
    let one = |row: &Row| {
        let mut watch = Watch::default();
        let judged = row.iter().take_while(|_| case.goes_on()).any(|t| rules.judge(*t, &mut watch));
        Looked { watch, judged }
    };
    rows.par_iter().map(one).collect()
}

/// Are all numbers that can be judged at the first texels of `rows` those of the table? The first one that is not ends it. At least
/// `least` texels must be judged.
#[must_use]
pub fn agree(case: &Case<'_>, slack: &[f64], rows: &[Row], least: usize) -> bool {
    let rules = Rules::new(case, slack);
    let judged: Option<usize> = rows
        .par_iter()
        .map(|row| match row.first().filter(|_| case.goes_on()).and_then(|t| rules.agrees(*t)) {
            Some(true) => Some(1),
            Some(false) => None,
            None => Some(0),
        })
        .try_reduce(|| 0, |a, b| Some(a + b));
    judged.is_some_and(|judged| judged >= least)
}

/// Is there a rule for a channel of the table?
#[must_use]
pub fn concerns(spec: &Spec) -> bool {
    (LAW.concerns)(spec)
}

fn check(case: &Case<'_>) -> Outcome {
    let looked = look(case, &[], &rows(&case.table.grid, 0x40e5, LEAST));
    outcome(looked)
}

/// What the texels say together.
#[must_use]
pub fn outcome(looked: Vec<Looked>) -> Outcome {
    let lost = looked.iter().filter(|l| !l.judged).count();
    let total = looked.len();
    let mut watch = Watch::default();
    for l in looked {
        watch.join(l.watch);
    }
    let few = lost as f64 > (LOST * total as f64).max(1.0);
    if few && !watch.is_broken() && watch.checked() > 0 {
        let why = watch.why().unwrap_or_default().to_owned();
        return Outcome::NotChecked(format!("{lost} of {total} texels could not be judged: {why}"));
    }
    watch.outcome("no channel has an independent rule")
}
