//! Distributions of facet normals.

use super::{FunctionInfo, Input, NO_ANGLES, REFERENCE, alias, known, number, theta};
use crate::cite;
use crate::models::{DefaultValue, Param};
use crate::terms::beckmann::Beckmann;
use crate::terms::ggx::Ggx;
use crate::terms::smith::Ndf;
use crate::terms::student_t::StudentT;
use crate::terms::{blinn_phong, charlie, gtr, kelemen, sggx, velvet};

pub(super) const ALPHA: Param = number("alpha", "width; alpha = roughness^2", [1e-8, 2.0], 0.25).also(&["m"]);
pub(super) const ALPHA_X: Param = Param::number(
    "alpha_x",
    "alpha_x",
    "width along the tangent; equal to alpha unless given",
    [1e-8, 2.0],
    DefaultValue::Of("alpha"),
);
pub(super) const ALPHA_Y: Param = Param::number(
    "alpha_y",
    "alpha_y",
    "width along the bitangent; equal to alpha unless given",
    [1e-8, 2.0],
    DefaultValue::Of("alpha"),
);
pub(super) const ROUGHNESS: Param =
    number("roughness", "roughness of the cloth", [1e-3, 1.0], 0.5).also(&["r"]);
pub(super) const GAMMA: Param =
    number("gamma", "exponent of the tail; 2 is GGX, large is Beckmann", [1.500_001, 1e8], 2.0);
const SIGMA: Param = number("sigma", "width of the fibres", [1e-4, 2.0], 0.5);
const NORMAL: Input = Input::Wi("the facet normal");
const SMITH: &str = "The integral of D cos over the hemisphere is 1. Below the horizon D is 0.";

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "d-ggx",
        title: "GGX (Trowbridge-Reitz) distribution of normals",
        formula: "1 / (pi ax ay ((x / ax)^2 + (y / ay)^2 + z^2)^2)",
        sources: &[(cite::WALTER_2007, "Eq. 33"), (cite::BURLEY_2012, "App. B Eq. 13")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: SMITH,
        also: &[alias("D_ggx")],
        known: &[known(&[("alpha", "0.25")], theta(0.0), 5.092_958_178_940_651, 1e-14, REFERENCE)],
        eval: |p, at| Ok(Ggx::new(p.number("alpha_x")?, p.number("alpha_y")?).d(at.wi)),
    },
    FunctionInfo {
        id: "d-beckmann",
        title: "Beckmann's distribution of normals",
        formula: "exp(-X) / (pi ax ay cos^4), X = ((x / ax)^2 + (y / ay)^2) / z^2",
        sources: &[(cite::WALTER_2007, "Eq. 25"), (cite::COOK_TORRANCE_1982, "section 2, without pi there")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: SMITH,
        also: &[alias("D_beckmann")],
        known: &[known(&[("alpha", "1")], [1.0, 2.5, 0.0, 0.0], 0.330_303_673_440_412_34, 1e-14, REFERENCE)],
        eval: |p, at| Ok(Beckmann::new(p.number("alpha_x")?, p.number("alpha_y")?).d(at.wi)),
    },
    FunctionInfo {
        id: "d-blinn-phong",
        title: "Blinn-Phong distribution of normals",
        formula: "(n + 2) / (2 pi) cos^n",
        sources: &[(cite::WALTER_2007, "Eq. 30")],
        params: &[number("n", "exponent", [0.0, 1e7], 64.0)],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Close to Beckmann with alpha^2 = 2 / (n + 2).",
        also: &[alias("D_blinn_phong")],
        known: &[known(&[("n", "2.5")], theta(0.5), 0.516_716_830_715_63, 1e-14, REFERENCE)],
        eval: |p, at| Ok(blinn_phong::d(p.number("n")?, at.wi)),
    },
    FunctionInfo {
        id: "d-gtr",
        title: "GTR, generalised Trowbridge-Reitz",
        formula: "c / (1 + (alpha^2 - 1) cos^2)^gamma, c = (gamma - 1)(alpha^2 - 1) / (pi (1 - alpha^(2(1 - gamma))))",
        sources: &[(cite::BURLEY_2012, "App. B Eq. 1 to 3")],
        params: &[ALPHA, number("gamma", "exponent of the tail; 2 is GGX", [0.0, 10.0], 1.0)],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Regular at gamma = 1 and at alpha = 1, where the printed constant is 0/0. No masking is known for general gamma.",
        also: &[alias("D_gtr")],
        known: &[known(
            &[("alpha", "0.25"), ("gamma", "1")],
            theta(0.0),
            1.722_090_353_487_319_3,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| Ok(gtr::d(p.number("alpha")?, p.number("gamma")?, at.wi)),
    },
    FunctionInfo {
        id: "d-student-t",
        title: "Student's t distribution of slopes (STD)",
        formula: "(1 + X / (gamma - 1))^(-gamma) / (pi ax ay cos^4), X = ((x / ax)^2 + (y / ay)^2) / z^2",
        sources: &[
            (cite::RIBARDIERE_2017, "Eq. 18, by appleseed"),
            (cite::APPLESEED, "`StdMDF::D`: the same form"),
        ],
        params: &[ALPHA, ALPHA_X, ALPHA_Y, GAMMA],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "gamma = 2 is GGX, gamma -> infinity Beckmann; below 2 it grows without bound at the horizon.",
        also: &[alias("D_std")],
        known: &[known(
            &[("alpha", "1"), ("gamma", "10")],
            theta(1.0),
            0.343_533_138_618_162_54,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| {
            Ok(StudentT::new(p.number("alpha_x")?, p.number("alpha_y")?, p.number("gamma")?).d(at.wi))
        },
    },
    FunctionInfo {
        id: "d-charlie",
        title: "Charlie: a power of the sine, for cloth",
        formula: "(2 + 1/r) sin^(1/r) / (2 pi)",
        sources: &[(cite::ESTEVEZ_KULLA_2017, "Eq. 2")],
        params: &[ROUGHNESS],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "0 at the normal: the fibres stand up.",
        also: &[alias("D_charlie")],
        known: &[known(&[("roughness", "1")], theta(1.0), 0.401_772_800_101_745_65, 1e-14, REFERENCE)],
        eval: |p, at| Ok(charlie::d(p.number("roughness")?, at.wi)),
    },
    FunctionInfo {
        id: "d-velvet-2000",
        title: "Velvet: an inverted Gaussian",
        formula: "exp(-cot^2 / sigma^2) / (pi sigma^2 sin^4)",
        sources: &[(cite::ASHIKHMIN_2000, "section 5.1")],
        params: &[SIGMA],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Normalised here; goes with V-cavity masking.",
        also: &[],
        known: &[known(
            &[("sigma", "1")],
            theta(std::f64::consts::FRAC_PI_2 - 1e-9),
            std::f64::consts::FRAC_1_PI,
            1e-12,
            "closed form: 1 / (pi sigma^2) at the horizon",
        )],
        eval: |p, at| Ok(velvet::d_2000(p.number("sigma")?, at.wi)),
    },
    FunctionInfo {
        id: "d-velvet-2007",
        title: "Velvet: an inverted Gaussian on a floor",
        formula: "(1 + 4 exp(-cot^2 / alpha^2) / sin^4) / (pi (1 + 4 alpha^2))",
        sources: &[(cite::ASHIKHMIN_PREMOZE_2007, "section 4"), (cite::NEUBELT_PETTINEO_2013, "the norm")],
        params: &[number("alpha", "width", [1e-4, 1.0], 0.5)],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "A widely copied line lacks the sin^4.",
        also: &[],
        known: &[known(
            &[("alpha", "0.5")],
            theta(0.0),
            0.5 * std::f64::consts::FRAC_1_PI,
            1e-15,
            "closed form: 1 / (pi (1 + 4 alpha^2)) at the normal",
        )],
        eval: |p, at| Ok(velvet::d_2007(p.number("alpha")?, at.wi)),
    },
    FunctionInfo {
        id: "d-sggx",
        title: "SGGX fibres, S = diag(1, 1, sigma^2)",
        formula: "1 / (pi sigma (x^2 + y^2 + z^2 / sigma^2)^2)",
        sources: &[(cite::HEITZ_2015, "Eq. 11")],
        params: &[number("sigma", "thickness of the fibres along the normal", [1e-4, 1.0], 0.5)],
        inputs: &[NORMAL],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "A density over the whole sphere. sigma = 1 is isotropic, 1 / pi.",
        also: &[],
        known: &[known(
            &[("sigma", "0.25")],
            theta(0.0),
            0.015_625 * std::f64::consts::FRAC_1_PI,
            1e-15,
            "closed form: sigma^3 / pi at the normal",
        )],
        eval: |p, at| Ok(sggx::d(p.number("sigma")?, at.wi)),
    },
    FunctionInfo {
        id: "kelemen-texel",
        title: "Texel of the Beckmann texture of GPU Gems 3",
        formula: "0.5 PH^0.1, PH = exp(-tan^2 / m^2) / (m^2 u^4), u = cos of the half vector",
        sources: &[(cite::DEON_LUEBKE_2007, "section 14.3, KSTextureCompute")],
        params: &[
            number("ndoth", "cosine of the half vector", [0.0, 1.0], 0.9),
            number("m", "roughness, Beckmann's alpha", [0.0, 1.0], 0.3),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "Before quantisation. Above 1, and clipped by the texture, for m < 1/32 at the peak.",
        also: &[alias("gpugems3_beckmann_texel")],
        known: &[known(
            &[("ndoth", "1"), ("m", "0.0625")],
            NO_ANGLES,
            0.870_550_563_296_124_1,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| Ok(kelemen::encode(p.number("ndoth")?, p.number("m")?)),
    },
];
