"""Contact and friction against the cut-off, from the longest waves to far below the measurement.

A line is continued octave by octave with random waves (`gripscale.continuation.roughness`), each
with r times the slope of the octave above, on the faces that touch. r is from a withheld octave, a
`FinerMeasurement` or a `HurstExponent`. The equations, and the withheld octaves that a, b, c and
`UNFORETOLD` come from: docs/below-measurement.md.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from gripscale.continuation.roughness import (
    LONGEST_SHARE,
    FinerMeasurement,
    HurstExponent,
    Intermittency,
    OwnFaces,
    PeriodicLine,
    Roughness,
    as_roughness,
    slope_on_faces,
)
from gripscale.core import Array, Described, InputError, Mask, Quantity, checked, checks, provenance
from gripscale.core.parallel import in_threads, worker_count
from gripscale.core.units import in_mm
from gripscale.half_space.grid import nearest
from gripscale.half_space.model import DirectContact
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.model import STATUS, TOTALS, Load, OnProgress, predicted_answer
from gripscale.rubber import Rubber
from gripscale.surface import Profile, Surface

# Usual end of a continuation [m]: about the depth of a measured texture of a stone's face.
DOWN_TO = 10e-6
# a, half width of the 90 % band of the logarithm of a number for each octave [-].
BAND_OF_OCTAVE = 0.11
BAND_OF_GROWTH = 0.40  # b, the same over the logarithm of what continuation adds [-]
UNFORETOLD = 0.55  # largest |ln(r_1 / r_2)| of faces that foretell an octave
QUANTILE_90 = 1.645  # half width of the 90 % interval of a Gaussian over its standard deviation

# c, share of ln r of an octave, beyond that of `USUAL_HURST`, that the next octave has [-].
PERSISTENCE = 0.75
# Hurst exponent of fracture surfaces (E. Bouchaud, J. Phys.: Condens. Matter 9 (1997) 4319,
# doi:10.1088/0953-8984/9/21/002): broken stone, and what is known of an octave if nothing else is.
USUAL_HURST = 0.8

# ln r beside zero that a withheld octave is tried with; r_1 is interpolated between them.
_STEEPER, _LESS_STEEP = (0.6,), (-0.6, -1.2)

MOST_OCTAVES = 8
_LEAST_STEP = 0.05  # rest of an octave, over the last cut-off, that is not a step of its own

# Largest ratio of the slope of the faces to that of a finer measurement, or its inverse.
MOST_APART = 3.0
OnContact = Callable[[RoughContact], None]


@dataclass(frozen=True)
class Withheld:
    """The last measured octave, continued from those above with constant slope."""

    contact_fraction_error: float  # relative error of the contact fraction [-]
    friction_error: float  # relative error of the friction coefficient [-]
    # r_1, the slope over that of the octave above that gives the true friction [-].
    slope_ratio: float
    # r_2, the same of the octave above; NaN where the line is too short to try it.
    slope_ratio_above: float

    @property
    def foretells(self) -> bool:
        """Whether both octaves have slopes alike enough to foretell the next."""
        return not abs(math.log(self.slope_ratio / self.slope_ratio_above)) > UNFORETOLD


@dataclass(frozen=True, eq=False)
class CutOffContact:
    """The contacts of all lines with waves down to one cut-off."""

    wavelength: float  # shortest wavelength of the lines [m]
    contacts: tuple[RoughContact, ...] = field(repr=False)
    lines: tuple[PeriodicLine, ...] = field(repr=False)
    slope: float  # slope of the last octave on the faces that touch [-]; NaN for the first

    def mean(self, name: str) -> float:
        """Return a number of the contacts, averaged by length."""
        values = [getattr(contact, name) for contact in self.contacts]
        lengths = [contact.grid.lengths[0] for contact in self.contacts]
        return float(np.average(values, weights=lengths))

    def octaves(
        self, intermittency: Intermittency, shortest: float, random: np.random.Generator
    ) -> list[PeriodicLine]:
        """Return the next octave of each line, down to a wavelength [m] and of any scale."""
        longest = self.wavelength
        return [intermittency.octave(line, longest, shortest, random) for line in self.lines]

    @property
    def faces(self) -> list[Mask]:
        """Where each line is in contact, on the points of the line."""
        return [
            nearest(contact.active, (line.points,))
            for line, contact in zip(self.lines, self.contacts, strict=True)
        ]


@dataclass(frozen=True, eq=False, repr=False)
class ContactByCutOff(Described):
    """Contact and friction of lines against the cut-off."""

    steps: tuple[CutOffContact, ...]
    """From the longest cut-off to the shortest, an octave apart."""
    resolved: float
    """Shortest wavelength that was measured [m]."""
    slope_ratio: float
    """r of the last continued octave, its slope over that of the octave above [-]; NaN with a finer
    measurement, which has a slope for each."""
    withheld: Withheld | None
    """How well the last measured octave is found from those above; None where it was not tried."""
    overlap: float
    """Slope of the faces over that of the finer measurement where both are measured [-]."""

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield its fields, and why it ends where the measurement does if it was to go on."""
        yield from super().shown_rows()
        if self.refusal:
            yield "refusal", self.refusal

    @property
    def wavelength(self) -> Array:
        """Shortest wavelength of each step [m]."""
        return np.array([step.wavelength for step in self.steps])

    @property
    def octaves_below(self) -> Array:
        """Octaves of each step below the measurement."""
        return np.maximum(np.log2(self.resolved / self.wavelength), 0.0)

    def band(self, name: str) -> Array:
        """Return the half width of the 90 % band of the logarithm of a number at each step [-]."""
        octaves, values = self.octaves_below, self.values(name)
        resolved = values[octaves == 0.0][-1]
        growth = np.log(values / resolved) if resolved > 0.0 else np.zeros(values.size)
        width = np.hypot(BAND_OF_OCTAVE * octaves, BAND_OF_GROWTH * growth)
        return np.where(octaves > 0.0, width, 0.0)

    @property
    def refusal(self) -> str:
        """Why the lines were not continued; empty if they were, or if all was measured."""
        if self.withheld is None or self.withheld.foretells:
            return ""
        return unforetold(self.resolved, self.withheld.slope_ratio, self.withheld.slope_ratio_above)

    def values(self, name: str) -> Array:
        """Return a number of `RoughContact` at each step, averaged by length."""
        return np.array([step.mean(name) for step in self.steps])

    @property
    def converged(self) -> bool:
        """Whether all contacts of the last step converged."""
        return all(contact.converged for contact in self.steps[-1].contacts)

    def to_dataset(self) -> xr.Dataset:
        """Return the curves over `cut_off` with their bands."""

        def over(values: Any, unit: str, text: str) -> xr.Variable:
            return xr.Variable("cut_off", values, {"units": unit, "long_name": text})

        data = {"measured": over(self.octaves_below == 0.0, "1", "whether all waves were measured")}
        for name, text in _CURVES.items():
            data[name] = over(self.values(name), "1", text)
        for name in _BANDS.values():
            for end, sign in (("lower", -1.0), ("upper", 1.0)):
                values = self.values(name) * np.exp(sign * self.band(name))
                if name == "contact_fraction":
                    values = np.minimum(values, 1.0)
                data[f"{name}_{end}"] = over(values, "1", f"{end} end of the 90 % band")
        slopes = [step.slope for step in self.steps]
        data["octave_slope"] = over(slopes, "1", "slope of the last octave on the faces")
        statuses = ["; ".join({str(c.status) for c in step.contacts}) for step in self.steps]
        data["status"] = over(np.array(statuses, dtype=object), "1", "converged, or why not")
        facts = {name: getattr(self, name) for name in ("resolved", "slope_ratio", "overlap")}
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
            "refusal": self.refusal,
            **provenance.version_attributes(),
        }
        coordinate = over(self.wavelength, "m", "shortest wavelength of the surface")
        return xr.Dataset(data, {"cut_off": coordinate}, attributes)


# Numbers of `RoughContact` over the cut-off.
_CURVES = {
    "contact_fraction": "real over nominal contact area",
    "friction": "friction coefficient from the contact traction",
    "friction_from_dissipation": "friction coefficient from the energy lost in the rubber",
    "slope_in_contact": "rms slope of the surface in the contact",
}

# Numbers of an answer, and their curves with a band.
_BANDS = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}

# What a Dataset holds of a continuation, as far as it is known.
FACTS = {
    "resolved": "shortest wavelength that was measured",
    "slope_ratio": "slope of the last continued octave over that of the octave above",
    "overlap": "slope of the faces over that of the finer measurement",
    "withheld_contact_fraction_error": "relative error of the withheld octave, contact fraction",
    "withheld_friction_error": "relative error of the withheld octave, friction",
    "withheld_slope_ratio": "slope ratio that gives the friction of the withheld octave",
    "withheld_slope_ratio_above": "slope ratio that gives the friction of the octave above it",
}


def unforetold(resolved: float, last: float, above: float) -> str:
    """Return why roughness is not continued below a wavelength [m], with r_1 and r_2."""
    return (
        f"The roughness is not continued below {in_mm(resolved, 3)}, where the measurement ends: "
        f"the slopes of its last two octaves are {last:.2f} and {above:.2f} times those of the "
        f"octave above. Ratios more than {math.exp(UNFORETOLD):.2g} times apart foretell nothing: "
        "state a Hurst exponent, or measure a face of a stone finer."
    )


def cut_off_at(slope: float, wavelength: Array, slopes: Array) -> float:
    """Return the cut-off [m], from falling ones, at which `slopes` reach a value; NaN if none."""
    above = np.flatnonzero(slopes >= slope)
    if not above.size or above[0] == 0:
        return math.nan
    at = slice(above[0] - 1, above[0] + 1)
    return float(np.exp(np.interp(slope, slopes[at], np.log(wavelength[at]))))


def contact_by_cut_off(
    rubber: Rubber,
    lines: Profile | Sequence[Profile],
    *,
    pressure: Quantity,
    speed: Quantity,
    down_to: Quantity,
    longest: Quantity = 30e-3,
    roughness: Roughness | None = None,
    seed: int = 0,
    on_contact: OnContact | None = None,
    **options: Any,
) -> ContactByCutOff:
    """Return contact and friction of measured lines, solved with one cut-off after the other.

    Cut-offs are an octave apart. Above the shortest wavelength that the lines resolve, the waves
    are measured; below, they are continued and the numbers have a `band`. A curve with a `refusal`
    ends with the measurement; it shows why, and its Dataset has the attribute.
    Raises `InputError` if an argument is out of its range, a finer measurement does not reach
    `down_to` or is rougher or smoother than the faces by more than a factor of three where both are
    measured; and as `solve_rough_contact` does.

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
    load = {"pressure": pressure, "speed": speed, "tolerance": None, **options}
    solver = _Solver(rubber, load, on_contact)
    periodic = [PeriodicLine.of(line, resolved, last) for line in profiles]
    shortest_line = min(line.length for line in periodic)
    most = min(checks.positive("longest", longest, unit="m"), LONGEST_SHARE * shortest_line)
    measured_to = max(resolved, last)
    octaves = max(0, math.floor(math.log2(most / measured_to) + 1e-9))
    steps: list[CutOffContact] = []
    for cut_off in measured_to * 2.0 ** np.arange(octaves, -1, -1):
        slope = math.nan
        if steps:
            slope = slope_on_faces(periodic, steps[-1].faces, 2.0 * cut_off, cut_off)
        steps.append(solver.step(periodic, float(cut_off), slope, steps[-1] if steps else None))
    if last >= resolved:
        return ContactByCutOff(tuple(steps), resolved, math.nan, None, math.nan)
    if len(steps) < 3:
        raise InputError(
            f"lines must hold three octaves above {in_mm(resolved, 3)}, the shortest wavelength "
            f"they resolve, to be continued; got lines of {in_mm(periodic[0].length, 3)}"
        )
    return _continued(solver, steps, source, last, random)


@dataclass(frozen=True)
class _Solver:
    rubber: Rubber
    options: dict[str, Any]
    on_contact: OnContact | None

    def step(
        self,
        lines: Sequence[PeriodicLine],
        cut_off: float,
        slope: float,
        above: CutOffContact | None,
    ) -> CutOffContact:
        """Return the contacts of lines with waves down to a cut-off [m], from those `above`."""

        def job(at: int, _: threading.Event) -> RoughContact:
            start = None if above is None else above.contacts[at]
            contact = solve_rough_contact(
                self.rubber,
                lines[at].profile(),
                smallest_wavelength=cut_off,
                periodic=True,
                start=start,
                **self.options,
            )
            if start is None or contact.grids[0].cut_off > cut_off:  # solved from nothing
                return contact
            return replace(contact, grids=[start.grids[-1], *contact.grids])

        contacts: dict[int, RoughContact] = {}
        jobs = [partial(job, at) for at in range(len(lines))]
        with closing(in_threads(jobs, worker_count(None))) as solved:
            for at, contact in solved:
                contacts[at] = contact
                if self.on_contact is not None:
                    self.on_contact(contact)
        in_order = tuple(contacts[at] for at in range(len(lines)))
        return CutOffContact(cut_off, in_order, tuple(lines), slope)

    def next_step(
        self, step: CutOffContact, octaves: Sequence[PeriodicLine], slope: float, shortest: float
    ) -> CutOffContact:
        """Return the contacts with another octave, whose slope on the faces is `slope`."""
        # the line itself holds a part of it: flanks of edges, and waves near its end
        part = slope_on_faces(step.lines, step.faces, step.wavelength, shortest)
        rest = math.sqrt(max(slope**2 - part**2, 0.0))
        scale = rest / slope_on_faces(octaves, step.faces, math.inf, 0.0)
        lines = [
            replace(line, waves=line.waves + scale * octave.waves)
            for line, octave in zip(step.lines, octaves, strict=True)
        ]
        return self.step(lines, shortest, slope, step)


def _continued(
    solver: _Solver,
    steps: list[CutOffContact],
    source: Roughness,
    last: float,
    random: np.random.Generator,
) -> ContactByCutOff:
    """Return the curve of measured steps, continued octave by octave to the last cut-off [m]."""
    here = steps[-1]
    resolved = here.wavelength
    intermittency = Intermittency.of(here.lines, steps[-2].faces, resolved, random)
    ratio = usual = 2.0 ** (1.0 - USUAL_HURST)
    withheld, overlap = None, math.nan
    if isinstance(source, FinerMeasurement):
        overlap, ratio = _overlap(source, steps, last), math.nan
    elif isinstance(source, HurstExponent):
        ratio = usual = 2.0 ** (1.0 - source.hurst)
    else:
        quiet = replace(solver, on_contact=None)
        withheld, above = (_octave_again(quiet, part, random) for part in (steps, steps[:-1]))
        if withheld is not None and above is not None:
            withheld = replace(withheld, slope_ratio_above=above.slope_ratio)
    if withheld is not None:
        if not withheld.foretells:
            return ContactByCutOff(tuple(steps), resolved, math.nan, withheld, overlap)
        ratio = withheld.slope_ratio
    here = replace(here, lines=tuple(line.resolved_to(resolved) for line in here.lines))
    while here.wavelength > last:
        shortest = 0.5 * here.wavelength
        if shortest < last * (1.0 + _LEAST_STEP):
            shortest = last
        if isinstance(source, FinerMeasurement):
            slope = _finer_slope(source, steps, shortest)
        else:
            ratio = usual * (ratio / usual) ** PERSISTENCE
            # a part of an octave has its part of the mean square slope
            slope = here.slope * ratio * math.sqrt(math.log2(here.wavelength / shortest))
        octaves = here.octaves(intermittency, shortest, random)
        here = solver.next_step(here, octaves, slope, shortest)
        steps.append(here)
    return ContactByCutOff(tuple(steps), resolved, ratio, withheld, overlap)


def _finer_slope(finer: FinerMeasurement, steps: Sequence[CutOffContact], shortest: float) -> float:
    """Return the slope of the finer measurement; between both measurements, it is interpolated."""
    longest, _ = finer.wavelengths
    if steps[-1].wavelength <= longest:
        return finer.slope(steps[-1].wavelength, shortest)
    measured = next(step for step in reversed(steps) if step.wavelength > longest)
    ends = np.log([longest, measured.wavelength])
    slopes = np.log([finer.slope(longest, 0.5 * longest), measured.slope])
    return float(np.exp(np.interp(math.log(2.0 * shortest), ends, slopes)))


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


def _octave_again(
    solver: _Solver, steps: Sequence[CutOffContact], random: np.random.Generator
) -> Withheld | None:
    """Return how the last octave of measured steps is found; None with few, or no friction."""
    above, true = steps[-2], steps[-1]
    mu = true.mean("friction_from_dissipation")
    if not (len(steps) > 3 and mu > 0.0 and above.slope > 0.0):
        return None
    intermittency = Intermittency.of(above.lines, steps[-3].faces, above.wavelength, random)
    start = replace(above, lines=tuple(line.resolved_to(above.wavelength) for line in above.lines))
    waves = np.random.default_rng(random.integers(2**32))
    octaves = start.octaves(intermittency, true.wavelength, waves)

    def tried(log: float) -> tuple[float, float]:
        """Return area and friction over the true ones, with the same waves exp(log) as steep."""
        slope = above.slope * math.exp(log)
        step = solver.next_step(start, octaves, slope, true.wavelength)
        area = step.mean("contact_fraction") / true.mean("contact_fraction")
        return area, math.log(step.mean("friction_from_dissipation") / mu)

    area, friction = tried(0.0)
    by_log = {0.0: friction}
    # friction rises with the slope: ratios on one side, until the true friction lies between two
    for log in _STEEPER if friction < 0.0 else _LESS_STEEP:
        _, by_log[log] = tried(log)
        if by_log[log] * friction <= 0.0:
            break
    logs = sorted(by_log)
    frictions = np.maximum.accumulate([by_log[log] for log in logs])
    ratio = math.exp(float(np.interp(0.0, frictions, logs)))
    return Withheld(area - 1.0, math.expm1(friction), ratio, math.nan)


class ContinuedContact(DirectContact):
    """Direct contact of profiles, continued below their sampling and labelled as such.

    The answer holds the curves of `contact_by_cut_off` over `cut_off`, and as its estimated errors
    the standard error of a continuation. `down_to`, `roughness` and `seed` are arguments of this
    function; `periodic` and `tolerance` have no effect.
    """

    name: ClassVar[str] = "continued"

    tolerance: float | None = None
    down_to: float = checked(checks.positive, unit="m", default=DOWN_TO)
    roughness: Roughness = checked(as_roughness, default=OwnFaces())
    seed: int = checked(checks.whole, least=0, most=2**32 - 1, default=0)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer with the curves over `cut_off`; `on_progress` gets each contact.

        Raises `InputError` as `contact_by_cut_off` does, and unless the surface is measured
        profiles.
        """
        measured = surface.measured
        if measured is None or measured.map is not None:
            surface_kind = "waves stated by hand" if measured is None else "a map"
            raise InputError(
                "roughness below the measurement is continued from measured profiles; "
                f"got {surface_kind}"
            )
        curve = contact_by_cut_off(
            rubber,
            measured.cleaned,
            pressure=load.pressure,
            speed=load.speed,
            down_to=self.down_to,
            roughness=self.roughness,
            seed=self.seed,
            on_contact=on_progress,
            conditions=self.conditions,
            footprint=load.footprint,
            thickness=load.thickness,
        )
        answer = self._answer(curve.steps[-1].contacts, surface, load)
        if answer[STATUS].item() != "converged":
            return answer
        for name, curve_name in _BANDS.items():
            error = float(curve.band(curve_name)[-1]) / QUANTILE_90
            about = answer[f"{name}_error"].attrs
            answer[f"{name}_error"] = (error * answer[name]).assign_attrs(about)
        if curve.refusal:
            nothing = dict.fromkeys(TOTALS, math.nan)
            answer = predicted_answer(answer, nothing, curve.refusal, self.name, load)
        # `friction` without a dimension is that of the last cut-off
        data = curve.to_dataset().drop_vars("status")
        return answer.merge(
            data.rename({name: f"curve_{name}" for name in data if data[name].dims})
        )
