//! A reflectance model of your own, integrated by the rules of the library: `cargo run --release --example custom_model`.
//!
//! A model is a value of f and a way to draw directions. Its chart is optional: without one the hemisphere is subdivided, which is
//! slower and as exact.

#![allow(clippy::print_stdout, reason = "an example")]

use brdfbake::models::{Brdf, Chart, Sample, View};
use brdfbake::tables::integral::{Functional, integrate};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Minnaert's law of the Moon: f = (mu_o mu_i)^(k - 1) / pi.
#[derive(Debug)]
struct Moon {
    k: f64,
}

impl Brdf for Moon {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if wo.z <= 0.0 || wi.z <= 0.0 { 0.0 } else { libm::pow(wo.z * wi.z, self.k - 1.0) / PI }
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let radius = u.x.sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * u.y);
        let wi = DVec3::new(radius * cos, radius * sin, (1.0 - u.x).sqrt());
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, _: DVec3, wi: DVec3) -> f64 {
        wi.z.max(0.0) / PI
    }

    fn chart(&self) -> Option<Chart> {
        None
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let moon = Moon { k: 1.5 };
    for mu in [1.0, 0.5, 0.1] {
        let e = integrate(&moon, View { mu, phi: 0.0 }, &[Functional::One], 1e-6)?;
        // 2 mu^(k - 1) / (k + 1)
        let exact = 2.0 * libm::pow(mu, moon.k - 1.0) / (moon.k + 1.0);
        println!("E({mu}) = {:.8} +- {:.1e}, in closed form {exact:.8}", e.value[0], e.error[0]);
    }
    Ok(())
}
