//! Hemispherical averages `F_avg = 2 int_0^1 F(c) c dc` of the Fresnel factors.

use super::fresnel::{DIP, DIP_EXPONENT, ETA, EXPONENT, F0, F90, K, N, TINT};
use super::{FunctionInfo, NO_ANGLES, REFERENCE, alias, known};
use crate::cite;
use crate::integrate::graded::{Graded, Order};
use crate::terms::{fresnel, lazanyi, schlick};

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "fresnel-average-dielectric",
        title: "Average reflectance of a dielectric in diffuse light",
        formula: "2 int_0^1 F(c, eta) c dc; for eta < 1: 1 - eta^2 (1 - F_avg(1 / eta))",
        sources: &[(cite::DUNTLEY_1942, "after Walsh")],
        params: &[ETA],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Closed form; near eta = 1 in a form that does not cancel.",
        also: &[alias("Favg_dielectric")],
        known: &[known(&[("eta", "1.5")], NO_ANGLES, 0.091_777_959_342_351_21, 1e-14, REFERENCE)],
        eval: |p, _| Ok(fresnel::dielectric_average(p.number("eta")?)),
    },
    FunctionInfo {
        id: "fresnel-average-conductor",
        title: "Average reflectance of a conductor in diffuse light",
        formula: "2 int_0^1 F(c, n + i k) c dc",
        sources: &[(cite::BORN_WOLF_1999, "section 14.2 (F)")],
        params: &[N, K],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Quadrature, graded towards grazing and the critical angle of weak absorbers.",
        also: &[alias("Favg_conductor")],
        known: &[known(
            &[("n", "0.1875"), ("k", "3.375")],
            NO_ANGLES,
            0.939_571_036_509_833_5,
            1e-13,
            REFERENCE,
        )],
        eval: |p, _| Ok(conductor_average(p.number("n")?, p.number("k")?)),
    },
    FunctionInfo {
        id: "fresnel-average-schlick",
        title: "Average of Schlick's factor",
        formula: "F0 + (F90 - F0) / 21",
        sources: &[(cite::KULLA_CONTY_2017, "slide on the average Fresnel factor (F90 = 1)")],
        params: &[F0, F90],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Exact for Schlick's factor; 0.0857 for eta = 1.5, whose exact average is 0.0918.",
        also: &[],
        known: &[known(&[("f0", "0")], NO_ANGLES, 1.0 / 21.0, 1e-15, "closed form: 2 B(2, 6)")],
        eval: |p, _| Ok(schlick::schlick_average(p.number("f0")?, p.number("f90")?)),
    },
    FunctionInfo {
        id: "fresnel-average-schlick-generalised",
        title: "Average of Schlick's factor with a free exponent",
        formula: "F0 + (F90 - F0) 2 / ((p + 1)(p + 2))",
        sources: &[(cite::HOFFMAN_2019, "section 2 (F); integrated here")],
        params: &[F0, F90, EXPONENT],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The exponent 5 gives 1/21.",
        also: &[],
        known: &[known(
            &[("f0", "0"), ("exponent", "1")],
            NO_ANGLES,
            1.0 / 3.0,
            1e-15,
            "closed form: 2 int (1 - c) c dc",
        )],
        eval: |p, _| {
            Ok(schlick::schlick_generalised_average(p.number("f0")?, p.number("f90")?, p.number("exponent")?))
        },
    },
    FunctionInfo {
        id: "fresnel-average-f82-tint",
        title: "Average of the F82 tint as printed",
        formula: "F0 + (1 - F0) / 21 - b / 126",
        sources: &[(cite::KUTZ_2021, "section 2.3 (F); integrated here")],
        params: &[F0, TINT],
        inputs: &[],
        unit: "1",
        range: [-0.1, 1.0],
        notes: "Not the average of the clamped curve where that is clamped.",
        also: &[alias("Favg_f82_tint_unclamped")],
        known: &[known(
            &[("f0", "0.9375"), ("tint", "0.5")],
            NO_ANGLES,
            0.872_783_374_082_443_2,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| Ok(schlick::f82_tint_average(p.number("f0")?, p.number("tint")?)),
    },
    FunctionInfo {
        id: "fresnel-average-lazanyi",
        title: "Average of Lazanyi's factor",
        formula: "F0 + (1 - F0) / 21 - 4 a / ((q + 1)(q + 2)(q + 3))",
        sources: &[(cite::LAZANYI_2005, "the compensated formula (F); integrated here")],
        params: &[N, K, DIP, DIP_EXPONENT],
        inputs: &[],
        unit: "1",
        range: [-10.0, 1.0],
        notes: "2 B(3, q + 1) = 4 / ((q + 1)(q + 2)(q + 3)).",
        also: &[],
        known: &[known(
            &[("n", "1"), ("k", "0"), ("a", "1"), ("exponent", "6")],
            NO_ANGLES,
            1.0 / 21.0 - 1.0 / 126.0,
            1e-14,
            "closed form: 2 B(2, 6) - 2 B(3, 7)",
        )],
        eval: |p, _| {
            Ok(lazanyi::average(p.number("n")?, p.number("k")?, p.number("a")?, p.number("exponent")?))
        },
    },
];

/// `2 ∫ F c dc` of a conductor.
///
/// F has poles near c = ±1/N and branch points at c² = 1 − N². Panels are graded towards 0 on the scale 1/(1 + |N|), and
/// towards the real part of the branch point, if it lies in (0, 1), on the scale of its imaginary part.
fn conductor_average(n: f64, k: f64) -> f64 {
    if k == 0.0 && n > 0.0 {
        return fresnel::dielectric_average(n);
    }
    let branch = crate::math::complex::Complex::new(1.0 - n * n + k * k, -2.0 * n * k).sqrt_upper();
    let size = libm::hypot(n, k);
    let (critical, near) = (branch.re.abs(), branch.im.max(1e-12));
    let f = |c: f64| fresnel::conductor(c, n, k).unpolarised() * c;
    let panel = |from: f64, to: f64, scale: f64| {
        let rule = Graded::new((scale / (to - from).abs()).min(1e3), Order(1.0, 0.4), 24.0);
        let sum: f64 = rule.node.iter().zip(&rule.weight).map(|(x, w)| w * f(from + (to - from) * x)).sum();
        2.0 * (to - from).abs() * sum
    };
    let pole = 1.0 / (1.0 + size);
    if critical > 0.0 && critical < 1.0 {
        panel(0.0, 0.5 * critical, pole) + panel(critical, 0.5 * critical, near) + panel(critical, 1.0, near)
    } else {
        panel(0.0, 1.0, pole)
    }
}
