//! Fresnel factors: reference values, limits, reversibility, no NaN anywhere.

use crate::terms::values::{assert_relative, cosines, rows};
use crate::tolerance::{
    DIGIT_LOST, DIGITS_LOST, FEW_ROUNDINGS, LONG_SUM, MANY_ROUNDINGS, SQUARED_ROUNDING, TEN_ROUNDINGS, ULP,
    near,
};
use brdfbake::math::frame;
use brdfbake::terms::fresnel::{self, Polarised};
use glam::DVec3;

const FILE: &str = "points_fresnel";

fn both_in_unit_interval(what: &str, r: Polarised) {
    for x in [r.s, r.p] {
        assert!((0.0..=1.0).contains(&x), "{what}: {r:?} leaves [0, 1]");
    }
}

#[test]
fn dielectric_matches_reference_values() {
    for (model, pick) in [
        ("fresnel_dielectric_s", (|r| r.s) as fn(Polarised) -> f64),
        ("fresnel_dielectric_p", |r| r.p),
        ("fresnel_dielectric_unpolarised", Polarised::unpolarised),
    ] {
        for row in rows(FILE, model) {
            row.check(pick(fresnel::dielectric(libm::cos(row.wi_theta()), row.num("eta"))), DIGIT_LOST);
        }
    }
}

#[test]
fn conductor_matches_reference_values() {
    for (model, pick) in [
        ("fresnel_conductor_s", (|r| r.s) as fn(Polarised) -> f64),
        ("fresnel_conductor_p", |r| r.p),
        ("fresnel_conductor_unpolarised", Polarised::unpolarised),
    ] {
        for row in rows(FILE, model) {
            row.check(
                pick(fresnel::conductor(libm::cos(row.wi_theta()), row.num("n"), row.num("k"))),
                DIGIT_LOST,
            );
        }
    }
}

/// `cos_i`, eta, `R_s`, `R_p`, 1 − `R_s`, 1 − `R_p`; mpmath, 60 digits, textbook amplitudes.
const DIELECTRIC: &[[f64; 6]] = &[
    [
        1.0,
        1.0000009536743164,
        2.273734586029526586e-13,
        2.273734586029526586e-13,
        0.9999999999997726265,
        0.9999999999997726265,
    ],
    [
        0.5,
        1.0000009536743164,
        3.637954521109459368e-12,
        9.094834261615304071e-13,
        0.9999999999963620455,
        0.9999999999990905166,
    ],
    [
        0.0009765625,
        1.0000009536743164,
        0.07179680925608659193,
        0.0717963348776953675,
        0.9282031907439134081,
        0.9282036651223046325,
    ],
    [
        1e-8,
        1.0009765625,
        0.9999990951246194613,
        0.9999990933564225788,
        9.048753805387141904e-7,
        9.066435774211761162e-7,
    ],
    [0.5, 1.0000000000009095, 3.308722450191045841e-24, 8.271806125432475619e-25, 1.0, 1.0],
    [1e-8, 1.5, 0.999999964222913, 0.99999991950155605, 3.577708699999664305e-8, 8.049844394999252534e-8],
    [0.75, 0.6875, 0.36, 0.09493060628195763331, 0.64, 0.9050693937180423667],
    [
        0.9375,
        0.9999990463256836,
        2.943442828760665917e-13,
        1.69035868493532118e-13,
        0.9999999999997056557,
        0.9999999999998309641,
    ],
    [
        0.0625,
        10.0,
        0.9751872451143233444,
        0.05216584168930204634,
        0.02481275488567665557,
        0.9478341583106979537,
    ],
];

#[test]
fn dielectric_keeps_its_digits_for_nearly_equal_media_and_at_grazing() {
    for &[c, eta, rs, rp, ts, tp] in DIELECTRIC {
        let what = format!("cos = {c:e}, eta = {eta}");
        let (r, t) = (fresnel::dielectric(c, eta), fresnel::dielectric_transmittance(c, eta));
        assert_relative(&what, r.s, rs, MANY_ROUNDINGS);
        assert_relative(&what, r.p, rp, MANY_ROUNDINGS);
        assert_relative(&what, t.s, ts, MANY_ROUNDINGS);
        assert_relative(&what, t.p, tp, MANY_ROUNDINGS);
    }
}

#[test]
fn dielectric_reflects_and_transmits_all_the_power_on_both_sides() {
    for eta in
        [0.1, 0.5, 0.6875, 1.0 - 1e-9, 1.0, 1.0 + 1e-12, 1.0 + libm::exp2(-10.0), 1.33, 1.5, 2.5, 4.0, 10.0]
    {
        for c in cosines().into_iter().flat_map(|c| [c, -c]) {
            let what = format!("cos = {c:e}, eta = {eta}");
            let (r, t) = (fresnel::dielectric(c, eta), fresnel::dielectric_transmittance(c, eta));
            both_in_unit_interval(&what, r);
            both_in_unit_interval(&what, t);
            assert!(
                (r.s + t.s - 1.0).abs() < MANY_ROUNDINGS && (r.p + t.p - 1.0).abs() < MANY_ROUNDINGS,
                "{what}: {r:?} + {t:?}"
            );
            assert!(r.s >= r.p * (1.0 - 1e-14), "{what}: the s wave is the stronger one, {r:?}");
            if let Some(cos_t) = fresnel::cos_refracted(c, eta) {
                if c != 0.0 {
                    let ratio = if c < 0.0 { 1.0 / eta } else { eta };
                    let between = fresnel::transmittance_between(c.abs(), cos_t, ratio);
                    near!(between.s, t.s, MANY_ROUNDINGS, "{what}");
                    near!(between.p, t.p, MANY_ROUNDINGS, "{what}");
                }
                // Reversibility: the same interface passed the other way round reflects the same share.
                let back = fresnel::dielectric(-cos_t.copysign(c), eta).unpolarised();
                // Near the critical angle the last bit of the returning cosine decides.
                let ratio = eta.max(1.0 / eta);
                let slack = 1e-13 + 1e-15 * ratio * ratio * ratio / (cos_t * c.abs());
                near!(back, r.unpolarised(), slack, "{what}: forth {r:?}, back {back}");
            } else {
                assert_eq!((r.s, r.p), (1.0, 1.0), "{what}: total internal reflection");
                assert_eq!((t.s, t.p), (0.0, 0.0), "{what}: total internal reflection");
            }
        }
    }
}

#[test]
fn below_an_interface_is_above_the_inverse_one() {
    for eta in [0.75, 1.0 + libm::exp2(-10.0), 1.5, 4.0] {
        for c in cosines() {
            let (below, inverse) = (fresnel::dielectric(-c, eta), fresnel::dielectric(c, 1.0 / eta));
            // 1/eta − 1 carries the rounding of the division, hence the looser bound near 1.
            let bound = 1e-13 + 1e-15 / (eta - 1.0).abs();
            assert!(
                (below.s - inverse.s).abs() <= bound && (below.p - inverse.p).abs() <= bound,
                "{eta} {c}"
            );
        }
    }
}

#[test]
fn dielectric_special_angles() {
    for eta in [0.5, 0.75, 1.0009765625, 1.328125, 1.5, 2.5, 10.0] {
        let r0 = (eta - 1.0) / (eta + 1.0);
        assert_relative("normal", fresnel::dielectric(1.0, eta).unpolarised(), r0 * r0, MANY_ROUNDINGS);
        let zero = fresnel::dielectric(fresnel::cos_brewster(eta), eta).p;
        assert!(zero < SQUARED_ROUNDING, "eta = {eta}: R_p = {zero:e} at Brewster's angle");
        assert_relative("grazing", fresnel::dielectric(0.0, eta).unpolarised(), 1.0, FEW_ROUNDINGS);
        let critical = fresnel::cos_critical(eta);
        let dense_side = if eta < 1.0 { 1.0 } else { -1.0 };
        assert_eq!(fresnel::dielectric(dense_side * critical * (1.0 - 1e-9), eta).unpolarised(), 1.0);
        assert!(fresnel::dielectric(dense_side * critical * (1.0 + 1e-9), eta).unpolarised() < 1.0);
    }
    for c in cosines() {
        assert_eq!(fresnel::dielectric(c, 1.0).unpolarised(), 0.0);
        assert_eq!(fresnel::cos_refracted(c, 1.0), Some(c));
    }
    assert_eq!(fresnel::dielectric(0.0, 1.0).unpolarised(), 0.0);
    for row in rows("points_basics", "critical_angle_rad") {
        row.check(libm::acos(fresnel::cos_critical(row.num("eta_dense_over_rare"))), MANY_ROUNDINGS);
        row.check(libm::acos(fresnel::cos_critical(1.0 / row.num("eta_dense_over_rare"))), DIGITS_LOST);
    }
    for row in rows("points_basics", "brewster_angle_rad") {
        row.check(libm::acos(fresnel::cos_brewster(row.num("eta_t_over_i"))), MANY_ROUNDINGS);
    }
    for row in rows("points_basics", "radiance_scale_T_times_eta2_normal_incidence") {
        let eta = row.num("eta_t_over_i");
        row.check(fresnel::dielectric_transmittance(1.0, eta).unpolarised() * eta * eta, MANY_ROUNDINGS);
    }
}

#[test]
fn refraction_matches_reference_values() {
    for (model, axis) in [("refract_x", DVec3::X), ("refract_y", DVec3::Y), ("refract_z", DVec3::Z)] {
        for row in rows("points_basics", model) {
            let wt = fresnel::refract(row.wi(), row.wo(), row.num("eta_t_over_i")).unwrap();
            assert_relative("length", wt.length(), 1.0, FEW_ROUNDINGS);
            // Components are compared in units of the length: those near 0 are differences.
            near!(wt.dot(axis), row.value, ULP + FEW_ROUNDINGS * row.value.abs(), "{}: {wt}", row.name);
        }
    }
    let w = frame::spherical(0.7, 0.3);
    assert_eq!(
        fresnel::refract(w, frame::spherical(0.2, 2.0), 1.0),
        Some(-w),
        "eta = 1 passes straight through"
    );
    assert_eq!(fresnel::refract(frame::from_mu(0.1), DVec3::Z, 0.5), None);
    // There and back again, from below: wt leaves along −wt, which refracts to −w.
    let wt = fresnel::refract(w, DVec3::Z, 1.5).unwrap();
    assert!((fresnel::refract(wt, DVec3::Z, 1.5).unwrap() - w).length() < FEW_ROUNDINGS);
}

/// `cos_i`, n, k, 1 − `R_s`, 1 − `R_p`; mpmath, 60 digits, textbook amplitudes.
const METAL: &[[f64; 5]] = &[
    [1.0, 0.2, 3.5, 0.05843681519357195346, 0.05843681519357195346],
    [0.5, 0.0625, 64.0, 0.00003050684204629467091, 0.0001219771341097501502],
    [0.01, 0.0625, 64.0, 6.101273532270457726e-7, 0.001772322490548639387],
    [0.25, 0.0078125, 1000.0, 7.812488494410351294e-9, 1.249981679885927523e-7],
    [0.5, 1.0009765625, 0.0009765625, 0.9999924225805230149, 0.9999981167122962259],
    [1e-8, 0.1875, 3.375, 5.7904483880975489e-10, 7.770851983530473515e-9],
    [0.75, 3.0, 0.5, 0.6369440338372032, 0.8339159387825658248],
    [0.0009765625, 0.0078125, 1000.0, 3.051753234637628904e-11, 0.00001562050013830962738],
    [0.5, 0.5, 0.5, 0.385731144236655385, 0.6407136823345444135],
];

#[test]
fn absorptance_of_good_metals_keeps_its_digits() {
    for &[c, n, k, a_s, a_p] in METAL {
        let what = format!("cos = {c:e}, n = {n}, k = {k}");
        let (a, r) = (fresnel::conductor_absorptance(c, n, k), fresnel::conductor(c, n, k));
        assert_relative(&what, a.s, a_s, MANY_ROUNDINGS);
        assert_relative(&what, a.p, a_p, MANY_ROUNDINGS);
        assert_relative(&what, r.s, 1.0 - a_s, MANY_ROUNDINGS / (1.0 - a_s));
        assert_relative(&what, r.p, 1.0 - a_p, MANY_ROUNDINGS / (1.0 - a_p));
    }
}

#[test]
fn conductor_laws_over_the_whole_domain() {
    for n in [0.0, 1e-3, 0.05, 0.5, 1.0, 1.0 + libm::exp2(-10.0), 2.0, 10.0] {
        for k in [0.0, 1e-6, 0.1, 1.0, 7.5, 1000.0] {
            for c in cosines().into_iter().chain([0.0]) {
                let what = format!("cos = {c:e}, n = {n}, k = {k}");
                let (r, a) = (fresnel::conductor(c, n, k), fresnel::conductor_absorptance(c, n, k));
                both_in_unit_interval(&what, r);
                both_in_unit_interval(&what, a);
                assert!(
                    (r.s + a.s - 1.0).abs() < LONG_SUM && (r.p + a.p - 1.0).abs() < LONG_SUM,
                    "{what}: {r:?} + {a:?}"
                );
            }
            if n + k > 0.0 {
                let f0 = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
                let got = fresnel::conductor(1.0, n, k);
                assert!(
                    (got.s - f0).abs() <= MANY_ROUNDINGS * f0 && (got.p - f0).abs() <= MANY_ROUNDINGS * f0,
                    "{n} {k}"
                );
            }
        }
    }
}

#[test]
fn conductor_without_absorption_is_the_dielectric() {
    for n in [0.25, 0.6875, 1.0, 1.0 + libm::exp2(-20.0), 1.5, 4.0] {
        for c in cosines().into_iter().chain([0.0]) {
            let (metal, glass) = (fresnel::conductor(c, n, 0.0), fresnel::dielectric(c, n));
            let what = format!("cos = {c:e}, n = {n}");
            near!(metal.s, glass.s, DIGIT_LOST * glass.s, "{what}: {metal:?} {glass:?}");
            near!(metal.p, glass.p, DIGIT_LOST * glass.p + SQUARED_ROUNDING, "{what}: {metal:?} {glass:?}");
        }
    }
}

/// eta, `F_avg`; mpmath, 120 digits, the closed form of Walsh and Duntley and flux reversibility.
const AVERAGE: &[(f64, f64)] = &[
    (1.0000000000009095, 3.031649005798770935e-13),
    (1.0000009536743164, 3.178855394738534031e-7),
    (1.0009765625, 3.2263890215062818e-04),
    (1.0078125, 0.002482646650819519321),
    (1.0625, 0.01687092443980631317),
    (1.25, 0.05289793568647724161),
    (1.328125, 6.5633588992799605e-02),
    (1.5, 9.1777959342351212e-02),
    (1.75, 0.1272276527297036503),
    (1.9990234375, 0.1604699268012037148),
    (2.0, 0.1605966370696060325),
    (2.5, 2.2186657352196288e-01),
    (3.0, 0.2762034099975029064),
    (10.0, 0.640174994374748863),
    (100.0, 0.9501611712396514303),
    (0.9999990463256836, 2.225232959627184719e-6),
    (0.9990234375, 0.002274492801093880709),
    (0.75, 4.7488289521468803e-01),
    (0.6875, 5.6754140519075058e-01),
    (0.5, 0.7901491592674015081),
    (0.25, 0.9604148785311049085),
    (0.0625, 0.9990150347051991002),
];

#[test]
fn dielectric_average_matches_reference_values() {
    for &(eta, expected) in AVERAGE {
        assert_relative(&format!("eta = {eta}"), fresnel::dielectric_average(eta), expected, TEN_ROUNDINGS);
    }
    assert_eq!(fresnel::dielectric_average(1.0), 0.0);
    let next = 1.0 + f64::EPSILON;
    assert_relative("1 + 2^-52", fresnel::dielectric_average(next), f64::EPSILON / 3.0, DIGIT_LOST);
}
