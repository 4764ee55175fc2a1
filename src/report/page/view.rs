//! What a page is made of: tables with what is known of their errors.

use crate::grid::provenance::{Encoding, Reconstruction, TexelRecord};
use crate::grid::table::named;
use crate::grid::{Grid, Provenance, Table};
use crate::verify::converge::{Chart, Times};
use serde_json::Value as Json;

/// A page before its tables.
#[derive(Debug, Clone, Default)]
pub struct Head {
    /// Name of the recipe.
    pub recipe: String,
    /// Hash over its tables.
    pub hash: String,
    /// Program and version that baked.
    pub tool: String,
    /// Why the tables were asked for, as the manifest has it.
    pub scenes: Option<Json>,
    /// Files of earlier bakes.
    pub stale: Vec<String>,
    /// What the page is compared with, and tables that only that has.
    pub against: Option<(String, Vec<String>)>,
}

/// One table.
#[derive(Debug)]
pub struct View {
    /// What its files say.
    pub provenance: Provenance,
    /// The files.
    pub files: Vec<FileView>,
    /// Its texels, if a file of it could be read; else why not.
    pub texels: Result<Texels, String>,
    /// Seconds of integration and of checks, if they are to be shown.
    pub seconds: Option<[f64; 2]>,
    /// The table of the same name that it is compared with.
    pub against: Option<Against>,
    /// Error against evaluations; else why it is not drawn.
    pub convergence: Result<Convergence, String>,
}

/// A parameter map.
#[derive(Debug)]
pub struct MapView {
    /// How the names of its files begin.
    pub name: String,
    /// What its files say of themselves.
    pub record: Json,
    /// The files.
    pub files: Vec<MapFileView>,
    /// The levels that are shown, as they are read; else why there are none.
    pub levels: Result<Vec<MapLevel>, String>,
    /// What could not be shown, and why.
    pub left_out: Vec<String>,
}

/// A file of a map.
#[derive(Debug, Clone)]
pub struct MapFileView {
    /// Its name.
    pub file: String,
    /// Container.
    pub container: String,
    /// Storage.
    pub storage: String,
    /// Size.
    pub bytes: u64,
}

/// A level of a map.
#[derive(Debug, Clone)]
pub struct MapLevel {
    /// Its number, 0 the largest.
    pub level: usize,
    /// Width and height in texels.
    pub size: [usize; 2],
    /// Channels of all maps.
    pub planes: Vec<MapPlane>,
}

/// A channel of a map.
#[derive(Debug, Clone)]
pub struct MapPlane {
    /// Which map: `roughness`.
    pub map: String,
    /// Id of the channel.
    pub channel: String,
    /// Is it an error?
    pub is_error: bool,
    /// Rows from the top.
    pub values: Vec<f64>,
}

/// Error against evaluations, and against time where that is to be shown.
#[derive(Debug)]
pub struct Convergence {
    /// Of every method.
    pub chart: Chart,
    /// Seconds, of this run.
    pub times: Option<Vec<Times>>,
}

/// A file of a table.
#[derive(Debug, Clone)]
pub struct FileView {
    /// Its name.
    pub file: String,
    /// Container.
    pub container: String,
    /// Size.
    pub bytes: u64,
    /// Storage and what rounding costs.
    pub encoding: Encoding,
    /// Errors of a reader between texels.
    pub reconstruction: Option<Reconstruction>,
    /// What the texels hold, where they are fitted.
    pub texels: Option<TexelRecord>,
}

/// Numbers of a table: `[texel][channel]`.
#[derive(Debug, Clone)]
pub struct Texels {
    /// Where they are.
    pub grid: Grid,
    /// The file whose numbers they are.
    pub file: String,
    /// As stored.
    pub stored: Vec<f64>,
    /// Fresh integrals; NaN where there is none.
    pub integrals: Vec<f64>,
    /// Estimated errors of the integrals; NaN where there is none.
    pub estimates: Vec<f64>,
    /// Integrand evaluations of each texel, where they are known.
    pub evaluations: Vec<u32>,
    /// Where the integrals are from.
    pub origin: Origin,
}

/// Where the integrals of a page are from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// The bake itself.
    Bake,
    /// They were integrated anew, at so many texels.
    Again {
        /// How many.
        texels: usize,
    },
    /// There are none.
    None {
        /// Why.
        why: String,
    },
}

/// What a table is compared with.
#[derive(Debug)]
pub struct Against {
    /// What its files say.
    pub provenance: Provenance,
    /// Its numbers, if a file of it could be read.
    pub table: Result<Table, String>,
}

impl Texels {
    /// Number of channels.
    pub(super) fn channels(&self) -> usize {
        self.stored.len() / self.grid.len().max(1)
    }

    /// How far the stored number is from the integral, and what that may be off by: what is known of a texel's error.
    pub(super) fn error(&self, at: usize) -> f64 {
        (self.stored[at] - self.integrals[at]).abs() + self.estimates[at]
    }

    /// Place of the largest known error.
    pub(super) fn worst(&self) -> Option<usize> {
        let known = (0..self.stored.len()).filter(|i| self.error(*i).is_finite());
        known.max_by(|a, b| self.error(*a).total_cmp(&self.error(*b)).then(b.cmp(a)))
    }

    /// Places of the largest known errors, the largest first.
    pub(super) fn ranked(&self, most: usize) -> Vec<usize> {
        let larger = |a: &usize, b: &usize| self.error(*b).total_cmp(&self.error(*a)).then(a.cmp(b));
        let mut all: Vec<usize> = (0..self.stored.len()).filter(|i| self.error(*i).is_finite()).collect();
        if all.len() > most {
            all.select_nth_unstable_by(most, larger);
            all.truncate(most);
        }
        all.sort_by(larger);
        all
    }

    /// Axis ids and values of a texel.
    pub(super) fn at(&self, texel: usize) -> Vec<(String, f64)> {
        named(&self.grid, &self.grid.texel(texel))
    }
}
