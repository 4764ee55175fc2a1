//! EXR in tiles and parts, as the crate's own high-level reader sees it.

use super::support::{table, written};
use brdfbake::encode::read::read_bytes;
use brdfbake::encode::{FileOption, Storage};
use exr::prelude::{Blocks, ReadChannels, ReadLayers, read};
use std::io::Cursor;

#[test]
fn tiles_and_parts_hold_the_same_values() {
    let t = table(&[70, 66, 3], 2);
    let (plain, values) = written(&t, "exr", Storage::Half, &[]).unwrap();
    let stacked = read_bytes(&plain).unwrap();
    for (options, parts, tiled) in [
        (&[FileOption::Tiled][..], 1, true),
        (&[FileOption::Parts], 3, false),
        (&[FileOption::Parts, FileOption::Tiled], 3, true),
    ] {
        let (bytes, _) = written(&t, "exr", Storage::Half, options).unwrap();
        assert_eq!(bytes, written(&t, "exr", Storage::Half, options).unwrap().0);
        let image = read_bytes(&bytes).unwrap();
        assert_eq!((image.width, image.height), (70, 198));
        assert_eq!(image.channels, stacked.channels);
        assert_eq!(image.contradictions(), Vec::<String>::new());
        let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers();
        let file = reader.all_attributes().from_buffered(Cursor::new(&bytes)).unwrap();
        assert_eq!(file.layer_data.len(), parts);
        let mut read: Vec<f32> = Vec::new();
        for (i, layer) in file.layer_data.iter().enumerate() {
            assert_eq!(
                matches!(layer.encoding.blocks, Blocks::Tiles(size) if size.0 == 64 && size.1 == 64),
                tiled
            );
            if parts > 1 {
                let name = layer.attributes.layer_name.as_ref().unwrap().to_string();
                assert_eq!(name, format!("slice_{i:03}"));
            }
            read.extend(layer.channel_data.list[1].sample_data.values_as_f32());
        }
        let want: Vec<f64> = values.iter().skip(1).step_by(2).copied().collect();
        assert_eq!(read.into_iter().map(f64::from).collect::<Vec<_>>(), want);
    }
}
