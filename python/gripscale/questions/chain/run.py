"""The chain of waves of a case, in motion and at rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import xarray as xr

from gripscale.case import Case, fitted_for_load
from gripscale.chain import ChainError
from gripscale.chain.prediction import ChainResult
from gripscale.io import netcdf
from gripscale.questions.answer.answer import Answer
from gripscale.questions.inputs import record
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.material import require_load_bearing

DYNAMIC, STATIC = "dynamic", "static"
CHAIN_REPORT = "chain.txt"  # tables of the chain in the folder of a run


@dataclass
class ChainRun:
    """Predictions of the chain of a case.

    Raises `InputError` if the rubber cannot carry a load, or would be excited beyond its band where
    the case refuses it.
    """

    case: Case
    # By name, "dynamic" and "static".
    predictions: dict[str, ChainResult] = field(default_factory=dict)
    # Why a prediction has no totals, by name.
    failures: dict[str, ChainError] = field(default_factory=dict)
    answer: Answer | None = None  # the answer of the case, which judges the chain in figures

    def __post_init__(self) -> None:
        case, rubber = self.case, self.case.rubber_before
        for speed in planned(case).values():
            load = replace(case.load, speed=speed)
            require_load_bearing(rubber, load.pressure, load.time_under(load.footprint))
            if case.chain.extrapolate == "refuse":
                require_measured(rubber, case.surface.sines.wavelength, speed)

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

    def dataset(self, name: str) -> xr.Dataset:
        """Return the prediction `name` with case, surface and rubber as attributes."""
        sources = {
            "surface_source": self.case.surface.source,
            "rubber_source": self.case.measured_rubber.source,
        }
        return self.predictions[name].to_dataset().assign_attrs(self.case.attributes | sources)

    def solve(
        self, folder: Path | None = None, on_wave: Callable[[ChainResult], None] | None = None
    ) -> None:
        """Solve every prediction of the case, and write it to `dynamic.nc` and `static.nc`.

        A wave that does not converge ends its prediction, which is named in `failures`. `on_wave`
        is called with each prediction down to the wave just solved. What was solved is written even
        if it raises an error, or Ctrl-C ends it.
        """
        case = self.case
        for name, speed in planned(case).items():

            def keep(so_far: ChainResult, name: str = name) -> None:
                self.predictions[name] = so_far
                if on_wave is not None:
                    on_wave(so_far)

            try:
                load = replace(case.load, speed=speed)
                surface, effects = case.surface, case.conditions
                rubber = fitted_for_load(case.measured_rubber, surface, load, effects).rubber
                case.chain.solve(rubber, surface.sines, load, on_scale=keep)
            except ChainError as failure:
                self.failures[name] = failure
            finally:
                if folder is not None and name in self.predictions:
                    groups = {"inputs": record.inputs(case)}
                    netcdf.save(self.dataset(name), folder / f"{name}.nc", groups)


def planned(case: Case) -> dict[str, float]:
    """Return the speeds [m/s] of the predictions that a case asks for, by their names."""
    speeds = {DYNAMIC: case.load.speed} if case.load.speed > 0.0 else {}
    return speeds | ({STATIC: 0.0} if case.static or not speeds else {})
