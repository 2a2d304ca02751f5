"""Frequency sweeps of one rubber, each at a temperature of its own: what a laboratory delivers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import FileError, GripscaleError, InputError
from gripscale.core.units import ZERO_CELSIUS, in_si
from gripscale.io.text_table import file_paths
from gripscale.rubber.columns import (
    Block,
    ColumnLayout,
    Columns,
    above_zero,
    check_rows,
    columns_of,
    missing,
    read_blocks,
    young_moduli,
)

Array = NDArray[np.float64]

TOLERANCE = 1.0
"""Temperatures of one sweep follow each other within this [K]: instruments print 19.9 and 20.1."""
_WIDEST = 3.0
"""Largest span of a sweep's temperatures over the tolerance; a ramp runs on."""


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


@dataclass(frozen=True, init=False, eq=False)
class Sweeps:
    """Frequency sweeps at several temperatures, from rows in any order.

    Rows whose temperatures follow each other within `tolerance` are one sweep, at their mean.

    Parameters
    ----------
    temperature : array_like, shape (rows,)
        Temperature as measured [K].
    frequency : array_like, shape (rows,)
        Frequency [Hz].
    storage, loss : array_like, shape (rows,)
        E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa].
    tolerance : float
        Largest step between neighbouring temperatures of one sweep [K].
    name, source : str
        What was measured and where the numbers come from.

    Raises
    ------
    InputError
        If a value is not finite, not positive or beyond 1e-100 to 1e100, the lengths differ, there
        is no row, or temperatures run on without a gap, as on a ramp.
    """

    temperature: Array = field(repr=False)
    frequency: Array = field(repr=False)
    storage: Array = field(repr=False)
    loss: Array = field(repr=False)
    tolerance: float = TOLERANCE
    name: str = ""
    source: str = ""

    def __init__(
        self,
        temperature: ArrayLike,
        frequency: ArrayLike,
        storage: ArrayLike,
        loss: ArrayLike,
        tolerance: float = TOLERANCE,
        name: str = "",
        source: str = "",
    ) -> None:
        columns = checked_rows(temperature, frequency, storage, loss)
        tolerance = checks.not_negative("tolerance", tolerance, unit="K")
        order = np.lexsort((columns["frequency"], _groups(columns["temperature"], tolerance)))
        for key, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, key, ordered)
        object.__setattr__(self, "tolerance", tolerance)
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "source", checks.text("source", source))
        self._refuse_ramp()

    def _refuse_ramp(self) -> None:
        for rows in self._rows():
            inside = self.temperature[rows]
            if np.ptp(inside) > _WIDEST * self.tolerance:
                raise InputError(
                    f"temperature [K] must step from sweep to sweep by more than {self.tolerance:g}"
                    f" K; got {len(inside)} rows from {inside.min():.2f} to {inside.max():.2f} K "
                    "without a gap; a ramp needs nominal temperatures (temperature_step)"
                )

    def _rows(self) -> list[slice]:
        group = _groups(self.temperature, self.tolerance)
        cuts = [0, *(np.flatnonzero(np.diff(group)) + 1).tolist(), len(group)]
        return [slice(a, b) for a, b in pairwise(cuts)]

    def __len__(self) -> int:
        """Return the number of sweeps."""
        return len(self._rows())

    def __iter__(self) -> Iterator[Sweep]:
        """Yield the sweeps, the coldest first."""
        for rows in self._rows():
            yield Sweep(
                float(self.temperature[rows].mean()),
                self.frequency[rows],
                self.storage[rows],
                self.loss[rows],
            )

    def __eq__(self, other: object) -> bool:
        """Compare all numbers and names."""
        return isinstance(other, Sweeps) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        columns = self.temperature, self.frequency, self.storage, self.loss
        return *(column.tobytes() for column in columns), self.tolerance, self.name, self.source

    def between(self, lowest: float, highest: float) -> Sweeps:
        """Return the rows from a lowest to a highest frequency [Hz].

        For instruments whose own resonance is in the last rows of every sweep. Raises `InputError`
        if there is none.
        """
        low, high = checks.not_negative("lowest", lowest), checks.positive("highest", highest)
        kept = (self.frequency >= low) & (self.frequency <= high)
        columns = (self.temperature, self.frequency, self.storage, self.loss)
        temperature, frequency, storage, loss = (column[kept] for column in columns)
        if not kept.any():
            raise InputError(
                f"lowest and highest [Hz] must enclose a measured frequency; got {low:g} and "
                f"{high:g}"
            )
        return Sweeps(temperature, frequency, storage, loss, self.tolerance, self.name, self.source)

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
        return (
            f"{where}, "
            f"{self.frequency.min():.3g} to {self.frequency.max():.3g} Hz, "
            f"{len(self.frequency)} rows"
        )


def checked_rows(
    temperature: ArrayLike, frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike
) -> dict[str, Array]:
    """Return the four columns of measured rows; raise `InputError` as `Sweeps` does."""
    columns = {
        "temperature": checks.in_limits("temperature", temperature, unit="K"),
        "frequency": checks.in_limits("frequency", frequency, unit="Hz"),
        "storage": checks.in_limits("storage", storage, unit="Pa"),
        "loss": checks.in_limits("loss", loss, unit="Pa"),
    }
    lengths = [len(column) for column in columns.values()]
    if len(set(lengths)) != 1 or lengths[0] == 0:
        raise InputError(
            "temperature, frequency, storage and loss must have the same length of at least 1; "
            f"got {', '.join(map(str, lengths))}"
        )
    return columns


def _groups(temperature: Array, tolerance: float) -> NDArray[np.intp]:
    """Return which sweep each row belongs to, counted from the coldest."""
    order = np.argsort(temperature, kind="stable")
    group = np.empty(len(temperature), dtype=np.intp)
    group[order] = np.cumsum(np.diff(temperature[order], prepend=temperature[order[0]]) > tolerance)
    return group


# Whether a file holds sweeps at several temperatures, or one master curve.


def holds_sweeps(
    path: Path,
    *,
    columns: Columns | None = None,
    sheet: str | int | None = None,
    header: int | None = None,
) -> bool:
    """Return whether `read_sweeps` is the reader of a file, and not `read_master_curve`.

    So it is with RepTate's files, with several tables that state a temperature each, and with a
    column of temperatures over which the same frequencies come again. A master curve may say at
    what temperature each row was measured: its frequencies do not come again. The other arguments
    are those of `read_sweeps`.
    """
    try:
        stated = ColumnLayout(columns_of(columns))
        blocks = read_blocks(
            path, sheet=sheet, header=header, expected=stated.expected, temperature_unit="C"
        )
        return (
            blocks[0].temperature is not None
            or any(_repeats(one, stated) for one in blocks)
            or (len(blocks) > 1 and all(_tells(one, stated) for one in blocks))
        )
    except GripscaleError:
        return False


def _tells(block: Block, stated: ColumnLayout) -> bool:
    return stated.column(block.table, "temperature") is not None


def _repeats(block: Block, stated: ColumnLayout) -> bool:
    table = block.table
    temperature, frequency = (stated.column(table, one) for one in ("temperature", "frequency"))
    if temperature is None or frequency is None:
        return False
    degrees, hertz = (
        table.numbers(at, "a number", missing=True) for at in (temperature, frequency)
    )
    return bool(np.ptp(degrees) > 2.0 * TOLERANCE and len(np.unique(hertz)) <= len(hertz) // 2)


# From temperature ramps at a few frequencies to frequency sweeps at nominal temperatures.
#
# Along the rows of one frequency log E' and log E'' are interpolated linearly in temperature,
# within what was measured, at multiples of a step.

_ONE_FREQUENCY = 0.01
"""Frequencies that differ by less than this share are one."""
_LEAST_STEP = 0.01
_NEAR = 0.5
"""Distance of a row from a nominal temperature, over the step, so that it can be interpolated."""


def sweeps_from_ramps(
    temperature: ArrayLike,
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    step: float,
    name: str = "",
    source: str = "",
) -> Sweeps:
    """Return sweeps at nominal temperatures from rows measured while the temperature ran.

    Parameters
    ----------
    temperature, frequency, storage, loss : array_like, shape (rows,)
        As for `Sweeps`: [K], [Hz], [Pa], [Pa].
    step : float
        Distance of the nominal temperatures [K], which are its multiples in degrees Celsius. No
        smaller than the steps of the ramp, or rows are used twice.
    name, source : str
        Carried along.

    Raises
    ------
    InputError
        As `Sweeps` does; if `step` is not above zero, or no frequency was measured at two
        temperatures with a nominal one in between.
    """
    rows = checked_rows(temperature, frequency, storage, loss)
    step = checks.positive("step", step, unit="K")
    if step < _LEAST_STEP:
        raise InputError(f"step must be at least {_LEAST_STEP:g} K; got {step:g}")
    group = _frequencies(rows["frequency"])
    found = [_at_steps(rows, group == one, step) for one in range(int(group.max()) + 1)]
    together = np.concatenate(found, axis=1)
    if not together.size:
        low, high = rows["temperature"].min(), rows["temperature"].max()
        raise InputError(
            f"step [K] must put a nominal temperature between the {low:.2f} and {high:.2f} K "
            f"measured; got {step:g}"
        )
    kelvin, hertz, real, imaginary = together
    return Sweeps(kelvin, hertz, real, imaginary, 0.5 * step, name, source)


def _frequencies(frequency: Array) -> Array:
    """Return which of the frequencies each row belongs to."""
    order = np.argsort(frequency, kind="stable")
    apart = np.diff(np.log(frequency[order]), prepend=np.log(frequency[order[0]])) > _ONE_FREQUENCY
    group = np.empty(len(frequency), dtype=int)
    group[order] = np.cumsum(apart)
    return group


def _at_steps(rows: dict[str, Array], chosen: Array, step: float) -> Array:
    """Return temperature, frequency, E' and E'' of one frequency at nominal temperatures."""
    order = np.argsort(rows["temperature"][chosen], kind="stable")
    celsius, frequency, storage, loss = (
        rows[key][chosen][order] for key in ("temperature", "frequency", "storage", "loss")
    )
    celsius = celsius - ZERO_CELSIUS
    first, last = np.ceil(celsius[0] / step - 1e-9), np.floor(celsius[-1] / step + 1e-9)
    nominal = step * np.arange(first, last + 1.0)
    away = np.abs(np.subtract.outer(nominal, celsius)).min(axis=1, initial=np.inf)
    nominal = nominal[away <= _NEAR * step]
    return np.array(
        [
            nominal + ZERO_CELSIUS,
            np.full(len(nominal), np.exp(np.log(frequency).mean())),
            np.exp(np.interp(nominal, celsius, np.log(storage))),
            np.exp(np.interp(nominal, celsius, np.log(loss))),
        ]
    )


# Reading sweeps from what instruments export, guessing nothing.


def read_sweeps(
    path: str | Path | Sequence[str | Path],
    *,
    sheet: str | int | None = None,
    header: int | None = None,
    columns: Columns | None = None,
    temperature: float | None = None,
    temperature_unit: str | None = None,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    modulus: str | None = None,
    tolerance: float = TOLERANCE,
    temperature_step: float | None = None,
    titles_first: bool = False,
    name: str | None = None,
    source: str = "",
) -> Sweeps:
    """Read frequency sweeps at several temperatures from text, CSV, Excel or RepTate files.

    Titles are read in English and German. The rules of `gripscale.io.text_table` hold; several
    tables in one file, each with its temperature above it or in a column, are taken together.
    What the file states need not be given; what is given goes before it.

    Parameters
    ----------
    path : str, Path or sequence of them
        The file, or several, such as one for each temperature. Excel: .xlsx.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.
    header : int, optional
        Number of lines above the rows, where there are numbers among them.
    columns : mapping, or sequence of three str or int, optional
        Title or number from 1 of `temperature`, `frequency` and two of `storage`, `loss`,
        `loss_factor` and `magnitude`, as far as titles do not tell; three in a sequence are
        frequency, storage and loss.
    temperature : float, optional
        Temperature of a file that states none [K].
    temperature_unit : {"K", "C", "F"}, optional
        Unit of the temperatures.
    frequency_unit : {"Hz", "kHz", "MHz", "GHz", "rad/s"}, optional
        Unit of the frequencies.
    modulus_unit : {"Pa", "kPa", "psi", "MPa", "N/mm2", "GPa", "dyn/cm2"}, optional
        Unit of the moduli.
    modulus : {"E", "G"}, optional
        Whether they are Young's or shear moduli (G is multiplied by 3).
    tolerance : float
        Largest step between neighbouring temperatures of one sweep [K].
    temperature_step : float, optional
        For ramps, temperature sweeps at one or several frequencies: moduli are interpolated at
        multiples of this step [K] of degrees Celsius (see `gripscale.rubber.sweeps_from_ramps`).
    titles_first : bool
        Whether what the files state goes before what is given.
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
    units = {"frequency": frequency_unit, "modulus": modulus_unit, "temperature": temperature_unit}
    stated = ColumnLayout(columns_of(columns), units, modulus, titles_first)
    parts = [
        _rows(block, stated, temperature)
        for place in paths
        for block in read_blocks(
            place,
            sheet=sheet,
            header=header,
            expected=stated.expected,
            temperature_unit=temperature_unit,
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


def _rows(block: Block, stated: ColumnLayout, temperature: float | None) -> Array:
    """Return temperature, frequency, E' and E'' of the complete rows of a table, in SI units."""
    table, stated = block.table, stated.of(block.table)
    frequency = stated.column(table, "frequency")
    if frequency is None:
        raise missing(table, "frequency", "columns")
    hertz = stated.unit(table, [frequency], "frequency")
    rows = [
        row_temperatures(block, stated, temperature),
        in_si(above_zero(table, frequency, "frequency"), hertz, "frequency"),
        *young_moduli(table, stated),
    ]
    complete = np.isfinite(rows).all(axis=0)
    return np.array(rows)[:, complete]


def row_temperatures(block: Block, stated: ColumnLayout, given: float | None) -> Array:
    """Return the temperature of each row [K]: the caller's, of the lines above, of a column."""
    table = block.table
    if given is None and block.temperature is not None and "temperature" not in stated.columns:
        given = block.temperature
    if given is not None:
        return np.full(len(table.rows), given)
    column = stated.column(table, "temperature")
    if column is None:
        raise missing(table, "temperature", "columns or temperature")
    written = stated.unit(table, [column], "temperature")
    kelvin = in_si(table.numbers(column, "a temperature", missing=True), written, "temperature")
    check_rows(table, column, kelvin > 0.0, kelvin, "a temperature above absolute zero")
    return np.asarray(kelvin)
