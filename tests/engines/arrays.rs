//! Tables that an engine puts into one array: Bevy's area lights in one file, Ogre-Next's three files.

use crate::common::shared;
use crate::engines::compare::{Case, HALF, agree, ltc, not_worse, samples, size, truth};
use crate::engines::support::{Texture, bake, npy, picture, plan};
use crate::tolerance::{
    LOOKED_UP, NARROW_LIGHT_WEIGHT, NOTHING_LEANS, QUOTED_DIGITS_FOUR, QUOTED_DIGITS_THREE,
};
use brdfbake::encode::read;
use brdfbake::recipe::parse;

/// Rows of a layer of a picture whose layers are stacked.
fn layer(all: &Texture, index: usize) -> Texture {
    let height = all.width;
    let row = all.width * all.channels;
    let values = all.values[index * height * row..(index + 1) * height * row].to_vec();
    Texture::new(all.width, height, all.channels, values)
}

#[test]
fn bevy_area_lights() {
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan("bevy", |t| t.starts_with("bevy-ltc")), out.path());
    assert_eq!(files[0], files[1], "both tables in one file");
    assert!(files[0].ends_with("ltc.ktx2"));
    let bytes = std::fs::read(&files[0]).unwrap();
    let reader = ktx2::Reader::new(&bytes).unwrap();
    let header = reader.header();
    assert_eq!(header.format, Some(ktx2::Format::R16G16B16A16_SFLOAT));
    let told = (header.pixel_width, header.pixel_height, header.pixel_depth, header.layer_count);
    assert_eq!(told, (64, 64, 0, 2));
    assert_eq!(header.supercompression_scheme, Some(ktx2::SupercompressionScheme::Zstandard));
    let all = picture(&files[0], 4);
    assert_eq!((all.width, all.height), (64, 128));
    let [matrices, magnitudes] = [layer(&all, 0), layer(&all, 1)];
    // rough and along the normal nothing leans, whatever the fit
    let [m11, m31, m13, m33] = matrices.texel(63, 0).try_into().unwrap();
    assert!(m11 > 0.5 && m33 > 0.5 && f64::abs(m31) < NOTHING_LEANS && f64::abs(m13) < NOTHING_LEANS);
    // smooth and along the normal: everything is reflected
    assert!(
        (magnitudes.texel(0, 0)[0] - 1.0).abs() < NARROW_LIGHT_WEIGHT
            && magnitudes.texel(0, 0)[1].abs() < NARROW_LIGHT_WEIGHT
    );
    let Some(dir) = shared() else { return };
    let values = npy(&dir.join("oracles/engines/bevy/ltc_half.npy"));
    let shipped = Texture::new(64, 128, 4, values);
    let bounds = [[6.6e-2, HALF], [2.9e-2, HALF], [0.0, 0.0], [3e-6, HALF]];
    let own = samples(plan("bevy", |t| t.starts_with("bevy-ltc")), |file| picture(file, 4));
    agree("bevy ltc magnitude", &layer(&shipped, 1), &layer(&own, 1), &bounds);
    let case = Case {
        name: "bevy ltc magnitude",
        kind: "ltc-magnitude",
        channels: &["ltc.magnitude", "ltc.fresnel"],
        at: ltc,
        luck: 1.0,
    };
    not_worse(&case, &layer(&shipped, 1), &magnitudes, size(&files[0]), 0.0);
}

#[test]
fn ogre_next() {
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan("ogre-next", |t| t != "ogre-next-ltc-matrix"), out.path());
    assert!(files[0].ends_with("ltcMatrix1.dds") && files[1].ends_with("brtfLutDfg.dds"));
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        let dds = dds_info(&bytes);
        assert_eq!(dds, (64, 64, 10), "64 x 64, DXGI_FORMAT_R16G16B16A16_FLOAT: all three share an array");
    }
    let table = picture(&files[1], 3);
    let read = |mu: f64, r: f64| table.sample([mu, 1.0 - r]);
    // the blue channel of the shipped table, as others who fitted it tell: its means over cosines at both ends of roughness
    let mean = |r: f64| {
        let n = 4096;
        let mid = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        (0..n).map(|i| 2.0 * mid(i) * read(mid(i), r)[2] / f64::from(n)).sum::<f64>()
    };
    let told = [mean(0.0), mean(1.0)];
    assert!(
        (told[0] - 0.905).abs() < QUOTED_DIGITS_THREE && (told[1] - 0.702).abs() < QUOTED_DIGITS_FOUR,
        "{told:?}"
    );
    let bound = truth("dfg", &["dfg.scale", "dfg.bias"]);
    for (mu, r) in [(0.3, 0.4), (0.7, 0.2), (0.55, 0.9)] {
        // the rows are one texel too rough
        let r_held = r + 1.0 / 64.0;
        let exact = bound.baker.texel(&[mu, r_held * r_held], 1e-7).unwrap().value;
        let got = read(mu, r);
        assert!(
            (got[0] - exact[0]).abs() < LOOKED_UP && (got[1] - exact[1]).abs() < LOOKED_UP,
            "{mu} {r}: {got:?}"
        );
    }
}

/// Width, height and DXGI format of a file with the DX10 header.
fn dds_info(bytes: &[u8]) -> (u32, u32, u32) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    (word(16), word(12), word(128))
}

/// Two tables of one file, with these keys each.
fn two(a: &str, b: &str) -> String {
    let table = |name: &str, keys: &str| {
        format!(
            "[[table]]\nkind = 'fresnel-schlick'\nname = '{name}'\nfile = 'x.ktx2'\n{keys}\n\
             [[table.axis]]\nid = 'mu'\nlength = 4\n"
        )
    };
    format!("name = 'x'\n{}{}", table("a", a), table("b", b))
}

#[test]
fn layers_of_a_file_are_alike() {
    let plan = parse(&two("outputs = ['ktx2:half']", "outputs = ['ktx2:half']"), "x.toml").unwrap();
    let out = tempfile::tempdir().unwrap();
    let files = bake(&plan, out.path());
    let image = read::read_file(&files[0]).unwrap();
    assert_eq!((image.width, image.height), (4, 2));
    let values = &image.channels[0].values;
    assert_eq!(values[..4], values[4..], "both layers hold the same");
    let bytes = std::fs::read(&files[0]).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    assert!(
        text.contains("brdfbake\0[{") && text.contains("\"name\":\"a\"") && text.contains("\"name\":\"b\"")
    );
    let message = |a: &str, b: &str| parse(&two(a, b), "x.toml").unwrap_err().to_string();
    for (a, b) in [
        ("outputs = ['ktx2:half']", "outputs = ['ktx2:float']"),
        ("outputs = ['ktx2:half+zstd']", "outputs = ['ktx2:half']"),
    ] {
        assert!(message(a, b).contains("the layers and parts of a file have one size, storage and options"));
    }
    assert!(
        message("outputs = ['png:unorm16']", "outputs = ['png:unorm16']")
            .contains("only containers without a header")
    );
}
