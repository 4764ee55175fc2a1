//! Diffusion below surfaces and media: norms, inverses, limits.

use crate::terms::values::assert_relative;
use crate::tolerance::{
    CUT_SPECTRUM, FEW_ROUNDINGS, INTEGRAL_11, INTEGRAL_12, MANY_ROUNDINGS, PUBLISHED_FIT_ALBEDO,
    PUBLISHED_FIT_DIPOLE, PUBLISHED_FIT_INVERSE, TWO_ULPS, near,
};
use brdfbake::integrate::gauss;
use brdfbake::terms::burley_diffusion::{self, ShapeFit};
use brdfbake::terms::dipole::{self, Dipole};
use brdfbake::terms::skin::{self, Channel};
use brdfbake::terms::{blackbody, fresnel, medium};
use std::f64::consts::PI;

/// `2π ∫ f r dr` over r = eᵗ.
fn disk(f: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in -30..20 {
        let t = f64::from(i);
        sum += gauss::rule(32).integrate(t, t + 1.0, |t| {
            let r = libm::exp(t);
            2.0 * PI * f(r) * r * r
        });
    }
    sum
}

#[test]
fn the_dipole_integrates_to_its_total() {
    for (sigma_a, sigma_s, eta) in [(0.01, 1.0, 1.5), (1.0, 1.0, 1.3), (0.2, 5.0, 1.0)] {
        let d = Dipole { sigma_a, sigma_s, eta };
        assert_relative(&format!("{d:?}"), disk(|r| d.reflectance(r)), d.total(), INTEGRAL_12);
    }
    assert_relative(
        "no absorption",
        Dipole { sigma_a: 0.0, sigma_s: 2.0, eta: 1.4 }.total(),
        1.0,
        FEW_ROUNDINGS,
    );
    // the rational fit is one of the exact average from inside
    for eta in [1.2, 1.3, 1.5] {
        let exact = fresnel::dielectric_average(1.0 / eta);
        assert_relative(
            &format!("F_dr {eta}"),
            dipole::internal_reflectance(eta),
            exact,
            PUBLISHED_FIT_DIPOLE,
        );
    }
}

#[test]
fn skin_profiles_are_white() {
    for channel in [Channel::Red, Channel::Green, Channel::Blue] {
        assert_relative("norm", disk(|r| skin::profile(channel, r)), 1.0, INTEGRAL_12);
        assert_relative("inside", skin::inside(channel, 100.0), 1.0, MANY_ROUNDINGS);
        let part = gauss::rule(64).integrate(0.0, 0.7, |r| 2.0 * PI * r * skin::profile(channel, r));
        assert_relative("part", skin::inside(channel, 0.7), part, INTEGRAL_12);
        assert_relative("thin", skin::transmittance(channel, 0.0), 1.0, MANY_ROUNDINGS);
        // half the variance
        let d = 0.3;
        let twice = skin::transmittance(channel, d * std::f64::consts::SQRT_2);
        assert_relative("conventions", skin::transmittance_jimenez(channel, d), twice, MANY_ROUNDINGS);
    }
}

#[test]
fn normalised_diffusion_is_normalised_and_inverts() {
    for fit in [ShapeFit::Searchlight, ShapeFit::Diffuse, ShapeFit::DiffuseMeanFreePath] {
        for albedo in [0.1, 0.5, 0.8, 1.0] {
            let norm = disk(|r| burley_diffusion::profile(fit, albedo, 0.7, r));
            // r R is finite at 0: e^-30 of the range is left out
            assert_relative(&format!("{fit:?} {albedo}"), norm, albedo, INTEGRAL_11);
        }
    }
    for xi in [1e-300, 1e-12, 1e-5, 0.01, 0.3, 0.5, 0.7, 0.99, 0.999_999] {
        let x = burley_diffusion::cdf_inverse(xi);
        let bound = if xi > 0.5 { 1e-15 / (1.0 - xi) } else { 1e-15 };
        assert_relative(&format!("{xi}"), burley_diffusion::cdf(x), xi, bound.max(TWO_ULPS));
    }
    assert!(burley_diffusion::cdf_inverse(0.0) == 0.0 && burley_diffusion::cdf_inverse(1.0) > 100.0);
    assert!(burley_diffusion::profile(ShapeFit::Diffuse, 0.5, 1.0, 0.0).is_finite());
}

#[test]
fn albedo_maps_invert() {
    for c in [0.0, 1e-6, 0.1, 0.5, 0.9, 0.999, 1.0] {
        for g in [-0.5, 0.0, 0.8] {
            let alpha = medium::single_scattering_exact(c, g);
            near!(medium::half_space_albedo(alpha, g), c, PUBLISHED_FIT_INVERSE, "{c} {g}");
            let fit = medium::single_scattering_kulla_conty(c, g);
            assert!(
                (0.0..=1.0).contains(&fit) && (fit - alpha).abs() < PUBLISHED_FIT_ALBEDO,
                "{c} {g}: {fit} {alpha}"
            );
        }
    }
    assert_relative("thin slab", medium::slab_emission(3.0, 0.0, 2.0), 6.0, 0.0);
    assert_relative("thick slab", medium::slab_emission(3.0, 2.0, 1e9), 1.5, FEW_ROUNDINGS);
}

#[test]
fn planck_has_the_laws_of_wien_and_stefan() {
    // Wien: the peak is at 2.897771955e-3 m K
    let temperature = 5000.0;
    let peak = 2.897_771_955e-3 / temperature * 1e9;
    let at = blackbody::planck(peak, temperature);
    assert!(
        at > blackbody::planck(peak * 1.001, temperature)
            && at > blackbody::planck(peak * 0.999, temperature)
    );
    // Stefan and Boltzmann: π ∫ B dλ = 5.670374419e-8 T⁴
    let mut sum = 0.0;
    for i in 0..60 {
        let t = 3.0 + 0.25 * f64::from(i);
        sum += gauss::rule(32).integrate(t, t + 0.25, |t| {
            let lambda = libm::exp(t);
            blackbody::planck(lambda, temperature) * lambda * 1e-9
        });
    }
    let t2 = temperature * temperature;
    assert_relative("Stefan", PI * sum, 5.670_374_419e-8 * t2 * t2, CUT_SPECTRUM);
    assert!(blackbody::planck(1.0, 1.0) == 0.0);
}
