//! Memory: readers take what a file holds, whatever its header says; bakes take no more than was told before.
//!
//! One test at a time: the allocator counts for the whole process.
#![allow(clippy::unwrap_used, reason = "test")]
#![allow(clippy::print_stderr, reason = "what was skipped is said")]

mod counted;
mod hostile_pictures;
mod sample;

use brdfbake::cancel::Cancel;
use brdfbake::encode::read::read_bytes;
use brdfbake::encode::{ENCODERS, Encoder, FileOption, Label, Shape, Storage, quantise_table};
use brdfbake::grid::{Axis, Grid, Quantity, Table, Texel, Warp};
use brdfbake::pipeline::{PipelineError, Settings, Silent, memory, run};
use brdfbake::plan::Plan;
use brdfbake::recipe::parse;
use exr::image::write::WritableImage;
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder, f16,
};
use peak_alloc::PeakAlloc;
use std::io::Cursor;
use std::sync::{Mutex, MutexGuard, PoisonError};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Most bytes that were allocated during a call beyond those before it, and its result.
fn peak<T>(call: impl FnOnce() -> T) -> (usize, T) {
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage();
    let result = call();
    (ALLOCATOR.peak_usage().saturating_sub(before), result)
}

const MB: usize = 1 << 20;

/// What a reader may take for a file of a few kB that holds little: tables of decoders are of this size.
const SMALL: usize = 8 * MB;

/// A small file of every container and storage that is read, and EXR in every compression.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let mut seeds = Vec::new();
    let table = sample::table(&["v"], |_, x| x);
    // the binary of the MERL database has one size, and its reader takes no other
    for encoder in ENCODERS.iter().filter(|e| !e.magic().is_empty() && e.id() != "merl") {
        for storage in encoder.storages() {
            let p = sample::provenance(&table, *storage);
            let bytes = sample::file(*encoder, &table, *storage, &p);
            seeds.push((format!("{}:{}", encoder.id(), storage.id()), bytes));
        }
    }
    for compression in sample::COMPRESSIONS {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(exr::math::Vec2(8, 8))] {
            let samples = FlatSamples::F16((0..19 * 37).map(|i| f16::from_f32(i as f32 / 7.0)).collect());
            let channels = AnyChannels::sort([AnyChannel::new("Y", samples)].into_iter().collect());
            let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
            let layer = Layer::new((19, 37), LayerAttributes::default(), encoding, channels);
            let mut bytes = Cursor::new(Vec::new());
            Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
            seeds.push((format!("exr {compression:?} {blocks:?}"), bytes.into_inner()));
        }
    }
    seeds
}

/// Reads files that may be damaged; none must take more than its pixels, or little. Damaged blocks make a crate panic, which is
/// caught; its message is of no use here.
fn assert_modest(files: impl Iterator<Item = (String, Vec<u8>)>) {
    std::panic::set_hook(Box::new(|_| {}));
    let mut greedy = Vec::new();
    for (what, bytes) in files {
        let (taken, image) = peak(|| read_bytes(&bytes));
        let samples = image.map_or(0, |i| i.channels.iter().map(|c| c.values.len()).sum());
        // as it is packed, as codes, and as f64
        if taken > SMALL + 24 * samples {
            greedy.push(format!("{what}: {} bytes took {taken}, {samples} samples", bytes.len()));
        }
    }
    let _ = std::panic::take_hook();
    assert!(greedy.is_empty(), "{} files: {:#?}", greedy.len(), &greedy[..greedy.len().min(20)]);
}

#[test]
fn readers_take_what_a_file_holds_and_not_what_its_header_says() {
    let _alone = alone();
    for (name, seed) in seeds() {
        assert!(read_bytes(&seed).is_ok(), "{name}: {:?}", read_bytes(&seed).err());
        let places = (0..seed.len().min(400)).flat_map(|at| [0xff, 0x7f].map(|value| (at, value)));
        assert_modest(places.map(|(at, value)| {
            let mut bytes = seed.clone();
            bytes[at] = value;
            (format!("{name}, byte {at} = {value}"), bytes)
        }));
    }
}

/// The file with a number in place of another, behind a text.
fn forged(seed: &[u8], behind: &[u8], skip: usize, n: u32) -> Vec<u8> {
    let at = seed.windows(behind.len()).position(|w| w == behind).unwrap() + behind.len() + skip;
    let mut bytes = seed.to_vec();
    bytes[at..at + 4].copy_from_slice(&n.to_le_bytes());
    bytes
}

/// Pictures of 2^26 to 2^28 pixels by their headers.
fn large(name: &str, seed: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    if name.starts_with("png") {
        let mut bytes = seed.to_vec();
        bytes[16..24].copy_from_slice(&[0, 0, 0x1f, 0, 0, 0, 0x1f, 0]);
        let sum = crc(&bytes[12..29]).to_be_bytes();
        bytes[29..33].copy_from_slice(&sum);
        all.push((format!("{name}, 7936 x 7936"), bytes));
    }
    if !name.starts_with("exr") {
        return all;
    }
    // the window: its first corner, then the last column and row
    for (column, row) in [(0x80_0000, 18), (18, 0x80_0000), (16_000, 16_000)] {
        let mut bytes = forged(seed, b"dataWindow\0box2i\0", 12, column);
        bytes = forged(&bytes, b"dataWindow\0box2i\0", 16, row);
        all.push((format!("{name}, {column} x {row}"), bytes.clone()));
        // and a block that claims to be long: the first offset leads to it
        let word = |i: usize| u64::from_le_bytes(bytes[i..i + 8].try_into().unwrap());
        let is_offset =
            |i: &usize| word(*i) > *i as u64 && word(*i) < bytes.len() as u64 && bytes[i - 1] == 0;
        let table = (64..bytes.len() - 8).find(is_offset).unwrap();
        let first = usize::try_from(word(table)).unwrap();
        let at = first + if name.contains("Tiles") { 16 } else { 4 };
        bytes[at..at + 4].copy_from_slice(&0x5000_0000_u32.to_le_bytes());
        all.push((format!("{name}, {column} x {row}, a long block"), bytes));
    }
    all
}

#[test]
fn a_size_within_the_limits_takes_no_memory_either() {
    let _alone = alone();
    let all: Vec<_> = seeds().iter().flat_map(|(name, seed)| large(name, seed)).collect();
    for (what, bytes) in all.iter().filter(|(what, _)| what.starts_with("png")) {
        let message = read_bytes(bytes).unwrap_err().to_string();
        assert!(message.contains("cannot hold 7936 x 7936 pixels"), "{what}: {message}");
    }
    assert!(all.len() > 120, "{}", all.len());
    assert_modest(all.into_iter());
}

/// CRC-32 of a PNG chunk.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &b| {
        (0..8).fold(crc ^ u32::from(b), |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 })
    })
}

#[test]
fn shared_attacks_are_read_in_little_memory() {
    let _alone = alone();
    let Some(shared) = std::env::var_os("BRDFBAKE_SHARED") else {
        eprintln!("SKIPPED: BRDFBAKE_SHARED is not set");
        return;
    };
    let path = std::path::Path::new(&shared).join("cases/attack/slow-13300305.bin");
    let Ok(bytes) = std::fs::read(&path) else {
        eprintln!("SKIPPED: {} is not there", path.display());
        return;
    };
    assert_modest([("slow-13300305.bin".to_owned(), bytes)].into_iter());
}

/// The grid of a container: its own, or one of about so many numbers.
fn grid(encoder: &dyn Encoder, numbers: usize, channels: usize) -> Grid {
    let axis = |id: &str, len| Axis::new(Quantity::find(id).unwrap(), len, Texel::Center);
    if encoder.id() == "merl" {
        return Grid::new(vec![
            axis("phi_d", 180),
            axis("theta_d", 90),
            axis("theta_h", 90).warped(Warp::Power(0.5)),
        ])
        .unwrap();
    }
    let side = (numbers / channels).isqrt();
    Grid::new(vec![axis("mu", side), axis("roughness", side)]).unwrap()
}

fn table(grid: Grid, channels: usize) -> Table {
    let n = grid.len() * channels;
    // no pattern that a compressor finds, and numbers with many digits
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 * 1e-3
    };
    Table {
        channels: (0..channels).map(|c| sample::channel(&format!("c{c}"))).collect(),
        values: (0..n).map(|_| next()).collect(),
        errors: (0..n).map(|_| next() * 1e-9).collect(),
        evaluations: vec![1; grid.len()],
        grid,
    }
}

#[test]
fn writing_takes_what_the_container_says() {
    let _alone = alone();
    for encoder in ENCODERS {
        let options = encoder.options().iter().filter(|o| !matches!(o, FileOption::FillZero));
        let sets: Vec<Vec<FileOption>> = std::iter::once(vec![]).chain(options.map(|o| vec![*o])).collect();
        for (storage, options) in encoder.storages().iter().flat_map(|s| sets.iter().map(move |o| (*s, o))) {
            for channels in [1, 3, 4] {
                measure_writing(*encoder, storage, options, channels);
            }
        }
    }
}

fn measure_writing(encoder: &dyn Encoder, storage: Storage, options: &[FileOption], channels: usize) {
    // where texels or blocks are searched for it takes long; shaders take no more than 65 532 numbers
    let slow = options.contains(&FileOption::Zstd);
    let quick =
        !slow && matches!(storage, Storage::Half | Storage::Float | Storage::Double | Storage::Unorm16);
    let sizes = if quick { [240_000, 60_000] } else { [12_000, 1200] };
    let grids = sizes.map(|numbers| grid(encoder, numbers, channels));
    let shape = |grid| Shape { grid, channels, storage, options };
    let Some(grid) = grids.iter().find(|grid| shape(grid).check(encoder).is_ok()) else { return };
    let shape = shape(grid);
    let table = table(grid.clone(), channels);
    let rounded = quantise_table(&table, storage).unwrap();
    let input = sample::input(&table, &rounded, storage, options, Label { name: "x", ..Label::default() });
    let what = format!("{}:{} {options:?}, {channels} channels", encoder.id(), storage.id());
    let (taken, file) = peak(|| encoder.encode(&input).unwrap());
    let (bytes, memory) = (encoder.most_bytes(&shape), encoder.most_memory(&shape));
    // buffers of compressors and headers
    let fixed = MB / 2;
    assert!(file.len() <= bytes + 4096, "{what}: {} bytes, at most {bytes} were told", file.len());
    // what blocks decode to is compared with the values, which the plan counts apart
    let decoded = if storage.is_block() { 64 * table.grid.len() } else { 0 };
    assert!(taken <= memory.max(decoded) + fixed, "{what}: took {taken}, {memory} were told");
    assert!(memory <= 6 * taken + fixed, "{what}: took only {taken}, {memory} were told");
}

fn plan(length: usize, outputs: &str, more: &str) -> Plan {
    let text = format!(
        "name = 'm'\n[[table]]\nkind = 'fresnel-schlick'\nname = 't'\nreconstruction = 'off'\ntolerance = 1e-2\n\
         outputs = [{outputs}]\n{more}\n\
         [[table.axis]]\nid = 'mu'\nlength = {length}\n[[table.axis]]\nid = 'f0'\nlength = {length}\n"
    );
    parse(&text, "m.toml").unwrap()
}

fn bake(plan: &Plan) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { jobs: Some(2), memory: Some(u64::MAX), ..Settings::new(folder.path()) };
    peak(|| run(plan, &settings, &Cancel::new(), &Silent).unwrap()).0
}

#[test]
fn bakes_take_what_their_plan_says() {
    let _alone = alone();
    for (length, outputs, more) in [
        (640, "'exr:half'", ""),
        (640, "'csv:double'", ""),
        (640, "'npy:double', 'raw:float', 'text:half'", ""),
        (640, "'png:unorm16', 'ktx2:float+zstd'", ""),
        (512, "'c:double'", ""),
        (128, "'dds:bc4', 'dds:bc6h'", ""),
        (256, "'exr:float'", "texels = 'auto'"),
        (128, "'exr:half', 'csv:double'", "texels = 'minimax'"),
    ] {
        let [small, large] = [8, length].map(|l| plan(l, outputs, more));
        let told = memory::plan(&large) - memory::plan(&small);
        let all = bake(&large);
        let taken = all.saturating_sub(bake(&small)) as u64;
        let what = format!("{length} x {length}, {outputs} {more}");
        // numbers in the text of the provenance may have a few digits more
        assert!(taken <= told + 1024, "{what}: took {taken}, {told} were told");
        assert!(told <= 4 * taken, "{what}: took only {taken}, {told} were told");
        assert!(all as u64 <= memory::plan(&large), "{what}");
    }
}

#[test]
fn what_does_not_fit_is_refused_before_it_is_baked() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let refused = |plan: &Plan, memory| {
        let settings = Settings { memory, large: true, ..Settings::new(folder.path().join("out")) };
        run(plan, &settings, &Cancel::new(), &Silent).map(drop)
    };
    let large = plan(8192, "'csv:double'", "");
    match refused(&large, None) {
        Err(PipelineError::Memory { table, needed, limit }) => {
            assert_eq!((table.as_str(), needed), ("t", memory::plan(&large)));
            assert!(limit <= memory::MEMORY && needed > 8192 * 8192 * 100, "{needed}");
        }
        other => panic!("{other:?}"),
    }
    // a large plan is to be meant, whatever memory there is
    let unasked = run(&large, &Settings::new(folder.path().join("out")), &Cancel::new(), &Silent);
    let message = unasked.unwrap_err().to_string();
    assert!(message.contains("67108864 texels") && message.contains("--yes-large"), "{message}");
    assert!(!folder.path().join("out").exists());
    let small = plan(64, "'csv:double'", "");
    let needed = memory::plan(&small);
    assert!(matches!(refused(&small, Some(needed - 1)), Err(PipelineError::Memory { .. })));
    refused(&small, Some(needed)).unwrap();
    // a size that is searched for counts as the largest that is tried
    let open = "name = 'm'\n[[table]]\nkind = 'dfg'\nname = 't'\nsize = { longest = 2048 }\n";
    let fixed = "name = 'm'\n[[table]]\nkind = 'dfg'\nname = 't'\n";
    let [open, fixed] = [open, fixed].map(|text| memory::plan(&parse(text, "m.toml").unwrap()));
    assert!(open > fixed + 2048 * 2048 * 36, "{open} {fixed}");
    assert!(memory::available().is_some_and(|n| n > 1 << 20), "what the machine has");
}

/// A map of noise of this side.
fn map(side: u32, keys: &str, folder: &std::path::Path) -> Plan {
    let noise = |x: u32, y: u32, c: u32| (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503) ^ c) >> 9;
    let image = |name: &str, code: &dyn Fn(u32, u32, u32) -> u8| {
        let file = std::fs::File::create(folder.join(name)).unwrap();
        let mut encoder = png::Encoder::new(file, side, side);
        encoder.set_color(png::ColorType::Rgb);
        let texel = |i: u32| (0..3).map(move |c| code(i % side, i / side, c));
        let data: Vec<u8> = (0..side * side).flat_map(texel).collect();
        encoder.write_header().unwrap().write_image_data(&data).unwrap();
    };
    image("n.png", &|x, y, c| if c == 2 { 250 } else { 112 + (noise(x, y, c) & 31) as u8 });
    image("r.png", &|x, y, c| 60 + (noise(x, y, c) & 127) as u8);
    let [n, r] = ["n.png", "r.png"].map(|f| folder.join(f).display().to_string());
    let keys = keys.replace("r.png", &r);
    let text =
        format!("name = 'm'\n[[map]]\nname = 't'\nnormal = '{n}'\nroughness = '{r}'\ncheck = 8\n{keys}\n");
    parse(&text, "m.toml").unwrap()
}

#[test]
fn maps_take_what_their_plan_says() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    for (side, keys) in [
        (256, "outputs = ['ktx2']"),
        (128, "outputs = ['ktx2:normal=bc5', 'png', 'exr']\nnormals = 'fit'\nshape = 'anisotropic'"),
        (320, "sbrdf = { model = 'lafortune', lobes = 2, base = 'r.png' }\noutputs = ['dds']"),
    ] {
        let [(told, taken), (least, small)] = [side, 16].map(|side| {
            let plan = map(side, keys, folder.path());
            (memory::plan(&plan), bake(&plan) as u64)
        });
        let (told, grown) = (told - least, taken.saturating_sub(small));
        assert!(grown <= told, "{side}, {keys}: took {grown}, {told} were told");
        assert!(told <= 5 * grown, "{side}, {keys}: took only {grown}, {told} were told");
        let plan = map(side, keys, folder.path());
        assert!(taken <= memory::plan(&plan), "{side}, {keys}: took {taken}");
        let out = folder.path().join("out");
        let limit = memory::plan(&plan) - 1;
        let settings = Settings { memory: Some(limit), ..Settings::new(&out) };
        match run(&plan, &settings, &Cancel::new(), &Silent).unwrap_err() {
            PipelineError::MapMemory { map, needed, .. } => {
                assert_eq!((map.as_str(), needed), ("t", limit + 1))
            }
            other => panic!("{other}"),
        }
        assert!(!out.exists());
    }
}
