"""A dynamic-mechanical master curve: storage and loss modulus against frequency."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import in_si
from gripscale.io.netcdf import write_whole
from gripscale.io.text_table import TextTable, file_path
from gripscale.rubber.columns import (
    THREE,
    Block,
    ColumnLayout,
    Columns,
    columns_of,
    missing,
    quantity,
    read_blocks,
    young_moduli,
)
from gripscale.rubber.shift import Shift, shift_at

Array = NDArray[np.float64]


@dataclass(frozen=True, init=False, eq=False)
class MasterCurve:
    """Storage and loss modulus in uniaxial deformation, sorted by ascending frequency.

    Parameters
    ----------
    frequency : array_like, shape (rows,)
        Frequency [Hz], above zero, in any order; equal frequencies may occur (overlapping sets).
    storage, loss : array_like, shape (rows,)
        E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], above zero.
    reference_temperature : float, optional
        Temperature the curve holds for [K].
    name, source : str
        What was measured and where the numbers come from.
    shift : Shift, optional
        What the curve becomes at other temperatures; a law without a reference temperature of its
        own takes that of the curve.

    Raises
    ------
    InputError
        If a value is not finite, not positive or beyond 1e-100 to 1e100, the lengths differ or
        there are fewer than 2 rows.
    """

    frequency: Array = field(repr=False)
    storage: Array = field(repr=False)
    loss: Array = field(repr=False)
    reference_temperature: float | None = None
    name: str = ""
    source: str = ""
    shift: Shift | None = field(default=None, repr=False)

    def __init__(
        self,
        frequency: ArrayLike,
        storage: ArrayLike,
        loss: ArrayLike,
        reference_temperature: float | None = None,
        name: str = "",
        source: str = "",
        shift: Shift | None = None,
    ) -> None:
        columns = {
            "frequency": checks.in_limits("frequency", frequency, unit="Hz"),
            "storage": checks.in_limits("storage", storage, unit="Pa"),
            "loss": checks.in_limits("loss", loss, unit="Pa"),
        }
        lengths = [len(column) for column in columns.values()]
        if len(set(lengths)) != 1 or lengths[0] < 2:
            raise InputError(
                "frequency, storage and loss must have the same length of at least 2; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        if reference_temperature is not None:
            reference_temperature = checks.positive(
                "reference_temperature", reference_temperature, unit="K"
            )
        order = np.argsort(columns["frequency"], kind="stable")
        for key, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, key, ordered)
        object.__setattr__(self, "reference_temperature", reference_temperature)
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "source", checks.text("source", source))
        object.__setattr__(self, "shift", shift_at(shift, reference_temperature))

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def angular_frequency(self) -> Array:
        """Angular frequency 2 pi f [rad/s], shape (rows,)."""
        return 2.0 * np.pi * self.frequency

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage

    @property
    def decades(self) -> float:
        """Width of the measured band [decades]."""
        return float(np.log10(self.frequency[-1] / self.frequency[0]))


# Master curves as CSV files that `read_master_curve` reads again.


def write_master_curve(path: str | Path, master: MasterCurve) -> Path:
    """Write a master curve as CSV in Hz and Pa; return the path.

    The reference temperature stands in a comment, for people: whoever reads the file states it.

    Raises `FileError` if the file cannot be written.
    """
    checks.instance("master", master, MasterCurve)
    lines = [f"# {' '.join(text.split())}" for text in (master.name, master.source) if text]
    if master.reference_temperature is not None:
        lines.append(f"# reference temperature (K): {master.reference_temperature:g}")
    lines.append("frequency (Hz),storage modulus E' (Pa),loss modulus E'' (Pa)")
    rows = zip(master.frequency, master.storage, master.loss, strict=True)
    lines += [",".join(repr(float(value)) for value in row) for row in rows]
    text = "\n".join(lines) + "\n"
    return write_whole(file_path(path), lambda part: _write(part, text))


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


# Reading a master curve from a text or Excel file, guessing nothing.
#
# Units and the kind of modulus come from the header or from the caller.

_WHAT = "frequency, storage and loss"
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
    temperature_unit: str | None = None,
    columns: Columns | None = None,
    sheet: str | int | None = None,
    header: int | None = None,
    titles_first: bool = False,
    name: str | None = None,
    source: str = "",
) -> MasterCurve:
    """Read storage and loss modulus against frequency from a text, CSV or Excel file.

    Titles are read in English and German; two of storage modulus, loss modulus, loss factor and
    |E*| tell both moduli. The rules of `gripscale.io.text_table` hold. What the file states need
    not be given; what is given goes before it.

    Parameters
    ----------
    path : str or Path
        The file; Excel: .xlsx.
    frequency_unit : {"Hz", "kHz", "MHz", "GHz", "rad/s"}, optional
        Unit of the frequency column.
    modulus_unit : {"Pa", "kPa", "psi", "MPa", "N/mm2", "GPa", "dyn/cm2"}, optional
        Unit of the moduli.
    modulus : {"E", "G"}, optional
        Whether the file holds Young's or shear moduli (G is multiplied by 3).
    reference_temperature : float, optional
        Temperature the curve holds for [K]; by default what a line above the rows states, such as
        T = 20 °C.
    temperature_unit : {"K", "C", "F"}, optional
        Unit of that temperature, if the line has none.
    columns : sequence of three str or int, or mapping, optional
        Titles, or numbers from 1, of frequency, storage and loss; or a mapping to them from
        `frequency` and two of `storage`, `loss`, `loss_factor` and `magnitude`. Without it,
        recognised titles, or else the order of a file with exactly three columns.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.
    header : int, optional
        Number of lines above the rows, where there are numbers among them.
    titles_first : bool
        Whether what the file states goes before what is given.
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
        If a unit, the kind of modulus or the columns are neither stated nor given, or storage and
        loss are exchanged.
    """
    place = file_path(path)
    units = {"frequency": frequency_unit, "modulus": modulus_unit}
    stated = ColumnLayout(columns_of(columns), units, modulus, titles_first)
    unit = temperature_unit
    if reference_temperature is not None and unit is None:
        unit = "K"  # a temperature is given: that of the file decides nothing
    blocks = read_blocks(
        place, sheet=sheet, header=header, expected=stated.expected, temperature_unit=unit
    )
    table = _one(blocks)
    if not table.names and len(table.columns) == len(THREE) and not stated.columns:
        stated = stated.in_order()
    stated = stated.of(table)
    frequency = stated.column(table, "frequency")
    if frequency is None:
        raise missing(table, "frequency", "columns")
    _refuse_sweeps(table, frequency, named=bool(stated.columns))
    hertz = stated.unit(table, [frequency], "frequency")
    storage, loss = young_moduli(table, stated, _positive)
    return MasterCurve(
        in_si(_positive(table, frequency, "frequency"), hertz, "frequency"),
        storage,
        loss,
        reference_temperature=_reference(blocks[0], reference_temperature, stated),
        name=place.stem if name is None else name,
        source=source,
    )


def _one(blocks: list[Block]) -> TextTable:
    """Return the one table of a file."""
    table = blocks[0].table
    if len(blocks) > 1:
        raise FileError(
            f"{table.path}: expected one master curve; got {len(blocks)} tables, the second from "
            f"line {blocks[1].table.line_numbers[0]} on"
        )
    if len(table.columns) < len(THREE):
        raise FileError(
            f"{table.path}, line {table.line_numbers[0]}: expected at least 3 columns "
            f"(frequency, storage, loss); got {len(table.columns)}"
        )
    if len(table.rows) < _FEWEST_ROWS:
        raise FileError(
            f"{table.path}: expected at least {_FEWEST_ROWS} rows of {_WHAT}; got {len(table.rows)}"
        )
    return table


def _reference(block: Block, given: float | None, stated: ColumnLayout) -> float | None:
    """Return the temperature the curve holds for [K], if it is known."""
    if given is None or (stated.titles_first and block.temperature is not None):
        return block.temperature
    return given


def _refuse_sweeps(table: TextTable, frequency: int, *, named: bool) -> None:
    """Raise `FileError` if the rows are sweeps at several temperatures and no master curve.

    A shifted curve may still tell at what temperature each row was measured. Its frequencies do not
    repeat from one to the next, and the caller has `named` the columns.
    """
    for column, title in enumerate(table.columns):
        if quantity(title.name) != "temperature":
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
                "columns if they are shifted"
            )


def _positive(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column whose numbers are all there, above zero and within reason."""
    what = wanted.replace("_", " ")
    within = f"a {what} between {checks.LEAST:g} and {checks.MOST:g}"
    values = table.numbers(column, within)
    for number, value in zip(table.line_numbers, values, strict=True):
        if value < checks.LEAST:
            expected = within if value > 0.0 else f"a {what} above zero"
            raise FileError(f"{table.path}, line {number}: expected {expected}; got {value:g}")
    return values
