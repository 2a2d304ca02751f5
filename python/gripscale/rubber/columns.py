"""Young's moduli of the rows of a table, from what instruments print of them.

The modulus is told by two of E', E'', tan delta and |E*|:

    E'' = E' tan d,   E' = E''/tan d,   E' = |E*|/sqrt(1 + tan^2 d)

A shear modulus becomes the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.checks import shortened
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import ZERO_CELSIUS, in_si, listed, spelled
from gripscale.io.text_table import (
    ColumnTitle,
    Line,
    TextTable,
    is_row,
    parse_number,
    read_lines,
    table_in,
)

# What the titles of master curves and sweeps say, in the English and German of instruments.
#
# | quantity | titles |
# |---|---|
# | temperature | T, Temp., Temperature, Temperatur, Probentemperatur |
# | frequency | f, freq, Frequency, Frequenz, Angular frequency, Kreisfrequenz, omega |
# | storage | E', G', E_stor, Storage modulus, Speichermodul |
# | loss | E'', G'', E", E_loss, Loss modulus, Verlustmodul |
# | loss_factor | tan delta, tan(d), Loss factor, Verlustfaktor, Damping factor |
# | magnitude | E*, G*, |E*|, Complex modulus, Komplexer Modul |
# | strain | Strain, Shear strain, Strain amplitude, Dehnung, Verformung, Deformation, gamma |
#
# Logarithms are none of these.

_PATTERNS = {
    "loss_factor": r"tan\b|tan[\s_(]*(d|δ)|(loss|damping|dissipation) factor|verlustfaktor",
    "temperature": r"temp|(sample|proben)\s*-?temp",
    "frequency": r"omega|.*freq",
    "magnitude": r"\|?[eg]\*|.*complex .*modulus|.*komplexer .*modul",
    "storage": r"[eg]'(?!')|[eg][_ ]?stor|.*\bstor|.*speichermodul",
    "loss": r"[eg]''|[eg][_ ]?loss|.*\bloss|.*verlustmodul",
    "strain": r".*strain\b|.*dehnung|.*verformung|.*deformation|gamma\b|.*scherung",
}
_KNOWN = {name: re.compile(pattern) for name, pattern in _PATTERNS.items()}
_OTHER = re.compile(
    r"log|ln\b|lg\b|eta\b|η|visco|visko|complian|torque|phase|rate\b|static|statisch"
)
_LETTERS = {
    "T": "temperature",
    "f": "frequency",
    "ω": "frequency",
    "w": "frequency",
    "γ": "strain",
}
"""Letters that are a title by themselves: t is a time and F a force."""
_BARE_PRIMES = re.compile(r'(?<!["\w])[EG]"(?=\s*(?:[\t;,(\[/]|\s|$))')
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?"
_STATED = re.compile(
    rf"(?:^|[\s;,#%!])(?:T|Temp\w*|Sample temp\w*|Probentemp\w*)\.?\s*"
    rf"(?:[\[(]\s*(?P<before>[^\])]+)[\])])?\s*[=:;,\t]\s*\"?(?P<number>{_NUMBER})\"?"
    rf"(?:[\t;,]?[ \t]*[\[(]?(?P<after>°?\s?[A-Za-z]+)[\])]?)?\s*(?:$|[;,\t\"])",
    re.IGNORECASE,
)


def quantity(name: str) -> str | None:
    """Return the quantity a column `name` clearly means, else None."""
    text = plain(name)
    if not text[1:2].isalpha() and text[:1] in _LETTERS:
        return _LETTERS[text[0]]
    if len(text) == 1:
        return None
    low = text.lower()
    if _OTHER.search(low):
        return None
    return next((one for one, pattern in _KNOWN.items() if pattern.match(low)), None)


def modulus_kind(name: str) -> str | None:
    """Return `E` or `G` if the column `name` says which modulus it is, else None."""
    text = plain(name)
    found = set()
    if re.search(r"(?<![A-Za-z])E(?![A-Za-z])", text.replace("_", " ")):
        found.add("E")
    if re.search(r"(?<![A-Za-z])G(?![A-Za-z])", text.replace("_", " ")):
        found.add("G")
    if re.search(r"young|tensile", text, re.IGNORECASE):
        found.add("E")
    if re.search(r"shear|schub", text, re.IGNORECASE):
        found.add("G")
    return found.pop() if len(found) == 1 else None


def plain(name: str) -> str:
    """Return the name with one kind of prime, so that E'' can be told from E'."""
    text = name.strip()
    for prime in ("’", "′", "`", "´"):
        text = text.replace(prime, "'")
    return text.replace("″", "''").replace("”", "''").replace('"', "''")


def with_primes(line: str) -> str:
    """Return a line of titles with E'' and G'' where it has E" and G" outside quotation marks."""
    start = 0
    while found := _BARE_PRIMES.search(line, start):
        start = found.end()
        if line.count('"', 0, start) % 2:
            line = f"{line[: start - 1]}''{line[start:]}"
    return line


def stated_temperature(line: str) -> tuple[str, str | None] | None:
    """Return number and unit of the temperature a line above the rows states, such as T = 20 °C.

    The unit is None where the line has none. None if the line states no temperature.
    """
    found = _STATED.search(line.strip())
    if found is None:
        return None
    return found["number"], found["before"] or found["after"]


# What a caller states of a file of moduli: its columns, units and kind of modulus.

MODULI = ("storage", "loss", "loss_factor", "magnitude")
PAIRS = (
    ("storage", "loss"),
    ("storage", "loss_factor"),
    ("loss", "loss_factor"),
    ("magnitude", "loss_factor"),
)
"""Two that tell the modulus, the first choice first."""
QUANTITIES = ("temperature", "frequency", *MODULI)
"""What a column of a file of moduli may hold."""
THREE = ("frequency", "storage", "loss")
"""What three columns without names hold, in this order."""

Columns = Mapping[str, str | int] | Sequence[str | int]
"""Columns by quantity, or three of them; each by its title or its number from 1."""


@dataclass(frozen=True)
class ColumnLayout:
    """What is stated of a file; it goes before its titles, or after them if those come first."""

    columns: Mapping[str, str | int] = field(default_factory=dict)
    """Title or number from 1 of the column of a quantity."""
    units: Mapping[str, str | None] = field(default_factory=dict)
    """Unit of each kind of quantity, None where not stated."""
    modulus: str | None = None
    """E or G."""
    titles_first: bool = False
    """Whether what the titles say goes before what is stated here."""

    @property
    def expected(self) -> list[str]:
        """The titles to look for."""
        return [column for column in self.columns.values() if isinstance(column, str)]

    def in_order(self) -> ColumnLayout:
        """Return the same with frequency, storage and loss in the first three columns."""
        return replace(self, columns={name: at for at, name in enumerate(THREE, start=1)})

    def of(self, table: TextTable) -> ColumnLayout:
        """Return what counts for a table: no columns where its titles come first and name them."""
        if not (self.titles_first and self.columns):
            return self
        titles = replace(self, columns={})
        told = {one for one in QUANTITIES if titles.column(table, one) is not None}
        enough = "frequency" in told and any(told.issuperset(pair) for pair in PAIRS)
        return titles if enough else self

    def column(self, table: TextTable, wanted: str) -> int | None:
        """Return the column of a quantity; None if no title means it and none is stated.

        Raises `InputError` if several titles mean it, or there is no such column.
        """
        if wanted in self.columns:
            return position_of(table, self.columns[wanted])
        taken = {position_of(table, column) for column in self.columns.values()}
        named = [at for at, one in enumerate(table.columns) if quantity(one.name) == wanted]
        hits = [at for at in named if at not in taken]
        first = [row[hits[0]] for row in table.rows] if hits else []
        if any([row[at] for row in table.rows] != first for at in hits[1:]):
            raise InputError(
                f"{table.path}: columns must say which is the {wanted}, because {len(hits)} titles "
                f"mean it ({', '.join(table.columns[at].name for at in hits)})"
            )
        return hits[0] if hits else None

    def unit(self, table: TextTable, chosen: Sequence[int], kind: str) -> str:
        """Return the unit of the `chosen` columns; raise `InputError` if nothing states it."""
        given = self.units.get(kind)
        if given is not None:
            in_si(1.0, given, kind, f"{kind}_unit")
        written = {
            spelled(unit, kind) or unit for unit in (table.columns[at].unit for at in chosen)
        }
        one = next(iter(written)) if len(written) == 1 else None
        known = spelled(one, kind)
        if given is not None and not (self.titles_first and known):
            return given
        if known is None:
            what = "no unit" if one is None else checks.short_repr(one)
            raise InputError(
                f"{table.path}: {kind}_unit must be given ({listed(kind)}), because the header "
                f"states {what if len(written) == 1 else 'different units'}"
            )
        return known

    def modulus_of(self, table: TextTable, chosen: Sequence[int]) -> str:
        """Return E or G, whichever modulus the `chosen` columns hold."""
        given = self.modulus
        if given is not None:
            checks.one_of("modulus", given, ("E", "G"))
        titled = {modulus_kind(table.columns[at].name) for at in chosen}
        one = titled.pop() if len(titled) == 1 else None
        if given is not None and not (self.titles_first and one):
            return given
        if one is None:
            raise InputError(
                f"{table.path}: modulus must be given (E for Young's or G for shear), because the "
                "header does not tell"
            )
        return one


def columns_of(
    columns: Columns | None, quantities: Collection[str] = QUANTITIES
) -> dict[str, str | int]:
    """Return columns by quantity, of a mapping or of three in the order of a master curve.

    Raises `InputError` if they are neither.
    """
    if columns is None:
        return {}
    if isinstance(columns, Mapping):
        checks.allowed_names("quantity in columns", columns, quantities)
        return dict(columns)
    if (
        not isinstance(columns, Sequence)
        or isinstance(columns, str)
        or not all(isinstance(column, str | int) for column in columns)
        or len(columns) != len(THREE)
        or len(set(columns)) != len(THREE)
    ):
        raise InputError(
            "columns must be three different names or numbers from 1 for frequency, storage and "
            f"loss, or map quantities ({', '.join(quantities)}) to them; "
            f"got {checks.short_repr(columns)}"
        )
    return dict(zip(THREE, columns, strict=True))


def position_of(table: TextTable, column: str | int) -> int:
    """Return the position, from 0, of a column given by its number from 1 or by its title."""
    if not isinstance(column, str):
        return checks.counted(f"{table.path}: a column", column, len(table.columns))
    if table.names.count(column) != 1:
        known = table.titles or "no names"
        raise InputError(
            f"{table.path}: columns must be among the header's names ({known}); "
            f"got {checks.short_repr(column)}"
        )
    return table.names.index(column)


def missing(table: TextTable, what: str, argument: str) -> InputError:
    """Return the refusal of a table in which a quantity cannot be found."""
    names = shortened(", ".join(filter(None, table.names)))
    known = f"the header has {names}" if names else "no header"
    return InputError(f"{table.path}: {argument} must give the {what}; {known}")


Array = NDArray[np.float64]

_ROUNDING = 0.05
"""Relative error of a loss factor by the digits it is printed with."""


def young_moduli(
    table: TextTable,
    stated: ColumnLayout,
    numbers: Callable[[TextTable, int, str], Array] | None = None,
) -> tuple[Array, Array]:
    """Return E' and E'' [Pa] of each row.

    `numbers` reads a column of a quantity; by default NaN where a value is missing.

    Raises `InputError` if columns, units or the kind of modulus are not known, or the loss factor
    beside E' and E'' is E'/E''.
    """
    read = above_zero if numbers is None else numbers
    places = {one: stated.column(table, one) for one in MODULI}
    there = {one: at for one, at in places.items() if at is not None}
    pair = next((pair for pair in PAIRS if set(pair) <= set(there)), None)
    if pair is None:
        raise missing(table, "modulus as two of storage, loss, loss_factor, magnitude", "columns")
    in_pascal = [there[one] for one in pair if one != "loss_factor"]
    size = in_si(1.0, stated.unit(table, in_pascal, "modulus"), "modulus")
    size *= 3.0 if stated.modulus_of(table, in_pascal) == "G" else 1.0
    values = {
        one: read(table, there[one], one) * (1.0 if one == "loss_factor" else size) for one in pair
    }
    if pair == ("storage", "loss"):
        _check_factor(table, there, values["storage"], values["loss"])
        return values["storage"], values["loss"]
    factor = values["loss_factor"]
    if "storage" in values:
        return values["storage"], values["storage"] * factor
    if "loss" in values:
        return values["loss"] / factor, values["loss"]
    storage = values["magnitude"] / np.sqrt(1.0 + factor**2)
    return storage, storage * factor


def _check_factor(table: TextTable, there: dict[str, int], storage: Array, loss: Array) -> None:
    """Refuse a table whose loss factor is that of its storage and loss modulus exchanged."""
    if "loss_factor" not in there:
        return
    printed = np.log(np.abs(table.numbers(there["loss_factor"], "a finite number", missing=True)))
    own = np.log(loss / storage)
    known = np.isfinite(printed) & np.isfinite(own)
    if not known.any():
        return
    off, exchanged = (np.median(np.abs(printed + sign * own)[known]) for sign in (-1.0, 1.0))
    if exchanged < _ROUNDING < off:
        raise InputError(
            f"{table.path}: storage and loss modulus look exchanged, because the loss factor of "
            "the file is their quotient the other way round; columns must name them as they are"
        )


def above_zero(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column of numbers above zero, NaN where missing; `FileError` names other lines."""
    values = table.numbers(column, "a finite number", missing=True)
    good = (values >= checks.LEAST) & (values <= checks.MOST)
    span = f"{checks.LEAST:g} to {checks.MOST:g}"
    expected = f"a {wanted.replace('_', ' ')} above zero, {span},"
    check_rows(table, column, good, values, expected)
    return values


def check_rows(
    table: TextTable, column: int, good: NDArray[np.bool_], values: Array, expected: str
) -> None:
    """Raise `FileError`, naming the line, unless all `values` are `good` or missing."""
    bad = ~good & ~np.isnan(values)
    if bad.any():
        at = int(np.argmax(bad))
        raise FileError(
            f"{table.path}, line {table.line_numbers[at]}: expected {expected} in column "
            f"{table.columns[column].name or column + 1}; got {table.rows[at][column]}"
        )


# Tables of one file of moduli: a text or Excel file may hold several, each with its temperature.
#
# Lines that are no rows of numbers part the tables where they hold titles or state a temperature; a
# table without titles has those of the table before. RepTate's files begin with a line of
# parameters such as T=-35;Mw=13.5; where T is in degrees Celsius; without titles their columns are
# angular frequency [rad/s], G' and G'' [Pa].

KINDS = ("temperature", "frequency", "modulus", "strain")
_PARAMETERS = re.compile(r"(?:\s*\w+=[^;=]*;)+\s*")
_REPTATE = (ColumnTitle("frequency", "rad/s"), ColumnTitle("G'", "Pa"), ColumnTitle("G''", "Pa"))


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
        others = [ColumnTitle()] * (len(table.columns) - len(_REPTATE))
        table = replace(table, columns=[*_REPTATE, *others])
    return Block(table, celsius + ZERO_CELSIUS)
