//! Linear algebra, the one room with faer: dense LU and products, elimination of node layers, small
//! complex blocks, and GMRES for what is never formed.

mod blocks;
mod dense;
mod elimination;
mod gmres;

pub use blocks::invert;
pub use dense::{
    column, column_mut, column_ref, product, solve_columns, solve_dense, Factor, Matrix,
};
pub use elimination::{Elimination, Reduced};
pub(crate) use gmres::norm;
pub use gmres::{gmres, Found};
