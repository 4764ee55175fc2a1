//! Colours by sums over the spectrum: reflectances from Fresnel amplitudes, Planck's law, the eye and the light as tabulated.

use super::quad::{self, Sum, WIDE};
use super::{Asked, Truth, fresnel};
use crate::math::complex::Complex;
use crate::tables::metal::Index;
use crate::tables::role::{Glow, Polarisation};
use crate::tables::{Role, Spec};
use crate::terms::blackbody::{WYMAN_BREAKS, wyman_xyz, xyz_to_srgb};
use crate::terms::colour::{cie_xyz, d65};
use crate::terms::{metals, thin_film};
use std::f64::consts::PI;

/// Gauss rules of two and of three points on [0, 1].
const TWO: [(f64, f64); 2] = [(0.211_324_865_405_187_12, 0.5), (0.788_675_134_594_812_9, 0.5)];
const THREE: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Roundings of a value.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Breaks of the spectrum, and what a perfect mirror is in daylight.
#[derive(Debug)]
pub(super) struct Colour {
    breaks: Vec<f64>,
    /// By the fit of Wyman and others.
    fitted: bool,
    white: [f64; 3],
}

impl Colour {
    pub(super) fn new(spec: &Spec) -> Option<Colour> {
        let colours = |r: &Role| {
            matches!(
                r,
                Role::MetalColour(_) | Role::FilmColour(_) | Role::FilmSeries(_) | Role::BlackBody(..)
            )
        };
        let role = spec.roles().into_iter().find(colours)?;
        let glows = matches!(role, Role::BlackBody(..));
        let fitted = glows && spec.params.choice("eye").ok()? == "wyman-2013";
        let mut breaks: Vec<f64> =
            if fitted { WYMAN_BREAKS.to_vec() } else { (360..=830).map(f64::from).collect() };
        if !glows {
            let names = if matches!(role, Role::MetalColour(_)) { ["n", "k"] } else { ["n3", "k3"] };
            let kinks = Index::of(&spec.params, names).ok()?.kinks();
            breaks.extend(kinks.into_iter().filter(|l| (360.0..830.0).contains(l)));
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let mut colour = Colour { breaks, fitted, white: [1.0; 3] };
        if glows {
            return Some(colour);
        }
        let white = colour.in_daylight(1e-10, &mut |_| 1.0);
        colour.white = [0, 1, 2].map(|c| white.value[c]);
        Some(colour)
    }

    /// Linear sRGB of a reflectance in daylight: Gauss rules of two and of three points between the whole wavelengths, on halves of
    /// halves until they agree.
    fn in_daylight(&self, target: f64, f: &mut dyn FnMut(f64) -> f64) -> Sum {
        let mut sum = Sum::ZERO;
        for parts in [1, 2, 4, 8, 16, 32] {
            let [two, three] = [self.composite(&TWO, parts, f), self.composite(&THREE, parts, f)];
            for c in 0..3 {
                sum.value[c] = three[c];
                sum.error[c] = (three[c] - two[c]).abs() + ROUNDING * self.white[c].abs();
            }
            if sum.error[..3].iter().all(|e| *e <= target) {
                break;
            }
        }
        sum
    }

    /// A rule of nodes and weights on every part of every piece.
    fn composite(&self, rule: &[(f64, f64)], parts: u32, f: &mut dyn FnMut(f64) -> f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for pair in self.breaks.windows(2) {
            let length = (pair[1] - pair[0]) / f64::from(parts);
            for part in 0..parts {
                for (x, w) in rule {
                    let lambda = pair[0] + length * (f64::from(part) + x);
                    let light = w * length * d65(lambda) * f(lambda);
                    for (s, eye) in sum.iter_mut().zip(xyz_to_srgb(cie_xyz(lambda))) {
                        *s += light * eye;
                    }
                }
            }
        }
        sum
    }

    /// Linear sRGB of a spectrum; the fourth channel is its luminance.
    fn over_spectrum(&self, target: f64, f: &mut dyn FnMut(f64) -> f64) -> Sum {
        quad::integrate(&self.breaks, 4, &[target; WIDE], 1000, &mut |lambda| {
            let xyz = if self.fitted { wyman_xyz(lambda) } else { cie_xyz(lambda) };
            let power = f(lambda);
            let rgb = xyz_to_srgb(xyz);
            let mut sum = Sum::ZERO;
            for (s, v) in sum.value.iter_mut().zip([rgb[0], rgb[1], rgb[2], xyz[1]]) {
                *s = power * v;
            }
            sum
        })
    }

    /// Roles of this file.
    pub(super) fn truth(&self, role: Role, asked: &Asked<'_>, c: usize) -> Option<Truth> {
        let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
        let number = |id: &str| asked.spec.number(id, asked.at).ok();
        let target = asked.targets[c];
        match role {
            Role::MetalColour(band) => {
                let i = band.index();
                let mu = at("mu")?;
                let factor = &mut |lambda: f64| {
                    let f = fresnel::of_metal(asked.spec, Polarisation::None, (mu, 0, lambda), asked.at);
                    f.map_or(f64::NAN, |t| t.value)
                };
                let sum = self.in_daylight(0.5 * target * self.white[i], factor);
                Some(self.under_white(&sum, i))
            }
            Role::FilmColour(band) => {
                let i = band.index();
                let (mu, index) = (at("mu")?, Index::of(&asked.spec.params, ["n3", "k3"]).ok()?);
                let film = |lambda: f64| Film::of(&number, (&index, 0, lambda), at("n3"), at("film")?);
                let sum = self.in_daylight(0.5 * target * self.white[i], &mut |lambda| {
                    film(lambda).map_or(f64::NAN, |film| film.airy(mu, lambda))
                });
                Some(self.under_white(&sum, i))
            }
            Role::FilmSeries(band) => {
                let index = Index::of(&asked.spec.params, ["n3", "k3"]).ok()?;
                let of = (&index, band.index(), metals::RGB_NM[band.index()]);
                let film = Film::of(&number, of, at("n3"), at("film")?)?;
                Some(film.series(at("mu")?, number("orders")?.round(), band.index()))
            }
            Role::BlackBody(glow, band) => self.glow(glow, band.index(), &number, at("temperature")?, target),
            _ => None,
        }
    }

    fn under_white(&self, sum: &Sum, i: usize) -> Truth {
        Truth { value: sum.value[i] / self.white[i], error: sum.error[i] / self.white[i].abs() + ROUNDING }
    }

    fn glow(
        &self,
        glow: Glow,
        i: usize,
        number: &dyn Fn(&str) -> Option<f64>,
        temperature: f64,
        target: f64,
    ) -> Option<Truth> {
        // relative to the largest, so that no power over- or underflows
        let spectrum = |temperature: f64, target: f64| {
            let peak = planck(560.0, temperature);
            self.over_spectrum(target, &mut |lambda| planck(lambda, temperature) / peak)
        };
        // the size of the light first, roughly
        let rough = spectrum(temperature, f64::INFINITY).value[3];
        let factor = match glow {
            Glow::Light => {
                let reference = number("reference")?;
                let there = spectrum(reference, 1e-10);
                rough / there.value[3] * planck(560.0, temperature) / planck(560.0, reference)
            }
            Glow::Hue | Glow::Unclamped => 1.0,
        };
        let sum = spectrum(temperature, 0.2 * target * rough / factor.max(1.0));
        let y = sum.value[3];
        let hue = sum.value[i] / y;
        let error = (sum.error[i] + hue.abs() * sum.error[3]) / y;
        let (scale, scale_error) = if glow == Glow::Light {
            let reference = number("reference")?;
            let there = spectrum(reference, 1e-12);
            let scale = y / there.value[3] * planck(560.0, temperature) / planck(560.0, reference);
            (scale, scale * (sum.error[3] / y + there.error[3] / there.value[3] + 1e-13))
        } else {
            (1.0, 0.0)
        };
        let value = hue * scale;
        let kept = if glow == Glow::Unclamped { value } else { value.max(0.0) };
        Some(Truth { value: kept, error: error * scale + hue.abs() * scale_error + 1e-13 * value.abs() })
    }
}

/// Planck's law up to a constant: `x^5 / (e^(x c / T) - 1)`, x the wave number; c = h c / k = 1.438776877e-2 m K, from the exact constants.
fn planck(lambda_nm: f64, temperature: f64) -> f64 {
    const SECOND: f64 = 6.626_070_15e-34 * 299_792_458.0 / 1.380_649e-23;
    let wave = 1e9 / lambda_nm;
    let x = SECOND * wave / temperature;
    // against e^-x, which does not overflow; the power in units of 1e6 / m
    libm::pow(1e-6 * wave, 5.0) * libm::exp(-x) / -libm::expm1(-x)
}

/// A film between vacuum and a substrate.
struct Film {
    n2: f64,
    below: Complex,
    thickness_nm: f64,
}

impl Film {
    /// In the indices relative to what lies above, and in its wavelengths. `n3` is that of an axis.
    fn of(
        number: &dyn Fn(&str) -> Option<f64>,
        (index, colour, lambda_nm): (&Index<'_>, usize, f64),
        n3: Option<f64>,
        thickness_nm: f64,
    ) -> Option<Film> {
        let (n, k) = index.at(colour, lambda_nm);
        let n = if matches!(index, Index::Given { .. }) { n3.unwrap_or(n) } else { n };
        let above = number("eta")?;
        let below = Complex::new(n / above, k / above);
        Some(Film { n2: number("n2")? / above, below, thickness_nm: thickness_nm * above })
    }

    /// `N cos theta` of the three media, and their squared indices.
    fn waves(&self, mu: f64) -> [(Complex, Complex); 3] {
        let sin2 = Complex::real((1.0 - mu) * (1.0 + mu));
        [Complex::real(1.0), Complex::real(self.n2 * self.n2), self.below * self.below]
            .map(|square| ((square - sin2).sqrt_upper(), square))
    }

    /// Amplitudes of s and p at both interfaces.
    fn amplitudes(&self, mu: f64) -> [[Complex; 2]; 2] {
        let waves = self.waves(mu);
        let at = |i: usize| {
            let ((a, square_a), (b, square_b)) = (waves[i], waves[i + 1]);
            let ratio = |above: Complex, below: Complex| {
                if below.norm2() > 0.0 { above.over(below) } else { Complex::real(0.0) }
            };
            let (pa, pb) = (square_b * a, square_a * b);
            [ratio(a - b, a + b), ratio(pa - pb, pa + pb)]
        };
        [at(0), at(1)]
    }

    /// All orders, unpolarised: `|r12 + r23 w|^2 / |1 + r12 r23 w|^2`, w the phase of a round trip.
    fn airy(&self, mu: f64, lambda_nm: f64) -> f64 {
        let [first, second] = self.amplitudes(mu);
        let wave = self.waves(mu)[1].0.scale(4.0 * PI * self.thickness_nm / lambda_nm);
        let (sin, cos) = libm::sincos(wave.re);
        let turn = Complex::new(cos, sin).scale(libm::exp(-wave.im));
        let one = |i: usize| {
            let above = first[i] + second[i] * turn;
            let below = Complex::real(1.0) + first[i] * second[i] * turn;
            if below.norm2() > 0.0 { above.norm2() / below.norm2() } else { 1.0 }
        };
        0.5 * (one(0) + one(1))
    }

    /// The published series: powers of |r12 r23| with the Fourier transforms of the eye.
    fn series(&self, mu: f64, orders: f64, band: usize) -> Truth {
        let [first, second] = self.amplitudes(mu);
        let inside = self.waves(mu)[1].0;
        // total reflection at the film lets nothing in
        let whole = inside.im > 0.0;
        let path = 2.0 * inside.re * self.thickness_nm;
        let channels = [thin_film::Channel::X, thin_film::Channel::Y, thin_film::Channel::Z];
        let mut xyz = [0.0; 3];
        for (value, channel) in xyz.iter_mut().zip(channels) {
            for p in 0..2 {
                let (a, b) = (first[p].norm2(), second[p].norm2());
                if whole {
                    *value += 0.5;
                    continue;
                }
                let through = 1.0 - a;
                let star = if a * b < 1.0 { through * through * b / (1.0 - a * b) } else { 0.0 };
                let phase = (-first[p]).argument() + second[p].argument();
                let mut sum = a + star;
                let mut m = 1.0;
                while m <= orders {
                    let power = libm::pow(a * b, 0.5 * m);
                    sum +=
                        2.0 * (star - through) * power * thin_film::sensitivity(channel, m * path, m * phase);
                    m += 1.0;
                }
                *value += 0.5 * sum;
            }
        }
        const TO_RGB: [[f64; 3]; 3] = [
            [2.3706743, -0.9000405, -0.4706338],
            [-0.5138850, 1.4253036, 0.0885814],
            [0.0052982, -0.0146949, 1.0093968],
        ];
        let row = TO_RGB[band];
        // the phase of a long path is loose
        let loose = 1e-12 + 1e-15 * path;
        Truth { value: row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2], error: ROUNDING + loose }
    }
}
