//! The linearised contact problem: a complementarity problem with one border.
//!
//! Find forces f >= 0 and the approach d with
//!     gap = free + C f - d >= 0,   gap . f = 0,   sum f = load.
//! Where it is known which nodes touch it is linear (`held`).

#[derive(Debug, Clone)]
pub struct Contact {
    pub force: Vec<f64>,
    pub approach: f64,
    pub active: Vec<bool>,
}

/// What forces at the nodes add to the gaps.
pub trait Compliance: Sync {
    /// Of node `to` by a unit force at node `from`.
    fn between(&self, to: usize, from: usize) -> f64;

    /// Add what `force` opens to `gap`.
    fn open(&self, force: &[f64], gap: &mut [f64]);

    /// Forces between all nodes that nearly make an opening, for openings of the nodes of `set`; none
    /// where nothing is known of it.
    fn inverse(&self, _set: &[usize]) -> Option<Inverse<'_>> {
        None
    }
}

/// From openings to forces, at every node.
pub type Inverse<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

/// The problem: gaps without forces or approach, and what unit forces add to them.
#[derive(Clone, Copy)]
pub struct Linearised<'c, 'f> {
    pub compliance: &'c dyn Compliance,
    pub free: &'f [f64],
    pub load: f64,
}

/// Gaps under `force` at `approach`.
pub(super) fn gaps(
    compliance: &dyn Compliance,
    free: &[f64],
    force: &[f64],
    approach: f64,
) -> Vec<f64> {
    let mut gap: Vec<f64> = free.iter().map(|g| g - approach).collect();
    compliance.open(force, &mut gap);
    gap
}
