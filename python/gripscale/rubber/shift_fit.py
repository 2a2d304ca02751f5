"""The formulas of `gripscale.rubber.shift` fitted to shift tables, with standard errors.

Rows count by their standard errors, but none as more certain than a hundredth of a decade. Where
the formula misses the rows by more than their errors, the errors of its constants grow in
proportion. Shift tables are CSV files, to be looked at, edited and given back:

    # reference temperature (C): 20
    temperature (C),log10 a_T,standard error of log10 a_T,b_T,standard error of log10 b_T

Only the first two columns are needed; the sign is that of E*(w, T) = E*(a_T w, T_ref)/b_T.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from gripscale.core import Array, FileError, InputError, about_file, checks
from gripscale.core.units import ZERO_CELSIUS, quantity_in_si
from gripscale.io.folders import write_text
from gripscale.io.text_table import file_path, read_table, read_text
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.shift import EDGE, GAS_CONSTANT, WLF, Arrhenius, ShiftTable

_LEAST_ERROR = 0.01  # standard error of log10 a_T below which none is believed [decades]
_SECOND = 51.6  # universal c2 of WLF [K], to begin with


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
    """Return the WLF law of a shift table, valid between the temperatures that count.

    `reference_temperature` is T_0 [K], within the table; its own by default. Rows colder than
    `lowest` [K], such as those of the glass, do not count. Raises `InputError` if T_0 is missing or
    outside the table, fewer than three rows count, or they do not follow the law: log10 a_T must
    fall ever more slowly.
    """
    reference, kelvin, log_a, error = _rows(table, reference_temperature, 3, lowest)

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

    optimum = least_squares(
        weighted,
        [first, begin],
        bounds=([0.0, coldest * (1.0 + 1e-6) + 1e-6], [np.inf, 1e4]),
        x_scale=[10.0, 50.0],
    )
    c1, c2 = map(float, optimum.x)
    if not (optimum.success and c1 > 0.0 and c2 < 0.99e4 and c2 > coldest + 0.01):
        raise InputError(
            "table must follow WLF, log10 a_T falling ever more slowly with temperature; the best "
            f"constants found are c1 = {c1:.3g}, c2 = {c2:.3g} K"
        )
    residual = log_a - law(optimum.x)
    errors = _errors(np.asarray(optimum.jac), residual / error)
    shift = WLF(c1, c2, reference, _span(kelvin))
    return ShiftFit(shift, dict(zip(("c1", "c2"), errors, strict=True)), kelvin, residual)


def fit_arrhenius(
    table: ShiftTable,
    *,
    reference_temperature: float | None = None,
    lowest: float | None = None,
    highest: float | None = None,
) -> ShiftFit:
    """Return the Arrhenius law of a shift table, valid between the temperatures that count.

    `reference_temperature` is T_0 [K], within the table; its own by default. Only rows from
    `lowest` to `highest` [K] count. If T_0 is not among them, a constant between them and T_0 is
    found as well, so that the rows of the glass can be fitted alone. Raises `InputError` if T_0 is
    missing or outside the table, fewer than two rows count, or log10 a_T does not fall with
    temperature.
    """
    reference, kelvin, log_a, error = _rows(table, reference_temperature, 2, lowest, highest)
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
    errors = {"activation_energy": _errors(weighted, residual / error)[0]}
    return ShiftFit(Arrhenius(energy, _span(kelvin)), errors, kelvin, residual)


def _rows(
    table: ShiftTable,
    temperature: float | None,
    least: int,
    lowest: float | None,
    highest: float | None = None,
) -> tuple[float, Array, Array, Array]:
    """Return T_0, and of the rows that count temperature, log10 a against T_0 and its error."""
    checks.instance("table", table, ShiftTable)
    reference = table.reference_temperature if temperature is None else temperature
    if reference is None:
        raise InputError(
            "reference_temperature [K] must be given, because the table states none",
            missing="reference_temperature",
        )
    reference = checks.positive("reference_temperature", reference, unit="K")
    kelvin = table.temperature
    log_a = table.log_a(kelvin, reference)
    low = 0.0 if lowest is None else checks.not_negative("lowest", lowest, unit="K")
    high = math.inf if highest is None else checks.positive("highest", highest, unit="K")
    chosen = (kelvin >= low - EDGE) & (kelvin <= high + EDGE)
    if chosen.sum() < least:
        raise InputError(
            f"table must have at least {least} rows between the temperatures fitted; got "
            f"{chosen.sum()}"
        )
    error = np.maximum(np.nan_to_num(table.horizontal_error, nan=_LEAST_ERROR), _LEAST_ERROR)
    return reference, kelvin[chosen], log_a[chosen], error[chosen]


def _span(kelvin: Array) -> tuple[float, float] | None:
    return (float(kelvin[0]), float(kelvin[-1])) if len(kelvin) > 1 else None


def _errors(matrix: Array, residual: Array) -> list[float]:
    freedoms = len(residual) - matrix.shape[1]
    excess = float(residual @ residual) / freedoms if freedoms > 0 else 1.0
    covariance = np.linalg.pinv(matrix.T @ matrix)
    return [float(v) for v in np.sqrt(np.diag(covariance) * max(excess, 1.0))]


_TITLES = "temperature (C),log10 a_T,standard error of log10 a_T,b_T,standard error of log10 b_T"
_REFERENCE = re.compile(r"^\s*[#%!].*reference temperature \((\w)\):\s*([-+.\deE]+)", re.MULTILINE)
_DECIMALS = 6  # of a temperature in degrees Celsius: 20.1, not 20.100000000000023


def write_shift_table(path: str | Path, table: ShiftTable) -> Path:
    """Write a shift table as CSV, in degrees Celsius; return the path.

    Raises `FileError` if it cannot be written.
    """
    checks.instance("table", table, ShiftTable)
    columns = (
        np.round(table.temperature - ZERO_CELSIUS, _DECIMALS),
        table.horizontal,
        table.horizontal_error,
        10.0**table.vertical,
        table.vertical_error,
    )
    lines = ["# E*(w, T) = E*(a_T w, T_ref) / b_T"]
    if table.reference_temperature is not None:
        celsius = round(table.reference_temperature - ZERO_CELSIUS, _DECIMALS)
        lines.append(f"# reference temperature (C): {celsius!r}")
    lines.append(_TITLES)
    lines += [",".join(repr(float(v)) for v in row) for row in zip(*columns, strict=True)]
    return write_text(file_path(path), "\n".join([*lines, ""]))


def read_shift_table(path: str | Path, *, temperature_unit: str | None = None) -> ShiftTable:
    """Read a shift table from CSV or text, such as `write_shift_table` writes.

    Titles that say temperature and log a (log10 a_T, log aT, ln(aT)) or a (a_T, shift factor) name
    the columns; b, log b and errors are read where they are, and a reference from a comment.
    `temperature_unit` is K, C or F, if the header does not state it. Raises `FileError` if the file
    cannot be read or has no such columns, `InputError` if the unit of the temperatures is neither
    stated nor given, or the numbers are no table.
    """
    file = file_path(path)
    table = read_table(
        file,
        "rows of temperature and a_T or log10 a_T",
        kinds=("temperature",),
        named=lambda name: name in ("log10", "log", "ln") or _meaning(name) is not None,
    )
    titles = {
        _meaning(title.name) or _meaning(f"{title.name} {title.unit}"): at
        for at, title in enumerate(table.columns)
    }
    if "temperature" not in titles or not {"a", "log_a", "ln_a"} & titles.keys():
        raise FileError(
            f"{file}: expected columns of temperature and a_T or log10 a_T; the header has "
            f"{', '.join(table.names) or 'no names'}"
        )
    columns = {str(n): table.numbers(at, "a number", missing=True) for n, at in titles.items()}
    layout = FileLayout(temperature_unit=temperature_unit)
    unit = layout.unit(table, titles["temperature"], "temperature")
    kelvin = quantity_in_si(columns["temperature"], unit, "temperature")
    for name in {"ln_a", "ln_b"} & columns.keys():
        columns.setdefault(f"log_{name[-1]}", columns[name] / math.log(10.0))
    for name in {"a", "b"} & columns.keys():
        if not (columns[name] > 0.0).all():
            least = np.nanmin(columns[name])
            raise FileError(f"{file}: expected {name}_T above zero; got {least:g}")
        columns.setdefault(f"log_{name}", np.log10(columns[name]))
    reference = None
    if match := _REFERENCE.search(read_text(file)):
        try:
            reference = float(quantity_in_si(float(match[2]), match[1], "temperature"))
        except ValueError as error:
            raise FileError(
                f"{file}: expected a number as reference temperature; got {match[2]}"
            ) from error
    errors = columns.get("log_a_error"), columns.get("log_b_error")
    with about_file(file, InputError):
        vertical = columns.get("log_b")
        return ShiftTable(kelvin, columns["log_a"], errors[0], vertical, errors[1], reference)


def _meaning(name: str) -> str | None:
    low = re.sub(r"[\s_()]+", "", name.lower())
    low = re.sub(r"(horizontal)?shiftfactor$|verschiebungsfaktor$", "at", low)
    if low.startswith("t") and (low == "t" or low.startswith("temp")):
        return "temperature"
    factor = next((f for f in "ab" if re.search(rf"(^|log(10)?|ln|of|error){f}t?$", low)), None)
    if factor is None:
        return None
    if "error" in low or "uncertainty" in low:
        return f"log_{factor}_error"
    natural = re.search(rf"ln(of)?{factor}t?$", low)
    return f"log_{factor}" if "log" in low else f"ln_{factor}" if natural else factor
