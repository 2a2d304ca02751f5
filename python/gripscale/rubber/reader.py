"""Reading a master curve from a text or CSV file, guessing nothing.

Units and the kind of modulus come from the header or from the caller; a shear modulus is turned
into the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.header import is_temperature, modulus_kind, quantity
from gripscale.rubber.master_curve import Array, MasterCurve
from gripscale.textfile import TextTable, file_path, read_table
from gripscale.units import in_si, listed, spelled

_QUANTITIES = ("frequency", "storage", "loss")
_FEWEST_ROWS = 2
_ONE_TEMPERATURE = 2.0
"""Temperatures this close [K] are one: no oven is quieter."""


def read_master_curve(
    path: str | Path,
    *,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    modulus: str | None = None,
    reference_temperature: float | None = None,
    columns: Sequence[str | int] | None = None,
    name: str | None = None,
    source: str = "",
) -> MasterCurve:
    """Read storage and loss modulus against frequency from a text or CSV file.

    The rules of `gripscale.textfile` hold. What the header states need not be given; what is given
    goes before the header.

    Parameters
    ----------
    path : str or Path
        The file.
    frequency_unit : {"Hz", "kHz", "MHz", "GHz", "rad/s"}, optional
        Unit of the frequency column.
    modulus_unit : {"Pa", "kPa", "MPa", "GPa", "N/mm2"}, optional
        Unit of both modulus columns.
    modulus : {"E", "G"}, optional
        Whether the file holds Young's or shear moduli (G is multiplied by 3).
    reference_temperature : float, optional
        Temperature the curve holds for [K].
    columns : sequence of three str or int, optional
        Header names or zero-based positions of frequency, storage and loss. Without it, recognised
        header names, or else the order of a file with exactly three columns.
    name, source : str, optional
        Carried along; the file's stem by default, and nothing.

    Returns
    -------
    MasterCurve

    Raises
    ------
    FileError
        If the file cannot be read or holds something else, such as sweeps at several temperatures;
        the message names path and line.
    InputError
        If a unit, the kind of modulus or the columns are neither stated nor given.
    """
    place = file_path(path)
    names = () if columns is None else _three(columns)
    table = _table(place, [column for column in names if isinstance(column, str)])
    chosen = _choose(table, columns)
    _refuse_sweeps(table, chosen[0], named=columns is not None)
    hertz = unit_of(table, chosen[:1], "frequency", frequency_unit)
    pascal = unit_of(table, chosen[1:], "modulus", modulus_unit)
    to_young = 3.0 if modulus_of(table, chosen[1:], modulus) == "G" else 1.0
    frequency, storage, loss = (
        _positive(table, column, wanted) for column, wanted in zip(chosen, _QUANTITIES, strict=True)
    )
    return MasterCurve(
        in_si(frequency, hertz, "frequency"),
        in_si(storage, pascal, "modulus") * to_young,
        in_si(loss, pascal, "modulus") * to_young,
        reference_temperature=reference_temperature,
        name=place.stem if name is None else name,
        source=source,
    )


def _table(place: Path, expected: list[str]) -> TextTable:
    what = "frequency, storage and loss"
    table = read_table(
        place,
        f"at least {_FEWEST_ROWS} rows of {what}",
        kinds=("frequency", "modulus"),
        named=lambda name: quantity(name) is not None or name in expected,
    )
    if len(table.columns) < len(_QUANTITIES):
        raise FileError(
            f"{place}, line {table.line_numbers[0]}: expected at least 3 columns "
            f"(frequency, storage, loss); got {len(table.columns)}"
        )
    if len(table.rows) < _FEWEST_ROWS:
        raise FileError(
            f"{place}: expected at least {_FEWEST_ROWS} rows of {what}; got {len(table.rows)}"
        )
    return table


def _refuse_sweeps(table: TextTable, frequency: int, *, named: bool) -> None:
    """Raise `FileError` if the rows are sweeps at several temperatures and no master curve.

    A shifted curve may still tell at what temperature each row was measured. Its frequencies do not
    repeat from one to the next, and the caller has `named` the columns.
    """
    for column, title in enumerate(table.columns):
        if not is_temperature(title.name):
            continue
        kelvin = table.numbers(column, "a temperature", missing=True)
        kelvin = kelvin[np.isfinite(kelvin)]
        if not kelvin.size or np.ptp(kelvin) <= _ONE_TEMPERATURE:
            continue
        hertz = _positive(table, frequency, "frequency")
        if not named or len(np.unique(hertz)) <= len(hertz) // 2:
            raise FileError(
                f"{table.path}: expected one master curve; got rows at temperatures from "
                f"{kelvin.min():g} to {kelvin.max():g} in column {checks.shortened(title.name)}; "
                "shift the sweeps to one master curve first (read_sweeps, superpose), or name the "
                "columns if they are "
                "shifted"
            )


def _choose(table: TextTable, columns: Sequence[str | int] | None) -> list[int]:
    """Return the columns of frequency, storage and loss."""
    if columns is not None:
        return [position_of(table, column) for column in _three(columns)]
    count = len(table.columns)
    if not table.names:
        if count == len(_QUANTITIES):
            return [0, 1, 2]
        raise InputError(
            f"{table.path}: columns must name frequency, storage and loss, because the file has "
            f"{count} columns and no header that does; got nothing"
        )
    found = []
    for wanted in _QUANTITIES:
        hits = [i for i, name in enumerate(table.names) if quantity(name) == wanted]
        if len(hits) != 1:
            raise InputError(
                f"{table.path}: columns must name frequency, storage and loss, because {len(hits)} "
                f"header names mean {wanted}; the header has {table.titles}"
            )
        found.append(hits[0])
    return found


def _three(columns: Sequence[str | int]) -> Sequence[str | int]:
    if (
        not isinstance(columns, Sequence)
        or isinstance(columns, str)
        or not all(isinstance(column, str | int) for column in columns)
        or len(columns) != 3
        or len(set(columns)) != 3
    ):
        raise InputError(
            f"columns must be three different names or positions for frequency, storage and loss; "
            f"got {checks.shown(columns)}"
        )
    return columns


def position_of(table: TextTable, column: str | int) -> int:
    """Return the position of a column given by it or by its name in the header."""
    if isinstance(column, int):
        return checks.whole("columns", column, least=0, most=len(table.columns) - 1)
    if table.names.count(column) != 1:
        known = table.titles or "no names"
        raise InputError(
            f"{table.path}: columns must be among the header's names ({known}); "
            f"got {checks.shown(column)}"
        )
    return table.names.index(column)


def unit_of(table: TextTable, chosen: list[int], kind: str, given: str | None) -> str:
    """Return the unit of the `chosen` columns: the caller's, or else the one the header states."""
    if given is not None:
        in_si(1.0, given, kind, f"{kind}_unit")
        return given
    written = (table.columns[i].unit for i in chosen)
    stated = {spelled(unit, kind) or unit for unit in written}
    unit = stated.pop()
    if unit is None or stated or spelled(unit, kind) is None:
        what = "no unit" if unit is None else checks.shown(unit)
        raise InputError(
            f"{table.path}: {kind}_unit must be given ({listed(kind)}), because the header states "
            f"{'different units' if stated else what}"
        )
    return unit


def modulus_of(table: TextTable, chosen: list[int], given: str | None) -> str:
    """Return E or G, whichever modulus the `chosen` columns hold."""
    if given is not None:
        return checks.one_of("modulus", given, ("E", "G"))
    stated = {modulus_kind(table.columns[i].name) for i in chosen}
    kind = stated.pop()
    if stated or kind is None:
        raise InputError(
            f"{table.path}: modulus must be given (E for Young's or G for shear), because the "
            "header does not tell"
        )
    return kind


def _positive(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column whose numbers are all above zero and within reason."""
    within = f"a {wanted} between {checks.LEAST:g} and {checks.MOST:g}"
    values = table.numbers(column, within)
    for number, value in zip(table.line_numbers, values, strict=True):
        if value < checks.LEAST:
            expected = within if value > 0.0 else f"a {wanted} above zero"
            raise FileError(f"{table.path}, line {number}: expected {expected}; got {value:g}")
    return values
