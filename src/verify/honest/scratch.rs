#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::disallowed_methods, clippy::pedantic, reason = "scratch")]
use super::hemisphere::{Flux, Wanted};
use crate::integrate::View;
use crate::models::{self, Brdf, Params};
use crate::tables::integral::{Functional, integrate};
use std::time::Instant;

fn model(id: &str, set: &[(&str, f64)]) -> Box<dyn Brdf> {
    let (info, _) = models::find(id).unwrap();
    let mut params = Params::resolve(info.id, info.params, []).unwrap();
    for (k, v) in set {
        params.set(k, *v);
        if *k == "alpha" && info.param("alpha_x").is_some() {
            params.set("alpha_x", *v);
            params.set("alpha_y", *v);
        }
    }
    (info.build)(&params).unwrap()
}


#[derive(Debug)]
struct Counted(Box<dyn Brdf>, std::sync::atomic::AtomicUsize);
impl Brdf for Counted {
    fn eval(&self, a: glam::DVec3, b: glam::DVec3) -> f64 { self.1.fetch_add(1, std::sync::atomic::Ordering::Relaxed); self.0.eval(a, b) }
    fn sample(&self, wo: glam::DVec3, u: glam::DVec2) -> Option<models::Sample> { self.0.sample(wo, u) }
    fn pdf(&self, a: glam::DVec3, b: glam::DVec3) -> f64 { self.0.pdf(a, b) }
    fn chart(&self) -> Option<crate::integrate::Chart> { self.0.chart() }
    fn turns(&self) -> bool { self.0.turns() }
}

#[test]
fn sweep() {
    let sets: &[(&str, &str, &[f64])] = &[("phong", "n", &[1.0]), ("ggx-dielectric", "eta", &[0.4, 0.66]), ("charlie", "roughness", &[0.5]), ("oren-nayar-full", "sigma", &[0.5]), ("velvet-ashikhmin", "sigma", &[0.05]), ("ggx", "alpha", &[0.01, 0.3])];
    let _others: &[(&str, &str, &[f64])] = &[
        ("ggx", "alpha", &[1e-6, 1e-4, 0.01, 0.1, 0.5, 1.0]), ("beckmann", "alpha", &[1e-4, 0.01, 0.1, 0.5, 1.0]),
        ("charlie", "roughness", &[0.05, 0.5]), ("velvet-ashikhmin", "sigma", &[0.05, 0.5]), ("ward", "alpha", &[0.01, 0.3]),
        ("ggx-dielectric", "eta", &[0.4, 0.66, 1.5]), ("phong", "n", &[1.0, 100.0, 1e5]), ("kulla-conty", "alpha", &[0.01, 0.5]),
        ("lafortune-lobe", "n", &[2.0, 50.0, 1000.0]), ("burley-diffuse", "r", &[0.5]), ("oren-nayar-full", "sigma", &[0.5, 1.4]),
        ("gltf", "roughness", &[0.3]), ("banks", "n", &[10.0]), ("sggx-fiber", "sigma", &[0.01, 0.3]), ("ltc-sheen", "roughness", &[0.3]),
        ("cook-torrance-1982", "alpha", &[0.07]), ("ashikhmin-shirley", "nu", &[10.0, 1000.0]),
    ];
    for (id, key, values) in sets {
        for a in *values {
            let m = Counted(model(id, &[(key, *a)]), Default::default());
            for mu in [0.0, 1e-3, 0.05, 0.5, 1.0] {
                for target in [3e-5, 1e-7] {
                    let f = [Functional::One];
                    let Ok(base) = integrate(&*m.0, mu, &f, target * 0.1) else { continue };
                    let w = Wanted { model: &m, view: View::from(mu), flux: Flux::Reflected, functionals: &f, eta: if id.contains("dielectric") { *a } else { f64::NAN }, target };
                    let t0 = Instant::now();
                    m.1.store(0, std::sync::atomic::Ordering::Relaxed);
                    let s = w.sum(false);
                    let n = m.1.load(std::sync::atomic::Ordering::Relaxed);
                    let t1 = Instant::now();
                    let d = |x: f64| (x - base.value[0]).abs();
                    let flag = |dd: f64, e: f64| if dd > e + base.error[0] { "!!" } else { "" };
                    println!("{id:18} {a:7} mu {mu:6} t {target:e} E {:.10} +-{:.0e} n {} | H d {:.0e} e {:.0e} {n} {:.2} ms {}",
                        base.value[0], base.error[0], base.evaluations, d(s.value[0]), s.error[0], (t1 - t0).as_secs_f64() * 1e3, flag(d(s.value[0]), s.error[0]));
                }
            }
        }
    }
}
