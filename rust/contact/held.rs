//! The linearised contact problem where it is known which nodes touch: linear, with one border,
//!     C f - d = -free on the nodes that touch,   sum f = load.
//!
//! Few nodes are factored. For many, of which a matrix would take more memory than the block, GMRES: C
//! is a convolution but for the slopes of the profile, and its inverse between all nodes, cut down to
//! those that touch, is near the inverse of what C is between them (the edges alone tell them apart).

use super::touching::{Compliance, Inverse};
use crate::linear::{add, gmres, norm, Factor, Matrix};
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// Share of the gaps that iteration leaves open: some digits of what a factor leaves, far below what a
/// solution may.
const ITERATED_TO: f64 = 1e-13;
/// Directions kept in the iteration, and most products: 9 to 17 are needed.
const LIMITS: (usize, usize) = (100, 300);

/// Where the compliance has no inverse to start from, more nodes than this are not factored either.
const MOST_FACTORED: usize = 2048;

/// Nodes held in contact.
pub struct Held<'a> {
    compliance: &'a dyn Compliance,
    /// Number of all nodes.
    nodes: usize,
    set: Vec<usize>,
    way: Way<'a>,
}

enum Way<'a> {
    Factored { factor: Factor, border: f64 },
    Iterated(Nearly<'a>),
}

/// The compliance's inverse between all nodes, with the forces at the nodes held that it has for one
/// approach of them all.
struct Nearly<'a> {
    inverse: Inverse<'a>,
    raised: Vec<f64>,
}

impl<'a> Held<'a> {
    pub fn new(
        compliance: &'a dyn Compliance,
        active: &[bool],
        settings: &Settings,
    ) -> Result<Self, Status> {
        let set: Vec<usize> = (0..active.len()).filter(|&a| active[a]).collect();
        if set.is_empty() {
            return Err(Status::NoActiveSet);
        }
        let few = set.len() <= settings.factored_contacts;
        let inverse = if few { None } else { compliance.inverse(&set) };
        if inverse.is_none() && set.len() > MOST_FACTORED {
            return Err(Status::NoActiveSet);
        }
        let way = inverse.map_or_else(
            || factored(compliance, &set),
            |inverse| nearly(inverse, active, &set),
        );
        Ok(Self {
            compliance,
            nodes: active.len(),
            set,
            way,
        })
    }

    /// Forces at all nodes, `load` together, and the approach, with which the gaps `free` close; none
    /// if they cannot be told.
    pub fn close(
        &self,
        free: &[f64],
        load: f64,
        watch: &Watch<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        watch.look()?;
        let right: Vec<f64> = self.set.iter().map(|&a| -free[a]).collect();
        let solved = match &self.way {
            Way::Factored { factor, border } => solve(factor, *border, right, load),
            Way::Iterated(nearly) => self.iterate(nearly, &right, load, watch)?,
        };
        Ok(solved.map(|(force, approach)| (self.spread(&force), approach)))
    }

    fn iterate(
        &self,
        nearly: &Nearly<'_>,
        right: &[f64],
        load: f64,
        watch: &Watch<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Status> {
        let (mut force, mut approach) = self.guess(nearly, right, load);
        let mut left = right.to_vec();
        add(&mut left, -1.0, &self.opened(&force, approach));
        let target = ITERATED_TO * norm(right);
        // Every guess has the load that is asked for: what is left has none.
        let apply = |v: &[f64], out: &mut [f64]| {
            let (force, approach) = self.guess(nearly, v, 0.0);
            out.copy_from_slice(&self.opened(&force, approach));
        };
        let found = gmres(apply, &left, target, LIMITS, watch)?;
        let (more, higher) = self.guess(nearly, &found.y, 0.0);
        add(&mut force, 1.0, &more);
        approach += higher;
        Ok((norm(&found.left) <= target).then_some((force, approach)))
    }

    /// Forces, `load` together, and approach that nearly open the nodes held by `opening`.
    fn guess(&self, nearly: &Nearly<'_>, opening: &[f64], load: f64) -> (Vec<f64>, f64) {
        let mut force = cut(&(nearly.inverse)(&self.spread(opening)), &self.set);
        let missing = load - force.iter().sum::<f64>();
        let approach = missing / nearly.raised.iter().sum::<f64>();
        add(&mut force, approach, &nearly.raised);
        (force, approach)
    }

    /// By what forces and approach open the nodes held.
    fn opened(&self, force: &[f64], approach: f64) -> Vec<f64> {
        let mut gap = vec![-approach; self.nodes];
        self.compliance.open(&self.spread(force), &mut gap);
        cut(&gap, &self.set)
    }

    /// Values of the nodes held, zero elsewhere.
    fn spread(&self, values: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.nodes];
        for (&a, value) in self.set.iter().zip(values) {
            all[a] = *value;
        }
        all
    }
}

fn factored<'a>(compliance: &dyn Compliance, set: &[usize]) -> Way<'a> {
    let n = set.len();
    // Of the compliance's size, so that pivoting sees comparable rows.
    let border = compliance.between(set[0], set[0]).abs().max(1e-300);
    let entry = |i: usize, j: usize| {
        if i < n && j < n {
            compliance.between(set[i], set[j])
        } else if i < n || j < n {
            border * if i < n { -1.0 } else { 1.0 }
        } else {
            0.0
        }
    };
    let factor = Factor::new(&Matrix::from_fn(n + 1, n + 1, entry));
    Way::Factored { factor, border }
}

fn solve(factor: &Factor, border: f64, mut right: Vec<f64>, load: f64) -> Option<(Vec<f64>, f64)> {
    right.push(border * load);
    let told = factor.solve(&mut right);
    let approach = border * right.pop()?;
    told.then_some((right, approach))
}

fn nearly<'a>(inverse: Inverse<'a>, active: &[bool], set: &[usize]) -> Way<'a> {
    let ones: Vec<f64> = active.iter().map(|&touches| f64::from(touches)).collect();
    let raised = cut(&inverse(&ones), set);
    Way::Iterated(Nearly { inverse, raised })
}

/// The values at the nodes of `set`.
fn cut(values: &[f64], set: &[usize]) -> Vec<f64> {
    set.iter().map(|&a| values[a]).collect()
}
