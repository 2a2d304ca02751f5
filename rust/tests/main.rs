//! The kernel's test ladder, from shape functions to whole waves, in one binary.

mod complementarity;
mod dissipation;
mod element_and_mesh;
mod energy;
mod hostile_input;
mod jacobian;
mod krylov;
mod linear;
mod local_tangent;
mod material_point;
mod mesh_sequence;
mod profile;
mod roughening;
mod settings;
mod sliding_history;
mod sparse_step;
mod steady;
mod threads;
mod transient;

use gripscale_kernel::contact::profile::Heights;
use gripscale_kernel::error::KernelError;
use gripscale_kernel::fem::block::{Block, Field, RowState};
use gripscale_kernel::fem::mesh::Mesh;
use gripscale_kernel::material::energy::Energy;
use gripscale_kernel::problem::{Load, MeshSize, Problem, Profile, Rubber};
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solution::Solution;
use gripscale_kernel::transient::{Run, Stage};
use gripscale_kernel::watch::Watch;

/// The inputs of one wave, changed field by field by the tests; unit wavelength and modulus.
#[derive(Clone)]
pub struct Case {
    pub energy: (&'static str, Vec<(&'static str, f64)>),
    pub equilibrium_modulus: f64,
    pub moduli: Vec<f64>,
    pub relaxation_times: Vec<f64>,
    pub bulk_modulus: f64,
    pub wavelength: f64,
    pub amplitude: f64,
    /// Samples in place of the sine.
    pub heights: Option<Vec<f64>>,
    pub pressure: f64,
    pub speed: f64,
    pub load_time: f64,
    pub depth: f64,
    pub columns: usize,
    pub rows: usize,
    pub order: usize,
    pub settings: Settings,
    pub tolerance: Option<f64>,
}

impl Case {
    pub fn elastic(amplitude: f64, pressure: f64) -> Self {
        Self {
            energy: ("neo_hookean", vec![]),
            equilibrium_modulus: 1.0,
            moduli: vec![],
            relaxation_times: vec![],
            bulk_modulus: 1000.0,
            wavelength: 1.0,
            amplitude,
            heights: None,
            pressure,
            speed: 0.0,
            load_time: f64::INFINITY,
            depth: 1.5,
            columns: 64,
            rows: 14,
            order: 1,
            settings: Settings::default(),
            tolerance: None,
        }
    }

    fn heights(&self) -> Result<Heights, KernelError> {
        match &self.heights {
            Some(samples) => Heights::sampled(samples),
            None => Heights::sine(self.amplitude),
        }
    }

    pub fn problem(&self) -> Result<Problem, KernelError> {
        Ok(Problem {
            rubber: Rubber::new(
                new_energy(self.energy.0, &self.energy.1)?,
                self.equilibrium_modulus,
                self.moduli.clone(),
                self.relaxation_times.clone(),
                self.bulk_modulus,
            )?,
            profile: Profile::new(self.wavelength, self.heights()?)?,
            load: Load::new(self.pressure, self.speed, self.load_time)?,
            mesh: MeshSize::new(self.columns, self.rows, self.depth, self.order)?,
        })
    }

    pub fn solve(&self, start: Option<&Solution>) -> Result<Solution, KernelError> {
        self.watched(start, &Watch::endless())
    }

    pub fn watched(
        &self,
        start: Option<&Solution>,
        watch: &Watch<'_>,
    ) -> Result<Solution, KernelError> {
        let problem = self.problem()?;
        gripscale_kernel::steady::solve(&problem, &self.settings, self.tolerance, start, watch)
    }

    pub fn run(&self, stages: &[Stage], start: Option<&Solution>) -> Result<Run, KernelError> {
        let Problem {
            rubber,
            profile,
            mesh,
            ..
        } = self.problem()?;
        let watch = Watch::endless();
        let settings = &self.settings;
        gripscale_kernel::transient::solve(
            &rubber, &profile, &mesh, settings, stages, start, &watch,
        )
    }
}

pub fn mesh(columns: usize, rows: usize, depth: f64, order: usize) -> Mesh {
    Mesh::new(&MeshSize::new(columns, rows, depth, order).unwrap())
}

fn new_energy(kind: &str, parameters: &[(&str, f64)]) -> Result<Energy, KernelError> {
    let parameters = parameters
        .iter()
        .map(|&(name, value)| (name.to_owned(), value));
    Energy::new(kind, &parameters.collect())
}

pub fn energy(kind: &str, parameters: &[(&str, f64)]) -> Energy {
    new_energy(kind, parameters).unwrap()
}

/// Let the pressures of one row be what its volumes ask for.
pub fn balance_volumes(block: &Block<'_>, row: usize, state: &RowState, field: &mut Field) {
    let volumes = block.row_volumes(row, field, state);
    let masses = &block.mesh.elements[row].mode_mass;
    let (columns, at) = (block.mesh.columns, row * volumes.len());
    for (i, volume) in volumes.into_iter().enumerate() {
        let (mode, column) = (i / columns, i % columns);
        let pressure = &mut field.pressure[at + column * masses.len() + mode];
        *pressure += block.bulk_modulus / masses[mode] * volume;
    }
}

/// A reproducible pseudo-random number in [-1, 1) (splitmix64), for fields without structure.
pub fn noise(index: usize) -> f64 {
    let mut z = (index as u64).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}
