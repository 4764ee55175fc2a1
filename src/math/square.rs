//! Dense square matrices of a few hundred rows: Cholesky's factors, inverses, singular values.

/// A square matrix, one row after another.
#[derive(Debug, Clone, PartialEq)]
pub struct Square {
    order: usize,
    entries: Vec<f64>,
}

/// Most sweeps of [`Square::orthogonalise`]; ten are usual.
const SWEEPS: usize = 40;

/// Rows whose cosine is below this count as orthogonal.
const ORTHOGONAL: f64 = 1e-15;

impl Square {
    /// All zeros.
    #[must_use]
    pub fn zero(order: usize) -> Square {
        Square { order, entries: vec![0.0; order * order] }
    }

    /// The matrix with the entries `f(row, column)`.
    #[must_use]
    pub fn from_fn(order: usize, mut f: impl FnMut(usize, usize) -> f64) -> Square {
        let entries = (0..order * order).map(|k| f(k / order, k % order)).collect();
        Square { order, entries }
    }

    /// Number of rows.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// A row; empty beyond the last.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        self.entries.get(i * self.order..(i + 1) * self.order).unwrap_or(&[])
    }

    /// A row to write to; empty beyond the last.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        self.entries.get_mut(i * self.order..(i + 1) * self.order).unwrap_or(&mut [])
    }

    /// The rows from the first on.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.entries.chunks_exact(self.order.max(1))
    }

    /// `self x`.
    #[must_use]
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        self.rows().map(|row| dot(row, x)).collect()
    }

    /// The lower triangle L with `L L' = self`; the upper triangle is not read.
    ///
    /// A pivot that is not positive, or within rounding of 0, ends a positive matrix (`None`). With `semidefinite` it
    /// counts as 0 and so does its column.
    #[must_use]
    pub fn cholesky(&self, semidefinite: bool) -> Option<Square> {
        let n = self.order;
        let mut lower = Square::zero(n);
        for i in 0..n {
            let (done, rest) = lower.entries.split_at_mut(i * n);
            let mine = &mut rest[..n];
            for j in 0..i {
                let above = &done[j * n..(j + 1) * n];
                let sum = self.row(i)[j] - dot(&mine[..j], &above[..j]);
                mine[j] = if above[j] > 0.0 { sum / above[j] } else { 0.0 };
            }
            let diagonal = self.row(i)[i];
            let pivot = diagonal - dot(&mine[..i], &mine[..i]);
            mine[i] = if pivot > f64::EPSILON * diagonal.abs() {
                pivot.sqrt()
            } else if semidefinite && !pivot.is_nan() {
                0.0
            } else {
                return None;
            };
        }
        Some(lower)
    }

    /// `self^-1 x` for a lower triangle.
    pub fn forward(&self, x: &mut [f64]) {
        for i in 0..self.order {
            let row = self.row(i);
            x[i] = (x[i] - dot(&row[..i], &x[..i])) / row[i];
        }
    }

    /// `(self')^-1 x` for a lower triangle.
    pub fn backward(&self, x: &mut [f64]) {
        for i in (0..self.order).rev() {
            let row = self.row(i);
            x[i] /= row[i];
            let known = x[i];
            x[..i].iter_mut().zip(row).for_each(|(x, l)| *x -= l * known);
        }
    }

    /// The inverse of a positive symmetric matrix; `None` if it is not positive.
    #[must_use]
    pub fn inverse_positive(&self) -> Option<Square> {
        let n = self.order;
        let lower = self.cholesky(false)?;
        // rows of the transpose of L^-1
        let mut columns = Square::zero(n);
        for j in 0..n {
            let x = columns.row_mut(j);
            x[j] = 1.0 / lower.row(j)[j];
            for i in j + 1..n {
                let row = lower.row(i);
                x[i] = -dot(&row[j..i], &x[j..i]) / row[i];
            }
        }
        let mut inverse = Square::zero(n);
        for i in 0..n {
            for j in 0..=i {
                let value = dot(&columns.row(i)[i..], &columns.row(j)[i..]);
                inverse.row_mut(i)[j] = value;
                inverse.row_mut(j)[i] = value;
            }
        }
        Some(inverse)
    }

    /// `self' other` for two lower triangles.
    #[must_use]
    pub fn transposed_times(&self, other: &Square) -> Square {
        let n = self.order;
        let mut product = Square::zero(n);
        for k in 0..n {
            let (left, right) = (self.row(k), other.row(k));
            for (i, &l) in left.iter().enumerate().take(k + 1) {
                product.row_mut(i)[..=k].iter_mut().zip(right).for_each(|(p, r)| *p += l * r);
            }
        }
        product
    }

    /// Adds `factor x x'`.
    pub fn add_outer(&mut self, factor: f64, x: &[f64]) {
        let n = self.order.max(1);
        for (row, &a) in self.entries.chunks_exact_mut(n).zip(x) {
            let scaled = factor * a;
            row.iter_mut().zip(x).for_each(|(r, b)| *r += scaled * b);
        }
    }

    /// Turns the rows into each other until all are orthogonal: their lengths are then the singular values, and they over
    /// their lengths the right singular vectors.
    ///
    /// Source: [Hestenes 1958](crate::cite::HESTENES_1958), Jacobi's rotations from one side. Small singular values of graded
    /// matrices keep their digits. Deterministic.
    pub fn orthogonalise(&mut self) {
        let n = self.order;
        for _ in 0..SWEEPS {
            let mut squares: Vec<f64> = self.rows().map(|r| dot(r, r)).collect();
            let mut turned = false;
            for p in 0..n {
                for q in p + 1..n {
                    turned |= self.turn(p, q, &mut squares);
                }
            }
            if !turned {
                break;
            }
        }
    }

    /// One rotation; false if the rows p < q are orthogonal already.
    fn turn(&mut self, p: usize, q: usize, squares: &mut [f64]) -> bool {
        let n = self.order;
        let (above, below) = self.entries.split_at_mut(q * n);
        let (x, y) = (&mut above[p * n..(p + 1) * n], &mut below[..n]);
        let along = dot(x, y);
        let (a, b) = (squares[p].max(0.0), squares[q].max(0.0));
        if along.abs() <= ORTHOGONAL * n as f64 * (a * b).sqrt() || along.abs() <= f64::MIN_POSITIVE {
            return false;
        }
        let zeta = (b - a) / (2.0 * along);
        let tan = 1.0f64.copysign(zeta) / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let sin = cos * tan;
        for (x, y) in x.iter_mut().zip(y) {
            (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
        }
        squares[p] = a - tan * along;
        squares[q] = b + tan * along;
        true
    }
}

/// The scalar product, in four sums.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in fours.zip(others) {
        for l in 0..4 {
            sums[l] += x[l] * y[l];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(n: usize) -> Square {
        let mut seed = 1u64;
        Square::from_fn(n, |_, _| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        })
    }

    #[test]
    fn factors_and_inverse() {
        let a = random(13);
        let positive = Square::from_fn(13, |i, j| dot(a.row(i), a.row(j)) + f64::from(u8::from(i == j)));
        let lower = positive.cholesky(false).unwrap();
        let inverse = positive.inverse_positive().unwrap();
        for i in 0..13 {
            for j in 0..13 {
                assert!((dot(lower.row(i), lower.row(j)) - positive.row(i)[j]).abs() < 1e-14);
                let one = dot(positive.row(i), inverse.row(j));
                assert!((one - f64::from(u8::from(i == j))).abs() < 1e-13);
            }
        }
        let negative = Square::from_fn(2, |i, j| if i == j { -1.0 } else { 0.0 });
        assert!(negative.cholesky(false).is_none());
    }

    /// Singular values over twelve decades: D Q with a rotation Q and a diagonal D has them on the diagonal.
    #[test]
    fn small_singular_values_keep_their_digits() {
        let mut q = random(12);
        q.orthogonalise();
        let scale = |i: usize| libm::exp(-2.5 * i as f64);
        let norm = |r: &[f64]| dot(r, r).sqrt();
        let mut graded = Square::from_fn(12, |i, j| scale(i) * q.row(i)[j] / norm(q.row(i)));
        // mix the rows by a triangle, which keeps the grading
        let mixed = Square::from_fn(12, |i, j| {
            (0..=i).map(|k| graded.row(i)[j] + 1e-3 * scale(i) * q.row(k)[j]).sum()
        });
        let product: f64 = (0..12).map(|i| libm::log(norm(graded.row(i)))).sum();
        graded.orthogonalise();
        let again: f64 = (0..12).map(|i| libm::log(norm(graded.row(i)))).sum();
        assert!((product - again).abs() < 1e-12, "{product} {again}");
        let mut turned = mixed.clone();
        turned.orthogonalise();
        for i in 0..12 {
            for j in 0..i {
                let cos = dot(turned.row(i), turned.row(j)) / (norm(turned.row(i)) * norm(turned.row(j)));
                assert!(cos.abs() < 1e-13);
            }
        }
        let frobenius = |s: &Square| s.rows().map(|r| dot(r, r)).sum::<f64>();
        assert!((frobenius(&turned) / frobenius(&mixed) - 1.0).abs() < 1e-13);
    }
}
