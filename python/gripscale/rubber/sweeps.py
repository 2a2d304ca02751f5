"""Frequency sweeps of one rubber, each at a temperature of its own: what a laboratory delivers.

Temperature ramps at a few frequencies become sweeps at nominal temperatures: along the rows of one
frequency log E' and log E'' are interpolated linearly in temperature, within what was measured, at
multiples of a step.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import Array, Checked, Quantity, Vector, checked, checks
from gripscale.core.errors import FileError, GripscaleError, InputError, about_file
from gripscale.core.units import ZERO_CELSIUS, quantity_in_si, si_value
from gripscale.io.text_table import file_path, file_paths, is_excel
from gripscale.rubber.blocks import Block, read_blocks, with_named_temperature
from gripscale.rubber.columns import (
    APART,
    FileLayout,
    check_rows,
    notes_of_faults,
    spread_of_repeats,
    unit_in,
    young_moduli,
)
from gripscale.rubber.shift import WLF

# Temperatures of one sweep follow each other within this [K]: instruments print 19.9 and 20.1.
TEMPERATURE_TOLERANCE = 1.0
_WIDEST = 3.0  # largest span of a sweep's temperatures over the tolerance; a ramp runs on
_ROW = ("temperature", "frequency", "storage", "loss")


@dataclass(frozen=True)
class Sweep:
    """One frequency sweep: rows in order of rising frequency."""

    temperature: float
    """Mean temperature of the rows [K]."""
    frequency: Array
    """Frequency [Hz], shape (rows,)."""
    storage: Array
    """E' [Pa]."""
    loss: Array
    """E'' [Pa]."""

    def __len__(self) -> int:
        return len(self.frequency)


class Sweeps(Checked, eq=False):
    """Frequency sweeps at several temperatures, from rows in any order.

    Rows whose temperatures follow each other within `tolerance` are one sweep, at their mean.
    Raises `InputError` if a value is not finite, not positive or beyond 1e-100 to 1e100, the
    lengths differ, there is no row, or temperatures run on without a gap, as on a ramp.
    """

    temperature: Vector = checked(checks.positive_vector, unit="K", repr=False)
    """Temperature as measured [K], shape (rows,)."""
    frequency: Vector = checked(checks.positive_vector, unit="Hz", repr=False)
    """Frequency [Hz], shape (rows,)."""
    storage: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    loss: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    """E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], shape (rows,)."""
    tolerance: float = checked(
        checks.not_negative,
        unit="K",
        quantity="temperature difference",
        default=TEMPERATURE_TOLERANCE,
    )
    """Largest step between neighbouring temperatures of one sweep [K]."""
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What was measured, and where the numbers come from."""
    notes: tuple[str, ...] = field(default=(), repr=False)
    """What was done to the rows of its files, such as rows left out."""

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = {name: getattr(self, name) for name in _ROW}
        checks.same_length(1, **columns)
        order = np.lexsort((self.frequency, neighbours_of(self.temperature, self.tolerance)))
        self._set(**{name: column[order] for name, column in columns.items()})
        for rows in self._rows():
            inside = self.temperature[rows]
            if np.ptp(inside) > _WIDEST * self.tolerance:
                raise InputError(
                    f"temperature [K] must step from sweep to sweep by more than {self.tolerance:g}"
                    f" K; got {len(inside)} rows from {inside.min():.2f} to {inside.max():.2f} K "
                    "without a gap; a ramp needs nominal temperatures (temperature_step)"
                )

    def _rows(self) -> list[slice]:
        group = neighbours_of(self.temperature, self.tolerance)
        cuts = [0, *(np.flatnonzero(np.diff(group)) + 1).tolist(), len(group)]
        return [slice(a, b) for a, b in pairwise(cuts)]

    def __len__(self) -> int:
        return len(self._rows())

    def __iter__(self) -> Iterator[Sweep]:
        """Yield the sweeps, the coldest first."""
        for rows in self._rows():
            kelvin, *columns = (getattr(self, name)[rows] for name in _ROW)
            yield Sweep(float(kelvin.mean()), *columns)

    def between(self, lowest: float, highest: float) -> Sweeps:
        """Return the rows from a lowest to a highest frequency [Hz].

        For instruments whose own resonance is in the last rows of every sweep. Raises `InputError`
        if there is none.
        """
        low, high = checks.not_negative("lowest", lowest), checks.positive("highest", highest)
        kept = (self.frequency >= low) & (self.frequency <= high)
        if kept.any():
            return replace(self, **{name: getattr(self, name)[kept] for name in _ROW})
        raise InputError(
            f"lowest and highest [Hz] must enclose a measured frequency; got {low:g} and {high:g}"
        )

    @property
    def is_ramp(self) -> bool:
        """Whether one frequency was measured while the temperature ran."""
        span = float(np.ptp(self.temperature))
        return is_single_frequency(self.frequency) and span > _WIDEST * TEMPERATURE_TOLERANCE

    @property
    def temperatures(self) -> Array:
        """Mean temperature of each sweep, rising [K], shape (sweeps,)."""
        return np.array([sweep.temperature for sweep in self])

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage

    def summary(self) -> str:
        """Return the sweeps in a line of text."""
        celsius = self.temperatures - ZERO_CELSIUS
        where = f"{len(self)} sweeps from {celsius[0]:.1f} to {celsius[-1]:.1f} °C"
        if len(self) == 1:
            where = f"one sweep at {celsius[0]:.1f} °C"
        low, high = self.frequency.min(), self.frequency.max()
        return f"{where}, {low:.3g} to {high:.3g} Hz, {len(self.frequency)} rows"


def neighbours_of(values: Array, tolerance: float) -> NDArray[np.intp]:
    """Return which group of neighbouring values each belongs to, counted from the lowest."""
    order = np.argsort(values, kind="stable")
    group = np.empty(len(values), dtype=np.intp)
    group[order] = np.cumsum(np.diff(values[order], prepend=values[order[0]]) > tolerance)
    return group


def holds_sweeps(path: Path, layout: FileLayout | None = None) -> bool:
    """Return whether `read_sweeps` is the reader of a file, and not `read_master_curve`.

    It is for tables that state a temperature, and for a column of temperatures over which the same
    frequencies come again, as in no master curve.
    """
    layout = layout or FileLayout()
    layout = FileLayout(layout.columns, layout.sheet, layout.header, frequency=layout.frequency)
    try:
        blocks = read_blocks(path, layout, temperature_unit="C")
        with_column = [layout.column(block.table, "temperature") is not None for block in blocks]
        return (
            blocks[0].temperature is not None
            or any(_repeats(block, layout) for block in blocks)
            or (len(blocks) > 1 and all(with_column))
        )
    except GripscaleError:
        return False


def states_temperature(path: str | Path) -> bool:
    """Return whether a file states the temperature of its moduli, above a table or in a column."""
    layout = FileLayout()
    blocks = read_blocks(file_path(path), layout, temperature_unit="C")
    return all(block.states_temperature(layout) for block in blocks)


def read_shift_of_sweeps(path: str | Path, layout: Mapping[str, Any]) -> WLF | None:
    """Return the shift that a file of RepTate (.tts) states among its parameters, or None."""
    file = file_path(path)
    if is_excel(file):
        return None
    return read_blocks(file, FileLayout(**layout), temperature_unit="C")[0].shift


def _repeats(block: Block, layout: FileLayout) -> bool:
    table = block.table
    columns = [layout.column(table, name) for name in ("temperature", "frequency")]
    if None in columns:
        return False
    degrees, hertz = (table.numbers(at or 0, "a number", missing=True) for at in columns)
    degrees = degrees[np.isfinite(degrees)]
    if not degrees.size or np.ptp(degrees) <= 2.0 * TEMPERATURE_TOLERANCE:
        return False
    return len(np.unique(hertz)) <= len(hertz) // 2 or is_single_frequency(hertz)


_ONE_FREQUENCY = 0.01  # frequencies that differ by less than this share are one


def is_single_frequency(hertz: Array) -> bool:
    """Return whether all frequencies [Hz] are one within the noise of an instrument."""
    return bool(hertz.max() <= (1.0 + _ONE_FREQUENCY) * hertz.min())


_LEAST_STEP = 0.01
# Distance of a row from a nominal temperature, over the step, so that it can be interpolated.
_NEAR = 0.5


def sweeps_from_ramps(
    temperature: ArrayLike,
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    step: Quantity,
    name: str = "",
    source: str = "",
) -> Sweeps:
    """Return sweeps at nominal temperatures from rows measured while the temperature ran.

    Rows, `name` and `source` are as for `Sweeps`: [K], [Hz], [Pa], [Pa], shape (rows,). Nominal
    temperatures are the multiples of `step` [K] in degrees Celsius; if they are closer than the
    steps of the ramp, rows are used twice. Raises `InputError` as `Sweeps` does, if `step` is not
    above zero, or no frequency was measured at two temperatures with a nominal one in between.
    """
    units = ("K", "Hz", "Pa", "Pa")
    columns = zip(_ROW, (temperature, frequency, storage, loss), units, strict=True)
    rows = {name: checks.positive_vector(name, values, unit=unit) for name, values, unit in columns}
    checks.same_length(1, **rows)
    step = checks.positive("step", si_value("step", step, "K", "temperature difference"), unit="K")
    if step < _LEAST_STEP:
        raise InputError(f"step must be at least {_LEAST_STEP:g} K; got {step:g}")
    group = neighbours_of(np.log(rows["frequency"]), _ONE_FREQUENCY)
    parts = []
    for of_one_frequency in range(int(group.max()) + 1):
        chosen = np.flatnonzero(group == of_one_frequency)
        chosen = chosen[np.argsort(rows["temperature"][chosen], kind="stable")]
        kelvin, hertz, real, imaginary = (rows[name][chosen] for name in _ROW)
        celsius = kelvin - ZERO_CELSIUS
        first, last = np.ceil(celsius[0] / step - 1e-9), np.floor(celsius[-1] / step + 1e-9)
        nominal = step * np.arange(first, last + 1.0)
        away = np.abs(np.subtract.outer(nominal, celsius)).min(axis=1, initial=np.inf)
        nominal = nominal[away <= _NEAR * step]
        moduli = [np.exp(np.interp(nominal, celsius, np.log(part))) for part in (real, imaginary)]
        mean = np.full(len(nominal), np.exp(np.log(hertz).mean()))
        parts.append(np.array([nominal + ZERO_CELSIUS, mean, *moduli]))
    at_steps = np.concatenate(parts, axis=1)
    if not at_steps.size:
        low, high = rows["temperature"].min(), rows["temperature"].max()
        raise InputError(
            f"step [K] must put a nominal temperature between the {low:.2f} and {high:.2f} K "
            f"measured; got {step:g}"
        )
    kelvin, hertz, real, imaginary = at_steps
    return Sweeps(kelvin, hertz, real, imaginary, 0.5 * step, name, source)


def read_sweeps(
    path: str | Path | Sequence[str | Path],
    *,
    modulus: str | None = None,
    frequency: float | None = None,
    temperature: float | None = None,
    tolerance: float = TEMPERATURE_TOLERANCE,
    temperature_step: float | None = None,
    name: str | None = None,
    source: str = "",
    **options: Any,
) -> Sweeps:
    """Read frequency sweeps at several temperatures from text, CSV, Excel or RepTate files.

    Rows with a missing value in a column that is needed are left out. Titles are read in English
    and German. The rules of `gripscale.io.text_table` hold. Several tables in one file are taken
    together, each with its temperature above it or in a column; side by side, too. What the file
    states need not be given; what is given goes before it. Nothing is guessed. Raises `FileError`
    if a file cannot be read or a value in it cannot be; the message names path and line. Raises
    `InputError` if a unit, the kind of modulus, a column or a temperature is neither stated nor
    given.

        >>> gs.read_sweeps("sweeps.csv").temperatures
        array([263.15, 278.15, 293.15, 308.15])

    Parameters
    ----------
    path : str, Path or sequence of them
        The file, or several, such as one for each temperature, which then may stand in its name
        with its unit: sweep_-20C.csv. Excel: .xlsx.
    modulus, name, source, **options
        As in `read_master_curve`.
    frequency : float, optional
        Frequency of all rows [Hz], as of a temperature ramp, where the file does not state it.
    temperature : float, optional
        Temperature of a file that states none [K].
    tolerance : float
        Largest step between neighbouring temperatures of one sweep [K].
    temperature_step : float, optional
        For ramps, temperature sweeps at one or several frequencies: moduli are interpolated at
        multiples of this step [K] of degrees Celsius (see `gripscale.rubber.sweeps_from_ramps`).
    """
    paths = file_paths(path)
    layout = FileLayout(modulus=modulus, frequency=frequency, **options)
    if temperature is not None:
        temperature = checks.positive("temperature", temperature, unit="K")
    parts, notes = [], []
    for file in paths:
        blocks = read_blocks(file, layout, temperature_unit=layout.temperature_unit)
        if temperature is None and len(paths) > 1:
            blocks = [with_named_temperature(block, file.stem, layout) for block in blocks]
        for table_layout, block in ((layout.for_table(block.table), block) for block in blocks):
            parts.append(_rows(block, table_layout, temperature))
            notes += notes_of_faults(block.table, table_layout)
    rows = np.concatenate(parts, axis=1)
    if not rows.size:
        raise FileError(f"{paths[0]}: expected rows without missing values; got none")
    kelvin, hertz, storage, loss = rows
    spread = spread_of_repeats(hertz, storage, loss, kelvin)
    if spread > APART:
        raise FileError(
            f"{paths[0]}: expected one measurement at each frequency and temperature; got moduli "
            f"{spread:.2g} times apart, as of several specimens, strain amplitudes, units or "
            "unnamed temperatures: keep the rows of one of them"
        )
    rows, note = thinned(rows)
    name = paths[0].stem if name is None else name
    if temperature_step is not None:
        return sweeps_from_ramps(*rows, step=temperature_step, name=name, source=source)
    kelvin, hertz, storage, loss = rows
    with about_file(paths[0], InputError):
        return Sweeps(kelvin, hertz, storage, loss, tolerance, name, source, (*notes, *note))


def _rows(block: Block, layout: FileLayout, temperature: float | None) -> Array:
    """Return temperature, frequency, E' and E'' of the complete rows of a table, in SI units."""
    hertz = layout.read(block.table, "frequency")
    kelvin = row_temperatures(block, layout, temperature)
    rows = np.array([kelvin, hertz, *young_moduli(block.table, layout)])
    measured = np.isfinite(rows[1:]).all(axis=0)
    without = np.flatnonzero(measured & np.isnan(kelvin))
    if without.size:
        raise FileError(
            f"{block.table.path}, line {block.table.line_numbers[without[0]]}: expected a "
            f"temperature in every row; got none in {without.size} of {len(kelvin)} rows: fill "
            "the column, or remove these rows"
        )
    return rows[:, measured]


# A line above rows whose temperature is farther from their column [K] is of the room or an older
# run: no oven is that far from what it was set to.
_AWAY = 5.0


def row_temperatures(block: Block, layout: FileLayout, temperature: float | None) -> Array:
    """Return the temperature of each row [K]: the caller's, of the lines above, of a column."""
    table, above = block.table, block.temperature
    column = layout.column(table, "temperature")
    if temperature is None and above is not None and "temperature" not in layout.by_quantity:
        unit = None if column is None else unit_in(table.columns[column], "temperature")
        if column is None or unit is None:
            temperature = above
        else:
            degrees = table.numbers(column, "a temperature", missing=True)
            away = np.abs(quantity_in_si(degrees, unit, "temperature") - above)
            temperature = None if (away > _AWAY).any() else above
    if temperature is not None:
        return np.full(len(table.rows), temperature)
    if column is None:
        raise InputError(
            f"{table.path}: the temperature of the rows must stand in a column, Temperature [°C], "
            "in a line above the rows, T = 20 °C, or in the name of each of several files, "
            f"sweep_20C.csv; the header has {table.titles or 'no names'}"
        )
    degrees = table.numbers(column, "a temperature", missing=True)
    unit = layout.unit(table, column, "temperature")
    kelvin = np.asarray(quantity_in_si(degrees, unit, "temperature"))
    check_rows(table, column, kelvin > 0.0, kelvin, "a temperature above absolute zero")
    return kelvin


MOST_ROWS = 5000  # rows up to which all are kept: instruments that log on write 1e5 or 1e6
ROWS_PER_DECADE = 100  # rows of a decade of frequency, at one temperature, that are kept of more
_SAME_TEMPERATURE = 0.2  # width of a step of temperature [K]


def thinned(rows: Array) -> tuple[Array, tuple[str, ...]]:
    """Return rows without those too many, and a note of it: the middle one of each bin stays.

    The first two of `rows` are temperature [K] and frequency [Hz], shape (columns, rows). Rows are
    kept as measured: the mean of a thousand has the scatter of none, and a series fitted within
    that follows the drift of the instrument with a hundred elements.
    """
    count = rows.shape[1]
    if count <= MOST_ROWS:
        return rows, ()
    temperature, frequency = np.round(rows[0] / _SAME_TEMPERATURE), np.log10(rows[1])
    bins = 1e6 * temperature + np.round(ROWS_PER_DECADE * frequency)
    order = np.lexsort((frequency, bins))
    _, first, each = np.unique(bins[order], return_index=True, return_counts=True)
    kept = order[first + each // 2]
    return rows[:, kept], (
        f"{kept.size} of {count} rows kept, at most {ROWS_PER_DECADE} of a decade of frequency at "
        "one temperature",
    )
