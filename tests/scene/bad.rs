//! Refused files: one fixture a fault, whose name says it, with the exact message.

use std::collections::BTreeSet;

use brdfbake::scene::{Limits, analyse, read, read_slice};
use proptest::prelude::*;

use super::fixture;

/// File, and its message without the file's name at the end.
const REFUSED: &[(&str, &str)] = &[
    (
        "a_png.gltf",
        r#"not a glTF file: it starts with "\x89PNG\r\n\x1a\n", expected the magic "glTF" or '{'"#,
    ),
    ("asset_missing.gltf", "missing: asset, expected an object with the version"),
    (
        "clearcoat_out_of_range.gltf",
        "out of range: materials[0].extensions.KHR_materials_clearcoat.clearcoatFactor = 2.0, allowed [0, 1]",
    ),
    ("cut_short.gltf", "bad JSON at materials[0], line 1 column 61: EOF while parsing an object"),
    ("duplicate_key.gltf", "duplicate key: materials[0].name is given twice"),
    ("empty.gltf", "the JSON text is empty"),
    (
        "extension_not_an_object.gltf",
        "wrong type: materials[0].extensions.KHR_materials_sheen is the boolean true, expected an object",
    ),
    ("glb_bin_first.glb", "GLB chunk of type BIN, expected JSON as the first chunk"),
    ("glb_bin_too_long.glb", "GLB chunk BIN declares 400 bytes, allowed 4; the file is cut or forged"),
    ("glb_json_chunk_empty.glb", "the JSON text is empty"),
    (
        "glb_json_chunk_too_long.glb",
        "GLB chunk JSON declares 4294967280 bytes, allowed 28; the file is cut or forged",
    ),
    ("glb_json_is_an_array.glb", "wrong type: the document is an array of 2, expected an object"),
    ("glb_json_padded_with_nul.glb", "bad JSON at the document, line 1 column 28: trailing characters"),
    ("glb_json_twice.glb", "GLB chunk of type JSON, expected BIN as the second chunk"),
    (
        "glb_length_cuts_the_chunk.glb",
        "GLB chunk JSON declares 28 bytes, allowed 4; the file is cut or forged",
    ),
    (
        "glb_length_too_long.glb",
        "GLB header declares 4294967295 bytes, allowed 20 to 48 (the file's size); the file is cut or forged",
    ),
    (
        "glb_length_zero.glb",
        "GLB header declares 0 bytes, allowed 20 to 48 (the file's size); the file is cut or forged",
    ),
    ("glb_second_header_cut.glb", "GLB ends inside the header of its second chunk"),
    ("glb_ten_bytes.glb", "GLB of 10 bytes, expected at least 20 (header and first chunk header)"),
    ("glb_unknown_first.glb", r#"GLB chunk of type "JSOX", expected JSON as the first chunk"#),
    ("glb_unknown_second.glb", r#"GLB chunk of type "\u{1b}[2J", expected BIN as the second chunk"#),
    ("glb_version_one.glb", "GLB container version 1, allowed 2"),
    (
        "glossiness_array.gltf",
        "wrong type: materials[0].extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor is an array of 1, expected a number",
    ),
    (
        "ior_below_one.gltf",
        "out of range: materials[0].extensions.KHR_materials_ior.ior = 0.5, allowed 0 or [1, ∞)",
    ),
    (
        "lod_dangling.gltf",
        "dangling index: materials[0].extensions.MSFT_lod.ids[0] = 5; materials in the file: 1",
    ),
    ("lone_surrogate.gltf", "bad JSON at materials[0].name, line 1 column 66: unexpected end of hex escape"),
    (
        "material_beyond_2_64.gltf",
        "wrong type: meshes[0].primitives[0].material is the number 1.8446744073709552e+19, expected an index (an integer of at least 0)",
    ),
    (
        "material_dangling.gltf",
        "dangling index: meshes[0].primitives[1].material = 1; materials in the file: 1",
    ),
    (
        "material_float.gltf",
        "wrong type: meshes[0].primitives[0].material is the number 0.0, expected an index (an integer of at least 0)",
    ),
    (
        "material_near_2_64.gltf",
        "dangling index: meshes[0].primitives[0].material = 18446744073709551615; materials in the file: 1",
    ),
    (
        "material_negative.gltf",
        "wrong type: meshes[0].primitives[0].material is the number -1, expected an index (an integer of at least 0)",
    ),
    ("mesh_dangling.gltf", "dangling index: nodes[1].mesh = 3; meshes in the file: 0"),
    ("mesh_without_primitives.gltf", "missing: meshes[0].primitives, expected an array of primitives"),
    ("meshes_object.gltf", "wrong type: meshes is an object of 0, expected an array"),
    (
        "metallic_huge.gltf",
        "out of range: materials[0].pbrMetallicRoughness.metallicFactor = 1e38, allowed [0, 1]",
    ),
    ("min_version_three.gltf", r#"unsupported version: asset.minVersion = "3.0", allowed 2.x"#),
    ("name_number.gltf", "wrong type: materials[0].name is the number 7, expected a string"),
    (
        "nested_200.gltf",
        "bad JSON at materials[0].extensions.X[0][0][0][0][0][0][0][0]…, line 1 column 195: recursion limit exceeded",
    ),
    ("not_utf8.gltf", "the JSON text is not UTF-8: byte 59 of it is the first bad one"),
    ("only_blanks.gltf", "the JSON text is empty"),
    (
        "pointer_dangling.gltf",
        "dangling index: animations[0].channels[0].target.extensions.KHR_animation_pointer.pointer = 4; materials in the file: 1",
    ),
    ("root_array.gltf", r#"not a glTF file: it starts with "[\"asset\"", expected the magic "glTF" or '{'"#),
    (
        "roughness_1e400.gltf",
        "bad JSON at materials[0].pbrMetallicRoughness.roughnessFactor, line 3 column 79: number out of range",
    ),
    (
        "roughness_above_one.gltf",
        "out of range: materials[0].pbrMetallicRoughness.roughnessFactor = 1.7, allowed [0, 1]",
    ),
    (
        "roughness_nan.gltf",
        "bad JSON at materials[0].pbrMetallicRoughness.roughnessFactor, line 3 column 75: expected value",
    ),
    (
        "roughness_negative.gltf",
        "out of range: materials[0].pbrMetallicRoughness.roughnessFactor = -0.1, allowed [0, 1]",
    ),
    (
        "roughness_null.gltf",
        "wrong type: materials[0].pbrMetallicRoughness.roughnessFactor is null, expected a number",
    ),
    (
        "roughness_string.gltf",
        r#"wrong type: materials[0].pbrMetallicRoughness.roughnessFactor is the string "0.5", expected a number"#,
    ),
    (
        "sheen_two_channels.gltf",
        "wrong type: materials[0].extensions.KHR_materials_sheen.sheenColorFactor is an array of 2, expected an array of 3 numbers",
    ),
    (
        "texture_dangling.gltf",
        "dangling index: materials[0].pbrMetallicRoughness.metallicRoughnessTexture.index = 0; textures in the file: 0",
    ),
    (
        "texture_without_index.gltf",
        "missing: materials[0].pbrMetallicRoughness.metallicRoughnessTexture.index, expected the index of a texture",
    ),
    (
        "thickness_negative.gltf",
        "out of range: materials[0].extensions.KHR_materials_volume.thicknessFactor = -1.0, allowed [0, ∞)",
    ),
    ("trailing_data.gltf", "bad JSON at the document, line 1 column 35: trailing characters"),
    (
        "uri_absolute.gltf",
        r#"refused URI: images[1].uri = "/etc/passwd": absolute path, allowed paths in the scene's folder"#,
    ),
    (
        "uri_backslash.gltf",
        r#"refused URI: images[1].uri = "..\secret.png": backslash, allowed `/` as the separator"#,
    ),
    (
        "uri_data_no_comma.gltf",
        r#"refused URI: images[1].uri = "data:image/png;base64": `data:` without a comma"#,
    ),
    (
        "uri_device.gltf",
        r#"refused URI: images[1].uri = "textures/NUL.png": name `NUL.png` is read as another one on Windows"#,
    ),
    (
        "uri_drive.gltf",
        r#"refused URI: images[1].uri = "C:/secret.png": scheme `c:`, allowed `data:` and paths in the scene's folder"#,
    ),
    ("uri_escaped_twice.gltf", r#"refused URI: images[1].uri = "%252e%252e/secret.png": escaped twice"#),
    (
        "uri_file.gltf",
        r#"refused URI: images[1].uri = "file:///etc/passwd": scheme `file:`, allowed `data:` and paths in the scene's folder"#,
    ),
    (
        "uri_http.gltf",
        r#"refused URI: buffers[0].uri = "https://example.com/a.bin": scheme `https:`, allowed `data:` and paths in the scene's folder"#,
    ),
    ("uri_nul.gltf", r#"refused URI: images[1].uri = "a.png%00.txt": control character U+0000"#),
    ("uri_number.gltf", "wrong type: images[1].uri is the number 5, expected a string"),
    (
        "uri_server.gltf",
        r#"refused URI: images[1].uri = "//host/share.png": absolute path, allowed paths in the scene's folder"#,
    ),
    (
        "variant_dangling.gltf",
        "dangling index: meshes[0].primitives[0].extensions.KHR_materials_variants.mappings[0].material = 9; materials in the file: 1",
    ),
    ("version_missing.gltf", r#"missing: asset.version, expected a string such as "2.0""#),
    ("version_number.gltf", "wrong type: asset.version is the number 2.0, expected a string"),
    ("version_one.gltf", r#"unsupported version: asset.version = "1.0", allowed 2.x"#),
    ("version_twenty.gltf", r#"unsupported version: asset.version = "20.0", allowed 2.x"#),
];

#[test]
fn every_fault_has_its_message() {
    for (name, want) in REFUSED {
        let error = read(&fixture("bad").join(name), &Limits::default()).unwrap_err();
        assert_eq!(error.to_string(), format!("{want} ({name})"));
    }
}

#[test]
fn every_file_in_bad_is_in_the_table() {
    let in_folder: BTreeSet<String> = std::fs::read_dir(fixture("bad"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let in_table: BTreeSet<String> = REFUSED.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(in_folder, in_table);
}

#[test]
fn every_length_of_a_cut_file_is_survived() {
    for name in ["four_materials.glb", "four_materials.gltf"] {
        let bytes = std::fs::read(fixture(name)).unwrap();
        // The text is whole at its closing brace; a cut container is always refused.
        let whole = if name.ends_with("glb") { bytes.len() } else { bytes.trim_ascii_end().len() };
        for len in 0..bytes.len() {
            assert_eq!(
                read_slice(&bytes[..len], name, &Limits::default()).is_ok(),
                len >= whole,
                "{name} cut to {len}"
            );
        }
    }
}

/// Reads and analyses; a panic fails the test, an error does not.
fn survives(bytes: &[u8]) {
    if let Ok(scene) = read_slice(bytes, "fuzzed", &Limits::default()) {
        for need in analyse(&scene).needs {
            for (id, range) in &need.ranges {
                let (lo, hi) = (range.lo, range.hi);
                assert!(lo <= hi, "{id} [{lo}, {hi}]");
                assert!(!id.ends_with("roughness") || (0.0 <= lo && hi <= 1.0), "{id} [{lo}, {hi}]");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn flipped_bytes_are_survived(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        for name in ["four_materials.glb", "not_supported.gltf"] {
            let mut bytes = std::fs::read(fixture(name)).unwrap();
            for (at, byte) in &flips {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            survives(&bytes);
        }
    }

    #[test]
    fn lying_headers_are_survived(words in prop::array::uniform4(any::<u32>()), cut in 0usize..64) {
        let mut bytes = std::fs::read(fixture("four_materials.glb")).unwrap();
        // Version, length, chunk length, chunk type: each alone and all together.
        for (i, word) in words.iter().enumerate() {
            let mut one = bytes.clone();
            one[4 + 4 * i..8 + 4 * i].copy_from_slice(&word.to_le_bytes());
            survives(&one);
            survives(&one[..cut]);
            // Small lengths are where an unguarded subtraction fails.
            one[4 + 4 * i..8 + 4 * i].copy_from_slice(&(word % 32).to_le_bytes());
            survives(&one);
            bytes[4 + 4 * i..8 + 4 * i].copy_from_slice(&word.to_le_bytes());
        }
        survives(&bytes);
    }

    #[test]
    fn swapped_values_are_survived(
        at in any::<prop::sample::Index>(),
        value in prop::sample::select(vec![
            "null", "true", "-1", "1e308", "-0.0", "18446744073709551615", "18446744073709551616", "\"\"",
            "[]", "{}", "[[]]", "{\"index\":9}", "[1,2,3]", "0.5",
        ]),
    ) {
        // Replaces one value of the text: what follows a colon, up to the next comma or bracket.
        let text = std::fs::read_to_string(fixture("not_supported.gltf")).unwrap();
        let starts: Vec<usize> = text.match_indices(": ").map(|(i, _)| i + 2).collect();
        let start = starts[at.index(starts.len())];
        let len = text[start..].find([',', '}', ']', '\n']).unwrap();
        survives(format!("{}{value}{}", &text[..start], &text[start + len..]).as_bytes());
    }

    #[test]
    fn random_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        survives(&bytes);
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend_from_slice(&bytes);
        survives(&glb);
    }
}
