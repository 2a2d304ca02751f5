//! The block in finite elements: element rows with memory along x, mixed in displacement and pressure.

pub mod averaged_jacobian;
pub mod block;
pub mod dissipation;
pub mod element;
mod element_row;
pub mod element_tangent;
pub mod harmonic_block;
mod harmonic_row;
pub mod jacobian;
pub mod jacobian_product;
pub mod mesh;
pub mod pattern;
mod point_slopes;
#[cfg(test)]
mod tests;
