//! Minimisation without derivatives, for a few variables.

/// The minimum of `f` near `start`, by the method of Nelder and Mead: a simplex that is reflected, stretched and shrunk.
///
/// Source: [Nelder and Mead 1965](crate::cite::NELDER_MEAD_1965) with the usual factors 1, 2, 1/2, 1/2. Begun `rounds` times, each
/// from the best point of the round before, with steps half as long. Ends a round after `steps` steps, or when the
/// values at the corners agree to 1e-14. Deterministic. NaN counts as worse than everything.
#[must_use]
pub fn minimise(
    start: &[f64],
    step: f64,
    rounds: usize,
    steps: usize,
    f: &mut dyn FnMut(&[f64]) -> f64,
) -> Vec<f64> {
    let mut best = start.to_vec();
    let mut step = step;
    for _ in 0..rounds {
        best = round(&best, step, steps, f);
        step *= 0.5;
    }
    best
}

fn round(start: &[f64], step: f64, steps: usize, f: &mut dyn FnMut(&[f64]) -> f64) -> Vec<f64> {
    let n = start.len();
    let mut value = |x: &[f64]| {
        let v = f(x);
        if v.is_nan() { f64::INFINITY } else { v }
    };
    let mut corners: Vec<(f64, Vec<f64>)> = vec![(value(start), start.to_vec())];
    for i in 0..n {
        let mut x = start.to_vec();
        x[i] += step;
        corners.push((value(&x), x));
    }
    for _ in 0..steps {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (least, most) = (corners[0].0, corners[n].0);
        if most - least <= 1e-14 * least.abs() {
            break;
        }
        let centre: Vec<f64> =
            (0..n).map(|i| corners[..n].iter().map(|c| c.1[i]).sum::<f64>() / n as f64).collect();
        let along =
            |t: f64| -> Vec<f64> { centre.iter().zip(&corners[n].1).map(|(c, w)| c + t * (w - c)).collect() };
        let reflected = along(-1.0);
        let r = value(&reflected);
        let next = if r < least {
            let stretched = along(-2.0);
            let s = value(&stretched);
            if s < r { Some((s, stretched)) } else { Some((r, reflected)) }
        } else if r < corners[n - 1].0 {
            Some((r, reflected))
        } else {
            let near = along(if r < most { -0.5 } else { 0.5 });
            let v = value(&near);
            (v < r.min(most)).then_some((v, near))
        };
        if let Some(corner) = next {
            corners[n] = corner;
        } else {
            let best = corners[0].1.clone();
            for corner in &mut corners[1..] {
                for (x, b) in corner.1.iter_mut().zip(&best) {
                    *x = b + 0.5 * (*x - b);
                }
                corner.0 = value(&corner.1);
            }
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners.swap_remove(0).1
}
