//! Tables: their values, errors, laws and fits.

mod analytic;
mod common;
mod counted;
mod golden;
mod honesty;
mod laws;
mod listed;
mod ltc;
mod numerics;
mod sample;
mod size;
mod sweep;
mod tables;
mod tables_energy;
mod tables_skin;
mod texels;
mod tolerance;
