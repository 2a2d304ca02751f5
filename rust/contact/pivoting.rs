//! The linearised contact problem by complementary pivoting, for active sets that cycle.
//!
//! From any active set, the bounds that its forces and gaps violate are moved to where they hold,
//!     f_i >= -t a_i,   g_i >= -t b_i,
//! so that the set solves the problem at t = 1. Along the path of solutions t falls to 0, and at every
//! kink one node enters or leaves the set (Lemke, Management Science 11 (1965) 681; Cottle, Pang & Stone,
//! "The Linear Complementarity Problem" (2009), section 4.5; here the covering vector follows from the
//! set). If the compliance is positive definite, symmetric or not, there is one solution for every t and
//! t only falls. Otherwise t may rise in between; if it rises without end there is no solution.

use super::active_set_system::ActiveSetSystem;
use super::complementarity_problem::{ComplementarityProblem, Contact};
use crate::executor::Executor;
use crate::linear::add;
use crate::settings::Settings;
use crate::status::Status;

/// Changes of single nodes of the active set.
const ROUNDS: usize = 2000;

/// Bounds are moved further than needed by up to this share, different for each node, to avoid ties.
const SPREAD: f64 = 0.1;
/// Fractional parts of the multiples of the golden ratio are well separated.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Solve from the active set `start`, which must not be empty.
pub fn solve<'a>(
    problem: &ComplementarityProblem<'a, '_>,
    start: &[bool],
    settings: &Settings,
    executor: &Executor<'_>,
) -> Result<(Contact, ActiveSetSystem<'a>), Status> {
    let mut path = Path::new(problem, start, settings, executor)?;
    let (mut t, mut falling) = (1.0, true);
    for _ in 0..ROUNDS {
        let (system, [fixed, slope]) = path.lines(executor)?;
        if let Some(node) = path.changed {
            // The force or gap that the node has gained is zero here and must grow.
            falling = slope.distance[node] < 0.0;
        }
        // Follow the path to its next kink, or to t = 0.
        let kink = next_kink(&fixed.distance, &slope.distance, t, falling);
        let step = kink.map_or(f64::INFINITY, |(_, step)| step);
        if falling && step >= t {
            let contact = Contact {
                force: fixed.force,
                approach: fixed.approach,
                active_set: path.active_set,
            };
            return Ok((contact, system));
        }
        // One node enters or leaves the set there.
        let (node, _) = kink.ok_or(Status::NoActiveSet)?;
        t += if falling { -step } else { step };
        path.active_set[node] = !path.active_set[node];
        path.changed = Some(node);
    }
    Err(Status::NoActiveSet)
}

/// A point of the path: its active set, and how far the bounds are moved at t = 1.
struct Path<'a, 's> {
    problem: &'s ComplementarityProblem<'a, 's>,
    settings: &'s Settings,
    active_set: Vec<bool>,
    /// The node that entered or left the set last.
    changed: Option<usize>,
    force_shift: Vec<f64>,
    gap_shift: Vec<f64>,
}

/// One of the two parts of a solution that is linear in t.
struct Line {
    force: Vec<f64>,
    approach: f64,
    /// Distance from its bound of every node's force (in the set) or gap (out of it).
    distance: Vec<f64>,
}

impl<'a, 's> Path<'a, 's> {
    fn new(
        problem: &'s ComplementarityProblem<'a, 's>,
        start: &[bool],
        settings: &'s Settings,
        executor: &Executor<'_>,
    ) -> Result<Self, Status> {
        let nodes = start.len();
        let mut path = Self {
            problem,
            settings,
            active_set: start.to_vec(),
            changed: None,
            force_shift: vec![0.0; nodes],
            gap_shift: vec![0.0; nodes],
        };
        let (_, [fixed, _]) = path.lines(executor)?;
        for (i, distance) in fixed.distance.iter().enumerate() {
            let spread = 1.0 + SPREAD * (GOLDEN * (i + 1) as f64).fract();
            let shift = if start[i] { &mut path.force_shift } else { &mut path.gap_shift };
            shift[i] = spread * (-distance).max(0.0);
        }
        Ok(path)
    }

    /// The solution on the active set as fixed part + t slope; the other nodes lie on their bounds.
    fn lines(&self, executor: &Executor<'_>) -> Result<(ActiveSetSystem<'a>, [Line; 2]), Status> {
        let &problem = self.problem;
        let unloaded = ComplementarityProblem {
            free_gap: &vec![0.0; problem.free_gap.len()],
            load: 0.0,
            ..problem
        };
        let system = ActiveSetSystem::new(problem.compliance, &self.active_set, self.settings)?;
        let fixed = self.line(&system, &problem, 0.0, executor)?;
        let slope = self.line(&system, &unloaded, 1.0, executor)?;
        Ok((system, [fixed, slope]))
    }

    /// The solution of `problem` with the bounds moved `t` times as far as at t = 1.
    fn line(
        &self,
        system: &ActiveSetSystem<'_>,
        problem: &ComplementarityProblem<'_, '_>,
        t: f64,
        executor: &Executor<'_>,
    ) -> Result<Line, Status> {
        let inactive = |(shift, &active): (&f64, &bool)| if active { 0.0 } else { -t * shift };
        let nodes = self.force_shift.iter().zip(&self.active_set);
        let mut force: Vec<f64> = nodes.map(inactive).collect();
        let mut gap_to_close = problem.free_gap.to_vec();
        add(&mut gap_to_close, t, &self.gap_shift);
        problem.compliance.add_opening(&force, &mut gap_to_close);
        let load = problem.load - force.iter().sum::<f64>();
        let solution = system.solve(&gap_to_close, load, executor)?;
        let (active_force, approach) = solution.ok_or(Status::NoActiveSet)?;
        add(&mut force, 1.0, &active_force);
        let gap = problem.gaps(&force, approach);
        let distance = (0..force.len())
            .map(|i| match self.active_set[i] {
                true => force[i] + t * self.force_shift[i],
                false => gap[i] + t * self.gap_shift[i],
            })
            .collect();
        Ok(Line { force, approach, distance })
    }
}

/// The node that reaches its bound first as t changes from its present value, and by how much t then
/// has changed.
fn next_kink(fixed: &[f64], slope: &[f64], t: f64, falling: bool) -> Option<(usize, f64)> {
    let mut next: Option<(usize, f64)> = None;
    for (i, (fixed, slope)) in fixed.iter().zip(slope).enumerate() {
        let closing = if falling { *slope } else { -slope };
        if closing > 0.0 {
            let step = ((fixed + t * slope) / closing).max(0.0);
            if next.is_none_or(|(_, least)| step < least) {
                next = Some((i, step));
            }
        }
    }
    next
}
