//! The block in finite elements: element rows with a dense memory along x, pressures condensed.

pub mod assembly;
pub mod block;
mod circular;
pub mod dissipation;
pub mod element;
pub mod element_tangent;
pub(crate) mod harmonic_band;
mod harmonic_row;
pub mod jacobian;
pub mod mesh;
pub mod pattern;
mod point_slopes;
mod row_state;
pub mod uniform;
