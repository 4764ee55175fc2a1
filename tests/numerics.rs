//! Numbers or files that change raise their version: what was baked before is then baked anew, in folders and caches.
#![allow(clippy::unwrap_used, reason = "test")]

use crate::laws::bake;
use crate::sample;
use brdfbake::encode::{ENCODERS, Encoder, Storage};
use brdfbake::grid::{Axis, Grid};
use brdfbake::models::{MODELS, Params};
use brdfbake::plan::identity::NUMERICS;
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::tables::spec::Request;
use brdfbake::tables::{Bound, TABLES};
use rayon::prelude::*;
use std::path::Path;

/// Wide, so that it is quick: which rule is taken shows at any tolerance.
const TOLERANCE: f64 = 1e-2;

/// A small table in every container and storage.
fn files() -> Vec<Vec<u8>> {
    let table = sample::table(&["v"], |_, x| x);
    let of = |encoder: &&'static dyn Encoder| {
        let file = |storage: &Storage| {
            let provenance = sample::provenance(&table, *storage);
            sample::file(*encoder, &table, *storage, &provenance)
        };
        encoder.storages().iter().map(file).collect::<Vec<_>>()
    };
    // the binary of the MERL database has one size, of 33 MB, and is nothing but numbers
    ENCODERS.iter().filter(|e| e.id() != "merl").flat_map(of).collect()
}

/// Texels of every kind at the corners of its default axes, and E of every model, as bits; and files.
fn numbers() -> blake3::Hash {
    let kinds: Vec<Vec<f64>> = TABLES
        .par_iter()
        .map(|kind| {
            let mut spec = Request { kind: kind.id.to_owned(), ..Request::default() }.bind().unwrap().spec;
            let short = |a: &Axis| Axis { len: 2, ..a.clone() };
            spec.grid = Grid::new(spec.grid.axes().iter().map(short).collect()).unwrap();
            let baker = (spec.kind.bind)(&spec).unwrap();
            let table = bake(&Bound { spec, baker }, TOLERANCE);
            [table.values, table.errors].concat()
        })
        .collect();
    let models: Vec<Vec<f64>> = MODELS
        .par_iter()
        .map(|info| {
            let model = (info.build)(&Params::resolve(info.id, info.params, []).unwrap()).unwrap();
            let at = |mu: f64| integrate(&*model, mu, &[Functional::One], 1e-4);
            [0.05, 0.7]
                .into_iter()
                .filter_map(|mu| at(mu).ok())
                .flat_map(|e| [e.value[0], e.error[0]])
                .collect()
        })
        .collect();
    let mut hasher = blake3::Hasher::new();
    for values in kinds.iter().chain(&models) {
        for v in values {
            hasher.update(&v.to_bits().to_le_bytes());
        }
        hasher.update(b"|");
    }
    files().iter().for_each(|bytes| {
        hasher.update(bytes);
    });
    hasher.finalize()
}

#[test]
fn numbers_that_change_have_another_version() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/values/numerics.txt");
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let now = numbers().to_hex().to_string();
    let of_version = kept.lines().find_map(|l| l.strip_prefix(&format!("{NUMERICS} ")));
    match of_version {
        Some(hash) => assert_eq!(
            hash, now,
            "texels, errors or files have changed, and their version has not: raise NUMERICS in src/plan/identity.rs, then\n\
             BLESS=1 cargo test --test baked numbers_that_change"
        ),
        None if std::env::var_os("BLESS").is_some() => {
            std::fs::write(&path, format!("{kept}{NUMERICS} {now}\n")).unwrap();
        }
        None => {
            panic!("tests/values/numerics.txt has no line for version {NUMERICS}: add `{NUMERICS} {now}`")
        }
    }
}
