//! Parameter maps: lobes, pictures, files, conversions.

mod conversions;
mod counted;
mod footprints;
mod map_files;
mod map_lobes;
mod map_pictures;
mod map_recipes;
mod map_scenes;
mod map_texels;
mod sbrdf;
mod tolerance;
