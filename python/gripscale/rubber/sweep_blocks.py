"""Tables of one file of moduli: a text or Excel file may hold several, each with its temperature.

Lines that are no rows of numbers part the tables where they hold titles or state a temperature; a
table without titles has those of the table before. RepTate's files begin with a line of parameters
such as T=-35;Mw=13.5; where T is in degrees Celsius; without titles their columns are angular
frequency [rad/s], G' and G'' [Pa].
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from gripscale.cells import Line, is_row, parse_number
from gripscale.errors import FileError, InputError
from gripscale.rubber.titles import quantity, stated_temperature, with_primes
from gripscale.textfile import Column, TextTable, read_lines, table_in
from gripscale.units import ZERO_CELSIUS, in_si, listed, spelled

KINDS = ("temperature", "frequency", "modulus", "strain")
_PARAMETERS = re.compile(r"(?:\s*\w+=[^;=]*;)+\s*")
_REPTATE = (Column("frequency", "rad/s"), Column("G'", "Pa"), Column("G''", "Pa"))


@dataclass(frozen=True)
class Block:
    """A table and the temperature stated above it [K], if any."""

    table: TextTable
    temperature: float | None = None


def read_blocks(
    path: Path,
    *,
    expected: list[str],
    temperature_unit: str | None,
    sheet: str | int | None = None,
    header: int | None = None,
) -> list[Block]:
    """Return the tables of a file, in its order; `expected` are names of columns to look for.

    Raises `FileError` and `InputError` as `read_sweeps` does.
    """
    read = read_lines(path, sheet=sheet, header=header)
    lines = [(number, with_primes(line)) for number, line in read]
    if lines and _PARAMETERS.fullmatch(lines[0][1]):
        return [_reptate(path, lines, expected)]
    blocks: list[Block] = []
    titles: list[Line] = []
    for part in _parts(lines, expected):
        above, rows = _above(part), part[len(_above(part)) :]
        own = [line for line in above if _names(line[1], expected)]
        stated = _stated(path, above, temperature_unit)
        first = above.index(own[0]) if own else len(above)
        titles = [line for line in above[first:] if stated_temperature(line[1]) is None] or titles
        whole = [*titles, *rows] if own or titles else part
        blocks.append(Block(_table(path, whole, expected), stated))
    return blocks or [Block(_table(path, lines, expected))]


def _parts(lines: list[Line], expected: list[str]) -> Iterator[list[Line]]:
    """Yield the lines of each table: those above its rows, then the rows."""
    part: list[Line] = []
    between: list[Line] = []
    for line in lines:
        if not is_row(line[1]) and not _is_broken(line[1], part):
            between.append(line)
            continue
        begins = any(_begins(text, expected) for _, text in between)
        if part and any(is_row(text) for _, text in part) and begins:
            yield part
            part = []
        part += [*between, line]
        between = []
    if part:
        yield part


def _begins(line: str, expected: list[str]) -> bool:
    return _names(line, expected) or stated_temperature(line) is not None


def _is_broken(line: str, part: list[Line]) -> bool:
    """Return whether a line below rows begins with a number: a row with a fault, to be named."""
    first = re.split(r"[\t;,\s]", line.strip(), maxsplit=1)[0]
    number = parse_number(first)
    return number is not None and number == number and any(is_row(text) for _, text in part)


def _names(line: str, expected: list[str]) -> bool:
    """Return whether a line names two of the quantities, or one of the `expected` columns."""
    for separator in ("\t", ";", ",", r"\s{2,}", r"\s+"):
        cells = [_bare(cell) for cell in re.split(separator, line.strip(" #%!"))]
        found = {quantity(cell) for cell in cells} - {None}
        if len(found) > 1 or any(cell in expected for cell in cells):
            return True
    return False


def _bare(cell: str) -> str:
    return cell.strip().strip('"').strip()


def _above(part: list[Line]) -> list[Line]:
    first = next((at for at, (_, line) in enumerate(part) if is_row(line)), len(part))
    return part[:first]


def _stated(path: Path, above: list[Line], unit: str | None) -> float | None:
    """Return the last temperature the lines above a table state [K]."""
    for number, line in reversed(above):
        found = stated_temperature(line)
        if found is None:
            continue
        value, written = found
        known = unit if spelled(written, "temperature") is None else written
        if known is None:
            raise InputError(
                f"{path}, line {number}: temperature_unit must be given ({listed('temperature')}), "
                f"because the line states none with {value}"
            )
        return float(
            in_si(float(value.replace(",", ".")), known, "temperature", "temperature_unit")
        )
    return None


def _table(path: Path, lines: list[Line], expected: list[str]) -> TextTable:
    return table_in(
        path,
        lines,
        "rows of frequency, storage and loss",
        kinds=KINDS,
        named=lambda name: quantity(name) is not None or name in expected,
    )


def _reptate(path: Path, lines: list[Line], expected: list[str]) -> Block:
    """Return the table of a file of RepTate: the temperature is that of its parameters."""
    pairs = (pair.partition("=") for pair in lines[0][1].split(";"))
    stated = {key.strip(): value.strip() for key, _, value in pairs}
    celsius = parse_number(stated.get("T", ""))
    if celsius is None or celsius != celsius:
        raise FileError(
            f"{path}, line {lines[0][0]}: expected T=... in degrees Celsius among the parameters; "
            f"got {stated.get('T', 'none')}"
        )
    table = _table(path, lines[1:], expected)
    if not table.names:
        if len(table.columns) < len(_REPTATE):
            raise FileError(
                f"{path}, line {table.line_numbers[0]}: expected at least 3 columns (frequency, "
                f"G', G''); got {len(table.columns)}"
            )
        others = [Column()] * (len(table.columns) - len(_REPTATE))
        table = replace(table, columns=[*_REPTATE, *others])
    return Block(table, celsius + ZERO_CELSIUS)
