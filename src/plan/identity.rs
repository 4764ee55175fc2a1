//! The identity of a table: one hash over everything that the bytes of its files depend on.
//!
//! Caching, `--check`, shards and provenance stand on it: files whose table has this identity are the files that a bake would
//! write. It is blake3 of a list of parts, each with its length, in this order:
//!
//! * [`NUMERICS`], the version of the numbers, and the version of the program, which files name;
//! * the request with every default filled in, in canonical form, but for the name of its file. Its own name, and that of the plan,
//!   are in it only where one of its containers holds metadata, which names both;
//! * the contents of its inputs, by what they are to the table.
//!
//! Paths, hosts, clocks and threads are in no file, so they are not in it. Names of inputs are in those of maps only.

use super::map::PlannedMap;
use super::table::PlannedTable;
use serde_json::Value as Json;

/// Version of the numbers: raised by any change after which the same request gives other texels, errors or bytes of files. What was
/// kept of older versions is then baked anew.
pub const NUMERICS: u32 = 4;

/// A file that the numbers of a table depend on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// What it is to the table: `roughness`, `measured`.
    pub role: String,
    /// blake3 of its bytes, in hex.
    pub content: String,
}

impl Input {
    /// An input with these bytes.
    #[must_use]
    pub fn new(role: impl Into<String>, bytes: &[u8]) -> Input {
        Input { role: role.into(), content: blake3::hash(bytes).to_hex().to_string() }
    }
}

/// Collects the parts of an identity. Each is preceded by its length, so that no two lists of parts run together.
#[derive(Debug, Clone)]
pub struct Hasher(blake3::Hasher);

impl Hasher {
    /// A hash that begins with the versions. `what` tells units of different sorts apart: `table`.
    #[must_use]
    pub fn new(what: &str) -> Hasher {
        Hasher(blake3::Hasher::new())
            .part(what.as_bytes())
            .part(&NUMERICS.to_le_bytes())
            .part(env!("CARGO_PKG_VERSION").as_bytes())
    }

    /// With a further part.
    #[must_use]
    pub fn part(mut self, bytes: &[u8]) -> Hasher {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
        self
    }

    /// With the inputs, whose order means something.
    #[must_use]
    pub fn inputs(self, inputs: &[Input]) -> Hasher {
        inputs.iter().fold(self, |h, i| h.part(i.role.as_bytes()).part(i.content.as_bytes()))
    }

    /// The hash in hex.
    #[must_use]
    pub fn finish(self) -> String {
        self.0.finalize().to_hex().to_string()
    }
}

/// The identity of a table of the plan of this name.
pub(super) fn of_table(plan: &str, table: &PlannedTable) -> String {
    let mut request = table.keys();
    request.remove("file");
    let named = table.outputs.iter().any(|o| o.encoder.holds_metadata());
    if !named {
        request.remove("name");
    }
    Hasher::new("table")
        .part(if named { plan.as_bytes() } else { &[] })
        .part(Json::Object(request).to_string().as_bytes())
        .inputs(&table.inputs)
        .finish()
}

/// The hash of a plan.
pub(super) fn of_plan(name: &str, tables: &[PlannedTable], maps: &[PlannedMap]) -> String {
    let hasher = Hasher::new("plan").part(name.as_bytes());
    let units = tables.iter().map(|t| &t.identity).chain(maps.iter().map(|m| &m.identity));
    units.fold(hasher, |h, identity| h.part(identity.as_bytes())).finish()
}
