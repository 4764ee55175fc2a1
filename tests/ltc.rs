//! Transformed cosines fitted to models.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

mod common;
use brdfbake::models::{self, Brdf, Params};
use brdfbake::tables::ltc_fit::{self, Family};
use brdfbake::terms::ltc::Inverse;

fn model(id: &str, params: &str) -> Box<dyn Brdf> {
    let (info, _) = models::find(id).unwrap();
    let given: serde_json::Map<String, serde_json::Value> = serde_json::from_str(params).unwrap();
    let params = Params::resolve(info.id, info.params, given.iter().map(|(k, v)| (k.as_str(), v))).unwrap();
    (info.build)(&params).unwrap()
}

#[test]
#[ignore = "exploration"]
fn explore() {
    let dir = common::shared().unwrap().join("oracles/engines/selfshadow_ltc");
    let (_, tab) = common::npy(&dir.join("ltc_js_g_ltc_1.npy"));
    let (_, refit) = common::npy(&dir.join("refit_float64__tab_ggx.npy"));
    let start = std::time::Instant::now();
    let mut rows = Vec::new();
    for t in 0..64 {
        for a in 0..64 {
            let r = f64::from(a) / 63.0;
            let alpha = (r * r).max(1e-5);
            let x = f64::from(t) / 63.0;
            let mu = (1.0 - x * x).max(libm::cos(1.57));
            let m = model("ggx", &format!("{{\"alpha\": {alpha}}}"));
            let f = ltc_fit::fit(&*m, mu.into(), Family::Even, 2.4e-4).unwrap();
            rows.push((t, a, mu, alpha, f, m));
        }
    }
    println!("fit {:.2} s", start.elapsed().as_secs_f64());
    let level: f64 = std::env::var("LEVEL").map_or(15.0, |l| l.parse().unwrap());
    let mut stats = [[0.0f64; 4]; 3];
    let mut worse = 0;
    let mut missed = 0;
    let mut evals = 0u64;
    for (t, a, mu, alpha, f, m) in &rows {
        let k = ((t * 64 + a) * 4) as usize;
        let q = &tab[k..k + 4];
        let ship = Inverse { m11: q[0], m31: q[1], m13: q[2], m33: q[3], m22: 1.0 };
        let k9 = ((t * 64 + a) * 9) as usize;
        // M row-major -> inverse
        let mm = &refit[k9..k9 + 9];
        let d = mm[0] * mm[8] - mm[2] * mm[6];
        let re = Inverse { m11: mm[8] / d, m13: -mm[2] / d, m31: -mm[6] / d, m33: mm[0] / d, m22: 1.0 / mm[4] };
        let re = re.scaled(1.0 / re.m22);
        let o = ltc_fit::judge(&**m, (*mu).into(), &f.fit.inverse, level).unwrap();
        let s = ltc_fit::judge(&**m, (*mu).into(), &ship, level).unwrap();
        let r = ltc_fit::judge(&**m, (*mu).into(), &re, level).unwrap();
        for (st, j) in stats.iter_mut().zip([o, s, r]) {
            st[0] = st[0].max(j.l3);
            st[1] += j.l3 / 4096.0;
            st[2] = st[2].max(j.variation);
            st[3] += j.variation / 4096.0;
        }
        evals += u64::from(f.evaluations);
        let e = f.fit.inverse;
        let diff = f.error.entries;
        let best = s.l3.min(r.l3);
        missed += usize::from(diff > 2.4e-4);
        if o.l3 > best * (1.0 + 1e-6) || diff > 2.4e-4 {
            if o.l3 > best * (1.0 + 1e-6) { worse += 1; }
            if o.l3 > best * (1.0 + 1e-6) || std::env::var_os("ALL").is_some() { println!("{t} {a} mu {mu:.4} alpha {alpha:.5} ours {:.4e} (own {:.4e}) shipped {:.4e} refit {:.4e}, tv {:.4} {:.4}; diff {diff:.1e} n {} [{:.5} {:.5} {:.5} {:.6}] {q:?}", o.l3, f.fit.l3, s.l3, r.l3, o.variation, s.variation, f.evaluations, e.m11, e.m31, e.m13, e.m33); }
        }
    }
    println!("worse {worse}, missed {missed} {stats:?} evals/texel {}", evals / 4096);
}

#[test]
#[ignore = "exploration"]
fn levels() {
    for (t, a) in [(61, 18), (62, 21), (63, 18), (63, 30), (30, 40)] {
        let r = f64::from(a) / 63.0;
        let alpha = (r * r).max(1e-5);
        let x = f64::from(t) / 63.0;
        let mu = (1.0 - x * x).max(libm::cos(1.57));
        let m = model("ggx", &format!("{{\"alpha\": {alpha}}}"));
        let f = ltc_fit::fit(&*m, mu.into(), Family::Even, 2.4e-4).unwrap();
        println!("{t} {a} mu {mu} alpha {alpha} {:?}", f.fit);
        for level in [5.6, 8.0, 11.0, 15.0, 20.0, 27.0, 40.0] {
            let j = ltc_fit::judge(&*m, mu.into(), &f.fit.inverse, level).unwrap();
            println!("  {level} {:.6} {:.6} {:.9}", j.l3, j.variation, j.albedo);
        }
    }
}

#[test]
#[ignore = "exploration"]
fn convergence() {
    for (t, a) in [(0, 1), (1, 1)] {
        let r = f64::from(a) / 63.0;
        let alpha = (r * r).max(1e-5);
        let x = f64::from(t) / 63.0;
        let mu = (1.0 - x * x).max(libm::cos(1.57));
        let m = model("ggx", &format!("{{\"alpha\": {alpha}}}"));
        println!("{t} {a} mu {mu} alpha {alpha}");
        ltc_fit::fit(&*m, mu.into(), Family::Even, 1e-5).unwrap();
    }
}

#[test]
#[ignore = "exploration"]
fn honesty() {
    for tolerance in [1e-2, 1e-3, 2.4e-4] {
        let (mut worst, mut over, mut largest, mut n) = (0.0f64, 0, 0.0f64, 0);
        let mut ratios = Vec::new();
        for t in (0..64).step_by(3) {
            for a in (0..64).step_by(3) {
                let r = f64::from(a) / 63.0;
                let alpha = (r * r).max(1e-5);
                let x = f64::from(t) / 63.0;
                let mu = (1.0 - x * x).max(libm::cos(1.57));
                let m = model("ggx", &format!("{{\"alpha\": {alpha}}}"));
                let f = ltc_fit::fit(&*m, mu.into(), Family::Even, tolerance).unwrap();
                let truth = ltc_fit::fit(&*m, mu.into(), Family::Even, 3e-5).unwrap().fit.inverse;
                let entries = |i: &Inverse| [i.m11, i.m13, i.m31, i.m33];
                let (e, q) = (entries(&f.fit.inverse), entries(&truth));
                let est = f.error.entries.max(1e-9);
                let err = (0..4).map(|k| (e[k] - q[k]).abs()).fold(0.0, f64::max);
                n += 1;
                largest = largest.max(err);
                over += usize::from(err > est);
                worst = worst.max(err / est);
                ratios.push(err / est);
            }
        }
        ratios.sort_by(f64::total_cmp);
        println!("{tolerance:e}: largest {largest:.1e}, over {over} of {n}, worst ratio {worst:.1}, median {:.2}, p90 {:.2}", ratios[n / 2], ratios[9 * n / 10]);
    }
}

#[test]
#[ignore = "exploration"]
fn timing() {
    use std::time::Instant;
    let m = model("ggx", "{\"alpha\": 0.6}");
    for level in [8.0, 20.0, 54.0] {
        let f = ltc_fit::fit(&*m, 0.8.into(), Family::Even, 1e-2).unwrap();
        let start = Instant::now();
        for _ in 0..20 { ltc_fit::judge(&*m, 0.8.into(), &f.fit.inverse, level).unwrap(); }
        println!("{level} {:?}", start.elapsed() / 20);
    }
}
