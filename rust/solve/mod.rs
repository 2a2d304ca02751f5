//! Solving: one load, raising it, a sequence of meshes and the way from one mesh to another.

pub mod balance;
pub mod bordered;
pub mod increment;
pub mod judge;
pub mod kept_factor;
pub mod krylov;
pub mod load_stepping;
pub mod mesh_sequence;
pub mod mesh_solution;
pub mod newton;
mod next_set;
pub mod roughening;
pub mod transfer;
