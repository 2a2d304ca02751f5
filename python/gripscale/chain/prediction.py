"""Result of the chain: the solved waves, and area and friction down to each of them.

    A_r/A_0  = prod A_i / lambda_i,    mu_r = sum mu_i

Lind & Wangenheim 2014, IMECE2014-37998, equations 2 and 3. A wave hands down the pressure in its
contact: its mean (equation 1), or N classes of equal load with areas a_n over the nominal area,

    a_n = int dF / p    over the n-th of N equal shares of the load F,    p_n = p_1 / (N a_n).

The contacts of the next wave under all p_n are divided into N classes again.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
import xarray as xr

import gripscale
from gripscale import model
from gripscale.conditions.conditions import Conditions
from gripscale.core import Array, Pictured, Status, labelled, provenance
from gripscale.core.errors import ConvergenceError, InputError
from gripscale.core.units import readable
from gripscale.cut_off_exponents import NOT_CONVERGED, CutOffExponents, of_curve
from gripscale.model import Load
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import Extrapolation, of_sum
from gripscale.surface import SineStack
from gripscale.wave.kernel import WaveSolver
from gripscale.wave.problem import Sine, WaveLoad, WaveProblem
from gripscale.wave.result import CHAIN, LW, ScaleResult, padded, waves_to_dataset

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Name of the pressures of the classes [Pa], among the details of a wave.
CLASS_PRESSURES = "class_pressures"


@dataclass(frozen=True)
class PressureClasses:
    """Parts of the nominal area under one pressure each, all of the same load."""

    pressure: Array  # on each class [Pa], rising
    area: Array  # of each class over the nominal area [-]

    @classmethod
    def uniform(cls, pressure: float) -> PressureClasses:
        """Return the whole nominal area under one pressure."""
        return cls(np.array([pressure]), np.ones(1))

    @property
    def mean(self) -> float:
        """Mean pressure on the area of all classes [Pa]."""
        return float(self.pressure @ self.area / self.area.sum())

    def handed_down(self, solved: Sequence[ScaleResult], count: int) -> PressureClasses:
        """Return `count` classes of the contacts of the waves solved under each class."""
        if count == len(solved) == 1:
            wave, area = solved[0], self.area * solved[0].contact_fraction
            # equation 1; unchanged in full contact
            return PressureClasses(self.pressure * wave.wavelength / wave.contact_length, area)
        parts = [_contact_of(wave) for wave in solved]
        area = np.concatenate([a * part for a, (part, _) in zip(self.area, parts, strict=True)])
        pressure = np.concatenate([values for _, values in parts])
        order = np.argsort(pressure)
        load = np.append(0.0, np.cumsum((area * pressure)[order]))
        below = np.append(0.0, np.cumsum(area[order]))
        areas = np.diff(np.interp(np.linspace(0.0, load[-1], count + 1), load, below))
        return PressureClasses(load[-1] / (count * areas), areas)

    def combined(self, solved: Sequence[ScaleResult]) -> ScaleResult:
        """Return one result for a wave solved under each class.

        Contact fractions are averaged by area, frictions by load; stretches, residual and status
        are the worst ones, iterations are summed. Pressure and deformed mesh are those of the class
        nearest to the mean pressure.
        """
        failed = [wave for wave in solved if not passes_pressure(wave)]
        if failed or len(solved) == 1:
            return (failed or list(solved))[0]
        nearest = solved[int(np.argmin(np.abs(self.pressure - self.mean)))]

        def average(name: str, weight: Array) -> float:
            return float(np.average([getattr(wave, name) for wave in solved], weights=weight))

        by_load = self.area * self.pressure
        return replace(
            nearest,
            pressure_received=self.mean,
            contact_fraction=average("contact_fraction", self.area),
            contact_fraction_error=average("contact_fraction_error", self.area),
            friction=average("friction", by_load),
            friction_from_dissipation=average("friction_from_dissipation", by_load),
            friction_error=average("friction_error", by_load),
            newton_iterations=sum(wave.newton_iterations for wave in solved),
            residual=max(wave.residual for wave in solved),
            min_stretch=min(wave.min_stretch for wave in solved),
            max_stretch=max(wave.max_stretch for wave in solved),
            details={**nearest.details, CLASS_PRESSURES: self.pressure},
        )


def passes_pressure(wave: ScaleResult) -> bool:
    """Return whether the next wave can be solved: this one converged and is in contact."""
    return wave.converged and 0.0 < wave.contact_fraction <= 1.0


def _contact_of(wave: ScaleResult) -> tuple[Array, Array]:
    """Return share of the wavelength and pressure [Pa] of each node in contact.

    The edges of the contact lie between nodes, so that shares are scaled to the contact fraction
    and pressures to the load.
    """
    after = np.append(wave.x[1:], wave.x[0] + wave.wavelength)
    before = np.insert(wave.x[:-1], 0, wave.x[-1] - wave.wavelength)
    active = wave.pressure > 0.0
    if not active.any():
        raise InputError(
            "pressure_classes must be 1 for a solver that gives no pressure along the wave; "
            f"got none above zero from {wave.model}"
        )
    share = (after - before)[active]
    share *= wave.contact_fraction / share.sum()
    pressure = wave.pressure[active]
    return share, pressure * (wave.pressure_received / (share @ pressure))


@dataclass(frozen=True, repr=False)
class ChainResult(Pictured):
    """Contact and friction of a stack of waves (m, Pa, m/s).

    A wave that did not converge is kept, last, with its status: the totals are then NaN.
    """

    rubber: Rubber
    """As measured; under conditions each wave has another one, see `ScaleResult.rubber`."""
    sines: SineStack
    load: Load
    scales: list[ScaleResult]
    planned: int
    """Number of waves to solve."""
    conditions: Conditions | None = None
    """Conditions of the rubber, and the area term."""

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield status, contact, friction, load and the waves."""
        yield "status", str(self.status)
        for name in ("contact_fraction", "friction", "friction_from_dissipation"):
            yield name, f"{getattr(self, name):.4g}"
        yield "waves", f"{len(self.scales)} of {self.planned} solved"
        load = self.load
        yield "load", f"{readable(load.pressure, 'Pa')}, {readable(load.speed, 'm/s')}"
        yield "rubber", self.rubber.name or "unnamed"
        for scale in self.scales[:7]:
            length, pressure = readable(scale.wavelength, "m"), scale.pressure_received
            yield length, f"{readable(pressure, 'Pa')}, friction {scale.friction:.3g}"

    @property
    def status(self) -> Status:
        """`converged` if every wave so far has converged, else the status of the last."""
        return self.scales[-1].status if self.scales else Status.CONVERGED

    @property
    def converged(self) -> bool:
        """Whether every wave so far has converged."""
        return all(scale.converged for scale in self.scales)

    @property
    def running_contact_fraction(self) -> Array:
        """A_r/A_0 down to each wave (equation 2); NaN from a failed wave on."""
        return np.asarray(np.cumprod(self._of_converged("contact_fraction")), dtype=float)

    @property
    def running_friction(self) -> Array:
        """Friction coefficient down to each wave (equation 3); NaN from a failed wave on."""
        return np.cumsum(self._of_converged("friction"))

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area, A_r/A_0, of all waves [-]."""
        return float(self.running_contact_fraction[-1]) if self.scales else math.nan

    @property
    def friction(self) -> float:
        """Friction coefficient of all waves [-]."""
        return float(self.running_friction[-1]) if self.scales else math.nan

    @property
    def friction_from_dissipation(self) -> float:
        """Friction coefficient of all waves from the energy lost in the rubber [-]."""
        each = self._of_converged("friction_from_dissipation")
        return float(each.sum()) if self.scales else math.nan

    @property
    def adhesive_friction(self) -> float:
        """Friction coefficient of the area term [-]; NaN without an area term, and at rest."""
        if self.conditions is None or not self.scales:
            return math.nan
        kelvin = self.scales[-1].details.get("contact_temperature")
        if kelvin is None:
            kelvin = self.conditions.temperature_of(self.rubber)
        load = self.load
        return self.conditions.adhesive_friction(
            self.contact_fraction, load.pressure, load.speed, kelvin
        )

    @property
    def total_friction(self) -> float:
        """Sum of hysteresis and area term [-]; NaN without an area term."""
        return self.friction + self.adhesive_friction

    @property
    def extrapolation(self) -> Extrapolation:
        """Share of the friction that uses the rubber beyond its measured frequencies."""
        each = [scale.extrapolation for scale in self.scales]
        return of_sum(each, self._of_converged("friction"))

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """Exponents of the cut-off, over the last octave of the waves."""
        if not self.converged:
            return NOT_CONVERGED
        return of_curve(
            [scale.wavelength for scale in self.scales],
            self.running_contact_fraction,
            self.running_friction,
            moving=self.load.speed > 0.0,
        )

    @property
    def why(self) -> str:
        """`converged`, or which wave failed and why."""
        if self.converged:
            return "converged"
        scale = self.scales[-1]
        return (
            f"{self.last_wave()} did not converge: {scale.why} after {scale.newton_iterations} "
            f"Newton iterations, residual {scale.residual:.2g}"
        )

    def last_wave(self) -> str:
        """Return number and data of the last wave, in words."""
        scale = self.scales[-1]
        return (
            f"wave {len(self.scales)} of {self.planned} "
            f"(wavelength {scale.wavelength * 1e3:.4g} mm, "
            f"amplitude {scale.amplitude * 1e3:.4g} mm, pressure {scale.pressure_received:.4g} Pa, "
            f"speed {scale.speed:.4g} m/s)"
        )

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over the dimension `scale`."""
        data = waves_to_dataset(self.scales)
        what = {"contact_fraction": "real contact area", "friction": "friction coefficient"}
        for number, name in enumerate(what, start=2):
            values, source = getattr(self, f"running_{name}"), f"{LW}, equation {number}"
            words = f"{what[name]} down to the wave"
            data[f"running_{name}"] = labelled("scale", values, "1", words, source)
        for part in ("wavelength", "amplitude"):
            values, words = getattr(self.sines, part), f"{part} of the waves"
            data[f"sines_{part}"] = labelled("wave", values, "m", words, CHAIN)
        classes = [
            np.ravel(s.details.get(CLASS_PRESSURES, s.pressure_received)) for s in self.scales
        ]
        if any(len(pressures) > 1 for pressures in classes):
            dims, words = ("scale", "pressure_class"), "pressure on each class of equal load"
            data[CLASS_PRESSURES] = labelled(dims, padded(classes), "Pa", words, CHAIN)
        totals = {total: getattr(self, total.removeprefix("total_")) for total in model.TOTALS}
        data = data.assign_attrs(
            title="Real contact area and friction of rubber on a rough surface",
            rubber=f"{self.rubber.name}; {self.rubber.source}".strip("; "),
            rubber_parameters=json.dumps(self.rubber.to_dict()),
            planned_waves=self.planned,
            conditions=json.dumps(None if self.conditions is None else self.conditions.to_dict()),
            method=f"{LW}, equations 1 to 3",
            **provenance.version_attributes(),
        )
        answer = model.predicted_answer(
            data,
            totals,
            self.why,
            "chain",
            self.load,
            self.extrapolation,
            self.cut_off_exponents,
            status_word=str(self.status),
        )
        return model.with_area_term(answer, self.adhesive_friction)

    def plot(self) -> Figure:
        """Draw area and friction down to each wave; see `gripscale.questions.contact_figure`."""
        return gripscale.questions.contact_figure({"chain": self.to_dataset()})

    def _of_converged(self, name: str) -> Array:
        """Return a number of each wave, NaN where it did not converge."""
        return np.array([getattr(s, name) if s.converged else math.nan for s in self.scales])


class RubberAt(Protocol):
    """Rubber of each wave, which may depend on the waves solved before."""

    def __call__(self, wave: Sine, so_far: ChainResult) -> Rubber:
        """Return the rubber on `wave`, the next one after those of `so_far`."""


class ChainError(ConvergenceError):
    """A wave of the chain did not converge; `partial` holds everything solved up to it.

    The last entry of `partial.scales` is the wave that failed, with its status.
    """

    def __init__(self, message: str, partial: ChainResult) -> None:
        super().__init__(message)
        self.partial = partial

    @property
    def status(self) -> Status | None:
        """The status of the wave; None if it converged to a contact that cannot be."""
        return None if self.partial.converged else self.partial.status


@dataclass(frozen=True)
class ChainSolve:
    """Solves all waves one after the other and adds them to an `empty` prediction."""

    empty: ChainResult
    waves: Sequence[Sine]
    solver: WaveSolver
    classes: int  # number of pressure classes
    on_scale: Callable[[ChainResult], None] | None

    def __call__(self, rubber_at: RubberAt, start: ChainResult | None) -> ChainResult:
        """Return the prediction with the rubber of each wave, each from its wave of `start`."""
        result, load = self.empty, self.empty.load
        classes, length = PressureClasses.uniform(load.pressure), load.footprint
        for number, wave in enumerate(self.waves):
            first = start.scales[number] if start and number < len(start.scales) else None
            solid, time = rubber_at(wave, result), load.time_under(length)
            loads = [WaveLoad(pressure, load.speed, time) for pressure in classes.pressure.tolist()]
            problems = [WaveProblem(solid, wave, each, load.thickness) for each in loads]
            solved = [self.solver.solve(problem, first) for problem in problems]
            scale = classes.combined(solved)
            result = replace(result, scales=[*result.scales, scale])
            if self.on_scale is not None:
                self.on_scale(result)
            if not scale.converged:
                raise ChainError(result.why, result)
            if not passes_pressure(scale):
                raise ChainError(
                    f"{result.last_wave()} has a contact fraction of {scale.contact_fraction:g}; "
                    "expected more than 0 and at most 1",
                    result,
                )
            length = scale.contact_length
            classes = classes.handed_down(solved, self.classes)
        return result
