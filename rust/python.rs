//! Python bindings: arguments in, arrays out, the interpreter released in between. No numerics.

use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::KernelError;
use crate::hyperelastic::Energy;
use crate::newton::{Ending, Limits};
use crate::scale::{Scale, Solution};

impl From<KernelError> for PyErr {
    fn from(error: KernelError) -> Self {
        PyValueError::new_err(error.to_string())
    }
}

/// Contact and friction of one wave, lengths in wavelengths and stresses in Pa.
#[pyclass(frozen, name = "Solution")]
struct PySolution(Solution);

#[pymethods]
impl PySolution {
    #[getter]
    fn status(&self) -> &'static str {
        match self.0.report.ending {
            Ending::Converged => "converged",
            Ending::IterationLimit => "iteration limit",
            Ending::ElementInverted => "element inverted",
            Ending::NoActiveSet => "no active set",
            Ending::NotFinite => "not finite",
            Ending::Fold => "fold in the load path",
            Ending::ToleranceNotMet => "tolerance not met",
        }
    }
    #[getter]
    fn residual(&self) -> f64 {
        self.0.report.residual
    }
    #[getter]
    fn newton_iterations(&self) -> usize {
        self.0.count.iterations
    }
    #[getter]
    fn load_steps(&self) -> usize {
        self.0.count.steps
    }
    #[getter]
    fn load_reached(&self) -> f64 {
        self.0.load_reached
    }
    #[getter]
    fn approach(&self) -> f64 {
        self.0.state.approach
    }
    #[getter]
    fn contact_fraction(&self) -> f64 {
        self.0.outcome.contact_fraction
    }
    #[getter]
    fn contacts(&self) -> Vec<(f64, f64)> {
        self.0.outcome.contacts.clone()
    }
    #[getter]
    fn friction(&self) -> f64 {
        self.0.outcome.friction
    }
    #[getter]
    fn friction_from_dissipation(&self) -> f64 {
        self.0.outcome.friction_from_dissipation
    }
    #[getter]
    fn contact_fraction_error(&self) -> f64 {
        self.0.contact_fraction_error
    }
    #[getter]
    fn friction_error(&self) -> f64 {
        self.0.friction_error
    }
    #[getter]
    fn columns(&self) -> usize {
        self.0.cell.columns
    }
    #[getter]
    fn rows(&self) -> usize {
        self.0.cell.rows
    }
    #[getter]
    fn min_stretch(&self) -> f64 {
        self.0.outcome.min_stretch
    }
    #[getter]
    fn max_stretch(&self) -> f64 {
        self.0.outcome.max_stretch
    }
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.outcome.x)
    }
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let scaled = self
            .0
            .outcome
            .pressure
            .iter()
            .map(|p| p * self.0.stress_unit);
        PyArray1::from_iter(py, scaled)
    }
    #[getter]
    fn mesh_x<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.mesh(py, |point| point.0)
    }
    #[getter]
    fn mesh_z<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.mesh(py, |point| point.1)
    }
}

impl PySolution {
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        part: impl Fn(&(f64, f64)) -> f64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let layers: Vec<Vec<f64>> = self
            .0
            .mesh()
            .iter()
            .map(|layer| layer.iter().map(&part).collect())
            .collect();
        Ok(PyArray2::from_vec2(py, &layers)?)
    }
}

/// The strain energy by its name and two coefficients.
fn energy(name: &str, first: f64, second: f64) -> Result<Energy, KernelError> {
    match name {
        "neo_hookean" => Ok(Energy::NeoHookean),
        "mooney_rivlin" => Ok(Energy::MooneyRivlin { share: first }),
        "yeoh" => Ok(Energy::Yeoh {
            second: first,
            third: second,
        }),
        other => Err(KernelError::UnknownName {
            name: "strain energy",
            expected: "neo_hookean, mooney_rivlin, yeoh",
            value: other.to_owned(),
        }),
    }
}

/// Solve one wave; see `gripscale.scale.solve_scale` for the arguments.
#[pyfunction]
#[pyo3(signature = (*, strain_energy, equilibrium_modulus, moduli, relaxation_times, bulk_modulus,
    wavelength, amplitude, pressure, speed, load_time, depth, columns, rows, order, tolerance,
    iterations, budget, residual_tolerance, step, start))]
#[allow(clippy::too_many_arguments)]
fn solve_scale(
    py: Python<'_>,
    strain_energy: (String, f64, f64),
    equilibrium_modulus: f64,
    moduli: PyReadonlyArray1<'_, f64>,
    relaxation_times: PyReadonlyArray1<'_, f64>,
    bulk_modulus: f64,
    wavelength: f64,
    amplitude: f64,
    pressure: f64,
    speed: f64,
    load_time: f64,
    depth: f64,
    columns: usize,
    rows: usize,
    order: usize,
    tolerance: Option<f64>,
    iterations: usize,
    budget: usize,
    residual_tolerance: f64,
    step: f64,
    start: Option<Bound<'_, PySolution>>,
) -> PyResult<PySolution> {
    let scale = Scale {
        energy: energy(&strain_energy.0, strain_energy.1, strain_energy.2)?,
        equilibrium_modulus,
        moduli: moduli.as_array().to_vec(),
        relaxation_times: relaxation_times.as_array().to_vec(),
        bulk_modulus,
        wavelength,
        amplitude,
        pressure,
        speed,
        load_time,
        depth,
        columns,
        rows,
        order,
        tolerance,
        limits: Limits {
            iterations,
            budget,
            tolerance: residual_tolerance,
            step,
        },
    };
    let start = start.as_ref().map(|solution| &solution.get().0);
    Ok(PySolution(py.detach(|| scale.solve(start))?))
}

#[pymodule(name = "_kernel")]
fn kernel(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PySolution>()?;
    module.add_function(wrap_pyfunction!(solve_scale, module)?)?;
    Ok(())
}
