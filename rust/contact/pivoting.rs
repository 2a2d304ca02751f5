//! The linearised contact problem by complementary pivots: for active sets that do not settle.
//!
//! From any active set, the bounds that its forces and gaps break are moved to where they hold,
//!     f_i >= -t a_i,   g_i >= -t b_i,
//! so that it solves the problem at t = 1. Along the path of solutions t falls to 0, and at every
//! kink one node changes sides (Lemke, Management Science 11 (1965) 681; Cottle, Pang & Stone, "The
//! Linear Complementarity Problem" (2009), section 4.5; the covering vector suits the set). Where the
//! compliance is positive definite, symmetric or not, there is one solution for every t and t only
//! falls. Elsewhere it may rise in between; where it rises for ever there is no answer.

use super::touching::{gaps, Contact, Linearised};
use crate::linear::{solve_columns, Matrix};
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// Share by which bounds are moved further than needed, different for each node: none shall tie.
const SPREAD: f64 = 0.1;
/// Multiples of the golden ratio stay apart from one another.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Solve from the active set `start`, which must not be empty.
pub fn solve(
    problem: &Linearised<'_>,
    start: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<Contact, Status> {
    let mut path = Path::from(problem, start, watch)?;
    let (mut t, mut falling) = (1.0, true);
    for _ in 0..settings.single_node_rounds {
        let (fixed, slope) = path.lines(watch)?;
        if let Some(node) = path.changed {
            // What the node has now, a force or a gap, is zero and must grow.
            falling = slope.distance[node] < 0.0;
        }
        let kink = next_kink(&fixed.distance, &slope.distance, t, falling);
        let step = kink.map_or(f64::INFINITY, |(_, step)| step);
        if falling && step >= t {
            return Ok(Contact {
                force: fixed.force,
                approach: fixed.approach,
                active: path.active,
            });
        }
        let (node, _) = kink.ok_or(Status::NoActiveSet)?;
        t += if falling { -step } else { step };
        path.active[node] = !path.active[node];
        path.changed = Some(node);
    }
    Err(Status::NoActiveSet)
}

/// Where on the path: the active set, and how far bounds are moved at t = 1.
struct Path<'a> {
    problem: &'a Linearised<'a>,
    active: Vec<bool>,
    /// The node that changed sides last.
    changed: Option<usize>,
    force_moved: Vec<f64>,
    gap_moved: Vec<f64>,
}

/// One of the two parts of a solution that is linear in t.
struct Line {
    force: Vec<f64>,
    approach: f64,
    /// Of every node's force (closed) or gap (open) from its bound.
    distance: Vec<f64>,
}

impl<'a> Path<'a> {
    fn from(
        problem: &'a Linearised<'a>,
        start: &[bool],
        watch: &Watch<'_>,
    ) -> Result<Self, Status> {
        let nodes = start.len();
        let mut path = Self {
            problem,
            active: start.to_vec(),
            changed: None,
            force_moved: vec![0.0; nodes],
            gap_moved: vec![0.0; nodes],
        };
        let (fixed, _) = path.lines(watch)?;
        for (i, distance) in fixed.distance.iter().enumerate() {
            let spread = 1.0 + SPREAD * (GOLDEN * (i + 1) as f64).fract();
            let moved = if start[i] {
                &mut path.force_moved
            } else {
                &mut path.gap_moved
            };
            moved[i] = spread * (-distance).max(0.0);
        }
        Ok(path)
    }

    /// The solution on the active set as fixed part + t slope; bounds hold where nodes lie on them.
    fn lines(&self, watch: &Watch<'_>) -> Result<(Line, Line), Status> {
        let Linearised {
            compliance,
            free,
            load,
        } = *self.problem;
        let nodes = free.len();
        let held: Vec<f64> = (0..nodes)
            .map(|i| {
                if self.active[i] {
                    0.0
                } else {
                    -self.force_moved[i]
                }
            })
            .collect();
        let opened = gaps(compliance, &vec![0.0; nodes], &held, 0.0);
        let set: Vec<usize> = (0..nodes).filter(|&i| self.active[i]).collect();
        if set.is_empty() {
            return Err(Status::NoActiveSet);
        }
        let matrix = self.problem.bordered(&set, watch.threads);
        let border = self.problem.border(&set);
        let right = Matrix::from_fn(set.len() + 1, 2, |row, column| {
            match (set.get(row), column) {
                (Some(&i), 0) => -free[i],
                (Some(&i), _) => -self.gap_moved[i] - opened[i],
                (None, 0) => border * load,
                (None, _) => -border * held.iter().sum::<f64>(),
            }
        });
        let solved = solve_columns(&matrix, right, watch)?.ok_or(Status::NoActiveSet)?;
        let line = |column: usize, free: &[f64], outside: &[f64], moved: f64| {
            let mut force = outside.to_vec();
            for (row, &i) in set.iter().enumerate() {
                force[i] = solved[(row, column)];
            }
            let approach = border * solved[(set.len(), column)];
            let gap = gaps(compliance, free, &force, approach);
            let distance = (0..nodes)
                .map(|i| match self.active[i] {
                    true => force[i] + moved * self.force_moved[i],
                    false => gap[i] + moved * self.gap_moved[i],
                })
                .collect();
            Line {
                force,
                approach,
                distance,
            }
        };
        let nothing = vec![0.0; nodes];
        Ok((line(0, free, &nothing, 0.0), line(1, &nothing, &held, 1.0)))
    }
}

/// The node that reaches its bound first on the way of t from where it is, and how far that is.
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
