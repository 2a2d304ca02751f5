//! What the linearised contact problem consists of, and its solution.

/// A solution: forces and approach, and the nodes in contact.
#[derive(Debug, Clone)]
pub struct Contact {
    pub force: Vec<f64>,
    pub approach: f64,
    pub active_set: Vec<bool>,
}

/// What forces at the nodes add to the gaps.
pub trait Compliance: Sync {
    /// What a unit force at node `from` adds to the gap of node `to`.
    fn entry(&self, to: usize, from: usize) -> f64;

    /// Add C `force` to `gap`.
    fn add_opening(&self, force: &[f64], gap: &mut [f64]);

    /// An approximate inverse of C, for openings of the `active_nodes`; None if there is none.
    fn approximate_inverse(&self, _active_nodes: &[usize]) -> Option<ApproximateInverse<'_>> {
        None
    }
}

/// From openings to forces, at every node.
pub type ApproximateInverse<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

#[derive(Clone, Copy)]
pub struct ComplementarityProblem<'c, 'g> {
    pub compliance: &'c dyn Compliance,
    /// Gaps without forces and approach.
    pub free_gap: &'g [f64],
    pub load: f64,
}

impl ComplementarityProblem<'_, '_> {
    /// Gaps under `force` at `approach`.
    pub fn gaps(&self, force: &[f64], approach: f64) -> Vec<f64> {
        let mut gap: Vec<f64> = self.free_gap.iter().map(|g| g - approach).collect();
        self.compliance.add_opening(force, &mut gap);
        gap
    }
}
