"""Formulas fitted to shift tables, with standard errors.

    WLF        log10 a_T = -c1 (T - T_0) / (c2 + T - T_0)
    Arrhenius  log10 a_T = H / (R ln 10) (1/T - 1/T_0)

Rows count by their standard errors, but none as more certain than a hundredth of a decade. Where
the formula misses the rows by more than their errors, the errors of its constants grow in
proportion.
Sources: M. L. Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701,
doi:10.1021/ja01619a008; J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift.base import EDGE, Array
from gripscale.rubber.shift.table import ShiftTable
from gripscale.rubber.shift.wlf import GAS_CONSTANT, WLF, Arrhenius
from gripscale.units import ZERO_CELSIUS

_LEAST_ERROR = 0.01
"""Standard error of log10 a_T below which none is believed [decades]."""
_SECOND = 51.6
"""Universal c2 of WLF [K], to begin with."""


@dataclass(frozen=True)
class ShiftFit:
    """A formula fitted to a shift table."""

    shift: WLF | Arrhenius
    """With the temperatures fitted as its `valid_range`."""
    errors: dict[str, float]
    """Standard error of each constant by its name: c1 [-], c2 [K], activation_energy [J/mol]."""
    temperature: Array = field(repr=False)
    """Temperatures fitted [K], shape (rows,)."""
    residual: Array = field(repr=False)
    """Table less formula, in log10 a_T [-], shape (rows,)."""

    @property
    def misfit(self) -> float:
        """Root mean square of the residual [decades]."""
        return float(np.sqrt(np.mean(self.residual**2)))

    def summary(self) -> str:
        """Return the constants with their errors in a line of text."""
        units = {"c2": " K", "activation_energy": " J/mol"}
        constants = ", ".join(
            f"{name} = {getattr(self.shift, name):.4g} +- {error:.2g}{units.get(name, '')}"
            for name, error in self.errors.items()
        )
        low, high = self.temperature[[0, -1]] - ZERO_CELSIUS
        return (
            f"{self.shift.kind}: {constants}; {low:.1f} to {high:.1f} °C, "
            f"misfit {self.misfit:.3f} decades"
        )


def fit_wlf(
    table: ShiftTable, *, reference_temperature: float | None = None, lowest: float | None = None
) -> ShiftFit:
    """Return the WLF law of a shift table.

    Parameters
    ----------
    table : ShiftTable
        At least three rows that count.
    reference_temperature : float, optional
        T_0 [K], within the table; its own by default.
    lowest : float, optional
        Rows colder than this [K], such as those of the glass, do not count.

    Returns
    -------
    ShiftFit
        The law at T_0, valid between the temperatures that count, with its errors.

    Raises
    ------
    InputError
        If T_0 is missing or outside the table, too few rows count, or they do not follow the law:
        log10 a_T must fall ever more slowly.
    """
    reference = _reference(table, reference_temperature)
    kelvin, log_a, error = _rows(table, reference, lowest, None, 3)

    def law(constants: Array) -> Array:
        above = kelvin - reference
        return np.asarray(-constants[0] * above / (constants[1] + above))

    from scipy.optimize import least_squares

    coldest = max(float(reference - kelvin.min()), 0.0)
    begin = max(_SECOND, 1.5 * coldest)
    slope = law(np.array([1.0, begin]))
    first = max(float(slope @ log_a) / max(float(slope @ slope), 1e-30), 1e-3)

    def weighted(constants: Array) -> Array:
        return np.asarray((law(constants) - log_a) / error)

    found = least_squares(
        weighted,
        [first, begin],
        bounds=([0.0, coldest * (1.0 + 1e-6) + 1e-6], [np.inf, 1e4]),
        x_scale=[10.0, 50.0],
    )
    c1, c2 = map(float, found.x)
    if not (found.success and c1 > 0.0 and c2 < 0.99e4 and c2 > coldest + 0.01):
        raise InputError(
            "table must follow WLF, log10 a_T falling ever more slowly with temperature; the best "
            f"constants found are c1 = {c1:.3g}, c2 = {c2:.3g} K"
        )
    shift = WLF(c1, c2, reference, _span(kelvin))
    residual = log_a - law(found.x)
    errors = _errors(np.asarray(found.jac), residual / error)
    return ShiftFit(shift, dict(zip(("c1", "c2"), errors, strict=True)), kelvin, residual)


def fit_arrhenius(
    table: ShiftTable,
    *,
    reference_temperature: float | None = None,
    lowest: float | None = None,
    highest: float | None = None,
) -> ShiftFit:
    """Return the Arrhenius law of a shift table.

    Parameters
    ----------
    table : ShiftTable
        At least two rows that count.
    reference_temperature : float, optional
        T_0 [K], within the table; its own by default. A constant between rows that count and T_0 is
        found as well if T_0 is not among them, so that the rows of the glass can be fitted alone.
    lowest, highest : float, optional
        Only rows between these [K] count.

    Returns
    -------
    ShiftFit
        The law, valid between the temperatures that count, with its error.

    Raises
    ------
    InputError
        If T_0 is missing or outside the table, too few rows count, or log10 a_T does not fall with
        temperature.
    """
    reference = _reference(table, reference_temperature)
    kelvin, log_a, error = _rows(table, reference, lowest, highest, 2)
    matrix = 1.0 / (GAS_CONSTANT * math.log(10.0)) * (1.0 / kelvin - 1.0 / reference)[:, None]
    if not kelvin[0] - EDGE <= reference <= kelvin[-1] + EDGE:
        matrix = np.column_stack([matrix, np.ones(len(kelvin))])
    weighted = matrix / error[:, None]
    solution, *_ = np.linalg.lstsq(weighted, log_a / error, rcond=None)
    energy = float(solution[0])
    if energy <= 0.0:
        raise InputError(
            f"table must fall with temperature for Arrhenius; the activation energy found is "
            f"{energy:.3g} J/mol"
        )
    residual = log_a - matrix @ solution
    errors = _errors(weighted, residual / error)
    return ShiftFit(
        Arrhenius(energy, _span(kelvin)), {"activation_energy": errors[0]}, kelvin, residual
    )


def _reference(table: ShiftTable, given: float | None) -> float:
    checks.instance("table", table, ShiftTable)
    reference = table.reference_temperature if given is None else given
    if reference is None:
        raise InputError("reference_temperature [K] must be given, because the table states none")
    reference = checks.positive("reference_temperature", reference, unit="K")
    table.log_a(reference, reference)
    return reference


def _rows(
    table: ShiftTable, reference: float, lowest: float | None, highest: float | None, least: int
) -> tuple[Array, Array, Array]:
    """Return temperature, log10 a against the reference and its error, of the rows that count."""
    kelvin = table.temperature
    low = 0.0 if lowest is None else checks.not_negative("lowest", lowest, unit="K")
    high = math.inf if highest is None else checks.positive("highest", highest, unit="K")
    chosen = (kelvin >= low - EDGE) & (kelvin <= high + EDGE)
    if chosen.sum() < least:
        raise InputError(
            f"table must have at least {least} rows between the temperatures fitted; got "
            f"{chosen.sum()}"
        )
    error = np.maximum(np.nan_to_num(table.horizontal_error, nan=_LEAST_ERROR), _LEAST_ERROR)
    return kelvin[chosen], table.log_a(kelvin, reference)[chosen], error[chosen]


def _span(kelvin: Array) -> tuple[float, float] | None:
    return (float(kelvin[0]), float(kelvin[-1])) if len(kelvin) > 1 else None


def _errors(matrix: Array, residual: Array) -> list[float]:
    """Return standard errors from the weighted Jacobian and residuals."""
    left = len(residual) - matrix.shape[1]
    excess = float(residual @ residual) / left if left > 0 else 1.0
    covariance = np.linalg.pinv(matrix.T @ matrix)
    return [float(v) for v in np.sqrt(np.diag(covariance) * max(excess, 1.0))]
