//! A texel of written maps as parameters of a model: `FILE:X,Y` or `FILE:X,Y,LEVEL`, columns from the left and rows from the top.
//!
//! FILE is a file of a map, or the beginning of the names of all of them (`maps/bark` for `maps/bark.roughness.ktx2` and what lies
//! beside it). A roughness is the width alpha = r² of a lobe, with strength and direction of an anisotropy two widths along axes of
//! their own (`KHR_materials_anisotropy`), with a wide lobe beside it a sum of two; lobes of Lafortune are those of the model
//! `lafortune`. Directions are seen from the mesh: a normal turns the lobe.

use super::texel_file::{self, Found};
use crate::cancel::Cancel;
use crate::encode::ReadError;
use crate::functions::{EvalError, Subject};
use crate::maps::Lobe;
use crate::maps::sbrdf::{CosineLobe, exponent};
use crate::maps::turned::{Incident, Turned};
use crate::math::figures::short;
use crate::models::lobes::{Part, Sum};
use crate::models::{self, Brdf, ModelInfo, ParamError, Params, implied_values, lafortune, lambert};
use glam::DVec3;
use serde_json::{Map, Value as Json, json};
use std::path::{Path, PathBuf};

/// A place in a map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TexelPlace {
    /// A file, or the beginning of the names of the files of a map.
    pub path: PathBuf,
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// Level, 0 the largest.
    pub level: usize,
}

/// Why a texel gives no parameters.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TexelError {
    /// Not `FILE:X,Y,LEVEL`.
    #[error("`{0}` is no texel; it is FILE:X,Y or FILE:X,Y,LEVEL, such as maps/bark.roughness.ktx2:3,4,1")]
    Form(String),
    /// Nothing is there.
    #[error("{0}: no such file, and no files of a map whose names begin with it ({0}.roughness.ktx2)")]
    Missing(String),
    /// The file cannot be read.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// Why.
        source: ReadError,
    },
    /// Beyond the map.
    #[error("{file}: level {level} has {width} x {height} texels, and ({x}, {y}) is none of them")]
    Outside {
        /// The file.
        file: String,
        /// Level.
        level: usize,
        /// Its width.
        width: usize,
        /// Its height.
        height: usize,
        /// The column.
        x: usize,
        /// The row.
        y: usize,
    },
    /// It does not say what it holds.
    #[error("{0} does not say what its channels are; KTX2, EXR and PNG that `brdfbake map` wrote do")]
    Untold(String),
    /// Nothing in it is a parameter.
    #[error("{file}: {got} are no parameters; roughness, anisotropy, normals and lobes are")]
    NoParameter {
        /// The file.
        file: String,
        /// Its channels.
        got: String,
    },
    /// Two files tell the same.
    #[error("two files tell `{0}`; leave one out")]
    Twice(String),
    /// A part without the part that it belongs to.
    #[error("{has} of a texel without {lacks}; name the map, as in maps/bark:3,4, to read all of its files")]
    Part {
        /// What is there.
        has: String,
        /// What is not.
        lacks: String,
    },
    /// A model has no place for it.
    #[error("{model} has no {what}: the texel tells {channels}; {hint}")]
    NotOf {
        /// Model or function.
        model: String,
        /// What it would need.
        what: &'static str,
        /// What the texel tells.
        channels: String,
        /// What takes it.
        hint: &'static str,
    },
    /// A parameter that is given beside the texel.
    #[error("`{0}` is told by the texel and given, too; leave one out")]
    Given(String),
    /// A value that the model does not take.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// Nothing has this name.
    #[error(transparent)]
    Name(#[from] EvalError),
}

impl TexelPlace {
    /// Reads `FILE:X,Y` or `FILE:X,Y,LEVEL`.
    ///
    /// # Errors
    /// [`TexelError::Form`].
    pub fn parse(text: &str) -> Result<TexelPlace, TexelError> {
        let form = || TexelError::Form(text.to_owned());
        let (path, place) = text.rsplit_once(':').filter(|(path, _)| !path.is_empty()).ok_or_else(form)?;
        let numbers: Result<Vec<usize>, _> = place.split(',').map(|n| n.trim().parse()).collect();
        let [x, y, level] = match numbers.map_err(|_| form())?[..] {
            [x, y] => [x, y, 0],
            [x, y, level] => [x, y, level],
            _ => return Err(form()),
        };
        Ok(TexelPlace { path: Path::new(path).to_owned(), x, y, level })
    }
}

/// What a texel tells.
#[derive(Debug, Clone, PartialEq)]
pub struct MapTexel {
    /// Tangent, bitangent and normal that the lobes stand about.
    axes: [DVec3; 3],
    lobes: Lobes,
    /// Channels, in words.
    told: String,
    /// Colours of its albedos are not the same.
    coloured: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum Lobes {
    /// A normal alone.
    None,
    /// Widths along both axes, and of a second lobe with its share.
    Widths { alpha: [f64; 2], round: bool, wide: Option<[f64; 2]> },
    /// Diffuse albedo, and lobes with their factors; over their own integral or as they are.
    Lafortune { diffuse: f64, lobes: Vec<(CosineLobe, f64)>, incident: bool },
}

/// Parameters by their names.
type Keys = Map<String, Json>;

/// Most lobes whose channels are looked for.
const MOST: usize = crate::maps::sbrdf::MOST_LOBES;

impl MapTexel {
    /// Reads the texels of maps that lie over each other; of albedos the channel `colour` (0 red, 1 green, 2 blue).
    ///
    /// # Errors
    /// [`TexelError`].
    pub fn read(places: &[TexelPlace], colour: usize, cancel: &Cancel) -> Result<MapTexel, TexelError> {
        let mut found = Found::default();
        for place in places {
            texel_file::add(&mut found, place, cancel)?;
        }
        let part = |has: &str, lacks: &str| TexelError::Part { has: has.to_owned(), lacks: lacks.to_owned() };
        let of = |id: &str| found.of(id);
        let normal = match (of("normal.x"), of("normal.y")) {
            (Some(x), Some(y)) => {
                let y = if found.green_down { -y } else { y };
                let z = of("normal.z").unwrap_or_else(|| (1.0 - x * x - y * y).max(0.0).sqrt());
                DVec3::new(x, y, z).try_normalize().unwrap_or(DVec3::Z)
            }
            _ => DVec3::Z,
        };
        let direction = |x: &str, y: &str| Some(libm::atan2(of(y)?, of(x)?));
        let mut angle = 0.0;
        let lobes = if of("exponent1").is_some() || of("albedo1.r").is_some() || of("diffuse.r").is_some() {
            angle = direction("tangent.x", "tangent.y").unwrap_or(0.0);
            lafortune(&found, colour)?
        } else if let Some(r) = of("roughness") {
            let least = r * r;
            let wide = of("wide.roughness").zip(of("wide.weight")).map(|(r, w)| [r * r, w]);
            let strength = of("strength");
            if let Some(turned) = direction("direction.x", "direction.y") {
                angle = turned;
            }
            let s = strength.unwrap_or(0.0);
            Lobes::Widths { alpha: [least + (1.0 - least) * s * s, least], round: strength.is_none(), wide }
        } else if of("strength").is_some() {
            return Err(part("a strength of anisotropy", "its roughness"));
        } else if of("wide.roughness").is_some() {
            return Err(part("a wide lobe", "the roughness of the other one"));
        } else if of("normal.x").is_some() {
            Lobes::None
        } else {
            return Err(found.no_parameter());
        };
        let axes = Lobe { normal, alpha_max: 1.0, alpha_min: 1.0, angle }.axes();
        let axes =
            if normal == DVec3::Z && angle.abs() <= 0.0 { [DVec3::X, DVec3::Y, DVec3::Z] } else { axes };
        Ok(MapTexel { axes, lobes, told: found.ids(), coloured: found.coloured() })
    }

    /// What it tells, in words.
    #[must_use]
    pub fn words(&self) -> String {
        let three = |v: [f64; 3]| format!("({})", v.map(short).join(", "));
        let mut words = match &self.lobes {
            Lobes::None => Vec::new(),
            Lobes::Widths { alpha, round: true, wide: None } => vec![format!("alpha = {}", short(alpha[1]))],
            Lobes::Widths { alpha, round: true, wide: Some([wide, share]) } => {
                let (narrow, wide, share) = (short(alpha[1]), short(*wide), short(*share));
                vec![format!("alpha = {narrow}, and {wide} with the share {share}")]
            }
            Lobes::Widths { alpha: [x, y], .. } => vec![format!("alpha = {} x {}", short(*x), short(*y))],
            Lobes::Lafortune { diffuse, lobes, incident } => {
                let what = if *incident { "albedo" } else { "factor" };
                let lobe = |(l, w): &(CosineLobe, f64)| {
                    format!("C {}, n {}, {what} {}", three(l.c), short(l.n), short(*w))
                };
                let own = lobes.iter().filter(|l| l.1 > 0.0).map(lobe);
                std::iter::once(format!("diffuse {}", short(*diffuse))).chain(own).collect()
            }
        };
        let [t, _, n] = self.axes;
        if n != DVec3::Z {
            words.push(format!("normal {}", three(n.to_array())));
        } else if t != DVec3::X {
            words.push(format!("turned by {} deg", short(libm::atan2(t.y, t.x).to_degrees())));
        }
        words.join("; ")
    }

    /// Are its albedos not those of grey?
    #[must_use]
    pub fn coloured(&self) -> bool {
        self.coloured
    }

    /// The parameters of each lobe, with its share, for what has these parameters.
    fn parameters(
        &self,
        id: &str,
        has: &dyn Fn(&str) -> bool,
        given: &Keys,
    ) -> Result<Vec<(f64, Keys)>, TexelError> {
        let not_of =
            |what, hint| TexelError::NotOf { model: id.to_owned(), what, channels: self.told.clone(), hint };
        let round = |alpha: f64| -> Result<Vec<(&str, f64)>, TexelError> {
            match () {
                () if has("alpha") => Ok(vec![("alpha", alpha)]),
                // glTF's is the root of the width; other roughnesses are of other lobes
                () if id == models::gltf::INFO.id => Ok(vec![("roughness", alpha.sqrt())]),
                () => Err(not_of("alpha", "models of microfacets have one, such as ggx")),
            }
        };
        let sets: Vec<(f64, Vec<(&str, f64)>)> = match &self.lobes {
            Lobes::None => vec![(1.0, Vec::new())],
            Lobes::Widths { alpha, round: true, wide: None } => vec![(1.0, round(alpha[1])?)],
            Lobes::Widths { alpha, round: true, wide: Some([wide, share]) } => {
                vec![(1.0 - share, round(alpha[1])?), (*share, round(*wide)?)]
            }
            Lobes::Widths { alpha: [x, y], .. } if has("alpha_x") && has("alpha_y") => {
                vec![(1.0, vec![("alpha_x", *x), ("alpha_y", *y)])]
            }
            Lobes::Widths { .. } => return Err(not_of("alpha_x and alpha_y", "ggx has both")),
            Lobes::Lafortune { .. } => return Err(not_of("lobes", "lafortune has them")),
        };
        // a width beside those of the texel would be idle
        let told = sets.iter().flat_map(|s| &s.1).map(|(key, _)| *key);
        let widths: &[&str] = if self.lobes == Lobes::None { &[] } else { &["alpha", "alpha_x", "alpha_y"] };
        if let Some(key) = told.chain(widths.iter().copied()).find(|key| given.contains_key(*key)) {
            return Err(TexelError::Given(key.to_owned()));
        }
        let whole = |(share, set): (f64, Vec<(&str, f64)>)| {
            let own = set.into_iter().map(|(key, value)| (key.to_owned(), json!(value)));
            (share, given.clone().into_iter().chain(own).collect())
        };
        Ok(sets.into_iter().map(whole).collect())
    }

    /// The model of this name with the parameters of the texel and those that are given, in its frame.
    ///
    /// # Errors
    /// [`TexelError`] where the model has no place for what the texel tells.
    pub fn model(
        &self,
        (info, implied): (&'static ModelInfo, models::Implied),
        given: &Keys,
    ) -> Result<Box<dyn Brdf>, TexelError> {
        if let (Lobes::Lafortune { diffuse, lobes, incident }, true) =
            (&self.lobes, info.id == lafortune::INFO.id)
        {
            if let Some(key) = given.keys().next() {
                return Err(TexelError::Given(key.clone()));
            }
            let row = |(lobe, rho): &(CosineLobe, f64)| json!([lobe.c[0], lobe.c[1], lobe.c[2], lobe.n, rho]);
            let rows: Vec<Json> = lobes.iter().map(row).collect();
            let model: Box<dyn Brdf> = if *incident {
                let white = [("rho".to_owned(), json!(1.0))].into_iter().collect();
                let own = &lambert::INFO;
                let lobe = (own.build)(&Params::resolve_over(own.id, own.params, &Map::new(), &white)?)?;
                let floor = Part { weight: *diffuse, chance: *diffuse, lobe };
                let parts = lobes.iter().map(|(lobe, albedo)| Part::new(*albedo, Incident::new(*lobe)));
                Box::new(Sum::new(std::iter::once(floor).chain(parts).collect()))
            } else {
                let params = [("rho_d".to_owned(), json!(diffuse)), ("lobes".to_owned(), json!(rows))];
                let params = params.into_iter().collect();
                (info.build)(&Params::resolve_over(info.id, info.params, &Map::new(), &params)?)?
            };
            return Ok(Turned::within(self.axes, model));
        }
        let has = |key: &str| info.param(key).is_some();
        let sets = self.parameters(info.id, &has, given)?;
        let build = |params: &Keys| -> Result<Box<dyn Brdf>, ParamError> {
            (info.build)(&Params::resolve_over(info.id, info.params, &implied_values(implied), params)?)
        };
        let model: Box<dyn Brdf> = match &sets[..] {
            [(_, one)] => build(one)?,
            several => {
                let part = |(share, params): &(f64, Keys)| {
                    Ok(Part { weight: *share, chance: *share, lobe: build(params)? })
                };
                Box::new(Sum::new(several.iter().map(part).collect::<Result<_, ParamError>>()?))
            }
        };
        Ok(Turned::within(self.axes, model))
    }

    /// What a row of `eval` asks for, with the parameters of the texel.
    ///
    /// # Errors
    /// As [`MapTexel::model`]; a function takes a width and no frame.
    pub fn subject(&self, name: &str, given: &Map<String, Json>) -> Result<Subject, TexelError> {
        // what stands behind the name is a remark
        let name = name.split_whitespace().next().unwrap_or_default();
        if let Some((info, implied)) = models::find(name) {
            return Ok(Subject::Model(info, self.model((info, implied), given)?));
        }
        let not_of = |what| TexelError::NotOf {
            model: name.to_owned(),
            what,
            channels: self.told.clone(),
            hint: "functions take one width about the normal; models take more",
        };
        let Some((info, implied)) = crate::functions::find(name) else {
            return Ok(Subject::new(name, given)?);
        };
        let has = |key: &str| info.params.iter().any(|p| p.is_called(key));
        let mut sets = self.parameters(info.id, &has, given)?;
        if sets.len() > 1 || self.axes != [DVec3::X, DVec3::Y, DVec3::Z] {
            return Err(not_of("frame of its own and no second lobe"));
        }
        let params =
            Params::resolve_over(info.id, info.params, &implied_values(implied), &sets.swap_remove(0).1)?;
        Ok(Subject::Function(info, params))
    }
}

/// The lobes of a texel, of one colour.
fn lafortune(found: &Found, colour: usize) -> Result<Lobes, TexelError> {
    let letter = ["r", "g", "b"][colour.min(2)];
    let part = |has: String, lacks: &str| TexelError::Part { has, lacks: lacks.to_owned() };
    let diffuse = found.of(&format!("diffuse.{letter}"));
    let mut lobes = Vec::new();
    for j in 1..=MOST.max(found.lobes) {
        let of = |id: &str| found.of(&format!("{id}{j}"));
        let albedo = found.of(&format!("albedo{j}.{letter}"));
        let shape = (of("c.x"), of("c.y"), of("c.z"), of("exponent"));
        match (albedo, shape) {
            (Some(albedo), (Some(x), Some(y), Some(z), Some(code))) => {
                let constant = of("constant").unwrap_or(1.0);
                lobes.push((CosineLobe { c: [x, y, z], n: exponent(code) }, albedo * constant));
            }
            (None, (None, ..)) if j > found.lobes => {}
            (Some(_), _) => return Err(part(format!("the albedo of lobe {j}"), "its shape")),
            (None, _) => return Err(part(format!("{} lobes", found.lobes), "the albedo of each")),
        }
    }
    match diffuse {
        Some(diffuse) if !lobes.is_empty() => {
            Ok(Lobes::Lafortune { diffuse, lobes, incident: found.incident })
        }
        Some(_) => Err(part("a diffuse albedo".to_owned(), "lobes")),
        None => Err(part("lobes".to_owned(), "the diffuse albedo")),
    }
}
