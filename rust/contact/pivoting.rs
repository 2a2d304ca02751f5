//! The linearised contact problem by complementary pivots: for active sets that do not settle.
//!
//! From any active set, the bounds that its forces and gaps break are moved to where they hold,
//!     f_i >= -t a_i,   g_i >= -t b_i,
//! so that it solves the problem at t = 1. Along the path of solutions t falls to 0, and at every
//! kink one node changes sides (Lemke, Management Science 11 (1965) 681; Cottle, Pang & Stone, "The
//! Linear Complementarity Problem" (2009), section 4.5; the covering vector suits the set). Where the
//! compliance is positive definite, symmetric or not, there is one solution for every t and t only
//! falls. Elsewhere it may rise in between; where it rises for ever there is no answer.

use super::held::Held;
use super::touching::{gaps, Contact, Linearised};
use crate::linear::add;
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// Share by which bounds are moved further than needed, different for each node: none shall tie.
const SPREAD: f64 = 0.1;
/// Multiples of the golden ratio stay apart from one another.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Solve from the active set `start`, which must not be empty.
pub fn solve<'a>(
    problem: &Linearised<'a, '_>,
    start: &[bool],
    settings: &Settings,
    watch: &Watch<'_>,
) -> Result<(Contact, Held<'a>), Status> {
    let mut path = Path::from(problem, start, settings, watch)?;
    let (mut t, mut falling) = (1.0, true);
    for _ in 0..settings.single_node_rounds {
        let (held, [fixed, slope]) = path.lines(watch)?;
        if let Some(node) = path.changed {
            // What the node has now, a force or a gap, is zero and must grow.
            falling = slope.distance[node] < 0.0;
        }
        let kink = next_kink(&fixed.distance, &slope.distance, t, falling);
        let step = kink.map_or(f64::INFINITY, |(_, step)| step);
        if falling && step >= t {
            let contact = Contact {
                force: fixed.force,
                approach: fixed.approach,
                active: path.active,
            };
            return Ok((contact, held));
        }
        let (node, _) = kink.ok_or(Status::NoActiveSet)?;
        t += if falling { -step } else { step };
        path.active[node] = !path.active[node];
        path.changed = Some(node);
    }
    Err(Status::NoActiveSet)
}

/// Where on the path: the active set, and how far bounds are moved at t = 1.
struct Path<'a, 's> {
    problem: &'s Linearised<'a, 's>,
    settings: &'s Settings,
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

impl<'a, 's> Path<'a, 's> {
    fn from(
        problem: &'s Linearised<'a, 's>,
        start: &[bool],
        settings: &'s Settings,
        watch: &Watch<'_>,
    ) -> Result<Self, Status> {
        let nodes = start.len();
        let mut path = Self {
            problem,
            settings,
            active: start.to_vec(),
            changed: None,
            force_moved: vec![0.0; nodes],
            gap_moved: vec![0.0; nodes],
        };
        let (_, [fixed, _]) = path.lines(watch)?;
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
    fn lines(&self, watch: &Watch<'_>) -> Result<(Held<'a>, [Line; 2]), Status> {
        let &Linearised {
            compliance,
            free,
            load,
        } = self.problem;
        let held = Held::new(compliance, &self.active, self.settings)?;
        let fixed = self.line(&held, free, load, 0.0, watch)?;
        let slope = self.line(&held, &vec![0.0; free.len()], 0.0, 1.0, watch)?;
        Ok((held, [fixed, slope]))
    }

    /// The solution for gaps `free` under `load` where bounds are `moved` times as far as at t = 1.
    fn line(
        &self,
        held: &Held<'_>,
        free: &[f64],
        load: f64,
        moved: f64,
        watch: &Watch<'_>,
    ) -> Result<Line, Status> {
        let compliance = self.problem.compliance;
        let open = |(force, &active): (&f64, &bool)| if active { 0.0 } else { -moved * force };
        let mut force: Vec<f64> = self
            .force_moved
            .iter()
            .zip(&self.active)
            .map(open)
            .collect();
        let mut to_close = free.to_vec();
        add(&mut to_close, moved, &self.gap_moved);
        compliance.open(&force, &mut to_close);
        let load = load - force.iter().sum::<f64>();
        let solved = held.close(&to_close, load, watch)?;
        let (on_set, approach) = solved.ok_or(Status::NoActiveSet)?;
        add(&mut force, 1.0, &on_set);
        let gap = gaps(compliance, free, &force, approach);
        let distance = (0..force.len())
            .map(|i| match self.active[i] {
                true => force[i] + moved * self.force_moved[i],
                false => gap[i] + moved * self.gap_moved[i],
            })
            .collect();
        Ok(Line {
            force,
            approach,
            distance,
        })
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
