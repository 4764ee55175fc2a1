//! Texels of every table kind: what is asked for, what the product says, and the table of truths.

use crate::sweep::check::Outcome;
use brdfbake::grid::{Axis, Quantity, Texel as Place};
use brdfbake::models::{self, Params};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::tables::{self, ChannelInfo};
use brdfbake::verify::seeds::Seeds;
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::path::Path;

/// A texel that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Texel {
    pub(crate) kind: String,
    pub(crate) layout: String,
    /// Empty for kinds without a model.
    pub(crate) model: String,
    pub(crate) params: Map<String, Value>,
    pub(crate) axes: Vec<String>,
    pub(crate) at: Vec<f64>,
}

/// A texel with the truth of each channel and its error; a channel without a truth has an infinite error.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) texel: Texel,
    pub(crate) truths: Vec<(f64, f64)>,
}

impl Texel {
    /// With axes from pairs of quantity and value.
    pub(crate) fn new(
        kind: &str,
        layout: &str,
        model: &str,
        params: Map<String, Value>,
        at: &[(&str, f64)],
    ) -> Texel {
        Texel {
            kind: kind.to_owned(),
            layout: layout.to_owned(),
            model: model.to_owned(),
            params,
            axes: at.iter().map(|a| a.0.to_owned()).collect(),
            at: at.iter().map(|a| a.1).collect(),
        }
    }

    /// With axes of so many texels; that of Gaussians counts them from 0.
    pub(crate) fn bind_with(&self, len: usize) -> Bound {
        self.bound(len).unwrap()
    }

    pub(crate) fn bind(&self) -> Result<Bound, tables::BindError> {
        self.bound(2)
    }

    fn bound(&self, len: usize) -> Result<Bound, tables::BindError> {
        let axis = |id: &String| {
            let axis = Axis::new(Quantity::find(id).unwrap(), len, Place::Endpoint);
            match (id.as_str(), self.kind.as_str()) {
                ("gaussian", _) => axis.over([0.0, len as f64 - 1.0]),
                // some lobes have no fit at mu = 0, and are refused there
                ("mu", "ltc-matrix") => axis.over([0.01, 1.0]),
                _ => axis,
            }
        };
        let request = Request {
            kind: self.kind.clone(),
            layout: Some(self.layout.clone()),
            model: (!self.model.is_empty()).then(|| self.model.clone()),
            params: self.params.clone(),
            axes: Some(self.axes.iter().map(axis).collect()),
            ..Request::default()
        };
        request.bind()
    }

    pub(crate) fn channels(&self) -> &'static [ChannelInfo] {
        let kind = tables::find(&self.kind).unwrap();
        kind.layouts.iter().find(|l| l.id == self.layout).unwrap().channels
    }

    /// The value on an axis.
    pub(crate) fn axis(&self, id: &str) -> f64 {
        self.axes.iter().position(|a| a == id).map_or(f64::NAN, |i| self.at[i])
    }

    /// A parameter of the kind or the model: from an axis, as given, or its default.
    pub(crate) fn resolved(&self) -> Params {
        let kind = tables::find(&self.kind).unwrap();
        let own = |key: &str| kind.params.iter().any(|p| p.id == key);
        let given = self.params.iter().filter(|(k, _)| own(k)).map(|(k, v)| (k.as_str(), v));
        Params::resolve(kind.id, kind.params, given).unwrap()
    }

    /// The model and its parameters at the texel; white if asked.
    pub(crate) fn draw(&self, white: bool) -> crate::sweep::draw::Draw {
        let (info, _) = models::find(&self.model).unwrap();
        let given: Map<String, Value> = self
            .params
            .iter()
            .filter(|(k, _)| info.param(k).is_some())
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect();
        let pairs = given.iter().map(|(k, v)| (k.as_str(), v));
        let mut params = Params::resolve(info.id, info.params, pairs).unwrap();
        for (id, value) in self.axes.iter().zip(&self.at) {
            // an axis may leave the range of its parameter, and takes along those that follow it
            if id != "mu" && params.set(id, *value) {
                for other in info.followers(id).filter(|other| !given.contains_key(*other)) {
                    params.set(other, *value);
                }
            }
        }
        if white && params.optional("f0").is_some() {
            params.set("f0", 1.0);
            params.set("f90", 1.0);
        }
        let phi = self.axis("phi");
        crate::sweep::draw::Draw {
            model: info,
            params,
            given,
            mu: self.axis("mu"),
            phi: if phi.is_nan() { 0.0 } else { phi },
        }
    }
}

/// A generator that is spoken to in the terms of ranges.
pub(crate) struct Pick(pub(crate) Seeds);

impl Pick {
    pub(crate) fn new(kind: &str, seed: u64, number: u64) -> Pick {
        let mut hash = seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        for byte in kind.bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        Pick(Seeds::new(hash))
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// Uniform, each end in one draw of twelve.
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        match self.0.index(12) {
            0 => lo,
            1 => hi,
            _ => lo + (hi - lo) * self.unit(),
        }
    }

    /// By the logarithm, each end in one draw of twelve.
    pub(crate) fn log(&mut self, lo: f64, hi: f64) -> f64 {
        match self.0.index(12) {
            0 => lo,
            1 => hi,
            _ => (lo * libm::pow(hi / lo, self.unit())).clamp(lo, hi),
        }
    }

    pub(crate) fn one<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.0.index(of.len())]
    }

    pub(crate) fn mu(&mut self) -> f64 {
        crate::sweep::draw::view(&mut self.0)
    }
}

pub(crate) fn read(path: &Path) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let numbers = |text: &str| text.split_whitespace().map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    let row = |record: csv::StringRecord| {
        let texel = Texel {
            kind: record[0].to_owned(),
            layout: record[1].to_owned(),
            model: record[2].to_owned(),
            params: serde_json::from_str(&record[3]).unwrap(),
            axes: record[4].split_whitespace().map(str::to_owned).collect(),
            at: numbers(&record[5]),
        };
        Row { texel, truths: numbers(&record[6]).into_iter().zip(numbers(&record[7])).collect() }
    };
    reader.records().map(|r| row(r.unwrap())).collect()
}

pub(crate) fn write(path: &Path, rows: &[Row]) {
    let mut writer = csv::Writer::from_path(path).unwrap();
    writer
        .write_record(["kind", "layout", "model", "params_json", "axes", "at", "truth", "truth_error"])
        .unwrap();
    let join = |numbers: &mut dyn Iterator<Item = String>| numbers.collect::<Vec<_>>().join(" ");
    for row in rows {
        let t = &row.texel;
        let params = serde_json::to_string(&t.params).unwrap();
        let at = join(&mut t.at.iter().map(|x| format!("{x:e}")));
        let truth = join(&mut row.truths.iter().map(|x| format!("{:e}", x.0)));
        let error = join(&mut row.truths.iter().map(|x| format!("{:.1e}", x.1)));
        writer
            .write_record([&t.kind, &t.layout, &t.model, &params, &t.axes.join(" "), &at, &truth, &error])
            .unwrap();
    }
    writer.flush().unwrap();
}

/// All channels of all rows at all tolerances; `row` of an outcome counts rows.
pub(crate) fn run(rows: &[Row], tolerances: &[f64]) -> Vec<Outcome> {
    let texel = |(number, row): (usize, &Row)| {
        let bound = row.texel.bind().unwrap();
        let mut all = Vec::new();
        for &tolerance in tolerances {
            let e = bound.baker.texel(&row.texel.at, tolerance);
            for (c, (truth, own)) in row.truths.iter().enumerate() {
                if !own.is_finite() {
                    continue;
                }
                let floor = own.max(1e-13 * truth.abs().max(1.0));
                let (error, estimate, evaluations) =
                    e.as_ref().map_or((0.0, 0.0, 0), |e| (e.value[c] - truth, e.error[c], e.evaluations));
                let error = if error.is_finite() { error } else { f64::INFINITY };
                let refused = e.is_err();
                all.push(Outcome { row: number, tolerance, error, floor, estimate, evaluations, refused });
            }
        }
        all
    };
    rows.par_iter().enumerate().flat_map_iter(texel).collect()
}

/// `kind layout`, and the model where it is not the default.
pub(crate) fn label(row: &Row) -> String {
    let t = &row.texel;
    format!("{} {}", t.kind, t.layout)
}

/// The texel in words.
pub(crate) fn words(row: &Row) -> String {
    let t = &row.texel;
    let at: Vec<String> = t.axes.iter().zip(&t.at).map(|(id, x)| format!("{id}={x:e}")).collect();
    format!(
        "{} {} {} {} at {}",
        t.kind,
        t.layout,
        t.model,
        serde_json::to_string(&t.params).unwrap(),
        at.join(" ")
    )
}
