"""From sweeps at several temperatures to one master curve.

    E*(w, T) = E*(a_T w, T_ref) / b_T

A start pair by pair, then all sweeps at once with their uncertainty (`joint_shift`), then the
reference temperature, and a report on how they meet: docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from gripscale.core import Array, CaseKey, Described, InputError, Quantity, Words, checks
from gripscale.core.units import ZERO_CELSIUS, celsius
from gripscale.rubber.joint_shift import SHIFTED_MODULI, Rows, align, sweep_rows
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.shift import Shift, ShiftTable
from gripscale.rubber.sweeps import Sweeps

_STEP = 0.02  # steps of the shifts that are tried [decades]
_BACK = 0.5  # how far a colder sweep may seem to be faster [decades]: by scatter on a plateau
_LEAST_SHARE = 0.1  # least overlap that is tried, over the shorter of the two sweeps
_LEAST_NOISE = 2e-3  # scatter of a modulus about lines between its rows [decades], at least
# x of shape (rows,) rising, y of shape (moduli, rows).
_Points = tuple[Array, Array]


@dataclass(frozen=True, repr=False)
class Overlap(Described):
    """How two neighbouring sweeps meet, once shifted."""

    colder: float
    """Temperature of the colder sweep [K]."""
    warmer: float
    """Temperature of the warmer one [K]."""
    decades: float
    """Width of the overlap [decades of frequency]; below zero the width of the gap."""
    rows: int
    """Rows of both within the overlap."""
    storage: float
    """Root mean square distance of log10 E' in the overlap [decades]; NaN without one."""
    loss: float
    """The same of log10 E''."""
    loss_factor: float
    """The same of log10 E''/E'."""

    def __str__(self) -> str:
        pair = f"{self.colder - ZERO_CELSIUS:.1f} and {self.warmer - ZERO_CELSIUS:.1f} °C"
        return f"{pair}: {self.decades:.2f} decades"


def start(rows: Rows, lifted: bool) -> tuple[Array, Array]:
    """Return log10 a and log10 b of each sweep against the warmest, pair by pair."""
    sweeps = [rows.of(sweep) for sweep in range(rows.sweeps)]
    # The scatter [decades] about lines between neighbouring rows.
    distances = [np.zeros((len(rows.y), 0))]
    for x, y in sweeps:
        share = (x[1:-1] - x[:-2]) / np.maximum(x[2:] - x[:-2], 1e-12)
        middle = y[:, 1:-1] - (1.0 - share) * y[:, :-2] - share * y[:, 2:]
        distances.append(np.abs(middle) / np.sqrt(1.0 + share**2 + (1.0 - share) ** 2))
    away = np.concatenate(distances, axis=1)
    noise = np.full(len(rows.y), _LEAST_NOISE)
    if away.size:
        noise = np.maximum(1.4826 * np.median(away, axis=1), _LEAST_NOISE)
    lifts = rows.lifts if lifted else np.zeros_like(rows.lifts)
    weight, steps = lifts / noise**2, []
    for cold, warm in pairwise(sweeps):
        least = _LEAST_SHARE * min(np.ptp(cold[0]), np.ptp(warm[0]))
        shifts = np.arange(-_BACK, max(warm[0][-1] - cold[0][0] - least, 0.0) + _STEP, _STEP)
        best, least_cost = (0.0, 0.0), math.inf
        for shift in shifts[shifts > warm[0][0] - cold[0][-1]]:
            apart = difference((cold[0] + shift, cold[1]), warm)
            if apart.shape[1] < 2:
                continue
            lift = -float(weight @ apart.mean(axis=1) / weight.sum()) if weight.any() else 0.0
            rest = apart + lift * lifts[:, None]
            cost = float(np.log((rest**2).mean(axis=1) + noise**2).sum())
            if cost < least_cost:
                best, least_cost = (float(shift), lift), cost
        steps.append(best)
    total = np.cumsum([*steps, (0.0, 0.0)][::-1], axis=0)[::-1]
    return total[:, 0], total[:, 1]


def difference(cold: _Points, warm: _Points) -> Array:
    """Return y of the colder sweep less the warmer at the rows of both in the overlap."""
    low, high = max(cold[0][0], warm[0][0]), min(cold[0][-1], warm[0][-1])
    x = np.concatenate([cold[0], warm[0]])
    x = x[(x >= low - 1e-12) & (x <= high + 1e-12)]
    colder, warmer = (
        np.array([np.interp(x, along, y) for y in moduli]) for along, moduli in (cold, warm)
    )
    return np.asarray(colder - warmer)


_LITTLE = 0.5  # overlap below which a shift rests on a few rows [decades]
_LARGE = 0.3  # standard error of log10 a_T that is worth a sentence [decades]
# Distance of a modulus between neighbours that no scatter explains: a tenth of it [decades].
_MISFIT = 0.04


@dataclass(frozen=True, repr=False)
class Superposition(Described):
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
        origin = "found from the sweeps" if self.fitted else "as given"
        lines = [f"{len(self.temperatures)} sweeps superposed, shift {origin}"]
        if self.overlaps:
            width = [pair.decades for pair in self.overlaps]
            apart = np.array([(pair.storage, pair.loss) for pair in self.overlaps])
            apart = apart[np.isfinite(apart).all(axis=1)]
            storage, loss = np.median(apart, axis=0) if apart.size else (math.nan, math.nan)
            lines.append(
                f"neighbours overlap by {min(width):.2f} to {max(width):.2f} decades and differ in "
                f"the median by E' {10.0**storage - 1.0:.1%}, E'' {10.0**loss - 1.0:.1%}"
            )
        return "\n".join([*lines, *self.findings])


def report_superposition(
    sweeps: Sweeps, shift: Shift, reference: float, joint: dict[str, float]
) -> Superposition:
    """Return how sweeps meet; `joint` is the scatter of each modulus, empty for a given shift."""
    kelvin = temperatures_in(shift, sweeps.temperatures, sweeps.tolerance)
    a, b = shift.log_a(kelvin, reference), shift.log_b(kelvin, reference)
    shifted = []
    for sweep, along, up in zip(sweeps, a, b, strict=True):
        y = np.log10([sweep.storage, sweep.loss, sweep.loss / sweep.storage])
        y[:2] += up
        shifted.append((np.log10(sweep.frequency) + along, y))
    overlaps = []
    pairs = zip(pairwise(kelvin.tolist()), pairwise(shifted), strict=True)
    for temperatures, (cold, warm) in pairs:
        width = float(min(cold[0][-1], warm[0][-1]) - max(cold[0][0], warm[0][0]))
        apart = difference(cold, warm) if width >= 0.0 else np.empty((3, 0))
        rms = np.sqrt((apart**2).mean(axis=1)) if apart.size else np.full(3, np.nan)
        overlaps.append(Overlap(*temperatures, width, apart.shape[1], *map(float, rms)))
    findings = tuple(superposition_warnings(overlaps, shift, fitted=bool(joint)))
    return Superposition(sweeps.temperatures, tuple(overlaps), bool(joint), joint, findings)


def temperatures_in(shift: Shift, temperatures: Array, tolerance: float) -> Array:
    """Return where to read a shift [K]: a table at its own temperatures within the tolerance."""
    if not isinstance(shift, ShiftTable):
        return temperatures
    rows = shift.temperature
    nearest = rows[np.abs(np.subtract.outer(temperatures, rows)).argmin(axis=1)]
    return np.where(np.abs(nearest - temperatures) <= tolerance, nearest, temperatures)


def superposition_warnings(
    overlaps: Sequence[Overlap], shift: Shift, *, fitted: bool
) -> Iterator[str]:
    """Yield what is doubtful about how sweeps meet, a sentence each."""
    little = [str(pair) for pair in overlaps if pair.decades < _LITTLE]
    if little:
        yield (
            "neighbours hardly overlap, or not at all, and their shift may be a bound only: "
            f"{'; '.join(little)}"
        )
    for name, words in (("storage", "E'"), ("loss", "E''")):
        apart = [pair for pair in overlaps if getattr(pair, name) > _MISFIT]
        if apart:
            worst = max(getattr(pair, name) for pair in apart)
            yield (
                f"{words} of {len(apart)} of {len(overlaps)} neighbours does not superpose (apart "
                f"by up to {10.0**worst - 1.0:.0%} in the root mean square), from "
                f"{apart[0].colder - ZERO_CELSIUS:.1f} to {apart[-1].warmer - ZERO_CELSIUS:.1f} "
                "°C: vertical shifts, another strain amplitude or a second relaxation are the "
                "usual causes"
            )
    if not isinstance(shift, ShiftTable):
        return
    if np.nanmax(shift.horizontal_error, initial=0.0) > _LARGE:
        at = int(np.nanargmax(shift.horizontal_error))
        yield (
            f"the standard error of log10 a_T reaches {shift.horizontal_error[at]:.2f}, at "
            f"{celsius(shift.temperature[at], '.1f')}"
        )
    if fitted and (shift.vertical != 0.0).any():
        yield (
            "a_T and b_T were found together: where E' and E'' are nearly one power law, as on a "
            "rubbery plateau, one stands for the other, and both may be worse than their "
            "standard errors"
        )


# Scatter of a good laboratory [decades], for whether two sweeps have a value in common.
_NOISE = 0.01
# How far beyond the first or the last sweep a reference temperature still is that sweep's [K].
_NOMINAL = 0.5


def superpose(sweeps: Sweeps, *, reference_temperature: Quantity, **options: Any) -> MasterCurve:
    """Return the master curve of sweeps; options and errors are those of `superpose_report`.

    >>> gs.superpose(sweeps, reference_temperature="20 C").shift.temperature
    array([263.15, 278.15, 293.15, 308.15])
    """
    master, _ = superpose_report(sweeps, reference_temperature=reference_temperature, **options)
    return master


def superpose_report(
    sweeps: Sweeps,
    *,
    reference_temperature: Quantity,
    vertical: bool = False,
    shift: Shift | None = None,
    moduli: str = "both",
) -> tuple[MasterCurve, Superposition]:
    """Return the master curve of sweeps, all rows shifted, and the report on how they meet.

    The `shift` of the curve is a `ShiftTable` with standard errors, or the one given. Raises
    `InputError` if an argument is out of range, neighbouring sweeps have nothing in common, or a
    given shift has no value at a temperature.

    Parameters
    ----------
    sweeps : Sweeps
        At least two sweeps that overlap, unless the shift is given.
    reference_temperature : float
        Temperature the curve holds for [K], within those measured. Between two sweeps it is reached
        by interpolation of the shift.
    vertical : bool
        Whether b_T is found as well; 1 otherwise. Where both moduli are one power law, a_T and b_T
        cannot be told apart, which their errors say.
    shift : Shift, optional
        Taken as it is: nothing is fitted.
    moduli : {"both", "storage", "loss", "loss_factor"}
        What the shift is found from.
    """
    checks.instance("sweeps", sweeps, Sweeps)
    reference = checks.positive("reference_temperature", reference_temperature, unit="K")
    lifted = checks.flag("vertical", vertical)
    checks.one_of("moduli", moduli, SHIFTED_MODULI)
    scatter: dict[str, float] = {}
    doubt = ""
    if shift is None:
        shift, scatter, doubt = _fitted_shift(sweeps, reference, lifted, moduli)
    elif not isinstance(shift, Shift):
        raise InputError(f"shift must be a Shift, such as WLF; got {checks.short_repr(shift)}")
    elif lifted:
        raise InputError("vertical must be False with a shift that is given; got True")
    shift = shift.bound(reference)
    kelvin = temperatures_in(shift, sweeps.temperatures, sweeps.tolerance)
    rows = [len(sweep) for sweep in sweeps]
    a, b = (np.repeat(part(kelvin, reference), rows) for part in (shift.a, shift.b))
    master = MasterCurve(
        sweeps.frequency * a,
        sweeps.storage * b,
        sweeps.loss * b,
        reference_temperature=reference,
        name=sweeps.name,
        source=sweeps.source,
        shift=shift,
    )
    report = report_superposition(sweeps, shift, reference, scatter)
    findings = (*filter(None, [doubt]), *report.findings)
    return master, replace(report, findings=findings)


def _fitted_shift(
    sweeps: Sweeps, reference: float, lifted: bool, moduli: str
) -> tuple[ShiftTable, dict[str, float], str]:
    """Return the shift of the sweeps, the scatter of each modulus, and that b_T is missing."""
    kelvin = sweeps.temperatures.copy()
    for end in (0, -1):  # 20 °C, where the last sweep was measured at 19.97
        outside = reference < kelvin[0] if end == 0 else reference > kelvin[-1]
        if outside and abs(kelvin[end] - reference) <= _NOMINAL:
            kelvin[end] = reference
    if not kelvin[0] <= reference <= kelvin[-1]:
        raise InputError(
            f" must lie within the temperatures measured, {kelvin[0]:.2f} to {kelvin[-1]:.2f} K; "
            f"got {reference:g}",
            key="reference_temperature",
        )
    if len(kelvin) == 1:
        return ShiftTable(kelvin, [0.0], [0.0], reference_temperature=reference), {}, ""
    both = sweep_rows(sweeps, "both")
    pairs = pairwise([both.of(sweep) for sweep in range(both.sweeps)])
    for colder, ((x, cold), (next_x, warm)) in enumerate(pairs):
        # E' of neighbours, their first modulus, must have a value in common.
        apart = warm[0].max() + 3.0 * _NOISE < cold[0].min()
        if min(len(x), len(next_x)) < 2 or apart:
            low, high = sweeps.temperatures[colder : colder + 2] - ZERO_CELSIUS
            raise InputError(
                Words(
                    "sweeps at neighbouring temperatures must overlap for a shift to be found; "
                    f"those at {low:.2f} and {high:.2f} °C do not: superpose either side alone, or "
                    "give ",
                    CaseKey("shift=gripscale.rubber.WLF(8.86, 101.6)"),
                ),
                missing="shift",
            )
    rows = sweep_rows(sweeps, moduli)
    first = "storage" if "storage" in SHIFTED_MODULI[moduli] and not lifted else moduli
    joint = align(rows, *start(sweep_rows(sweeps, first), lifted), lifted)
    scatter = dict(zip(SHIFTED_MODULI[moduli], joint.scatter.tolist(), strict=True))
    count = len(kelvin)
    share = np.array([np.interp(reference, kelvin, unit) for unit in np.eye(count)])
    against = np.eye(count) - share
    error = [
        np.sqrt(np.maximum(np.diag(against @ block @ against.T), 0.0))
        for block in (joint.covariance[:count, :count], joint.covariance[count:, count:])
    ]
    held = ShiftTable(kelvin, joint.log_a, vertical=joint.log_b)
    doubt = ""
    met = report_superposition(sweeps, held, reference, scatter).overlaps
    if moduli == "both" and not (lifted or any(max(p.storage, p.loss) > _MISFIT for p in met)):
        other = align(rows, *start(rows, lifted=True), lifted=True)
        gain = rows.x.size * float(np.log(joint.scatter / other.scatter).sum())
        if gain > count - 1:  # Akaike's criterion: b_T explains more than its number
            missed = against @ (other.log_a - joint.log_a)
            error[0] = np.hypot(error[0], missed)
            doubt = (
                f"vertical shifts, up to {10.0 ** np.abs(against @ other.log_b).max() - 1.0:.0%}, "
                f"superpose the sweeps better and change log10 a_T by up to "
                f"{np.abs(missed).max():.2f}, which is in its errors: try vertical"
            )
    log_a, log_b = held.log_a(kelvin, reference), held.log_b(kelvin, reference)
    vertical, vertical_error = (log_b, error[1]) if lifted else (None, None)
    table = ShiftTable(kelvin, log_a, error[0], vertical, vertical_error, reference)
    return table, scatter, doubt
