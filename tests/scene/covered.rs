//! Texels that meshes cover: triangles against a sampler that is asked at many points, and accessors of every kind by hand.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "places in small pictures, and codes of small types"
)]

use brdfbake::picture::{Covered, Wrap, write_png};
use brdfbake::plan::scene::{SurveyOptions, Texels, survey};
use brdfbake::scene::{LeftOutKind, Needs};
use brdfbake::verify::seeds::Seeds;
use std::collections::BTreeSet;

#[test]
fn triangles_read_what_a_sampler_reads() {
    let mut seeds = Seeds::new(11);
    for round in 0..60 {
        let size = [3 + round % 7, 2 + round % 5];
        let wrap = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][round % 3];
        let linear = round % 2 == 0;
        let corners = [(); 3].map(|()| [(); 2].map(|()| seeds.unit() * 2.6 - 0.8));
        let mut covered = Covered::new(size, [wrap; 2], linear, 1 << 20);
        covered.mark(&corners).unwrap();
        let found: BTreeSet<usize> = (0..size[0] * size[1]).filter(|i| covered.has(*i)).collect();
        assert_eq!(found.len(), covered.len());
        let mut read = BTreeSet::new();
        for _ in 0..40_000 {
            let (a, b) = (seeds.unit(), seeds.unit());
            let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            let [x, y] = [0, 1].map(|c| {
                let [p, q, r] = corners.map(|corner| corner[c]);
                let at = (p + a * (q - p) + b * (r - p)) * size[c] as f64 - if linear { 0.5 } else { 0.0 };
                let first = at.floor() as i64;
                (first..=first + i64::from(linear)).map(|i| wrap.at(i, size[c])).collect::<Vec<_>>()
            });
            read.extend(y.iter().flat_map(|y| x.iter().map(move |x| y * size[0] + x)));
        }
        assert!(read.is_subset(&found), "round {round}: {read:?} against {found:?}");
        // a texel of which a corner has a hundred-thousandth may not have been drawn
        assert!(found.len() - read.len() <= 1, "round {round}: {read:?} against {found:?}");
    }
}

/// A scene of one primitive: accessors and views as text, the bytes of its buffer.
struct Case<'a> {
    bytes: Vec<u8>,
    accessors: &'a str,
    views: &'a str,
    /// Of the primitive, behind its material.
    primitive: &'a str,
    /// The texture: 0 is read at the nearest texel, 1 as its sampler pleases.
    index: usize,
    /// Of the textureInfo, behind its index.
    texture: &'a str,
    more: &'a str,
}

const PLAIN: Case<'static> = Case {
    bytes: Vec::new(),
    accessors: r#"{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2" }"#,
    views: r#"{ "buffer": 0, "byteLength": 24 }"#,
    primitive: r#""attributes": { "NORMAL": 9, "TEXCOORD_0": 0 }"#,
    index: 0,
    texture: "",
    more: "",
};

/// Code of texel `i` of 4 x 4.
fn code(i: usize) -> u8 {
    10 + 15 * i as u8
}

/// Inside texel 5.
const IN_FIVE: [f32; 6] = [0.3, 0.3, 0.45, 0.3, 0.3, 0.45];

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

fn needs(case: &Case<'_>) -> Needs {
    let folder = tempfile::tempdir().unwrap();
    let codes: Vec<u8> = (0..16).flat_map(|i| [0, code(i), 255]).collect();
    std::fs::write(folder.path().join("mr.png"), write_png([4, 4], 3, &codes).unwrap()).unwrap();
    std::fs::write(folder.path().join("a.bin"), &case.bytes).unwrap();
    let Case { bytes, accessors, views, primitive, index, texture, more } = case;
    let text = format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "accessors": [{accessors}], "bufferViews": [{views}],
            "buffers": [{{ "uri": "a.bin", "byteLength": {} }}], "images": [{{ "uri": "mr.png" }}],
            "samplers": [{{ "magFilter": 9728, "minFilter": 9984 }}], "textures": [{{ "source": 0, "sampler": 0 }}, {{ "source": 0 }}],
            "materials": [{{ "pbrMetallicRoughness": {{ "metallicRoughnessTexture": {{ "index": {index} {texture} }} }} }}],
            "meshes": [{{ "primitives": [{{ "material": 0, {primitive} }}] }}] {more} }}"#,
        bytes.len()
    );
    let file = folder.path().join("a.gltf");
    std::fs::write(&file, text).unwrap();
    let options = SurveyOptions { texels: Texels::Referenced, ..SurveyOptions::default() };
    survey(&[file], &options).unwrap().needs
}

/// Levels of the roughness texture that count, as codes.
fn codes(needs: &Needs) -> [u8; 2] {
    let ggx = needs.needs.iter().find(|n| n.table == "ggx").unwrap();
    let range = &ggx.ranges["roughness"];
    [range.lo, range.hi].map(|v| (v * 255.0).round() as u8)
}

#[track_caller]
fn covers(case: &Case<'_>, [first, last]: [usize; 2]) {
    let found = needs(case);
    assert_eq!(codes(&found), [code(first), code(last)], "{:?}", found.left_out);
    assert!(!found.in_doubt(), "{:?}", found.left_out);
    // one level is one value
    let why = &found.needs[0].asked_by[0].why;
    assert_eq!(first != last, why.contains("where the mesh covers it"), "{why}");
}

/// Component type, whether it is divided by its largest, what 1 is, and the bytes of a number.
type Quantised = (u32, bool, f64, fn(f64) -> Vec<u8>);

#[test]
fn texture_coordinates_of_every_type_are_read() {
    covers(&Case { bytes: floats(&IN_FIVE), ..PLAIN }, [5, 5]);
    // integers, divided by their largest or, by KHR_mesh_quantization, scaled by the transform; every second element is not read
    let typed = |component: u32, normalized: bool| {
        let (n, more) =
            (if normalized { ", \"normalized\": true" } else { "" }, "\"count\": 3, \"type\": \"VEC2\"");
        format!(r#"{{ "bufferView": 0, "byteOffset": 4, "componentType": {component}{n}, {more} }}"#)
    };
    let scaled = r#", "extensions": { "KHR_texture_transform": { "scale": [0.01, 0.01] } }"#;
    let quantised: [Quantised; 6] = [
        (5120, true, 127.0, |v| vec![v as i8 as u8]),
        (5121, true, 255.0, |v| vec![v as u8]),
        (5122, true, 32767.0, |v| (v as i16).to_le_bytes().into()),
        (5123, true, 65535.0, |v| (v as u16).to_le_bytes().into()),
        (5120, false, 100.0, |v| vec![v as i8 as u8]),
        (5123, false, 100.0, |v| (v as u16).to_le_bytes().into()),
    ];
    for (component, normalized, most, bytes_of) in quantised {
        let pair = |uv: &[f32]| -> Vec<u8> {
            uv.iter().flat_map(|v| bytes_of((f64::from(*v) * most).round())).collect()
        };
        let mut bytes = vec![0xff; 4];
        for uv in IN_FIVE.chunks(2) {
            bytes.extend(pair(uv));
            bytes.resize(bytes.len().next_multiple_of(4), 0xff);
            bytes.extend([0xff; 4]);
        }
        let views = format!(r#"{{ "buffer": 0, "byteLength": {}, "byteStride": 8 }}"#, bytes.len());
        let accessors = typed(component, normalized);
        let texture = if normalized { "" } else { scaled };
        covers(&Case { bytes, accessors: &accessors, views: &views, texture, ..PLAIN }, [5, 5]);
    }
}

#[test]
fn indices_modes_and_sparse_elements_are_followed() {
    // vertex 3 lies in texel 15 and is named by nothing, by an index, or by the mode
    let mut bytes = floats(&IN_FIVE);
    bytes.extend(floats(&[0.9, 0.9]));
    let four = r#"{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2" }"#;
    let views = r#"{ "buffer": 0, "byteLength": 32 }"#;
    let of = Case { bytes: bytes.clone(), accessors: four, views, ..PLAIN };
    covers(&of, [5, 5]);
    let mode = |mode: u32| format!(r#"{}, "mode": {mode}"#, PLAIN.primitive);
    for (number, last) in [(4, 5), (5, 15), (6, 15), (0, 15), (1, 15), (2, 15), (3, 15)] {
        let primitive = mode(number);
        covers(&Case { bytes: bytes.clone(), primitive: &primitive, ..of }, [5, last]);
    }
    for (component, index) in [(5121, vec![3]), (5123, vec![3, 0]), (5125, vec![3, 0, 0, 0])] {
        let mut all = bytes.clone();
        (0..3).for_each(|_| all.extend(&index));
        let accessors = format!(
            r#"{four}, {{ "bufferView": 1, "componentType": {component}, "count": 3, "type": "SCALAR" }}"#
        );
        let views =
            format!(r#"{views}, {{ "buffer": 0, "byteOffset": 32, "byteLength": {} }}"#, 3 * index.len());
        let primitive = format!(r#"{}, "indices": 1"#, PLAIN.primitive);
        covers(
            &Case { bytes: all, accessors: &accessors, views: &views, primitive: &primitive, ..PLAIN },
            [15, 15],
        );
    }
    // zeros but for elements 0 and 2, of which the first goes to texel 15 and the last to texel 5: a line through texel 0
    let mut sparse = vec![0, 2];
    sparse.extend([0; 2]);
    sparse.extend(floats(&[0.9, 0.9, 0.3, 0.3]));
    let accessors = r#"{ "componentType": 5126, "count": 3, "type": "VEC2", "sparse": { "count": 2,
        "indices": { "bufferView": 0, "componentType": 5121 }, "values": { "bufferView": 1 } } }"#;
    let views = r#"{ "buffer": 0, "byteLength": 2 }, { "buffer": 0, "byteOffset": 4, "byteLength": 16 }"#;
    covers(&Case { bytes: sparse, accessors, views, ..PLAIN }, [0, 15]);
}

#[test]
fn transforms_sets_and_samplers_decide_where_a_texture_is_read() {
    let with = |texture: &str, wanted| covers(&Case { bytes: floats(&IN_FIVE), texture, ..PLAIN }, wanted);
    with(r#", "extensions": { "KHR_texture_transform": { "offset": [0.5, -0.25] } }"#, [3, 3]);
    with(r#", "extensions": { "KHR_texture_transform": { "scale": [2, 1] } }"#, [6, 7]);
    // a quarter turn counter-clockwise where v points down: (u, v) to (v, -u), and -0.3 is 0.7
    with(r#", "extensions": { "KHR_texture_transform": { "rotation": 1.5707963267948966 } }"#, [9, 9]);
    // another set, named by the texture or by its transform
    let mut bytes = floats(&IN_FIVE);
    bytes.extend(floats(&[0.9; 6]));
    let accessors = r#"{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2" },
        { "bufferView": 0, "byteOffset": 24, "componentType": 5126, "count": 3, "type": "VEC2" }"#;
    let primitive = r#""attributes": { "NORMAL": 9, "TEXCOORD_0": 0, "TEXCOORD_1": 1 }"#;
    for texture in [
        r#", "texCoord": 1"#,
        r#", "texCoord": 0, "extensions": { "KHR_texture_transform": { "texCoord": 1 } }"#,
    ] {
        let views = r#"{ "buffer": 0, "byteLength": 48 }"#;
        covers(&Case { bytes: bytes.clone(), accessors, views, primitive, texture, ..PLAIN }, [15, 15]);
    }
    // a sampler that says nothing mixes the texels around: from a fifth of the way beyond the centre of texel 5 on, 5, 6, 9 and 10
    let inner = [0.42, 0.42, 0.45, 0.42, 0.42, 0.45];
    covers(&Case { bytes: floats(&inner), ..PLAIN }, [5, 5]);
    covers(&Case { bytes: floats(&inner), index: 1, ..PLAIN }, [5, 10]);
}

#[test]
fn where_coordinates_are_not_known_the_whole_image_counts() {
    let unknown = |case: &Case<'_>, told: &str| {
        let found = needs(case);
        assert_eq!(codes(&found), [code(0), code(15)], "{told}");
        let left = found.left_out.iter().find(|l| l.kind == LeftOutKind::Unknown);
        let why = &left.unwrap_or_else(|| panic!("{told}: {:?}", found.left_out)).why;
        assert!(why.contains("the whole image counts") && why.contains(told), "{told}: {why}");
    };
    let bytes = || floats(&IN_FIVE);
    let primitive = r#""attributes": { "TEXCOORD_0": 0 }, "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0 } }"#;
    let accessors = r#"{ "componentType": 5126, "count": 3, "type": "VEC2" }"#;
    unknown(&Case { bytes: bytes(), accessors, primitive, ..PLAIN }, "KHR_draco_mesh_compression");
    let views = r#"{ "buffer": 0, "byteLength": 24, "extensions": { "EXT_meshopt_compression": {} } }"#;
    unknown(&Case { bytes: bytes(), views, ..PLAIN }, "EXT_meshopt_compression");
    unknown(&Case { bytes: bytes(), primitive: r#""attributes": {}"#, ..PLAIN }, "TEXCOORD_0");
    let primitive = r#""attributes": { "TEXCOORD_0": 0 }, "targets": [{ "TEXCOORD_0": 0 }]"#;
    unknown(&Case { bytes: bytes(), primitive, ..PLAIN }, "morph targets");
    let more = r#", "animations": [{ "channels": [{ "target": { "extensions": { "KHR_animation_pointer": {
        "pointer": "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/extensions/KHR_texture_transform/offset" } } } }] }]"#;
    unknown(&Case { bytes: bytes(), more, ..PLAIN }, "animated");
    let mut indexed = bytes();
    indexed.extend([0, 1, 3]);
    let accessors = format!(
        r#"{}, {{ "bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR" }}"#,
        PLAIN.accessors
    );
    let views = r#"{ "buffer": 0, "byteLength": 24 }, { "buffer": 0, "byteOffset": 24, "byteLength": 3 }"#;
    let primitive = r#""attributes": { "TEXCOORD_0": 0 }, "indices": 1"#;
    unknown(&Case { bytes: indexed, accessors: &accessors, views, primitive, ..PLAIN }, "index 3");
    let nan = [f32::NAN, 0.3, 0.4, 0.4, 0.3, 0.4];
    unknown(&Case { bytes: floats(&nan), ..PLAIN }, "finite");
    unknown(&Case { bytes: bytes()[..23].to_vec(), ..PLAIN }, "bytes 0 to 24 of a file of 23");
    let accessors =
        r#"{ "bufferView": 0, "componentType": 5126, "count": 9999999999999999999, "type": "VEC2" }"#;
    unknown(&Case { bytes: bytes(), accessors, ..PLAIN }, "do not fit");
    let accessors = r#"{ "componentType": 5126, "count": 18446744073709551615, "type": "VEC2" }"#;
    unknown(&Case { bytes: bytes(), accessors, ..PLAIN }, "too many");
    for (accessors, told) in [
        (r#"{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }"#, "VEC2"),
        (r#"{ "bufferView": 7, "componentType": 5126, "count": 3, "type": "VEC2" }"#, "bufferViews"),
        (r#"{ "bufferView": 0, "componentType": 5130, "count": 3, "type": "VEC2" }"#, "5126"),
        ("", "accessors"),
    ] {
        unknown(&Case { bytes: bytes(), accessors, ..PLAIN }, told);
    }
}
