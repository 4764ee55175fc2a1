//! The readers of the library, each with the files that it knows.

use super::repository;
use crate::sample;
use brdfbake::cancel::Cancel;
use brdfbake::cli::{self, Cli};
use brdfbake::encode::{ENCODERS, beside, read};
use brdfbake::picture;
use brdfbake::pipeline::audit::audit;
use brdfbake::pipeline::golden::Golden;
use brdfbake::pipeline::map::texel::TexelPlace;
use brdfbake::pipeline::pages::{self, Asked};
use brdfbake::pipeline::recheck::Beside;
use brdfbake::plan::scene::Pictures;
use brdfbake::plan::{Output, map};
use brdfbake::recipe::{self, ENGINES, PRESETS};
use brdfbake::scene::{self, Limits, write::Parts};
use clap::Parser;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use tempfile::TempDir;

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
        read: |bytes| {
            // levels of pyramids too: the last one that may be there, and one beyond
            let level = |k| read::read_level_until(&Cancel::new(), bytes, k).is_ok();
            let levels = [1, 3].map(level);
            read::read_bytes(bytes).is_ok() || levels.contains(&true)
        },
    },
    Reader {
        id: "rows",
        covers: &[],
        seeds: || {
            let rows = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,\"{\"\"alpha\"\": 0.3}\",0.5,0,0.4,1\nlambert,,1,0,1,0\n";
            let function = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nfresnel-dielectric,\"{\"\"eta\"\": 1.5}\",0.1,,,\n";
            vec![rows.into(), function.into()]
        },
        words: &[
            "model",
            "params_json",
            "wi_theta",
            "ggx",
            "ggx-glass",
            "gltf",
            "\"{\"\"alpha\"\": ",
            ",,,,",
            "\n",
            "alpha_x",
        ],
        read: |bytes| {
            let (from, to) = (SCRATCH.file("rows.csv", bytes), SCRATCH.path("rows-out.csv"));
            let words = ["brdfbake", "eval", from.to_str().unwrap(), "-o", to.to_str().unwrap()];
            cli::run(Cli::try_parse_from(words).unwrap(), &Arc::new(Cancel::new())).is_ok()
        },
    },
    Reader {
        id: "golden",
        covers: &["pipeline/golden.rs load"],
        seeds: || {
            let all = "recipe = \"r.toml\"\nulps = 1\nabsolute = 1e-6\n[channel.\"dfg.scale\"]\nulps = 2\nabsolute = 0\n";
            vec![all.into(), b"ulps = 0.5\n".to_vec(), Vec::new()]
        },
        words: &["recipe", "ulps", "absolute", "[channel.x]\n", " = ", "1e400", "-0.0"],
        read: |bytes| {
            SCRATCH.file("golden.toml", bytes);
            Golden::load(SCRATCH.folder()).is_ok()
        },
    },
    Reader {
        id: "manifests",
        covers: &["pipeline/audit.rs audit", "pipeline/recheck/file.rs load"],
        seeds: || {
            let examples = ["01-split-sum", "02-energy-compensation", "08-maps", "16-sbrdf"];
            let path = |e: &str| format!("out-examples/{e}/manifest.json");
            examples.iter().map(|e| std::fs::read(repository().join(path(e))).unwrap()).collect()
        },
        words: &[
            "\"schema\"",
            "\"tables\"",
            "\"maps\"",
            "\"files\"",
            "\"file\"",
            "\"axes\"",
            "\"len\": ",
            "\"../x\"",
            "\"level\": 9,",
            "[[",
            "]]",
        ],
        read: |bytes| {
            SCRATCH.file("manifest.json", bytes);
            let folder = SCRATCH.folder();
            let asked = Asked { against: None, evaluations: 0, timings: false };
            let pages = pages::of_folder(folder, &asked, &Cancel::new()).is_ok();
            let _ = Beside::load(folder);
            audit(folder).is_ok() && pages
        },
    },
    Reader {
        id: "words",
        covers: &[
            "plan/output.rs parse",
            "plan/map/output.rs parse",
            "encode/layout.rs parse",
            "pipeline/map/texel.rs parse",
        ],
        seeds: || {
            let words =
                ["exr:half+positional", "ktx2:roughness=bc4+normal=bc5", "128x64x2:half", "maps/m:12,7,1"];
            words.iter().map(|w| w.as_bytes().to_vec()).collect()
        },
        words: &["exr", "ktx2", ":", "+", "=", "x", "half", "bc6h", "roughness"],
        read: |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let _ = brdfbake::math::shown::show(&text);
            let parsed = [
                Output::parse(&text).is_ok(),
                map::Output::parse(&text).is_ok(),
                brdfbake::encode::Layout::parse(&text).is_ok(),
                TexelPlace::parse(&text).is_ok(),
            ];
            parsed.contains(&true)
        },
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
            "picture/read.rs is_picture",
            "picture/levels.rs levels",
        ],
        seeds: pictures,
        words: &["IHDR", "PLTE", "IDAT", "RIFF", "WEBP", "VP8L", "JFIF", "#?RADIANCE"],
        read: |bytes| {
            let known = picture::facts(bytes).is_ok();
            let _ = picture::is_picture(bytes);
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
        covers: &[
            "scene/mod.rs read_slice",
            "scene/write/glb.rs open",
            "scene/write/references.rs references",
        ],
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
            let limits = Limits { texels: true, meshes: true, colours: true, ..Limits::default() };
            let drawn = scene::read_slice(bytes, "fuzz.glb", &limits).map(|scene| {
                // buffers beside it are looked for in the folder of the tests
                let folder = repository().join("tests/scenes/bumps");
                Pictures::new(None, 1 << 16).triangles(&scene, &folder).0.len()
            });
            let _ = scene::write::references(&String::from_utf8_lossy(bytes));
            scene::read_slice(bytes, "fuzz.glb", &Limits::default()).is_ok() && parts && drawn.is_ok()
        },
    },
];

/// A folder for readers that take one, or a file of it.
struct Scratch(LazyLock<TempDir>);

static SCRATCH: Scratch = Scratch(LazyLock::new(|| tempfile::tempdir().unwrap()));

impl Scratch {
    fn folder(&self) -> &Path {
        self.0.path()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// Writes a file into it.
    fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        std::fs::write(self.path(name), bytes).unwrap();
        self.path(name)
    }
}

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
    // the head of a binary of the MERL database
    seeds.push([90u32, 90, 180].iter().flat_map(|n| n.to_le_bytes()).collect());
    seeds.extend(files(&["out-examples/08-maps"], &["ktx2"]));
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
