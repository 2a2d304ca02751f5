"""Reading a master curve from a text or CSV file, guessing nothing.

Units and the kind of modulus come from the header or from the caller; a shear modulus is turned
into the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.header import (
    FREQUENCY_UNITS,
    MODULUS_UNITS,
    Column,
    modulus_kind,
    quantity,
    read_header,
)
from gripscale.rubber.master_curve import MasterCurve

_QUANTITIES = ("frequency", "storage", "loss")
_COMMENT = ("#", "%", "!")


@dataclass(frozen=True)
class _Table:
    header: list[Column] | None
    rows: NDArray[np.float64]
    line_numbers: list[int]


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

    Columns are separated by blanks, tabs, commas or semicolons; lines starting with #, % or ! are
    comments; the header may be a comment. What the header states need not be given; what is given
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
        If the file cannot be read or holds something else; the message names path and line.
    InputError
        If a unit, the kind of modulus or the columns are neither stated nor given.
    """
    place = Path(path)
    expected = [column for column in columns or () if isinstance(column, str)]
    table = _parse(place, expected)
    chosen = _choose(place, table, columns)
    to_hertz = FREQUENCY_UNITS[
        _unit(place, table, chosen[:1], "frequency_unit", frequency_unit, FREQUENCY_UNITS)
    ]
    to_pascal = MODULUS_UNITS[
        _unit(place, table, chosen[1:], "modulus_unit", modulus_unit, MODULUS_UNITS)
    ]
    to_young = 3.0 if _kind(place, table, chosen[1:], modulus) == "G" else 1.0
    frequency, storage, loss = table.rows[:, chosen].T
    _check_positive(place, table, chosen)
    return MasterCurve(
        frequency * to_hertz,
        storage * to_pascal * to_young,
        loss * to_pascal * to_young,
        reference_temperature=reference_temperature,
        name=place.stem if name is None else name,
        source=source,
    )


def _parse(place: Path, expected: list[str]) -> _Table:
    header_lines: list[str] = []
    rows: list[list[float]] = []
    numbers: list[int] = []
    for at, line in enumerate(_text(place).splitlines(), start=1):
        bare = line.strip()
        comment = bare.startswith(_COMMENT)
        if not bare or (comment and rows):
            continue
        cells = _cells(bare)
        if not rows and (comment or _number(cells[0]) is None):
            header_lines.append(bare.lstrip("".join(_COMMENT)))
            continue
        rows.append(_row(place, at, cells, len(rows[0]) if rows else None))
        numbers.append(at)
    if len(rows) < 2:
        raise FileError(
            f"{place}: expected at least 2 rows of frequency, storage and loss; got {len(rows)}"
        )
    count = len(rows[0])
    if count < 3:
        raise FileError(
            f"{place}, line {numbers[0]}: expected at least 3 columns "
            f"(frequency, storage, loss); got {count}"
        )
    return _Table(read_header(header_lines, count, expected), np.array(rows), numbers)


def _text(place: Path) -> str:
    try:
        raw = place.read_bytes()
    except OSError as error:
        raise FileError(f"{place}: cannot be read ({error.strerror or error})") from error
    if b"\0" in raw:
        raise FileError(f"{place}: expected a text file; got binary data")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _cells(line: str) -> list[str]:
    for separator in ("\t", ";"):
        if separator in line:
            return [cell.strip() for cell in line.strip(separator).split(separator)]
    by_comma = [cell.strip() for cell in line.rstrip(",").split(",")]
    if len(by_comma) > 1 and not any(len(cell.split()) > 1 for cell in by_comma):
        return by_comma
    return line.split()


def _number(cell: str) -> float | None:
    try:
        return float(cell.replace(",", ".") if cell.count(",") == 1 else cell)
    except ValueError:
        return None


def _row(place: Path, at: int, cells: list[str], count: int | None) -> list[float]:
    if count is not None and len(cells) != count:
        raise FileError(f"{place}, line {at}: expected {count} numbers; got {len(cells)}")
    values = []
    for cell in cells:
        value = _number(cell)
        if value is None or not np.isfinite(value):
            raise FileError(f"{place}, line {at}: expected a finite number; got {cell!r}")
        values.append(value)
    return values


def _choose(place: Path, table: _Table, columns: Sequence[str | int] | None) -> list[int]:
    count = table.rows.shape[1]
    header = table.header
    if columns is not None:
        return [_position(place, table, column) for column in _three(columns)]
    if header is None:
        if count == 3:
            return [0, 1, 2]
        raise InputError(
            f"{place}: columns must name frequency, storage and loss, because the file has "
            f"{count} columns and no header that does; got nothing"
        )
    found = []
    for wanted in _QUANTITIES:
        hits = [i for i, column in enumerate(header) if quantity(column.name) == wanted]
        if len(hits) != 1:
            names = ", ".join(column.name for column in header)
            raise InputError(
                f"{place}: columns must name frequency, storage and loss, because {len(hits)} "
                f"header names mean {wanted}; the header has {names}"
            )
        found.append(hits[0])
    return found


def _three(columns: Sequence[str | int]) -> Sequence[str | int]:
    if isinstance(columns, str) or len(columns) != 3 or len(set(columns)) != 3:
        raise InputError(
            f"columns must be three different names or positions for frequency, storage and loss; "
            f"got {columns!r}"
        )
    return columns


def _position(place: Path, table: _Table, column: str | int) -> int:
    count = table.rows.shape[1]
    if isinstance(column, int):
        return checks.whole("columns", column, least=0, most=count - 1)
    names = [] if table.header is None else [known.name for known in table.header]
    if names.count(column) != 1:
        known = ", ".join(names) or "no names"
        raise InputError(
            f"{place}: columns must be among the header's names ({known}); got {column!r}"
        )
    return names.index(column)


def _unit(
    place: Path,
    table: _Table,
    chosen: list[int],
    argument: str,
    given: str | None,
    known: Mapping[str, float],
) -> str:
    if given is not None:
        return checks.one_of(argument, given, known)
    stated = {table.header[i].unit for i in chosen} if table.header else {None}
    unit = stated.pop()
    if stated or unit is None or unit not in known:
        what = "no unit" if unit is None and not stated else repr(unit)
        raise InputError(
            f"{place}: {argument} must be given ({', '.join(known)}), because the header states "
            f"{'different units' if stated else what}"
        )
    return unit


def _kind(place: Path, table: _Table, chosen: list[int], given: str | None) -> str:
    if given is not None:
        return checks.one_of("modulus", given, ("E", "G"))
    stated = {modulus_kind(table.header[i].name) for i in chosen} if table.header else {None}
    kind = stated.pop()
    if stated or kind is None:
        raise InputError(
            f"{place}: modulus must be given (E for Young's or G for shear), because the header "
            "does not tell"
        )
    return kind


def _check_positive(place: Path, table: _Table, chosen: list[int]) -> None:
    for wanted, column in zip(_QUANTITIES, chosen, strict=True):
        bad = np.flatnonzero(table.rows[:, column] <= 0.0)
        if bad.size:
            raise FileError(
                f"{place}, line {table.line_numbers[bad[0]]}: expected a {wanted} above zero; "
                f"got {table.rows[bad[0], column]:g}"
            )
