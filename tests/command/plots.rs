//! Plots of lobes, albedos and hemispheres, as they are seen.

use super::support::{brdfbake, code, err, folder, text};
use crate::tolerance::SHOWN;
use std::path::Path;

const COLOURS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

/// Draws into a folder; the text of the SVG.
fn svg(dir: &Path, args: &[&str]) -> String {
    let to = dir.join("plot.svg");
    let o = brdfbake(&[&["plot"], args, &["-o", text(&to)]].concat());
    assert_eq!(code(&o), 0, "{args:?}: {}", err(&o));
    std::fs::read_to_string(to).unwrap()
}

/// The points of every thick curve of a colour.
fn curves(svg: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let head = format!("stroke=\"{colour}\" stroke-width=\"2\" points=\"");
    let lines =
        svg.lines().filter_map(|l| l.split_once(&head)).map(|(_, rest)| rest.trim_end_matches("\"/>"));
    lines
        .map(|l| {
            l.split(' ')
                .map(|p| p.split_once(',').unwrap())
                .map(|(x, y)| [x, y].map(|v| v.parse().unwrap()))
                .collect()
        })
        .collect()
}

/// How far a curve goes from its lowest point.
fn tall(curve: &[[f64; 2]]) -> f64 {
    let y = || curve.iter().map(|p| p[1]);
    y().fold(f64::MIN, f64::max) - y().fold(f64::MAX, f64::min)
}

#[test]
fn a_divergence_at_the_horizon_leaves_the_lobe() {
    let dir = folder();
    for model in ["ward", "ward-duer", "ashikhmin-shirley-specular"] {
        let drawn = svg(dir.path(), &[model, "--angles", "0,30"]);
        for colour in &COLOURS[..2] {
            let all = curves(&drawn, colour);
            assert!(!all.is_empty() && tall(&all[0]) > 100.0, "{model} {colour}: an empty lobe");
        }
    }
    assert!(svg(dir.path(), &["ward"]).contains("cut where"));
    assert!(!svg(dir.path(), &["lambert"]).contains("cut where"));
}

#[test]
fn several_models_and_a_sweep_share_a_picture_that_says_what_they_are() {
    let dir = folder();
    let drawn = svg(dir.path(), &["ggx", "--sweep", "alpha=0.2,0.4,0.8", "--angles", "30"]);
    for (colour, alpha) in COLOURS.iter().zip(["0.2", "0.4", "0.8"]) {
        assert_eq!(curves(&drawn, colour).len(), 1);
        assert!(drawn.contains(&format!("ggx, alpha = {alpha}: largest f")), "{alpha}");
    }
    let drawn = svg(dir.path(), &["lambert", "ggx", "-p", "alpha=0.3", "--angles", "0,60"]);
    assert_eq!(COLOURS.map(|c| curves(&drawn, c).len()), [2, 2, 0]);
    // f of a white diffuse surface is 1 / pi at every angle
    assert!(drawn.contains("lambert: largest f 0.3183 (0 deg), 0.3183 (60 deg)"), "{drawn}");
    let drawn = svg(dir.path(), &["ggx", "-p", "alpha=0.3"]);
    assert!(drawn.contains("alpha_x = 0.3") && drawn.contains("masking = correlated"), "{drawn}");
    // a glass has a lobe below the surface
    let glass = svg(dir.path(), &["ggx-glass", "--angles", "30"]);
    assert!(glass.contains("below: transmitted") && curves(&glass, COLOURS[0]).len() == 2);
}

#[test]
fn the_azimuth_turns_the_plane_of_incidence() {
    let dir = folder();
    let ward = [
        "ward",
        "-p",
        "rho_d=0",
        "-p",
        "alpha_x=0.1",
        "-p",
        "alpha_y=0.5",
        "--angles",
        "0",
        "--scale",
        "linear",
    ];
    let half = |azimuth: &str| {
        let curve =
            curves(&svg(dir.path(), &[&ward[..], &["--azimuth", azimuth]].concat()), COLOURS[0]).remove(0);
        let x = || curve.iter().map(|p| p[0]);
        x().fold(f64::MIN, f64::max) - x().fold(f64::MAX, f64::min)
    };
    // narrow along the tangent, wide across it; half a turn is the same
    assert!(half("90") > 2.0 * half("0"), "{} {}", half("90"), half("0"));
    assert!((half("180") - half("0")).abs() < 0.1);
}

#[test]
fn albedos_are_curves_over_the_view() {
    let dir = folder();
    let drawn = svg(dir.path(), &["lambert", "ggx", "--show", "albedo"]);
    assert!(drawn.contains("lambert: E 1 at grazing, 1 at normal"), "{drawn}");
    let flat = &curves(&drawn, COLOURS[0])[0];
    assert!(tall(flat) < 0.05 && flat.len() >= 2);
    // E(1) as the command prints it
    let o = brdfbake(&["albedo", "ggx", "--mu", "1"]);
    let e: f64 = super::support::out(&o).lines().nth(1).unwrap().split('\t').nth(1).unwrap().parse().unwrap();
    let told = drawn.split("ggx: E ").nth(1).unwrap().split(" at grazing, ").nth(1).unwrap();
    let told: f64 = told.split(' ').next().unwrap().parse().unwrap();
    assert!((told - e).abs() < SHOWN, "{told} {e}");
}

#[test]
fn pixels_have_words_and_hemispheres_are_round() {
    let dir = folder();
    let to = dir.path().join("map.png");
    let drawn = |args: &[&str]| {
        let o = brdfbake(&[&["plot"], args, &["-o", text(&to)]].concat());
        assert_eq!(code(&o), 0, "{}", err(&o));
        image::open(&to).unwrap().to_rgb8()
    };
    let [a, b] =
        ["0.3", "0.4"].map(|alpha| drawn(&["ggx", "-p", &format!("alpha={alpha}"), "--angles", "0"]));
    let title = |i: &image::RgbImage| {
        (0..26).map(|y| (0..i.width()).filter(|x| i.get_pixel(*x, y).0[0] < 128).count()).sum::<usize>()
    };
    assert!(title(&a) > 100, "no title: {}", title(&a));
    let differs = (0..26).any(|y| (0..a.width()).any(|x| a.get_pixel(x, y) != b.get_pixel(x, y)));
    assert!(differs, "the parameters are not in the picture");
    // straight down an isotropic lobe is the same all round; an anisotropic one is not
    let round = |i: &image::RgbImage| {
        // the disc: 220 pixels from 20 to the right, under the title and the name
        let top = (40..80).find(|y| i.get_pixel(130, *y).0 != [255; 3]).unwrap();
        let at = |x: u32, y: u32| i.get_pixel(20 + x, top + y).0;
        let off = |a: [u8; 3], b: [u8; 3]| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap();
        (20..80).map(|k| off(at(109 - k, 109), at(109, 109 - k))).max().unwrap()
    };
    let isotropic = round(&drawn(&["ggx", "-p", "alpha=0.3", "--show", "map", "--angles", "0"]));
    let anisotropic = ["ward", "-p", "alpha_x=0.1", "-p", "alpha_y=0.5", "--show", "map", "--angles", "0"];
    assert!(isotropic <= 2, "{isotropic}");
    assert!(round(&drawn(&anisotropic)) > 40);
}

#[test]
fn what_plots_cannot_show_is_refused() {
    for (args, exit, named) in [
        (&["ggx", "--azimuth", "30"][..], 2, "--azimuth"),
        (&["ggx", "--show", "albedo", "--angles", "30"], 2, "--angles"),
        (&["ggx", "--show", "albedo", "--scale", "log"], 2, "--scale"),
        (&["ggx", "ggx"], 2, "twice"),
        (&["ggx", "--sweep", "alpha=0.1,0.1"], 2, "twice"),
        (&["ggx", "--sweep", "alpha"], 2, "KEY=V1,V2"),
        (&["ggx", "-p", "alpha=0.1", "--sweep", "alpha=0.1,0.2"], 3, "--param"),
        (&["lambert", "eon", "-p", "alpha=0.1"], 3, "alpha"),
        (&["ggx", "--sweep", "alpha=0.1,0.2,0.3,0.4,0.5,0.6,0.7"], 2, "at most"),
        (&["ggx", "lambrt"], 3, "lambert"),
    ] {
        let o = brdfbake(&[&["plot"], args].concat());
        assert!(code(&o) == exit && err(&o).contains(named), "{args:?}: {} {}", code(&o), err(&o));
    }
}
