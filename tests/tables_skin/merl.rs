//! The MERL binary, read by the index functions of the published reader (written here from its text, apart from the writer).

use crate::tolerance::{SINGLE, SINGLE_ANGLES, SINGLE_NEAREST, near};
use brdfbake::cancel::Cancel;
use brdfbake::encode::Storage;
use brdfbake::models::{self, Params};
use brdfbake::pipeline::{self, Settings, Silent};
use brdfbake::plan::{Output, Plan, TableRequest};
use brdfbake::tables::merl::directions;
use brdfbake::tables::spec::Request;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

const BRDF_SAMPLING_RES_THETA_H: usize = 90;
const BRDF_SAMPLING_RES_THETA_D: usize = 90;
const BRDF_SAMPLING_RES_PHI_D: usize = 360;

type Vector = [f64; 3];

fn rotate_vector(vector: Vector, axis: Vector, angle: f64) -> Vector {
    let (sin_ang, cos_ang) = libm::sincos(angle);
    let dot: f64 = axis.iter().zip(&vector).map(|(a, v)| a * v).sum::<f64>() * (1.0 - cos_ang);
    let cross = [
        axis[1] * vector[2] - axis[2] * vector[1],
        axis[2] * vector[0] - axis[0] * vector[2],
        axis[0] * vector[1] - axis[1] * vector[0],
    ];
    [0, 1, 2].map(|i| vector[i] * cos_ang + axis[i] * dot + cross[i] * sin_ang)
}

/// theta_half, theta_diff, phi_diff.
fn std_coords_to_half_diff_coords(theta_in: f64, fi_in: f64, theta_out: f64, fi_out: f64) -> [f64; 3] {
    let spherical = |theta: f64, fi: f64| -> Vector {
        [libm::sin(theta) * libm::cos(fi), libm::sin(theta) * libm::sin(fi), libm::cos(theta)]
    };
    let (input, output) = (spherical(theta_in, fi_in), spherical(theta_out, fi_out));
    let mut half = [0, 1, 2].map(|i| 0.5 * (input[i] + output[i]));
    let length = half.iter().map(|x| x * x).sum::<f64>().sqrt();
    half = half.map(|x| x / length);
    let theta_half = libm::acos(half[2]);
    let fi_half = libm::atan2(half[1], half[0]);
    let temp = rotate_vector(input, [0.0, 0.0, 1.0], -fi_half);
    let diff = rotate_vector(temp, [0.0, 1.0, 0.0], -theta_half);
    [theta_half, libm::acos(diff[2]), libm::atan2(diff[1], diff[0])]
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "as the published reader does it")]
fn theta_half_index(theta_half: f64) -> usize {
    if theta_half <= 0.0 {
        return 0;
    }
    let theta_half_deg = (theta_half / (PI / 2.0)) * BRDF_SAMPLING_RES_THETA_H as f64;
    let temp = (theta_half_deg * BRDF_SAMPLING_RES_THETA_H as f64).sqrt();
    (temp as usize).min(BRDF_SAMPLING_RES_THETA_H - 1)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "as the published reader does it")]
fn theta_diff_index(theta_diff: f64) -> usize {
    let tmp = theta_diff / (PI * 0.5) * BRDF_SAMPLING_RES_THETA_D as f64;
    (tmp.max(0.0) as usize).min(BRDF_SAMPLING_RES_THETA_D - 1)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "as the published reader does it")]
fn phi_diff_index(phi_diff: f64) -> usize {
    let phi_diff = if phi_diff < 0.0 { phi_diff + PI } else { phi_diff };
    let tmp = phi_diff / PI * (BRDF_SAMPLING_RES_PHI_D / 2) as f64;
    (tmp.max(0.0) as usize).min(BRDF_SAMPLING_RES_PHI_D / 2 - 1)
}

struct Brdf(Vec<f64>);

/// read_brdf: three ints, then doubles until the end.
fn read_brdf(bytes: &[u8]) -> Brdf {
    let dims: Vec<usize> = bytes[..12]
        .chunks(4)
        .map(|c| usize::try_from(i32::from_le_bytes(c.try_into().unwrap())).unwrap())
        .collect();
    let n: usize = dims.iter().product();
    assert_eq!(n, BRDF_SAMPLING_RES_THETA_H * BRDF_SAMPLING_RES_THETA_D * BRDF_SAMPLING_RES_PHI_D / 2);
    assert_eq!(bytes.len(), 12 + 3 * 8 * n);
    Brdf(bytes[12..].chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect())
}

impl Brdf {
    /// lookup_brdf_val.
    fn lookup(&self, theta_in: f64, fi_in: f64, theta_out: f64, fi_out: f64) -> [f64; 3] {
        let [theta_half, theta_diff, fi_diff] =
            std_coords_to_half_diff_coords(theta_in, fi_in, theta_out, fi_out);
        let ind = phi_diff_index(fi_diff)
            + theta_diff_index(theta_diff) * BRDF_SAMPLING_RES_PHI_D / 2
            + theta_half_index(theta_half) * BRDF_SAMPLING_RES_PHI_D / 2 * BRDF_SAMPLING_RES_THETA_D;
        let plane = BRDF_SAMPLING_RES_THETA_H * BRDF_SAMPLING_RES_THETA_D * BRDF_SAMPLING_RES_PHI_D / 2;
        [
            self.0[ind] * (1.0 / 1500.0),
            self.0[ind + plane] * (1.15 / 1500.0),
            self.0[ind + 2 * plane] * (1.66 / 1500.0),
        ]
    }
}

fn spherical(w: glam::DVec3) -> (f64, f64) {
    (libm::acos(w.z), libm::atan2(w.y, w.x))
}

/// Bakes a model to a MERL file by the whole pipeline.
fn file(model: &str, params: &str) -> Vec<u8> {
    let request = Request {
        kind: "merl".into(),
        model: Some(model.into()),
        params: serde_json::from_str(params).unwrap(),
        ..Request::default()
    };
    let table = TableRequest {
        outputs: Some(vec![Output::new(&brdfbake::encode::Merl, Storage::Float)]),
        reconstruction: Some(false),
        ..TableRequest::new("measured", request)
    };
    let plan = Plan::from_requests("merl", vec![table]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { jobs: Some(2), ..Settings::new(folder.path()) };
    pipeline::run(&plan, &settings, &Cancel::new(), &Silent).unwrap();
    std::fs::read(folder.path().join("measured.binary")).unwrap()
}

#[test]
fn a_matte_surface_is_the_same_everywhere() {
    let brdf = read_brdf(&file("lambert", r#"{"rho": 0.5, "red": 1, "green": 0.5, "blue": 0.25}"#));
    let mut state = 7u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    for _ in 0..2000 {
        let [a, b, c, d] =
            [1.35 * unit(), PI * (2.0 * unit() - 1.0), 1.35 * unit(), PI * (2.0 * unit() - 1.0)];
        let got = brdf.lookup(a, b, c, d);
        for (got, factor) in got.iter().zip([1.0, 0.5, 0.25]) {
            let expected = 0.5 * FRAC_1_PI * factor;
            near!(*got, expected, SINGLE * expected, "{a} {b} {c} {d}: {got} {expected}");
        }
    }
}

#[test]
fn every_cell_is_found_by_the_published_indices() {
    let brdf = read_brdf(&file("ggx", r#"{"alpha": 0.3, "f0": 0.5}"#));
    let (info, _) = models::find("ggx").unwrap();
    let (alpha, f0) = (serde_json::json!(0.3), serde_json::json!(0.5));
    let params = Params::resolve(info.id, info.params, [("alpha", &alpha), ("f0", &f0)]).unwrap();
    let model = (info.build)(&params).unwrap();
    let (mut seen, mut lit) = (0, 0);
    for h in (0..90).step_by(7) {
        for d in (0..90).step_by(5) {
            for p in (0..180).step_by(11) {
                let middle = |i: usize, n: f64| (i as f64 + 0.5) / n;
                let x = middle(h, 90.0);
                let (theta_h, theta_d, phi_d) =
                    (x * x * FRAC_PI_2, middle(d, 90.0) * FRAC_PI_2, middle(p, 180.0) * PI);
                let (wo, wi) = directions(theta_h, theta_d, phi_d);
                let ((ti, fi), (to, fo)) = (spherical(wi), spherical(wo));
                // what the reader makes of the directions are the angles that they were made from
                let angles = std_coords_to_half_diff_coords(ti, fi, to, fo);
                for (got, expected) in angles.iter().zip([theta_h, theta_d, phi_d]) {
                    near!(*got, expected, SINGLE_ANGLES, "{theta_h} {theta_d} {phi_d}: {angles:?}");
                }
                // turned about the normal, and with both directions exchanged, it is the same cell
                for got in [
                    brdf.lookup(ti, fi, to, fo),
                    brdf.lookup(ti, fi + 1.0, to, fo + 1.0),
                    brdf.lookup(to, fo, ti, fi),
                ] {
                    let expected = model.eval(wo, wi);
                    near!(got[1], expected, SINGLE_NEAREST * expected, "{h} {d} {p}: {got:?} {expected}");
                    lit += usize::from(expected > 0.0);
                }
                seen += 1;
            }
        }
    }
    assert!(lit > seen, "{lit} of {}", 3 * seen);
}

#[test]
fn what_does_not_fit_is_refused() {
    let bind = |model: &str, params: &str| {
        let request = Request {
            kind: "merl".into(),
            model: Some(model.into()),
            params: serde_json::from_str(params).unwrap(),
            ..Request::default()
        };
        request.bind().map(|_| ())
    };
    assert!(
        bind("ggx", r#"{"alpha_x": 0.1, "alpha_y": 0.4}"#).unwrap_err().to_string().contains("anisotropic")
    );
    assert!(bind("phong-classic", "{}").unwrap_err().to_string().contains("not reciprocal"));
    assert!(bind("mirror", "{}").unwrap_err().to_string().contains("mirror"));
    // another grid: refused by the container, in words
    let grid = brdfbake::grid::Grid::new(
        brdfbake::tables::merl::default_axes()
            .into_iter()
            .map(|a| brdfbake::grid::Axis { len: 4, ..a })
            .collect(),
    );
    let grid = grid.unwrap();
    let channels = [brdfbake::grid::Channel {
        id: "f".into(),
        meaning: String::new(),
        range: [0.0, 1.0],
        role: String::new(),
    }];
    let input = brdfbake::encode::EncodeInput {
        grid: &grid,
        channels: &channels,
        values: &[0.0; 64],
        blocks: &[],
        errors: &[0.0; 64],
        options: &[],
        storage: Storage::Float,
        label: brdfbake::encode::Label::default(),
        cancel: &Cancel::new(),
    };
    let error = brdfbake::encode::encoder("merl").unwrap().encode(&input).unwrap_err().to_string();
    assert!(error.starts_with("merl cannot hold these axes"), "{error}");
}

/// Reads a file with `tests/foreign/read_merl.py`, where Python is at hand.
#[test]
#[ignore = "needs python3 on the path"]
fn python_reads_it_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lambert.binary");
    std::fs::write(&path, file("lambert", r#"{"rho": 0.5}"#)).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/foreign/read_merl.py");
    let out = std::process::Command::new("python3")
        .arg(script)
        .arg(&path)
        .args(["0.3", "0", "0.8", "2.5"])
        .output();
    let text = String::from_utf8(out.unwrap().stdout).unwrap();
    for number in text.split_whitespace() {
        near!(number.parse::<f64>().unwrap(), 0.5 * FRAC_1_PI, SINGLE, "{text}");
    }
    assert_eq!(text.split_whitespace().count(), 3);
}
