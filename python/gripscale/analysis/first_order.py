"""What is not known of the inputs, carried to the friction by derivatives: no sample is solved.

A source of `gripscale.analysis.sources` draws other inputs; the tangent of the direct contact says
what they change. With the adjoint of `gripscale.half_space.sensitivity`

    ln mu' - ln mu = (sum_q Re c(q) ln(M'/M) + sum_x dmu/dh (h' - h)) / mu + e ln(l'/l),

M' being the moduli of another rubber, h' other heights, and e the exponent of the cut-off l over
its last octave. The standard deviation over draws is the error of the source.

Two sources are no small change. Another stretch of road has the error of the pieces of the profiles
(`gripscale.half_space.sampling_error`). Where spikes are removed or kept, heights change by
millimetres: on the shipped road the tangent gives 4.7 % of friction and contacts solved anew 3.0 %.
A few draws of the cleaning are therefore solved.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from gripscale.analysis.ladder import DIRECT
from gripscale.analysis.sampled_answer import GRID, ROAD
from gripscale.analysis.sampled_inputs import Inputs, Measurement
from gripscale.analysis.sampling import Uncertainty, draws
from gripscale.analysis.sources import LABELS, Source
from gripscale.case.results import CaseResults
from gripscale.conditions.conditions import Conditions
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError, RubberWarning
from gripscale.half_space.grid import periodic_heights
from gripscale.half_space.model import DirectContact
from gripscale.half_space.response import HalfSpace
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sensitivity import FrictionAdjoint
from gripscale.model import SAMPLING_ERRORS
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile

DRAWS = 64
"""Draws of each source: the standard deviation is known to a tenth. A draw costs no contact."""
SOLVED, SOLVED_DRAWS = "cleaning", 8
"""The source whose draws are solved, and how many."""
FRICTION_SAMPLING_ERROR = list(SAMPLING_ERRORS)[1]


@dataclass(frozen=True)
class Tangent:
    """The direct contacts of a case, the derivatives of their friction, and the shares in it."""

    results: CaseResults
    case: Inputs
    """Its inputs, which others are compared with."""
    contacts: Sequence[RoughContact]
    adjoints: Sequence[FrictionAdjoint]
    share: Array
    """Of the friction of all [-], shape (contacts,)."""
    friction: float
    """Of all, from dissipation [-]."""
    sampling_error: float
    """Relative standard error of the friction from pieces of the profiles [-]."""

    @classmethod
    def of(cls, results: CaseResults) -> Tangent:
        """Solve the direct contact of a case on the grid with four points in the smallest wave.

        Raises `InputError` if the case is at rest, or a contact has no result.
        """
        contacts: list[RoughContact] = []
        answer = _model(results).predict(
            results.rubber.rubber, results.surface, results.load, on_progress=contacts.append
        )
        friction = np.array([each.friction_from_dissipation for each in contacts])
        if not all(each.has_friction for each in contacts):
            status = ", ".join(str(each.status) for each in contacts)
            raise InputError(
                "the direct contact must have a result with friction for its derivatives; got "
                f"status {status}, friction {', '.join(f'{each:.3g}' for each in friction)}"
            )
        weight = friction * [each.grid.lengths[0] for each in contacts]
        error = float(answer.get(FRICTION_SAMPLING_ERROR, math.nan))
        adjoints = [FrictionAdjoint.of(each) for each in contacts]
        mean = float(answer["total_friction_from_dissipation"])
        case = Inputs.of(Measurement.of(results))
        return cls(results, case, contacts, adjoints, weight / weight.sum(), mean, error)

    def solved_change(self, inputs: Inputs) -> float:
        """Return the change of ln mu by a contact with the other inputs [-]."""
        surface, model = inputs.for_model(_model(self.results))
        answer = model.predict(inputs.rubber, surface, self.results.load)
        return math.log(float(answer["total_friction_from_dissipation"]) / self.friction)

    def change(self, inputs: Inputs) -> float:
        """Return what other inputs than those of the case change in ln mu, to first order [-]."""
        case = self.case
        parts = np.zeros(len(self.contacts))
        for at, (contact, adjoint) in enumerate(zip(self.contacts, self.adjoints, strict=True)):
            if inputs.rubber is not case.rubber:
                parts[at] += _by_rubber(adjoint, inputs.rubber)
            if inputs.cleaned is not case.cleaned or inputs.smooth_gaps != case.smooth_gaps:
                assert inputs.measured is not None
                parts[at] += _by_surface(adjoint, inputs.measured.surfaces[at])
            if inputs.end != case.end:
                exponent = contact.cut_off_exponents.friction
                parts[at] += exponent * math.log(inputs.end / case.end)
        return float(self.share @ parts)


def _model(results: CaseResults) -> DirectContact:
    """Return the direct contact on the grid with four points in the smallest wave."""
    return DirectContact(tolerance=None, conditions=results.conditions)


def _by_rubber(adjoint: FrictionAdjoint, rubber: Rubber) -> float:
    """Return the change of ln mu by another rubber, at the temperature it has in the case."""
    contact, body = adjoint.contact, adjoint.body
    solid = (contact.conditions or Conditions()).before(rubber)
    scales = None if body.by_scale is None else replace(body.by_scale, rubber=solid)
    other = HalfSpace(solid, body.speed, by_scale=scales)
    change = np.log(other.modulus(contact.grid) / body.modulus(contact.grid))
    effect = adjoint.by_modulus(np.broadcast_to(change, contact.grid.spectrum_shape))
    return float(effect.sum() / contact.friction_from_dissipation)


def _by_surface(adjoint: FrictionAdjoint, surface: Profile | HeightMap) -> float:
    """Return the change of ln mu by other heights of the same stretch."""
    contact = adjoint.contact
    heights = periodic_heights(
        surface, smallest_wavelength=contact.smallest_wavelength, periodic=False
    )
    change = heights.on(contact.grid.shape) - contact.height
    return float((adjoint.by_height * change).sum() / contact.friction_from_dissipation)


def first_order(
    results: CaseResults,
    uncertainty: Uncertainty | None = None,
    *,
    count: int = DRAWS,
    seed: int = 0,
) -> xr.Dataset:
    """Return the error of the friction of a case by each source, from one solution.

    Parameters
    ----------
    results : CaseResults
        A prepared case with a measured surface, in motion.
    uncertainty : Uncertainty, optional
        What is uncertain; by default as the table [uncertainty] of the case says.
    count : int
        Draws of each source.
    seed : int
        Seed of the random numbers.

    Returns
    -------
    xarray.Dataset
        Over `source`: `friction_error`, the relative standard error by first order [-]; NaN for
        the stretch of road where pieces of the profiles are too few. The grid has none.

    Raises
    ------
    InputError
        As `Tangent.of`.
    """
    measurement = Measurement.of(results)
    asked = uncertainty or Uncertainty.of_case(results.file.case.uncertainty)
    tangent = Tangent.of(results)
    drawn = replace(asked, without=(*asked.without, ROAD, GRID))
    sources = drawn.of(measurement, (DIRECT,), any_number=True).sources
    errors = {each.name: _scatter(tangent, each, count, seed) for each in sources}
    if ROAD not in asked.without:
        errors[ROAD] = tangent.sampling_error
    attrs = {"units": "1", "long_name": "relative standard error of friction, by first order"}
    labels = np.array([LABELS[name] for name in errors], dtype=object)
    return xr.Dataset(
        {"friction_error": ("source", [*errors.values()], attrs)},
        {"source": np.array([*errors], dtype=object), "label": ("source", labels)},
    )


def _scatter(tangent: Tangent, source: Source, count: int, seed: int) -> float:
    """Return the standard deviation of ln mu over draws of a source [-], to first order."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        solved = source.name == SOLVED
        drawn = [
            each.inputs
            for each in draws(tangent.case, [source], SOLVED_DRAWS if solved else count, seed)
        ]
        change = tangent.solved_change if solved else tangent.change
        changes = [change(each) for each in drawn if each is not None]
    return float(np.std(changes))
