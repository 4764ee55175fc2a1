//! The factors of the papers (D, Lambda, G1, G2, Fresnel) in closed, cancellation-free form.

pub mod beckmann;
pub mod blinn_phong;
pub mod charlie;
pub mod fresnel;
pub mod ggx;
pub mod gtr;
pub mod kelemen;
pub mod phase;
pub mod schlick;
pub mod smith;
pub mod student_t;
pub mod vcavity;
pub mod velvet;
