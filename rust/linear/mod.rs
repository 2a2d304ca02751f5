//! Linear algebra, the one room with faer: dense LU, sparse L D L^T, small complex blocks, and GMRES
//! for what is never formed.

mod blocks;
mod dense;
mod gmres;
mod sparse;

pub use blocks::invert;
pub use dense::{Factor, Matrix};
pub(crate) use gmres::{add, norm};
pub use gmres::{gmres, Found};
pub use sparse::{Ldl, LdlFactor};
