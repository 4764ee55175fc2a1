//! The split-sum table: the environment BRDF of a rough surface under a uniform sky, with the Fresnel factor split off.
//!
//! A shader multiplies its prefiltered radiance by `F0 * scale + F90 * bias`, or, in the multiscatter layout, by
//! `mix(fc, total, F0)`, and can add the energy lost to multiple scattering by `1 + F0 (1 / total - 1)`.
//!
//! Metals whose reflectance dips near 82 degrees take a third channel: for Schlick's factor with the F82 tint,
//! `F = F0 + (1 - F0) Fc - b v (1 - v)^6`, the albedo is exactly `F0 * scale + bias - d * f82`, with
//! `d = (F0 + (1 - F0) (6/7)^5) (1 - tint)`, what F lies below Schlick's curve at v = 1/7.

use super::default_axes::{coupled, split_sum, view_and_roughness};
use super::integral::{Functional, integrate};
use super::role::{Light, Lobe, OtherLobe, Side, Weight};
use super::sweep::Sweep;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, Sums};
use crate::math::lanes::LANES;
use crate::models::{self, Brdf};
use crate::terms::schlick;

const UNIT: [f64; 2] = [0.0, 1.0];

/// A part of the white albedo with its Fresnel weight.
const fn split(id: &'static str, meaning: &'static str, weight: Weight) -> ChannelInfo {
    ChannelInfo { id, meaning, range: UNIT, role: Role::Split(Lobe::White, weight, 1.0) }
}

/// What a lobe beside the model reflects.
const fn beside(lobe: &'static OtherLobe) -> Role {
    Role::Albedo(Lobe::Other(lobe), Light::All, Side::Above)
}

const SCALE: ChannelInfo = split("dfg.scale", "int (f/F) (1 - Fc) mu_i dwi", Weight::SchlickComplement);
const BIAS: ChannelInfo = split("dfg.bias", "int (f/F) Fc mu_i dwi", Weight::Schlick);
const FC: ChannelInfo = split("dfg.fc", "int (f/F) Fc mu_i dwi", Weight::Schlick);
const TOTAL: ChannelInfo = split("dfg.total", "int (f/F) mu_i dwi = E(mu, alpha), white", Weight::One);
const LOSS: ChannelInfo = ChannelInfo {
    id: "dfg.loss",
    meaning: "1 - int (f/F) mu_i dwi = 1 - E",
    range: UNIT,
    role: Role::Complement(Lobe::White, Side::Above),
};
const REST: ChannelInfo = ChannelInfo {
    id: "dfg.rest",
    meaning: "int (f/F) (Fc - (1 - mu)^5) mu_i dwi: bias without what a mirror of the same albedo has",
    range: [-1.0, 1.0],
    role: Role::SplitRest(Lobe::White),
};
const F82: ChannelInfo =
    split("dfg.f82", "int (f/F) v (1 - v)^6 / (1/7 (6/7)^6) mu_i dwi, v = wo.wh", Weight::F82);
const F82_X16: ChannelInfo = ChannelInfo {
    id: "dfg.f82-x16",
    meaning: "16 int (f/F) v (1 - v)^6 mu_i dwi, as Babylon.js stores it for OpenPBR",
    range: UNIT,
    role: Role::Split(Lobe::White, Weight::F82, 16.0 / schlick::F82_SCALE),
};
const CLOTH: ChannelInfo = ChannelInfo {
    id: "dfg.cloth",
    meaning: "int D V mu_i dwi, D of Charlie with r = alpha (not below 1e-6), V = 1 / (4 (mu_o + mu_i - mu_o mu_i))",
    range: [0.0, 400.0],
    role: beside(&CLOTH_LOBE),
};
const DIFFUSE: ChannelInfo = ChannelInfo {
    id: "dfg.diffuse",
    meaning: "int f mu_i dwi of Burley's diffuse lobe, colour 1, r = sqrt(alpha)",
    range: [0.0, 785.0 / 504.0],
    role: beside(&DIFFUSE_LOBE),
};

const DIFFUSE_HDRP: ChannelInfo = ChannelInfo {
    id: "dfg.diffuse-hdrp",
    meaning: "dfg.diffuse / 1.03571, kept in [0.5, 1.5], as Unity's HDRP stores it",
    range: [0.5, 1.5],
    role: Role::KeptAlbedo(Lobe::Other(&DIFFUSE_LOBE), 1.03571),
};

const DIFFUSE_FROSTBITE: ChannelInfo = ChannelInfo {
    id: "dfg.diffuse-frostbite",
    meaning: "int f mu_i dwi of Frostbite's diffuse lobe, colour 1, r = sqrt(alpha)",
    range: [0.0, 1.04],
    role: beside(&FROSTBITE_LOBE),
};

static CLOTH_LOBE: OtherLobe =
    OtherLobe { info: &models::charlie_neubelt::INFO, param: "roughness", from_alpha: |alpha| alpha };
static FROSTBITE_LOBE: OtherLobe =
    OtherLobe { info: &models::frostbite_diffuse::INFO, param: "r", from_alpha: f64::sqrt };
static DIFFUSE_LOBE: OtherLobe =
    OtherLobe { info: &models::burley_diffuse::INFO, param: "r", from_alpha: f64::sqrt };

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "dfg",
    title: "Split-sum DFG",
    formula: "scale = int (f/F) (1 - Fc) mu_i dwi, bias = int (f/F) Fc mu_i dwi, Fc = (1 - wo.wh)^5",
    sources: &[
        Source::new(cite::KARIS_2013, "section 'Environment BRDF', Eq. 8").of(is_of_the_model),
        Source::new(cite::KUTZ_2021, "the F82 tint, whose term is the channel f82")
            .of(|role| matches!(role, Role::Split(_, Weight::F82, _))),
        Source::new(cite::ESTEVEZ_KULLA_2017, "Eq. 2 (D of the cloth)").of(is_cloth),
        Source::new(cite::NEUBELT_PETTINEO_2013, "the visibility of the cloth").of(is_cloth),
        Source::new(cite::BURLEY_2012, "section 5.3 (the diffuse lobe)")
            .of(|role| role.lobe() == Some(Lobe::Other(&DIFFUSE_LOBE))),
        Source::new(cite::LAGARDE_2014, "section 3.1.2 (the diffuse lobe renormalised)")
            .of(|role| role.lobe() == Some(Lobe::Other(&FROSTBITE_LOBE))),
    ],
    coordinates: &["mu", "alpha"],
    layouts: &[
        Layout { id: "scale-bias", doc: "specular = F0 * scale + F90 * bias", channels: &[SCALE, BIAS] },
        Layout {
            id: "multiscatter",
            doc: "specular = mix(fc, total, F0), F90 = 1; energy compensation 1 + F0 (1 / total - 1)",
            channels: &[FC, TOTAL],
        },
        Layout {
            id: "factored",
            doc: "E = 1 - loss, bias = E (1 - mu)^5 + rest, scale = E - bias; both channels are smooth where a mirror begins",
            channels: &[LOSS, REST],
        },
        Layout {
            id: "f82",
            doc: "specular = F0 * scale + bias - (F0 + (1 - F0) (6/7)^5) (1 - tint) * f82, exact where F is not clamped",
            channels: &[SCALE, BIAS, F82],
        },
        Layout {
            id: "multiscatter-cloth",
            doc: "as multiscatter; cloth = the albedo of Charlie's sheen with roughness alpha, as Filament reads it",
            channels: &[FC, TOTAL, CLOTH],
        },
        Layout {
            id: "multiscatter-diffuse",
            doc: "as multiscatter; diffuse = the factor of the diffuse colour under a uniform sky",
            channels: &[FC, TOTAL, DIFFUSE],
        },
    ],
    mix: Mix::Free(&[F82_X16, DIFFUSE_HDRP, DIFFUSE_FROSTBITE]),
    model: ModelUse::Split("ggx"),
    params: &[],
    laws: &["finite", "range", "energy", "split", "cross-check", "reciprocity", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Anisotropic: axes mu, phi (the view azimuth), alpha_x and alpha_y; a width may be a parameter; or mu, phi, roughness and anisotropy (glTF's strength; rotation turns phi). alpha = 0 is the mirror: scale = 1 - (1 - mu)^5, bias = (1 - mu)^5. cloth grows as 1 / sqrt(2 pi alpha) where mu and \
        alpha go to 0 (9 in Filament's first texel), and diffuse exceeds 1 on rough surfaces at grazing: half floats hold them, \
        fixed point spreads its steps over their range.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    if setting.holds("dfg.loss") || setting.holds("dfg.rest") {
        // smooth where a mirror begins, so a gentler coupling serves
        return view_and_roughness(coupled(2.5, 4.0, 1.0), Warp::Power(0.65));
    }
    if setting.holds("dfg.f82") || setting.holds("dfg.f82-x16") {
        return view_and_roughness(coupled(4.0, 8.0, 0.25), Warp::Power(0.5));
    }
    split_sum()
}

fn is_of_the_model(role: Role) -> bool {
    role.lobe() == Some(Lobe::White)
}

fn is_cloth(role: Role) -> bool {
    role.lobe() == Some(Lobe::Other(&CLOTH_LOBE))
}

/// What a channel is integrated from.
#[derive(Clone, Copy)]
enum Part {
    /// A functional of the table's model, and its factor.
    Split(Functional, f64),
    /// 1 - E.
    Loss,
    /// The Schlick-weighted integral without (1 - mu)^5 E.
    Rest,
    /// The albedo of a lobe beside the model.
    Lobe(&'static OtherLobe),
    /// The same over a divisor, kept in the range of its channel.
    Kept(&'static OtherLobe, f64, [f64; 2]),
}

/// What loss and rest decode to, alone or before another channel.
const DECODED: &[&[ChannelInfo]] = &[
    &[SCALE, BIAS],
    &[SCALE, BIAS, F82],
    &[SCALE, BIAS, F82_X16],
    &[SCALE, BIAS, CLOTH],
    &[SCALE, BIAS, DIFFUSE],
    &[SCALE, BIAS, DIFFUSE_HDRP],
    &[SCALE, BIAS, DIFFUSE_FROSTBITE],
];

struct Dfg {
    sweep: Sweep,
    channels: Vec<&'static str>,
    parts: Vec<Part>,
    /// The functionals of the parts, in order: one pass serves them all.
    functionals: Vec<Functional>,
    /// Number of the axis of alpha; the model's own value if there is none.
    alpha: Result<usize, f64>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let mut parts = spec.each(part)?;
    for (part, channel) in parts.iter_mut().zip(&spec.layout.channels) {
        if let Part::Kept(_, _, range) = part {
            *range = channel.range;
        }
    }
    let lobes = parts.iter().all(|p| matches!(p, Part::Lobe(_) | Part::Kept(..)));
    if let Some((info, _)) =
        spec.model.as_ref().filter(|(info, _)| !lobes && info.measured("alpha").is_none())
    {
        let why =
            "has no alpha, so that every row over it would be the same; take `albedo`, or a model with alpha";
        return Err(BindError::Model { kind: spec.kind.id, model: info.id.to_owned(), why });
    }
    let mut functionals = Vec::new();
    for needed in parts.iter().flat_map(Part::functionals) {
        if !functionals.contains(&needed) {
            functionals.push(needed);
        }
    }
    let sweep = Sweep::new(spec, true)?;
    let own = spec.model.as_ref().and_then(|(info, params)| params.number(info.measured("alpha")?.id).ok());
    let alpha = match (spec.axis("alpha"), own) {
        (Some(axis), _) => Ok(axis),
        (None, Some(alpha)) => Err(alpha),
        (None, None) => Ok(spec.coordinate("alpha")?),
    };
    let widths = ["alpha_x", "alpha_y", "anisotropy"].map(|id| spec.axis(id).is_some());
    if widths.contains(&true) && parts.iter().any(|p| matches!(p, Part::Lobe(_) | Part::Kept(..))) {
        let why = "has two widths here, but cloth and diffuse go with one alpha; take a layout without them";
        let model = sweep.info().id.to_owned();
        return Err(BindError::Model { kind: spec.kind.id, model, why });
    }
    Ok(Box::new(Dfg { sweep, channels: spec.layout.ids().collect(), parts, functionals, alpha }))
}

impl Part {
    fn functionals(&self) -> Vec<Functional> {
        match self {
            Part::Split(g, _) => vec![*g],
            Part::Loss => vec![Functional::One],
            Part::Rest => vec![Functional::Schlick, Functional::One],
            Part::Lobe(_) | Part::Kept(..) => Vec::new(),
        }
    }
}

fn part(role: Role) -> Option<Part> {
    Some(match role {
        Role::Complement(Lobe::White, _) => Part::Loss,
        Role::SplitRest(Lobe::White) => Part::Rest,
        Role::Split(Lobe::White, weight, factor) => Part::Split(weight.functional()?, factor),
        Role::Albedo(Lobe::Other(lobe), ..) => Part::Lobe(lobe),
        Role::KeptAlbedo(Lobe::Other(lobe), divisor) => Part::Kept(lobe, divisor, UNIT),
        _ => return None,
    })
}

impl Dfg {
    /// By how much the white albedo is above 1 beyond its own estimate; 0 if it is not.
    fn above_one(&self, split: &Estimate) -> f64 {
        let of = |g| self.functionals.iter().position(|f| *f == g).map(|i| split.value[i] - split.error[i]);
        let sum = of(Functional::SchlickComplement).zip(of(Functional::Schlick)).map(|(a, b)| a + b);
        of(Functional::One).or(sum).map_or(0.0, |least| (least - 1.0).max(0.0))
    }

    /// What loss and rest, in this order and first, decode to; with one more channel at most.
    fn factored(&self) -> Option<&'static [ChannelInfo]> {
        let [Part::Loss, Part::Rest, more @ ..] = &self.parts[..] else { return None };
        let third = self.channels.get(2).copied();
        DECODED.iter().copied().find(|d| d.len() == more.len() + 2 && d.get(2).map(|c| c.id) == third)
    }

    /// The tolerance of the integrals: the rest adds two errors.
    fn share(&self, tolerance: f64) -> f64 {
        if self.parts.iter().any(|p| matches!(p, Part::Rest)) { 0.5 * tolerance } else { tolerance }
    }

    /// Four texels at once, if the kernel serves them.
    fn four(&self, at: &[&[f64]], tolerance: f64) -> Option<Vec<Result<Estimate, TexelError>>> {
        let four = self.sweep.four(at, &self.functionals, self.share(tolerance))?;
        let each = at.iter().zip(four).map(|(at, (model, split))| {
            let split = self.passive(split?, &*model, at, tolerance)?;
            self.channels_of(&split, at, tolerance)
        });
        Some(each.collect())
    }

    /// No white albedo is above 1: an estimate that says so is one of the few that are too small.
    fn passive(
        &self,
        mut split: Estimate,
        model: &dyn Brdf,
        at: &[f64],
        tolerance: f64,
    ) -> Result<Estimate, TexelError> {
        if !self.sweep.info().laws.passive {
            return Ok(split);
        }
        let share = self.share(tolerance);
        for _ in 0..3 {
            if self.above_one(&split) <= 0.0 {
                break;
            }
            let finer = 0.1 * split.largest_error().min(share);
            let again = integrate(model, self.sweep.view(at), &self.functionals, finer)?;
            split = Estimate { evaluations: split.evaluations.saturating_add(again.evaluations), ..again };
        }
        // what is still above is off by that at least
        let excess = self.above_one(&split).min(share);
        split.error.iter_mut().for_each(|e| *e += excess);
        Ok(split)
    }

    /// The channels from the integrals of the model.
    fn channels_of(&self, split: &Estimate, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let view = self.sweep.view(at);
        let mut all = Estimate { evaluations: split.evaluations, ..Estimate::ZERO };
        let of = |g: Functional| {
            let i = self.functionals.iter().position(|f| *f == g).unwrap_or(0);
            (split.value[i], split.error[i])
        };
        for (c, part) in self.parts.iter().enumerate() {
            (all.value[c], all.error[c]) = match part {
                Part::Split(g, factor) => {
                    let (value, error) = of(*g);
                    (factor * value, factor * error)
                }
                Part::Loss => {
                    let (value, error) = of(Functional::One);
                    (1.0 - value, error)
                }
                Part::Rest => {
                    let ((fc, fc_error), (one, one_error)) = (of(Functional::Schlick), of(Functional::One));
                    let mirror = schlick::weight(view.mu);
                    (fc - mirror * one, fc_error + mirror * one_error)
                }
                Part::Lobe(lobe) | Part::Kept(lobe, ..) => {
                    let model = lobe.build(self.alpha.map_or_else(|alpha| alpha, |axis| at[axis]))?;
                    // an isotropic lobe: the azimuth of the view does not matter
                    let e = integrate(&*model, view.in_plane(), &[Functional::One], tolerance)?;
                    all.evaluations = all.evaluations.saturating_add(e.evaluations);
                    match part {
                        Part::Kept(_, divisor, [lo, hi]) => {
                            ((e.value[0] / divisor).clamp(*lo, *hi), e.error[0] / divisor)
                        }
                        _ => (e.value[0], e.error[0]),
                    }
                }
            };
        }
        Ok(all)
    }
}

impl Baker for Dfg {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let mut split = Estimate::ZERO;
        if !self.functionals.is_empty() {
            let model = self.sweep.model(at)?;
            split = integrate(&*model, self.sweep.view(at), &self.functionals, self.share(tolerance))?;
            split = self.passive(split, &*model, at, tolerance)?;
        }
        self.channels_of(&split, at, tolerance)
    }

    fn group(&self) -> usize {
        if self.functionals.is_empty() { 1 } else { LANES }
    }

    fn texels(&self, at: &[&[f64]], tolerance: f64) -> Vec<Result<Estimate, TexelError>> {
        self.four(at, tolerance).unwrap_or_else(|| at.iter().map(|at| self.texel(at, tolerance)).collect())
    }

    fn decoded(&self) -> Option<&'static [ChannelInfo]> {
        self.factored()
    }

    fn decode(&self, at: &[f64], values: &mut Sums) {
        if self.factored().is_some() {
            let (albedo, mirror) = (1.0 - values[0], schlick::weight(self.sweep.mu(at)));
            let bias = albedo * mirror + values[1];
            (values[0], values[1]) = (albedo - bias, bias);
        }
    }

    fn rule(&self) -> String {
        let lobes = self.parts.iter().any(|p| matches!(p, Part::Lobe(_) | Part::Kept(..)));
        let more = if lobes { "; cloth and diffuse each by its own rule" } else { "" };
        format!("{}{more}", self.sweep.rule())
    }
}
