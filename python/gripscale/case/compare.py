"""One case through every kind of model: what each assumption of the chain costs.

From rung to rung one assumption is given up: finite strain; one wave after another (the same waves
at once); sine waves (the measured spectrum at once); random phases (the measured profile itself).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gripscale import versions
from gripscale.case.results import CaseResults
from gripscale.chain.model import Chain
from gripscale.chain.solvers import wave_solver
from gripscale.model import Model, NominalLoad
from gripscale.rough import random_phases, surface_of_sines
from gripscale.rough.model import DirectContact
from gripscale.surface import PreparedSurface, Profile
from gripscale.surface.prepared import Measured
from gripscale.theory.half_plane import HalfPlane
from gripscale.theory.models import Persson

if TYPE_CHECKING:
    import xarray as xr

DIRECT = "direct"
JUDGED_TO = 0.1
"""Estimated relative error of the contact that every run judges its chain by."""
LENGTH_OF_SINES = 10
"""Period of a surface of sines over its largest wave."""


class Sample(NamedTuple):
    """One solution of a rung: area and friction, or why there are none."""

    contact_fraction: float
    friction: float
    status: str


@dataclass(frozen=True)
class Rung:
    """What one model says, over its samples (profiles, seeds of random phases)."""

    name: str
    label: str
    """In words, for tables and figures."""
    samples: Sequence[Sample] = field(repr=False)
    seconds: float

    @property
    def status(self) -> str:
        """`converged`, or what the first sample that failed says."""
        bad = (sample.status for sample in self.samples if sample.status != "converged")
        return next(bad, "converged")

    def mean(self, name: str) -> float:
        """Return the mean of `contact_fraction` or `friction`; NaN if a sample failed."""
        return float(np.mean([getattr(sample, name) for sample in self.samples]))

    def spread(self, name: str) -> float:
        """Return the standard deviation over the samples; NaN for a single one."""
        values = [getattr(sample, name) for sample in self.samples]
        return float(np.std(values, ddof=1)) if len(values) > 1 else float("nan")


@dataclass(frozen=True)
class Comparison:
    """The rungs of a case, in order."""

    results: CaseResults
    rungs: list[Rung]

    def to_dataset(self) -> xr.Dataset:
        """Return mean, spread, samples and status of every rung, over `rung`."""
        import xarray as xr

        def along(values: Sequence[object], unit: str, long_name: str) -> xr.Variable:
            attrs = {"units": unit, "long_name": long_name, "source": "gripscale compare"}
            return xr.Variable("rung", np.array(values), attrs)

        data = {}
        for name, text in (
            ("contact_fraction", "real over nominal contact area"),
            ("friction", "friction coefficient"),
        ):
            data[f"total_{name}"] = along([rung.mean(name) for rung in self.rungs], "1", text)
            spread = [rung.spread(name) for rung in self.rungs]
            data[f"{name}_spread"] = along(spread, "1", f"standard deviation of the {text}")
        data["samples"] = along([len(r.samples) for r in self.rungs], "1", "number of samples")
        data["status"] = along([r.status for r in self.rungs], "1", "converged, or why not")
        data["label"] = along([r.label for r in self.rungs], "1", "the model in words")
        data["seconds"] = along([r.seconds for r in self.rungs], "s", "time it took")
        load = self.results.file.case.load
        return xr.Dataset(data, coords={"rung": [rung.name for rung in self.rungs]}).assign_attrs(
            title="Contact and friction by model",
            case=self.results.file.text,
            nominal_pressure_Pa=load.pressure,
            sliding_speed_m_per_s=load.speed,
            **versions.attributes(),
        )


def compare_case(
    results: CaseResults,
    *,
    seeds: int = 3,
    tolerance: float = 0.05,
    on_rung: Callable[[Rung], None] | None = None,
) -> Comparison:
    """Put the models side by side over the inputs of a case.

    Parameters
    ----------
    results : CaseResults
        A prepared case, such as `prepare_case` gives.
    seeds : int
        Random phases drawn of each surface.
    tolerance : float
        Estimated relative error of each direct contact.
    on_rung : callable, optional
        Called with each `Rung` as it is done.

    Returns
    -------
    Comparison
        Without a measured profile only the chain and its own waves at once. A rung that did not
        converge is NaN and says why.

    Raises
    ------
    InputError
        If an input cannot be used by a model.
    """
    rungs = []
    for name, label, tasks in _ladder(results, seeds, tolerance):
        clock = time.perf_counter()
        samples = [_sample(results, model, surface) for model, surface in tasks]
        rung = Rung(name, label, samples, time.perf_counter() - clock)
        rungs.append(rung)
        if on_rung is not None:
            on_rung(rung)
    return Comparison(results, rungs)


def judged(results: CaseResults) -> Rung | None:
    """Return the direct contact of the measured profiles, at the speed of the case.

    None if no profile was measured. Solved to an estimated relative error of `JUDGED_TO`.
    """
    measured = results.surface.measured
    if measured is None:
        return None
    clock = time.perf_counter()
    model = DirectContact(tolerance=JUDGED_TO)
    samples = [_sample(results, model, one) for one in _each(results.surface, measured)]
    return Rung(DIRECT, "profile as measured, at once", samples, time.perf_counter() - clock)


def _ladder(
    results: CaseResults, seeds: int, tolerance: float
) -> Iterator[tuple[str, str, list[tuple[Model, PreparedSurface]]]]:
    """Yield name, label, and a model with a surface for each sample."""
    surface, solver = results.surface, results.file.case.solver
    if solver.model != HalfPlane.name:
        block = Chain(wave_solver(solver.model, solver.options()))
        yield "chain", "chain, finite strain", [(block, surface)]
    yield "chain_half_plane", "chain, small strain", [(Chain(HalfPlane()), surface)]
    direct = DirectContact(tolerance=tolerance)
    length = LENGTH_OF_SINES * float(surface.sines.wavelength[0])
    sines = [surface_of_sines(surface.sines, length, seed) for seed in range(seeds)]
    yield "sines", "its sine waves at once", [(direct, _of(surface, line)) for line in sines]
    if surface.measured is None:
        return
    own = list(_each(surface, surface.measured))
    drawn = [
        _of(surface, random_phases(cleaned, seed))
        for cleaned in surface.measured.cleaned
        for seed in range(seeds)
    ]
    yield "random_phases", "profile with random phases", [(direct, one) for one in drawn]
    yield DIRECT, "profile as measured, at once", [(direct, one) for one in own]
    yield "persson", "Persson, isotropic surface", [(Persson(), one) for one in own]


def _sample(results: CaseResults, model: Model, surface: PreparedSurface) -> Sample:
    load = results.file.case.load
    found = model.predict(
        results.rubber.rubber,
        surface,
        NominalLoad(load.pressure, load.speed, load.footprint, load.load_time),
    )
    return Sample(
        float(found.total_contact_fraction),
        float(found.total_friction_from_dissipation),
        str(found.prediction_status.item()),
    )


def _each(surface: PreparedSurface, measured: Measured) -> Iterator[PreparedSurface]:
    """Yield `surface` with one of its profiles after the other."""
    for cleaned in measured.cleaned:
        yield _of(surface, cleaned)


def _of(surface: PreparedSurface, line: Profile) -> PreparedSurface:
    """Return the waves of `surface` with `line` as the only profile."""
    return PreparedSurface(surface.sines, line.name, measured=Measured.of([line]))
