//! Linear algebra, the only module that uses faer: dense LU, small complex blocks, sparse L D L^T, and GMRES
//! for matrices that are never formed.

mod dense;
mod gmres;
mod hessenberg;
#[cfg_attr(not(feature = "python"), allow(dead_code))]
pub mod single_gmres;
mod sparse;
#[cfg(test)]
mod tests;
mod vectors;

pub use dense::{invert, Factor, Matrix};
pub use gmres::gmres;
pub use sparse::{Ldl, LdlFactor};
pub use vectors::{add, norm};
