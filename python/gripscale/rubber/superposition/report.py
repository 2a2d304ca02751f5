"""How well sweeps superpose: where neighbours meet, how they differ, and what is doubtful."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from gripscale.rubber.shift import Shift, ShiftTable
from gripscale.rubber.superposition.neighbours import (
    Overlap,
    Points,
    difference,
    overlap_width,
)
from gripscale.rubber.superposition.rows import Array
from gripscale.rubber.sweeps import Sweeps
from gripscale.units import ZERO_CELSIUS

_LITTLE = 0.5
"""Overlap below which a shift rests on a few rows [decades]."""
_LARGE = 0.3
"""Standard error of log10 a_T that is worth a sentence [decades]."""
_MISFIT = 0.04
"""Distance of a modulus between neighbours that no scatter explains: a tenth of it [decades]."""


@dataclass(frozen=True)
class Superposition:
    """How the sweeps of a master curve meet, and what is doubtful about it."""

    temperatures: Array = field(repr=False)
    """Of the sweeps, the coldest first [K]."""
    overlaps: tuple[Overlap, ...] = field(repr=False)
    """One for each pair of neighbours, the coldest first."""
    fitted: bool
    """Whether the shift was found from the sweeps, or given."""
    scatter: dict[str, float]
    """Of each modulus the shift rests on, about the smooth curve [decades]; empty if given."""
    findings: tuple[str, ...]
    """What is doubtful, a sentence each."""

    def summary(self) -> str:
        """Return the report as a few lines of text."""
        if len(self.temperatures) == 1:
            return "one sweep: there is nothing to superpose"
        how = "found from the sweeps" if self.fitted else "as given"
        lines = [f"{len(self.temperatures)} sweeps superposed, shift {how}"]
        if self.overlaps:
            width = [one.decades for one in self.overlaps]
            lines.append(
                f"neighbours overlap by {min(width):.2f} to {max(width):.2f} decades and differ in "
                f"the median by E' {_median(self, 'storage'):.1%}, E'' {_median(self, 'loss'):.1%}"
            )
        return "\n".join([*lines, *self.findings])


def report(
    sweeps: Sweeps, shift: Shift, reference: float, joint: dict[str, float]
) -> Superposition:
    """Return how the sweeps meet under a shift to a reference temperature [K].

    `joint` is the scatter of each modulus about the smooth curve, empty if the shift was given.
    """
    places = temperatures_in(shift, sweeps.temperatures, sweeps.tolerance)
    a, b = shift.log_a(places, reference), shift.log_b(places, reference)
    shifted = [
        _points(one.frequency, one.storage, one.loss, along, up)
        for one, along, up in zip(sweeps, a, b, strict=True)
    ]
    pairs = zip(places, places[1:], shifted, shifted[1:], strict=False)
    overlaps = tuple(overlap(float(t), float(u), cold, warm) for t, u, cold, warm in pairs)
    found = (*_findings(overlaps, shift), *_lifted(shift, bool(joint)))
    return Superposition(sweeps.temperatures, overlaps, bool(joint), joint, found)


def temperatures_in(shift: Shift, temperatures: Array, tolerance: float) -> Array:
    """Return where a shift is to be read for sweeps at `temperatures` [K].

    A table is read at its own temperature where that lies within the tolerance [K] of a sweep's.
    """
    if not isinstance(shift, ShiftTable):
        return temperatures
    own = shift.temperature
    nearest = own[np.abs(np.subtract.outer(temperatures, own)).argmin(axis=1)]
    return np.where(np.abs(nearest - temperatures) <= tolerance, nearest, temperatures)


def overlap(colder: float, warmer: float, cold: Points, warm: Points) -> Overlap:
    """Return how two shifted sweeps at two temperatures [K] meet; their y are E', E'', E''/E'."""
    width = overlap_width(cold[0], warm[0])
    apart = difference(cold, warm) if width >= 0.0 else np.empty((3, 0))
    rms = np.sqrt((apart**2).mean(axis=1)) if apart.size else np.full(3, np.nan)
    return Overlap(colder, warmer, width, apart.shape[1], *map(float, rms))


def _points(frequency: Array, storage: Array, loss: Array, along: float, up: float) -> Points:
    y = np.log10([storage, loss, loss / storage])
    y[:2] += up
    return np.log10(frequency) + along, y


def _median(superposition: Superposition, name: str) -> float:
    values = np.array([getattr(one, name) for one in superposition.overlaps])
    known = values[np.isfinite(values)]
    return float(10.0 ** np.median(known) - 1.0) if known.size else float("nan")


def _findings(overlaps: tuple[Overlap, ...], shift: Shift) -> Iterator[str]:
    little = [one for one in overlaps if one.decades < _LITTLE]
    if little:
        yield "neighbours hardly overlap, so that their shift is uncertain: " + _listed(little)
    for name, words in (("storage", "E'"), ("loss", "E''")):
        apart = [one for one in overlaps if getattr(one, name) > _MISFIT]
        if apart:
            worst = max(getattr(one, name) for one in apart)
            yield (
                f"{words} of {len(apart)} of {len(overlaps)} neighbours does not superpose (apart "
                f"by up to {10.0**worst - 1.0:.0%} in the root mean square), from "
                f"{apart[0].colder - ZERO_CELSIUS:.1f} to {apart[-1].warmer - ZERO_CELSIUS:.1f} "
                "°C: vertical shifts, another strain amplitude or a second relaxation are the "
                "usual causes"
            )
    if isinstance(shift, ShiftTable) and np.nanmax(shift.horizontal_error, initial=0.0) > _LARGE:
        at = int(np.nanargmax(shift.horizontal_error))
        yield (
            f"the standard error of log10 a_T reaches {shift.horizontal_error[at]:.2f}, at "
            f"{shift.temperature[at] - ZERO_CELSIUS:.1f} °C"
        )


def _lifted(shift: Shift, fitted: bool) -> Iterator[str]:
    if fitted and isinstance(shift, ShiftTable) and (shift.vertical != 0.0).any():
        yield (
            "a_T and b_T were found together: where E' and E'' are nearly one power law, as on a "
            "rubbery plateau, one stands for the other, and both may be worse than their "
            "standard errors"
        )


def _listed(overlaps: list[Overlap]) -> str:
    return "; ".join(map(str, overlaps))
