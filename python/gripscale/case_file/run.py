"""Running a case without a console: prepared inputs, predictions, files as the results come.

results = run_case("case.toml", output="results")
results.dynamic.friction
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path

from gripscale.case_file import events, folder
from gripscale.case_file.events import OnEvent
from gripscale.case_file.prepare import case_chain, case_surface, prepare_rubber
from gripscale.case_file.read import CaseFile, read_case
from gripscale.case_file.results import CaseResults
from gripscale.chain import Chain, ChainError
from gripscale.chain.prediction import Prediction
from gripscale.core.errors import FileError, InputError, about_keys
from gripscale.io import netcdf
from gripscale.questions.inputs import record
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.wave.kernel import WaveSolver
from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import WaveResult

KEY, FINISHED = "prediction_key", "prediction_finished"
"""Attributes of a result: what it depends on, and whether its chain came to its end."""

SAVE_EVERY = 2.0
"""Least time between two savings of an unfinished prediction [s]; each takes 0.1 s."""


@dataclass(frozen=True)
class StoredPrediction:
    """A prediction of an earlier run: all of it, or as many waves as converged."""

    prediction: Prediction
    finished: bool


@dataclass(frozen=True)
class ReplayedWaves:
    """Answers stored waves with their stored results, and solves the others."""

    inner: WaveSolver
    stored: tuple[WaveResult, ...]

    @property
    def name(self) -> str:
        """That of the solver inside."""
        return self.inner.name

    def solve(self, problem: WaveProblem, start: WaveResult | None = None) -> WaveResult:
        """Return the stored result of just this wave under just this pressure, or solve it."""
        asked = problem.profile.wavelength, problem.profile.amplitude, problem.load.pressure
        for wave in self.stored:
            if (wave.wavelength, wave.amplitude, wave.pressure_received) == asked:
                return wave
        return self.inner.solve(problem, start)


def earlier(path: Path, key: str, chain: Chain) -> StoredPrediction | None:
    """Return the prediction stored at `path`, or None if it is not of `key` or of no use.

    Of an unfinished one the waves that converged are of use if each depends on nothing but the one
    above it: under one pressure class, without conditions that are solved in several passes.
    """
    try:
        data = netcdf.load(path)
        prediction = Prediction.from_dataset(data) if data.attrs.get(KEY) == key else None
    except (FileError, InputError):
        return None
    if prediction is None:
        return None
    finished = bool(data.attrs.get(FINISHED, 0))
    if finished and prediction.converged:
        return StoredPrediction(prediction, finished=True)
    iterated = chain.conditions is not None and chain.conditions.iterated
    if iterated or chain.pressure_classes > 1:
        return None
    kept = [wave for wave in prediction.scales if wave.converged]
    return StoredPrediction(replace(prediction, scales=kept), finished=False) if kept else None


def prepare_case(case: CaseFile | str | Path) -> CaseResults:
    """Read and fit what a case names; nothing is solved yet.

    Raises `FileError` and `InputError` for what cannot be used.
    """
    file = case if isinstance(case, CaseFile) else read_case(case)
    chain = case_chain(file)
    surface = case_surface(file)
    rubber = prepare_rubber(file.case.rubber, file.resolve)
    results = CaseResults(file, surface, rubber, chain)
    _require_shift(results)
    return results


def run_case(
    case: CaseResults | CaseFile | str | Path,
    *,
    output: str | Path | None = None,
    on_event: OnEvent | None = None,
    fresh: bool = False,
) -> CaseResults:
    """Predict contact area and friction of a case.

    Parameters
    ----------
    case : path, CaseFile or CaseResults
        The case file, read, or with its inputs prepared.
    output : path, optional
        Folder for the result files, written as the waves are solved, with the case and its files,
        so that it runs from there. Results of an earlier run are replaced, unless they are of
        exactly this case: then what was finished is taken up and not solved again. Without it
        nothing is written.
    on_event : callable, optional
        Called with each event of `gripscale.case_file.events`: start, waves, predictions, files.
    fresh : bool, optional
        Take nothing up.

    Returns
    -------
    CaseResults
        A wave that did not converge ends its prediction, which is kept, and is named in
        `failures`.

    Raises
    ------
    FileError, InputError
        For what cannot be read, used or written.
    """
    results = case if isinstance(case, CaseResults) else prepare_case(case)
    emit = on_event or (lambda event: None)
    require_feasible(results)
    if output is not None:
        results.folder = Path(output)
        folder.require_writable(results.folder)
    names = tuple(name for name, _ in results.planned())
    stored: dict[str, StoredPrediction | None] = {}
    if results.folder is not None and not fresh:
        paths = {name: results.folder / f"{name}.nc" for name in names}
        stored = {name: earlier(paths[name], results.key(name), results.chain) for name in names}
    iterated = results.file.case.conditions.iterated
    emit(events.RunStarted(names, len(results.surface.sines), iterated))
    if results.folder is not None:
        keep = [f"{name}.nc" for name, prediction in stored.items() if prediction is not None]
        replaced = folder.earlier_run(results.folder, keep)
        if replaced:
            emit(events.ResultsReplaced(replaced))
        folder.prepare(results.folder, results.file, keep)
    for name, speed in results.planned():
        _solve(results, name, speed, emit, stored.get(name))
    return results


@about_keys("rubber.shift")
def _require_shift(results: CaseResults) -> None:
    """Raise `InputError` if a temperature or heat is asked for and the rubber has no shift."""
    try:
        _ = results.rubber_before
    except InputError as error:
        raise InputError(f"{results.file.path}: [conditions] {error}") from error


def require_feasible(results: CaseResults) -> None:
    """Raise `InputError` if the rubber cannot carry a load or would be excited beyond its band.

    The latter only if the case refuses it.
    """
    rubber = results.rubber_before
    for _, speed in results.planned():
        load = replace(results.load, speed=speed)
        require_load_bearing(rubber, load.pressure, load.time_under(load.footprint))
    if results.file.case.rubber.extrapolate == "refuse":
        for _, speed in results.planned():
            require_measured(rubber, results.surface.sines.wavelength, speed)


def _solve(
    results: CaseResults, name: str, speed: float, emit: OnEvent, stored: StoredPrediction | None
) -> None:
    """Add one prediction to `results`, on disk as it grows; the inputs follow at the end."""
    chain = results.chain
    stored_waves = 0 if stored is None else len(stored.prediction.scales)
    clock = saved = time.perf_counter()
    pass_number = 0

    def keep(so_far: Prediction) -> None:
        nonlocal clock, saved, pass_number
        results.predictions[name] = so_far
        is_stored = len(so_far.scales) <= stored_waves
        if not is_stored:
            if time.perf_counter() - saved > SAVE_EVERY:
                _save(results, name)
                saved = time.perf_counter()
            if events.PASSES in so_far.scales[-1].details:
                return  # rubber and contact agree: no wave was solved anew
        pass_number += len(so_far.scales) == 1
        seconds, clock = time.perf_counter() - clock, time.perf_counter()
        emit(events.WaveSolved.last_of(so_far, name, pass_number, seconds, stored=is_stored))

    finished = False
    try:
        if stored is not None and stored.finished:
            for count in range(1, stored_waves + 1):
                keep(replace(stored.prediction, scales=stored.prediction.scales[:count]))
        else:
            if stored is not None:
                waves = ReplayedWaves(chain.solver, tuple(stored.prediction.scales))
                chain = replace(chain, solver=waves)
            load = replace(results.load, speed=speed)
            chain.solve(results.rubber.rubber, results.surface.sines, load, on_scale=keep)
        finished = True
    except ChainError as failure:
        results.failures[name] = failure
    finally:
        _save(results, name, with_inputs=True, finished=finished)
    if name in results.predictions:
        failed = results.failures.get(name)
        emit(events.PredictionFinished.of(results.predictions[name], name, failed))
        if results.folder is not None:
            emit(events.FileWritten(str(results.folder / f"{name}.nc")))


def _save(
    results: CaseResults, name: str, *, with_inputs: bool = False, finished: bool = False
) -> None:
    """Write what is known of a prediction, at the end with the inputs beside it."""
    if results.folder is None or name not in results.predictions:
        return
    stamp = {KEY: results.key(name), FINISHED: int(finished)}
    data = results.dataset(name).assign_attrs(stamp)
    groups = {"inputs": record.inputs(results)} if with_inputs else {}
    netcdf.save(data, results.folder / f"{name}.nc", groups)
