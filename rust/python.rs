//! Python bindings: arguments in, arrays out, the interpreter released in between. No numerics.

use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::KernelError;
use crate::newton::{Ending, Limits};
use crate::sliding::{Scale, Solution};

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
        }
    }
    #[getter]
    fn residual(&self) -> f64 {
        self.0.report.residual
    }
    #[getter]
    fn newton_iterations(&self) -> usize {
        self.0.total_iterations
    }
    #[getter]
    fn load_steps(&self) -> usize {
        self.0.load_steps
    }
    #[getter]
    fn load_reached(&self) -> f64 {
        self.0.load_reached
    }
    #[getter]
    fn approach(&self) -> f64 {
        self.0.approach
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
            .mesh
            .iter()
            .map(|layer| layer.iter().map(&part).collect())
            .collect();
        Ok(PyArray2::from_vec2(py, &layers)?)
    }
}

/// Solve one wave; see `gripscale.scale.solve_scale` for the arguments.
#[pyfunction]
#[pyo3(signature = (*, equilibrium_modulus, moduli, relaxation_times, bulk_modulus, wavelength,
    amplitude, pressure, speed, load_time, depth, columns, rows, order, iterations, tolerance,
    step))]
#[allow(clippy::too_many_arguments)]
fn solve_scale(
    py: Python<'_>,
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
    iterations: usize,
    tolerance: f64,
    step: f64,
) -> PyResult<PySolution> {
    let scale = Scale {
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
        limits: Limits {
            iterations,
            tolerance,
            step,
        },
    };
    Ok(PySolution(py.detach(|| scale.solve())?))
}

#[pymodule(name = "_kernel")]
fn kernel(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PySolution>()?;
    module.add_function(wrap_pyfunction!(solve_scale, module)?)?;
    Ok(())
}
