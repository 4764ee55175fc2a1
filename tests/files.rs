//! Files: written, read back, compared; scenes and engines.

mod common;
mod compare;
mod containers;
mod counted;
mod encode;
mod encode_hostile;
mod engines;
mod evidence;
mod foreign;
mod fuzz;
mod rechecked;
mod sample;
mod scene;
mod tolerance;
mod written;
