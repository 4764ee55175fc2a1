//! The readers of the library, each with the files that it knows.

use crate::sample;
use brdfbake::cancel::Cancel;
use brdfbake::encode::{ENCODERS, beside, read};
use brdfbake::picture;
use brdfbake::recipe::{self, ENGINES, PRESETS};
use brdfbake::scene::{self, Limits, write::Parts};
use std::path::Path;

/// What reads a file from outside.
pub(super) struct Reader {
    pub(super) id: &'static str,
    /// Functions of the library, as `file function`.
    pub(super) covers: &'static [&'static str],
    /// Files that are right.
    pub(super) seeds: fn() -> Vec<Vec<u8>>,
    /// Words that mean something to it.
    pub(super) words: &'static [&'static str],
    /// True if it takes the file.
    pub(super) read: fn(&[u8]) -> bool,
}

/// All of them.
pub(super) static READERS: &[Reader] = &[
    Reader {
        id: "containers",
        covers: &["encode/open.rs read_bytes"],
        seeds: containers,
        words: &["dataWindow", "chlist", "IHDR", "zTXt", "KTX2", "DX10", "descr", "shape"],
        read: |bytes| read::read_bytes(bytes).is_ok(),
    },
    Reader {
        id: "bare",
        covers: &["encode/beside.rs bare"],
        seeds: || vec![vec![0x3c; 2 * 35 * 2], vec![0x3f; 4 * 35 * 2], b"1, 2, 3".to_vec()],
        words: &[",", " ", "0x"],
        read: |bytes| {
            let table = sample::table(&["a", "b"], |_, x| x);
            let provenance = sample::provenance(&table, brdfbake::encode::Storage::Half);
            beside::bare(bytes, &provenance, &Cancel::new()).is_ok()
        },
    },
    Reader {
        id: "pictures",
        covers: &[
            "picture/read.rs read_bytes",
            "picture/read.rs read_within",
            "picture/read.rs facts",
            "picture/levels.rs levels",
        ],
        seeds: pictures,
        words: &["IHDR", "PLTE", "IDAT", "RIFF", "WEBP", "VP8L", "JFIF", "#?RADIANCE"],
        read: |bytes| {
            let known = picture::facts(bytes).is_ok();
            let read = picture::read_within(bytes, 64 << 20).is_ok();
            let levels =
                picture::levels(bytes, |n| if n < 64 << 20 { Ok(()) } else { Err(64 << 20) }).is_ok();
            known && (read || levels)
        },
    },
    Reader {
        id: "recipes",
        covers: &["recipe/mod.rs parse"],
        seeds: || {
            let engines = ENGINES.iter().map(|e| e.recipe);
            PRESETS.iter().map(|p| p.source).chain(engines).map(|s| s.as_bytes().to_vec()).collect()
        },
        words: &[
            "[[table]]\n",
            "[[map]]\n",
            "[table.size]\n",
            "axis",
            "warp",
            "domain",
            "kind",
            "outputs",
            " = ",
            "'''",
        ],
        read: |bytes| recipe::parse(&String::from_utf8_lossy(bytes), "fuzz.toml").is_ok(),
    },
    Reader {
        id: "scenes",
        covers: &["scene/mod.rs read_slice", "scene/write/glb.rs open"],
        seeds: || files(&["tests/scenes", "tests/scenes/bumps", "tests/scenes/spec_gloss"], &["gltf", "glb"]),
        words: &[
            "KHR_materials_sheen",
            "extensions",
            "bufferView",
            "accessors",
            "materials",
            "data:,",
            "uri",
            "JSON",
            "BIN",
        ],
        read: |bytes| {
            let parts = Parts::open(bytes).is_ok();
            scene::read_slice(bytes, "fuzz.glb", &Limits::default()).is_ok() && parts
        },
    },
];

/// A file of every container that is read, and storage.
fn containers() -> Vec<Vec<u8>> {
    let table = sample::table(&["v"], |_, x| x);
    let mut seeds = Vec::new();
    // the binary of the MERL database has one size, of 33 MB
    for encoder in ENCODERS.iter().filter(|e| !e.magic().is_empty() && e.id() != "merl") {
        for storage in encoder.storages() {
            let p = sample::provenance(&table, *storage);
            seeds.push(sample::file(*encoder, &table, *storage, &p));
        }
    }
    seeds
}

fn pictures() -> Vec<Vec<u8>> {
    let mut seeds = files(
        &["tests/footprints", "tests/scenes/bumps", "tests/scenes/spec_gloss"],
        &["png", "jpg", "webp"],
    );
    for format in [image::ImageFormat::Png, image::ImageFormat::Jpeg, image::ImageFormat::WebP] {
        let colour = |x: u32, y: u32| image::Rgb([28 * x, 36 * y, 99].map(|c| u8::try_from(c).unwrap()));
        let image = image::DynamicImage::from(image::RgbImage::from_fn(9, 7, colour));
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        seeds.push(bytes.into_inner());
    }
    seeds.extend(containers());
    // large ones are read slowly and hide nothing that small ones do not
    seeds.retain(|s| s.len() < 100_000);
    seeds
}

/// Files of the repository with these endings.
fn files(folders: &[&str], endings: &[&str]) -> Vec<Vec<u8>> {
    let mut paths = Vec::new();
    for folder in folders {
        let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap();
        paths.extend(entries.map(|e| e.unwrap().path()));
    }
    paths.retain(|p| p.extension().and_then(|e| e.to_str()).is_some_and(|e| endings.contains(&e)));
    paths.sort();
    paths.iter().map(|p| std::fs::read(p).unwrap()).collect()
}
