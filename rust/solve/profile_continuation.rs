//! Continuation from a smooth profile to a rough one: a coarse mesh begins with the long waves alone, and
//! every finer mesh adds the waves that it resolves.
//!
//! The elasticity of its neighbours keeps a node on a crest from sliding off it, if nodes are so close that
//! the slope changes little from one to the next. With fewer nodes the block has states that no finer mesh
//! has, and Newton's method jumps between them. From the solution for a smoother profile on the mesh before,
//! Newton's method needs some ten steps; if it fails, the new waves are added in smaller parts, which grow
//! again after an easy step: on a sharp crest one part of the way is much harder than the rest.

use super::load_stepping::{raise, EASY_ITERATIONS};
use super::mesh_sequence::COARSEST_NODES;
use super::newton;
use super::transfer::transfer;
use crate::contact::profile::Heights;
use crate::contact::State;
use crate::executor::Executor;
use crate::fem::mesh::{Mesh, MeshSize};
use crate::model::Model;
use crate::settings::Settings;
use crate::solution::{Counts, Report};
use crate::status::Status;

/// Newton iterations without a smaller residual after which waves are added in smaller parts.
const PATIENCE: usize = 4;
/// Largest share of the residual forces to which the linearised problem is solved while waves are added.
const KRYLOV_SHARE: f64 = 0.03;
/// Largest change of the displacement gradient in one Newton iteration while waves are added.
const LARGEST_STEP: f64 = 1.0;

/// The problem, independent of the mesh.
pub struct ProfileContinuation<'a> {
    pub model: &'a Model,
    pub size: &'a MeshSize,
    pub load: f64,
    /// Load time in passages of the wave.
    pub passages: f64,
    pub settings: &'a Settings,
    pub executor: &'a Executor<'a>,
}

/// Why a rough profile was not solved on a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Unsolved {
    pub status: Status,
    /// Number of waves, from the longest, with which the profile carried the load on any mesh.
    pub waves: usize,
}

/// A solution for a smoother profile or a coarser mesh.
struct Stage {
    mesh: Mesh,
    heights: Heights,
    state: State,
    report: Report,
    /// Number of waves, from the longest, that the profile has in full.
    waves: usize,
}

/// A mesh and the number of waves to solve on it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Target {
    columns: usize,
    waves: usize,
}

impl ProfileContinuation<'_> {
    /// The solution on a mesh of `columns`. None if the profile is smooth for the mesh, or if its longest
    /// waves alone do not carry the load: load stepping on the mesh itself then gives the reason.
    pub fn solve(
        &self,
        columns: usize,
        counts: &mut Counts,
    ) -> Option<Result<(State, Report), Unsolved>> {
        let targets = self.targets(columns);
        if targets.len() < 2 {
            return None;
        }
        match self.begin(targets[0], counts) {
            Ok(first) => Some(self.through(first, &targets[1..], counts)),
            Err(status) if status.interrupts() => Some(Err(Unsolved { status, waves: 0 })),
            Err(_) => None,
        }
    }

    /// The waves that each mesh resolves, from the coarsest mesh to all waves on the last. One mesh alone
    /// if the profile is smooth for it.
    fn targets(&self, columns: usize) -> Vec<Target> {
        let (order, all) = (self.size.order, self.model.heights.waves());
        let resolved =
            |columns: usize| (order * columns / self.settings.nodes_per_wave).clamp(1, all);
        let mut targets = vec![Target { columns, waves: all }];
        let mut columns = columns;
        while targets[0].waves > 1 {
            columns = columns.div_ceil(2);
            let smooth = targets.len() == 1 && resolved(columns) == all;
            if smooth || order * columns < COARSEST_NODES {
                break;
            }
            let waves = resolved(columns);
            targets.insert(0, Target { columns, waves });
        }
        targets
    }

    fn through(
        &self,
        first: Stage,
        targets: &[Target],
        counts: &mut Counts,
    ) -> Result<(State, Report), Unsolved> {
        let mut last = first;
        for (i, &target) in targets.iter().enumerate() {
            let waves = last.waves;
            let unsolved = |status| Unsolved { status, waves };
            last =
                self.add_waves(last, target, i + 1 == targets.len(), counts).map_err(unsolved)?;
        }
        Ok((last.state, last.report))
    }

    fn mesh(&self, columns: usize) -> Mesh {
        Mesh::new(&self.size.with_columns(columns, self.settings.row_exponent))
    }

    /// The longest waves, by load stepping.
    fn begin(&self, target: Target, counts: &mut Counts) -> Result<Stage, Status> {
        let mesh = self.mesh(target.columns);
        let memory = self.model.sliding_memory(&mesh, self.passages);
        let model = self.model.with_heights(self.model.heights.smoothed(target.waves));
        let pressed = model.pressed(&mesh, &memory, self.executor);
        let mut state = State::at_rest(&mesh);
        let report = raise(&pressed, &mut state, self.load, self.settings, counts);
        report.converged()?;
        Ok(Stage { mesh, heights: model.heights, state, report, waves: target.waves })
    }

    /// Add the waves of `target` on its mesh, in as many parts as necessary: all of them on the `final_mesh`,
    /// elsewhere in halves only, because the rest is easier on the next mesh.
    fn add_waves(
        &self,
        last: Stage,
        target: Target,
        final_mesh: bool,
        counts: &mut Counts,
    ) -> Result<Stage, Status> {
        let mesh = self.mesh(target.columns);
        let memory = self.model.sliding_memory(&mesh, self.passages);
        let settings = Settings {
            patience: PATIENCE,
            max_iterations: self.settings.roughening_iterations,
            krylov_share: KRYLOV_SHARE,
            largest_step: LARGEST_STEP,
            ..*self.settings
        };
        let rougher = self.model.heights.smoothed(target.waves);
        let mut state = transfer(&last.mesh, &last.state, &mesh, 1.0);
        let (mut reached, mut added, mut part) = (None, 0.0, 1.0_f64);
        let least = if final_mesh { self.settings.smallest_roughening } else { 0.5 };
        while part >= least {
            // Try the profile with a part of the new waves.
            let share = (added + part).min(1.0);
            let model = self.model.with_heights(last.heights.toward(&rougher, share));
            let pressed = model.pressed(&mesh, &memory, self.executor);
            let mut trial = state.clone();
            let report = newton::solve(&pressed, &mut trial, self.load, &settings);
            counts.add(&report);
            // Go on from it with a larger part, or from the last one with a smaller part.
            match report.status {
                Status::Converged if share == 1.0 => {
                    return Ok(Stage {
                        mesh,
                        heights: rougher,
                        state: trial,
                        report,
                        waves: target.waves,
                    })
                }
                Status::Converged => {
                    if report.iterations <= EASY_ITERATIONS {
                        part *= 2.0;
                    }
                    (state, added) = (trial, share);
                    reached = Some((model.heights, report));
                }
                status if status.interrupts() => return Err(status),
                _ => part = 0.5 * (share - added),
            }
        }
        match reached {
            _ if final_mesh => Err(Status::ProfileTooRough),
            None => Ok(last),
            Some((heights, report)) => Ok(Stage { mesh, heights, state, report, ..last }),
        }
    }
}
