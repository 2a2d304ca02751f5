"""A dynamic-mechanical master curve: storage and loss modulus against frequency; its files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import gripscale
from gripscale.core import Checked, FileError, Pictured, checked, checks, shown_value
from gripscale.core.arrays import Array, Quantity, Vector
from gripscale.core.units import UNITS, quantity_in_si, spelled
from gripscale.io.folders import write_text
from gripscale.io.text_table import TextTable, file_path
from gripscale.rubber import columns
from gripscale.rubber.blocks import read_blocks
from gripscale.rubber.columns import APART, THREE, FileLayout
from gripscale.rubber.shift import Shift, shift_at, shown_state
from gripscale.rubber.sweeps import thinned

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class MasterCurve(Checked, Pictured, eq=False):
    """Storage and loss modulus in uniaxial deformation, sorted by ascending frequency.

    Raises `InputError` if a value is not finite, not positive or beyond 1e-100 to 1e100, the
    lengths differ or there are fewer than 2 rows.

        >>> gs.MasterCurve(["1 Hz", "10 Hz"], ["5 MPa", "8 MPa"], ["1 MPa", "2 MPa"]).loss_factor
        array([0.2 , 0.25])
    """

    frequency: Vector = checked(checks.positive_vector, unit="Hz", repr=False)
    """Frequency [Hz], shape (rows,), in any order; it may repeat where sets overlap."""
    storage: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    loss: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    """E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], shape (rows,)."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Temperature the curve holds for [K]."""
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What was measured, and where the numbers come from."""
    shift: Shift | None = field(default=None, repr=False)
    """What the curve becomes at other temperatures; a law may take its temperature."""
    notes: tuple[str, ...] = field(default=(), repr=False)
    """What was done to the rows of its file, such as rows left out."""

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = {name: getattr(self, name) for name in THREE}
        checks.same_length(2, **columns)
        order = np.argsort(self.frequency, kind="stable")
        self._set(**{name: column[order] for name, column in columns.items()})
        self._set(shift=shift_at(self.shift, self.reference_temperature))

    def __len__(self) -> int:
        return len(self.frequency)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield name, ranges of frequency, moduli and loss factor, and temperature."""
        yield "name", self.name or "unnamed"
        yield "frequency", f"{shown_value(self.frequency, 'Hz')}, {self.decades:.1f} decades"
        yield "E'", shown_value(self.storage, "Pa")
        yield "E''", shown_value(self.loss, "Pa")
        yield "tan delta", shown_value(self.loss_factor)
        yield from shown_state(self)

    def plot(self) -> Figure:
        """Draw both moduli and the loss factor by frequency as measured."""
        return gripscale.questions.measured_moduli_figure(self)

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


MODULI_TITLES = ("frequency (Hz)", "storage modulus E' (Pa)", "loss modulus E'' (Pa)")


def write_master_curve(path: str | Path, master: MasterCurve) -> Path:
    """Write a master curve as CSV in Hz and Pa; return the path.

    The reference temperature stands in a comment, for people: whoever reads the file states it.
    Raises `FileError` if the file cannot be written.
    """
    checks.instance("master", master, MasterCurve)
    lines = [f"# {' '.join(text.split())}" for text in (master.name, master.source) if text]
    if master.reference_temperature is not None:
        lines.append(f"# reference temperature (K): {master.reference_temperature:g}")
    lines.append(",".join(MODULI_TITLES))
    rows = zip(master.frequency, master.storage, master.loss, strict=True)
    lines += [",".join(repr(float(value)) for value in row) for row in rows]
    return write_text(file_path(path), "\n".join([*lines, ""]))


_ONE_TEMPERATURE = 2.0  # temperatures this close [K] are one: no oven is quieter
_TWO_ROWS = "expected at least 2 rows of frequency, storage and loss"


def read_master_curve(
    path: str | Path,
    *,
    modulus: str | None = None,
    reference_temperature: Quantity | None = None,
    name: str | None = None,
    source: str = "",
    **options: Any,
) -> MasterCurve:
    """Read storage and loss modulus against frequency from a text, CSV or Excel file.

    Rows with a missing value in a column that is needed are left out. Titles are read in English
    and German; two of storage modulus, loss modulus, loss factor and |E*| state both moduli. The
    rules of `gripscale.io.text_table` hold. What the file states need not be given; what is given
    goes before it. Nothing is guessed. Raises `FileError` if the file cannot be read or holds
    something else, such as sweeps at several temperatures; the message names path and line. Raises
    `InputError` if a unit, the kind of modulus or the columns are neither stated nor given, or
    storage and loss are exchanged.

        >>> gs.read_master_curve("dma.txt", reference_temperature="20 C").decades
        10.0

    Parameters
    ----------
    path : str or Path
        The file; Excel: .xlsx.
    modulus : {"E", "G"}, optional
        Whether the file holds Young's or shear moduli; needed unless its titles say so.
    reference_temperature : float, optional
        Temperature the curve holds for [K]; by default what a line above the rows states, such as
        T = 20 °C, or a column that holds one temperature.
    name, source : str, optional
        Carried along; the file's stem by default, and nothing.
    **options
        `columns`, `sheet`, `header`, `frequency_unit`, `modulus_unit`, `temperature_unit` and
        `titles_first`, as fields of `gripscale.rubber.FileLayout`. Without `columns`
        three columns without titles are frequency, storage and loss.
    """
    file, layout = file_path(path), FileLayout(modulus=modulus, **options)
    unit = layout.temperature_unit
    if reference_temperature is not None and unit is None:
        unit = "K"  # a temperature is given: that of the file decides nothing
    blocks = read_blocks(file, layout, temperature_unit=unit)
    table, above = blocks[0].table, blocks[0].temperature
    if len(blocks) > 1:
        raise FileError(
            f"{file}: expected one master curve; got {len(blocks)} tables, the second from "
            f"line {blocks[1].table.line_numbers[0]} on; those of sweeps state their temperatures"
        )
    if len(table.columns) < len(THREE):
        content = columns.other_content(table) or f"({table.titles or 'no titles'})"
        raise FileError(
            f"{file}, line {table.line_numbers[0]}: expected at least 3 columns "
            f"(frequency, storage, loss); got {len(table.columns)}, {content}"
        )
    if len(table.rows) < 2:
        raise FileError(f"{file}: {_TWO_ROWS}; got {len(table.rows)}")
    if not table.names and len(table.columns) == len(THREE) and layout.columns is None:
        layout = replace(layout, columns=(1, 2, 3))
    layout = layout.for_table(table)
    column = layout.needed_column(table, "frequency")
    _refuse_sweeps(table, column, with_columns=bool(layout.columns))
    rows = np.array([layout.read(table, "frequency"), *columns.young_moduli(table, layout)])
    hertz, storage, loss = rows[:, np.isfinite(rows).all(axis=0)]
    if len(hertz) < 2:
        raise FileError(f"{file}: {_TWO_ROWS}; got {len(hertz)} without missing values")
    spread = columns.spread_of_repeats(hertz, storage, loss, np.zeros(len(hertz)))
    if spread > APART:
        raise FileError(
            f"{file}: expected one master curve; got the same frequencies again with moduli "
            f"{spread:.2g} times apart, as sweeps at several temperatures have them: add a column "
            "with the temperature of each row, or write one file for each temperature, with the "
            "temperature in its name, such as sweep_-20C.csv"
        )
    if above is None and (reference_temperature is None or layout.titles_first):
        above = _temperature_of_rows(table, layout)
        above = blocks[0].reference if above is None else above
    if reference_temperature is None or (layout.titles_first and above is not None):
        reference_temperature = above
    name = file.stem if name is None else name
    few, note = thinned(np.array([np.ones(len(hertz)), hertz, storage, loss]))
    notes = (*columns.notes_of_faults(table, layout), *note)
    return MasterCurve(few[1], few[2], few[3], reference_temperature, name, source, None, notes)


def _temperature_of_rows(table: TextTable, layout: FileLayout) -> float | None:
    """Return the temperature of a column in which all rows have the same [K], or None."""
    column = layout.column(table, "temperature")
    if column is None:
        return None
    title = table.columns[column]
    if title.unit and not any(spelled(title.unit, kind) for kind in UNITS):
        layout.unit(table, column, "temperature")  # refuses a unit that is not known
    unit = layout.temperature_unit or columns.unit_in(title, "temperature")
    if unit is None:
        return None
    kelvin = quantity_in_si(table.numbers(column, "a number", missing=True), unit, "temperature")
    kelvin = kelvin[np.isfinite(kelvin)]
    same = kelvin.size > 0 and np.ptp(kelvin) <= _ONE_TEMPERATURE and kelvin.min() > 0.0
    return float(kelvin.mean()) if same else None


def _refuse_sweeps(table: TextTable, frequency: int, *, with_columns: bool) -> None:
    """Raise `FileError` for sweeps; frequencies of a shifted curve with columns do not repeat."""
    for column, title in enumerate(table.columns):
        if columns.quantity(title.name) != "temperature":
            continue
        kelvin = table.numbers(column, "a temperature", missing=True)
        kelvin = kelvin[np.isfinite(kelvin)]
        if not kelvin.size or np.ptp(kelvin) <= _ONE_TEMPERATURE:
            continue
        hertz = columns.above_zero(table, frequency, "frequency")
        if not with_columns or len(np.unique(hertz)) <= len(hertz) // 2:
            raise FileError(
                f"{table.path}: expected one master curve; got rows at temperatures from "
                f"{kelvin.min():g} to {kelvin.max():g} in column {checks.shortened(title.name)}; "
                "shift the sweeps to one master curve first, or name the columns (columns) if they "
                "are shifted"
            )
