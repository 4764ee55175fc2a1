//! Functions, terms, models and integrals.

mod anisotropic;
mod chi2;
mod common;
mod compensated;
mod counted;
mod distributions;
mod empirical;
mod facets_and_cloth;
mod functions;
mod glass;
mod known;
mod math;
mod oracle_dfg;
mod quadrature;
mod quadrature_charts;
mod renderers;
mod sheen;
mod single;
mod terms;
mod tolerance;
