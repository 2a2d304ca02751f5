//! The rubber at a point and along a line: pure functions, nothing of meshes or loads.

pub mod carried_history;
pub mod dissipation;
pub mod energy;
pub mod kinematics;
pub mod maxwell;
pub mod sliding_history;
pub mod stress;
