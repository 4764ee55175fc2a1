//! Plans: one resolved job, whoever asked for it. A recipe, an engine, a scene and a program all make [`TableRequest`]s; here they are
//! judged, bound and filled in, and a [`Plan`] comes out.
//!
//! | from | by | to |
//! |---|---|---|
//! | a program | [`Plan::from_requests`] | [`Plan`] |
//! | the text of a recipe | [`recipe::parse`](crate::recipe::parse), which reads requests and calls the same | [`Plan`] |
//! | an engine | [`Engine::plan`](crate::recipe::Engine::plan), the text of its recipe | [`Plan`] |
//! | a glTF scene | [`scene::requests`] from [`Needs`](crate::scene::Needs), then [`Plan::from_requests`] | [`Plan`] |
//! | a plan | [`Plan::requests`], and [`recipe::text`](crate::recipe::text) of these | the same plan |
//!
//! # A request
//! [`TableRequest`] has a field a key; see its file for what a new key takes. Judging it reports every fault with its [`Place`], a path
//! into the request (`table[2].axis[1].domain`). No file is known here: whoever made the request finds the place in it.
//!
//! # Another sort of unit
//! What is no table (a [`map`]) gets files of its own beside `request.rs` and `table.rs`, a list in [`Plan`] beside
//! `tables`, and an identity that begins with [`identity::Hasher::new`] of its own word. Its files go through [`Plan::files`].
//!
//! # A planned table
//! [`PlannedTable`] holds the request with every default filled in, what it is bound to, its [`Output`]s, and its
//! [`identity`]. After this room there are no words left to look up: an output holds its encoder and storage.

mod bind;
pub(crate) mod canonical;
pub(crate) mod fault;
pub(crate) mod faults;
#[cfg(feature = "unstable")]
pub mod identity;
#[cfg(not(feature = "unstable"))]
pub(crate) mod identity;
pub mod map;
mod name;
mod output;
mod place;
mod probe;
pub(crate) mod request;
pub(crate) mod resolve;
#[cfg(feature = "scene")]
pub mod scene;
pub(crate) mod sizing;
mod table;

pub use fault::Fault;
pub use identity::Input;
pub use map::{MapRequest, PlannedMap};
pub use name::MANIFEST;
pub use output::Output;
pub use place::{Part, Path, Place, Step};
pub use request::TableRequest;
pub use resolve::{Plan, PlanError};
pub use sizing::Sizing;
pub use table::PlannedTable;

/// Most tables of a plan.
pub const MAX_TABLES: usize = 256;
/// Tolerances that can be asked for. Sums in f64 reach about 1e-13; nothing coarser than a tenth is a table.
pub const TOLERANCE: [f64; 2] = [1e-12, 0.1];
/// Most characters of a name or of a reason.
pub(crate) const LONGEST_REASON: usize = 1000;
