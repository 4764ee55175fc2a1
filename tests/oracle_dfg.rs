//! Every texel of the split-sum tables against independent integrals (good to 1e-12): below the tolerance asked for,
//! and below the estimate reported.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, reason = "test")]

use crate::common::{axis, bake, npy, request, shared};
use brdfbake::grid::{Axis, Texel};

const TOLERANCES: [f64; 4] = [1e-2, 2.4e-4, 1e-6, 1e-9];

fn check(name: &str, layout: &str, params: &str, axes: &[Axis], channels: [usize; 2], reference: &[f64]) {
    let bound = request("dfg", layout, params, axes.to_vec());
    for tolerance in TOLERANCES {
        let table = bake(&bound, tolerance).unwrap_or_else(|e| panic!("{name} at {tolerance:e}: {e}"));
        let (mut largest, mut dishonest, mut ratio) = (0.0f64, 0, 0.0f64);
        let texels = table.values.len() / 2;
        for t in 0..texels {
            let mut ok = true;
            for (c, r) in channels.iter().enumerate() {
                let error = (table.values[2 * t + c] - reference[2 * t + r]).abs();
                largest = largest.max(error);
                // the references themselves are good to 1e-12
                let estimate = table.errors[2 * t + c] + 1e-12;
                ok &= error <= estimate;
                ratio = ratio.max(error / estimate);
            }
            dishonest += usize::from(!ok);
        }
        println!(
            "{name} {layout} {tolerance:.1e}: largest error {largest:.1e}, {dishonest} of {texels} above the estimate (worst {ratio:.2} x), {:.0} evaluations a texel",
            table.total_evaluations() as f64 / texels as f64
        );
        assert!(largest <= tolerance, "{name} {layout}: largest error {largest:e} > {tolerance:e}");
        assert!(
            dishonest * 100 <= texels,
            "{name} {layout} {tolerance:e}: {dishonest} of {texels} dishonest"
        );
        assert!(ratio <= 10.0, "{name} {layout} {tolerance:e}: an error is {ratio} times its estimate");
    }
}

#[test]
fn tables_agree_with_independent_integrals() {
    let Some(shared) = shared() else { return };
    let dir = shared.join("oracles/dfg");
    for n in [32, 128] {
        let axes = [axis("mu", n, Texel::Center), axis("roughness", n, Texel::Center)];
        let (_, ss) = npy(&dir.join(format!("dfg_ss_{n}.npy")));
        check("centres", "scale-bias", "{}", &axes, [0, 1], &ss);
        let (_, ms) = npy(&dir.join(format!("dfg_ms_{n}.npy")));
        check("centres", "multiscatter", "{}", &axes, [0, 1], &ms);
    }
}

#[test]
fn tables_agree_at_the_texels_of_other_programs() {
    let Some(shared) = shared() else { return };
    let dir = shared.join("oracles/dfg");
    // every reference here is (E, B), the multiscatter layout is (B, E)
    let mut fil = [axis("mu", 64, Texel::Center), axis("roughness", 64, Texel::Center)];
    fil[1].offset = 1.0;
    check(
        "one texel off in roughness",
        "multiscatter",
        "{}",
        &fil,
        [1, 0],
        &npy(&dir.join("fil_ref_64.npy")).1,
    );

    let mut cyc = [axis("mu", 32, Texel::Endpoint), axis("roughness", 32, Texel::Endpoint)];
    for a in &mut cyc {
        a.clamp = Some([1e-4, 1.0]);
    }
    let (shape, values) = npy(&dir.join("cyc_ref.npy"));
    assert_eq!(shape, [32, 32, 2]);
    check("endpoints clamped at 1e-4", "multiscatter", "{}", &cyc, [1, 0], &values);

    let mi = [axis("mu", 128, Texel::Center), axis("roughness", 128, Texel::Center)];
    let separable = r#"{"masking": "separable"}"#;
    check("separable Smith", "multiscatter", separable, &mi, [1, 0], &npy(&dir.join("mi_ref_128.npy")).1);
}
