//! The linearised contact problem for a given active set: linear, with one border,
//!     C f - d = -free gap on the active set,   sum f = load.
//!
//! A small set is factored. For a large one, whose matrix would need more memory than the block, GMRES
//! is used: C is a convolution except for the slopes of the profile, and its inverse between all nodes,
//! restricted to the active set, is near the inverse of the restricted C. The two differ only at the
//! edges of the contacts.

use super::complementarity_problem::{ApproximateInverse, Compliance};
use crate::executor::Executor;
use crate::linear::{add, gmres, norm, Factor, Matrix};
use crate::settings::Settings;
use crate::status::Status;

/// Share of the gaps that GMRES leaves open: a few digits more than a factor leaves, and far below what
/// a solution may leave.
const GMRES_SHARE: f64 = 1e-13;
/// Directions kept by GMRES, and the largest number of products: 9 to 17 are needed.
const GMRES_LIMITS: (usize, usize) = (100, 300);

/// Largest set that is factored where the compliance has no approximate inverse.
const LARGEST_FACTORED: usize = 2048;

/// The linear system of one active set, ready to be solved for any gaps and load.
pub struct ActiveSetSystem<'a> {
    compliance: &'a dyn Compliance,
    /// Number of all nodes.
    nodes: usize,
    active_nodes: Vec<usize>,
    method: Method<'a>,
}

enum Method<'a> {
    Direct { factor: Factor, border: f64 },
    Iterative(Preconditioner<'a>),
}

/// The approximate inverse between all nodes, and the forces on the active set that it gives for a unit
/// of approach.
struct Preconditioner<'a> {
    inverse: ApproximateInverse<'a>,
    force_by_approach: Vec<f64>,
}

impl<'a> ActiveSetSystem<'a> {
    pub fn new(
        compliance: &'a dyn Compliance,
        active_set: &[bool],
        settings: &Settings,
    ) -> Result<Self, Status> {
        let active_nodes: Vec<usize> = (0..active_set.len()).filter(|&a| active_set[a]).collect();
        if active_nodes.is_empty() {
            return Err(Status::NoActiveSet);
        }
        let inverse = if active_nodes.len() <= settings.factored_contacts {
            None
        } else {
            compliance.approximate_inverse(&active_nodes)
        };
        if inverse.is_none() && active_nodes.len() > LARGEST_FACTORED {
            return Err(Status::NoActiveSet);
        }
        let method = match inverse {
            None => factored(compliance, &active_nodes),
            Some(inverse) => preconditioned(inverse, active_set, &active_nodes),
        };
        Ok(Self { compliance, nodes: active_set.len(), active_nodes, method })
    }

    /// Forces at all nodes with the sum `load`, and the approach, that close the gaps `free_gap` of the
    /// active set; None if the system is singular.
    pub fn solve(
        &self,
        free_gap: &[f64],
        load: f64,
        executor: &Executor<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        executor.check_cancelled()?;
        let right: Vec<f64> = self.active_nodes.iter().map(|&a| -free_gap[a]).collect();
        let solution = match &self.method {
            Method::Direct { factor, border } => solve_directly(factor, *border, right, load),
            Method::Iterative(preconditioner) => {
                self.iterate(preconditioner, &right, load, executor)?
            }
        };
        Ok(solution.map(|(force, approach)| (self.extend(&force), approach)))
    }

    fn iterate(
        &self,
        preconditioner: &Preconditioner<'_>,
        right: &[f64],
        load: f64,
        executor: &Executor<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        let (mut force, mut approach) = self.precondition(preconditioner, right, load);
        let mut residual = right.to_vec();
        add(&mut residual, -1.0, &self.opening(&force, approach));
        let target = GMRES_SHARE * norm(right);
        // The first guess carries the whole load, so every correction carries none.
        let apply = |v: &[f64], out: &mut [f64]| {
            let (force, approach) = self.precondition(preconditioner, v, 0.0);
            out.copy_from_slice(&self.opening(&force, approach));
        };
        let solution = gmres(apply, &residual, target, GMRES_LIMITS, executor)?;
        let (force_change, approach_change) = self.precondition(preconditioner, &solution.y, 0.0);
        add(&mut force, 1.0, &force_change);
        approach += approach_change;
        Ok((norm(&solution.residual) <= target).then_some((force, approach)))
    }

    /// Forces on the active set with the sum `load`, and approach, that nearly make an `opening` of it.
    fn precondition(
        &self,
        preconditioner: &Preconditioner<'_>,
        opening: &[f64],
        load: f64,
    ) -> (Vec<f64>, f64) {
        let forces = (preconditioner.inverse)(&self.extend(opening));
        let mut force = restrict(&forces, &self.active_nodes);
        let missing = load - force.iter().sum::<f64>();
        let approach = missing / preconditioner.force_by_approach.iter().sum::<f64>();
        add(&mut force, approach, &preconditioner.force_by_approach);
        (force, approach)
    }

    /// How far forces and approach open the gaps of the active set.
    fn opening(&self, force: &[f64], approach: f64) -> Vec<f64> {
        let mut gap = vec![-approach; self.nodes];
        self.compliance.add_opening(&self.extend(force), &mut gap);
        restrict(&gap, &self.active_nodes)
    }

    /// Values of the active set at all nodes, zero elsewhere.
    fn extend(&self, values: &[f64]) -> Vec<f64> {
        let mut extended = vec![0.0; self.nodes];
        for (&a, value) in self.active_nodes.iter().zip(values) {
            extended[a] = *value;
        }
        extended
    }
}

fn factored<'a>(compliance: &dyn Compliance, active_nodes: &[usize]) -> Method<'a> {
    let n = active_nodes.len();
    // A border of the size of the compliance, so that pivoting compares rows of one size.
    let border = compliance.entry(active_nodes[0], active_nodes[0]).abs().max(1e-300);
    let entry = |i: usize, j: usize| {
        if i < n && j < n {
            compliance.entry(active_nodes[i], active_nodes[j])
        } else if i < n || j < n {
            border * if i < n { -1.0 } else { 1.0 }
        } else {
            0.0
        }
    };
    let factor = Factor::new(&Matrix::from_fn(n + 1, n + 1, entry));
    Method::Direct { factor, border }
}

fn solve_directly(
    factor: &Factor,
    border: f64,
    mut right: Vec<f64>,
    load: f64,
) -> Option<(Vec<f64>, f64)> {
    right.push(border * load);
    let regular = factor.solve(&mut right);
    let approach = border * right.pop()?;
    regular.then_some((right, approach))
}

fn preconditioned<'a>(
    inverse: ApproximateInverse<'a>,
    active_set: &[bool],
    active_nodes: &[usize],
) -> Method<'a> {
    let ones: Vec<f64> = active_set.iter().map(|&active| f64::from(active)).collect();
    let force_by_approach = restrict(&inverse(&ones), active_nodes);
    Method::Iterative(Preconditioner { inverse, force_by_approach })
}

/// The values at the active nodes.
fn restrict(values: &[f64], active_nodes: &[usize]) -> Vec<f64> {
    active_nodes.iter().map(|&a| values[a]).collect()
}
