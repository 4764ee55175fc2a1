//! Least squares with weights that must not be negative, for a few unknowns.

/// The w >= 0 that minimises `w' G w - 2 b' w`, G the Gram matrix (rows), by the active set of Lawson and Hanson.
///
/// Source: [Lawson and Hanson 1974](crate::cite::LAWSON_HANSON_1974) chapter 23, algorithm NNLS, on the normal equations.
/// Domain: G symmetric and positive (a singular step is left out). Accuracy: that of the normal equations, relative
/// 1e-16 times their condition.
#[must_use]
pub fn nonnegative(gram: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let mut w = vec![0.0; n];
    let mut free = vec![false; n];
    for _ in 0..3 * n + 3 {
        let slope = |i: usize| b[i] - gram[i].iter().zip(&w).map(|(g, w)| g * w).sum::<f64>();
        let floor = 1e-13 * b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let candidate =
            (0..n).filter(|&i| !free[i] && slope(i) > floor).max_by(|&i, &j| slope(i).total_cmp(&slope(j)));
        let Some(enter) = candidate else { break };
        free[enter] = true;
        // back to the feasible set: shorten the step to where the first weight vanishes, and hold that one
        loop {
            let set: Vec<usize> = (0..n).filter(|&i| free[i]).collect();
            let Some(solution) = solve(gram, b, &set) else {
                free[enter] = false;
                return w;
            };
            let shortest = set
                .iter()
                .zip(&solution)
                .filter(|(_, s)| **s <= 0.0)
                .map(|(&i, s)| w[i] / (w[i] - s))
                .fold(f64::INFINITY, f64::min);
            if !shortest.is_finite() {
                w.fill(0.0);
                set.iter().zip(&solution).for_each(|(&i, s)| w[i] = *s);
                break;
            }
            for (&i, s) in set.iter().zip(&solution) {
                w[i] += shortest * (s - w[i]);
                if w[i] <= 1e-300 || (*s <= 0.0 && w[i] <= 1e-15) {
                    w[i] = 0.0;
                    free[i] = false;
                }
            }
            if set.iter().all(|&i| free[i]) {
                break;
            }
        }
    }
    w
}

/// The unconstrained solution for the unknowns of `set`, by Cholesky's factors; none if the matrix is singular.
fn solve(gram: &[Vec<f64>], b: &[f64], set: &[usize]) -> Option<Vec<f64>> {
    let n = set.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let inner: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let rest = gram[set[i]][set[j]] - inner;
            if i == j {
                if rest <= 1e-15 * gram[set[i]][set[i]] {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    let mut x: Vec<f64> = Vec::with_capacity(n);
    for i in 0..n {
        let inner: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x.push((b[set[i]] - inner) / l[i][i]);
    }
    for i in (0..n).rev() {
        let inner: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - inner) / l[i][i];
    }
    Some(x)
}
