//! Least squares for a few unknowns: with weights that must not be negative, and plain.

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

/// The x of `G x = b`, G symmetric and positive, by Cholesky's factors; none if it is singular.
#[must_use]
pub fn positive(gram: &[Vec<f64>], b: &[f64]) -> Option<Vec<f64>> {
    let all: Vec<usize> = (0..b.len()).collect();
    solve(gram, b, &all)
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

/// The x that minimises `sum (w (row . x - right))^2`, by Householder reflections.
///
/// Range: a column that depends on those before it, to 1e-13 of the largest entry, gets the coefficient 0; none if there are
/// no rows, fewer rows than columns, or a result that is not finite. Accuracy: relative 1e-16 times the condition of the rows.
#[must_use]
pub fn least_squares(rows: &[Vec<f64>], right: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
    let n = rows.first()?.len();
    if rows.len() < n {
        return None;
    }
    let mut columns: Vec<Vec<f64>> =
        (0..n).map(|j| rows.iter().zip(weights).map(|(r, w)| r[j] * w).collect()).collect();
    let mut y: Vec<f64> = right.iter().zip(weights).map(|(f, w)| f * w).collect();
    let size = columns.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut diagonal = vec![0.0; n];
    for k in 0..n {
        let (done, rest) = columns.split_at_mut(k + 1);
        let v = &mut done[k];
        let norm = v[k..].iter().map(|x| x * x).sum::<f64>().sqrt();
        if norm <= 1e-13 * size {
            continue;
        }
        diagonal[k] = if v[k] > 0.0 { -norm } else { norm };
        v[k] -= diagonal[k];
        let square: f64 = v[k..].iter().map(|x| x * x).sum();
        for other in rest.iter_mut().chain(std::iter::once(&mut y)) {
            let along = 2.0 * v[k..].iter().zip(&other[k..]).map(|(a, b)| a * b).sum::<f64>() / square;
            other[k..].iter_mut().zip(&v[k..]).for_each(|(o, v)| *o -= along * v);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev().filter(|k| diagonal[*k].abs() > 0.0) {
        let known: f64 = (k + 1..n).map(|j| columns[j][k] * x[j]).sum();
        x[k] = (y[k] - known) / diagonal[k];
    }
    x.iter().all(|v| v.is_finite()).then_some(x)
}
