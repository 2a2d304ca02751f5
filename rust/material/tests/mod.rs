mod dissipation;
mod energy;
mod material_point;
mod sliding_history;
