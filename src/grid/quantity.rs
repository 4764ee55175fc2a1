//! What an axis can measure. A derived quantity (`roughness`) is read into its base quantity (`alpha`) by a named map.

use super::expression::{Expression, PlainText};
use super::scalar::Scalar;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::f64::consts::{FRAC_PI_2, PI};

/// A quantity that an axis can sweep: id, symbol, unit, and its relation to the base quantity that formulas use.
#[derive(Debug)]
pub struct Quantity {
    /// Id, as in recipes and metadata: `mu`, `roughness`.
    pub id: &'static str,
    /// Symbol in formulas.
    pub symbol: &'static str,
    /// Unit; `1` for pure numbers.
    pub unit: &'static str,
    /// One line of meaning.
    pub meaning: &'static str,
    /// Largest domain on which the quantity makes sense.
    pub domain: [f64; 2],
    /// For a derived quantity: base id, formula, map to the base, and map from the base.
    pub base: Option<Base>,
}

/// How a derived quantity becomes its base quantity.
#[derive(Debug)]
pub struct Base {
    /// Id of the base quantity.
    pub id: &'static str,
    /// The map.
    pub map: BaseMap,
}

/// A map from a derived quantity to its base, with its inverse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BaseMap {
    /// `x^2`.
    Square,
    /// `cos(x)`.
    Cosine,
    /// `(1 + x^2) / (1 - x^2)`: the index of refraction whose reflectance at normal incidence is `x^4`.
    Root4OfF0,
    /// `(1 - x^2) / (1 + x^2)`: the same from the denser side.
    Root4OfF0Inverse,
    /// `5 (1 - x) / x`.
    SchlickZ,
}

impl BaseMap {
    /// From the quantity to its base.
    #[must_use]
    pub fn to<S: Scalar>(self, x: S) -> S {
        let one = || S::number(1.0);
        let square = || x.clone().power(2.0);
        match self {
            BaseMap::Square => square(),
            BaseMap::Cosine => x.cosine().at_least(0.0),
            BaseMap::Root4OfF0 => one().plus(square()).over(one().minus(square())),
            BaseMap::Root4OfF0Inverse => one().minus(square()).over(one().plus(square())),
            BaseMap::SchlickZ => S::number(5.0).times(one().minus(x.clone())).over(x),
        }
    }

    /// From the base to the quantity: the inverse of [`BaseMap::to`].
    #[must_use]
    pub fn from(self, base: f64) -> f64 {
        match self {
            BaseMap::Square => base.sqrt(),
            BaseMap::Cosine => libm::acos(base),
            BaseMap::Root4OfF0 => ((base - 1.0) / (base + 1.0)).max(0.0).sqrt(),
            BaseMap::Root4OfF0Inverse => ((1.0 - base) / (1.0 + base)).max(0.0).sqrt(),
            BaseMap::SchlickZ => 5.0 / (5.0 + base),
        }
    }
}

const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Every quantity, base quantities before those derived from them.
pub static QUANTITIES: &[Quantity] = &[
    base("mu", "mu_o", "1", "cosine of the view angle to the normal", [0.0, 1.0]),
    base("mu_m", "mu_m", "1", "cosine of the microfacet normal (N.H)", [0.0, 1.0]),
    base("mu_i", "mu_i", "1", "cosine of the incident angle", [0.0, 1.0]),
    base(
        "phi",
        "phi_o",
        "rad",
        "azimuth of the view direction from the tangent",
        [0.0, std::f64::consts::TAU],
    ),
    base("alpha", "alpha", "1", "width of the microfacet distribution", [0.0, 2.0]),
    base("alpha_x", "alpha_x", "1", "width along the tangent", [0.0, 2.0]),
    base("alpha_y", "alpha_y", "1", "width along the bitangent", [0.0, 2.0]),
    base(
        "anisotropy",
        "s",
        "1",
        "strength of anisotropy, as glTF has it: alpha_x = mix(alpha, 1, s^2), alpha_y = alpha",
        [0.0, 1.0],
    ),
    base(
        "rotation",
        "psi",
        "rad",
        "rotation of anisotropy, as glTF has it: from the tangent of the mesh to that of the grooves; the azimuth is phi - rotation",
        [0.0, std::f64::consts::TAU],
    ),
    base("gamma", "gamma", "1", "exponent of the tail of a distribution of normals; 2 is GGX", [0.0, 1e8]),
    base("m", "m", "1", "Beckmann width as Cook-Torrance and Kelemen name it; equals alpha", [0.0, 2.0]),
    base("eta", "eta", "1", "relative index of refraction, below over above", [1e-3, 1e3]),
    base("k", "k", "1", "extinction coefficient of a conductor", [0.0, 1e3]),
    base("f0", "F0", "1", "reflectance at normal incidence", [0.0, 1.0]),
    base("n", "n", "1", "exponent of a cosine lobe; of a conductor, the real part of the index", [0.0, 1e7]),
    base("nu", "nu", "1", "exponent of a cosine lobe along the tangent", [0.0, 1e7]),
    base("nv", "nv", "1", "exponent of a cosine lobe along the bitangent", [0.0, 1e7]),
    base("sigma", "sigma", "rad", "standard deviation of the slope angle of facets", [0.0, 1.57]),
    base("r", "r", "1", "roughness of a diffuse lobe, as its model takes it", [0.0, 1.0]),
    base("exponent", "e", "1", "exponent of a generalised Schlick factor", [0.0, 5e4]),
    base("gloss", "gloss", "1", "gloss of Disney's clear coat", [0.0, 1.0]),
    base("rho", "rho", "1", "diffuse reflectance", [0.0, 1.0]),
    base("ndotl", "n.l", "1", "cosine of the light to the normal, below the horizon too", [-1.0, 1.0]),
    base("curvature", "1/r", "1/mm", "curvature of the surface, one over its radius", [0.0, 1e3]),
    base("radius", "r", "mm", "distance along the surface from the point of entry", [0.0, 1e4]),
    base("offset", "x", "mm", "distance along one direction from the point of entry", [0.0, 1e4]),
    base("thickness", "d", "mm", "thickness of what light passes through", [0.0, 1e4]),
    base("opd", "D", "nm", "optical path difference between both faces of a film", [0.0, 1e6]),
    base("film", "d", "nm", "thickness of a thin film", [0.0, 1e5]),
    base("n2", "n_2", "1", "index of a thin film", [1.0, 10.0]),
    base("n3", "n_3", "1", "index below a thin film, real part", [0.0, 1e5]),
    base(
        "path",
        "d",
        "length",
        "length of the path in a medium, in the unit of its coefficients",
        [0.0, 1e9],
    ),
    base("tau", "tau", "1", "optical thickness: extinction times a length", [0.0, 1e6]),
    base("xi", "xi", "rad", "upper end of the integral of airlight", [0.0, FRAC_PI_2]),
    base("temperature", "T", "K", "temperature of what glows", [500.0, 1e6]),
    base("gaussian", "i", "1", "number of a Gaussian of a sum, the narrowest first", [0.0, 63.0]),
    base("u", "u", "1", "uniform random number", [0.0, 1.0]),
    base("v", "v", "1", "second uniform random number", [0.0, 1.0]),
    base("g", "g", "1", "mean cosine of a phase function", [-1.0, 1.0]),
    base("draine_alpha", "alpha", "1", "weight of cos^2 in Draine's phase function", [0.0, 100.0]),
    base("diameter", "d", "um", "diameter of the droplets of fog and cloud", [5.0, 50.0]),
    base("deflection", "theta", "rad", "angle between the directions of travel; 0 is forward", [0.0, PI]),
    base("theta_h", "theta_h", "rad", "angle of the half vector to the normal", [0.0, FRAC_PI_2]),
    base("theta_d", "theta_d", "rad", "angle of the half vector to both directions", [0.0, FRAC_PI_2]),
    base("phi_d", "phi_d", "rad", "azimuth of the directions round the half vector", [0.0, PI]),
    derived("roughness", "r", "artist's roughness", [0.0, 1.0], Base { id: "alpha", map: BaseMap::Square }),
    derived(
        "sheen_roughness",
        "r",
        "roughness of a sheen, as glTF has it",
        [0.0, 1.0],
        Base { id: "alpha", map: BaseMap::Square },
    ),
    derived(
        "theta",
        "theta_o",
        "view angle to the normal",
        [0.0, FRAC_PI_2],
        Base { id: "mu", map: BaseMap::Cosine },
    ),
    derived(
        "f0_root4",
        "z",
        "fourth root of the dielectric F0",
        [0.0, 0.99],
        Base { id: "eta", map: BaseMap::Root4OfF0 },
    ),
    derived(
        "f0_root4_inverse",
        "z",
        "fourth root of the dielectric F0, seen from the denser side",
        [0.0, 0.99],
        Base { id: "eta", map: BaseMap::Root4OfF0Inverse },
    ),
    derived(
        "schlick_z",
        "z",
        "Schlick exponent on (0, 1]: 1 is a constant factor, 1/2 the usual 5",
        [1e-4, 1.0],
        Base { id: "exponent", map: BaseMap::SchlickZ },
    ),
];

/// Quantities that some models take as they are, although elsewhere they have a base: `roughness` of a model that has a parameter
/// of that name is that parameter.
static OWN: &[Quantity] = &[
    base("roughness", "r", "1", "roughness, as its model takes it", [0.0, 1.0]),
    base("sheen_roughness", "r", "1", "roughness of the sheen, as its model takes it", [0.0, 1.0]),
];

/// A unit in words, angles spelled out; none for pure numbers.
#[must_use]
pub fn unit_words(unit: &'static str) -> Option<&'static str> {
    match unit {
        "1" => None,
        "rad" => Some("radians"),
        "deg" => Some("degrees"),
        other => Some(other),
    }
}

const fn base(
    id: &'static str,
    symbol: &'static str,
    unit: &'static str,
    meaning: &'static str,
    domain: [f64; 2],
) -> Quantity {
    Quantity { id, symbol, unit, meaning, domain, base: None }
}

const fn derived(
    id: &'static str,
    symbol: &'static str,
    meaning: &'static str,
    domain: [f64; 2],
    base: Base,
) -> Quantity {
    let unit = if matches!(base.map, BaseMap::Cosine) { "rad" } else { "1" };
    Quantity { id, symbol, unit, meaning, domain, base: Some(base) }
}

impl Quantity {
    /// Its unit in words; none for pure numbers.
    #[must_use]
    pub fn unit_words(&self) -> Option<&'static str> {
        unit_words(self.unit)
    }

    /// Looks a quantity up by its id.
    #[must_use]
    pub fn find(id: &str) -> Option<&'static Quantity> {
        QUANTITIES.iter().find(|q| q.id == id)
    }

    /// The quantity of this id without a base, for a model that takes it as it is. Read back from a file it is the one with a
    /// base again: the map is then in the file's words.
    #[must_use]
    pub fn own(id: &str) -> Option<&'static Quantity> {
        OWN.iter().find(|q| q.id == id)
    }

    /// The interval of this quantity whose base values are those from `lo` to `hi`.
    #[must_use]
    pub fn interval_from_base(&self, [lo, hi]: [f64; 2]) -> [f64; 2] {
        let [a, b] = [self.from_base(lo), self.from_base(hi)];
        [a.min(b), a.max(b)]
    }

    /// The id that formulas use: the base's, or its own.
    #[must_use]
    pub fn base_id(&self) -> &'static str {
        self.base.as_ref().map_or(self.id, |b| b.id)
    }

    /// The map to the base as an equation in the ids of both; none for a quantity that is its own base.
    #[must_use]
    pub fn base_formula(&self) -> Option<String> {
        let base = self.base.as_ref()?;
        Some(format!("{} = {}", base.id, base.map.to(Expression::name(self.id)).write(&PlainText, true)))
    }

    /// Value of the base quantity.
    #[must_use]
    pub fn to_base<S: Scalar>(&self, value: S) -> S {
        match &self.base {
            Some(base) => base.map.to(value),
            None => value,
        }
    }

    /// Value of this quantity for a value of its base.
    #[must_use]
    pub fn from_base(&self, value: f64) -> f64 {
        self.base.as_ref().map_or(value, |b| b.map.from(value))
    }

    /// True where the quantity has no natural bounds of its own.
    #[must_use]
    pub fn is_unbounded(&self) -> bool {
        self.domain == UNBOUNDED
    }
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id && self.base_id() == other.base_id()
    }
}

/// Serde by id, for fields of type `&'static Quantity`.
pub(crate) mod by_id {
    use super::{Deserialize, Deserializer, Quantity, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(q: &&'static Quantity, s: S) -> Result<S::Ok, S::Error> {
        q.id.serialize(s)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<&'static Quantity, D::Error> {
        let id = String::deserialize(d)?;
        Quantity::find(&id).ok_or_else(|| serde::de::Error::custom(format!("unknown quantity `{id}`")))
    }
}
