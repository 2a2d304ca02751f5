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
from functools import cached_property

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.conditions import Conditions
from gripscale.core import Array, ComplexArray, InputError, RubberWarning, in_threads, worker_count
from gripscale.core.parallel import Job
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
class Tangent:
    """The direct contacts of a case, the derivatives of their friction, and the shares in it."""

    case: Case
    usual: Inputs
    contacts: Sequence[RoughContact]
    adjoints: Sequence[FrictionAdjoint]
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
        amounts = _amounts(contacts)
        errors = [float(answer.get(name, math.nan)) for name in reversed(SAMPLING_ERRORS)]
        adjoints = [FrictionAdjoint.of(contact) for contact in contacts]
        usual, share = Inputs.of(case), amounts / amounts.sum(1, keepdims=True)
        return cls(case, usual, contacts, adjoints, share, np.array(errors))

    def solved_change(self, inputs: Inputs) -> Array:
        """Return the changes of ln mu and ln A_r/A_0 by a contact with the other inputs [-]."""
        surface, model = inputs.for_model(_model(self.case))
        assert isinstance(model, DirectContact)
        load, contacts = inputs.under(self.case.load), []
        for measured, usual, contact in zip(
            _surfaces(surface), _surfaces(self.case.surface), self.contacts, strict=True
        ):
            # cleaned otherwise, a profile may lose its end
            start = contact if measured.z.shape == usual.z.shape else None
            contacts.append(model.contact(inputs.rubber, surface, measured, load, start))
        amounts = [_amounts(each).sum(1) for each in (contacts, self.contacts)]
        return np.asarray(np.log(amounts[0] / amounts[1]))

    def change(self, inputs: Inputs) -> float:
        """Return what other inputs than those of the case change in ln mu, to first order [-]."""
        usual = self.usual
        parts = np.zeros(len(self.contacts))
        for at, (contact, adjoint) in enumerate(zip(self.contacts, self.adjoints, strict=True)):
            friction = contact.friction_from_dissipation
            if inputs.rubber is not usual.rubber:
                effect = adjoint.by_modulus(_log_ratio(adjoint, inputs.rubber))
                parts[at] += float(effect.sum() / friction)
            if inputs.cleaned is not usual.cleaned or inputs.smooth_gaps != usual.smooth_gaps:
                assert inputs.measured is not None
                heights = periodic_heights(
                    inputs.measured.surfaces[at],
                    smallest_wavelength=contact.smallest_wavelength,
                    periodic=False,
                )
                change = heights.on(contact.grid.shape) - contact.height
                parts[at] += float((adjoint.by_height * change).sum() / friction)
            if inputs.end != usual.end:
                exponent = contact.cut_off_exponents.friction
                parts[at] += exponent * math.log(inputs.end / usual.end)
        return float(self.share[0] @ (parts + self._by_conditions(inputs, 0)))

    def area_changes(self, drawn: Sequence[Inputs]) -> Array:
        """Return what other rubbers or cut-offs change in ln A_r/A_0, to first order [-]."""
        parts = np.zeros((len(drawn), len(self.contacts)))
        ends = np.array([inputs.end / self.usual.end for inputs in drawn])
        changed = any(inputs.rubber is not self.usual.rubber for inputs in drawn)
        for at, (contact, adjoint) in enumerate(zip(self.contacts, self.adjoints, strict=True)):
            parts[:, at] = contact.cut_off_exponents.contact_fraction * np.log(ends)
            if changed:
                changes = np.array([_log_ratio(adjoint, inputs.rubber) for inputs in drawn])
                along, directions = _directions(changes, np.abs(adjoint.weight))
                differences = sensitivity.ContactFractionDifferences(contact)
                parts[:, at] += along @ [differences.by_modulus(each) for each in directions]
        parts += [self._by_conditions(inputs, 1) for inputs in drawn]
        return np.asarray(parts @ self.share[1])

    def _by_conditions(self, inputs: Inputs, quantity: int) -> Array:
        """Return what pressure and temperature change in ln mu or ln A_r/A_0 of each contact."""
        change = [inputs.log_pressure, inputs.warming]
        if not any(change):
            return np.zeros(len(self.contacts))
        return np.asarray(self._by_pressure_and_kelvin[quantity] @ change)

    @cached_property
    def _by_pressure_and_kelvin(self) -> tuple[Array, Array]:
        """Derivatives of ln mu and ln A_r/A_0 by ln p_0 and T [1/K], each (contacts, 2)."""
        friction, area = [], []
        for contact, adjoint in zip(self.contacts, self.adjoints, strict=True):
            differences = sensitivity.ContactFractionDifferences(contact)
            change = sensitivity.scalar_changes(contact).get("temperature", np.zeros(1, complex))
            by_kelvin = float(adjoint.by_modulus(change).sum())
            pair = np.array([adjoint.by_log_pressure, by_kelvin])
            friction.append(pair / contact.friction_from_dissipation)
            area.append([differences.by_log_pressure(), differences.by_modulus(change)])
        return np.array(friction), np.array(area)


def _surfaces(surface: Surface) -> list[Profile | HeightMap]:
    """Return the profiles of a measured surface, or its map."""
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


def _model(case: Case) -> DirectContact:
    """Return the direct contact on the grid with four points in the smallest wave."""
    return DirectContact(tolerance=None, conditions=case.conditions)


def _log_ratio(adjoint: FrictionAdjoint, rubber: Rubber) -> ComplexArray:
    """Return ln(M'/M) [-] of each wave of another rubber, at the temperature of the case."""
    contact, body = adjoint.contact, adjoint.contact.body
    solid = (contact.conditions or Conditions()).before(rubber)
    scales = None if body.by_scale is None else replace(body.by_scale, rubber=solid)
    other = HalfSpace(solid, body.speed, by_scale=scales, thickness=body.thickness)
    change = np.log(other.modulus(contact.grid) / body.modulus(contact.grid))
    return np.broadcast_to(change, contact.grid.spectrum_shape)


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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        errors = _standard_errors(tangent, sources, count, seed)
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


def _standard_errors(
    tangent: Tangent, sources: Sequence[Source], count: int, seed: int
) -> dict[str, Array]:
    """Return the standard errors of ln mu and ln A_r/A_0 by draws of each source [-].

    The draws that are solved come last, so that all threads are busy to the end.
    """

    def drawn(source: Source, count: int) -> list[Inputs]:
        every = (each.inputs for each in draws(tangent.usual, [source], count, seed))
        return [inputs for inputs in every if inputs is not None]

    def scatter(source: Source) -> Array:
        few = FEW_DRAWS if source.name in OF_RUBBER else count
        friction = [tangent.change(inputs) for inputs in drawn(source, count)]
        return np.array([np.std(friction), np.std(tangent.area_changes(drawn(source, few)))])

    def of_draws(source: Source) -> Job[Array]:
        return lambda _: scatter(source)

    def of_draw(inputs: Inputs) -> Job[Array]:
        return lambda _: tangent.solved_change(inputs)

    jobs: list[Job[Array]] = []
    names: list[str] = []
    for source in sorted(sources, key=lambda source: source.name in SOLVED):
        if source.name in SOLVED:
            of_source = [of_draw(inputs) for inputs in drawn(source, SOLVED[source.name])]
        else:
            of_source = [of_draws(source)]
        jobs += of_source
        names += [source.name] * len(of_source)
    done = dict(in_threads(jobs, worker_count(None)))
    values = np.array([done[at] for at in range(len(jobs))])
    # of a single scatter itself, of solved draws their rms change
    return {
        source.name: np.sqrt(np.mean(values[np.array(names) == source.name] ** 2, axis=0))
        for source in sources
    }
