//! Python bindings: arguments in, arrays out, the interpreter released in between. No numerics.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray1,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyMapping;

use crate::cancel::Cancel;
use crate::error::{unknown, KernelError};
use crate::executor::{Executor, Threads};
use crate::gap_extension::GapExtension;
use crate::line_filter::LineFilter;
use crate::line_system::LineSystem;
use crate::linear::single_gmres;
use crate::map_filter::{MapFilter, RowBuffers};
use crate::map_system::MapSystem;
use crate::material::maxwell;
use crate::problem::{Energy, Heights, Load, MeshSize, Parameters, Problem, Profile, Rubber};
use crate::settings::Settings;
use crate::solution::Solution;
use crate::spectral::{Complex32, Complex64};
use crate::status::Status;
use crate::steady;
use crate::transient::{self, Moment, Run, Stage};

impl From<KernelError> for PyErr {
    fn from(error: KernelError) -> Self {
        let text = error.to_string();
        match error {
            KernelError::Stopped => PyKeyboardInterrupt::new_err(text),
            KernelError::Internal(_) => PyRuntimeError::new_err(text),
            _ => PyValueError::new_err(text),
        }
    }
}

/// One `#[pymethods]` block of getters of a Python class, `name: type = value of what the class wraps`.
macro_rules! getters {
    ($class:ident of $wrapped:ty; $($name:ident: $kind:ty = $value:expr;)+) => {
        #[pymethods]
        impl $class {
            $(#[getter]
            fn $name<'py>(&self, py: Python<'py>) -> PyResult<$kind> {
                let value: fn(&$wrapped, Python<'py>) -> PyResult<$kind> = $value;
                value(&self.0, py)
            })+
        }
    };
}

/// Contact and friction of one wave, lengths in wavelengths and stresses in Pa.
#[pyclass(frozen, name = "Solution")]
struct PySolution(Solution);

/// Moments of sliding in time, in SI units but for the approach, which is in wavelengths.
#[pyclass(frozen, name = "Run")]
struct PyRun(Run);

type Vector<'py> = Bound<'py, PyArray1<f64>>;
type Table<'py> = Bound<'py, PyArray2<f64>>;

getters! {
    PySolution of Solution;
    status: &'static str = |s, _| Ok(s.finest.report.status.word());
    residual: f64 = |s, _| Ok(s.finest.report.residual);
    newton_iterations: usize = |s, _| Ok(s.counts.iterations);
    jacobian_products: usize = |s, _| Ok(s.counts.products);
    load_steps: usize = |s, _| Ok(s.counts.load_steps);
    load_reached: f64 = |s, _| Ok(s.finest.report.load_reached);
    approach: f64 = |s, _| Ok(s.finest.state.approach);
    contact_fraction: f64 = |s, _| Ok(s.finest.outcome.contact_fraction);
    contacts: Vec<(f64, f64)> = |s, _| Ok(s.finest.outcome.contacts.clone());
    friction: f64 = |s, _| Ok(s.finest.outcome.friction);
    friction_from_dissipation: f64 = |s, _| Ok(s.finest.outcome.friction_from_dissipation);
    lost_by_row: Vector<'py> = |s, py| Ok(PyArray1::from_slice(py, &s.finest.outcome.lost_by_row));
    row_heights: Vector<'py> = |s, py| Ok(PyArray1::from_slice(py, &s.finest.mesh.row_height));
    contact_fraction_error: f64 = |s, _| Ok(s.finest.contact_fraction_error);
    friction_error: f64 = |s, _| Ok(s.finest.friction_error);
    friction_bound: Option<f64> = |s, _| Ok(s.finest.friction_bound);
    judged_by: Option<usize> = |s, _| Ok(s.finest.coarser_columns());
    columns: usize = |s, _| Ok(s.finest.mesh.columns);
    rows: usize = |s, _| Ok(s.finest.mesh.rows);
    too_narrow: Option<(f64, f64)> = |s, _| Ok(s.too_narrow);
    waves_carried: Option<usize> = |s, _| Ok(s.waves_carried);
    min_stretch: f64 = |s, _| Ok(s.finest.outcome.min_stretch);
    max_stretch: f64 = |s, _| Ok(s.finest.outcome.max_stretch);
    x: Vector<'py> = |s, py| Ok(PyArray1::from_slice(py, &s.finest.outcome.x));
    pressure: Vector<'py> = |s, py| {
        let pascals = s.finest.outcome.pressure.iter().map(|p| p * s.stress_unit);
        Ok(PyArray1::from_iter(py, pascals))
    };
    mesh_x: Table<'py> = |s, py| mesh(s, py, |point| point.0);
    mesh_z: Table<'py> = |s, py| mesh(s, py, |point| point.1);
}

getters! {
    PyRun of Run;
    status: &'static str = |run, _| Ok(run.status.word());
    newton_iterations: usize = |run, _| Ok(run.counts.iterations);
    time: Vector<'py> = |run, py| moments(run, py, |moment| moment.time);
    distance: Vector<'py> = |run, py| moments(run, py, |moment| moment.distance);
    speed: Vector<'py> = |run, py| moments(run, py, |moment| moment.speed);
    pressure: Vector<'py> = |run, py| moments(run, py, |moment| moment.pressure);
    friction: Vector<'py> = |run, py| moments(run, py, |moment| moment.friction);
    contact_fraction: Vector<'py> = |run, py| moments(run, py, |moment| moment.contact_fraction);
    approach: Vector<'py> = |run, py| moments(run, py, |moment| moment.approach);
}

fn moments<'py>(run: &Run, py: Python<'py>, value: fn(&Moment) -> f64) -> PyResult<Vector<'py>> {
    Ok(PyArray1::from_iter(py, run.moments.iter().map(value)))
}

fn mesh<'py>(
    solution: &Solution,
    py: Python<'py>,
    part: fn(&(f64, f64)) -> f64,
) -> PyResult<Table<'py>> {
    let layers = solution.node_positions();
    let layers: Vec<Vec<f64>> =
        layers.iter().map(|layer| layer.iter().map(part).collect()).collect();
    Ok(PyArray2::from_vec2(py, &layers)?)
}

/// Dictionaries of the Python side, in SI units with shear moduli.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct RubberItems {
    equilibrium_modulus: f64,
    moduli: Vec<f64>,
    relaxation_times: Vec<f64>,
    bulk_modulus: f64,
    strain_energy: (String, Parameters),
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct ProfileItems {
    kind: String,
    wavelength: f64,
    #[pyo3(default)]
    amplitude: Option<f64>,
    #[pyo3(default)]
    heights: Option<Vec<f64>>,
}

impl ProfileItems {
    fn checked(self) -> Result<Profile, KernelError> {
        let heights = match self.kind.as_str() {
            "sine" => Heights::sine(needed("a sine", "amplitude", self.amplitude)?)?,
            "sampled" => Heights::sampled(&needed("a sampled profile", "heights", self.heights)?)?,
            other => {
                let kinds = ["sine", "sampled"];
                return Err(unknown("the kind of a profile", other, &kinds));
            }
        };
        Profile::new(self.wavelength, heights)
    }
}

fn needed<T>(owner: &'static str, name: &'static str, value: Option<T>) -> Result<T, KernelError> {
    value.ok_or(KernelError::MissingParameter { owner, name })
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct LoadItems {
    pressure: f64,
    speed: f64,
    load_time: f64,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct MeshItems {
    columns: usize,
    rows: usize,
    depth: f64,
    element_order: usize,
}

/// What slides on what: a problem without its load.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct BodyItems {
    rubber: RubberItems,
    profile: ProfileItems,
    mesh: MeshItems,
}

impl BodyItems {
    fn checked(self) -> Result<(Rubber, Profile, MeshSize), KernelError> {
        let (items, mesh) = (self.rubber, self.mesh);
        let (kind, parameters) = items.strain_energy;
        let rubber = Rubber::new(
            Energy::new(&kind, &parameters)?,
            items.equilibrium_modulus,
            items.moduli,
            items.relaxation_times,
            items.bulk_modulus,
        )?;
        let mesh = MeshSize::new(mesh.columns, mesh.rows, mesh.depth, mesh.element_order)?;
        Ok((rubber, self.profile.checked()?, mesh))
    }
}

/// Largest number of threads, time limit [s], and a function that the calling thread calls every 50 ms: it
/// raises to stop.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct WorkItems {
    workers: usize,
    time_limit: Option<f64>,
    look: Py<PyAny>,
}

/// The defaults with the changes in a mapping from names to numbers.
fn settings(changes: &Bound<'_, PyMapping>) -> PyResult<Settings> {
    let changes: Vec<(String, f64)> = changes.items()?.extract()?;
    let changes = changes.iter().map(|(name, value)| (name.as_str(), *value));
    Ok(Settings::new(changes)?)
}

/// `cancellable` with the threads and the time limit of `work`.
fn run_cancellable<T: Send>(
    py: Python<'_>,
    work: WorkItems,
    solve: impl FnOnce(&Executor<'_>) -> Result<T, KernelError> + Send,
) -> PyResult<T> {
    cancellable(py, &Threads::new(work.workers), &work.look, work.time_limit, solve)
}

/// Run `solve` with the interpreter released. Every now and then the interpreter is asked whether to go on:
/// a signal such as Ctrl-C or an exception of `look` stops the work, and is raised in the end.
fn cancellable<T: Send>(
    py: Python<'_>,
    threads: &Threads,
    look: &Py<PyAny>,
    time_limit: Option<f64>,
    solve: impl FnOnce(&Executor<'_>) -> Result<T, KernelError> + Send,
) -> PyResult<T> {
    let raised: OnceLock<PyErr> = OnceLock::new();
    let stop_requested = || {
        let ask = |py: Python<'_>| py.check_signals().and_then(|()| look.call0(py));
        if let Err(error) = Python::attach(ask) {
            // The first exception is kept.
            raised.get_or_init(|| error);
        }
        raised.get().is_some()
    };
    let result = py.detach(|| {
        let cancel = Cancel::new(&stop_requested, time_limit)?;
        solve(&Executor::new(threads, cancel))
    });
    match raised.into_inner() {
        Some(error) => Err(error),
        None => Ok(result?),
    }
}

/// Solve one wave at rest or in steady sliding, as far as the time limit of `work` allows; `start`, any other
/// solution, is a first guess.
#[pyfunction]
fn solve_steady(
    py: Python<'_>,
    problem: &Bound<'_, PyAny>,
    settings: &Bound<'_, PyMapping>,
    tolerance: Option<f64>,
    start: Option<Bound<'_, PySolution>>,
    work: WorkItems,
) -> PyResult<PySolution> {
    let (rubber, profile, mesh) = problem.extract::<BodyItems>()?.checked()?;
    let load: LoadItems = problem.get_item("load")?.extract()?;
    let problem = Problem {
        rubber,
        profile,
        load: Load::new(load.pressure, load.speed, load.load_time)?,
        mesh,
    };
    let settings = self::settings(settings)?;
    let start = start.as_ref().map(|solution| &solution.get().0);
    let solve =
        |executor: &Executor<'_>| steady::solve(&problem, &settings, tolerance, start, executor);
    Ok(PySolution(run_cancellable(py, work, solve)?))
}

/// Slide through stages (duration, speed, pressure), from rest or from a `start` of the same rubber and
/// profile.
#[pyfunction]
fn solve_transient<'py>(
    py: Python<'py>,
    problem: BodyItems,
    settings: &Bound<'py, PyMapping>,
    stages: Vec<(f64, f64, f64)>,
    start: Option<Bound<'py, PySolution>>,
    work: WorkItems,
) -> PyResult<PyRun> {
    let (rubber, profile, mesh) = problem.checked()?;
    let settings = self::settings(settings)?;
    let start = start.as_ref().map(|solution| &solution.get().0);
    let stage = |(duration, speed, pressure)| Stage { duration, speed, pressure };
    let stages: Vec<Stage> = stages.into_iter().map(stage).collect();
    let solve = |executor: &Executor<'_>| {
        transient::solve(&rubber, &profile, &mesh, &settings, &stages, start, executor)
    };
    Ok(PyRun(run_cancellable(py, work, solve)?))
}

/// Filters and contacts of lines of a number of points, which release the interpreter.
#[pyclass(frozen, name = "Line")]
struct PyLine(LineFilter);

#[pymethods]
impl PyLine {
    #[new]
    fn new(points: usize) -> Self {
        Self(LineFilter::new(points))
    }

    /// Values with each of their harmonics, 0 to half the points, times its factor.
    fn filtered<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f32>,
        factors: PyReadonlyArray1<'py, Complex32>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let (values, factors) = (values.as_slice()?, factors.as_slice()?);
        if values.len() != self.0.points() {
            return Err(PyValueError::new_err("expected a value for each point"));
        }
        self.check_waves(factors)?;
        let filtered = py.detach(|| {
            let mut line = self.0.line();
            line.fill(values);
            self.0.apply(factors, &mut line);
            (0..values.len()).map(|at| line.get(at)).collect()
        });
        Ok(PyArray1::from_vec(py, filtered))
    }

    /// Solution of Q K p = r at `places`, its residual and the products it took; |r| = 1.
    ///
    /// `filters` are K and S of each harmonic; `numbers` the factor of Q, the target of the residual and
    /// the most products.
    fn close_gap<'py>(
        &self,
        py: Python<'py>,
        right: PyReadonlyArray1<'py, f32>,
        places: PyReadonlyArray1<'py, i64>,
        filters: [PyReadonlyArray1<'py, Complex32>; 2],
        extension: PyRef<'py, PyGapExtension>,
        numbers: (f32, f64, usize),
    ) -> PyResult<(Bound<'py, PyArray1<f32>>, f64, usize)> {
        let [compliance, stiffness] = &filters;
        let (factor, target, most) = numbers;
        let system = LineSystem {
            filter: &self.0,
            places: places.as_slice()?,
            compliance: compliance.as_slice()?,
            stiffness: stiffness.as_slice()?,
            extension: &extension.0,
            factor,
        };
        self.check_waves(system.compliance)?;
        self.check_waves(system.stiffness)?;
        let right = right.as_slice()?.to_vec();
        if !system.fits(right.len()) {
            return Err(PyValueError::new_err("expected points and an extension of the line"));
        }
        let found = py.detach(|| system.solution(right, target, most));
        Ok((PyArray1::from_vec(py, found.x), found.residual, found.products))
    }
}

impl PyLine {
    fn check_waves(&self, factors: &[Complex32]) -> PyResult<()> {
        if factors.len() == self.0.waves() {
            return Ok(());
        }
        Err(PyValueError::new_err("expected a factor for each wave"))
    }
}

/// Filters and contacts of maps of one shape, as those of `Line`; `look` is called now and then, and may raise.
#[pyclass(frozen, name = "Map")]
struct PyMap {
    filter: MapFilter,
    threads: Threads,
    look: Py<PyAny>,
    /// Of numpy: it asks for large pages.
    memory: Py<PyArray1<Complex32>>,
}

#[pymethods]
impl PyMap {
    #[new]
    fn new(py: Python<'_>, rows: usize, columns: usize, threads: usize, look: Py<PyAny>) -> Self {
        let filter = MapFilter::new(rows, columns);
        let memory = PyArray1::zeros(py, filter.memory(), false).unbind();
        Self { filter, threads: Threads::new(threads), look, memory }
    }

    /// Values with each of their waves times its factor.
    fn filtered<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray2<'py, f32>,
        factors: PyReadonlyArray2<'py, Complex32>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (rows, columns) = (self.filter.rows(), self.filter.columns());
        let out = PyArray2::<f32>::zeros(py, [rows, columns], false);
        let mut writable = out.readwrite();
        let (values, to) = (values.as_slice()?, writable.as_slice_mut()?);
        if values.len() != rows * columns {
            return Err(PyValueError::new_err("expected a value for each point"));
        }
        let mut memory = self.memory.bind(py).readwrite();
        let (factors, memory) = (self.factors(&factors)?, memory.as_slice_mut()?);
        let read = |i: usize, buffers: &mut RowBuffers| {
            buffers.row.copy_from_slice(&values[i * columns..][..columns]);
        };
        let write = |_: usize, row: &[f32], to: &mut [f32]| to.copy_from_slice(row);
        let to = to.chunks_mut(columns).collect();
        let filter = |executor: &Executor<'_>| {
            let filtered = self.filter.apply(executor, factors, memory, read, to, write);
            filtered.map_err(|_| KernelError::Stopped)
        };
        cancellable(py, &self.threads, &self.look, None, filter)?;
        drop(writable);
        Ok(out)
    }

    /// Solution of Q K p = r at `places`; see `Line.close_gap`.
    fn close_gap<'py>(
        &self,
        py: Python<'py>,
        right: PyReadonlyArray1<'py, f32>,
        places: PyReadonlyArray1<'py, i64>,
        filters: [PyReadonlyArray2<'py, Complex32>; 2],
        extension: PyRef<'py, PyGapExtension>,
        numbers: (f32, f64, usize),
    ) -> PyResult<(Bound<'py, PyArray1<f32>>, f64, usize)> {
        let no_map = || PyValueError::new_err("expected points and an extension of the map");
        let [compliance, stiffness] = &filters;
        let mut memory = self.memory.bind(py).readwrite();
        let memory = memory.as_slice_mut()?;
        let (factor, target, most) = numbers;
        let system = MapSystem {
            filter: &self.filter,
            places: places.as_slice()?,
            compliance: self.factors(compliance)?,
            stiffness: self.factors(stiffness)?,
            extension: extension.0.on_map().ok_or_else(no_map)?,
            factor,
        };
        let right = right.as_slice()?.to_vec();
        if !system.fits(right.len()) {
            return Err(no_map());
        }
        let solve = |executor: &Executor<'_>| {
            let solution = system.solution(executor, right, target, most, memory);
            solution.map_err(|_| KernelError::Stopped)
        };
        let found = cancellable(py, &self.threads, &self.look, None, solve)?;
        Ok((PyArray1::from_vec(py, found.x), found.residual, found.products))
    }
}

impl PyMap {
    fn factors<'a>(
        &self,
        factors: &'a PyReadonlyArray2<'_, Complex32>,
    ) -> PyResult<&'a [Complex32]> {
        let factors = factors.as_slice()?;
        if factors.len() == self.filter.waves() {
            return Ok(factors);
        }
        Err(PyValueError::new_err("expected a factor for each wave"))
    }
}

/// Solution of A x = `right`, its residual and the products it took; `operator` gives A x.
#[pyfunction]
fn gmres<'py>(
    py: Python<'py>,
    operator: Bound<'py, PyAny>,
    right: PyReadonlyArray1<'py, f32>,
    target: f64,
    most: usize,
) -> PyResult<(Bound<'py, PyArray1<f32>>, f64, usize)> {
    let apply = |x: &[f32]| -> PyResult<Vec<f32>> {
        let image: PyReadonlyArray1<'_, f32> =
            operator.call1((PyArray1::from_slice(py, x),))?.extract()?;
        Ok(image.as_slice()?.to_vec())
    };
    let found = single_gmres::gmres(apply, right.as_slice()?.to_vec(), target, most)?;
    Ok((PyArray1::from_vec(py, found.x), found.residual, found.products))
}

/// sum E_i i w tau_i / (1 + i w tau_i) at frequencies w, without the interpreter's lock.
#[pyfunction]
fn relaxing_moduli<'py>(
    py: Python<'py>,
    omega: PyReadonlyArray1<'py, f64>,
    moduli: PyReadonlyArray1<'py, f64>,
    times: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
    let (omega, moduli, times) = (omega.as_slice()?, moduli.as_slice()?, times.as_slice()?);
    let values = py.detach(|| maxwell::relaxing_moduli(omega, moduli, times));
    Ok(PyArray1::from_vec(py, values))
}

/// Extends gaps of the points in contact, `active`, to open points.
#[pyclass(frozen, name = "GapExtension")]
struct PyGapExtension(GapExtension);

#[pymethods]
impl PyGapExtension {
    /// On a line, linearly without a `reach`.
    #[staticmethod]
    fn of_line(active: PyReadonlyArray1<'_, bool>, reach: Option<f32>) -> PyResult<Self> {
        Ok(Self(GapExtension::of_line(active.as_slice()?, reach)))
    }

    /// On a map.
    #[staticmethod]
    fn of_map(active: PyReadonlyArray2<'_, bool>, far: f32) -> PyResult<Self> {
        let columns = active.shape()[1];
        Ok(Self(GapExtension::of_map(active.as_slice()?, columns, far)))
    }

    /// Set the open points of `values`, flattened, which are zero there.
    fn extend(&self, mut values: PyReadwriteArray1<'_, f32>) -> PyResult<()> {
        let values = values.as_slice_mut()?;
        if values.len() != self.0.points() {
            return Err(PyValueError::new_err("expected a value for each point"));
        }
        self.0.extend(values);
        Ok(())
    }
}

/// Name, default and one sentence of every setting.
#[pyfunction]
fn default_settings() -> Vec<(&'static str, f64, &'static str)> {
    Settings::default().list()
}

/// Word, sentence and advice of every status that a result can have.
#[pyfunction]
fn statuses() -> Vec<(&'static str, &'static str, &'static str)> {
    let texts = |status: &Status| (status.word(), status.sentence(), status.advice());
    Status::ALL.iter().map(texts).collect()
}

/// Parameters of every strain energy by its name.
#[pyfunction]
fn strain_energies() -> BTreeMap<&'static str, Vec<&'static str>> {
    let kinds = Energy::KINDS.iter();
    kinds.map(|&(kind, names)| (kind, names.to_vec())).collect()
}

#[pymodule(name = "_kernel")]
mod kernel {
    #[pymodule_export]
    use super::{
        default_settings, gmres, relaxing_moduli, solve_steady, solve_transient, statuses,
        strain_energies, PyGapExtension, PyLine, PyMap, PyRun, PySolution,
    };
}
