//! Solving: one load, load stepping, a sequence of meshes, and the transfer between meshes.

pub mod bordered;
pub mod error_estimator;
pub mod kept_factor;
pub mod krylov;
pub mod load_stepping;
pub mod mesh_sequence;
pub mod newton;
pub mod newton_step;
pub mod profile_continuation;
pub mod residual;
#[cfg(test)]
mod tests;
pub mod transfer;
