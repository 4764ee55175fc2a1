//! Fresnel factors, films, masking: high-precision values, and colours from another program.

use super::helpers::{close, rows, table, texel};
use crate::common::{bake, request};
use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, FEW_ROUNDINGS, MANY_ROUNDINGS};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::terms::metals;
use brdfbake::verify;

const MU: (&str, f64, f64) = ("mu", 0.0, 1.0);

#[test]
fn conductors_agree_with_high_precision_values() {
    for (name, channel) in [("fresnel_conductor_s", 0), ("fresnel_conductor_p", 3)] {
        for row in rows("points_fresnel", name) {
            let params =
                format!(r#"{{"metal": "index", "n": {}, "k": {}}}"#, row.params["n"], row.params["k"]);
            let bound = table("fresnel-conductor", "polarised", &params, &[MU]);
            let e = texel(&bound, &[libm::cos(row.angle)], 1e-9);
            close(&row.name, e.value[channel], row.value, DIGIT_LOST);
            close(&row.name, e.value[channel + 2], row.value, DIGIT_LOST);
        }
    }
    // n and k on axes
    let axes = [MU, ("n", 0.0, 4.0), ("k", 0.0, 100.0)];
    let bound = table("fresnel-conductor", "rgb", r#"{"metal": "index"}"#, &axes);
    for row in rows("points_fresnel", "fresnel_conductor_unpolarised") {
        let at = [libm::cos(row.angle), row.num("n"), row.num("k")];
        close(&row.name, texel(&bound, &at, 1e-9).value[1], row.value, DIGIT_LOST);
    }
}

/// Linear sRGB by another program: numpy, textbook complex amplitudes, the CIE 1931 observer and D65 as their tables have them, twelve
/// Gauss points in each nm.
const GOLD: &[(f64, [f64; 3])] = &[
    (1.0, [1.037_554_373_212, 0.728_348_845_034, 0.364_595_150_412]),
    (0.5, [1.020_061_113_149, 0.737_984_937_886, 0.400_933_137_577]),
    (0.1, [0.992_196_815_169, 0.892_830_448_060, 0.724_227_692_708]),
    (0.02, [0.998_429_626_153, 0.976_171_027_512, 0.931_991_190_303]),
];

/// The same under a coat of index 1.5.
const COATED_GOLD: &[(f64, [f64; 3])] = &[
    (1.0, [1.026_520_505_404, 0.672_671_261_068, 0.259_616_815_588]),
    (0.1, [0.994_392_182_519, 0.916_451_054_013, 0.770_758_833_970]),
];

#[test]
fn gold_is_what_another_program_computes() {
    let bound = table("fresnel-conductor", "srgb", r#"{"metal": "au"}"#, &[MU]);
    for (mu, expected) in GOLD {
        for tolerance in [1e-3, 2.4e-4, 1e-6] {
            let e = texel(&bound, &[*mu], tolerance);
            for (c, x) in expected.iter().enumerate() {
                close(&format!("{mu} {tolerance:e}"), e.value[c], *x, tolerance);
                close(&format!("{mu} {tolerance:e} estimate"), e.value[c], *x, e.error[c] + 1e-10);
            }
        }
    }
}

/// n2, n3, k3, thickness, cosine, colour.
type Coloured = (f64, f64, f64, f64, f64, [f64; 3]);

/// As [`GOLD`].
const FILMS: &[Coloured] = &[
    (1.33, 1.5, 0.0, 0.0, 1.0, [0.04, 0.04, 0.04]),
    (1.33, 1.5, 0.0, 400.0, 1.0, [0.016_695_275_327, 0.039_902_689_642, 0.013_567_421_149]),
    (1.5, 1.33, 0.0, 550.0, 0.5, [0.075_771_638_362, 0.121_157_059_371, 0.065_534_560_275]),
    (1.33, 1.5, 0.0, 1200.0, 0.25, [0.199_051_932_136, 0.242_634_679_829, 0.231_599_792_305]),
    (2.5, 2.5, 3.4, 60.0, 0.8, [0.183_416_488_973, 0.372_834_141_376, 0.554_431_742_390]),
    (1.5, 0.2, 3.4, 9000.0, 0.9, [0.917_163_057_536, 0.917_219_530_850, 0.917_200_613_275]),
];

/// Alumina of 200 nm on aluminium at mu = 0.6, in vacuum and in water.
const ALUMINA: &[(&str, [f64; 3])] = &[
    ("1", [0.907_478_979_100, 0.883_524_491_774, 0.793_988_691_206]),
    ("1.33", [0.870_235_681_983, 0.881_781_491_974, 0.863_005_431_835]),
];

#[test]
fn films_on_metals_and_metals_under_coats_are_what_another_program_computes() {
    for (mu, expected) in COATED_GOLD {
        let bound = table("fresnel-conductor", "srgb", r#"{"metal": "au", "eta": 1.5}"#, &[MU]);
        let e = texel(&bound, &[*mu], 1e-6);
        for (c, x) in expected.iter().enumerate() {
            close(&format!("coat {mu}"), e.value[c], *x, e.error[c] + 1e-10);
        }
    }
    for (eta, expected) in ALUMINA {
        let params = format!(r#"{{"metal": "al", "n2": 1.77, "eta": {eta}}}"#);
        let e = texel(&table("thin-film", "srgb", &params, &[MU, ("film", 0.0, 1e3)]), &[0.6, 200.0], 1e-6);
        for (c, x) in expected.iter().enumerate() {
            close(&format!("film in {eta}"), e.value[c], *x, e.error[c] + 1e-10);
        }
    }
}

/// A metal by rows is the metal; a list of three is three tables; a curve with F0 and tint meets the metal where it must.
#[test]
fn metals_by_rows_by_channels_and_by_tint() {
    let of = |layout: &str, params: &str| table("fresnel-conductor", layout, params, &[MU]);
    let rows = format!(r#"{{"metal": "rows", "nk": {:?}}}"#, metals::find("cu").unwrap().rows);
    for layout in ["rgb", "srgb", "polarised", "f82-tint"] {
        let [own, given] = [r#"{"metal": "cu"}"#, &rows].map(|p| texel(&of(layout, p), &[0.3], 1e-6));
        for (a, b) in own.value.iter().zip(&given.value) {
            close(layout, *a, *b, 0.0);
        }
    }
    let three = of("rgb", r#"{"metal": "index", "n": [0.44, 0.53, 1.09], "k": [3.69, 2.77, 1.83]}"#);
    // closed form: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
    for (c, f0) in [0.887_824, 0.788_292, 0.435_014].into_iter().enumerate() {
        close("F0 of brass", texel(&three, &[1.0], 1e-9).value[c], f0, 5e-7);
    }
    let series = r#"{"n3": [0.44, 0.53, 1.09], "k3": [3.69, 2.77, 1.83]}"#;
    let films = table("thin-film", "series", series, &[MU, ("film", 0.0, 1e3)]);
    let green = table("thin-film", "series", r#"{"n3": 0.53, "k3": 2.77}"#, &[MU, ("film", 0.0, 1e3)]);
    let [films, green] = [films, green].map(|b| texel(&b, &[0.7, 300.0], 1e-9).value);
    close("green", films[1], green[1], 0.0);
    assert!((films[0] - green[0]).abs() > 0.01);
    for mu in [1.0, 1.0 / 7.0] {
        let [f, tint] = ["rgb", "f82-tint"].map(|l| texel(&of(l, r#"{"metal": "al"}"#), &[mu], 1e-9).value);
        for c in 0..3 {
            close(&format!("tint at {mu}"), tint[c], f[c], MANY_ROUNDINGS);
        }
    }
}

/// What cannot be: a reason that names it.
#[test]
fn metals_that_cannot_be_are_refused() {
    for (layout, params, part) in [
        ("srgb", r#"{"metal": "index", "n": [0.4, 0.5, 1.0]}"#, "lists of three have no spectrum"),
        ("rgb", r#"{"metal": "rows"}"#, "wants two rows or more"),
        ("rgb", r#"{"nk": [[400, 1, 2], [700, 1, 2]]}"#, "write metal = \"rows\""),
        ("rgb", r#"{"metal": "rows", "nk": [[500, 1, 2], [700, 1, 2]]}"#, "from 500 to 700 nm"),
        ("rgb", r#"{"metal": "rows", "nk": [[400, 1, 2], [400, 1, 2]]}"#, "row 2 is not beyond"),
        ("rgb", r#"{"metal": "index", "n": [0.4, 0.5]}"#, "or three in a list"),
        ("rgb", r#"{"metal": "index", "n": [0.4, 0.5, -1]}"#, "n = -1"),
    ] {
        let request = brdfbake::tables::spec::Request {
            kind: "fresnel-conductor".to_owned(),
            layout: Some(layout.to_owned()),
            params: serde_json::from_str(params).unwrap(),
            ..Default::default()
        };
        let why = request.bind().unwrap_err().to_string();
        assert!(why.contains(part), "{params}: {why}");
    }
}

#[test]
fn films_are_what_another_program_computes() {
    for (n2, n3, k3, d, mu, expected) in FILMS {
        let params = format!(r#"{{"n2": {n2}, "n3": {n3}, "k3": {k3}}}"#);
        let bound = table("thin-film", "srgb", &params, &[MU, ("film", 0.0, 1e4)]);
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let e = texel(&bound, &[*mu, *d], tolerance);
            for (c, x) in expected.iter().enumerate() {
                close(&format!("{params} {d} {tolerance:e}"), e.value[c], *x, tolerance);
                close(&format!("{params} {d} {tolerance:e} estimate"), e.value[c], *x, e.error[c] + 2e-12);
            }
        }
    }
}

#[test]
fn the_series_is_near_the_spectrum_where_it_should_be() {
    // both are fits of one eye under different whites: a few hundredths apart on a dielectric
    let params = r#"{"n2": 1.5, "n3": 1.33, "orders": 3}"#;
    let axes = [MU, ("film", 0.0, 1e4)];
    let series = table("thin-film", "series", params, &axes);
    let exact = table("thin-film", "srgb", r#"{"n2": 1.5, "n3": 1.33}"#, &axes);
    for d in [100.0, 300.0, 550.0] {
        let (a, b) = (texel(&series, &[0.7, d], 1e-9), texel(&exact, &[0.7, d], 1e-9));
        for c in 0..3 {
            close(&format!("{d}"), a.value[c], b.value[c], 0.03);
        }
    }
}

#[test]
fn schlick_and_its_variants_agree_with_high_precision_values() {
    for (name, variant, names) in [
        ("fresnel_schlick", "generalised", &[("F0", "f0"), ("F90", "f90"), ("exponent", "exponent")][..]),
        ("fresnel_f82_tint_unclamped", "f82-tint", &[("F0", "f0"), ("tint", "tint")]),
        ("fresnel_lazanyi", "lazanyi", &[("n", "n"), ("k", "k"), ("a", "a"), ("alpha", "q")]),
    ] {
        for row in rows("points_fresnel", name) {
            let given: Vec<String> = names
                .iter()
                .filter(|n| row.params.get(n.0).is_some())
                .map(|n| format!(r#""{}": {}"#, n.1, row.params[n.0]))
                .collect();
            let params = format!(r#"{{"variant": "{variant}", {}}}"#, given.join(", "));
            let bound = table("fresnel-schlick", "unclamped", &params, &[MU]);
            close(
                &row.name,
                texel(&bound, &[libm::cos(row.angle)], 1e-9).value[0],
                row.value,
                MANY_ROUNDINGS,
            );
        }
    }
    // from the denser side: no light passes beyond the critical angle, and F0 is that of the other side
    let bound = table("fresnel-schlick", "clamped", r#"{"variant": "dielectric", "eta": 0.5}"#, &[MU]);
    close("total", texel(&bound, &[0.8], 1e-9).value[0], 1.0, 0.0);
    close("normal", texel(&bound, &[1.0], 1e-9).value[0], 1.0 / 9.0, FEW_ROUNDINGS);
    // negative values are cut where renderers cut them
    let dark = r#"{"variant": "f82-tint", "f0": 0, "tint": 0}"#;
    let at = [0.261];
    close(
        "dip",
        texel(&table("fresnel-schlick", "unclamped", dark, &[MU]), &at, 1e-9).value[0],
        -0.1268,
        1e-4,
    );
    close("cut", texel(&table("fresnel-schlick", "clamped", dark, &[MU]), &at, 1e-9).value[0], 0.0, 0.0);
}

#[test]
fn masking_and_visibility_are_closed_forms_at_width_one() {
    // GGX, alpha = 1: Lambda = (1/mu - 1)/2, so G1 = 2 mu/(1 + mu), G2 = 2 mu_o mu_i/(mu_o + mu_i)
    let g1 = table("masking", "g1", "{}", &[MU, ("alpha", 0.0, 1.0)]);
    let axes = [MU, ("mu_i", 0.0, 1.0)];
    for mu in [1e-6, 0.01, 0.3, 0.9, 1.0] {
        close("G1", texel(&g1, &[mu, 1.0], 1e-9).value[0], 2.0 * mu / (1.0 + mu), FEW_ROUNDINGS);
        for mu_i in [0.02, 0.5, 1.0] {
            let value = |layout: &str, masking: &str| {
                let params = format!(r#"{{"masking": "{masking}", "alpha": 1}}"#);
                texel(&table("visibility", layout, &params, &axes), &[mu, mu_i], 1e-9).value[0]
            };
            close("V", value("visibility", "correlated"), 0.5 / (mu + mu_i), DIGIT_LOST / mu_i);
            close("G2", value("g2", "correlated"), 2.0 * mu * mu_i / (mu + mu_i), MANY_ROUNDINGS);
            let product = 4.0 * mu * mu_i / ((1.0 + mu) * (1.0 + mu_i));
            close("G1 G1", value("g2", "separable"), product, MANY_ROUNDINGS);
            close("V sep", value("visibility", "separable"), product / (4.0 * mu * mu_i), DIGIT_LOST);
        }
    }
    // Lambda of Beckmann against high-precision values of equal widths
    for row in
        rows("points_terms", "Lambda_beckmann").iter().filter(|r| r.params["alpha_x"] == r.params["alpha_y"])
    {
        let bound = table("masking", "g1", r#"{"distribution": "beckmann"}"#, &[MU, ("alpha", 0.0, 2.0)]);
        let got = texel(&bound, &[libm::cos(row.angle), row.num("alpha_x")], 1e-9).value[0];
        close(&row.name, got, 1.0 / (1.0 + row.value), DIGITS_LOST);
    }
    // Karis: k = alpha/2
    let karis = table("masking", "g1", r#"{"distribution": "schlick-ibl"}"#, &[MU, ("alpha", 0.0, 1.0)]);
    close("karis", texel(&karis, &[0.5, 0.5], 1e-9).value[0], 0.5 / (0.5 * 0.75 + 0.25), FEW_ROUNDINGS);
}

#[test]
fn laws_hold() {
    let axis = |id: &str| Axis::new(Quantity::find(id).unwrap(), 9, Texel::Center);
    let film = || Axis::new(Quantity::find("film").unwrap(), 9, Texel::Endpoint).over([0.0, 900.0]);
    for (kind, layout, params, axes) in [
        ("fresnel-conductor", "rgb", r#"{"metal": "cu"}"#, vec![axis("mu")]),
        ("fresnel-conductor", "srgb", r#"{"metal": "cu"}"#, vec![axis("mu")]),
        (
            "fresnel-schlick",
            "clamped",
            r#"{"variant": "f82-tint", "tint": 0.2}"#,
            vec![axis("mu"), axis("f0")],
        ),
        ("thin-film", "srgb", "{}", vec![axis("mu"), film()]),
        ("thin-film", "series", "{}", vec![axis("mu"), film()]),
        ("masking", "g1", "{}", vec![axis("mu"), axis("roughness")]),
        ("visibility", "visibility", "{}", vec![axis("mu"), axis("mu_i"), axis("roughness")]),
    ] {
        let bound = request(kind, layout, params, axes);
        let table = bake(&bound, 1e-5).unwrap();
        let checked = verify::check(&bound, table, 1e-5, &[]);
        assert!(checked.is_ok(), "{kind} {layout}: {:?}", checked.unwrap_err());
    }
}
