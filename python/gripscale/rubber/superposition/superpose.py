"""From sweeps at several temperatures to one master curve.

    E*(w, T) = E*(a_T w, T_ref) / b_T

A start pair by pair from E' (`neighbours`), then all sweeps at once with their uncertainty
(`joint`), then the reference temperature, and a report on how they meet (`report`).
"""

from __future__ import annotations

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.shift import Shift, ShiftTable
from gripscale.rubber.superposition.joint import Joint, align
from gripscale.rubber.superposition.neighbours import no_common_modulus, start
from gripscale.rubber.superposition.report import Superposition, report, temperatures_in
from gripscale.rubber.superposition.rows import MODULI, Array, Rows, rows_of
from gripscale.rubber.sweeps import Sweeps
from gripscale.units import ZERO_CELSIUS

_NOISE = 0.01
"""Scatter of a good laboratory [decades], for whether two sweeps have a value in common."""
_NOMINAL = 0.5
"""How far beyond the first or the last sweep a reference temperature still is that sweep's [K]."""


def superpose(
    sweeps: Sweeps,
    *,
    reference_temperature: float,
    vertical: bool = False,
    shift: Shift | None = None,
    moduli: str = "both",
) -> MasterCurve:
    """Return the master curve of sweeps at several temperatures, with its shift.

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

    Returns
    -------
    MasterCurve
        All rows, shifted. Its `shift` is a `ShiftTable` with standard errors, or the one given.

    Raises
    ------
    InputError
        If an argument is out of range, neighbouring sweeps have nothing in common, or a given shift
        has no value at a temperature.
    """
    master, _ = superpose_report(
        sweeps,
        reference_temperature=reference_temperature,
        vertical=vertical,
        shift=shift,
        moduli=moduli,
    )
    return master


def superpose_report(
    sweeps: Sweeps,
    *,
    reference_temperature: float,
    vertical: bool = False,
    shift: Shift | None = None,
    moduli: str = "both",
) -> tuple[MasterCurve, Superposition]:
    """Return the master curve and the report on how the sweeps meet.

    Arguments and errors are those of `superpose`.
    """
    checks.instance("sweeps", sweeps, Sweeps)
    reference = checks.positive("reference_temperature", reference_temperature, unit="K")
    lifted = checks.flag("vertical", vertical)
    checks.one_of("moduli", moduli, MODULI)
    scatter: dict[str, float] = {}
    if shift is None:
        shift, scatter = _found(sweeps, reference, lifted, moduli)
    else:
        shift = _given(shift, reference, lifted)
    return _master(sweeps, shift, reference), report(sweeps, shift, reference, scatter)


def _given(shift: Shift, reference: float, lifted: bool) -> Shift:
    if not isinstance(shift, Shift):
        raise InputError(f"shift must be a Shift, such as WLF; got {checks.shown(shift)}")
    if lifted:
        raise InputError("vertical must be False with a shift that is given; got True")
    return shift.bound(reference)


def _found(
    sweeps: Sweeps, reference: float, lifted: bool, moduli: str
) -> tuple[ShiftTable, dict[str, float]]:
    """Return the shift of the sweeps, and the scatter of each modulus."""
    kelvin = sweeps.temperatures.copy()
    for end in (0, -1):  # 20 °C, where the last sweep was measured at 19.97
        outside = reference < kelvin[0] if end == 0 else reference > kelvin[-1]
        if outside and abs(kelvin[end] - reference) <= _NOMINAL:
            kelvin[end] = reference
    if not kelvin[0] <= reference <= kelvin[-1]:
        raise InputError(
            f"reference_temperature must lie within the temperatures measured, {kelvin[0]:.2f} to "
            f"{kelvin[-1]:.2f} K; got {reference:g}"
        )
    if len(kelvin) == 1:
        return ShiftTable(kelvin, [0.0], [0.0], reference_temperature=reference), {}
    _require_common(sweeps, rows_of(sweeps, "both"))
    rows = rows_of(sweeps, moduli)
    first = "storage" if "storage" in MODULI[moduli] and not lifted else moduli
    joint = align(rows, *start(rows_of(sweeps, first), lifted), lifted)
    scatter = dict(zip(MODULI[moduli], joint.scatter.tolist(), strict=True))
    return _table(kelvin, reference, joint, lifted), scatter


def _require_common(sweeps: Sweeps, rows: Rows) -> None:
    """Raise `InputError` unless E' of neighbouring sweeps has values in common."""
    for colder in range(rows.sweeps - 1):
        cold, warm = rows.of(colder), rows.of(colder + 1)
        if min(len(cold[0]), len(warm[0])) < 2 or no_common_modulus(cold, warm, _NOISE):
            raise _nothing_common(sweeps, colder)


def _nothing_common(sweeps: Sweeps, colder: int) -> InputError:
    low, high = sweeps.temperatures[colder : colder + 2] - ZERO_CELSIUS
    return InputError(
        f"sweeps at neighbouring temperatures must overlap for a shift to be found; those at "
        f"{low:.2f} and {high:.2f} °C do not: give the shift, or superpose either side alone"
    )


def _table(kelvin: Array, reference: float, joint: Joint, lifted: bool) -> ShiftTable:
    """Return the shifts against the reference temperature, with their errors."""
    count = len(kelvin)
    share = np.array([np.interp(reference, kelvin, one) for one in np.eye(count)])
    against = np.eye(count) - share
    error = [
        np.sqrt(np.maximum(np.diag(against @ block @ against.T), 0.0))
        for block in (joint.covariance[:count, :count], joint.covariance[count:, count:])
    ]
    held = ShiftTable(kelvin, joint.log_a, vertical=joint.log_b)
    return ShiftTable(
        kelvin,
        held.log_a(kelvin, reference),
        error[0],
        held.log_b(kelvin, reference) if lifted else None,
        error[1] if lifted else None,
        reference_temperature=reference,
    )


def _master(sweeps: Sweeps, shift: Shift, reference: float) -> MasterCurve:
    kelvin = temperatures_in(shift, sweeps.temperatures, sweeps.tolerance)
    rows = [len(one) for one in sweeps]
    a, b = (np.repeat(part(kelvin, reference), rows) for part in (shift.a, shift.b))
    return MasterCurve(
        sweeps.frequency * a,
        sweeps.storage * b,
        sweeps.loss * b,
        reference_temperature=reference,
        name=sweeps.name,
        source=sweeps.source,
        shift=shift,
    )
