//! Helpers shared by test files.
#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::print_stderr,
    missing_docs,
    reason = "each test file uses a part"
)]

use brdfbake::cancel::Cancel;
use brdfbake::grid::{Axis, Quantity, Table, Texel};
use brdfbake::tables::driver::{self, BakeError, OnMiss, Options};
use brdfbake::tables::spec::{Bound, Request};
use std::path::PathBuf;

/// The folder of shared reference values, if `BRDFBAKE_SHARED` names it; says so if not.
pub(crate) fn shared() -> Option<PathBuf> {
    let dir = std::env::var_os("BRDFBAKE_SHARED").map(PathBuf::from);
    if dir.is_none() {
        eprintln!("SKIPPED: set BRDFBAKE_SHARED to the folder of shared reference values to run this test");
    }
    dir
}

/// Reads a little-endian f64 `.npy` file: shape and values in C order.
pub(crate) fn npy(path: &std::path::Path) -> (Vec<usize>, Vec<f64>) {
    let bytes = std::fs::read(path).unwrap();
    let header_len = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(&bytes[10..10 + header_len]).unwrap();
    assert!(header.contains("<f8"), "{header}");
    let shape = header.split("'shape': (").nth(1).unwrap().split(')').next().unwrap();
    let shape = shape.split(',').filter_map(|s| s.trim().parse().ok()).collect();
    let values =
        bytes[10 + header_len..].chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
    (shape, values)
}

pub(crate) fn axis(id: &str, len: usize, texel: Texel) -> Axis {
    Axis::new(Quantity::find(id).unwrap(), len, texel)
}

pub(crate) fn request(kind: &str, layout: &str, params: &str, axes: Vec<Axis>) -> Bound {
    let request = Request {
        kind: kind.to_owned(),
        layout: Some(layout.to_owned()),
        params: serde_json::from_str(params).unwrap(),
        axes: Some(axes),
        ..Request::default()
    };
    request.bind().unwrap()
}

pub(crate) fn bake(bound: &Bound, tolerance: f64) -> Result<Table, BakeError> {
    let cancel = Cancel::new();
    driver::bake(bound, Options { tolerance, on_miss: OnMiss::Fail, cancel: &cancel, progress: &|_| {} })
}
