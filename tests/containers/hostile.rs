//! Damaged and hostile files: an error, never a panic, never memory for what a header tells.

use super::support::{table, written};
use brdfbake::encode::read::read_bytes;
use brdfbake::encode::{FileOption, Storage};
use proptest::prelude::*;
use std::sync::OnceLock;

fn seeds() -> &'static [Vec<u8>] {
    static SEEDS: OnceLock<Vec<Vec<u8>>> = OnceLock::new();
    SEEDS.get_or_init(|| {
        let file = |lengths: &[usize], channels, container, storage, options: &[FileOption]| {
            written(&table(lengths, channels), container, storage, options).unwrap().0
        };
        let mut seeds = vec![
            file(&[9, 5], 2, "ktx2", Storage::Half, &[]),
            file(&[9, 5, 3], 3, "ktx2", Storage::Rgb9e5, &[]),
            file(&[9, 5], 3, "ktx2", Storage::Rgbd, &[]),
            file(&[9, 5], 1, "dds", Storage::Unorm16, &[]),
            file(&[9, 5, 3], 2, "dds", Storage::Rgb10a2, &[FileOption::Layers]),
            file(&[9, 5], 2, "npy", Storage::Float, &[]),
            file(&[9, 5], 2, "hdr", Storage::Rgbe, &[]),
            file(&[3, 5], 2, "hdr", Storage::Rgbe, &[]),
            file(&[9, 5], 2, "ktx2", Storage::Bc6h, &[]),
            file(&[9, 5, 3], 2, "dds", Storage::Bc5, &[]),
        ];
        if cfg!(feature = "zstd") {
            seeds.push(file(&[32, 32], 2, "ktx2", Storage::Half, &[FileOption::Zstd]));
        }
        seeds
    })
}

#[test]
fn every_truncation_is_an_error() {
    for seed in seeds() {
        assert!(read_bytes(seed).is_ok());
        for len in 0..seed.len() {
            assert!(read_bytes(&seed[..len]).is_err(), "{len} of {} bytes", seed.len());
        }
    }
}

#[test]
fn forged_sizes_are_refused() {
    let forge = |seed: usize, at: usize, bytes: &[u8]| {
        let mut file = seeds()[seed].clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        read_bytes(&file).unwrap_err().to_string()
    };
    let huge = [0xff, 0xff, 0xff, 0x7f];
    let ktx2 = "ktx2: the header tells of 2147483647 x 5 pixels; at most 2^28 samples are read";
    assert_eq!(forge(0, 20, &huge), ktx2);
    assert_eq!(forge(0, 36, &[6]), "ktx2: 6 faces; cube maps are not supported");
    assert_eq!(forge(0, 20, &[10]), "ktx2: the level has 180 bytes, its size tells of 200");
    assert_eq!(forge(0, 12, &[43]), "ktx2: VkFormat 43 is not supported");
    let dds = "dds: the header tells of 2147483647 x 5 pixels; at most 2^28 samples are read";
    assert_eq!(forge(3, 16, &huge), dds);
    assert_eq!(forge(3, 16, &[10]), "dds: the file has 90 bytes of pixels, its header tells of 100");
    assert_eq!(forge(8, 20, &[13]), "ktx2: the level has 96 bytes, its size tells of 128");
    assert_eq!(forge(9, 16, &[13]), "dds: the file has 288 bytes of pixels, its header tells of 384");
    let text = String::from_utf8_lossy(&seeds()[5]).into_owned();
    let shape = text.find("(5, 9, 2)").unwrap();
    // the replacement character of the magic is two bytes longer than its byte
    let npy = forge(5, shape - 2, b"(99999999, 9999999, 9, 2), }      ");
    assert!(npy.starts_with("npy: the header tells of 9 x 999"), "{npy}");
    let size = seeds()[6].windows(8).position(|w| w == b"-Y 5 +X ").unwrap();
    assert_eq!(
        forge(6, size, b"-Y 5 +Z "),
        "hdr: the size `-Y 5 +Z 9` is not of the form -Y height +X width"
    );
}

#[test]
#[cfg(feature = "zstd")]
fn a_frame_that_holds_more_than_it_should_is_found_out() {
    // 64 MiB of zeros in place of 4096 bytes
    let mut file = seeds()[10].clone();
    let start = u64::from_le_bytes(file[80..88].try_into().unwrap()) as usize;
    let bomb = zstd::bulk::compress(&vec![0; 1 << 26], 3).unwrap();
    file.truncate(start);
    file.extend(&bomb);
    file[88..96].copy_from_slice(&(bomb.len() as u64).to_le_bytes());
    let message = read_bytes(&file).unwrap_err().to_string();
    assert_eq!(message, "ktx2: the level has 4097 bytes, its size tells of 4096");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(
        std::env::var("BRDFBAKE_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(4000)
    ))]

    #[test]
    fn flipped_bytes_do_not_panic(
        seed in 0..seeds().len(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        near in prop::collection::vec((0..220usize, any::<u8>()), 0..4),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = seeds()[seed].clone();
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        for (at, value) in near {
            if let Some(b) = bytes.get_mut(at) {
                *b = value;
            }
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(image) = read_bytes(&bytes) {
            let area = image.width * image.height;
            prop_assert!(image.channels.iter().all(|c| c.values.len() == area));
        }
    }
}
