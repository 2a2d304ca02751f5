//! What tests share: one wave through the entry points of the kernel, meshes, energies and fields.

use proptest::test_runner::{Config as ProptestConfig, FileFailurePersistence};

use crate::cancel::Cancel;
use crate::error::KernelError;
use crate::executor::Executor;
use crate::fem::block::{Block, Field, RowState};
use crate::fem::mesh::Mesh;
use crate::problem::{Energy, Heights, Load, MeshSize, Problem, Profile, Rubber};
use crate::settings::Settings;
use crate::solution::{MeshSolution, Solution};
use crate::steady;
use crate::transient::{self, Run, Stage};

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

    /// Full contact of small slope in lossy sliding, nearly incompressible.
    pub fn full_contact() -> Self {
        let case = Self::elastic(1e-3, 0.2).sliding(2.0, &[(2.0, 0.02), (4.0, 0.3)]);
        Self { bulk_modulus: 1e5, ..case }
    }

    /// The case in sliding, with networks of moduli and relaxation times.
    pub fn sliding(self, speed: f64, networks: &[(f64, f64)]) -> Self {
        let (moduli, relaxation_times) = networks.iter().copied().unzip();
        Self { speed, moduli, relaxation_times, ..self }
    }

    pub fn on_mesh(self, columns: usize, rows: usize, order: usize) -> Self {
        Self { columns, rows, order, ..self }
    }

    pub fn with_settings<const N: usize>(self, changes: [(&str, f64); N]) -> Self {
        Self { settings: Settings::new(changes).unwrap(), ..self }
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
        self.solve_with(start, &serial())
    }

    /// The solution from rest on the finest mesh, whatever its status.
    pub fn finest(&self) -> MeshSolution {
        self.solve(None).unwrap().finest
    }

    pub fn solve_with(
        &self,
        start: Option<&Solution>,
        executor: &Executor<'_>,
    ) -> Result<Solution, KernelError> {
        let problem = self.problem()?;
        steady::solve(&problem, &self.settings, self.tolerance, start, executor)
    }

    pub fn run(&self, stages: &[Stage], start: Option<&Solution>) -> Result<Run, KernelError> {
        let Problem { rubber, profile, mesh, .. } = self.problem()?;
        transient::solve(&rubber, &profile, &mesh, &self.settings, stages, start, &serial())
    }
}

/// Three strain energies, of which two have a permanent network that follows the strain.
pub fn energies() -> [(&'static str, Vec<(&'static str, f64)>); 3] {
    [
        ("neo_hookean", vec![]),
        ("mooney_rivlin", vec![("share", 0.3)]),
        ("yeoh", vec![("second", -0.05), ("third", 0.02)]),
    ]
}

pub fn new_energy(kind: &str, parameters: &[(&str, f64)]) -> Result<Energy, KernelError> {
    let parameters = parameters.iter().map(|&(name, value)| (name.to_owned(), value));
    Energy::new(kind, &parameters.collect())
}

/// `count` cases of a property, those that failed once first; they stand in `file`.
pub fn cases(count: u32, file: &'static str) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(file))),
        ..ProptestConfig::with_cases(count)
    }
}

/// A reproducible pseudo-random number in [-1, 1) (splitmix64), for fields without structure.
pub fn noise(index: usize) -> f64 {
    let mut z = (index as u64).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}

/// The calling thread alone, never cancelled.
pub fn serial() -> Executor<'static> {
    Executor::serial(Cancel::never())
}

pub fn mesh(columns: usize, rows: usize, depth: f64, order: usize) -> Mesh {
    Mesh::new(&MeshSize::new(columns, rows, depth, order).unwrap())
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
