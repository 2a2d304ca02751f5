//! Estimates of the discretisation error of a solution, and whether it can be trusted at all.
//!
//! Lengths in periods of the profile, h the node spacing, k A the steepness of the profile.
//!
//! The error of the contact fraction is the largest of (a) its change from the mesh of half the resolution;
//! (b) the uncertainty of the places of the edges, a share of h that grows where few nodes lie beside an
//! edge; (c) near full contact, f = (2/pi) asin sqrt(p/p*) with p* known to c (k h)^2: a gap of width
//! sqrt(1 - p/p*) opens between nodes that do not resolve it (K. L. Johnson, "Contact Mechanics" (1985),
//! section 13.2).
//!
//! The error of friction is the largest of (a) its change; (b) the difference of its two measures; (c) an
//! error on which two meshes may agree by chance: c (k h)^2 of itself, c / n^2 for n nodes in a contact, and
//! c h k A, because nodes pin a nearly symmetric contact.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

use crate::contact::profile::Heights;
use crate::settings::Settings;
use crate::solution::MeshSolution;
use crate::status::Status;

/// Uncertainty of both edges of a contact together, in node spacings: of one of many nodes; the nodes in a
/// contact or gap for which it doubles; its largest value.
const EDGE_ERROR: f64 = 0.15;
const EDGE_NODES: f64 = 16.0;
const MOST_EDGE_ERROR: f64 = 0.4;
/// Estimated error of the contact fraction over its change between meshes.
const SAFETY: f64 = 1.5;
/// Relative error of the pressure of full contact over (k h)^2.
const CLOSING_ERROR: f64 = 1.5;
/// Least relative error of friction over (k h)^2, and times the square of the nodes in a contact.
const FRICTION_ORDER_ERROR: f64 = 0.6;
const FRICTION_NODE_ERROR: f64 = 1.5;
/// Node spacings by which a contact pinned by nodes may be shifted.
const PINNING: f64 = 0.05;
/// Friction over the slope k A below which errors are relative to this share of k A.
const SMALL_FRICTION: f64 = 0.04;
/// Fewest nodes of the contacts that carry half of the load in a trusted solution.
const FEWEST_CONTACT_NODES: usize = 4;

/// Error estimates of the solutions on one profile.
#[derive(Debug, Clone, Copy)]
pub struct ErrorEstimator {
    /// Largest error allowed, relative in friction and absolute in contact fraction.
    pub tolerance: Option<f64>,
    pub settings: Settings,
    pub slides: bool,
    /// k A of a sine.
    steepness: f64,
    /// k of a sine.
    wave_number: f64,
}

/// One contact: its consecutive nodes, the nodes of the gap after it, and its load.
#[derive(Debug, PartialEq)]
struct Patch {
    closed: usize,
    open: usize,
    load: f64,
}

impl ErrorEstimator {
    pub fn new(
        heights: &Heights,
        slides: bool,
        tolerance: Option<f64>,
        settings: &Settings,
    ) -> Self {
        let steepness = heights.steepness();
        Self {
            tolerance,
            settings: *settings,
            slides,
            steepness,
            wave_number: steepness / heights.half_range(),
        }
    }

    /// The friction to which differences are relative: at least a share of k A, below which friction is not
    /// resolved.
    fn friction_scale(&self, solution: &MeshSolution) -> f64 {
        let (traction, lost) =
            (solution.outcome.friction, solution.outcome.friction_from_dissipation);
        let least = SMALL_FRICTION * self.steepness;
        traction.abs().max(lost.abs()).max(least)
    }

    /// Largest difference of the two frictions of a solution that is to be trusted; none at rest.
    pub fn friction_bound(&self, solution: &MeshSolution) -> Option<f64> {
        let bound = self.settings.most_mismatch * self.friction_scale(solution);
        self.slides.then_some(bound)
    }

    /// `Converged`, or why a solution that converged cannot be trusted.
    pub fn verdict(&self, solution: &MeshSolution) -> Status {
        let patches = patches(&solution.state.active_set, &solution.state.force);
        let few = |patch: &&Patch| patch.closed < FEWEST_CONTACT_NODES;
        let load = |patch: &Patch| patch.load;
        let narrow: f64 = patches.iter().filter(few).map(load).sum();
        if narrow > 0.5 * patches.iter().map(load).sum::<f64>() {
            return Status::ContactTooNarrow;
        }
        match self.friction_bound(solution) {
            Some(bound) if mismatch(solution) > bound => Status::FrictionsDisagree,
            _ => Status::Converged,
        }
    }

    /// Whether the estimated errors of a solution are within the share `part` of the tolerance.
    pub fn meets(&self, solution: &MeshSolution, part: f64) -> bool {
        let Some(tolerance) = self.tolerance else {
            return true;
        };
        let scale = self.friction_scale(solution);
        let friction_met = !self.slides || solution.friction_error <= part * tolerance * scale;
        friction_met && solution.contact_fraction_error <= part * tolerance
    }

    /// Estimated errors of contact fraction and friction, by the solution on a coarser mesh.
    pub fn errors(&self, fine: &MeshSolution, coarse: &MeshSolution) -> (f64, f64) {
        let patches = patches(&fine.state.active_set, &fine.state.force);
        let (new, old) = (&fine.outcome, &coarse.outcome);
        let change = (new.contact_fraction - old.contact_fraction).abs();
        let fraction = SAFETY * change.max(self.edge_error(fine, &patches));
        let friction = (new.friction - old.friction).abs().max(mismatch(fine));
        (fraction.max(self.closing_error(fine)), friction.max(self.chance_error(fine, &patches)))
    }

    /// Columns of the coarsest mesh that is known to meet the tolerance, if errors fall to a quarter at most
    /// when columns are doubled; 0 if the errors were not estimated.
    pub fn columns_within(&self, solution: &MeshSolution) -> usize {
        if solution.friction_error.is_nan() {
            return 0;
        }
        let (mut columns, mut part) = (solution.mesh.columns, 0.25);
        while columns > 1 && self.meets(solution, part) {
            (columns, part) = (columns / 2, part / 4.0);
        }
        columns
    }

    /// A solution with its errors, if there is a coarser one to estimate them from.
    pub fn with_errors(
        &self,
        mut fine: MeshSolution,
        coarse: Option<&MeshSolution>,
    ) -> MeshSolution {
        fine.friction_bound = self.friction_bound(&fine);
        if let (true, Some(coarse)) = (fine.converged(), coarse) {
            fine.coarser = Some((coarse.mesh.clone(), coarse.state.clone()));
            (fine.contact_fraction_error, fine.friction_error) = self.errors(&fine, coarse);
        }
        fine
    }

    /// The last solution, with its verdict as its status.
    pub fn conclude(&self, mut last: MeshSolution) -> MeshSolution {
        if last.converged() {
            last.report.status = self.verdict(&last);
        }
        if last.converged() && !self.meets(&last, 1.0) {
            last.report.status = Status::ToleranceNotMet;
        }
        last
    }

    /// Uncertainty of the edges of all contacts, those of one independent of the others.
    fn edge_error(&self, solution: &MeshSolution, patches: &[Patch]) -> f64 {
        let uncertainty = |patch: &Patch| {
            let nodes = patch.closed.min(patch.open) as f64;
            (EDGE_ERROR * (1.0 + EDGE_NODES / nodes)).min(MOST_EDGE_ERROR)
        };
        let squares = patches.iter().map(|patch| uncertainty(patch).powi(2));
        solution.mesh.node_spacing() * squares.sum::<f64>().sqrt()
    }

    /// (k h)^2 of the mesh, times a constant below one or so.
    fn second_order(&self, solution: &MeshSolution, constant: f64) -> f64 {
        constant * (self.wave_number * solution.mesh.node_spacing()).powi(2)
    }

    /// Error of the contact fraction by the error of the pressure of full contact.
    fn closing_error(&self, solution: &MeshSolution) -> f64 {
        let full = |share: f64| FRAC_2_PI * share.clamp(0.0, 1.0).sqrt().asin();
        let fraction = solution.outcome.contact_fraction;
        let share = if solution.state.active_set.iter().all(|&closed| closed) {
            // How far the lowest pressure is from opening a gap, for a sine of pressure.
            let pressure = solution.outcome.pressure.iter();
            let low = pressure.clone().fold(f64::INFINITY, |low, &p| low.min(p));
            let high = pressure.fold(f64::NEG_INFINITY, |high, &p| high.max(p));
            1.0 + 2.0 * low / (high - low)
        } else {
            (FRAC_PI_2 * fraction).sin().powi(2)
        };
        let error = self.second_order(solution, CLOSING_ERROR);
        let (lower, upper) = (full(share * (1.0 - error)), full(share * (1.0 + error)));
        (fraction - lower).max(upper - fraction)
    }

    /// Error of friction on which meshes may agree by chance.
    fn chance_error(&self, solution: &MeshSolution, patches: &[Patch]) -> f64 {
        if !self.slides {
            return 0.0;
        }
        let mut relative = self.second_order(solution, FRICTION_ORDER_ERROR);
        let mut shift = 0.0;
        if !patches.is_empty() {
            relative += FRICTION_NODE_ERROR / mean_nodes(patches).powi(2);
            shift = PINNING * solution.mesh.node_spacing() * self.steepness;
        }
        relative * solution.outcome.friction.abs() + shift
    }
}

fn mismatch(solution: &MeshSolution) -> f64 {
    (solution.outcome.friction - solution.outcome.friction_from_dissipation).abs()
}

/// Mean number of nodes of a contact, weighted by load.
fn mean_nodes(patches: &[Patch]) -> f64 {
    let load: f64 = patches.iter().map(|patch| patch.load).sum();
    let nodes = patches.iter().map(|patch| patch.load * patch.closed as f64);
    nodes.sum::<f64>() / load
}

/// The contacts around the period, each with the gap after it; none if contact is full.
fn patches(active_set: &[bool], force: &[f64]) -> Vec<Patch> {
    let n = active_set.len();
    let run = |first: usize, closed: bool| {
        let along = (0..n).take_while(|i| active_set[(first + i) % n] == closed);
        along.count()
    };
    let starts = (0..n).filter(|&a| active_set[a] && !active_set[(a + n - 1) % n]);
    starts
        .map(|first| {
            let closed = run(first, true);
            Patch {
                closed,
                open: run(first + closed, false),
                load: (0..closed).map(|i| force[(first + i) % n]).sum(),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_go_around_the_period() {
        let active_set = [true, false, false, true, false, true, true];
        let force = [1.0, 0.0, 0.0, 2.0, 0.0, 3.0, 4.0];
        let patch = |closed, open, load| Patch { closed, open, load };
        assert_eq!(patches(&active_set, &force), [patch(1, 1, 2.0), patch(3, 2, 8.0)]);
        assert!(patches(&[true; 4], &[1.0; 4]).is_empty());
        assert!(patches(&[false; 4], &[0.0; 4]).is_empty());
    }
}
