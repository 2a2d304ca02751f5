"""Contact and friction of a map against the cut-off, continued by diffusion below the measurement.

A grid of a map cannot follow roughness over many octaves as that of a line can. So the contact is
solved with all measured waves, and its pressures start Persson's diffusion
(`gripscale.theory.diffusion`) through the waves below. These are a power law that continues the
last two measured octaves. An octave counts as it acts: its slope is that of a Gaussian surface with
the same friction, found by diffusion from the contact without the octave. Steep edges that do not
touch make no friction, and rough places that do touch make more than their share. With h_n the
slope of the last octave, h_n/h_(n-1) = 2^(1 - H).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import scipy

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.core.units import in_mm
from gripscale.half_space.below_measurement import (
    LEAST_STEP,
    LONGEST,
    ContactByCutOff,
    CutOffContact,
    HurstExponent,
    OnContact,
    OwnFaces,
    Roughness,
    typical,
)
from gripscale.half_space.grid import nearest, periodic_heights
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap
from gripscale.surface.cut_off import PowerLaw
from gripscale.surface.profile import RESOLVED_STEPS
from gripscale.theory.diffusion import ContactPressures, DiffusionResult, diffusion

FEWEST_OCTAVES = 2
"""Octaves above the measurement whose slopes say how it goes on."""

GROWTH_OF_MAPS = 1.27
"""Power of the octaves that the band grows with: 20, 48 and 81 % after one, two and three octaves
of maps that hold as many measured ones, see docs/theories.md."""

HURST_LIMITS = 0.5, 1.5
"""Exponents beyond these are those of noise, or the end of an instrument's band."""

SLOPES, SLOPE_ERROR = (1e-3, 10.0), 1e-3
"""Range of the slope of an octave, and the relative error to which it is found."""

USUAL_HURST = 0.8
"""Exponent within an octave whose slope is sought."""


@dataclass(frozen=True, eq=False)
class DiffusedContact(CutOffContact):
    """Numbers of a diffusion down to one cut-off; `contacts` holds what it started from."""

    numbers: dict[str, float] = field(default_factory=dict)
    """Numbers of `RoughContact` by name."""

    def mean(self, name: str) -> float:
        """Return a number of the diffusion."""
        return self.numbers[name]


def map_by_cut_off(
    rubber: Rubber,
    surface: HeightMap,
    *,
    pressure: float,
    speed: float,
    down_to: float,
    longest: float = 8e-3,
    roughness: Roughness | None = None,
    periodic: bool = False,
    on_contact: OnContact | None = None,
    **options: Any,
) -> ContactByCutOff:
    """Return contact and friction of a map against the cut-off, down to any wavelength.

    The cut-offs are octaves above and below the shortest wavelength that the map resolves. Above,
    contacts are solved; below, their pressures diffuse and the numbers have a `band`.

    Parameters
    ----------
    rubber : Rubber
        The half-space.
    surface : HeightMap
        The map, sliding along its x.
    pressure : float
        Nominal pressure [Pa].
    speed : float
        Sliding speed [m/s].
    down_to : float
        Last cut-off [m].
    longest : float
        About the first cut-off [m]; a quarter of the shorter side at most.
    roughness : OwnFaces or HurstExponent, optional
        The exponent of the power law: that of the faces by default. Both have their slope.
    periodic : bool
        Take the map as one period as it stands.
    on_contact : callable, optional
        Called with each contact as it is solved.
    options
        Further arguments of `solve_rough_contact`. With its `tolerance`, None by default, the area
        of the continuation is more accurate: from four points in the smallest wave of the start it
        is about 10 % low after an octave, from a start solved to 2 % about 4 %.

    Raises
    ------
    InputError
        If an argument is out of its range, the roughness is a finer measurement, the map is too
        short, or conditions change the rubber within the contact; and as `solve_rough_contact`
        does.
    """
    checks.instance("surface", surface, HeightMap)
    source = OwnFaces() if roughness is None else roughness
    if not isinstance(source, OwnFaces | HurstExponent):
        raise InputError(
            "roughness of a map must be OwnFaces or HurstExponent, because its octaves below the "
            f"measurement are a power law; got {checks.short_repr(source)}"
        )
    resolved = max(RESOLVED_STEPS * max(surface.step), surface.reliable or 0.0)
    last = checks.positive("down_to", down_to, unit="m")
    below = resolved / last > 1.0 + LEAST_STEP
    shortest = resolved if below else max(last, resolved)
    side = min(surface.length)
    most = min(checks.positive("longest", longest, unit="m"), LONGEST * side)
    octaves = max(FEWEST_OCTAVES, math.floor(math.log2(most / shortest) + 1e-9))
    if 2.0**octaves * shortest > side:
        raise InputError(
            f"surface must hold {FEWEST_OCTAVES} octaves above {in_mm(shortest, 3)}, its shortest "
            f"wavelength; got a map of {in_mm(side, 3)}"
        )
    options = {"pressure": pressure, "speed": speed, "tolerance": None, **options}
    steps: list[CutOffContact] = []
    for cut_off in shortest * 2.0 ** np.arange(octaves, -1, -1):
        contact = solve_rough_contact(
            rubber, surface, smallest_wavelength=float(cut_off), periodic=periodic, **options
        )
        slope = (
            _octave_slope(surface, contact, steps[-1].contacts[0], periodic) if steps else math.nan
        )
        steps.append(CutOffContact(float(cut_off), (contact,), (), slope))
        if on_contact is not None:
            on_contact(contact)
    if not below:
        return ContactByCutOff(tuple(steps), resolved, math.nan, None, math.nan)
    law = _power_law(steps, source)
    result = _diffused(steps[-1].contacts[0], law, last)
    steps += _diffusion_steps(result, steps[-1], law)
    ratio = 2.0 ** (1.0 - law.hurst)
    return ContactByCutOff(tuple(steps), resolved, ratio, None, math.nan, GROWTH_OF_MAPS)


def _octave_slope(
    surface: HeightMap, contact: RoughContact, before: RoughContact, periodic: bool
) -> float:
    """Return the slope [-] of the last octave on the points in contact without it."""
    shortest, shape = contact.smallest_wavelength, contact.grid.shape
    heights = periodic_heights(surface, smallest_wavelength=shortest, periodic=periodic)
    octave = heights.on(shape) - heights.on(shape, before.smallest_wavelength)
    return typical(contact.grid.slope(octave)[nearest(before.active, shape)])


def _power_law(steps: Sequence[CutOffContact], source: OwnFaces | HurstExponent) -> PowerLaw:
    """Return the mean square gradient below the last step, from the last two octaves."""
    before, last = (_equivalent_slope(*pair) for pair in pairwise(steps[-3:]))
    if math.isnan(before + last):
        before, last = (step.slope for step in steps[-2:])
    if not (before > 0.0 and last > 0.0):
        raise InputError(
            "surface must be rough on the faces that touch, in the two octaves above its shortest "
            f"wavelength; got slopes of {before:.3g} and {last:.3g}"
        )
    if isinstance(source, HurstExponent):
        hurst = source.hurst
    else:
        hurst = float(np.clip(1.0 - math.log2(last / before), *HURST_LIMITS))
    return _law_of_octave(hurst, 0.5, last)


def _law_of_octave(hurst: float, ratio: float, slope: float) -> PowerLaw:
    """Return the power law with a slope [-] between a wavelength and the `ratio`-th part of it.

    The mean square gradient of an isotropic surface is twice the mean square slope along x.
    """
    return PowerLaw(hurst, 2.0 * slope**2 / abs(PowerLaw(hurst, 1.0).added(ratio)))


def _equivalent_slope(before: CutOffContact, last: CutOffContact) -> float:
    """Return the slope [-] of a Gaussian octave with the effect of a measured one.

    The effect is on the friction, at rest on the contact fraction; NaN if no slope has it.
    """
    moving = last.contacts[0].speed > 0.0
    true = last.mean("friction_from_dissipation" if moving else "contact_fraction")

    def excess(log_slope: float) -> float:
        law = _law_of_octave(USUAL_HURST, 2.0, math.exp(log_slope))
        result = _diffused(before.contacts[0], law, last.wavelength)
        return (result.friction if moving else result.contact_fraction) - true

    least, most = (math.log(slope) for slope in SLOPES)
    if not (last.slope > 0.0 and excess(least) * excess(most) < 0.0):
        return math.nan
    return math.exp(scipy.optimize.brentq(excess, least, most, xtol=SLOPE_ERROR))


def _diffused(contact: RoughContact, law: PowerLaw, down_to: float) -> DiffusionResult:
    """Return the diffusion from the pressures of a contact down to a wavelength [m]."""
    if contact.by_scale is not None:
        raise InputError(
            "conditions of a map below its measurement must not change the rubber within the "
            "contact; got heat or softening: leave them out, or take lines of the map"
        )
    start = ContactPressures(
        contact.pressure[contact.active],
        min(contact.contact_fraction, 1.0),
        contact.friction_from_dissipation,
        contact.smallest_wavelength,
    )
    return diffusion(
        contact.rubber,
        start,
        law,
        pressure=contact.nominal_pressure,
        speed=contact.speed,
        smallest_wavelength=down_to,
    )


def _diffusion_steps(
    result: DiffusionResult, start: CutOffContact, law: PowerLaw
) -> list[CutOffContact]:
    """Return the steps of a diffusion below its start; NaN if its integrals did not converge."""
    steps: list[CutOffContact] = []
    usable = 1.0 if result.converged else math.nan
    ratios = result.wavelength[0] / result.wavelength
    # half of the mean square gradient of an isotropic surface is the mean square slope along x
    squares = np.array([0.5 * law.added(ratio) for ratio in ratios])
    in_contact = start.mean("slope_in_contact")
    for at in range(1, ratios.size):
        friction = usable * float(result.running_friction[at])
        numbers = {
            "contact_fraction": usable * float(result.running_contact_fraction[at]),
            "friction": friction,
            "friction_from_dissipation": friction,
            "slope_in_contact": math.hypot(in_contact, math.sqrt(squares[at])),
        }
        slope = math.sqrt(squares[at] - squares[at - 1])
        length = float(result.wavelength[at])
        steps.append(DiffusedContact(length, start.contacts, (), slope, numbers))
    return steps
