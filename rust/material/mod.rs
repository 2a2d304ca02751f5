//! The rubber at a point and along a line: pure functions, independent of meshes and loads.

pub mod carried_history;
pub mod dissipation;
pub mod energy;
pub mod kinematics;
pub mod maxwell;
pub mod sliding_history;
pub mod stress;
#[cfg(test)]
pub mod tests;
