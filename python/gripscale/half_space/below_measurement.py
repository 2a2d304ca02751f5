"""Contact and friction against the cut-off, from the longest waves to far below the measurement.

A line is continued octave by octave: its measured waves stay, and random waves are added below them
(`gripscale.surface.periodic`). What counts is how rough the faces are that touch, so the slope of
each octave is measured on the points in contact of the solution without it, as the 68 % quantile of
its magnitude: steep edges, of which there are few, do not decide it. Each new octave gets a slope
that is r times that of the octave above. r comes from

- the faces themselves (`OwnFaces`): the last measured octave is withheld, continued in the same way
  and solved; with r_1 the ratio that gives its true friction, r = sqrt(r_1);
- a finer measurement of a face of a stone (`FinerMeasurement`): the slopes of its octaves;
- a stated Hurst exponent (`HurstExponent`): r = 2^(1 - H).

The square root is a compromise between constant slope and the last measured octave: the ratio of
one octave says only half of the next. Withheld octaves of measured and synthetic surfaces show how
far a continuation errs: see `BAND`.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from gripscale.core import checks, provenance
from gripscale.core.arrays import Array, Mask
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.core.parallel import in_threads, worker_count
from gripscale.core.units import in_mm
from gripscale.half_space.grid import nearest, periodic_heights
from gripscale.half_space.grid_sequence import POINTS_IN_WAVE
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile
from gripscale.surface.periodic import Intermittency, PeriodicLine

if TYPE_CHECKING:
    import xarray as xr

BAND = 0.20
"""Half width of the 90 % band of a number one octave below the measurement, relative to it.
Measured on withheld octaves, see docs/below-measurement.md."""

_BAND_GROWTH = 0.5
"""Power of the octaves below the measurement that the band grows with."""

QUANTILE = 0.68
"""Share of the points in contact whose slope is below that of an octave."""

RATIO_LIMIT = 0.3
"""Largest |ln r_1|: an octave that rolls off faster is the end of an instrument's band."""

MOST_OCTAVES = 8
_LEAST_STEP = 0.05
"""Rest of an octave, over the last cut-off, that is not a step of its own."""

_LONGEST = 0.25
"""Longest cut-off over the length of the shortest line."""

OnContact = Callable[[RoughContact], None]


class OwnFaces(Checked):
    """Continue with the slopes of the faces that touch."""


class HurstExponent(Checked):
    """Continue the slopes of the faces that touch as a power law with this exponent."""

    hurst: float = checked(checks.positive)

    def __post_init__(self) -> None:
        checks.at_most_one("hurst", self.hurst)


class FinerMeasurement(Checked):
    """Continue with the slopes of a finer measurement of a face of a stone: a line or a map."""

    surface: Profile | HeightMap

    @cached_property
    def lines(self) -> list[Profile]:
        """The measured lines."""
        return [self.surface] if isinstance(self.surface, Profile) else self.surface.lines()

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Longest and shortest wavelength [m] whose slope is measured."""
        longest = _LONGEST * self.lines[0].length
        return longest, max(line.resolution_limit for line in self.lines)

    def slope(self, longest: float, shortest: float) -> float:
        """Return the slope [-] of the waves between two wavelengths [m]."""
        periodic = [_periodic(line, shortest) for line in self.lines]
        return typical(np.concatenate([line.slope(longest, shortest) for line in periodic]))


Roughness = OwnFaces | HurstExponent | FinerMeasurement
"""Where the roughness below the measurement comes from."""


def as_roughness(name: str, value: Any) -> Roughness:
    """Return `value` if it is a `Roughness`; else raise `InputError`."""
    if not isinstance(value, Roughness):
        expected = "OwnFaces, HurstExponent or FinerMeasurement"
        raise InputError(f"{name} must be {expected}; got {checks.short_repr(value)}")
    return value


@dataclass(frozen=True)
class Withheld:
    """The last measured octave, continued from those above with constant slope."""

    contact_fraction_error: float
    """Relative error of the contact fraction [-]."""
    friction_error: float
    """Relative error of the friction coefficient [-]."""
    slope_ratio: float
    """r_1, the slope over that of the octave above that gives the true friction [-]."""


@dataclass(frozen=True, eq=False)
class CutOffContact:
    """The contacts of all lines with waves down to one cut-off."""

    wavelength: float
    """Shortest wavelength of the lines [m]."""
    contacts: tuple[RoughContact, ...] = field(repr=False)
    lines: tuple[PeriodicLine, ...] = field(repr=False)
    slope: float
    """Slope of the last octave on the faces that touch [-]; NaN for the first."""

    def mean(self, name: str) -> float:
        """Return a number of the contacts, averaged by length."""
        values = [getattr(contact, name) for contact in self.contacts]
        lengths = [contact.grid.lengths[0] for contact in self.contacts]
        return float(np.average(values, weights=lengths))

    @property
    def faces(self) -> list[Mask]:
        """Where each line is in contact, on the points of the line."""
        return [
            nearest(contact.active, (line.points,))
            for line, contact in zip(self.lines, self.contacts, strict=True)
        ]


@dataclass(frozen=True, eq=False)
class ContactByCutOff:
    """Contact and friction of lines against the cut-off."""

    steps: tuple[CutOffContact, ...]
    """From the longest cut-off to the shortest, an octave apart."""
    resolved: float
    """Shortest wavelength that was measured [m]."""
    slope_ratio: float
    """r, slope of a continued octave over that of the octave above [-]; NaN with a finer
    measurement, which has a slope for each."""
    withheld: Withheld | None
    """How well the last measured octave is found from those above; None where it was not tried."""
    overlap: float
    """Slope of the faces over that of the finer measurement where both are measured [-]."""

    @property
    def wavelength(self) -> Array:
        """Shortest wavelength of each step [m]."""
        return np.array([step.wavelength for step in self.steps])

    @property
    def octaves_below(self) -> Array:
        """Octaves of each step below the measurement."""
        return np.maximum(np.log2(self.resolved / self.wavelength), 0.0)

    @property
    def band(self) -> Array:
        """Half width of the 90 % band of each step, relative to its number."""
        return BAND * self.octaves_below**_BAND_GROWTH

    def values(self, name: str) -> Array:
        """Return a number of `RoughContact` at each step, averaged by length."""
        return np.array([step.mean(name) for step in self.steps])

    @property
    def converged(self) -> bool:
        """Whether all contacts of the last step converged."""
        return all(contact.converged for contact in self.steps[-1].contacts)

    def to_dataset(self) -> xr.Dataset:
        """Return the curves over `cut_off` with their bands."""
        import xarray as xr

        def over(values: Any, unit: str, text: str) -> xr.Variable:
            return xr.Variable("cut_off", values, {"units": unit, "long_name": text})

        data = {"measured": over(self.octaves_below == 0.0, "1", "whether all waves were measured")}
        for name, text in _CURVES.items():
            data[name] = over(self.values(name), "1", text)
        for name in ("contact_fraction", "friction_from_dissipation"):
            for end, sign in (("lower", -1.0), ("upper", 1.0)):
                values = self.values(name) * np.exp(sign * np.arcsinh(self.band))
                data[f"{name}_{end}"] = over(values, "1", f"{end} end of the 90 % band")
        data["octave_slope"] = over(
            [step.slope for step in self.steps], "1", "slope of the last octave on the faces"
        )
        statuses = ["; ".join({str(c.status) for c in step.contacts}) for step in self.steps]
        data["status"] = over(np.array(statuses, dtype=object), "1", "converged, or why not")
        facts = {
            "resolved": self.resolved,
            "slope_ratio": self.slope_ratio,
            "overlap": self.overlap,
        }
        if self.withheld is not None:
            facts |= {f"withheld_{name}": value for name, value in vars(self.withheld).items()}
        for name, value in facts.items():
            if math.isfinite(value):
                unit = "m" if name == "resolved" else "1"
                data[name] = xr.Variable((), value, {"units": unit, "long_name": FACTS[name]})
        contact = self.steps[0].contacts[0]
        attributes = {
            "title": "Contact and friction against the cut-off",
            "nominal_pressure": contact.nominal_pressure,
            "speed": contact.speed,
        }
        coordinate = over(self.wavelength, "m", "shortest wavelength of the surface")
        return xr.Dataset(
            data, {"cut_off": coordinate}, attributes | provenance.version_attributes()
        )


_CURVES = {
    "contact_fraction": "real over nominal contact area",
    "friction": "friction coefficient from the contact traction",
    "friction_from_dissipation": "friction coefficient from the energy lost in the rubber",
    "slope_in_contact": "rms slope of the surface in the contact",
}
"""Numbers of `RoughContact` over the cut-off."""

FACTS = {
    "resolved": "shortest wavelength that was measured",
    "slope_ratio": "slope of a continued octave over that of the octave above",
    "overlap": "slope of the faces over that of the finer measurement",
    "withheld_contact_fraction_error": "relative error of the withheld octave, contact fraction",
    "withheld_friction_error": "relative error of the withheld octave, friction",
    "withheld_slope_ratio": "slope ratio that gives the friction of the withheld octave",
}
"""What a Dataset holds of a continuation, as far as it is known."""


def cut_off_at(slope: float, wavelength: Array, slopes: Array) -> float:
    """Return the cut-off [m] at which the rms slope in contact reaches a value; NaN if none.

    `slopes` are those at the cut-offs `wavelength` [m], which fall.
    """
    above = np.flatnonzero(slopes >= slope)
    if not above.size or above[0] == 0:
        return math.nan
    at = slice(above[0] - 1, above[0] + 1)
    return float(np.exp(np.interp(slope, slopes[at], np.log(wavelength[at]))))


def contact_by_cut_off(
    rubber: Rubber,
    lines: Profile | Sequence[Profile],
    *,
    pressure: float,
    speed: float,
    down_to: float,
    longest: float = 30e-3,
    roughness: Roughness | None = None,
    seed: int = 0,
    on_contact: OnContact | None = None,
    **options: Any,
) -> ContactByCutOff:
    """Return contact and friction of measured lines, solved with one cut-off after the other.

    Cut-offs are an octave apart. Above the shortest wavelength that the lines resolve, the waves
    are measured; below, they are continued and the numbers have a `band`.

    Parameters
    ----------
    rubber : Rubber
        The half-space.
    lines : Profile or sequence of Profile
        Lines of one surface; the slopes of their faces are pooled.
    pressure : float
        Nominal pressure [Pa].
    speed : float
        Sliding speed [m/s].
    down_to : float
        Last cut-off [m], at most eight octaves below the measurement.
    longest : float
        About the first cut-off [m]; a quarter of the shortest line at most.
    roughness : OwnFaces, HurstExponent or FinerMeasurement, optional
        What the continued octaves are taken from: the faces of the lines by default.
    seed : int
        Seed of the random waves.
    on_contact : callable, optional
        Called with each contact of the result as it is solved.
    options
        Further arguments of `solve_rough_contact`: conditions, footprint, extrapolate.

    Raises
    ------
    InputError
        If an argument is out of its range, a finer measurement does not reach `down_to` or is
        rougher or smoother than the faces by more than a factor of three where both are measured;
        and as `solve_rough_contact` does.
    """
    profiles = [lines] if isinstance(lines, Profile) else checks.instances("lines", lines, Profile)
    source = OwnFaces() if roughness is None else as_roughness("roughness", roughness)
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    resolved = max(line.resolution_limit for line in profiles)
    last = checks.positive("down_to", down_to, unit="m")
    if last > resolved / (1.0 + _LEAST_STEP):
        last = max(last, resolved)
    if last < resolved / 2**MOST_OCTAVES:
        raise InputError(
            f"down_to must be at least {resolved / 2**MOST_OCTAVES:.3g} m, {MOST_OCTAVES} octaves "
            f"below the {in_mm(resolved, 3)} that the lines resolve; got {last:.3g} m"
        )
    solver = _Solver(rubber, {"pressure": pressure, "speed": speed, "tolerance": None, **options})
    periodic = [_periodic(line, resolved, last) for line in profiles]
    shortest_line = min(line.length for line in periodic)
    most = min(checks.positive("longest", longest, unit="m"), _LONGEST * shortest_line)
    measured_to = max(resolved, last)
    octaves = max(0, math.floor(math.log2(most / measured_to) + 1e-9))
    cut_offs = measured_to * 2.0 ** np.arange(octaves, -1, -1)
    steps: list[CutOffContact] = []
    for cut_off in cut_offs:
        shorter = [line.down_to(cut_off) for line in periodic]
        slope = _octave_slope(periodic, steps[-1].faces, cut_off) if steps else math.nan
        steps.append(solver.step(shorter, float(cut_off), slope, on_contact))
    if last >= resolved:
        return ContactByCutOff(tuple(steps), resolved, math.nan, None, math.nan)
    if len(steps) < 3:
        raise InputError(
            f"lines must hold three octaves above {in_mm(resolved, 3)}, the shortest wavelength "
            f"they resolve, to be continued; got lines of {in_mm(periodic[0].length, 3)}"
        )
    continuation = _Continuation.of(solver, steps, source, last, random)
    while steps[-1].wavelength > last:
        steps.append(continuation.next(solver, steps, last, random, on_contact))
    return ContactByCutOff(
        tuple(steps),
        resolved,
        continuation.slope_ratio,
        continuation.withheld,
        continuation.overlap,
    )


def _periodic(line: Profile, shortest: float, finest: float | None = None) -> PeriodicLine:
    """Return the waves of a line down to `shortest`, with points for waves to `finest` [m]."""
    heights = periodic_heights(line, smallest_wavelength=shortest, periodic=False)
    length = heights.grid.lengths[0]
    waves = length / min(shortest, finest or shortest)
    points = 2 * scipy.fft.next_fast_len(math.ceil(0.5 * POINTS_IN_WAVE * waves))
    return PeriodicLine(length, points, np.asarray(scipy.fft.rfft(heights.on((points,)))))


def typical(slopes: Array) -> float:
    """Return the slope [-] that stands for an octave."""
    return float(np.quantile(np.abs(slopes), QUANTILE))


def _octave_slope(
    lines: Sequence[PeriodicLine], faces: Sequence[Mask], shortest: float, octaves: float = 1.0
) -> float:
    """Return the slope of the waves down to `shortest` [m] on faces [-]."""
    longest = 2.0**octaves * shortest
    slopes = [line.slope(longest, shortest)[on] for line, on in zip(lines, faces, strict=True)]
    return typical(np.concatenate(slopes))


@dataclass(frozen=True)
class _Solver:
    rubber: Rubber
    options: dict[str, Any]

    def step(
        self,
        lines: Sequence[PeriodicLine],
        cut_off: float,
        slope: float,
        on_contact: OnContact | None = None,
    ) -> CutOffContact:
        """Return the contacts of lines with waves down to a cut-off [m]."""

        def job(line: PeriodicLine, _: threading.Event) -> RoughContact:
            return solve_rough_contact(
                self.rubber,
                line.profile(),
                smallest_wavelength=cut_off,
                periodic=True,
                **self.options,
            )

        contacts: list[RoughContact | None] = [None] * len(lines)
        jobs = [partial(job, line) for line in lines]
        with closing(in_threads(jobs, worker_count(None))) as solved:
            for at, contact in solved:
                contacts[at] = contact
                if on_contact is not None:
                    on_contact(contact)
        return CutOffContact(cut_off, tuple(c for c in contacts if c), tuple(lines), slope)

    def continued(
        self,
        step: CutOffContact,
        intermittency: Intermittency,
        slope: float,
        shortest: float,
        random: np.random.Generator,
        on_contact: OnContact | None = None,
    ) -> CutOffContact:
        """Return the contacts with another octave, whose slope on the faces is `slope`."""
        waves = [
            line.with_waves(intermittency.octave(line, step.wavelength, shortest, random))
            for line in step.lines
        ]
        octaves = math.log2(step.wavelength / shortest)
        scale = slope / _octave_slope(waves, step.faces, shortest, octaves)
        lines = [
            line.with_waves(line.waves + scale * new.waves)
            for line, new in zip(step.lines, waves, strict=True)
        ]
        return self.step(lines, shortest, slope, on_contact)


@dataclass(frozen=True)
class _Continuation:
    """How to go on below the measurement."""

    intermittency: Intermittency
    slope_ratio: float
    finer: FinerMeasurement | None
    withheld: Withheld | None
    overlap: float

    @classmethod
    def of(
        cls,
        solver: _Solver,
        steps: Sequence[CutOffContact],
        source: Roughness,
        last: float,
        random: np.random.Generator,
    ) -> _Continuation:
        """Return the continuation of measured steps, from long cut-offs to short ones."""
        here = steps[-1]
        intermittency = Intermittency.of(here.lines, steps[-2].faces, here.wavelength, random)
        if isinstance(source, FinerMeasurement):
            overlap = _overlap(source, steps, last)
            return cls(intermittency, math.nan, source, None, overlap)
        if isinstance(source, HurstExponent):
            return cls(intermittency, 2.0 ** (1.0 - source.hurst), None, None, math.nan)
        withheld = _withheld(solver, steps, random)
        ratio = 1.0 if withheld is None else math.sqrt(withheld.slope_ratio)
        return cls(intermittency, ratio, None, withheld, math.nan)

    def next(
        self,
        solver: _Solver,
        steps: Sequence[CutOffContact],
        last: float,
        random: np.random.Generator,
        on_contact: OnContact | None,
    ) -> CutOffContact:
        """Return the step an octave below the last, or at the last cut-off [m]."""
        here = steps[-1]
        shortest = 0.5 * here.wavelength
        if shortest < last * (1.0 + _LEAST_STEP):
            shortest = last
        share = math.log2(here.wavelength / shortest)
        if self.finer is None:
            # a part of an octave has its part of the mean square slope
            slope = here.slope * self.slope_ratio * math.sqrt(share)
        else:
            slope = self._finer_slope(self.finer, here, shortest, steps)
        return solver.continued(here, self.intermittency, slope, shortest, random, on_contact)

    def _finer_slope(
        self,
        finer: FinerMeasurement,
        here: CutOffContact,
        shortest: float,
        steps: Sequence[CutOffContact],
    ) -> float:
        """Return the slope of the finer measurement; between both, it is interpolated."""
        longest, _ = finer.wavelengths
        if here.wavelength <= longest:
            return finer.slope(here.wavelength, shortest)
        measured = next(step for step in reversed(steps) if step.wavelength > longest)
        ends = np.log([longest, measured.wavelength])
        slopes = np.log([finer.slope(longest, 0.5 * longest), measured.slope])
        return float(np.exp(np.interp(math.log(2.0 * shortest), ends, slopes)))


MOST_APART = 3.0


def _overlap(finer: FinerMeasurement, steps: Sequence[CutOffContact], last: float) -> float:
    """Return the slope of the faces over that of the finer measurement [-]; NaN without overlap."""
    longest, shortest = finer.wavelengths
    if last < shortest * (1.0 - 1e-9):
        raise InputError(
            f"down_to must be at least {shortest:.3g} m, the shortest wavelength that the finer "
            f"measurement resolves; got {last:.3g} m"
        )
    both = [step for step in steps if 2.0 * step.wavelength <= longest and step.slope > 0.0]
    if not both:
        return math.nan
    logs = [math.log(s.slope / finer.slope(2.0 * s.wavelength, s.wavelength)) for s in both]
    ratio = math.exp(float(np.mean(logs)))
    if not 1.0 / MOST_APART <= ratio <= MOST_APART:
        raise InputError(
            "the finer measurement must be of a face of the same surface: its slope must be that "
            f"of the faces within a factor of {MOST_APART:g} where both are measured; the faces "
            f"are {ratio:.3g} times as steep from {in_mm(longest, 3)} to "
            f"{in_mm(both[-1].wavelength, 3)}: check units and orientation"
        )
    return ratio


def _withheld(
    solver: _Solver, steps: Sequence[CutOffContact], random: np.random.Generator
) -> Withheld | None:
    """Return how the last measured octave is found from those above; None without friction."""
    above, true = steps[-2], steps[-1]
    mu = true.mean("friction_from_dissipation")
    if not (len(steps) > 3 and mu > 0.0 and above.slope > 0.0):
        return None
    faces = steps[-3].faces
    intermittency = Intermittency.of(above.lines, faces, above.wavelength, random)
    seed = random.integers(2**32)
    logs = np.array([-RATIO_LIMIT, 0.0, RATIO_LIMIT])
    tried = [
        solver.continued(
            above,
            intermittency,
            above.slope * math.exp(log),
            true.wavelength,
            np.random.default_rng(seed),  # the same waves, steeper or less steep
        )
        for log in logs
    ]
    errors = np.log([step.mean("friction_from_dissipation") / mu for step in tried])
    ratio = math.exp(float(np.interp(0.0, errors, logs))) if np.all(np.diff(errors) > 0) else 1.0
    area = tried[1].mean("contact_fraction") / true.mean("contact_fraction")
    return Withheld(area - 1.0, math.expm1(errors[1]), ratio)
