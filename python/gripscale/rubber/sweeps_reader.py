"""Reading sweeps from what instruments export, guessing nothing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.moduli import above_zero, check_rows, young_moduli
from gripscale.rubber.ramps import sweeps_from_ramps
from gripscale.rubber.stated import Columns, Stated, columns_of, missing
from gripscale.rubber.sweep_blocks import Block, read_blocks
from gripscale.rubber.sweeps import TOLERANCE, Array, Sweeps
from gripscale.textfile import file_paths
from gripscale.units import in_si


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

    Titles are read in English and German. The rules of `gripscale.textfile` hold; several tables
    in one file, each with its temperature above it or in a column, are taken together. What the
    file states need not be given; what is given goes before it.

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
    stated = Stated(columns_of(columns), units, modulus, titles_first)
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


def _rows(block: Block, stated: Stated, temperature: float | None) -> Array:
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


def row_temperatures(block: Block, stated: Stated, given: float | None) -> Array:
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
