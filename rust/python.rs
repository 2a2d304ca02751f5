//! Python bindings: arguments in, arrays out, the interpreter released in between. No numerics.

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::KernelError;
use crate::hyperelastic::Energy;
use crate::newton::{Ending, Limits};
use crate::scale::{Scale, Solution};
use crate::transient::Stage;

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
        status(self.0.report.ending)
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

fn status(ending: Ending) -> &'static str {
    match ending {
        Ending::Converged => "converged",
        Ending::IterationLimit => "iteration limit",
        Ending::ElementInverted => "element inverted",
        Ending::NoActiveSet => "no active set",
        Ending::NotFinite => "not finite",
        Ending::Fold => "fold in the load path",
        Ending::ToleranceNotMet => "tolerance not met",
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

/// The inputs of one wave in SI units, shear moduli; a dictionary on the Python side.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Inputs {
    strain_energy: (String, f64, f64),
    equilibrium_modulus: f64,
    moduli: Vec<f64>,
    relaxation_times: Vec<f64>,
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
}

impl Inputs {
    fn scale(self) -> Result<Scale, KernelError> {
        Ok(Scale {
            energy: energy(
                &self.strain_energy.0,
                self.strain_energy.1,
                self.strain_energy.2,
            )?,
            equilibrium_modulus: self.equilibrium_modulus,
            moduli: self.moduli,
            relaxation_times: self.relaxation_times,
            bulk_modulus: self.bulk_modulus,
            wavelength: self.wavelength,
            amplitude: self.amplitude,
            pressure: self.pressure,
            speed: self.speed,
            load_time: self.load_time,
            depth: self.depth,
            columns: self.columns,
            rows: self.rows,
            order: self.order,
            tolerance: self.tolerance,
            limits: Limits {
                iterations: self.iterations,
                budget: self.budget,
                tolerance: self.residual_tolerance,
                step: self.step,
            },
        })
    }
}

/// Solve one wave, from another solution if one is given.
#[pyfunction]
fn solve_scale(
    py: Python<'_>,
    inputs: Inputs,
    start: Option<Bound<'_, PySolution>>,
) -> PyResult<PySolution> {
    let scale = inputs.scale()?;
    let start = start.as_ref().map(|solution| &solution.get().0);
    Ok(PySolution(py.detach(|| scale.solve(start))?))
}

/// Slide through stages (duration, speed, pressure). Returns status, iterations and one row per
/// moment: time, distance, speed, pressure, friction, contact fraction, approach.
#[pyfunction]
fn run_stages<'py>(
    py: Python<'py>,
    inputs: Inputs,
    stages: Vec<(f64, f64, f64)>,
    start: Option<Bound<'py, PySolution>>,
) -> PyResult<(&'static str, usize, Bound<'py, PyArray2<f64>>)> {
    let scale = inputs.scale()?;
    let start = start.as_ref().map(|solution| &solution.get().0);
    let stages: Vec<Stage> = stages
        .into_iter()
        .map(|(duration, speed, pressure)| Stage {
            duration,
            speed,
            pressure,
        })
        .collect();
    let run = py.detach(|| scale.run(&stages, start))?;
    let moments: Vec<Vec<f64>> = run
        .moments
        .iter()
        .map(|m| {
            vec![
                m.time,
                m.distance,
                m.speed,
                m.pressure,
                m.friction,
                m.contact_fraction,
                m.approach,
            ]
        })
        .collect();
    let table = PyArray2::from_vec2(py, &moments)?;
    Ok((status(run.report.ending), run.count.iterations, table))
}

#[pymodule(name = "_kernel")]
fn kernel(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<PySolution>()?;
    module.add_function(wrap_pyfunction!(solve_scale, module)?)?;
    module.add_function(wrap_pyfunction!(run_stages, module)?)?;
    Ok(())
}
