"""Reading sweeps from what instruments export, guessing nothing.

The modulus is told by two of E', E'', tan delta and |E*|:

    E'' = E' tan d,   E' = E''/tan d,   E' = |E*|/sqrt(1 + tan^2 d)

A shear modulus becomes the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.ramps import sweeps_from_ramps
from gripscale.rubber.reader import modulus_of, position_of, unit_of
from gripscale.rubber.sweep_blocks import Block, read_blocks
from gripscale.rubber.sweeps import TOLERANCE, Array, Sweeps
from gripscale.rubber.titles import quantity
from gripscale.textfile import TextTable, file_paths
from gripscale.units import in_si

MODULI = ("storage", "loss", "loss_factor", "magnitude")
_PAIRS = (
    ("storage", "loss"),
    ("storage", "loss_factor"),
    ("loss", "loss_factor"),
    ("magnitude", "loss_factor"),
)
_NAMES = ("temperature", "frequency", *MODULI)

Columns = Mapping[str, str | int]


def read_sweeps(
    path: str | Path | Sequence[str | Path],
    *,
    sheet: str | int | None = None,
    columns: Columns | None = None,
    temperature: float | None = None,
    temperature_unit: str | None = None,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    modulus: str | None = None,
    tolerance: float = TOLERANCE,
    temperature_step: float | None = None,
    name: str | None = None,
    source: str = "",
) -> Sweeps:
    """Read frequency sweeps at several temperatures from text, CSV, Excel or RepTate files.

    Titles are read in English and German. The rules of `gripscale.textfile` hold; several tables
    in one file, each with its temperature above it or in a column, are taken together. What the
    file states need not be given; what is given goes before it.

    Parameters
    ----------
    path : str, Path or sequence of them
        The file, or several, such as one for each temperature. Excel: .xlsx.
    sheet : str or int, optional
        Name or position of the Excel sheet, where several hold numbers.
    columns : mapping, optional
        Title or zero-based position of `temperature`, `frequency` and two of `storage`, `loss`,
        `loss_factor` and `magnitude`, as far as titles do not tell.
    temperature : float, optional
        Temperature of a file that states none [K].
    temperature_unit : {"K", "C", "F"}, optional
        Unit of the temperatures.
    frequency_unit : {"Hz", "kHz", "MHz", "GHz", "rad/s"}, optional
        Unit of the frequencies.
    modulus_unit : {"Pa", "kPa", "MPa", "GPa", "N/mm2"}, optional
        Unit of the moduli.
    modulus : {"E", "G"}, optional
        Whether they are Young's or shear moduli (G is multiplied by 3).
    tolerance : float
        Largest step between neighbouring temperatures of one sweep [K].
    temperature_step : float, optional
        For ramps, temperature sweeps at one or several frequencies: moduli are interpolated at
        multiples of this step [K] of degrees Celsius (see `gripscale.rubber.sweeps_from_ramps`).
    name, source : str, optional
        Carried along; the file's stem by default, and nothing.

    Returns
    -------
    Sweeps
        Rows with a missing value in a column that is needed are left out.

    Raises
    ------
    FileError
        If a file cannot be read or a value in it cannot be; the message names path and line.
    InputError
        If a unit, the kind of modulus, a column or a temperature is neither stated nor given.
    """
    paths = file_paths(path)
    if temperature is not None:
        temperature = checks.positive("temperature", temperature, unit="K")
    given = {"frequency": frequency_unit, "modulus": modulus_unit, "temperature": temperature_unit}
    chosen = _chosen(columns)
    expected = [column for column in chosen.values() if isinstance(column, str)]
    parts = [
        _rows(block, chosen, temperature, given, modulus)
        for place in paths
        for block in read_blocks(
            place, sheet=sheet, expected=expected, temperature_unit=temperature_unit
        )
    ]
    temperatures, *others = np.concatenate(parts, axis=1)
    if not temperatures.size:
        raise FileError(f"{paths[0]}: expected rows without missing values; got none")
    called = paths[0].stem if name is None else name
    frequency, storage, loss = others
    if temperature_step is not None:
        return sweeps_from_ramps(
            temperatures,
            frequency,
            storage,
            loss,
            step=temperature_step,
            name=called,
            source=source,
        )
    try:
        return Sweeps(temperatures, frequency, storage, loss, tolerance, called, source)
    except InputError as error:
        raise InputError(f"{paths[0]}: {error}") from error


def _chosen(columns: Columns | None) -> dict[str, str | int]:
    if columns is None:
        return {}
    if not isinstance(columns, Mapping):
        raise InputError(
            f"columns must map quantities ({', '.join(_NAMES)}) to titles or positions; "
            f"got {checks.shown(columns)}"
        )
    checks.known("quantity in columns", columns, _NAMES)
    return dict(columns)


def _rows(
    block: Block,
    chosen: dict[str, str | int],
    temperature: float | None,
    given: dict[str, str | None],
    modulus: str | None,
) -> Array:
    """Return temperature, frequency, E' and E'' of the complete rows of a table, in SI units."""
    table = block.table
    frequency = find_column(table, "frequency", chosen)
    if frequency is None:
        raise missing(table, "frequency", "columns")
    hertz = unit_of(table, [frequency], "frequency", given["frequency"])
    rows = [
        row_temperatures(block, chosen, temperature, given["temperature"]),
        in_si(above_zero(table, frequency, "frequency"), hertz, "frequency"),
        *young_moduli(table, chosen, given["modulus"], modulus),
    ]
    complete = np.isfinite(rows).all(axis=0)
    return np.array(rows)[:, complete]


def find_column(table: TextTable, wanted: str, chosen: Columns) -> int | None:
    """Return the column of a quantity; None if no title means it and none is chosen.

    Raises `InputError` if several titles mean it.
    """
    if wanted in chosen:
        return position_of(table, chosen[wanted])
    taken = {position_of(table, column) for column in chosen.values()}
    named = [at for at, one in enumerate(table.columns) if quantity(one.name) == wanted]
    hits = [at for at in named if at not in taken]
    first = [row[hits[0]] for row in table.rows] if hits else []
    if any([row[at] for row in table.rows] != first for at in hits[1:]):
        raise InputError(
            f"{table.path}: columns must say which is the {wanted}, because {len(hits)} titles "
            f"mean it ({', '.join(table.columns[at].name for at in hits)})"
        )
    return hits[0] if hits else None


def young_moduli(
    table: TextTable, chosen: Columns, modulus_unit: str | None, modulus: str | None
) -> tuple[Array, Array]:
    """Return E' and E'' [Pa] of each row, NaN where a value is missing."""
    places = {one: find_column(table, one, chosen) for one in MODULI}
    there = {one: at for one, at in places.items() if at is not None}
    pair = next((pair for pair in _PAIRS if set(pair) <= set(there)), None)
    if pair is None:
        raise missing(table, "modulus as two of storage, loss, loss_factor, magnitude", "columns")
    in_pascal = [there[one] for one in pair if one != "loss_factor"]
    size = in_si(1.0, unit_of(table, in_pascal, "modulus", modulus_unit), "modulus")
    size *= 3.0 if modulus_of(table, in_pascal, modulus) == "G" else 1.0
    values = {
        one: above_zero(table, there[one], one) * (1.0 if one == "loss_factor" else size)
        for one in pair
    }
    if pair == ("storage", "loss"):
        return values["storage"], values["loss"]
    factor = values["loss_factor"]
    if "storage" in values:
        return values["storage"], values["storage"] * factor
    if "loss" in values:
        return values["loss"] / factor, values["loss"]
    storage = values["magnitude"] / np.sqrt(1.0 + factor**2)
    return storage, storage * factor


def row_temperatures(block: Block, chosen: Columns, given: float | None, unit: str | None) -> Array:
    """Return the temperature of each row [K]: the caller's, of the lines above, of a column."""
    table = block.table
    if given is None and block.temperature is not None and "temperature" not in chosen:
        given = block.temperature
    if given is not None:
        return np.full(len(table.rows), given)
    column = find_column(table, "temperature", chosen)
    if column is None:
        raise missing(table, "temperature", "columns or temperature")
    written = unit_of(table, [column], "temperature", unit)
    kelvin = in_si(table.numbers(column, "a temperature", missing=True), written, "temperature")
    _check(table, column, kelvin > 0.0, kelvin, "a temperature above absolute zero")
    return np.asarray(kelvin)


def above_zero(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column of numbers above zero, NaN where missing; `FileError` names other lines."""
    values = table.numbers(column, "a finite number", missing=True)
    good = (values >= checks.LEAST) & (values <= checks.MOST)
    span = f"{checks.LEAST:g} to {checks.MOST:g}"
    expected = f"a {wanted.replace('_', ' ')} above zero, {span},"
    _check(table, column, good, values, expected)
    return values


def _check(
    table: TextTable, column: int, good: NDArray[np.bool_], values: Array, expected: str
) -> None:
    bad = ~good & ~np.isnan(values)
    if bad.any():
        at = int(np.argmax(bad))
        raise FileError(
            f"{table.path}, line {table.line_numbers[at]}: expected {expected} in column "
            f"{table.columns[column].name or column + 1}; got {table.rows[at][column]}"
        )


def missing(table: TextTable, what: str, argument: str) -> InputError:
    """Return the refusal of a table in which a quantity cannot be found."""
    known = f"the header has {', '.join(filter(None, table.names))}" if table.names else "no header"
    return InputError(f"{table.path}: {argument} must give the {what}; {known}")
