//! Signs of directions. An axis has no sign, its direction in a texture has: filtering d and −d cancels.
//!
//! The smallest level begins; every level takes the signs of the level above it, and then every texel that goes against its
//! neighbours and its parent is turned, again and again, until none does. A texel without an axis has the direction (1, 0).

use super::filter::Level;

/// Directions of all levels, `[cos, sin]` from the tangent, of length 1.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
pub fn directions(levels: &[Level<'_>]) -> Vec<Vec<[f32; 2]>> {
    let mut out: Vec<Vec<[f32; 2]>> = Vec::with_capacity(levels.len());
    let mut above: Option<([usize; 2], Vec<[f32; 2]>)> = None;
    for level in levels.iter().rev() {
        let strength: Vec<f32> = level.iter().map(|t| t.roughness_max - t.roughness).collect();
        let mut own: Vec<[f32; 2]> = level
            .iter()
            .zip(&strength)
            .map(|(t, s)| {
                let (sin, cos) = libm::sincos(f64::from(t.angle));
                if *s > 0.0 { [cos as f32, sin as f32] } else { [1.0, 0.0] }
            })
            .collect();
        let parent = |i: usize| {
            let (size, directions) = above.as_ref()?;
            let [x, y] = [i % level.size[0], i / level.size[0]];
            let at = |v: usize, from: usize, to: usize| (v * to / from.max(1)).min(to - 1);
            Some(directions[at(y, level.size[1], size[1]) * size[0] + at(x, level.size[0], size[0])])
        };
        let parents: Vec<[f32; 2]> = (0..own.len()).map(|i| parent(i).unwrap_or([1.0, 0.0])).collect();
        for ((d, p), s) in own.iter_mut().zip(&parents).zip(&strength) {
            if *s > 0.0 && dot(*d, *p) < 0.0 {
                *d = [-d[0], -d[1]];
            }
        }
        relax(&mut own, &strength, &parents, level.size);
        above = Some((level.size, own.clone()));
        out.push(own);
    }
    out.reverse();
    out
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

/// Most passes over a level.
const PASSES: usize = 16;

/// Turns texels that go against the sum of their four neighbours, and of their parent, which counts a quarter.
fn relax(own: &mut [[f32; 2]], strength: &[f32], parents: &[[f32; 2]], [width, height]: [usize; 2]) {
    for _ in 0..PASSES {
        let mut turned = false;
        for i in 0..own.len() {
            if strength[i] <= 0.0 {
                continue;
            }
            let [x, y] = [i % width, i / width];
            // textures repeat, mostly; a border that does not loses nothing by it
            let near = [
                y * width + (x + 1) % width,
                y * width + (x + width - 1) % width,
                (y + 1) % height * width + x,
                (y + height - 1) % height * width + x,
            ];
            let mut sum = [0.0; 2];
            for j in near.into_iter().filter(|j| *j != i) {
                sum[0] += strength[j] * own[j][0];
                sum[1] += strength[j] * own[j][1];
            }
            sum[0] += 0.25 * strength[i] * parents[i][0];
            sum[1] += 0.25 * strength[i] * parents[i][1];
            if dot(own[i], sum) < 0.0 {
                own[i] = [-own[i][0], -own[i][1]];
                turned = true;
            }
        }
        if !turned {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::filter::Texel;

    fn level(size: [usize; 2], angle: impl Fn(usize, usize) -> f32) -> Level<'static> {
        let texel = |i: usize| Texel {
            normal: [0.0, 0.0, 1.0],
            roughness: 0.3,
            roughness_max: 0.6,
            angle: angle(i % size[0], i / size[0]),
            wide: [0.0; 2],
            distance: 0.0,
            doubt: 0.0,
            at_limit: false,
        };
        Level::of(size, (0..size[0] * size[1]).map(texel).collect())
    }

    /// Axes that waver about the bitangent: as angles they jump from +90 to -90 degrees.
    #[test]
    fn neighbours_agree_across_the_jump_of_the_angle() {
        let waver = |x: usize, y: usize| {
            let a = std::f32::consts::FRAC_PI_2 - 0.2 + 0.1 * ((x + 3 * y) % 5) as f32;
            if a > std::f32::consts::FRAC_PI_2 { a - std::f32::consts::PI } else { a }
        };
        let levels = [level([8, 8], waver), level([4, 4], waver), level([2, 2], waver), level([1, 1], waver)];
        let directions = directions(&levels);
        for (level, own) in levels.iter().zip(&directions) {
            for (i, d) in own.iter().enumerate() {
                let right = i / level.size[0] * level.size[0] + (i + 1) % level.size[0];
                assert!(dot(*d, own[right]) > 0.0, "{:?} texel {i}", level.size);
                assert!((d[0] * d[0] + d[1] * d[1] - 1.0).abs() < 1e-5);
            }
        }
        for pair in directions.windows(2) {
            assert!(dot(pair[0][0], pair[1][0]) > 0.0);
        }
    }
}
