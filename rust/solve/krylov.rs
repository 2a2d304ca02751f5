//! The linearised problem of a Newton step without a matrix, GMRES on displacement and pressure:
//!     J y - C^T df = r,   g + C y - dd = 0 on the nodes that touch,   sum f = load
//!
//! J is applied (`fem::jacobian`), its average along the rows solved (`fem::uniform`). With that in
//! place of J the whole problem, complementarity included, is dense in the contact forces alone: it
//! says which nodes touch. On that set, its conditions kept by every direction, GMRES brings the forces
//! into balance (constraint preconditioning: Keller, Gould & Wathen, SIAM J. Matrix Anal. Appl. 21
//! (2000) 1300). The next Newton step finds the next set: to iterate one problem on set after set, until
//! none changes, took more products and no fewer steps.

use super::increment::{Increment, Now};
use crate::contact::complementarity;
use crate::contact::held::Held;
use crate::contact::surface::Surface;
use crate::contact::touching::{Contact, Linearised};
use crate::contact::{PressedBlock, State};
use crate::fem::jacobian::{self, Jacobian};
use crate::fem::mesh::Mesh;
use crate::fem::uniform::{self, Uniform};
use crate::linear::{gmres, norm};
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// The forces out of balance may fall to this share, or to this absolute size.
#[derive(Debug, Clone, Copy)]
pub struct Accuracy {
    pub share: f64,
    pub least: f64,
}

/// Increment of a Newton step from `now` under `load`, the nodes of `set` held; the average tells them
/// where none are given.
pub fn increment(
    pressed: &PressedBlock<'_>,
    now: Now<'_>,
    set: Option<&[bool]>,
    load: f64,
    accuracy: Accuracy,
    settings: &Settings,
) -> Result<Increment, Status> {
    let Now {
        state,
        rows,
        balance,
        ..
    } = now;
    let watch = pressed.watch;
    let jacobian = Jacobian::new(&pressed.block, &state.field, rows, watch)?;
    let uniform = Uniform::new(&jacobian, watch)?;
    let step = Step {
        mesh: pressed.mesh(),
        watch,
        jacobian: &jacobian,
        uniform: &uniform,
        surface: Surface::new(&uniform, &balance.slope),
        bend: balance.bend(pressed, state),
        gap: &balance.gap,
        state,
        set,
        load,
        right: balance.to_undo(pressed),
    };
    step.solve(accuracy, settings)
}

/// One linearised problem.
struct Step<'a> {
    mesh: &'a Mesh,
    watch: &'a Watch<'a>,
    jacobian: &'a Jacobian<'a>,
    uniform: &'a Uniform<'a>,
    surface: Surface<'a>,
    /// Contact force times curvature of the profile, at every node.
    bend: Vec<f64>,
    gap: &'a [f64],
    state: &'a State,
    set: Option<&'a [bool]>,
    load: f64,
    right: Vec<f64>,
}

/// Where products and averaged solutions take place.
struct Rooms<'t> {
    product: jacobian::Room<'t>,
    uniform: uniform::Room<'t>,
    solution: Vec<f64>,
}

/// A solution on the way.
struct Iterate {
    y: Vec<f64>,
    contact: Contact,
    /// Forces and volumes out of balance.
    left: Vec<f64>,
}

impl Step<'_> {
    /// Contact by the average, then balance on its set.
    fn solve(&self, accuracy: Accuracy, settings: &Settings) -> Result<Increment, Status> {
        let mut rooms = Rooms {
            product: self.jacobian.room(self.watch.threads),
            uniform: self.uniform.room(self.watch.threads),
            solution: vec![0.0; self.right.len()],
        };
        let mut now = Iterate {
            y: vec![0.0; self.right.len()],
            contact: Contact {
                force: self.state.force.clone(),
                approach: self.state.approach,
                active: self.state.active.clone(),
            },
            left: self.right.clone(),
        };
        let moved = self.uniform.reduce(&now.left, &mut rooms.uniform);
        let (contact, held) = self.touching(&now, &moved, settings)?;
        self.correct(&mut now, contact, moved, &mut rooms);
        let largest = norm(&self.right).max(norm(&now.left));
        let target = (accuracy.share * largest).max(accuracy.least);
        let products = self.balance(&mut now, &held, target, &mut rooms, settings)?;
        let displacements = self.jacobian.displacements();
        let mut u = now.y[..displacements].to_vec();
        u.resize(self.state.field.u.len(), 0.0);
        Ok(Increment {
            u,
            pressure: self.by_element(&now.y[displacements..]),
            contact: now.contact,
            products,
        })
    }

    /// Contact of the linearised problem with the average in place of the Jacobian; what is left out
    /// of balance moves the surface by `moved`.
    fn touching(
        &self,
        now: &Iterate,
        moved: &[f64],
        settings: &Settings,
    ) -> Result<(Contact, Held<'_>), Status> {
        let answered = self
            .surface
            .answer(&self.surface.forces(&now.contact.force));
        let surface = now.y.iter().zip(moved).zip(answered);
        let free: Vec<f64> = surface
            .map(|((y, moved), answered)| y + moved - answered)
            .collect();
        let mut free = self.surface.opening(&free);
        for (free, gap) in free.iter_mut().zip(self.gap) {
            *free += gap + self.state.approach;
        }
        if free.iter().any(|gap| !gap.is_finite()) {
            return Err(Status::NotFinite);
        }
        let problem = Linearised {
            compliance: &self.surface,
            free: &free,
            load: self.load,
        };
        match self.set {
            None => complementarity::solve(&problem, &now.contact.active, settings, self.watch),
            Some(active) => complementarity::on_set(&problem, active, settings, self.watch),
        }
    }

    /// Let the average answer to what is left, of which it has been reduced to `moved`, and to new
    /// contact forces.
    fn correct(&self, now: &mut Iterate, contact: Contact, moved: Vec<f64>, rooms: &mut Rooms<'_>) {
        let mut correction = std::mem::take(&mut rooms.solution);
        self.complete(
            moved,
            &difference(&contact.force, &now.contact.force),
            &mut correction,
            rooms,
        );
        for (y, change) in now.y.iter_mut().zip(&correction) {
            *y += change;
        }
        rooms.solution = correction;
        now.contact = contact;
        let change = difference(&now.contact.force, &self.state.force);
        self.product(&now.y, &change, &mut now.left, rooms);
        for (left, right) in now.left.iter_mut().zip(&self.right) {
            *left = right - *left;
        }
    }

    /// The averaged solution of what was reduced to `moved`, under contact forces as well.
    fn complete(
        &self,
        mut moved: Vec<f64>,
        forces: &[f64],
        out: &mut [f64],
        rooms: &mut Rooms<'_>,
    ) {
        let answered = self.surface.answer(&self.surface.forces(forces));
        for (u, answered) in moved.iter_mut().zip(answered) {
            *u += answered;
        }
        self.uniform.expand(&moved, out, &mut rooms.uniform);
    }

    /// `out` = J y - C^T `forces`.
    fn product(&self, y: &[f64], forces: &[f64], out: &mut [f64], rooms: &mut Rooms<'_>) {
        self.jacobian.product(y, out, &mut rooms.product);
        let shift = self.mesh.mean_shift(y);
        for (a, bend) in self.bend.iter().enumerate() {
            let at = self.mesh.place(a, 0);
            out[at] += bend * (y[at] - shift);
        }
        for (out, force) in out.iter_mut().zip(self.surface.forces(forces)) {
            *out -= force;
        }
    }

    /// Bring forces and volumes into balance with the nodes of `held` touching.
    fn balance(
        &self,
        now: &mut Iterate,
        held: &Held<'_>,
        target: f64,
        rooms: &mut Rooms<'_>,
        settings: &Settings,
    ) -> Result<usize, Status> {
        let mut failed = Ok(());
        let apply = |v: &[f64], out: &mut [f64]| {
            let mut solution = std::mem::take(&mut rooms.solution);
            match self.corrected(v, held, &mut solution, rooms) {
                Ok((force, _)) => self.product(&solution, &force, out, rooms),
                Err(status) => failed = Err(status),
            }
            rooms.solution = solution;
        };
        let limits = (settings.krylov_basis, settings.krylov_iterations);
        let found = gmres(apply, &now.left, target, limits, self.watch)?;
        failed?;
        let mut correction = std::mem::take(&mut rooms.solution);
        let (force, approach) = self.corrected(&found.y, held, &mut correction, rooms)?;
        for (y, change) in now.y.iter_mut().zip(&correction) {
            *y += change;
        }
        rooms.solution = correction;
        for (total, force) in now.contact.force.iter_mut().zip(&force) {
            *total += force;
        }
        now.contact.approach += approach;
        now.left = found.left;
        Ok(found.iterations)
    }

    /// The averaged solution for forces and volumes `v` that keeps the gaps of the nodes held, with
    /// the forces and the approach that keep them.
    fn corrected(
        &self,
        v: &[f64],
        held: &Held<'_>,
        out: &mut [f64],
        rooms: &mut Rooms<'_>,
    ) -> Result<(Vec<f64>, f64), Status> {
        let moved = self.uniform.reduce(v, &mut rooms.uniform);
        let opening = self.surface.opening(&moved);
        let kept = held.close(&opening, 0.0, self.watch)?;
        let (force, approach) = kept.ok_or(Status::NoActiveSet)?;
        self.complete(moved, &force, out, rooms);
        Ok((force, approach))
    }

    /// Pressures `[row][mode][column]` in the order of a field, `[row][column][mode]`.
    fn by_element(&self, pressure: &[f64]) -> Vec<f64> {
        let (modes, columns) = (self.mesh.modes(), self.mesh.columns);
        let rows = pressure.chunks_exact(modes * columns);
        let places = rows.flat_map(|row| {
            (0..columns).flat_map(move |column| (0..modes).map(move |m| row[m * columns + column]))
        });
        places.collect()
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
