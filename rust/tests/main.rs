//! The kernel's test ladder, from shape functions to whole waves, in one binary.

mod contact_problem;
mod element_and_cell;
mod elimination;
mod hostile_input;
mod material_point;
mod memory;
mod sliding_in_time;
mod tangent;
mod whole_wave;

/// A reproducible pseudo-random number in [-1, 1) (splitmix64), for fields without structure.
pub fn noise(index: usize) -> f64 {
    let mut z = (index as u64).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}
