//! Adaptive Gauss-Kronrod quadrature on pieces that are graded exponentially towards both of their ends.
//!
//! It shares nothing with `brdfbake::integrate`: other rules, other coordinates, another way to stop. Constants of the rules:
//! QUADPACK (Piessens et al. 1983), the error of a panel as there.

/// A Gauss-Kronrod rule: positive nodes, the middle last; weights; Gauss weights of every second node.
#[derive(Debug)]
pub(crate) struct Rule {
    nodes: &'static [f64],
    kronrod: &'static [f64],
    gauss: &'static [f64],
}

pub(crate) static K15: Rule = Rule {
    nodes: &[
        0.991455371120812639206854697526329,
        0.949107912342758524526189684047851,
        0.864864423359769072789712788640926,
        0.741531185599394439863864773280788,
        0.586087235467691130294144691258380,
        0.405845151377397166906606412076961,
        0.207784955007898467600689403773245,
        0.0,
    ],
    kronrod: &[
        0.022935322010529224963732008058970,
        0.063092092629978553290700663189204,
        0.104790010322250183839876322541518,
        0.140653259715525918745189590510238,
        0.169004726639267902826583426598550,
        0.190350578064785409913256402421014,
        0.204432940075298892414161999234649,
        0.209482141084727828012999174891714,
    ],
    gauss: &[
        0.129484966168869693270611432679082,
        0.279705391489276667901467771423780,
        0.381830050505118944950369775488975,
        0.417959183673469387755102040816327,
    ],
};

pub(crate) static K21: Rule = Rule {
    nodes: &[
        0.995657163025808080735527280689003,
        0.973906528517171720077964012084452,
        0.930157491355708226001207180059508,
        0.865063366688984510732096688423493,
        0.780817726586416897063717578345042,
        0.679409568299024406234327365114874,
        0.562757134668604683339000099272694,
        0.433395394129247190799265943165784,
        0.294392862701460198131126603103866,
        0.148874338981631210884826001129720,
        0.0,
    ],
    kronrod: &[
        0.011694638867371874278064396062192,
        0.032558162307964727478818972459390,
        0.054755896574351996031381300244580,
        0.075039674810919952767043140916190,
        0.093125454583697605535065465083366,
        0.109387158802297641899210590325805,
        0.123491976262065851077958109585166,
        0.134709217311473325928054001771707,
        0.142775938577060080797094273138717,
        0.147739104901338491374841515972068,
        0.149445554002916905664936468389821,
    ],
    gauss: &[
        0.066671344308688137593568809893332,
        0.149451349150580593145863396957658,
        0.219086362515982043995534934228163,
        0.269266719309996355091226921569469,
        0.295524224714752870173815619188769,
    ],
};

/// How one truth is computed; a second setting tells the error of the first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setting {
    pub(crate) rule: &'static Rule,
    /// Absolute tolerance, before it is scaled by the magnitude of the integral.
    pub(crate) tolerance: f64,
    /// Part of a panel's magnitude that its error may always be.
    pub(crate) relative: f64,
    /// Panels of one integral after which the rest is taken as it is; the two settings then differ by what is missing.
    pub(crate) panels: u32,
    /// First edges of the graded variable, positive half.
    pub(crate) edges: &'static [f64],
}

pub(crate) static COARSE: Setting =
    Setting { rule: &K15, tolerance: 0.0, relative: 1e-3, panels: 60, edges: &[0.0, 4.0, 9.0, 18.0, 36.0] };
/// For the many values that a curve or an average takes.
pub(crate) static MEDIUM: Setting =
    Setting { rule: &K15, tolerance: 1e-11, relative: 1e-12, panels: 1000, edges: &[0.0, 5.0, 14.0, 33.0] };
/// To judge [`LOOSE`] by.
pub(crate) static ROUGH: Setting =
    Setting { rule: &K21, tolerance: 1e-7, relative: 1e-8, panels: 300, edges: &[0.0, 5.0, 13.0, 30.0] };
/// For averages of what is itself dear.
pub(crate) static LOOSE: Setting =
    Setting { rule: &K15, tolerance: 1e-9, relative: 1e-10, panels: 400, edges: &[0.0, 6.0, 15.0, 33.0] };
pub(crate) static FIRST: Setting = Setting {
    rule: &K15,
    tolerance: 1e-12,
    relative: 1e-13,
    panels: 2000,
    edges: &[0.0, 3.5, 8.0, 17.0, 37.0],
};
pub(crate) static SECOND: Setting = Setting {
    rule: &K21,
    tolerance: 2e-13,
    relative: 2e-14,
    panels: 2000,
    edges: &[0.0, 4.5, 11.0, 22.0, 41.0],
};

/// A value, and the sum of what its panels say of their errors.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Setting {
    /// Integral, error as QUADPACK takes it, integral of the magnitude.
    fn panel(&self, a: f64, b: f64, f: &mut dyn FnMut(f64) -> f64) -> (f64, f64, f64) {
        let Rule { nodes, kronrod, gauss } = self.rule;
        let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
        let last = nodes.len() - 1;
        let middle = f(centre);
        let mut values = [0.0; 21];
        let mut k = kronrod[last] * middle;
        let mut g = if last % 2 == 1 { gauss[gauss.len() - 1] * middle } else { 0.0 };
        let mut magnitude = kronrod[last] * middle.abs();
        for i in 0..last {
            let (low, high) = (f(centre - half * nodes[i]), f(centre + half * nodes[i]));
            (values[2 * i], values[2 * i + 1]) = (low, high);
            k += kronrod[i] * (low + high);
            magnitude += kronrod[i] * (low.abs() + high.abs());
            if i % 2 == 1 {
                g += gauss[i / 2] * (low + high);
            }
        }
        let mean = 0.5 * k;
        let mut spread = kronrod[last] * (middle - mean).abs();
        for i in 0..last {
            spread += kronrod[i] * ((values[2 * i] - mean).abs() + (values[2 * i + 1] - mean).abs());
        }
        let (k, spread, magnitude) = (k * half, spread * half, magnitude * half);
        let mut error = (k - g * half).abs();
        if spread > 0.0 && error > 0.0 {
            error = spread * (200.0 * error / spread).powf(1.5).min(1.0);
        }
        (k, error, magnitude)
    }

    /// Integral between consecutive edges: halved until a panel's error is a tenth of the tolerance.
    pub(crate) fn adaptive(&self, edges: &[f64], tolerance: f64, f: &mut dyn FnMut(f64) -> f64) -> Sum {
        let mut total = Sum::default();
        let mut low = 0.0;
        let mut stack: Vec<(f64, f64, u32)> = Vec::new();
        for pair in edges.windows(2).rev() {
            stack.push((pair[0], pair[1], 0));
        }
        let mut count = 0;
        while let Some((a, b, depth)) = stack.pop() {
            count += 1;
            let (value, error, magnitude) = self.panel(a, b, f);
            if error <= 0.1 * tolerance
                || error <= self.relative * magnitude.max(total.value.abs())
                || depth >= 48
                || count > self.panels
                || error.is_nan()
            {
                // compensated: a thousand panels would add up their rounding
                let (sum, add) = (total.value, value - low);
                total.value = sum + add;
                low = (total.value - sum) - add;
                total.error += error;
            } else {
                let middle = 0.5 * (a + b);
                stack.push((middle, b, depth + 1));
                stack.push((a, middle, depth + 1));
            }
        }
        total
    }
}

/// A point of a graded piece: where it is, and its distances to both ends, exact where they are small.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At {
    pub(crate) x: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// The end of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    pub(crate) at: f64,
    /// True if scales below any that are known may lie next to it: the variable is graded towards it.
    pub(crate) sharp: bool,
}

/// An end towards which the variable is graded.
pub(crate) fn sharp(at: f64) -> Edge {
    Edge { at, sharp: true }
}

/// An end that marks a scale, or a line with smooth functions on both of its sides.
pub(crate) fn mark(at: f64) -> Edge {
    Edge { at, sharp: false }
}

impl Setting {
    /// `int_a^b f`. `f` is given the tolerance that an integral of its own may have.
    ///
    /// Between sharp ends x = a + (b - a) / (1 + e^-w); next to one, the distance to it is (b - a) e^w; else x itself. A piece
    /// of many decades takes the logarithm.
    fn piece(&self, a: Edge, b: Edge, tolerance: f64, f: &mut dyn FnMut(At, f64) -> f64) -> Sum {
        let length = b.at - a.at;
        if !(length > 0.0) {
            return Sum::default();
        }
        let decades = if a.at > 0.0 { (b.at / a.at).ln() } else { 0.0 };
        let wide = decades > 3.0;
        let mut call = |at: At, jacobian: f64| {
            if jacobian > 0.0 { jacobian * f(at, 0.01 * tolerance / jacobian) } else { 0.0 }
        };
        match (a.sharp, b.sharp) {
            (false, false) if wide => {
                let count = (decades / 3.0).ceil();
                let edges: Vec<f64> = (0..=count as usize).map(|k| decades * k as f64 / count).collect();
                self.adaptive(&edges, tolerance, &mut |w| {
                    let x = a.at * w.exp();
                    call(At { x, from: x - a.at, to: b.at - x }, x)
                })
            }
            (false, false) => self.adaptive(&[0.0, 1.0], tolerance, &mut |t| {
                let x = a.at + length * t;
                call(At { x, from: length * t, to: length * (1.0 - t) }, length)
            }),
            (true, false) => self.adaptive(&self.down(decades), tolerance, &mut |w| {
                let from = length * w.exp();
                call(At { x: a.at + from, from, to: -length * w.exp_m1() }, from)
            }),
            (false, true) if !wide => self.adaptive(&self.down(0.0), tolerance, &mut |w| {
                let to = length * w.exp();
                call(At { x: b.at - to, from: -length * w.exp_m1(), to }, to)
            }),
            _ => {
                // next to a mark the scale is that of the mark
                let left = if a.sharp {
                    self.down(decades)
                } else {
                    vec![-decades - 4.0, -decades, -0.5 * decades, 0.0]
                };
                let right = self.down(0.0);
                let edges: Vec<f64> =
                    left.into_iter().chain(right.iter().rev().skip(1).map(|w| -w)).collect();
                let rest = if a.sharp { 0.0 } else { (edges[0]).exp() };
                let scale = length;
                let main = self.adaptive(&edges, tolerance, &mut |w| {
                    let e = (-w.abs()).exp();
                    let (near, far) = (e / (1.0 + e), 1.0 / (1.0 + e));
                    let (from, to) =
                        if w < 0.0 { (scale * near, scale * far) } else { (scale * far, scale * near) };
                    let x = if w < 0.0 { a.at + from } else { b.at - to };
                    call(At { x, from, to }, scale * near * far)
                });
                if rest <= 0.0 {
                    return main;
                }
                // the short end that the left edges leave out
                let short = length * (rest / (1.0 + rest));
                let end = self.adaptive(&[0.0, 1.0], tolerance, &mut |t| {
                    let from = short * t;
                    call(At { x: a.at + from, from, to: length - from }, short)
                });
                Sum { value: main.value + end.value, error: main.error + end.error }
            }
        }
    }

    /// First edges of ln(distance / length), from far below to 0; more of them for a piece of many decades.
    fn down(&self, decades: f64) -> Vec<f64> {
        let mut edges: Vec<f64> = self.edges.to_vec();
        let last = edges[edges.len() - 1];
        let mut at = last;
        while decades > 8.0 && at < last + decades {
            at += 12.0;
            edges.push(at);
        }
        edges.iter().rev().map(|e| -e).collect()
    }

    /// The sum over the pieces between sorted edges.
    pub(crate) fn pieces(
        &self,
        edges: &[Edge],
        tolerance: f64,
        f: &mut dyn FnMut(At, f64, usize) -> f64,
    ) -> Sum {
        let mut total = Sum::default();
        for (i, pair) in edges.windows(2).enumerate() {
            let part = self.piece(pair[0], pair[1], tolerance, &mut |at, tolerance| f(at, tolerance, i));
            total.value += part.value;
            total.error += part.error;
        }
        total
    }
}

/// Edges inside (a, b), with both ends, in order; of those that are one but for rounding the sharp one is kept.
pub(crate) fn sorted(a: Edge, b: Edge, mut inner: Vec<Edge>) -> Vec<Edge> {
    inner.retain(|e| e.at > a.at && e.at < b.at);
    inner.push(b);
    inner.sort_by(|x, y| x.at.total_cmp(&y.at));
    let mut all = vec![a];
    for edge in inner {
        let last = all.len() - 1;
        if edge.at - all[last].at > 4e-16 * edge.at.abs() {
            all.push(edge);
        } else {
            all[last].sharp |= edge.sharp;
            if last > 0 {
                all[last].at = edge.at;
            }
        }
    }
    if all.len() == 1 {
        all.push(b);
    }
    all
}

/// A truth and its error, from two settings; the first run tells the magnitude.
pub(crate) fn two_settings(mut run: impl FnMut(&Setting, f64) -> Sum) -> (f64, f64) {
    let magnitude = run(&COARSE, 0.0).value.abs().max(1.0);
    let first = run(&FIRST, FIRST.tolerance * magnitude).value;
    let second = run(&SECOND, SECOND.tolerance * magnitude).value;
    (second, (first - second).abs() + 1e-15 * magnitude)
}
