//! Texels as reflectance: models in the frames that a normal and a direction of a map tell, and lobes that are divided by their integral.

use super::sbrdf::{CosineLobe, Divided, Normalise};
use crate::math::frame;
use crate::models::lobes::{Cosine, Over};
use crate::models::{Brdf, Chart, Sample, View};
use glam::{DVec2, DVec3};

/// A model in the frame of a texel: `axes` are its tangent, bitangent and normal in that of the mesh.
///
/// f is 0 where a direction is below the mesh or below the normal. A draw about a tilted normal may fall below the mesh.
#[derive(Debug)]
pub struct Turned {
    axes: [DVec3; 3],
    model: Box<dyn Brdf>,
}

impl Turned {
    /// The model, in these axes; as it is where they are those of the mesh.
    #[must_use]
    pub fn within(axes: [DVec3; 3], model: Box<dyn Brdf>) -> Box<dyn Brdf> {
        if axes == [DVec3::X, DVec3::Y, DVec3::Z] { model } else { Box::new(Turned { axes, model }) }
    }

    fn inside(&self, w: DVec3) -> DVec3 {
        let [t, b, n] = self.axes;
        DVec3::new(t.dot(w), b.dot(w), n.dot(w))
    }

    fn outside(&self, w: DVec3) -> DVec3 {
        let [t, b, n] = self.axes;
        t * w.x + b * w.y + n * w.z
    }
}

impl Brdf for Turned {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.model.eval(self.inside(wo), self.inside(wi)) } else { 0.0 }
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wi = self.outside(self.model.sample(self.inside(wo), u)?.wi);
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.model.pdf(self.inside(wo), self.inside(wi)) } else { 0.0 }
    }

    /// None: charts stand about the normal of the mesh.
    fn chart(&self) -> Option<Chart> {
        None
    }

    fn turns(&self) -> bool {
        true
    }
}

/// A lobe over its own integral at the direction of the light: `max(0, C wi . wo)^n / N(wi)`; not reciprocal.
///
/// |C wi|ⁿ cancels, so that no power of a length is taken.
#[derive(Debug)]
pub struct Incident {
    lobe: CosineLobe,
    /// Draws, and the chart.
    shape: Cosine,
}

impl Incident {
    /// The lobe of this shape.
    #[must_use]
    pub fn new(lobe: CosineLobe) -> Incident {
        Incident { lobe, shape: Cosine { c: lobe.c, n: lobe.n, scale: 1.0, over: Over::Nothing } }
    }
}

impl Brdf for Incident {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        Divided::new(self.lobe, Normalise::Incident).from(wi)(wo)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        self.shape.sample(wo, u)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.shape.pdf(wo, wi)
    }

    fn chart(&self) -> Option<Chart> {
        self.shape.chart()
    }

    fn rounding(&self, view: View) -> f64 {
        self.shape.rounding(view)
    }

    fn turns(&self) -> bool {
        self.shape.turns()
    }
}
