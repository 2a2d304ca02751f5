//! One wave for tests inside and outside the crate, through its public interface.

use gripscale_kernel::cancel::Cancel;
use gripscale_kernel::error::KernelError;
use gripscale_kernel::executor::Executor;
use gripscale_kernel::problem::{Energy, Heights, Load, MeshSize, Problem, Profile, Rubber};
use gripscale_kernel::settings::Settings;
use gripscale_kernel::solution::Solution;
use gripscale_kernel::steady;
use gripscale_kernel::transient::{self, Run, Stage};

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
        self.solve_with(start, &Executor::serial(Cancel::never()))
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
        let executor = Executor::serial(Cancel::never());
        let settings = &self.settings;
        transient::solve(&rubber, &profile, &mesh, settings, stages, start, &executor)
    }
}

pub fn new_energy(kind: &str, parameters: &[(&str, f64)]) -> Result<Energy, KernelError> {
    let parameters = parameters.iter().map(|&(name, value)| (name.to_owned(), value));
    Energy::new(kind, &parameters.collect())
}

/// A reproducible pseudo-random number in [-1, 1) (splitmix64), for fields without structure.
pub fn noise(index: usize) -> f64 {
    let mut z = (index as u64).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
}
