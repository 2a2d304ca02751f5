"""The chain of waves of a case, in motion and at rest, kept in a folder as the waves are solved."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import xarray as xr

from gripscale.case import Case
from gripscale.chain import Chain, ChainError
from gripscale.chain.prediction import ChainResult
from gripscale.core.errors import FileError, InputError
from gripscale.experiment.task import Task
from gripscale.io import netcdf
from gripscale.questions.answer.answer import Answer
from gripscale.questions.chain import events
from gripscale.questions.chain.events import OnEvent
from gripscale.questions.inputs import record
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.wave.kernel import WaveSolver
from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import ScaleResult

DYNAMIC, STATIC = "dynamic", "static"
CHAIN_REPORT = "chain.txt"  # tables of the chain in the folder of a run
# Attributes of a result: what it depends on, and whether its chain came to its end.
_KEY, FINISHED = "prediction_key", "prediction_finished"
SAVE_EVERY = 2.0  # least time between two savings of an unfinished prediction [s]; each takes 0.1 s


@dataclass(frozen=True)
class StoredPrediction:
    """A prediction of an earlier run: all of it, or the waves that converged."""

    prediction: ChainResult
    finished: bool


@dataclass(frozen=True)
class ReplayedWaves:
    """Answers stored waves with their stored results, and solves the others."""

    inner: WaveSolver
    stored: tuple[ScaleResult, ...]

    @property
    def name(self) -> str:
        """Name of the solver inside."""
        return self.inner.name

    def solve(self, problem: WaveProblem, start: ScaleResult | None = None) -> ScaleResult:
        """Return the stored result of just this wave under just this pressure, or solve it."""
        asked = problem.profile.wavelength, problem.profile.amplitude, problem.load.pressure
        for wave in self.stored:
            if (wave.wavelength, wave.amplitude, wave.pressure_received) == asked:
                return wave
        return self.inner.solve(problem, start)


@dataclass
class ChainRun:
    """Predictions of the chain of a case; more are added as they are solved."""

    case: Case
    folder: Path | None = None  # gets a file for each prediction, `dynamic.nc` and `static.nc`
    # By name, "dynamic" and "static".
    predictions: dict[str, ChainResult] = field(default_factory=dict)
    # Why a prediction has no totals, by name.
    failures: dict[str, ChainError] = field(default_factory=dict)
    # Predictions of an earlier run of the same case.
    stored: dict[str, StoredPrediction] = field(default_factory=dict)
    answer: Answer | None = None  # the answer of the case, which judges the chain in figures

    @classmethod
    def of(cls, case: Case, folder: Path | None = None, *, fresh: bool = False) -> ChainRun:
        """Return a run with what an earlier one of the same case left in the folder.

        `fresh` takes nothing up. Raises `InputError` as `require_feasible`.
        """
        run = cls(case, folder)
        require_feasible(case)
        if folder is not None and not fresh:
            for name in planned(case):
                prediction = earlier(folder / f"{name}.nc", run.key(name), case.chain)
                if prediction is not None:
                    run.stored[name] = prediction
        return run

    @property
    def dynamic(self) -> ChainResult | None:
        """The rubber sliding, or None if it was not asked for or has no wave yet."""
        return self.predictions.get(DYNAMIC)

    @property
    def static(self) -> ChainResult | None:
        """The relaxed rubber at rest, or None if it was not asked for or has no wave yet."""
        return self.predictions.get(STATIC)

    @property
    def converged(self) -> bool:
        """Whether every prediction asked for may be used."""
        return not self.failures

    @property
    def kept_files(self) -> list[str]:
        """Files in the folder that hold stored predictions."""
        return [f"{name}.nc" for name in self.stored]

    def key(self, name: str) -> str:
        """Return the key of the prediction `name`: equal keys mean equal results."""
        load = replace(self.case.load, speed=planned(self.case)[name])
        return Task(self.case.rubber, self.case.surface, load, self.case.chain).key

    def dataset(self, name: str) -> xr.Dataset:
        """Return the prediction `name` with case, surface and rubber as attributes."""
        sources = {
            "surface_source": self.case.surface.source,
            "rubber_source": self.case.measured_rubber.source,
        }
        return self.predictions[name].to_dataset().assign_attrs(self.case.attributes | sources)

    def solve(self, on_event: OnEvent | None = None) -> None:
        """Solve and keep every prediction of the case.

        A wave that does not converge ends its prediction, which is named in `failures`.
        """
        for name in planned(self.case):
            self._solve(name, on_event or (lambda event: None))

    def _solve(self, name: str, emit: OnEvent) -> None:
        chain, stored = self.case.chain, self.stored.get(name)
        stored_waves = 0 if stored is None else len(stored.prediction.scales)
        clock = saved = time.perf_counter()
        pass_number = 0

        def keep(so_far: ChainResult) -> None:
            nonlocal clock, saved, pass_number
            self.predictions[name] = so_far
            is_stored = len(so_far.scales) <= stored_waves
            if not is_stored:
                if time.perf_counter() - saved > SAVE_EVERY:
                    self._save(name)
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
                load = replace(self.case.load, speed=planned(self.case)[name])
                chain.solve(self.case.rubber, self.case.surface.sines, load, on_scale=keep)
            finished = True
        except ChainError as failure:
            self.failures[name] = failure
        finally:
            self._save(name, with_inputs=True, finished=finished)
        if name in self.predictions:
            failed = self.failures.get(name)
            emit(events.PredictionFinished.of(self.predictions[name], name, failed))
            if self.folder is not None:
                emit(events.FileWritten(str(self.folder / f"{name}.nc")))

    def _save(self, name: str, *, with_inputs: bool = False, finished: bool = False) -> None:
        """Write the waves of a prediction, at the end with the record of the inputs."""
        if self.folder is None or name not in self.predictions:
            return
        stamp = {_KEY: self.key(name), FINISHED: int(finished)}
        data = self.dataset(name).assign_attrs(stamp)
        groups = {"inputs": record.inputs(self.case)} if with_inputs else {}
        netcdf.save(data, self.folder / f"{name}.nc", groups)


def planned(case: Case) -> dict[str, float]:
    """Return the speeds [m/s] of the predictions that a case asks for, by their names."""
    speeds = {DYNAMIC: case.load.speed} if case.load.speed > 0.0 else {}
    return speeds | ({STATIC: 0.0} if case.static or not speeds else {})


def earlier(path: Path, key: str, chain: Chain) -> StoredPrediction | None:
    """Return the prediction stored at `path`, or None if it is not of `key` or of no use.

    Of an unfinished one the waves that converged are of use if each depends on nothing but the one
    above it: under one pressure class, without conditions that are solved in several passes.
    """
    try:
        data = netcdf.load_dataset(path)
        if data.attrs.get(_KEY) != key:
            return None
        prediction = ChainResult.from_dataset(data)
    except (FileError, InputError):
        return None
    if bool(data.attrs.get(FINISHED, 0)) and prediction.converged:
        return StoredPrediction(prediction, finished=True)
    iterated = chain.conditions is not None and chain.conditions.iterated
    waves = [wave for wave in prediction.scales if wave.converged]
    if iterated or chain.pressure_classes > 1 or not waves:
        return None
    return StoredPrediction(replace(prediction, scales=waves), finished=False)


def require_feasible(case: Case) -> None:
    """Raise `InputError` if the rubber cannot carry a load or would be excited beyond its band.

    The latter only if the case refuses it.
    """
    rubber = case.rubber_before
    for speed in planned(case).values():
        load = replace(case.load, speed=speed)
        require_load_bearing(rubber, load.pressure, load.time_under(load.footprint))
    if case.chain.extrapolate == "refuse":
        for speed in planned(case).values():
            require_measured(rubber, case.surface.sines.wavelength, speed)
