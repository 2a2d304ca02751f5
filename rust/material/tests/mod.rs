mod dissipation;
mod energy;
pub mod material_point;
pub mod sliding_history;
