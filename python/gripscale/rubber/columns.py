"""Tables of moduli as instruments print them: what their titles mean, and Young's moduli of rows.

Titles are read in several languages (docs/temperature.md lists the English and German ones). A
logarithm of one, such as log f or log10(E'/Pa), is raised again, and the a_T of a shifted frequency
is no part of its title. Two of E', E'', |E*| and tan delta, or the angle delta, state the modulus:

    E'' = E' tan d,   E' = E''/tan d,   E' = |E*|/sqrt(1 + tan^2 d)

An angular frequency without a unit, or in 1/s, is in rad/s. Rows whose frequency or modulus is zero
or less, up to a tenth of them, count as missing: faults of a measurement, not of the columns. A
shear modulus becomes the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from gripscale.core import Array, CaseKey, FileError, InputError, Mask, Words, checks, unstated
from gripscale.core.checks import Checked, checked, shortened
from gripscale.core.units import UNITS, listed, quantity_in_si, spelled
from gripscale.io.text_table import ColumnTitle, TextTable

_TITLES = {
    "loss_factor": r"tan\b|tan[\s_(]*(d|δ)|(loss|damping|dissipation) factor|verlustfaktor"
    r"|facteur de (perte|dissipation|amort)|损耗因子|損失正接",
    "temperature": r"t[eé]mp(?!s\b)|(sample|proben)\s*-?temp|ts$|温度|試料温度",
    "frequency": r"omega|.*(freq|fr[eé]qu|frecu)|pulsation|częstot|част|주파수|角?频率|角?周波数",
    "magnitude": r"\|?[egm]\*|.*(complex .*modulus|komplexer .*modul|module? complex)|复数?模量",
    "storage": r"(modul\w* )?[egm]'(?!')|re(al)? ?\([eg]\b|real (part|modulus)"
    r"|[eg][_ ]?p(rime)?\b|[eg][_ ]?stor|.*\bstor|.*speichermodul|.*elastic component"
    r"|m[oó]dul[eo] (de |d['’]|di )?(stockage|conserva|a(lm|rm)a[cz]ena|accumul|[eé]lasti)"
    r"|.*(zachowaw|opslagmod|lagringsmod|накопл)|저장|(储能|存储|储存)模量|貯蔵.*率",
    "loss": r"(modul\w* )?[egm]''|im(ag)? ?\([eg]\b|imag\w* (part|modulus)"
    r"|[eg][_ ]?(pp|double[ _-]?prime)\b|[eg][_ ]?loss|.*\bloss|.*verlustmodul"
    r"|.*(viscous component|stratno|verliesmod|f[öo]rlustmod|потерь)|손실"
    r"|m[oó]dul[eo] .*(perte|p[eé]rdi|perda|dissipa|visqueux|viscos)|损耗模量|損失.*率",
    "strain": r".*(strain\b|dehn(ung|\.|\b)|verformung|d[eé]formation|scherung)|[ds]sa\b"
    r"|gamma\b|应变",
}
_KINDS = {
    "E": re.compile(r"(?<![A-Za-z])E(?![A-Za-z])|(?i:young|tensile)"),
    "G": re.compile(r"(?<![A-Za-z])G(?![A-Za-z])|(?i:shear|schub)"),
}
# A logarithm in a line of titles: log f, log10(E'/Pa).
_LOGARITHM = re.compile(
    r"(?<![A-Za-z])(log10|log|lg|ln)(?:[\s_]*\(([^()]*)\)|[\s_]+(?=[A-Za-zωγ|]))", re.IGNORECASE
)
_RAISED = re.compile(r"(log10|ln)_(.*)")
_SHIFTED = re.compile(r"^a_?T[\s·*.×]*(?=[fωwo])")
# A symbol before what it stands for: f = storage over its small-strain value.
_SYMBOL = re.compile(r"^\w{1,2}'*\s*=\s*(?=[A-Za-z])")
_OTHER = re.compile(
    r"log|spatial|spectr|stat\b"
    r"|ln\b|lg\b|eta\b|η|visco(?!us comp)|visko|complian|torque|phase|rate\b|static|statisch"
)
_COMPLIANCE = re.compile(r"[JD]['’′″\"]|[JD]\(t|.*(complian|nachgieb)", re.IGNORECASE)
_RELAXATION = re.compile(r"[EG]\s*\(t|.*relax\w* ?mod", re.IGNORECASE)
_ANGULAR = re.compile(r"omega|ω|angular|kreis|pulsation|角|ang\.? ?freq", re.IGNORECASE)
# A frequency in words that mean either kind: 1/s of an angular one is rad/s.
_PER_SECOND = re.compile(r"(1/s(ec)?|s\^?-1|s⁻¹)", re.IGNORECASE)
_PHASE = re.compile(
    r"delta|δ|phase([ _-]?angle)?|loss[ _-]?angle|(phasen|verlust)winkel", re.IGNORECASE
)
# Letters that are a title by themselves: t is a time and F a force.
_LETTERS = {"T": "temperature", "f": "frequency", "ω": "frequency", "w": "frequency", "γ": "strain"}
_BAREPRIMES = re.compile(r'(?<!["\w])[EG]"(?=\s*(?:[\t;,(\[/]|\s|$))')
PRIMES = str.maketrans(dict.fromkeys("’′`´", "'") | dict.fromkeys('″”"', "''"))
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?"
# Before a temperature, words by which it is not that of the rows.
_OTHERS = ("reference", "ref.", "room", "ambient", "transition", "lab", "start", "end", "cure")
_NOT_BEHIND = "".join(rf"(?<!\b{re.escape(word)}\s)" for word in _OTHERS)
# A line that states the temperature or the frequency of the rows below it, or what a curve holds
# for.
_STATED = {
    kind: re.compile(
        rf"(?:^|[\s;,#%!]){'' if kind == 'reference' else _NOT_BEHIND}(?:{names})\.?\s*"
        rf"(?:[\[(]\s*(?P<before>[^\])]+)[\])])?\s*[=:;,\t]\s*\"?(?P<number>{_NUMBER})\"?"
        rf"(?:[\t;,]?[ \t]*[\[(]?(?P<after>°?\s?[A-Za-z]+(?:/s)?)[\])]?)?\s*(?:$|[;,\t\"])",
        re.IGNORECASE,
    )
    for kind, names in {
        "temperature": r"T|Temp\w*|Sample temp\w*|Probentemp\w*",
        "reference": r"T_?(?:0|ref|r)|(?:Reference|Ref\.|Referenz-?|Bezugs-?)\s*temp\w*",
        "frequency": r"f|Freq\w*|Test freq\w*|Messfreq\w*|Prüffreq\w*",
    }.items()
}


def quantity(name: str) -> str | None:
    """Return the quantity a column `name` clearly means, else None."""
    text = _SYMBOL.sub("", _SHIFTED.sub("", name.strip().translate(PRIMES)))
    if logarithm := _RAISED.fullmatch(text):
        return quantity(logarithm[2])
    if _PHASE.fullmatch(text):
        return "phase"
    if not text[1:2].isalpha() and text[:1] in _LETTERS:
        return _LETTERS[text[0]]
    if len(text) == 1:
        return None
    low = text.lower()
    if _OTHER.search(low):
        return None
    return next((meaning for meaning, pattern in _TITLES.items() if re.match(pattern, low)), None)


def modulus_kind(name: str) -> str | None:
    """Return `E` or `G` if the column `name` says which modulus it is, else None."""
    kinds = [kind for kind, pattern in _KINDS.items() if pattern.search(name)]
    return kinds[0] if len(kinds) == 1 else None


def with_primes(line: str) -> str:
    """Return a line of titles with E'' and G'' where it has E" and G" outside quotation marks."""
    start = 0
    while match := _BAREPRIMES.search(line, start):
        start = match.end()
        if line.count('"', 0, start) % 2:
            line = f"{line[: start - 1]}''{line[start:]}"
    return line


def with_logarithms(line: str) -> str:
    """Return a line of titles with its logarithms as one word each: log10_f/Hz, ln_E'/Pa."""

    def word(match: re.Match[str]) -> str:
        return f"{'ln' if match[1].lower() == 'ln' else 'log10'}_{match[2] or ''}"

    return _LOGARITHM.sub(word, line)


def with_numbers(table: TextTable, at: int, title: ColumnTitle, numbers: Array) -> TextTable:
    """Return a table with other numbers, and another title, in a column."""
    cells = (repr(float(number)).replace(".", table.decimal) for number in numbers)
    rows = [[*row[:at], cell, *row[at + 1 :]] for row, cell in zip(table.rows, cells, strict=True)]
    columns = [*table.columns[:at], title, *table.columns[at + 1 :]]
    return replace(table, columns=columns, rows=rows)


def raised(table: TextTable) -> TextTable:
    """Return a table with the numbers in place of their logarithms."""
    for at, title in enumerate(table.columns):
        logarithm = _RAISED.fullmatch(title.name)
        if logarithm is not None and quantity(title.name) is not None:
            base = math.e if logarithm[1] == "ln" else 10.0
            exponents = table.numbers(at, "the logarithm of a number", missing=True)
            with np.errstate(over="ignore"):
                numbers = base**exponents
            table = with_numbers(table, at, replace(title, name=logarithm[2]), numbers)
    return table


def stated_in(line: str, kind: str = "temperature") -> tuple[str, str | None] | None:
    """Return number and unit, if any, of what a line states, such as T = 20 °C or f = 10 Hz."""
    match = _STATED[kind].search(line.strip())
    return None if match is None else (match["number"], match["before"] or match["after"])


def unit_in(title: ColumnTitle, kind: str) -> str | None:
    """Return the unit of a kind that a title states or means, in its usual spelling, or None."""
    if kind != "frequency" or not (title.unit is None or _PER_SECOND.fullmatch(title.unit)):
        return spelled(title.unit, kind)
    angular = _ANGULAR.search(title.name) or title.name in ("w", "W")
    return "rad/s" if angular else title.unit and "Hz"


MODULI = ("storage", "loss", "loss_factor", "magnitude", "phase")
RATIOS = ("loss_factor", "phase")  # those without the unit of a modulus
# Two that state the modulus, the first choice first.
_WITH_RATIO = [(name, ratio) for ratio in RATIOS for name in ("storage", "loss", "magnitude")]
PAIRS = (("storage", "loss"), *_WITH_RATIO)
_QUANTITIES = ("temperature", "frequency", *MODULI, "strain")
THREE = ("frequency", "storage", "loss")  # what three columns without names hold, in this order
_Columns = Mapping[str, str | int] | Sequence[str | int]


def unit_name(name: str, value: object) -> str:
    """Return a unit; raise `InputError` unless it is one of the kind `name` says: `strain_unit`."""
    quantity_in_si(1.0, value, name.removesuffix("_unit"), name)  # type: ignore[arg-type]
    return str(value)


class FileLayout(Checked):
    """Where the numbers of a file of moduli stand and what they are, as far as a caller states it.

    What the file says itself need not be stated; what is stated goes before it.
    """

    columns: _Columns | None = None
    """Titles, or numbers from 1, of frequency, storage and loss; or a mapping to them from
    `frequency`, `temperature`, `strain` and two of `storage`, `loss`, `loss_factor` and
    `magnitude`. Without it recognised titles count."""
    sheet: str | int | None = None
    """Name of the Excel sheet or its number from 1, where several hold numbers."""
    header: int | None = None
    """Number of lines above the rows, where there are numbers among them."""
    frequency_unit: str | None = checked(unit_name, default=None)
    """Unit of the frequencies: Hz, kHz, MHz, GHz or rad/s."""
    modulus_unit: str | None = checked(unit_name, default=None)
    """Unit of the moduli: Pa, kPa, psi, MPa, N/mm2, GPa or dyn/cm2."""
    temperature_unit: str | None = checked(unit_name, default=None)
    """Unit of the temperatures: K, C or F."""
    strain_unit: str | None = checked(unit_name, default=None)
    """Unit of the strains: 1 or %."""
    modulus: str | None = checked(checks.one_of, choices=("E", "G"), default=None)
    """Whether they are Young's (E) or shear moduli (G, multiplied by 3)."""
    frequency: Any = checked(checks.positive, unit="Hz", default=None)
    """Frequency of all rows, as of a temperature ramp, where no column holds it: a number [Hz], or
    a text such as "10 Hz"."""
    titles_first: bool = False
    """Whether what the file says goes before what is stated here."""

    @property
    def by_quantity(self) -> Mapping[str, str | int]:
        """Title or number of the column of each quantity; `InputError` for other `columns`."""
        columns = self.columns
        if columns is None:
            return {}
        if isinstance(columns, Mapping):
            checks.allowed_names("quantity in columns", columns, _QUANTITIES)
            return columns
        if (
            not isinstance(columns, Sequence)
            or isinstance(columns, str)
            or not all(isinstance(column, str | int) for column in columns)
            or not len(columns) == len(set(columns)) == len(THREE)
        ):
            raise InputError(
                "columns must be three different names or numbers from 1 for frequency, storage "
                f"and loss, or map quantities ({', '.join(_QUANTITIES)}) to them; "
                f"got {checks.short_repr(columns)}"
            )
        return dict(zip(THREE, columns, strict=True))

    def for_table(self, table: TextTable) -> FileLayout:
        """Return the layout of one table: without columns where its titles count and suffice."""
        titles = replace(self, columns=None)
        count = self.titles_first and self.columns and titles.suffices(table)
        return titles if count else self

    def suffices(self, table: TextTable) -> bool:
        """Return whether frequency and modulus are in a table; `InputError` as `column`."""
        quantities = {name for name in _QUANTITIES if self.column(table, name) is not None}
        return "frequency" in quantities and any(quantities.issuperset(pair) for pair in PAIRS)

    def column(self, table: TextTable, wanted: str) -> int | None:
        """Return the column of a quantity, or None; `InputError` if several titles mean it."""
        columns = self.by_quantity
        if wanted in columns:
            return position_of(table, columns[wanted])
        taken = {position_of(table, column) for column in columns.values()}
        titled = [at for at, title in enumerate(table.columns) if quantity(title.name) == wanted]
        hits = [at for at in titled if at not in taken]
        kind = "modulus" if wanted in MODULI and wanted not in RATIOS else wanted
        if kind in UNITS:  # a force F and a frequency f are told apart by their units
            named = [at for at in hits if unit_in(table.columns[at], kind)]
            hits = [at for at in hits if at in named or not table.columns[at].unit] or hits
        if not all(_agree(table, hits[0], at) for at in hits[1:]):
            titles = shortened(", ".join(table.columns[at].name for at in hits))
            why = f"because {len(hits)} titles mean it ({titles})"
            raise unstated(f"{table.path}: ", "columns", f" must say which is the {wanted}, {why}")
        return hits[0] if hits else None

    def needed_column(self, table: TextTable, wanted: str) -> int:
        """Return the column of a quantity; raise `InputError` for none."""
        column = self.column(table, wanted)
        if column is None:
            raise missing(table, wanted)
        return column

    def read(self, table: TextTable, wanted: str) -> Array:
        """Return a column in SI units, of a quantity that must be there; as `young_moduli`."""
        column = self.needed_column(table, wanted)
        values = above_zero(table, column, wanted)
        return np.asarray(quantity_in_si(values, self.unit(table, column, wanted), wanted))

    def unit(self, table: TextTable, column: int, kind: str) -> str:
        """Return the unit of a column; raise `InputError` if nothing states it."""
        chosen_unit: str | None = getattr(self, f"{kind}_unit")
        header = table.columns[column].unit
        unit = unit_in(table.columns[column], kind)
        if chosen_unit is not None and not (self.titles_first and unit):
            return chosen_unit
        if unit is None:
            what = "no unit" if header is None else f"the unknown unit {checks.short_repr(header)}"
            title = shortened(table.columns[column].name) or f"column {column + 1}"
            why = f" must be given ({listed(kind)}), because the header states {what} of {title}"
            words = Words(f"{table.path}: ", CaseKey(f"{kind}_unit"), why)
            # not `missing` where a unit is stated: it is never proposed over
            raise InputError(words, missing="" if header else f"{kind}_unit")
        return unit

    def modulus_of(self, table: TextTable, chosen: Sequence[int]) -> str:
        """Return E or G, whichever modulus the `chosen` columns hold."""
        titled = {modulus_kind(table.columns[at].name) for at in chosen}
        title = titled.pop() if len(titled) == 1 else None
        if self.modulus is not None and not (self.titles_first and title):
            return self.modulus
        if title is None:
            why = "(E for Young's or G for shear), because the header does not tell"
            raise unstated(f"{table.path}: ", "modulus", f" must be given {why}")
        return title


def _agree(table: TextTable, first: int, second: int) -> bool:
    """Return whether two columns hold the same, frequencies perhaps in Hz and in rad/s."""
    if all(row[first] == row[second] for row in table.rows):
        return True
    units = [unit_in(table.columns[at], "frequency") for at in (first, second)]
    if None in units:
        return False
    one_way, other = (
        quantity_in_si(table.numbers(at, "a number", missing=True), str(unit), "frequency")
        for at, unit in zip((first, second), units, strict=True)
    )
    return bool(np.allclose(one_way, other, rtol=_SAME_FREQUENCY, atol=0.0, equal_nan=True))


def position_of(table: TextTable, column: str | int) -> int:
    """Return the position, from 0, of a column given by its number from 1 or by its title."""
    if not isinstance(column, str):
        # columns of words before the first one with numbers count, too
        last = table.empty + len(table.columns)
        position = checks.counted(f"{table.path}: a column", column, last) - table.empty
        if position < 0:
            raise InputError(f"{table.path}: column {column} holds no numbers")
        return position
    if table.names.count(column) != 1:
        names = f" must be among the header's names ({table.titles or 'no names'}); got "
        got = f"{names}{checks.short_repr(column)}"
        raise InputError(Words(f"{table.path}: ", CaseKey("columns"), got))
    return table.names.index(column)


def missing(table: TextTable, what: str) -> InputError:
    """Return the refusal of a table in which a quantity cannot be found."""
    names = shortened(", ".join(filter(None, table.names)))
    header = f"the header has {names}" if names else "no header"
    if any(_COMPLIANCE.match(name) for name in table.names):
        header += "; of compliances J' and J'' or D' and D'' by frequency are read"
    words = Words(f"{table.path}: ", CaseKey("columns"), f" must give the {what}; {header}")
    if what != "frequency" or all(quantity(name) != "temperature" for name in table.names):
        return InputError(words, missing="columns")
    key, where = CaseKey("frequency"), "; where all rows are at the same frequency, "
    return InputError(Words(words, where, key, ' states it, such as "10 Hz"'), missing="frequency")


def other_content(table: TextTable) -> str:
    """Return what a table with too few columns for moduli holds, in words; empty if unknown."""
    if any(_COMPLIANCE.match(name) for name in table.names):
        return f"a compliance ({table.titles}): creep is not read, sweeps are"
    if any(_RELAXATION.match(name) for name in table.names):
        return f"a relaxation modulus ({table.titles}): a Prony list and sweeps are read"
    if any(quantity(name) == "loss_factor" for name in table.names):
        return f"the loss factor alone ({table.titles}): a modulus is needed, too"
    return ""


_ROUNDING = 0.05  # relative error of a loss factor by the digits it is printed with


def young_moduli(table: TextTable, layout: FileLayout) -> tuple[Array, Array]:
    """Return E' and E'' [Pa] of each row, NaN where a value is missing."""
    positions = {name: layout.column(table, name) for name in MODULI}
    at = {name: position for name, position in positions.items() if position is not None}
    pair = next((pair for pair in PAIRS if set(pair) <= set(at)), None)
    if pair is None:
        raise missing(table, f"modulus as two of {', '.join(MODULI)}")
    moduli = [name for name in pair if name not in RATIOS]
    units = {name: layout.unit(table, at[name], "modulus") for name in moduli}
    size = 3.0 if layout.modulus_of(table, [at[name] for name in moduli]) == "G" else 1.0
    values = {
        name: size * quantity_in_si(above_zero(table, at[name], name), unit, "modulus")
        for name, unit in units.items()
    }
    if pair == ("storage", "loss"):
        if "loss_factor" in at:
            printed = table.numbers(at["loss_factor"], "a finite number", missing=True)
            printed *= _ratio_unit(table, at["loss_factor"])
            _refuse_swapped(table, values["loss"] / values["storage"], printed)
        return values["storage"], values["loss"]
    factor = _loss_factor(table, at[pair[1]], pair[1])
    if "storage" in values:
        return values["storage"], values["storage"] * factor
    if "loss" in values:
        return values["loss"] / factor, values["loss"]
    storage = values["magnitude"] / np.sqrt(1.0 + factor**2)
    return storage, storage * factor


def _loss_factor(table: TextTable, column: int, name: str) -> Array:
    """Return the loss factor [-] of a column that holds it, or the angle between E' and E''."""
    values, title = above_zero(table, column, name), table.columns[column]
    if name == "loss_factor":
        return values * _ratio_unit(table, column)
    if spelled(title.unit, "angle") is None:
        raise InputError(
            f"{table.path}: the title of a phase angle must state its unit ({listed('angle')}), "
            f"such as {title.name or 'delta'} (deg); got {title.unit or 'none'}"
        )
    angle = np.asarray(quantity_in_si(values, str(title.unit), "angle"))
    check_rows(table, column, angle < 0.5 * math.pi, values, "a phase angle below 90 degrees")
    return np.tan(angle)


def _ratio_unit(table: TextTable, column: int) -> float:
    """Return the size of the unit of a loss factor: that of %, or 1."""
    return quantity_in_si(1.0, spelled(table.columns[column].unit, "strain") or "1", "strain")


def _refuse_swapped(table: TextTable, quotient: Array, printed: Array) -> None:
    """Refuse a table whose printed loss factor is that of its moduli the other way round."""
    computed, factor = np.log(quotient), np.log(np.abs(printed))
    both = np.isfinite(factor) & np.isfinite(computed)
    if not both.any():
        return
    as_named, swapped = (np.median(np.abs(factor + sign * computed)[both]) for sign in (-1.0, 1.0))
    if swapped < _ROUNDING < as_named:
        raise InputError(
            f"{table.path}: storage and loss modulus look exchanged, because the loss factor of "
            "the file is storage over loss; columns must name them in their order",
            missing="columns",
        )


# Frequencies that differ by less than this share, temperatures by less than this [K], are one.
_SAME_FREQUENCY, _SAME_TEMPERATURE = 0.01, 0.2
# Ratio of moduli measured twice that no scatter explains: ten per cent of noise makes 1.3.
APART = 1.5
# Conditions measured over those that come again, at most, in a table that repeats itself.
_OFTEN = 3


def spread_of_repeats(frequency: Array, storage: Array, loss: Array, temperature: Array) -> float:
    """Return by which factor E' or E'' of one frequency and temperature differ, in the median."""
    conditions = np.round([np.log(frequency) / _SAME_FREQUENCY, temperature / _SAME_TEMPERATURE])
    pairs = conditions[0] + 1j * conditions[1]
    _, row, count = np.unique(pairs, return_inverse=True, return_counts=True)
    again = count > 1
    if not again.sum() >= max(2.0, len(count) / _OFTEN):
        return 1.0
    spreads = np.ones((2, len(count)))
    for modulus, spread in zip((storage, loss), spreads, strict=True):
        low, high = np.full(len(count), np.inf), np.zeros(len(count))
        np.minimum.at(low, row, modulus)
        np.maximum.at(high, row, modulus)
        spread[:] = high / low
    return float(np.median(spreads.max(axis=0)[again]))


def above_zero(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column of numbers above zero, NaN where missing; `FileError` names other lines."""
    what = f"a {wanted.replace('_', ' ')}"
    within = f"{what} between {checks.LEAST:g} and {checks.MOST:g}"
    values = table.numbers(column, within, missing=True)
    faults = values <= 0.0
    if faults.sum() > _FEW * len(values):
        check_rows(table, column, ~faults, values, f"{what} above zero")
    values = np.where(faults, np.nan, values)
    check_rows(table, column, values >= checks.LEAST, values, within)
    return values


_FEW = 0.1  # share of rows with a value of zero or less that are left out as faults


def notes_of_faults(table: TextTable, layout: FileLayout) -> list[str]:
    """Return a note of the rows that are left out because a value is zero or less."""
    names = ("frequency", *(name for name in MODULI if name not in RATIOS))
    faults = np.zeros(len(table.rows), dtype=bool)
    for name in names:
        if (column := layout.column(table, name)) is not None:
            faults |= table.numbers(column, "a number", missing=True) <= 0.0
    lines = [str(table.line_numbers[at]) for at in np.flatnonzero(faults)]
    if not lines:
        return []
    where = f"line{'s' * (len(lines) > 1)} {', '.join(lines[:4])}{', ...' * (len(lines) > 4)}"
    return [f"{len(lines)} of {len(faults)} rows left out, a value is zero or less ({where})"]


def check_rows(table: TextTable, column: int, good: Mask, values: Array, expected: str) -> None:
    """Raise `FileError`, naming the line, unless all `values` are `good` or missing."""
    bad = ~good & ~np.isnan(values)
    if bad.any():
        at = int(np.argmax(bad))
        raise FileError(
            f"{table.path}, line {table.line_numbers[at]}: expected {expected} in column "
            f"{table.label(column)}; got {table.rows[at][column]}"
        )
