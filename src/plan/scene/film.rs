//! Thin films: their colour over view, thickness, and the indices of film and base.

use super::Family;
use super::axes::Draft;
use crate::scene::{FILM, Need};

pub(super) const FAMILY: Family = Family { id: FILM, requests, serves: &[("thin-film", None)] };

/// Bases between the darkest and the brightest that a scene has, where they differ.
const BASES: usize = 8;
/// Indices of films, where they differ.
const FILMS: usize = 5;

fn requests(need: &Need) -> Vec<Draft> {
    let table = Draft::new("film-fresnel", "thin-film").layout("series").even("n2", FILMS).even("n3", BASES);
    vec![table.over(need, "film").over(need, "n2").over(need, "n3")]
}
