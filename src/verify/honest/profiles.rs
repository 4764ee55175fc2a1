//! Diffusion profiles from their formulas, and everything that is made of them by sums over other variables than the bakers'.

use super::quad::{self, Sum, WIDE};
use super::{Asked, Truth};
use crate::tables::profile::{Profile, Rgb};
use crate::tables::role::{Band, Per};
use crate::tables::{Role, Spec};
use crate::terms::dipole::{Dipole, internal_reflectance};
use std::f64::consts::{FRAC_PI_2, PI};

/// Relative rounding of a value of a profile, and of the whole that it is divided by.
const ROUNDING: f64 = 3e-13;

/// Accuracy of sums whose whole is 1.
const TARGET: f64 = 1e-13;

/// The profile of a table, as its parameters give it, with the integral of each band by a sum.
#[derive(Debug)]
pub(super) struct Profiles {
    profile: Profile,
    /// `2 pi int R r dr` of [`Profiles::raw`].
    whole: Rgb,
    /// Is the table scaled to its albedo?
    albedo: bool,
}

impl Profiles {
    pub(super) fn new(spec: &Spec) -> Option<Profiles> {
        let about_profiles = |role: &Role| {
            matches!(
                role,
                Role::BlurredLight(_)
                    | Role::Profile(..)
                    | Role::ProfileWithin(_)
                    | Role::ProfileBeyond(..)
                    | Role::ProfileRadius(_)
                    | Role::Kernel(_)
                    | Role::KernelWithin(_)
            )
        };
        spec.roles().iter().find(|r| about_profiles(r))?;
        let profile = Profile::new(spec).ok()?;
        let albedo = spec.params.choice("scale").is_ok_and(|word| word == "albedo");
        let mut profiles = Profiles { profile, whole: [1.0; 3], albedo };
        profiles.whole = [Band::Red, Band::Green, Band::Blue].map(|band| {
            let ring = &mut |r: f64| 2.0 * PI * profiles.raw_times_radius(r, band);
            profiles.over_radii(0.0, f64::INFINITY, ring).0
        });
        Some(profiles)
    }

    /// `r R(r)` before any scaling.
    fn raw_times_radius(&self, r: f64, band: Band) -> f64 {
        let c = band.index();
        match &self.profile {
            Profile::Gaussians { lobes, .. } => {
                let one = |(v, w): &(f64, Rgb)| w[c] * r / (2.0 * PI * v) * libm::exp(-(r / v) * (0.5 * r));
                lobes.iter().map(one).sum()
            }
            Profile::Burley { scale, .. } => {
                let third = libm::exp(-r / (3.0 * scale[c]));
                // e^-x + e^(-x / 3)
                (third + third * third * third) / (8.0 * PI * scale[c])
            }
            Profile::Dipole(dipoles) => r * dipole(&dipoles[c], r),
        }
    }

    /// R times r, of whole 1.
    fn times_radius(&self, r: f64, band: Band) -> f64 {
        self.raw_times_radius(r, band) / self.whole[band.index()]
    }

    /// What the table is scaled by.
    fn factor(&self, band: Band) -> f64 {
        if !self.albedo {
            return 1.0;
        }
        match &self.profile {
            Profile::Gaussians { total, .. } | Profile::Burley { total, .. } => total[band.index()],
            Profile::Dipole(_) => self.whole[band.index()],
        }
    }

    /// A sum over radii between two, split where the profile changes its scale.
    fn over_radii(&self, from: f64, to: f64, f: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
        let scales = self.profile.scales();
        let end = to.min(scales.last().copied().unwrap_or(0.0));
        let mut breaks = vec![from];
        breaks.extend(scales.into_iter().filter(|s| *s > from && *s < end));
        breaks.push(end.max(from));
        quad::integral(&breaks, TARGET, f)
    }

    /// The part inside a radius.
    fn within(&self, r: f64, band: Band) -> (f64, f64) {
        self.over_radii(0.0, r, &mut |s| 2.0 * PI * self.times_radius(s, band))
    }

    /// The part beyond a radius.
    fn beyond(&self, r: f64, band: Band) -> (f64, f64) {
        let (value, error) =
            self.over_radii(r, f64::INFINITY, &mut |s| 2.0 * PI * self.times_radius(s, band));
        (value, error + 1e-16)
    }

    /// Roles of this file.
    pub(super) fn truth(&self, role: Role, asked: &Asked<'_>, c: usize) -> Option<Truth> {
        let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
        let scaled = |(value, error): (f64, f64), factor: f64| Truth {
            value: factor * value,
            error: factor * (error + ROUNDING * value),
        };
        match role {
            Role::Profile(per, band) => {
                let r = at("radius")?;
                let value = match per {
                    Per::Ring => 2.0 * PI * self.times_radius(r, band),
                    Per::Area if r > 0.0 => self.times_radius(r, band) / r,
                    Per::Area => self.at_centre(band)?,
                };
                Some(scaled((value, ROUNDING * value), self.factor(band)))
            }
            Role::ProfileWithin(band) => Some(scaled(self.within(at("radius")?, band), self.factor(band))),
            Role::ProfileBeyond(stretch, band) => {
                Some(scaled(self.beyond(stretch * at("thickness")?, band), 1.0))
            }
            Role::ProfileRadius(band) => self.radius(at("u")?, asked.baked[c], band),
            Role::Kernel(band) => Some(scaled(self.line(at("offset")?, band), 1.0)),
            Role::KernelWithin(band) => Some(scaled(self.strip(at("offset")?, band), 1.0)),
            Role::BlurredLight(band) => self.blurred(asked, band, asked.targets[c]),
            _ => None,
        }
    }

    /// R(0), where it is finite.
    fn at_centre(&self, band: Band) -> Option<f64> {
        if self.profile.is_singular() {
            return None;
        }
        let near = 1e-9 * self.profile.scales().first()?;
        Some(self.times_radius(near, band) / near)
    }

    /// One step of Newton's method from the baked radius on a distribution that is added up.
    fn radius(&self, u: f64, baked: f64, band: Band) -> Option<Truth> {
        let u = u.min(1.0 - 0.5 * f64::EPSILON);
        if u <= 0.0 {
            return Some(Truth { value: 0.0, error: 0.0 });
        }
        let density = 2.0 * PI * self.times_radius(baked, band);
        let (miss, error) = if u < 0.5 {
            let (part, error) = self.within(baked, band);
            (part - u, error)
        } else {
            let (part, error) = self.beyond(baked, band);
            ((1.0 - u) - part, error)
        };
        let step = miss / density;
        // what the slope changes over the step is of second order
        let next = 2.0 * PI * self.times_radius((baked - step).max(0.0), band);
        let bend = (next / density - 1.0).abs() * step.abs();
        Some(Truth {
            value: baked - step,
            error: error / density + bend + ROUNDING * (baked + 1.0 / density * u.min(1.0 - u)),
        })
    }

    /// `L(x) = 2 int_x^inf R(r) r / sqrt(r^2 - x^2) dr`, in y = sqrt(r^2 - x^2).
    fn line(&self, x: f64, band: Band) -> (f64, f64) {
        let mut breaks: Vec<f64> = vec![0.0];
        let mut y = x;
        while y > 0.0 && y < self.profile.scales()[0] {
            breaks.push(y);
            y *= 8.0;
        }
        breaks.extend(self.profile.scales());
        breaks.sort_by(f64::total_cmp);
        quad::integral(&breaks, TARGET, &mut |y| {
            let r = libm::hypot(x, y);
            2.0 * self.times_radius(r, band) / r
        })
    }

    /// Light that leaves within x to either side: of a ring of radius r the part `2 asin(x / r) / pi`.
    fn strip(&self, x: f64, band: Band) -> (f64, f64) {
        let (inside, inner) = self.within(x, band);
        if x <= 0.0 {
            return (0.0, 0.0);
        }
        // the arcsine bends without bound at r = x: r = x cosh-like, r = x + s^2
        let end = self.profile.scales().last().copied().unwrap_or(0.0);
        if end <= x {
            return (inside, inner + 1e-16);
        }
        let mut breaks: Vec<f64> = vec![0.0];
        let more = self.profile.scales().into_iter().filter(|s| *s > x).map(|s| (s - x).sqrt());
        breaks.extend(more);
        if 2.0 * x < end {
            breaks.push(x.sqrt());
        }
        breaks.sort_by(f64::total_cmp);
        let (outside, outer) = quad::integral(&breaks, TARGET, &mut |s| {
            let r = x + s * s;
            2.0 * PI * self.times_radius(r, band) * libm::asin(x / r) / FRAC_PI_2 * 2.0 * s
        });
        (inside + outside, inner + outer + 1e-16)
    }

    /// Light on a ball: over the ring, or over the sphere in polar coordinates round the point, both azimuths summed.
    fn blurred(&self, asked: &Asked<'_>, band: Band, target: f64) -> Option<Truth> {
        let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
        let (mu, curvature) = (at("ndotl")?, at("curvature")?);
        if curvature <= 0.0 {
            return Some(Truth { value: mu.max(0.0), error: 0.0 });
        }
        let (r, theta) = (1.0 / curvature, libm::acos(mu));
        let sphere = asked.spec.params.choice("over").ok()? == "sphere";
        let lit = |x: f64| if sphere { lit_circle(theta, x, target) } else { lit_ring(theta, x) };
        // the sine of half the angle as the variable: the chord over 2 r
        let mut breaks = vec![0.0, 1.0];
        let kinks = [FRAC_PI_2 - theta, theta - FRAC_PI_2, 1.5 * PI - theta, theta + FRAC_PI_2];
        breaks.extend(kinks.into_iter().filter(|x| (0.0..=PI).contains(x)).map(|x| libm::sin(0.5 * x)));
        breaks.extend(self.profile.scales().into_iter().map(|s| 0.5 * s / r).filter(|x| *x < 1.0));
        breaks.sort_by(f64::total_cmp);
        // the end of the ring is a square root in the sine: its complement y, sine = 1 - y^2
        let breaks: Vec<f64> = breaks.iter().rev().map(|x| (1.0 - x).max(0.0).sqrt()).collect();
        let sums = |target: [f64; WIDE]| {
            quad::integrate(&breaks, 2, &target, 600, &mut |y| {
                let sine = 1.0 - y * y;
                let chord = 2.0 * r * sine;
                let x = 2.0 * libm::asin(sine.clamp(0.0, 1.0));
                // ds = 2 dsine / cos(x / 2) of a ring, r dr = 4 r^2 sine dsine of a sphere; cos = y sqrt(2 - y^2)
                let measure = if sphere {
                    self.times_radius(chord, band) * 2.0 * y
                } else {
                    self.times_radius(chord, band) / chord * 2.0 / (2.0 - y * y).sqrt()
                };
                let (light, error) = lit(x);
                let mut sum = Sum::ZERO;
                sum.value[0] = measure * light;
                sum.error[0] = measure * error;
                sum.value[1] = measure;
                sum
            })
        };
        let rough = sums([f64::INFINITY; WIDE]).value[1];
        let sum = sums([0.2 * target * rough; WIDE]);
        let value = sum.value[0] / sum.value[1];
        Some(Truth { value, error: (sum.error[0] + value * sum.error[1]) / sum.value[1] + ROUNDING })
    }
}

/// The clamped cosine on both sides of a ring.
fn lit_ring(theta: f64, x: f64) -> (f64, f64) {
    (0.5 * (libm::cos(theta - x).max(0.0) + libm::cos(theta + x).max(0.0)), 0.0)
}

/// Its mean over the circle at angle `beta`, by a sum up to where the light ends.
fn lit_circle(theta: f64, beta: f64, target: f64) -> (f64, f64) {
    let along = libm::cos(theta) * libm::cos(beta);
    let across = libm::sin(theta) * libm::sin(beta);
    let end = if along >= across {
        PI
    } else if along <= -across {
        return (0.0, 0.0);
    } else {
        libm::acos(-along / across)
    };
    quad::integral(&[0.0, end], 0.02 * target, &mut |phi| (along + across * libm::cos(phi)).max(0.0) / PI)
}

/// The dipole, `alpha' / (4 pi) sum z (sigma + 1 / d) exp(-sigma d) / d^2`.
fn dipole(d: &Dipole, r: f64) -> f64 {
    let sigma_t = d.sigma_a + d.sigma_s;
    let sigma = (3.0 * d.sigma_a * sigma_t).sqrt();
    let f = internal_reflectance(d.eta);
    let depth = 1.0 / sigma_t;
    let one = |z: f64| {
        let distance = (r * r + z * z).sqrt();
        z * (sigma + 1.0 / distance) * libm::exp(-sigma * distance) / (distance * distance)
    };
    let image = depth + 4.0 * depth * (1.0 + f) / (3.0 * (1.0 - f));
    d.sigma_s / sigma_t * (one(depth) + one(image)) / (4.0 * PI)
}
