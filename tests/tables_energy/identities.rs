//! Closed forms and identities that tie the tables together.

use crate::common::{axis, bake};
use crate::tables_energy::support::{table, texel};
use crate::tolerance::{
    DIGIT_LOST, INTEGRAL_5, INTEGRAL_5_TWICE, INTEGRAL_6_TWICE, INTEGRAL_7, INTEGRAL_8, INTEGRAL_9,
    INTEGRAL_10, INTEGRAL_11, near,
};
use brdfbake::grid::{Axis, Texel};
use brdfbake::integrate::gauss;
use brdfbake::models::Functional;
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::terms::{fresnel, schlick};
use brdfbake::verify;
use std::f64::consts::PI;

#[test]
fn the_f82_channel_splits_the_tinted_fresnel_factor_exactly() {
    // alpha = 1 at normal incidence: int D V g mu_i dwi = 2 int_(1/sqrt 2)^1 (2 u^2 - 1) g(u) / u du
    let expected = gauss::rule(16).integrate(std::f64::consts::FRAC_1_SQRT_2, 1.0, |u| {
        2.0 * (2.0 * u * u - 1.0) * libm::pow(1.0 - u, 6.0) * (823_543.0 / 46_656.0)
    });
    let f82 = table("dfg", "ggx", "{}", &["dfg.f82"], &["mu", "alpha"]);
    near!(texel(&f82, &[1.0, 1.0], 1e-12).0, expected, INTEGRAL_11, "{expected}");
    // a mirror
    let mirror = texel(&f82, &[1.0 / 7.0, 0.0], 1e-12).0;
    near!(mirror, 1.0, DIGIT_LOST, "{mirror}");
    let sixteen = table("dfg", "ggx", "{}", &["dfg.f82-x16"], &["mu", "alpha"]);
    let scaled = 16.0 * 46_656.0 / 823_543.0 * texel(&f82, &[0.3, 0.2], 1e-10).0;
    near!(texel(&sixteen, &[0.3, 0.2], 1e-10).0, scaled, INTEGRAL_9);
    // the formula in the layout: the albedo of a mirror of colour f0 and tint t at every angle
    let split = table("dfg", "ggx", "{}", &["dfg.scale", "dfg.bias", "dfg.f82"], &["mu", "alpha"]);
    for (f0, tint) in [(0.9, 0.8), (0.6, 0.5), (0.95, 1.0)] {
        for mu in [0.05, 0.2, 0.6, 1.0] {
            let e = split.baker.texel(&[mu, 0.0], 1e-12).unwrap().value;
            let dip = (f0 + (1.0 - f0) * libm::pow(6.0 / 7.0, 5.0)) * (1.0 - tint);
            let got = f0 * e[0] + e[1] - dip * e[2];
            let expected = schlick::f82_tint_unclamped(f0, tint, mu);
            near!(got, expected, DIGIT_LOST, "{f0} {tint} {mu}: {got} {expected}");
        }
    }
}

#[test]
fn a_dielectric_albedo_is_made_of_white_albedo_and_schlick_part() {
    // three integrals that share no factor but D V: E(eta) = F0 E + (1 - F0) part
    let part = table(
        "generalised-schlick",
        "ggx",
        r#"{"curve": "dielectric"}"#,
        &["schlick.part"],
        &["mu", "alpha", "eta"],
    );
    let mean = table(
        "generalised-schlick",
        "ggx",
        r#"{"curve": "dielectric"}"#,
        &["schlick.s"],
        &["mu", "alpha", "eta"],
    );
    // E_ggx_correlated_white and E_ggx_correlated_dielectric_reflection of the reference integrals
    let (white, exact) = (9.158_124_302_497_503_8e-1, 3.704_866_317_781_678_6e-2);
    let at = [1.0, 0.25, 1.5];
    let got = 0.04 * white + 0.96 * texel(&part, &at, 1e-12).0;
    near!(got, exact, INTEGRAL_11, "{got}");
    let got = white * (0.04 + 0.96 * texel(&mean, &at, 1e-12).0);
    near!(got, exact, INTEGRAL_11, "{got}");
    // a power of the exponent axis: 0 is a constant factor
    let power = table("generalised-schlick", "ggx", "{}", &["schlick.s"], &["mu", "alpha", "exponent"]);
    near!(texel(&power, &[0.4, 0.3, 0.0], 1e-9).0, 1.0, INTEGRAL_9);
    // visible normals at alpha = 1, normal incidence: D cos dwm = 2 u du, of which u > 1 / sqrt 2 leaves upwards
    let visible =
        table("generalised-schlick", "ggx", "{}", &["schlick.s-visible"], &["mu", "alpha", "exponent"]);
    for e in [0.0, 1.0, 5.0, 12.5] {
        let expected = gauss::rule(40)
            .integrate(std::f64::consts::FRAC_1_SQRT_2, 1.0, |u| 2.0 * u * libm::pow(1.0 - u, e));
        let got = texel(&visible, &[1.0, 1.0, e], 1e-9).0;
        near!(got, expected, INTEGRAL_8, "exponent {e}: {got} {expected}");
    }
}

#[test]
fn flux_through_an_interface_is_the_same_both_ways() {
    let channels = ["t-avg", "t-avg.inside", "r-avg", "r-avg.inside", "e-avg", "e-avg.inside"];
    let bound = table("average-albedo", "ggx-glass", "{}", &channels, &["alpha", "eta"]);
    for (alpha, eta) in [(0.5, 1.5), (0.2, 1.33), (1.0, 2.2)] {
        let e = bound.baker.texel(&[alpha, eta], 1e-5).unwrap();
        let [t, t_in, r, r_in, all, all_in, ..] = e.value;
        near!(t, eta * eta * t_in, INTEGRAL_5_TWICE * (1.0 + eta * eta), "{alpha} {eta}: {t} {t_in}");
        assert!((r + t - all).abs() < INTEGRAL_5 && (r_in + t_in - all_in).abs() < INTEGRAL_5);
        assert!(all < 1.0 && all_in < 1.0);
    }
}

#[test]
fn shares_of_a_compensated_interface_are_reciprocal() {
    let channels = ["ms.reflect", "ms.reflect.inside", "ms.missing-avg", "ms.missing-avg.inside"];
    let bound = table("glass-compensation", "ggx-glass", "{}", &channels, &["mu", "alpha", "eta"]);
    for (alpha, eta) in [(0.5, 1.5), (0.8, 2.0)] {
        let e = bound.baker.texel(&[0.5, alpha, eta], 1e-5).unwrap();
        let [a, a_in, m, m_in, ..] = e.value;
        let (forth, back) = ((1.0 - a) * m, eta * eta * (1.0 - a_in) * m_in);
        near!(forth, back, INTEGRAL_5, "{alpha} {eta}: {forth} {back}");
        assert!(a >= fresnel::dielectric_average(eta) - 1e-6 && a <= 1.0 && (0.0..=1.0).contains(&a_in));
        // the means are those of the average table
        let avg = table("average-albedo", "ggx-glass", "{}", &["e-avg", "e-avg.inside"], &["alpha", "eta"]);
        let avg = avg.baker.texel(&[alpha, eta], 1e-5).unwrap().value;
        assert!(
            (m - (1.0 - avg[0])).abs() < INTEGRAL_5_TWICE && (m_in - (1.0 - avg[1])).abs() < INTEGRAL_5_TWICE
        );
    }
}

#[test]
fn the_lobe_gives_back_what_is_missing() {
    // int lobe(mu_o) lobe(mu_i) mu_i dwi = 1 - E(mu_o), with E = 1 - mu ln((1 + mu) / mu) at alpha = 1
    let bound = table("compensation", "ggx", "{}", &["ms.lobe", "ms.turquin"], &["mu", "alpha"]);
    let lobe = |mu: f64| texel(&bound, &[mu, 1.0], 1e-10).0;
    let flux = gauss::rule(40).integrate(0.0, 1.0, |x| 2.0 * PI * lobe(x * x) * x * x * 2.0 * x);
    for mu in [0.1, 0.5, 1.0] {
        let missing = mu * libm::log1p(1.0 / mu);
        near!(lobe(mu) * flux, missing, INTEGRAL_7, "{mu}: {} {missing}", lobe(mu) * flux);
        let turquin = bound.baker.texel(&[mu, 1.0], 1e-10).unwrap().value[1];
        near!(turquin, missing / (1.0 - missing), INTEGRAL_9);
    }
    // a mirror misses nothing
    assert_eq!(bound.baker.texel(&[0.5, 0.0], 1e-6).unwrap().value[..2], [0.0, 0.0]);
}

#[test]
fn near_mirrors_lose_next_to_nothing_at_normal_incidence() {
    // 1 - E = 2 alpha^2 ln(1 / alpha) and less; the peak in mu_i is alpha^2 wide
    let bound = table("albedo", "ggx", "{}", &["e"], &["mu", "alpha"]);
    for alpha in [1e-8, 1e-7, 1e-6, 1e-5, 1e-4] {
        for mu in [1.0, 1.0 - 1e-12, 0.99] {
            for tolerance in [2.4e-4, 1e-7, 1e-10] {
                let (e, error) = texel(&bound, &[mu, alpha], tolerance);
                let lost = 2.0 * alpha * alpha * libm::log(1.0 / alpha);
                near!(1.0, e, error + lost + DIGIT_LOST, "alpha {alpha}, mu {mu}: {e} +- {error:e}");
            }
        }
    }
}

fn grid_table(kind: &str, model: &str, layout: &str, params: &str, axes: Vec<Axis>) -> Bound {
    let request = Request {
        kind: kind.to_owned(),
        model: Some(model.to_owned()),
        layout: Some(layout.to_owned()),
        params: serde_json::from_str(params).unwrap(),
        axes: Some(axes),
        ..Request::default()
    };
    request.bind().unwrap()
}

#[test]
fn four_axes_of_an_anisotropic_albedo_are_symmetric_and_obey_the_laws() {
    let widths = |id: &str| axis(id, 3, Texel::Endpoint).over([0.2, 0.6]);
    let axes = vec![
        axis("mu", 3, Texel::Center),
        axis("phi", 3, Texel::Endpoint).over([0.0, PI / 2.0]),
        widths("alpha_x"),
        widths("alpha_y"),
    ];
    let bound = grid_table("albedo", "ggx", "e", "{}", axes);
    let table = bake(&bound, 1e-5).unwrap();
    let at = |mu: usize, phi: usize, x: usize, y: usize| table.values[mu + 3 * (phi + 3 * (x + 3 * y))];
    let isotropic = crate::tables_energy::support::table("albedo", "ggx", "{}", &["e"], &["mu", "alpha"]);
    for mu in 0..3 {
        for phi in 0..3 {
            for x in 0..3 {
                for y in 0..3 {
                    // turning by a quarter swaps the widths
                    let (a, b) = (at(mu, phi, x, y), at(mu, 2 - phi, y, x));
                    near!(a, b, INTEGRAL_5_TWICE, "{mu} {phi} {x} {y}: {a} {b}");
                }
                let alpha = 0.2 + 0.2 * x as f64;
                let e = texel(&isotropic, &[(mu as f64 + 0.5) / 3.0, alpha], 1e-8).0;
                near!(at(mu, phi, x, x), e, INTEGRAL_5);
            }
        }
    }
    verify::check(&bound, table, 1e-5, &[]).unwrap();
}

#[test]
fn laws_see_light_that_is_made_or_lost() {
    let axes = || {
        vec![
            axis("mu", 3, Texel::Center),
            axis("roughness", 2, Texel::Endpoint).over([0.4, 1.0]),
            axis("eta", 2, Texel::Endpoint).over([1.3, 1.8]),
        ]
    };
    let bound = grid_table("albedo", "ggx-glass", "both-sides-r-t", "{}", axes());
    let good = bake(&bound, 1e-4).unwrap();
    verify::check(&bound, good.clone(), 1e-4, &[]).unwrap();
    let broken = |bound: &Bound, table: &brdfbake::grid::Table, change: &dyn Fn(&mut Vec<f64>)| {
        let mut table = table.clone();
        change(&mut table.values);
        let findings = verify::check(bound, table, 1e-4, &[]).unwrap_err();
        findings.into_iter().map(|f| f.law).collect::<Vec<_>>()
    };
    let laws = broken(&bound, &good, &|v| v.chunks_mut(4).for_each(|c| c[1] = 1.0));
    assert!(laws.contains(&"energy".to_owned()), "{laws:?}");
    let laws = broken(&bound, &good, &|v| v.chunks_mut(4).for_each(|c| c[3] *= 0.9));
    assert!(laws.contains(&"cross-check".to_owned()), "{laws:?}");
    let bound = grid_table("glass-compensation", "ggx-glass", "missing", "{}", axes());
    let good = bake(&bound, 1e-4).unwrap();
    verify::check(&bound, good.clone(), 1e-4, &[]).unwrap();
    let laws = broken(&bound, &good, &|v| v.iter_mut().for_each(|x| *x += 0.05));
    assert!(laws.contains(&"complement".to_owned()), "{laws:?}");
}

/// Albedo of Disney's clear coat: mu, gloss, E; the rule is converged to 1e-6.
const DISNEY_COAT: [(f64, f64, f64); 4] =
    [(1.0, 0.0, 0.00814496), (0.5, 0.0, 0.01307029), (0.2, 0.0, 0.03050295), (0.5, 1.0, 0.01504064)];

#[test]
fn clear_coats_at_a_fixed_f0_and_the_scaling_below_a_sheen() {
    // Disney's: E by a midpoint rule in half vectors, 6000 x 1200 points, that shares no code with this program
    let coat = table("albedo", "disney-clearcoat", "{}", &["e"], &["mu", "gloss"]);
    for (mu, gloss, expected) in DISNEY_COAT {
        let (got, _) = texel(&coat, &[mu, gloss], 1e-8);
        near!(got, expected, INTEGRAL_6_TWICE, "mu {mu}, gloss {gloss}: {got} {expected}");
    }
    // glTF's: F0 A + B with A and B of the reference integrals at theta = 0.5, alpha = 0.5
    let coat = table("albedo", "ggx", r#"{"f0": 0.04}"#, &["e"], &["mu", "alpha"]);
    let expected = 0.04 * 6.828_272_703_358_252_2e-1 + 5.069_087_395_918_239_3e-4;
    near!(texel(&coat, &[libm::cos(0.5), 0.5], 1e-10).0, expected, INTEGRAL_10);
    // E_charlie_conty_kulla_fitted_lambda at theta = 0.5, r = 0.5
    let scaling = table("sheen-scaling", "", r#"{"sheen": 0.5}"#, &["sheen.scaling"], &["mu", "alpha"]);
    let expected = 1.0 - 0.5 * 1.251_813_172_483_886_2e-1;
    near!(texel(&scaling, &[libm::cos(0.5), 0.5], 1e-10).0, expected, INTEGRAL_9);
}

#[test]
fn estimates_of_reflection_and_transmission_are_honest() {
    let (info, _) = brdfbake::models::find("ggx-glass").unwrap();
    let mut seeds = verify::seeds::Seeds::new(7);
    let mut low = 0;
    for _ in 0..25 {
        let z = 0.1 + 0.7 * seeds.unit();
        let (roughness, mu) = (0.1 + 0.9 * seeds.unit(), seeds.unit());
        let eta = (1.0 + z * z) / (1.0 - z * z);
        for eta in [eta, 1.0 / eta] {
            let mut params = brdfbake::models::Params::resolve(info.id, info.params, []).unwrap();
            for key in ["alpha", "alpha_x", "alpha_y"] {
                params.set(key, roughness * roughness);
            }
            params.set("eta", eta);
            let model = (info.build)(&params).unwrap();
            let parts = |tolerance| {
                let t = model.transmission().unwrap().albedo(mu.into(), tolerance);
                [Some(t), model.reduced(mu, &[Functional::One], tolerance)]
            };
            for (rough, fine) in parts(1.2e-4).into_iter().zip(parts(1e-7)) {
                let (Some(rough), Some(fine)) = (rough, fine) else { continue };
                let off = (rough.value[0] - fine.value[0]).abs() - fine.error[0];
                low += usize::from(off > rough.error[0]);
                assert!(off <= 4.0 * rough.error[0], "mu {mu}, r {roughness}, eta {eta}: off by {off:e}");
            }
        }
    }
    assert!(low <= 1, "{low} of 75 estimates are too small");
}
