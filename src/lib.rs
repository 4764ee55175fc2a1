//! `brdfbake`: BRDF lookup tables baked to a tolerance, verified as they bake.
//!
//! # Rooms
//! A room imports only rooms of a smaller rank; equal ranks are strangers (`tests/layering.rs`).
//!
//! | rank | room | holds |
//! |---|---|---|
//! | 0 | [`cancel`] | the token that stops work from outside |
//! | 0 | [`cite`] | the bibliography |
//! | 1 | [`math`] | frames, special functions, compensated sums |
//! | 2 | [`grid`] | axes, tables, the reference reader, provenance |
//! | 2 | [`integrate`] | quadrature rules and charts of the hemisphere; knows no BRDF |
//! | 2 | [`picture`] | decoded images as planes, and their pyramids |
//! | 2 | [`terms`] | D, F, G of the papers in closed form |
//! | 3 | [`models`] | one file a reflectance model, and their registry |
//! | 4 | [`functions`] | the terms as functions with ids, for evaluation by name |
//! | 4 | [`tables`] | one file a bakeable table, their registry, and the one driver loop |
//! | 5 | [`maps`] | footprints of normals to lobes: one file a filter rule |
//! | 5 | [`verify`] | one file a law; findings; `Verified` |
//! | 6 | [`encode`] | one file a container; readers |
//! | 7 | [`report`] | what a person reads: files and differences as text |
//! | 6 | [`scene`] | what a glTF file needs; knows nothing of the rest |
//! | 7 | [`plan`] | requests of any asker to one resolved job, and what its bytes depend on |
//! | 8 | [`recipe`] | the text of recipes to requests, faults to lines; presets and engines |
//! | 9 | [`pipeline`] | plan, bake, verify, encode, write |
//! | 9 | [`guide`] | the pages of the manual, and how engines use their tables |
//! | 10 | [`build`] | recipes as a step of a Cargo build |
//! | 11 | `cli` | one file a verb (feature `cli`) |
//!
//! # A table in ten lines
//! [`bake`] takes a request and gives values, errors and axes in memory; [`pipeline::Baked::encode`] makes a file of them. A build
//! script calls [`build::recipe`].

// Texts of the interface name what works behind it.
#![allow(rustdoc::private_intra_doc_links, reason = "they are links where private rooms are shown")]
// What only tests and benchmarks ask of a room is idle where they cannot reach it.
#![cfg_attr(
    not(feature = "unstable"),
    allow(dead_code, unused_imports, reason = "open with the feature `unstable`")
)]

pub mod build;
pub mod cancel;
pub mod cite;
#[cfg(feature = "cli")]
#[cfg_attr(not(feature = "unstable"), doc(hidden))]
pub mod cli;
pub mod encode;
pub mod grid;
pub mod guide;
pub mod maps;
pub mod models;
pub mod pipeline;
pub mod plan;
pub mod recipe;
#[cfg(feature = "scene")]
pub mod scene;
pub mod tables;
pub mod verify;

// Rooms that are no interface and may change in any release; tests and benchmarks open them.
#[cfg(feature = "unstable")]
pub mod functions;
#[cfg(not(feature = "unstable"))]
mod functions;

#[cfg(feature = "unstable")]
pub mod integrate;
#[cfg(not(feature = "unstable"))]
mod integrate;

#[cfg(feature = "unstable")]
pub mod math;
#[cfg(not(feature = "unstable"))]
mod math;

#[cfg(feature = "unstable")]
pub mod picture;
#[cfg(not(feature = "unstable"))]
mod picture;

#[cfg(feature = "unstable")]
pub mod report;
#[cfg(not(feature = "unstable"))]
mod report;

#[cfg(feature = "unstable")]
pub mod terms;
#[cfg(not(feature = "unstable"))]
mod terms;

pub use pipeline::bake;

#[cfg(test)]
#[path = "../tests/counted.rs"]
mod counted;
