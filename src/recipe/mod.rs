//! Recipes: TOML files that say which tables to bake, and which maps to make. A recipe is read into requests, which the room [`plan`](crate::plan) judges and
//! resolves into a [`Plan`]; here its faults get the line and column that their places stand at.
//!
//! # The file
//! ```toml
//! name = "example"                 # required; a-z, 0-9 and `-`
//! tolerance = 1e-4                 # optional; for tables that do not give their own
//! # engine = "bevy"                # the tables that an engine loads (`list engines`); `table` may then be left out
//!
//! [[table]]                        # 1 to 256 of them
//! kind = "dfg"                     # required; an id of `list tables`
//! name = "ggx-dfg"                 # required; stem of the file names, so unique and portable
//! # file = "dfg.ktx2"              # name of its one file, in place of `name` and an extension
//! layout = "scale-bias"            # default: the first layout of the kind
//! # channels = ["dfg.f82"]         # instead of a layout: any channels of the kind (`describe`), in file order
//! model = "ggx"                    # default: the kind's; an id or other name of `list models`
//! params = { masking = "correlated" }   # numbers and words of model and kind; default: theirs
//! tolerance = 1e-5                 # absolute, per channel; default: see below
//! outputs = ["exr:half"]           # container:storage, and options: "ktx2:half+rgba+zstd"; default: ["exr:half"]
//! on-miss = "fail"                 # or "report": a texel that misses the tolerance is counted, not an error
//! reconstruction = "on"            # or "off": measure the reader's error between texels
//! # size = "auto"                  # instead of lengths: find them, see below
//! texels = "exact"                 # or "least-squares", "minimax", "auto": fitted to the reader, see below
//!
//! [[table.axis]]                   # first is x (fastest), second y, third z; none at all: the kind's defaults
//! id = "mu"                        # required; a quantity: mu, roughness, alpha, eta, ...
//! length = 64                      # required; texels
//! domain = [0.0, 1.0]              # default: the whole domain of the quantity
//! warp = "sqrt"                    # default: "linear"; see below
//! texel = "endpoint"               # default; or "center"
//! direction = "ascending"          # default; or "descending": texel 0 holds the high end
//! offset = 0.0                     # default; shift in texels, for readers with an off-by-one
//! clamp = [1e-4, 1.0]              # default: the domain; values are clamped to it before use
//!
//! [[table.axis]]
//! id = "roughness"
//! length = 64
//! ```
//! * **Maps**: `[[map]]` is a normal and a roughness map with filtered levels, the request of the command `map`; page
//!   [`maps`](crate::guide::maps) says what it makes. Files are relative to the folder of the recipe.
//!
//! ```toml
//! [[map]]                          # at most 256 of them; `table` may then be left out
//! name = "bark"                    # required; how the names of its files begin
//! normal = "bark-normal.png"       # or { file, channels = ["R", "G", "B"], green = "up" | "down", z = "stored" | "derived",
//!                                  #   scale = 1.0, signed = "off", wrap = "repeat" | "mirror" | "clamp" or two of them,
//!                                  #   mend = "off", resample = "off" }; flat without one
//! roughness = 0.4                  # a number, a file, or { file, channel = "G", space = "linear" | "srgb",
//!                                  #   holds = "roughness" | "gloss", from = { lobe, range, log = "off", rule = "nearest" } }
//! packing = "image"                # other channels of that file too; or "single", or "gltf": R and B as glTF has them
//! factor = 1.0                     # of the roughness; what is written is for a factor of 1
//! rule = "fit"                     # an id of `list rules`
//! normals = "mean"                 # or "fit": lobes stand about fitted normals, which are written
//! shape = "isotropic"              # or "anisotropic"
//! effort = "fast"                  # or "exact"
//! objective = "normals"            # or "reflected"
//! outputs = ["ktx2"]               # containers, with storages or not: "ktx2:roughness=bc4+normal=bc5"
//! check = 32                       # texels of a level that are measured, beside the worst
//! compare = "off"                  # or "on": every published rule at the same texels
//! ```
//!
//! * **Warps**, on the domain normalised to v in [0, 1]: `"linear"`; `"sqrt"` = `{ power = 0.5 }`; `"square"` =
//!   `{ power = 2 }`; `{ power = p }`, w = v^p; `"sqrt-one-minus"` = `{ one-minus-power = 0.5 }`;
//!   `{ one-minus-power = p }`, w = 1 - (1 - v)^p; `{ coupled = "alpha", power = 2.0, scale = 1.0, exponent = 1.0 }`,
//!   w^power = v (1 + c) / (v + c) with c = scale a^exponent and a the base value of the named axis. See
//!   [`Warp`](crate::grid::Warp).
//! * **Default tolerance**: half a step near 1 of the finest storage among the outputs: 2^-12 for half, 2^-25 for
//!   float, 0.5/65535 for unorm16; `brdfbake describe CONTAINER` lists all.
//! * **Size from an error**: `size = "auto"` finds the smallest table that a bilinear reader of the stored numbers reads to
//!   within 2^-10 over the whole domain. `size = { error = 1e-3, domain = "practical", warps = "search", longest = 256 }` says it
//!   in full. Axes with a `length` keep it, the others are searched; `warps = "search"` tries other warps on those.
//! * **Fitted texels**: `texels = "least-squares"` or `"minimax"` stores not the value at each texel but the values that read,
//!   interpolated, with the least mean square or the least largest error; the file says so, with the errors of all three
//!   choices. It costs 16 to 64 integrals a texel (two axes), a texel is no sample any more, and the laws are those of the integrals:
//!   fitted channels stay in their ranges, but sums of them may pass a bound by as much as they read wrong. `"auto"` takes for
//!   each channel the fit that reads better than exact values in all of largest and mean error, over the whole and the
//!   practical domain, if one does, and exact values otherwise; it is what the tables of engines hold. With `size`, every trial
//!   is fitted. See [`grid::fit`](crate::grid::fit).
//! * **Laws** that a table is known to break are waived by `waive = [{ law = "energy", reason = "..." }]`; the file
//!   then says that it is not verified, with the reason. A law that the kind does not check cannot be waived.
//!
//! * **Files of other programs**: with `file`, a table with one output writes a file of that name. In the containers without
//!   header, `text` and `raw`, `before` and `after` stand round the numbers, and tables that name the same file follow each
//!   other in it: `file = "lut.h"`, `before = "const float lut[] = {\n"`, `after = "};\n"`.
//!   In `ktx2`, tables of one file are the layers of an array: they must have one size, storage and options.
//!
//! # Faults
//! All faults of a file are reported at once, in file order, with line, column, key, what was given, what is allowed
//! and a remedy. A file with syntax errors is checked for nothing else: what they leave of it cannot be trusted.
//!
//! # Canonical form
//! [`PlannedTable::canonical`](crate::plan::PlannedTable::canonical) is the table with every default filled in, under the keys of the file. Two recipes that
//! mean the same have the same canonical form and the same hash, whatever their spelling. It is itself a recipe: [`text`] writes it.
//!
//! ```
//! let plan = brdfbake::recipe::parse(
//!     r#"
//!     name = "one"
//!     [[table]]
//!     kind = "dfg"
//!     name = "ggx-dfg"
//!     "#,
//!     "one.toml",
//! )?;
//! assert_eq!(plan.tables[0].bound.spec.grid.len(), 64 * 64);
//!
//! let error = brdfbake::recipe::parse("nmae = 'one'", "one.toml").unwrap_err();
//! assert!(error.to_string().contains("did you mean `name`?"));
//! # Ok::<(), brdfbake::recipe::RecipeError>(())
//! ```

mod diagnostic;
mod document;
mod engine;
#[cfg(feature = "engines")]
mod engines;
mod index_file;
mod keys;
mod load;
mod preset;
mod read_axis;
mod read_map;
mod read_sbrdf;
mod read_size;
mod sbrdf_keys;
mod schema;
mod section;
mod span;
mod write;
mod write_map;

pub use diagnostic::{Diagnostic, RecipeError};
pub use engine::{Engine, EngineFile, Reader, Roughness, Shipped, engine};
#[cfg(feature = "engines")]
pub use engines::ENGINES;
pub use load::{LoadError, load};
pub use preset::{PRESETS, Preset, preset};
pub use schema::schema;
pub use write::{text, text_with_maps};

/// Every engine: none without the feature `engines`.
#[cfg(not(feature = "engines"))]
pub static ENGINES: &[Engine] = &[];

use crate::plan::faults::Faults;
use crate::plan::resolve::resolve;
use crate::plan::{Fault, Plan};
use std::path::Path;

/// Most bytes of a recipe file.
pub const MAX_BYTES: usize = 1 << 20;

/// Reads a recipe. `file_name` is that of messages; the images of maps and the indices of metals are found from its folder on.
///
/// # Errors
/// [`RecipeError`] with every fault of the text.
pub fn parse(source: &str, file_name: &str) -> Result<Plan, RecipeError> {
    let folder = Path::new(file_name).parent().unwrap_or(Path::new(""));
    parse_in(source, file_name, folder)
}

/// As [`parse`], with the folder of the images.
pub(crate) fn parse_in(source: &str, file_name: &str, folder: &Path) -> Result<Plan, RecipeError> {
    let source = source.strip_prefix('\u{feff}').unwrap_or(source);
    if source.len() > MAX_BYTES {
        let fault = Fault::FileTooLarge { bytes: source.len(), limit: MAX_BYTES };
        return Err(RecipeError::of_file(file_name, fault));
    }
    let (root, errors) = toml::de::DeTable::parse_recoverable(source);
    if !errors.is_empty() {
        return Err(diagnostic::syntax(source, file_name, &errors));
    }
    let mut faults = Faults::default();
    let document = document::read(root.get_ref(), folder, &mut faults);
    let mut judged = Faults::default();
    let document::Document { name, tolerance, drafts, maps, origins } = document;
    let plan = resolve(name.as_deref(), tolerance, drafts, maps, &mut judged);
    for (place, fault) in judged.list {
        faults.push(origins.locate(place), fault);
    }
    faults.dropped += judged.dropped;
    match plan {
        Some(plan) if faults.is_empty() => Ok(plan),
        _ => Err(diagnostic::locate(source, file_name, &span::Spans::of(&root), faults)),
    }
}
