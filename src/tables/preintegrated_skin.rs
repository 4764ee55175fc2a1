//! Pre-integrated skin: diffuse light on a round surface of skin, blurred by its diffusion profile.
//!
//! `D(theta, 1/r)` is what a point of a ball of radius r sends out where the light stands at angle theta to its normal.
//! A shader looks it up by N.L and an estimate of the curvature, and gets soft, reddish terminators from one fetch.
//!
//! # Which ball
//! * `ring` (the published one): the ball is a ring in the plane of the light,
//!   `D = int max(0, cos(theta + x)) R(2r sin(|x|/2)) dx / int R(2r sin(|x|/2)) dx`, x from -pi to pi. Some ports stop at
//!   +-pi/2, which is another table for small r. A profile that grows as 1/r (normalised diffusion) has no such table: both
//!   integrals diverge, and the ratio is the unblurred clamp(N.L).
//! * `sphere`: over the sphere, `D = int max(0, n'.l) R(|p - p'|) dA' / int R dA'`, with the chord as distance. With beta the
//!   angle to the point and `s = 2r sin(beta/2)`, dA = 2 pi s ds: the weight is the profile's own ring density, and the
//!   denominator is its cumulative distribution at 2r. This keeps the energy that lands on the ball, and takes every
//!   profile.
//!
//! Both divide by the part of the profile that fits on the ball, so that a uniformly lit one stays as bright.
//! Integrals run over the angle, split at the kinks of the clamped cosine and at the scales of the profile.

use super::profile::{self, Profile, Rgb};
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::{Estimate, MAX_CHANNELS, Sums, line};
use crate::models::{Param, ParamError};
use std::f64::consts::{FRAC_PI_2, PI};

const fn channel(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role: Role::BlurredLight(band) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "preintegrated-skin",
    title: "Pre-integrated skin",
    formula: "ring: D = int_-pi^pi max(0, cos(theta + x)) R(2 r sin(|x|/2)) dx / int_-pi^pi R(2 r sin(|x|/2)) dx; \
        sphere: the same over the area of the sphere",
    sources: &SOURCES,
    coordinates: &["ndotl", "curvature"],
    layouts: &[Layout {
        id: "rgb",
        doc: "diffuse light = irradiance of the light at normal incidence * albedo / pi * texel",
        channels: &[
            channel("skin.r", "D of red light", Band::Red),
            channel("skin.g", "D of green light", Band::Green),
            channel("skin.b", "D of blue light", Band::Blue),
        ],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &PARAMS,
    laws: &["finite", "range", "total", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The row of curvature 0 is clamp(N.L) exactly. Penner's axes: ndotl from -1 to 1, curvature 1/r in 1/mm; lengths in mm. \
        Profile burley needs over = sphere: on a ring its 1/r makes both integrals diverge.",
    bind,
};

static PARAMS: [Param; 1 + profile::PARAMS.len()] = profile::with(Param::choice(
    "over",
    "what is blurred: a ring, as published, or the sphere",
    &["ring", "sphere"],
));

/// Own sources, and those of profiles.
static SOURCES: [Source; 2 + profile::SOURCES.len()] = profile::with_sources([
    Source::new(cite::PENNER_2011, "the integral of the diffusion profile over a ring")
        .when("over", &["ring"]),
    Source::new(cite::PENNER_2011, "the idea, here over the sphere").when("over", &["sphere"]),
]);

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    // odd, so that the terminator, a kink where nothing is curved, lies on a texel: four times better than 128
    let axis =
        |id: &str, len, domain| Quantity::find(id).map(|q| Axis::new(q, len, Texel::Endpoint).over(domain));
    [axis("ndotl", 129, [-1.0, 1.0]), axis("curvature", 128, [0.0, 1.0])].into_iter().flatten().collect()
}

struct Skin {
    ndotl: usize,
    curvature: usize,
    profile: Profile,
    sphere: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let profile = Profile::new(spec)?;
    let sphere = spec.params.choice("over")? == "sphere";
    if profile.is_singular() && !sphere {
        let why = "profile burley has no integral over a ring (R grows as 1/r); set over = \"sphere\"";
        return Err(ParamError::Together { model: spec.kind.id, why: why.to_owned() }.into());
    }
    Ok(Box::new(Skin {
        ndotl: spec.coordinate("ndotl")?,
        curvature: spec.coordinate("curvature")?,
        profile,
        sphere,
    }))
}

impl Baker for Skin {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (mu, curvature) = (at[self.ndotl], at[self.curvature]);
        if curvature <= 0.0 {
            let mut value = [0.0; MAX_CHANNELS];
            value[..3].fill(mu.max(0.0));
            return Ok(Estimate::exact(value));
        }
        let blur = Blur::new(&self.profile, self.sphere, libm::acos(mu), 1.0 / curvature);
        super::finite(blur.integrate(tolerance), 3)
    }

    fn rule(&self) -> String {
        "adaptive Gauss-Kronrod (7, 15) over the angle, split at kinks and at the scales of the profile; curvature 0: closed form"
            .to_owned()
    }
}

/// One texel: light at angle theta, radius r in mm.
struct Blur<'a> {
    profile: &'a Profile,
    sphere: bool,
    theta: f64,
    r: f64,
    breaks: Vec<f64>,
}

impl Blur<'_> {
    fn new(profile: &Profile, sphere: bool, theta: f64, r: f64) -> Blur<'_> {
        let mut breaks = vec![0.0, PI];
        // where a side of the ring, or a circle round the point, enters or leaves the light
        let kinks = [FRAC_PI_2 - theta, theta - FRAC_PI_2, 1.5 * PI - theta, theta + FRAC_PI_2];
        let chords = profile.scales().into_iter().map(|s| 0.5 * s / r).filter(|x| *x < 1.0);
        breaks.extend(kinks.into_iter().chain(chords.map(|x| 2.0 * libm::asin(x))));
        breaks.retain(|x| (0.0..=PI).contains(x));
        breaks.sort_by(f64::total_cmp);
        Blur { profile, sphere, theta, r, breaks }
    }

    /// The quotient, to `tolerance`: both integrals in one pass, over a first guess of the denominator.
    fn integrate(&self, tolerance: f64) -> Estimate {
        let guess = self.sums(f64::INFINITY, [1.0; 3]);
        let scale = [3, 4, 5].map(|c| 1.0 / guess.value[c].max(f64::MIN_POSITIVE));
        let sums = self.sums(0.45 * tolerance, scale);
        let mut e = Estimate {
            value: [0.0; MAX_CHANNELS],
            error: [0.0; MAX_CHANNELS],
            evaluations: guess.evaluations.saturating_add(sums.evaluations),
        };
        for c in 0..3 {
            let (above, below) = (sums.value[c], sums.value[3 + c]);
            e.value[c] = above / below;
            e.error[c] = (sums.error[c] + e.value[c] * sums.error[3 + c]) / below;
        }
        e
    }

    /// Numerators and denominators of the channels.
    fn sums(&self, tolerance: f64, scale: Rgb) -> Estimate {
        line::integrate(&self.breaks, 6, tolerance, &mut |x, out: &mut Sums| {
            let (sin, cos) = libm::sincos(0.5 * x);
            let chord = 2.0 * self.r * sin;
            // dA = 2 pi s ds with s the chord, ds = r cos(x/2) dx
            let (weight, light) = if self.sphere {
                (self.profile.ring(chord).map(|w| w * self.r * cos), circle(self.theta, x))
            } else {
                (self.profile.at(chord), ring(self.theta, x))
            };
            for c in 0..3 {
                out[3 + c] = weight[c] * scale[c];
                out[c] = out[3 + c] * light;
            }
        })
    }
}

/// Mean of the clamped cosine on both sides of the ring, x away.
fn ring(theta: f64, x: f64) -> f64 {
    0.5 * (libm::cos(theta + x).max(0.0) + libm::cos(theta - x).max(0.0))
}

/// Mean of the clamped cosine over the circle at angle `beta` round a point where the light stands at `theta`.
///
/// `1/pi int_0^phi (a + b cos phi) dphi`, a = cos theta cos beta, b = sin theta sin beta, up to phi = acos(-a/b).
#[must_use]
pub fn circle(theta: f64, beta: f64) -> f64 {
    let (sin_t, cos_t) = libm::sincos(theta);
    let (sin_b, cos_b) = libm::sincos(beta);
    let (a, b) = (cos_t * cos_b, sin_t * sin_b);
    if a >= b {
        a
    } else if a <= -b {
        0.0
    } else {
        (a * libm::acos(-a / b) + ((b - a) * (b + a)).sqrt()) / PI
    }
}
