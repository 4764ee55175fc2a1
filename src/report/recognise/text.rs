//! What convention a table follows, as text.

use super::{Candidate, FITS, Recognised};
use crate::report::text::{Lines, number};

/// What was recognised. `name` is how the caller calls the file.
#[must_use]
pub(super) fn recognised(name: &str, found: Option<&Recognised>) -> String {
    let mut lines = Lines::default();
    let Some(found) = found else {
        lines.plain(&format!(
            "{name}: nothing to recognise: fewer than 2 x 2 pixels, or every channel is one number"
        ));
        return lines.finish();
    };
    if found.fits {
        lines.plain(&format!("{name}: a split sum by this convention"));
    } else {
        lines.plain(&format!("{name}: none fits within {}; the nearest is", number(FITS)));
    }
    let b = &found.best;
    let a = &b.arrangement;
    let (along_x, along_y) = match a.x {
        "cosine" => (cosine(b), roughness(b)),
        _ => (roughness(b), cosine(b)),
    };
    lines.item("x", &along_x);
    lines.item("y", &format!("{along_y} (index 0 in the top row)"));
    lines.item("model", &b.model);
    for (c, channel) in b.channels.iter().enumerate() {
        lines.item(&format!("channel {}", c + 1), channel);
    }
    lines.item("numbers", b.decoded);
    let [x, y] = b.at;
    lines.item(
        "error",
        &format!("mean {}, largest {} at x = {x}, y = {y}", number(b.mean), number(b.largest)),
    );
    lines.plain("Other candidates, with all else at its best");
    for (what, candidate) in &found.others {
        lines.item(&number(candidate.mean), what);
    }
    lines.finish()
}

fn cosine(b: &Candidate) -> String {
    let a = &b.arrangement;
    format!("{}, the {} end first, texel i at {}", a.mu, a.mu_first, a.mu_texel)
}

fn roughness(b: &Candidate) -> String {
    let a = &b.arrangement;
    let square = if a.roughness == "roughness" { " (alpha is its square)" } else { "" };
    format!("{}{square}, the {} end first, texel i at {}", a.roughness, a.roughness_first, a.roughness_texel)
}
