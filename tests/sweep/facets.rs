//! Half-vector lobes in elliptic slopes of the half vector: x = ax rho cos(tau), y = ay rho sin(tau), wh ~ (x, y, 1).
//!
//! `dwh = ax ay rho drho dtau / (1 + r^2)^(3/2)`, `dwi = 4 (wo.wh) dwh`. With c = mu_o, s its sine, p the slope along the view over
//! rho and q = r^2 / rho^2: `mu_i (1 + r^2) = c (1 - q rho^2) + 2 s p rho = c q (end - rho)(rho + 1/(q end))`, where `end` is the horizon,
//! and `wo.wh = (mu_i + c) sqrt(1 + r^2) / 2`: nothing cancels. Known lines are ends of pieces.

use crate::sweep::quad::{Edge, Setting, Sum, mark, sharp, sorted};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A pair of directions and their half vector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair {
    pub(crate) wo: DVec3,
    pub(crate) wi: DVec3,
    pub(crate) wh: DVec3,
    /// wo . wh
    pub(crate) cos_d: f64,
    pub(crate) mu_o: f64,
    pub(crate) mu_i: f64,
    /// Radial variable: slopes in units of the widths.
    pub(crate) rho: f64,
    /// r^2 = tan^2 of the half vector.
    pub(crate) r: f64,
    /// What the lobe has for the view alone.
    pub(crate) view: f64,
    /// sqrt(1 + r^2)
    root: f64,
    area: f64,
}

impl Pair {
    /// What `f mu_i (wo.wh)` is multiplied by, over `drho dtau`.
    pub(crate) fn facets(&self) -> f64 {
        4.0 * (self.area / self.root) * (self.rho / self.root) / self.root
    }

    /// What `V mu_i (wo.wh)` is multiplied by, for densities of slopes per `d(x/ax) d(y/ay)` that hold rho^2.
    pub(crate) fn slopes(&self) -> f64 {
        4.0 * self.root / self.rho
    }

    /// `mu_i (wo.wh)`
    pub(crate) fn cosines(&self) -> f64 {
        self.mu_i * self.cos_d
    }
}

/// Lines on which an integrand is not smooth.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lines {
    /// Values of wo.wh.
    pub(crate) cos_d: Vec<f64>,
    /// Values of mu_i, besides 0.
    pub(crate) mu_i: Vec<f64>,
    /// The lines of V-cavities.
    pub(crate) grooves: bool,
    /// wi at the normal is a singular point.
    pub(crate) normal: bool,
    /// More values of rho.
    pub(crate) rho: Vec<f64>,
}

/// An integral over half vectors.
pub(crate) struct Facets<'a> {
    pub(crate) mu: f64,
    pub(crate) phi: f64,
    pub(crate) alpha: [f64; 2],
    /// Where the lobe ends in rho; infinite for a tail.
    pub(crate) end: f64,
    /// Power of rho by which the integrand falls per ln rho, if it must be continued beyond 1e60.
    pub(crate) tail: f64,
    pub(crate) lines: Lines,
    /// Handed on to every pair.
    pub(crate) view: f64,
    /// The integrand per `drho dtau`.
    pub(crate) f: &'a (dyn Fn(&Pair) -> f64 + Sync),
}

/// What a ray of constant tau has.
struct Ray {
    tau: (f64, f64),
    sp: f64,
    q: f64,
    /// c q times the horizon
    reach: f64,
}

impl Facets<'_> {
    fn sine(&self) -> f64 {
        ((1.0 - self.mu) * (1.0 + self.mu)).sqrt()
    }

    fn isotropic(&self) -> bool {
        self.alpha[0] == self.alpha[1]
    }

    /// Coefficients of p in cos(tau) and sin(tau).
    fn along(&self) -> [f64; 2] {
        if self.isotropic() {
            return [self.alpha[0], 0.0];
        }
        let (sin, cos) = self.phi.sin_cos();
        [self.alpha[0] * cos, self.alpha[1] * sin]
    }

    pub(crate) fn integrate(&self, setting: &Setting, tolerance: f64) -> Sum {
        let half = self.isotropic();
        let breaks = self.breaks(half);
        let mut sum =
            setting.pieces(&breaks, tolerance, &mut |at, tolerance, _| self.ray(setting, at.x, tolerance));
        if half {
            sum.value *= 2.0;
            sum.error *= 2.0;
        }
        sum
    }

    /// Ends of the pieces in tau.
    fn breaks(&self, half: bool) -> Vec<Edge> {
        let [a, b] = self.along();
        let [ax, ay] = self.alpha;
        let mut all = Vec::new();
        let view = b.atan2(a);
        let mut kappas = vec![];
        let (c, s) = (self.mu, self.sine());
        for &line in &self.lines.cos_d {
            // roots meet; the line passes infinity; the line meets the horizon
            kappas.push((line * line - c * c).max(0.0).sqrt());
            kappas.push(line);
            let r2 = (2.0 * line / c) * (2.0 * line / c) - 1.0;
            if c > 0.0 && r2 > 0.0 {
                kappas.push(c * (r2 - 1.0) / (2.0 * r2.sqrt()));
            }
        }
        for &line in &self.lines.mu_i {
            kappas.push((line * line - c * c).max(0.0).sqrt());
        }
        if self.lines.grooves {
            kappas.push(c);
        }
        for kappa in kappas {
            // (a + b t)^2 = (kappa/s)^2 (ax^2 + ay^2 t^2)
            let k2 = (kappa / s) * (kappa / s);
            if !(k2 > 0.0 && k2.is_finite()) {
                continue;
            }
            let (u, v, w) = (b * b - k2 * ay * ay, a * b, a * a - k2 * ax * ax);
            let d = v * v - u * w;
            if d >= 0.0 {
                let t = -(v + d.sqrt().copysign(v));
                for slope in [t.atan2(u), w.atan2(t)] {
                    all.extend([slope, slope + PI, slope - PI]);
                }
            }
        }
        if half {
            all.push(FRAC_PI_2);
            // the plane of incidence is one of symmetry; a singular point may lie in it
            let plane = |at| Edge { at, sharp: self.lines.normal };
            return sorted(plane(0.0), plane(PI), all.into_iter().map(sharp).collect());
        }
        for quarter in [0.0, FRAC_PI_2, PI, -FRAC_PI_2, -PI] {
            all.push(quarter);
            for turn in [0.0, TAU, -TAU] {
                all.push(view + quarter + turn);
            }
        }
        sorted(sharp(-PI), sharp(PI), all.into_iter().map(sharp).collect())
    }

    fn ray(&self, setting: &Setting, tau: f64, tolerance: f64) -> f64 {
        let (sin, cos) = tau.sin_cos();
        let [a, b] = self.along();
        let (c, s) = (self.mu, self.sine());
        let p = a * cos + b * sin;
        let (qx, qy) = (self.alpha[0] * cos, self.alpha[1] * sin);
        let q = qx * qx + qy * qy;
        let sp = s * p;
        let root = sp.hypot(c * q.sqrt());
        let reach = if sp >= 0.0 { sp + root } else { c * q / (root - sp) * c };
        let horizon = if c > 0.0 { reach / (c * q) } else { f64::INFINITY };
        if !(reach > 0.0) {
            return 0.0;
        }
        let ray = Ray { tau: (cos, sin), sp, q, reach };
        let last = horizon.min(self.end).min(1e300);
        let open = horizon > last;
        let last = if last >= 1e300 { 1e60 } else { last };
        let end = Edge { at: last, sharp: !open };
        let breaks = sorted(sharp(0.0), end, self.on_ray(&ray));
        let count = breaks.len() - 2;
        let sum = setting.pieces(&breaks, tolerance, &mut |at, _, i| {
            let left = if i == count && !open { c * q * at.to } else { reach - c * q * at.x };
            self.at(&ray, at.x, left.max(0.0))
        });
        let beyond =
            if last == 1e60 && self.tail > 0.0 { self.at(&ray, last, reach) * last / self.tail } else { 0.0 };
        sum.value + beyond
    }

    /// Ends of the pieces in rho.
    fn on_ray(&self, ray: &Ray) -> Vec<Edge> {
        let (c, s, sp, q) = (self.mu, self.sine(), ray.sp, ray.q);
        let mut all: Vec<Edge> = self.lines.rho.iter().map(|rho| mark(*rho)).collect();
        all.push(mark(1.0));
        for &line in &self.lines.cos_d {
            let roots = quadratic(sp * sp - line * line * q, c * sp, (c - line) * (c + line));
            all.extend(roots.into_iter().filter(|rho| c + sp * rho > 0.0).map(sharp));
        }
        for &line in &self.lines.mu_i {
            all.extend(quadratic((c + line) * q, -sp, line - c).into_iter().map(mark));
        }
        if self.lines.grooves {
            all.extend([mark(sp / (c * q)), mark(c / sp)]);
            let angle = (c * q.sqrt()).atan2(sp);
            all.extend((1..=3).map(|k| mark(((f64::from(k) * PI - angle) / 3.0).tan() / q.sqrt())));
        }
        if self.lines.normal {
            all.push(sharp(s / (1.0 + c) / q.sqrt()));
        }
        all.retain(|edge| edge.at.is_finite() && edge.at > 0.0);
        all
    }

    fn at(&self, ray: &Ray, rho: f64, left: f64) -> f64 {
        let (c, s) = (self.mu, self.sine());
        let r = rho * ray.q.sqrt();
        let root = r.hypot(1.0);
        let mu_i = ((left / root) * ((rho + c / ray.reach) / root)).min(1.0);
        // nothing is left of it, and 1 / mu_i may overflow
        if !(mu_i > 1e-290) {
            return 0.0;
        }
        let cos_d = (0.5 * (mu_i + c) * root).min(1.0);
        let wh = DVec3::new(
            self.alpha[0] * rho * ray.tau.0 / root,
            self.alpha[1] * rho * ray.tau.1 / root,
            1.0 / root,
        );
        let (sin, cos) = if self.isotropic() { (0.0, 1.0) } else { self.phi.sin_cos() };
        let wo = DVec3::new(s * cos, s * sin, c);
        let wi = 2.0 * cos_d * wh - wo;
        let wi = DVec3::new(wi.x, wi.y, mu_i);
        let area = self.alpha[0] * self.alpha[1];
        (self.f)(&Pair { wo, wi, wh, cos_d, mu_o: c, mu_i, rho, r, view: self.view, root, area })
    }
}

/// Positive roots of `a x^2 + 2 b x + c`.
pub(crate) fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    let d = b * b - a * c;
    if !(d >= 0.0) {
        return Vec::new();
    }
    let t = -(b + d.sqrt().copysign(b));
    [t / a, c / t].into_iter().filter(|x| x.is_finite() && *x > 0.0).collect()
}
