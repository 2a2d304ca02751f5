"""What is not known of the inputs, carried to friction and contact area by derivatives.

A source of `sources` draws other inputs; the tangent of the direct contact says
what they change. With the adjoint of `gripscale.half_space.sensitivity`

    ln mu' - ln mu = (sum_q Re c(q) ln(M'/M) + sum_x dmu/dh (h' - h)) / mu + e ln(l'/l)
                     + a ln(p_0'/p_0) + b (T' - T),

M' being the moduli of another rubber, h' other heights, e the exponent of the cut-off l over its
last octave, and a and b the derivatives by nominal pressure and temperature. The standard deviation
over draws is the error of the source. The contact area has no adjoint: its derivatives by pressure,
temperature and moduli are differences of contacts that start from the solved one. The moduli of
drawn rubbers change along few directions, and each direction has one derivative (`_directions`).

Three sources are no small change. Another stretch of road has the error of the pieces of the
profiles (`gripscale.half_space.sampling_error`). Where spikes are removed or kept, heights change
by millimetres: on the shipped road the tangent gives 4.7 % of friction and contacts solved anew
3.4 %. Noise of the heights averages out in the tangent: what it does is of second order, one way in
each draw. A few draws of both are therefore solved, and the error is their rms change.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.conditions import Conditions
from gripscale.core import Array, ComplexArray, InputError, RubberWarning, worker_count
from gripscale.core.parallel import Job, all_results
from gripscale.half_space import sensitivity
from gripscale.half_space.grid import periodic_heights
from gripscale.half_space.model import DirectContact
from gripscale.half_space.response import HalfSpace
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sensitivity import FrictionAdjoint
from gripscale.model import SAMPLING_ERRORS
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.uncertainty.sampled_answer import GRID, ROAD
from gripscale.questions.uncertainty.sampled_inputs import Inputs
from gripscale.questions.uncertainty.sampling import Uncertainty, draws, stated_options
from gripscale.questions.uncertainty.sources import SOURCES, Source
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile, Surface

# Draws of each source: the standard deviation is known to a tenth. A draw costs no contact.
DRAWS = 64
# The sources whose draws are solved, and how many. Levels of the cleaning are spread evenly.
SOLVED = {"height_noise": 16, "cleaning": 8}
# Draws of another rubber for the contact area. On the shipped road 8 draws of the moduli give 1.0
# %, 48 draws 1.1 %.
FEW_DRAWS = 8
# Sources of another rubber.
OF_RUBBER = ("modulus", "bulk_modulus", "equilibrium_modulus")
# Part of the mean square change of the moduli that the directions of the contact area leave out.
SMALLEST_PART = 1e-4
CARRIED_QUANTITIES = ("friction", "contact_fraction")


@dataclass(frozen=True)
class ContactTangent:
    """One direct contact of a case, and the derivatives of its friction."""

    usual: Inputs
    number: int  # of the profile
    contact: RoughContact
    adjoint: FrictionAdjoint

    def friction_change(self, inputs: Inputs) -> float:
        """Return what other inputs than the usual change in ln mu, to first order [-]."""
        contact, usual, change = self.contact, self.usual, 0.0
        if inputs.rubber is not usual.rubber:
            change += float(self.adjoint.by_modulus(self._log_ratio(inputs.rubber)).sum())
        if inputs.cleaned is not usual.cleaned or inputs.smooth_gaps != usual.smooth_gaps:
            assert inputs.measured is not None
            heights = periodic_heights(
                inputs.measured.surfaces[self.number],
                smallest_wavelength=contact.smallest_wavelength,
                periodic=False,
            )
            differences = heights.on(contact.grid.shape) - contact.height
            change += float((self.adjoint.by_height * differences).sum())
        change /= contact.friction_from_dissipation
        if inputs.end != usual.end:
            change += contact.cut_off_exponents.friction * math.log(inputs.end / usual.end)
        return change + self._by_conditions(inputs, 0)

    def area_changes(self, drawn: Sequence[Inputs]) -> Array:
        """Return what other rubbers or cut-offs change in ln A_r/A_0, to first order [-]."""
        ends = np.log([inputs.end / self.usual.end for inputs in drawn])
        parts = self.contact.cut_off_exponents.contact_fraction * ends
        if any(inputs.rubber is not self.usual.rubber for inputs in drawn):
            changes = np.array([self._log_ratio(inputs.rubber) for inputs in drawn])
            along, directions = _directions(changes, np.abs(self.adjoint.weight))
            parts += along @ [self._differences.by_modulus(each) for each in directions]
        return np.asarray(parts + [self._by_conditions(inputs, 1) for inputs in drawn])

    def _log_ratio(self, rubber: Rubber) -> ComplexArray:
        """Return ln(M'/M) [-] of each wave of another rubber, at the temperature of the case."""
        contact, body = self.contact, self.contact.body
        solid = (contact.conditions or Conditions()).before(rubber)
        scales = None if body.by_scale is None else replace(body.by_scale, rubber=solid)
        other = HalfSpace(solid, body.speed, by_scale=scales, thickness=body.thickness)
        change = np.log(other.modulus(contact.grid) / body.modulus(contact.grid))
        return np.broadcast_to(change, contact.grid.spectrum_shape)

    def _by_conditions(self, inputs: Inputs, quantity: int) -> float:
        """Return what pressure and temperature change in ln mu or ln A_r/A_0."""
        change = [inputs.log_pressure, inputs.warming]
        return float(self._by_pressure_and_kelvin[quantity] @ change) if any(change) else 0.0

    @cached_property
    def _differences(self) -> sensitivity.ContactFractionDifferences:
        return sensitivity.ContactFractionDifferences(self.contact)

    @cached_property
    def _by_pressure_and_kelvin(self) -> Array:
        """Derivatives of ln mu and ln A_r/A_0 by ln p_0 and T [1/K], shape (2, 2)."""
        differences = self._differences
        change = sensitivity.scalar_changes(self.contact).get("temperature", np.zeros(1, complex))
        by_kelvin = float(self.adjoint.by_modulus(change).sum())
        friction = np.array([self.adjoint.by_log_pressure, by_kelvin])
        area = [differences.by_log_pressure(), differences.by_modulus(change)]
        return np.array([friction / self.contact.friction_from_dissipation, area])


@dataclass(frozen=True)
class Tangent:
    """The direct contacts of a case with their derivatives, and the shares of each in all."""

    case: Case
    usual: Inputs
    parts: Sequence[ContactTangent]
    share: Array  # of each contact in friction and contact area of all [-], shape (2, contacts)
    sampling_errors: Array  # relative standard errors of both from pieces of the profiles [-]

    @classmethod
    def of(cls, case: Case) -> Tangent:
        """Solve the direct contact of a case; raise `InputError` at rest or without a result."""
        contacts: list[RoughContact] = []
        answer = _model(case).predict(
            case.rubber, case.surface, case.load, on_progress=contacts.append
        )
        if not all(each.has_friction for each in contacts):
            status = ", ".join(str(each.status) for each in contacts)
            frictions = ", ".join(f"{each.friction_from_dissipation:.3g}" for each in contacts)
            raise InputError(
                "the direct contact must have a result with friction for its derivatives; got "
                f"status {status}, friction {frictions}"
            )
        usual, amounts = Inputs.of(case), _amounts(contacts)
        errors = [float(answer.get(name, math.nan)) for name in reversed(SAMPLING_ERRORS)]
        parts = [
            ContactTangent(usual, number, contact, FrictionAdjoint.of(contact))
            for number, contact in enumerate(contacts)
        ]
        return cls(case, usual, parts, amounts / amounts.sum(1, keepdims=True), np.array(errors))

    def solved_change(self, inputs: Inputs) -> Array:
        """Return the changes of ln mu and ln A_r/A_0 by a contact with the other inputs [-]."""
        surface, model = inputs.for_model(_model(self.case))
        assert isinstance(model, DirectContact)
        surfaces = zip(_surfaces(surface), _surfaces(self.case.surface), strict=True)
        load, usual, contacts = inputs.under(self.case.load), [p.contact for p in self.parts], []
        for contact, (measured, before) in zip(usual, surfaces, strict=True):
            # cleaned otherwise, a profile may lose its end
            start = contact if measured.z.shape == before.z.shape else None
            contacts.append(model.contact(inputs.rubber, surface, measured, load, start))
        return np.asarray(np.log(_amounts(contacts).sum(1) / _amounts(usual).sum(1)))

    def change(self, inputs: Inputs) -> float:
        """Return what other inputs than those of the case change in ln mu, to first order [-]."""
        return float(self.share[0] @ [part.friction_change(inputs) for part in self.parts])

    def area_changes(self, drawn: Sequence[Inputs]) -> Array:
        """Return what other rubbers or cut-offs change in ln A_r/A_0, to first order [-]."""
        return np.asarray(self.share[1] @ [part.area_changes(drawn) for part in self.parts])


def _model(case: Case) -> DirectContact:
    """Return the direct contact on the grid with four points in the smallest wave."""
    return DirectContact(tolerance=None, conditions=case.conditions)


def _surfaces(surface: Surface) -> list[Profile | HeightMap]:
    assert surface.measured is not None
    return list(surface.measured.surfaces)


def _amounts(contacts: Sequence[RoughContact]) -> Array:
    """Return friction from dissipation and contact fraction times length, (2, contacts)."""
    each = [(c.friction_from_dissipation, c.contact_fraction) for c in contacts]
    return np.asarray(np.transpose(each) * [contact.grid.lengths[0] for contact in contacts])


def _directions(changes: ComplexArray, weight: Array) -> tuple[Array, ComplexArray]:
    """Return directions d_k that changes c_i of ln M are sums of, and how far each goes along them.

    Principal components by `weight` of each wave: c_i = sum_k a_ik d_k, shapes (draws, directions)
    and (directions, *waves). `SMALLEST_PART` of the mean square is left out.
    """
    flat = (changes * np.sqrt(weight)).reshape(len(changes), -1)
    values, vectors = np.linalg.eigh((flat @ flat.conj().T).real)
    rest = np.cumsum(np.maximum(values, 0.0))
    kept = vectors[:, rest > SMALLEST_PART * rest[-1]]
    return kept, np.tensordot(kept.T, changes, 1)


def first_order(
    case: Case, uncertainty: Uncertainty | None = None, *, count: int = DRAWS, seed: int = 0
) -> xr.Dataset:
    """Return the errors of friction and contact area of a case by each source.

    The result is over `source`: `friction_error` and `contact_fraction_error`, the relative
    standard errors by first order [-]; NaN for the stretch of road where pieces of the profiles are
    too few. The grid has none. Raises `InputError` as `Tangent.of`.

    Parameters
    ----------
    case : Case
        A prepared case with a measured surface, in motion.
    uncertainty : Uncertainty, optional
        What is uncertain; by default as the table [uncertainty] of the case says.
    count : int
        Draws of each source for the friction.
    seed : int
        Seed of the random numbers.
    """
    asked = uncertainty or Uncertainty.of_case(stated_options(case))
    tangent = Tangent.of(case)
    # a range of a source that only the chain has says nothing of the direct contact
    ranges = {name: v for name, v in asked.ranges.items() if DIRECT in SOURCES[name].models}
    drawn = replace(asked, without=(*asked.without, ROAD, GRID), ranges=ranges)
    sources = drawn.of(case, (DIRECT,), any_number=True).sources

    def inputs_of(source: Source, count: int) -> list[Inputs]:
        every = (each.inputs for each in draws(tangent.usual, [source], count, seed))
        return [inputs for inputs in every if inputs is not None]

    def scatter(source: Source, _: object) -> Array:
        inputs = few = inputs_of(source, count)
        if source.name in OF_RUBBER:
            few = inputs_of(source, FEW_DRAWS)
        friction, area = [tangent.change(each) for each in inputs], tangent.area_changes(few)
        return np.array([np.std(friction), np.std(area)])

    def solved_change(inputs: Inputs, _: object) -> Array:
        return tangent.solved_change(inputs)

    names: list[str] = []
    jobs: list[Job[Array]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        # the draws that are solved come last, so that all threads are busy to the end
        for source in sorted(sources, key=lambda source: source.name in SOLVED):
            of_source: list[Job[Array]] = [partial(scatter, source)]
            if source.name in SOLVED:
                every = inputs_of(source, SOLVED[source.name])
                of_source = [partial(solved_change, inputs) for inputs in every]
            names += [source.name] * len(of_source)
            jobs += of_source
        squares = np.square(all_results(jobs, worker_count(None)))
    # of a single scatter itself, of solved draws their rms change
    errors = {
        source.name: np.sqrt(squares[np.array(names) == source.name].mean(axis=0))
        for source in sources
    }
    errors |= {ROAD: tangent.sampling_errors} if ROAD not in asked.without else {}
    labels = np.array([SOURCES[name].label for name in errors], dtype=object)
    text = "relative standard error of {}, by first order"
    return xr.Dataset(
        {
            f"{name}_error": (
                "source",
                [error[at] for error in errors.values()],
                {"units": "1", "long_name": text.format(name.replace("_", " "))},
            )
            for at, name in enumerate(CARRIED_QUANTITIES)
        },
        {"source": np.array([*errors], dtype=object), "label": ("source", labels)},
    )
