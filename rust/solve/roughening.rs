//! From smooth to rough: where a profile has waves that coarse meshes cannot follow, these begin with
//! the long ones alone and every finer mesh adds those that it resolves.
//!
//! A node that touches a crest is held by the elasticity of its neighbours against rolling off it,
//! which takes nodes so close that the slope changes little from one to the next: with fewer, the block
//! has states that no finer mesh has, and Newton's method runs from one to the next. From a smoother
//! profile on the mesh before it finds the rough one in some ten steps, or the new waves grow in parts.

use super::load_stepping::{raise, Counts};
use super::newton::{self, Report};
use super::transfer::transfer;
use crate::contact::profile::Heights;
use crate::contact::State;
use crate::fem::block::Memory;
use crate::fem::mesh::{Mesh, MeshSize};
use crate::model::Model;
use crate::settings::Settings;
use crate::status::Status;
use crate::watch::Watch;

/// What is pressed and how, whatever the mesh.
pub struct Roughening<'a> {
    pub model: &'a Model,
    pub size: &'a MeshSize,
    pub load: f64,
    pub settings: &'a Settings,
    pub watch: &'a Watch<'a>,
    /// What the networks remember on a mesh.
    pub memory: &'a dyn Fn(&Mesh) -> Memory,
}

/// Why a rough profile was not solved on a mesh.
#[derive(Debug, Clone, Copy)]
pub struct Ended {
    pub status: Status,
    /// Waves from the longest with which the profile did carry the load, on any mesh.
    pub waves: usize,
}

/// A solution on the way.
struct Stage {
    mesh: Mesh,
    heights: Heights,
    state: State,
    report: Report,
    /// The first waves that are all there.
    waves: usize,
}

/// A mesh and the waves it is to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Aim {
    columns: usize,
    waves: usize,
}

impl Roughening<'_> {
    /// The solution on a mesh of so many `columns`. None where the profile is smooth for it, or where
    /// the longest waves alone do not carry the load: raised anew on the mesh itself, it says why.
    pub fn solve(
        &self,
        columns: usize,
        counts: &mut Counts,
    ) -> Option<Result<(State, Report), Ended>> {
        let aims = self.aims(columns);
        if aims.len() < 2 {
            return None;
        }
        match self.begin(aims[0], counts) {
            Ok(first) => Some(self.through(first, &aims[1..], counts)),
            Err(Status::TimeLimit) => Some(Err(Ended {
                status: Status::TimeLimit,
                waves: 0,
            })),
            Err(_) => None,
        }
    }

    /// Waves that a mesh resolves, but not all of them where coarser meshes are to begin.
    fn aims(&self, columns: usize) -> Vec<Aim> {
        let (order, all) = (self.size.order, self.model.heights.waves());
        let resolved =
            |columns: usize| (order * columns / self.settings.nodes_per_wave).clamp(1, all);
        let mut aims = vec![Aim {
            columns,
            waves: all,
        }];
        let mut columns = columns;
        while aims[0].waves > 1 {
            columns = columns.div_ceil(2);
            let smooth = aims.len() == 1 && resolved(columns) == all;
            if smooth || order * columns < self.settings.coarsest_nodes {
                break;
            }
            let waves = resolved(columns);
            aims.insert(0, Aim { columns, waves });
        }
        aims
    }

    fn through(
        &self,
        first: Stage,
        aims: &[Aim],
        counts: &mut Counts,
    ) -> Result<(State, Report), Ended> {
        let mut last = first;
        for (i, &aim) in aims.iter().enumerate() {
            let waves = last.waves;
            let ended = |status| Ended { status, waves };
            last = self
                .add(last, aim, i + 1 == aims.len(), counts)
                .map_err(ended)?;
        }
        Ok((last.state, last.report))
    }

    fn mesh(&self, columns: usize) -> Mesh {
        Mesh::new(&self.size.with_columns(columns, self.settings.row_exponent))
    }

    /// The first waves, from a small load.
    fn begin(&self, aim: Aim, counts: &mut Counts) -> Result<Stage, Status> {
        let mesh = self.mesh(aim.columns);
        let memory = (self.memory)(&mesh);
        let model = self.model.on(self.model.heights.smoothed(aim.waves));
        let pressed = model.pressed(&mesh, &memory, self.watch);
        let mut state = State::at_rest(&mesh);
        let (report, _) = raise(&pressed, &mut state, self.load, self.settings, counts);
        report.converged()?;
        Ok(Stage {
            mesh,
            heights: model.heights,
            state,
            report,
            waves: aim.waves,
        })
    }

    /// The waves of `aim` on its mesh, in as many parts as it takes: to the `end`, or as far as one
    /// half brings, for what is left is easier on the next mesh.
    fn add(&self, last: Stage, aim: Aim, end: bool, counts: &mut Counts) -> Result<Stage, Status> {
        let mesh = self.mesh(aim.columns);
        let memory = (self.memory)(&mesh);
        let settings = Settings {
            patience: self.settings.roughening_patience,
            max_iterations: self.settings.roughening_iterations,
            ..*self.settings
        };
        let target = self.model.heights.smoothed(aim.waves);
        let mut state = transfer(&last.mesh, &last.state, &mesh, 1.0);
        let (mut reached, mut done, mut part) = (None, 0.0, 1.0_f64);
        let least = if end {
            self.settings.smallest_roughening
        } else {
            0.5
        };
        while part >= least {
            let share = (done + part).min(1.0);
            let model = self.model.on(last.heights.toward(&target, share));
            let pressed = model.pressed(&mesh, &memory, self.watch);
            let mut trial = state.clone();
            let report = newton::solve(&pressed, &mut trial, self.load, &settings);
            counts.add(&report);
            counts.load_steps += 1;
            match report.status {
                Status::Converged if share == 1.0 => {
                    return Ok(Stage {
                        mesh,
                        heights: target,
                        state: trial,
                        report,
                        waves: aim.waves,
                    })
                }
                Status::Converged => {
                    (state, done) = (trial, share);
                    reached = Some((model.heights, report));
                }
                Status::TimeLimit => return Err(Status::TimeLimit),
                _ => part *= 0.5,
            }
        }
        match reached {
            _ if end => Err(Status::ProfileTooRough),
            None => Ok(last),
            Some((heights, report)) => Ok(Stage {
                mesh,
                heights,
                state,
                report,
                ..last
            }),
        }
    }
}
