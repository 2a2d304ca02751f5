"""The tables of a file of moduli, each with what the lines above it state.

Tables stand below each other or side by side, parted by lines that hold titles or state a
temperature; one without titles has those of the table before. Of several tables those without
frequency and modulus are left out: steps that condition the sample. RepTate's files begin with a
line of parameters such as T=-35;Mw=13.5; and have rad/s and Pa. Compliances J' and J'', or D' and
D'', become moduli by G' = J'/(J'^2 + J''^2), G'' = J''/(J'^2 + J''^2), as G* = 1/J* with
J* = J' - i J'' (J. D. Ferry, Viscoelastic Properties of Polymers (1980), ch. 1).

Tables side by side hold a block for each temperature, or of ramps each frequency, in the columns of
one sheet. Blocks are told apart by a mark in the lines above the rows, over each of the columns or
once over the block: f [Hz] | E' -20 °C | E'' -20 °C | E' 0 °C | ..., or E' (10 Hz). A line of plain
numbers is one of temperatures. Each block becomes a table below a line with its mark.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gripscale.core import CaseKey, FileError, InputError, Words, unstated
from gripscale.core.units import ZERO_CELSIUS, listed, quantity_in_si, spelled
from gripscale.io import text_table
from gripscale.io.cells import (
    Line,
    cells_of,
    is_comment,
    is_number,
    is_row,
    is_row_of,
    parse_number,
)
from gripscale.io.text_table import ColumnTitle, TextTable
from gripscale.rubber import columns
from gripscale.rubber.columns import MODULI, PRIMES, FileLayout, quantity, stated_in
from gripscale.rubber.shift import WLF

_PAIR = re.compile(r"([JD])'(?!')"), re.compile(r"([JD])''")


def with_moduli(table: TextTable) -> TextTable:
    """Return a table with moduli [Pa] in place of compliances, or as it is without both of them.

    Raises `FileError` if a title does not state the unit.
    """
    names = [name.translate(PRIMES) for name in table.names]
    hits = [[at for at, name in enumerate(names) if part.match(name)] for part in _PAIR]
    if any(len(ats) != 1 for ats in hits):
        return table
    parts = []
    for (at,) in hits:
        unit = spelled(table.columns[at].unit, "compliance")
        if unit is None:
            units = listed("compliance")
            raise FileError(
                f"{table.path}: expected {names[at]} in {units}; got {table.columns[at].unit}"
            )
        compliance = table.numbers(at, "a compliance", missing=True)
        parts.append(quantity_in_si(compliance, unit, "compliance"))
    letter = "G" if names[hits[0][0]].startswith("J") else "E"
    with np.errstate(divide="ignore", invalid="ignore"):
        moduli = [part / (parts[0] ** 2 + parts[1] ** 2) for part in parts]
    for (at,), values, primes in zip(hits, moduli, ("'", "''"), strict=True):
        title = ColumnTitle(f"{letter}{primes}", "Pa")
        table = columns.with_numbers(table, at, title, values)
    return table


_ROWS = "rows of frequency, storage and loss"
KINDS = ("temperature", "frequency", "modulus", "compliance", "strain", "angle")
_PARAMETERS = re.compile(r"(?:\s*\w+=[^;=]*;)+\s*")
_STEP = re.compile(r"\[\w+\]")  # begins a step of a file of TRIOS: [step]
_REPTATE = (ColumnTitle("frequency", "rad/s"), ColumnTitle("G'", "Pa"), ColumnTitle("G''", "Pa"))


@dataclass(frozen=True)
class Block:
    """A table with what the lines above it state."""

    table: TextTable
    temperature: float | None = None  # temperature [K]
    shift: WLF | None = None
    reference: float | None = None  # temperature that a line above says a curve holds for [K]

    def states_temperature(self, layout: FileLayout) -> bool:
        """Return whether a line above the table, or a column, states the temperature."""
        return self.temperature is not None or layout.column(self.table, "temperature") is not None


def read_blocks(
    path: Path, layout: FileLayout, *, temperature_unit: str | None, most: int | None = None
) -> list[Block]:
    """Return the tables of a file; `temperature_unit` is that of temperatures that state none.

    Of each sheet only the first lines are read, at `most` so many. Raises `InputError` for an Excel
    file of several sheets with moduli, unless each of them states its temperature.
    """
    if not text_table.is_excel(path) or layout.sheet is not None:
        lines = text_table.read_lines(path, sheet=layout.sheet, header=layout.header)
        return text_table.read_once(
            ("blocks", path, repr(layout), temperature_unit, most),
            lambda: _blocks_in(path, lines[:most], layout, temperature_unit),
        )
    sheets: dict[str, list[Block]] = {}
    every_sheet = text_table.sheets_as_lines(path, header=layout.header)
    for name, lines in every_sheet.items():
        with suppress(FileError):  # a sheet without numbers
            blocks = _blocks_in(path, lines[:most], layout, temperature_unit)
            sheets[name] = [with_named_temperature(block, name, layout) for block in blocks]
    with_moduli = {name: _sufficient(blocks, layout) for name, blocks in sheets.items()}
    chosen = {name: blocks for name, blocks in with_moduli.items() if blocks} or sheets
    every = [block for blocks in chosen.values() for block in blocks]
    if len(chosen) > 1 and not all(block.states_temperature(layout) for block in every):
        hold = f"{len(chosen)} sheets hold numbers ({', '.join(chosen)})"
        raise unstated(f"{path}: ", "sheet", f" must be given, because {hold}")
    if not every:
        raise FileError(f"{path}: expected {_ROWS}; got none in {len(every_sheet)} sheets")
    return every


# A temperature in the name of a file or a sheet.
_NAMED = re.compile(r"(?<![A-Za-z\d])([-+]?\d+(?:[.,]\d+)?)\s?(?:°|deg)?\s?(C|K|F)(?![A-Za-z\d])")


def _blocks_in(
    path: Path, lines: list[Line], layout: FileLayout, temperature_unit: str | None
) -> list[Block]:
    expected = [column for column in layout.by_quantity.values() if isinstance(column, str)]
    if any(len(text) > _WIDEST for _, text in lines[:_ENOUGH]):
        raise FileError(f"{path}: expected {_ROWS}; got lines of more than {_WIDEST} characters")
    lines, plain = _plain_end(_with_signals(lines))
    lines = [(at, columns.with_logarithms(columns.with_primes(line))) for at, line in lines]
    if lines and _PARAMETERS.fullmatch(lines[0][1]):
        unit = temperature_unit or layout.temperature_unit
        return [_reptate(path, [*lines, *plain], expected, unit)]
    blocks: list[Block] = []
    titles: list[Line] = []
    sections = [lines] if layout.columns else split_blocks(lines)
    if len(sections) > 1 and plain:
        sections, plain = split_blocks([*lines, *plain]), []
    parts = [part for section in sections for part in _parts(section, expected)]
    if plain:
        parts[-1][1].extend(plain)
    for above, rows in parts:
        first = next((n for n, (_, text) in enumerate(above) if _names(text, expected)), None)
        temperature = _temperature_above(path, above, temperature_unit)
        reference = _temperature_above(path, above, None, "reference")
        if first is not None:
            here = [line for line in above[first:] if stated_in(line[1]) is None]
            titles = here or titles
        elif any(_STEP.fullmatch(text.strip()) for _, text in above):
            titles = []  # those of another step are not its own
        whole = [*titles, *rows] if titles else [*above, *rows]
        table = _with_frequency(_table(path, whole, expected), layout, above)
        blocks.append(Block(table, temperature, reference=reference))
    if len(blocks) < 2:
        return blocks or [Block(_table(path, lines, expected))]
    return _sufficient(blocks, layout) or blocks


_SIGNAL = re.compile(r"\s*Sig\d+\s+(.*\S)\s*")


def _with_signals(lines: list[Line]) -> list[Line]:
    """Return lines of TA's Universal Analysis with its signals, one a line, as titles."""
    signals = [match[1] for _, text in lines[:_ENOUGH] if (match := _SIGNAL.fullmatch(text))]
    starts = (at for at, (_, text) in enumerate(lines) if text.strip() == "StartOfData")
    start = next(starts, None) if signals else None
    if start is None:
        return lines
    return [(lines[start][0], "\t".join(signals)), *lines[start + 1 :]]


_PLAIN = "0123456789+-.eE\t;, \r"  # characters of a row of numbers
_WIDEST = 10_000  # characters of a line of moduli; a map has longer ones
_ENOUGH = 400  # lines of a table that tell what it is


def _plain_end(lines: list[Line]) -> tuple[list[Line], list[Line]]:
    """Return lines up to enough rows of the last table, and its other rows of plain numbers.

    No other line is among these: of 1e6 rows each is not looked at for titles.
    """
    first = len(lines)
    while first and not lines[first - 1][1].strip(_PLAIN):
        first -= 1
    return lines[: first + _ENOUGH], lines[first + _ENOUGH :]


def _sufficient(blocks: list[Block], layout: FileLayout) -> list[Block]:
    """Return the tables with frequency and modulus: not steps that condition the sample."""
    sufficient = []
    for block in blocks:
        with suppress(InputError):
            sufficient += [block] if layout.suffices(block.table) else []
    return sufficient


def with_named_temperature(block: Block, name: str, layout: FileLayout) -> Block:
    """Return a block with the temperature in the name of its file, if it states none itself."""
    temperatures = _NAMED.findall(name.replace("_", " "))
    if block.states_temperature(layout) or len(temperatures) != 1:
        return block
    ((number, unit),) = temperatures
    kelvin = quantity_in_si(float(number.replace(",", ".")), unit, "temperature")
    return replace(block, temperature=float(kelvin))


def _parts(lines: list[Line], expected: list[str]) -> Iterator[tuple[list[Line], list[Line]]]:
    """Yield the lines of each table: those above its rows, then the rows and what is among them."""
    above: list[Line] = []
    rows: list[Line] = []
    between: list[Line] = []
    for line in lines:
        # A line below rows that begins with a number is a row with a fault, to be named later.
        first = parse_number(re.split(r"[\t;,\s]", line[1].strip(), maxsplit=1)[0])
        broken = bool(rows) and first is not None and first == first
        if not is_row(line[1]) and not broken:
            between.append(line)
            continue
        begins = any(
            _names(text, expected) or stated_in(text) or _STEP.fullmatch(text.strip())
            for _, text in between
        )
        if rows and begins:
            yield above, rows
            rows = []
        if rows:
            rows += between
        else:
            above = between
        rows.append(line)
        between = []
    if rows:
        yield above, rows


def _names(line: str, expected: list[str]) -> bool:
    """Return whether a line names two of the quantities, or one of the `expected` columns."""
    for separator in ("\t", ";", ",", r"\s{2,}", r"\s+"):
        parts = re.split(separator, line.strip(" #%!"))
        cells = [part.strip().strip('"').strip() for part in parts]
        quantities = {quantity(cell) for cell in cells} - {None}
        if len(quantities) > 1 or any(cell in expected for cell in cells):
            return True
    return False


def _temperature_above(
    path: Path, above: list[Line], unit: str | None, kind: str = "temperature"
) -> float | None:
    """Return the last temperature, or reference, that the lines above a table state [K]."""
    for number, line in reversed(above):
        statement = stated_in(line, kind)
        if statement is None:
            continue
        value, written = statement
        if kind == "reference" and spelled(written, "temperature") is None:
            continue  # t0 may be a time
        chosen = unit if spelled(written, "temperature") is None else written
        if chosen is None:
            why = f"({listed('temperature')}), because the line states none with {value}"
            raise unstated(f"{path}, line {number}: ", "temperature_unit", f" must be given {why}")
        degrees = float(value.replace(",", "."))
        return float(quantity_in_si(degrees, chosen, "temperature", "temperature_unit"))
    return None


def _with_frequency(table: TextTable, layout: FileLayout, above: list[Line]) -> TextTable:
    """Return a table with a column of the frequency that the caller or a line above states."""
    titled = any(quantity(name) == "frequency" for name in table.names)
    with_column = titled or "frequency" in layout.by_quantity
    if layout.frequency is not None and with_column:
        words = " must be left out, because a column holds the frequency of each row"
        raise InputError(Words(f"{table.path}: ", CaseKey("frequency"), words))
    lines = (stated_in(line, "frequency") for _, line in above)
    stating = [(number, unit) for number, unit in filter(None, lines) if spelled(unit, "frequency")]
    if layout.frequency is not None:
        stating = [(str(layout.frequency), "Hz")]
    if with_column or not stating:
        return table
    cell, unit = stating[-1]
    columns = [*table.columns, ColumnTitle("Frequency", unit)]
    cell = cell.replace(",", ".").replace(".", table.decimal)
    return replace(table, columns=columns, rows=[[*row, cell] for row in table.rows])


def _table(path: Path, lines: list[Line], expected: list[str]) -> TextTable:
    table = text_table.table_in(
        path,
        lines,
        _ROWS,
        kinds=KINDS,
        named=lambda name: quantity(name) is not None or name in expected,
    )
    return with_moduli(columns.raised(table))


_HOTTEST = 180.0  # temperature that no rubber is measured at [°C]


def _reptate(path: Path, lines: list[Line], expected: list[str], unit: str | None) -> Block:
    """Return the table of a file of RepTate: the temperature is that of its parameters.

    Its unit is C unless another is stated, which must be where no rubber is that hot.
    """
    pairs = (pair.partition("=") for pair in lines[0][1].split(";"))
    parameters = {key.strip(): value.strip() for key, _, value in pairs}
    celsius = parse_number(parameters.get("T", ""))
    if celsius is None or celsius != celsius:
        raise FileError(
            f"{path}, line {lines[0][0]}: expected T=... in degrees Celsius among the parameters; "
            f"got {parameters.get('T', 'none')}"
        )
    if unit is None and celsius > _HOTTEST:
        words = f" must be given (C or K), because T={parameters['T']} in C is too hot for a rubber"
        raise unstated(f"{path}, line {lines[0][0]}: ", "temperature_unit", words)
    if unit is not None:
        kelvin = quantity_in_si(celsius, unit, "temperature", "temperature_unit")
        celsius = float(kelvin) - ZERO_CELSIUS
    table = _table(path, lines[1:], expected)
    titles = [*table.columns]
    if not table.names:
        titles[: len(_REPTATE)] = _REPTATE[: len(titles)]
    units = {quantity(title.name): title.unit for title in _REPTATE}
    titles = [
        replace(title, unit=title.unit or units.get(quantity(title.name))) for title in titles
    ]
    numbers = {key: number for key, text in parameters.items() if (number := parse_number(text))}
    isofrictional = parameters.get("iso", parameters.get("isof", "true")).lower() == "true"
    shift = _reptate_shift(numbers, celsius, isofrictional)
    return Block(replace(table, columns=titles), celsius + ZERO_CELSIUS, shift)


def _reptate_shift(numbers: Mapping[str, float], celsius: float, isofrictional: bool) -> WLF | None:
    """Return the shift of the parameters of a file of RepTate, None without its constants.

    RepTate states log10 a = -B1 (T - Tr)/((B2 + Tr)(B2 + T)), older versions
    log10 a = -C1 (T - T0)/(C2 + T), with temperatures in degrees Celsius: c2 = B2 + Tr, c1 = B1/c2.
    In the state of equal friction the reference is that of the molar mass,
    Tr - CTg/Mw + 68.7 dx12, and c2 the same (V. A. H. Boudara, D. J. Read, J. Ramirez,
    J. Rheol. 64 (2020) 709, doi:10.1122/8.0000002, and TheoryTTS.py of the program).
    """
    reference = numbers.get("Tr", numbers.get("T0", celsius))
    if "B1" in numbers and "B2" in numbers:
        c2 = numbers["B2"] + reference
        c1 = numbers["B1"] / c2 if c2 else 0.0
    elif "C1" in numbers and "C2" in numbers:
        c1, c2 = numbers["C1"], numbers["C2"] + reference
    else:
        return None
    if min(c1, c2) <= 0.0:
        return None
    if isofrictional and "Mw" in numbers:
        reference += 68.7 * numbers.get("dx12", 0.0) - numbers.get("CTg", 0.0) / numbers["Mw"]
    return WLF(c1, c2, reference + ZERO_CELSIUS)


# Tables side by side.
_MARK = re.compile(
    r"[\s_,@]*(?:\b(?:at|bei)\b)?\s*[(\[]?\s*(?:\b[Tf]\s*=)?\s*(?P<number>[-+]?\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>(?:°|deg\.?)?\s?[CF]|K|[kM]?Hz)\s*"
    r"(?:[)\]](?![A-Za-z])|(?![A-Za-z/]))"
)
_UNIT = re.compile(r"[\[(/]\s*(°?[CFK])\b")
# Separators of cells that may be empty, as those of a line with one mark for each block are.
_SEPARATORS = ("\t", ";", ",")
_MOST_TITLES = 4  # lines above the rows that may hold titles, units and marks
_FEWEST_COLUMNS = 4  # two blocks of two moduli


@dataclass(frozen=True)
class _Column:
    """What the lines above the rows say of a column."""

    name: str  # its title without its mark
    others: list[str]  # the cells above it without title and mark, such as its unit; a line each
    mark: str  # a line that states the temperature or the frequency, or empty

    @classmethod
    def of(cls, titles: list[list[str]], at: int) -> _Column:
        """Return what lines of cells above the rows say of the column `at`."""
        mark, texts = "", []
        for cells in titles:
            plain = all(not cell or is_number(cell) for cell in cells[1:])
            match, text = _MARK.search(cells[at]), cells[at]
            if plain and is_number(text):
                unit = _UNIT.search(cells[0])
                mark, text = f"T = {text} {unit[1] if unit else ''}".strip(), ""
            elif plain and any(cells[1:]):
                text = text if quantity(text) == "frequency" else ""
            elif match is not None:
                kind = "Frequency" if match["unit"].endswith("Hz") else "T"
                mark = f"{kind} = {match['number']} {match['unit'].strip()}"
                text = _MARK.sub("", text, count=1).strip()
            texts.append(text)
        name = next((text for text in texts if quantity(text) is not None), "")
        return cls(name, ["" if text == name else text for text in texts], mark)


def split_blocks(lines: list[Line]) -> list[list[Line]]:
    """Return the lines of each block of tables side by side; the `lines` of any other file."""
    start = _first_row(lines)
    if start is None:
        return [lines]
    first, separator = start
    count = len(cells_of(lines[first][1], separator))
    above = [(number, text.lstrip("#%! ")) for number, text in lines[:first][-_MOST_TITLES:]]
    below = [(number, text) for number, text in lines[first:] if not is_comment(text)]
    table = [
        (number, [*cells_of(text, separator), *[""] * count][:count])
        for number, text in [*above, *below]
        if separator in text
    ]
    titles = [row for row in table if row[0] < lines[first][0]]
    columns = [_Column.of([cells for _, cells in titles], at) for at in range(count)]
    for at in range(1, count):  # one title over the columns of all temperatures
        column, before = columns[at], columns[at - 1]
        if not column.name and column.mark and quantity(before.name) in MODULI:
            columns[at] = _Column(before.name, column.others, column.mark)
    parts = []
    for mark, chosen in _blocks(columns).items():
        names = separator.join(columns[at].name for at in chosen)
        part = [(titles[0][0], mark), (titles[-1][0], names)]
        for level, (number, _) in enumerate(titles):
            part.append((number, separator.join(columns[at].others[level] for at in chosen)))
        for number, cells in table[len(titles) :]:
            part.append((number, separator.join(cells[at] for at in chosen)))
        parts.append(part)
    return parts or [lines]


def _first_row(lines: list[Line]) -> tuple[int, str] | None:
    """Return the index of the first row of numbers, and its separator; None where there is none.

    A line of numbers above titles, or without its first cell, is one of temperatures.
    """
    for at, (_, text) in enumerate(lines):
        for separator in _SEPARATORS:
            cells = cells_of(text, separator)
            enough = len(cells) >= _FEWEST_COLUMNS and bool(cells[0]) and is_row_of(cells)
            if enough and (at + 1 == len(lines) or is_row(lines[at + 1][1])):
                return at, separator
    return None


def _blocks(columns: list[_Column]) -> dict[str, list[int]]:
    """Return the columns of each mark; none unless moduli come again, each with its mark."""
    quantities = [quantity(column.name) for column in columns]
    counts = Counter(quantities)
    marks = [column.mark for column in columns if column.mark]
    repeated = [counts[name] for name in MODULI if counts[name]]
    if len(set(marks)) < 2 or max(repeated, default=0) < 2:
        return {}
    once = set(repeated) == {len(marks)}  # each mark stands once, somewhere over its block
    blocks: dict[str, list[int]] = {mark: [] for mark in marks}
    seen: Counter[str | None] = Counter()
    current = marks[0]
    for at, name in enumerate(quantities):
        current = columns[at].mark or current
        if name in MODULI:
            blocks[marks[seen[name]] if once else current].append(at)
        seen[name] += 1
    for of_rows in ("frequency", "temperature"):
        positions = [at for at, name in enumerate(quantities) if name == of_rows]
        for number, chosen in enumerate(blocks.values()):
            if positions:
                chosen.insert(0, positions[number if len(positions) == len(blocks) else 0])
    return blocks
