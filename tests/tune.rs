#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::float_cmp,
    missing_docs,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "test"
)]
use brdfbake::integrate::{BATCH, Chart, Nodes};
use brdfbake::models::{self, Params};
fn rnd(s: &mut u64) -> f64 {
    *s ^= *s << 13;
    *s ^= *s >> 7;
    *s ^= *s << 17;
    (*s >> 11) as f64 / (1u64 << 53) as f64
}
#[test]
fn tune() {
    let levels = brdfbake::integrate::ladder::LEVELS;
    let mut sd = 88172645463325252u64;
    let mut pts = vec![];
    for i in 0..6000 {
        let (mu, al): (f64, f64) = match i % 4 {
            0 => (rnd(&mut sd), rnd(&mut sd).powi(2)),
            1 => (10f64.powf(-5. * rnd(&mut sd)), 10f64.powf(-5. * rnd(&mut sd))),
            2 => (1. - 10f64.powf(-5. * rnd(&mut sd)), 10f64.powf(-5. * rnd(&mut sd))),
            _ => (rnd(&mut sd), 10f64.powf(-5. * rnd(&mut sd))),
        };
        pts.push((mu, al));
    }
    let model = std::env::var("MODEL").unwrap_or("ggx".into());
    let (info, _) = models::find(&model).unwrap();
    let base = Params::resolve(info.id, info.params, []).unwrap();
    let sums = |mu: f64, al: f64, level: f64, n: &mut usize| {
        let mut p = base.clone();
        for k in ["alpha", "alpha_x", "alpha_y"] {
            p.set(k, al);
        }
        let m = (info.build)(&p).unwrap();
        let mut out = [0.0; BATCH];
        let mut s = [[0.0f64; 2]; 8];
        m.chart().unwrap().visit(mu, level, &mut |nodes: &Nodes| {
            *n += nodes.len;
            m.eval_nodes(nodes, &mut out);
            for i in 0..nodes.len {
                let f = out[i] * nodes.mu_i[i] * nodes.weight[i];
                let c = 1.0 - nodes.cos_d[i];
                s[nodes.panel][0] += f * (1.0 - c.powi(5));
                s[nodes.panel][1] += f * c.powi(5);
            }
        });
        s
    };
    let mut data: Vec<Vec<(f64, f64, f64, f64)>> = vec![vec![]; levels.len()];
    let mut cost = vec![0usize; levels.len()];
    for &(mu, al) in &pts {
        let all: Vec<_> = levels.iter().enumerate().map(|(j, l)| sums(mu, al, *l, &mut cost[j])).collect();
        let total = |s: &[[f64; 2]; 8], c: usize| s.iter().map(|p| p[c]).sum::<f64>();
        let best = &all[levels.len() - 1];
        for j in 1..levels.len() - 2 {
            let mut w: (f64, f64, f64, f64) = (0.0, mu, al, 0.0);
            let dd: Vec<f64> =
                (0..2).map(|c| (0..8).map(|p| (all[j][p][c] - all[j - 1][p][c]).abs()).sum()).collect();
            for c in 0..2 {
                let err = (total(&all[j], c) - total(best, c)).abs();
                let mix: f64 = std::env::var("MIX").map(|x| x.parse().unwrap()).unwrap_or(0.1);
                let d = dd[c] + mix * (dd[0] + dd[1]);
                let r = (err - 2e-15).max(0.0) / (d + 1e-15);
                w.0 = w.0.max(r);
                w.3 = w.3.max(err);
            }
            data[j].push(w);
        }
    }
    for j in 1..levels.len() - 2 {
        let d = &mut data[j];
        let maxerr = d.iter().map(|x| x.3).fold(0.0, f64::max);
        let mut e: Vec<f64> = d.iter().map(|x| x.3).collect();
        e.sort_by(f64::total_cmp);
        d.sort_by(|a, b| a.0.total_cmp(&b.0));
        let n = d.len();
        let m = d[n - 1];
        println!(
            "{:>4}->{:<4} evals {:>5} err med {:.1e} 99% {:.1e} max {:.1e}; ratio med {:.1e} 99% {:.2} 99.9% {:.2} max {:.2} at mu {:.1e} alpha {:.1e}",
            levels[j - 1],
            levels[j],
            cost[j] / pts.len(),
            e[n / 2],
            e[n * 99 / 100],
            maxerr,
            d[n / 2].0,
            d[n * 99 / 100].0,
            d[n * 999 / 1000].0,
            m.0,
            m.1,
            m.2
        );
    }
}
