"""Models of measured surfaces: direct contact, and the finite-strain block on each profile."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.conditions.conditions import Conditions, RubberByScale
from gripscale.conditions.flash_temperature import STONE, ThermalProperties
from gripscale.core import Array, Checked, InputError, Status, checked, checks, labelled, provenance
from gripscale.cut_off_exponents import NOT_CONVERGED, CutOffExponents, of_mean
from gripscale.half_space.conditions import warming_of
from gripscale.half_space.line_to_map import LineUnderLoad, line_under_load, pressure_over_modulus
from gripscale.half_space.location import contact_trace, with_traces
from gripscale.half_space.result import SHARES_BY_SLOPE, RoughContact
from gripscale.half_space.sampling_error import (
    PIECE,
    SERIES,
    condition_changes,
    log_change,
    sampling_error,
)
from gripscale.half_space.solve import relative_tolerance, solve_rough_contact
from gripscale.model import Load, OnProgress
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import of_sum
from gripscale.surface import HeightMap, Measured, Profile, Surface, SurfacePart
from gripscale.wave.block import solve_profile
from gripscale.wave.problem import Mesh
from gripscale.wave.result import waves_to_dataset

JUDGED_TO = 0.05  # estimated relative error of the contact that every run judges its chain by


TREAD = 8e-3  # thickness of a new tread [m]
FELT = 1.75  # wavelength over thickness up to which a layer is as soft as a half-space, within 5 %
# Shift of measured treads between 20 and 40 C: what warming is worth where no shift was measured.
DECADES_PER_KELVIN = 0.1
WARMING = "warming_without_shift"
# Names of the changes of an answer by a tread on a rigid base, by warming without a shift, and by
# the measured moduli in place of their series.
OTHER_CHANGES = tuple(
    f"{name}_of_{which}"
    for which in ("tread", "heat", "series")
    for name in ("contact_fraction", "friction")
)
# Names of changes over `condition`, by one standard error of what is not known of the conditions.
CONDITION_ERRORS = {
    "contact_fraction_condition_error": "change of ln contact fraction by an error of a condition",
    "friction_condition_error": "change of ln friction by an error of a condition",
}


def _measurement(surface: Surface, need: str) -> Measured:
    """Return what was measured; raise `InputError`, which begins with the need, if nothing was."""
    if surface.measured is None:
        raise InputError(
            f"{need}; got sine waves stated by hand, which have none "
            "(gripscale.half_space.surface_of_sines makes one)"
        )
    return surface.measured


def smallest_wavelength(surface: Surface, measured: Profile | HeightMap) -> float:
    """Return the shortest wave [m] of a measurement that counts by default."""
    return max(surface.cutoff_wavelength, 2.0 * float(np.max(measured.step)))


def resolved_wavelength(surface: Surface) -> float:
    """Return the shortest wave [m] in all measurements; without one, the stated cut-off."""
    measured = () if surface.measured is None else surface.measured.surfaces
    ends = [smallest_wavelength(surface, each) for each in measured]
    return max(ends, default=surface.cutoff_wavelength)


def _with_basis(
    answer: xr.Dataset,
    contacts: Sequence[RoughContact],
    lengths: Sequence[float],
    surface: Surface,
    load: Load,
) -> xr.Dataset:
    """Return an answer with what it rests on (`gripscale.model.BASIS`); NaN what a map has not."""
    longest = float(surface.sines.wavelength[0])
    piece, line = PIECE * longest, LineUnderLoad(*[math.nan] * 4)
    measured = surface.measured
    if measured is not None and measured.map is None:
        pressed = {"largest_wavelength": longest, "pressure": load.pressure, "speed": load.speed}
        lines = [
            line_under_load(profile, each.rubber, contact=each, **pressed)
            for profile, each in zip(measured.cleaned, contacts, strict=True)
        ]
        line = LineUnderLoad(*np.average(np.array(lines), axis=0, weights=lengths))
    strains = [pressure_over_modulus(each.body, load.pressure, longest) for each in contacts]
    errors = [sampling_error(contact, piece) for contact in contacts]
    area, friction = (
        np.multiply(lengths, [getattr(contact, name) for contact in contacts])
        for name in ("contact_fraction", "friction_from_dissipation")
    )
    numbers: tuple[Any, ...] = (
        _relative(area, [error.contact_fraction for error in errors]),
        _relative(friction, [error.friction for error in errors]),
        *line,
        float(np.average(strains, weights=lengths)),
        float(sum(error.pieces - 1 for error in errors)),
        _weighted(friction, [contact.steep_share for contact in contacts]),
        _weighted(area, [contact.missing_share for contact in contacts]),
    )
    variables = {
        name: labelled((), number, "1", text, "direct")
        for (name, text), number in zip(model.BASIS.items(), numbers, strict=True)
    }
    # the nominal pressure is the same: their loads are as their lengths
    weights = (friction, np.asarray(lengths, dtype=float), area)
    for (name, text), weight in zip(SHARES_BY_SLOPE.items(), weights, strict=True):
        share = _weighted(weight, [contact.shares_by_slope[name].values for contact in contacts])
        variables[f"total_{name}"] = labelled("slope", share, "1", text, "direct")
    return answer.assign(variables)


def _relative(parts: Array, errors: Sequence[float]) -> float:
    """Return the relative standard error of a sum of independent parts."""
    total = float(parts.sum())
    return math.hypot(*(parts * np.asarray(errors))) / total if total > 0.0 else math.nan


def _weighted(weight: Array, shares: Sequence[float] | Sequence[Array]) -> Array:
    """Return the mean of shares, or of rows of them; NaN where nothing is shared."""
    total, mean = float(weight.sum()), weight @ np.asarray(shares)
    return np.asarray(mean / total if total > 0.0 else mean * math.nan)


def _answer_by_length(
    data: xr.Dataset,
    parts: Sequence[Any],
    why_not: Sequence[str],
    lengths: Sequence[float],
    name: str,
    load: Load,
    cut_off_exponents: Sequence[CutOffExponents] = (),
) -> xr.Dataset:
    """Return `data` over `profile` with the results `parts` of profiles averaged by length [m].

    `why_not` says why a profile does not count: then there are no totals.
    """
    weight = np.asarray(lengths) / np.sum(lengths)
    bad = [f"profile {n} of {len(parts)}: {why}" for n, why in enumerate(why_not, start=1) if why]
    values = {
        total: np.array([getattr(part, total.removeprefix("total_")) for part in parts])
        for total in model.TOTALS
    }
    attrs = {"units": "1", "long_name": "share of the length"}
    weighted = data.assign(weight=("profile", weight, attrs))
    area, _, friction = (weight * each for each in values.values())
    beyond = of_sum([part.extrapolation for part in parts], friction)
    totals, exponents = dict.fromkeys(values, math.nan), NOT_CONVERGED
    if not bad:
        totals = {total: float(weight @ each) for total, each in values.items()}
        exponents = of_mean(cut_off_exponents, area, friction)
    status = "; ".join(bad) or Status.CONVERGED
    words = [str(part.status) for part, why in zip(parts, why_not, strict=True) if why]
    return model.predicted_answer(
        weighted, totals, status, name, load, beyond, exponents, status_word=next(iter(words), "")
    )


class DirectContact(Checked, model.Model):
    """Direct contact of every cleaned profile, averaged by length; or of a map.

    At small strain the mean deformation has no effect, and so the load time has none. The footprint
    is the length over which the rubber is heated. `smallest_wavelength` is the cut-off [m]: by
    default that of the surface's sine waves or, without one, the last of them; a `periodic` surface
    keeps all its waves then. The other fields are arguments of `solve_rough_contact`.
    """

    name: ClassVar[str] = "direct"
    method: ClassVar[tuple[str, ...]] = (
        "Rubber at small strain is pressed on the heights as they were measured, and slid.",
        *("prony", "half_space", "rough_contact", "rough_friction"),
    )
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})
    takes_conditions: ClassVar[bool] = True

    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    tolerance: float | None = checked(relative_tolerance, default=0.02)
    most_points: int | None = checked(checks.whole, least=1, most=2**40, default=None)
    periodic: bool = checked(checks.flag, default=False)
    conditions: Conditions | None = None
    traces: bool = checked(checks.flag, default=False)
    """Whether the answer holds every contact as charts draw it (`with_traces`)."""
    alternatives: bool = checked(checks.flag, default=False)
    """Whether the answer holds how it changes by what is not known of its conditions."""
    unstated: bool = checked(checks.flag, default=False)
    """Whether it holds how it changes by what is not stated: where the rubber ends, its shift."""

    def with_conditions(self, conditions: Conditions | None) -> DirectContact:
        """Return the direct contact under other conditions."""
        return replace(self, conditions=conditions)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer, with each profile over `profile`; `on_progress` gets each contact.

        Raises `InputError` if the surface was not measured: waves stated by hand have no profile.
        """
        contacts = []
        measurement = _measurement(surface, "the direct contact needs a measured profile")
        for measured in measurement.surfaces:
            contacts.append(self.contact(rubber, surface, measured, load))
            if on_progress is not None:
                on_progress(contacts[-1])
        answer = self._answer(contacts, surface, load)
        return self._with_alternatives(answer, contacts[0], rubber, surface, load)

    def contact(
        self,
        rubber: Rubber,
        surface: Surface,
        measured: Profile | HeightMap,
        load: Load,
        start: RoughContact | None = None,
        by_scale: RubberByScale | None = None,
        *,
        coarse: bool = False,
    ) -> RoughContact:
        """Return the contact of a profile or map of a surface, as `solve_rough_contact` does."""
        smallest = self.smallest_wavelength
        if smallest is None and not self.periodic:
            smallest = smallest_wavelength(surface, measured)
        return solve_rough_contact(
            rubber,
            measured,
            pressure=load.pressure,
            speed=load.speed,
            smallest_wavelength=smallest,
            tolerance=self.tolerance,
            most_points=self.most_points,
            periodic=self.periodic,
            thickness=load.thickness,
            conditions=self.conditions,
            footprint=load.footprint,
            start=start,
            by_scale=by_scale,
            coarse=coarse,
        )

    def _with_alternatives(
        self,
        answer: xr.Dataset,
        contact: RoughContact,
        rubber: Rubber,
        surface: Surface,
        load: Load,
    ) -> xr.Dataset:
        """Return an answer with how its first contact changes by what is not known."""
        if not (self.alternatives and contact.usable):
            return answer
        measured = _measurement(surface, "").surfaces[0]
        # of a wet contact the change is that of the dry one, which its grids are of
        dry = replace(self, tolerance=None, conditions=self.conditions and self.conditions.dry)
        start = replace(contact, water=None)

        def solve(
            other: Rubber, by_scale: RubberByScale | None, under: Load = load
        ) -> RoughContact:
            return dry.contact(other, surface, measured, under, start, by_scale, coarse=True)

        changes = dict(condition_changes(contact, rubber, solve))
        numbers = np.array(list(changes.values())).reshape(-1, 2).T
        labels = np.array(list(changes), dtype=object)
        answer = answer.assign_coords(condition=("condition", labels))
        for (name, text), values in zip(CONDITION_ERRORS.items(), numbers, strict=True):
            answer[name] = labelled("condition", values, "1", text, "direct")
        signed = {"series": changes[SERIES]} if SERIES in changes else {}
        others: dict[str, Load] = {}
        longest = 0.0 if surface.waves is None else float(surface.sines.wavelength[0])
        if self.unstated and load.thickness is None and longest > FELT * TREAD:
            others["tread"] = replace(load, thickness=TREAD)
        effects = self.conditions or Conditions()
        cold = rubber.shift is None and "heat" not in effects.off and not effects.water
        if self.unstated and cold and contact.friction_from_dissipation > 0.0:
            effects = replace(effects, heat=ThermalProperties(), counterface=STONE)
            rise = warming_of(contact, effects, load.footprint).where_lost
            answer[WARMING] = labelled((), rise, "K", "rise that a shift would count", "direct")
            slower = load.speed * 10.0 ** (-DECADES_PER_KELVIN * rise)
            others["heat"] = replace(load, speed=max(slower, 1e-9 * load.speed))
        for which, other in others.items():
            # what is far from the contact needs the grid that judges it, started from a coarser one
            near = solve(rubber, contact.by_scale, other)
            whole = dry.contact(rubber, surface, measured, other, near, contact.by_scale)
            signed[which] = log_change(contact, whole)
        for which, of_both in signed.items():
            for name, change in of_both._asdict().items():
                text = f"change of ln {name} by {which}"
                answer[f"{name}_of_{which}"] = labelled((), change, "1", text, "direct")
        return answer

    def _answer(self, contacts: Sequence[RoughContact], surface: Surface, load: Load) -> xr.Dataset:
        """Return the answer of the contacts of all profiles."""
        # patches and grids differ in number from profile to profile: only the contacts have them
        parts = [c.to_dataset(fields=False).drop_dims(["patch", "grid"]) for c in contacts]
        lengths = [contact.grid.lengths[0] for contact in contacts]
        answer = _answer_by_length(
            xr.concat(parts, dim="profile", join="outer", combine_attrs="override"),
            contacts,
            ["" if contact.usable else str(contact.status) for contact in contacts],
            lengths,
            self.name,
            load,
            [contact.cut_off_exponents for contact in contacts],
        )
        notes = dict.fromkeys(note for contact in contacts for note in contact.notes)
        answer = answer.assign_attrs(notes=" ".join(notes))
        if surface.waves is not None:
            answer = _with_basis(answer, contacts, lengths, surface, load)
        if self.traces:
            answer = with_traces(answer, [contact_trace(contact) for contact in contacts])
        adhesive = [contact.adhesive_friction for contact in contacts]
        return model.with_area_term(answer, float(np.average(adhesive, weights=lengths)))


# Settings that give up a window after seconds: to follow the steepest contacts takes minutes.
QUICK = {"smallest_roughening": 0.1, "roughening_iterations": 12, "rescue_columns": 256}


class BlockOnProfile(Checked, model.Model):
    """Model of measured profiles: each cleaned profile in one block, averaged by length.

    Profiles must be short (`gripscale.half_space.windows`): a block resolves about a hundred waves.
    The fields are arguments of `gripscale.solve_profile`.
    """

    name: ClassVar[str] = "block_on_profile"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement"})

    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    periodic: bool = checked(checks.flag, default=False)
    tolerance: float | None = checked(checks.positive, default=None)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer, with each profile over `profile`; `on_progress` gets each result.

        Raises `InputError` without a profile, or for one with more waves than a block resolves.
        """
        results = []
        for profile in _measurement(surface, "the block on a profile needs a profile").cleaned:
            result = solve_profile(
                rubber,
                profile,
                pressure=load.pressure,
                speed=load.speed,
                load_time=load.time_under(load.footprint),
                depth=load.depth_of_block(Mesh.depth, profile.length),
                smallest_wavelength=self.smallest_wavelength,
                periodic=self.periodic,
                tolerance=self.tolerance,
                settings=QUICK,
            )
            results.append(result)
            if on_progress is not None:
                on_progress(result)
        data = waves_to_dataset(results).drop_vars("scale").rename(scale="profile")
        data = data.assign_attrs(
            title="Profiles in the finite-strain block", **provenance.version_attributes()
        )
        why_not = ["" if result.converged else result.why for result in results]
        lengths = [result.wavelength for result in results]
        return _answer_by_length(data, results, why_not, lengths, self.name, load)
