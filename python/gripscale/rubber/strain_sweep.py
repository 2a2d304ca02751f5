"""Strain sweeps: storage and loss modulus against the amplitude of strain, one temperature.

What softening at larger strain (Payne) is taken from. Instruments print the single amplitude or the
peak-to-peak (double) one; a factor of two that no curve shows, so that it has to be stated.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import in_si
from gripscale.io.text_table import TextTable, file_path
from gripscale.rubber.columns import (
    MODULI,
    QUANTITIES,
    Block,
    ColumnLayout,
    Columns,
    above_zero,
    columns_of,
    missing,
    read_blocks,
    young_moduli,
)
from gripscale.rubber.sweeps import TOLERANCE, Array, row_temperatures

AMPLITUDES = {"single": 1.0, "peak-to-peak": 0.5}
"""What an amplitude may be, and what makes it a single one."""
_QUANTITIES = ("strain", *QUANTITIES)
_DOUBLE = re.compile(
    r"peak[\s-]*(to[\s-]*)?peak|p\s?-\s?p\b|pk-pk|double|dsa\b|doppel|spitze", re.I
)
_SINGLE = re.compile(r"single|ssa\b|0\s?-\s?p|zero[\s-]*to[\s-]*peak|einfach", re.I)
_ONE_FREQUENCY = 0.02
"""Share by which frequencies of one sweep may differ."""


@dataclass(frozen=True, init=False, eq=False)
class StrainSweep:
    """Storage and loss modulus against strain, in order of rising strain.

    Parameters
    ----------
    strain : array_like, shape (rows,)
        Single amplitude of strain [-], above zero.
    storage, loss : array_like, shape (rows,)
        E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa].
    deformation : {"uniaxial", "shear"}
        What the strain is: of length, or shear.
    temperature : float, optional
        Temperature [K].
    frequency : float, optional
        Frequency [Hz].
    name, source : str
        What was measured and where the numbers come from.

    Raises
    ------
    InputError
        If a value is not finite, not positive or beyond 1e-100 to 1e100, or the lengths differ.
    """

    strain: Array = field(repr=False)
    storage: Array = field(repr=False)
    loss: Array = field(repr=False)
    deformation: str
    temperature: float | None = None
    frequency: float | None = None
    name: str = ""
    source: str = ""

    def __init__(
        self,
        strain: ArrayLike,
        storage: ArrayLike,
        loss: ArrayLike,
        deformation: str,
        temperature: float | None = None,
        frequency: float | None = None,
        name: str = "",
        source: str = "",
    ) -> None:
        columns = {
            "strain": checks.in_limits("strain", strain),
            "storage": checks.in_limits("storage", storage, unit="Pa"),
            "loss": checks.in_limits("loss", loss, unit="Pa"),
        }
        lengths = [len(column) for column in columns.values()]
        if len(set(lengths)) != 1 or lengths[0] == 0:
            raise InputError(
                "strain, storage and loss must have the same length of at least 1; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        order = np.argsort(columns["strain"], kind="stable")
        for key, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, key, ordered)
        checks.one_of("deformation", deformation, ("uniaxial", "shear"))
        object.__setattr__(self, "deformation", deformation)
        for key, value, unit in (("temperature", temperature, "K"), ("frequency", frequency, "Hz")):
            known = None if value is None else checks.positive(key, value, unit=unit)
            object.__setattr__(self, key, known)
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "source", checks.text("source", source))

    def __len__(self) -> int:
        return len(self.strain)

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage


def read_strain_sweep(
    path: str | Path,
    *,
    amplitude: str | None = None,
    strain_unit: str | None = None,
    modulus_unit: str | None = None,
    modulus: str | None = None,
    temperature: float | None = None,
    temperature_unit: str | None = None,
    frequency: float | None = None,
    frequency_unit: str | None = None,
    sheet: str | int | None = None,
    header: int | None = None,
    columns: Columns | None = None,
    name: str | None = None,
    source: str = "",
) -> StrainSweep:
    """Read one strain sweep from a text, CSV or Excel file.

    Titles are those `read_sweeps` knows; what the file states need not be given.

    Parameters
    ----------
    path : str or Path
        The file.
    amplitude : {"single", "peak-to-peak"}, optional
        What the strain column holds, unless its title says so (peak-to-peak, double, DSA; single,
        SSA). The peak-to-peak amplitude is halved.
    strain_unit : {"1", "%"}, optional
        Unit of the strain.
    modulus_unit, modulus, temperature_unit, frequency_unit, sheet, header
        As for `read_sweeps`. Shear moduli (G) come with shear strain, Young's with that of length.
    temperature : float, optional
        Temperature [K], if no column states it.
    frequency : float, optional
        Frequency [Hz], if no column states it.
    columns : mapping, optional
        As for `read_sweeps`, with `strain`.
    name, source : str, optional
        Carried along; the file's stem by default, and nothing.

    Returns
    -------
    StrainSweep
        Temperature and frequency are None if neither stated nor given.

    Raises
    ------
    FileError
        If the file cannot be read or holds more than one temperature or frequency.
    InputError
        If a unit, the kind of modulus or of amplitude, or a column is neither stated nor given.
    """
    place = file_path(path)
    units = {
        "strain": strain_unit,
        "modulus": modulus_unit,
        "temperature": temperature_unit,
        "frequency": frequency_unit,
    }
    stated = ColumnLayout(columns_of(columns, _QUANTITIES), units, modulus)
    blocks = read_blocks(
        place,
        sheet=sheet,
        header=header,
        expected=stated.expected,
        temperature_unit=temperature_unit,
    )
    if len(blocks) > 1:
        raise FileError(f"{place}: expected one strain sweep; got {len(blocks)} tables")
    table = blocks[0].table
    strain = _strain(table, stated, amplitude)
    storage, loss = young_moduli(table, stated)
    complete = np.isfinite([strain, storage, loss]).all(axis=0)
    moduli = [stated.column(table, one) for one in MODULI if one != "loss_factor"]
    known = [one for one in moduli if one is not None]
    return StrainSweep(
        strain[complete],
        storage[complete],
        loss[complete],
        "shear" if stated.modulus_of(table, known) == "G" else "uniaxial",
        _temperature(blocks[0], stated, temperature),
        _frequency(table, stated, frequency),
        name=place.stem if name is None else name,
        source=source,
    )


def _strain(table: TextTable, stated: ColumnLayout, amplitude: str | None) -> Array:
    """Return the single amplitude of strain [-]."""
    column = stated.column(table, "strain")
    if column is None:
        raise missing(table, "strain", "columns")
    title = table.columns[column].name
    if amplitude is None:
        said = {"peak-to-peak": _DOUBLE.search(title), "single": _SINGLE.search(title)}
        found = [word for word, match in said.items() if match]
        if len(found) != 1:
            raise InputError(
                f"{table.path}: amplitude must be given (single or peak-to-peak), because the "
                f"title {title or 'of the strain'} does not tell"
            )
        amplitude = found[0]
    size = AMPLITUDES[checks.one_of("amplitude", amplitude, AMPLITUDES)]
    written = stated.unit(table, [column], "strain")
    return np.asarray(size * in_si(above_zero(table, column, "strain"), written, "strain"))


def _temperature(block: Block, stated: ColumnLayout, given: float | None) -> float | None:
    known = block.temperature is not None or stated.column(block.table, "temperature") is not None
    if given is not None or not known:
        return given
    kelvin = row_temperatures(block, stated, None)
    kelvin = kelvin[np.isfinite(kelvin)]
    if kelvin.size and np.ptp(kelvin) > 2.0 * TOLERANCE:
        raise FileError(
            f"{block.table.path}: expected one temperature; got {kelvin.min():.2f} to "
            f"{kelvin.max():.2f} K"
        )
    return float(kelvin.mean()) if kelvin.size else None


def _frequency(table: TextTable, stated: ColumnLayout, given: float | None) -> float | None:
    column = stated.column(table, "frequency")
    if given is not None or column is None:
        return given
    written = stated.unit(table, [column], "frequency")
    hertz = in_si(above_zero(table, column, "frequency"), written, "frequency")
    hertz = hertz[np.isfinite(hertz)]
    if hertz.size and hertz.max() > (1.0 + _ONE_FREQUENCY) * hertz.min():
        raise FileError(
            f"{table.path}: expected one frequency; got {hertz.min():g} to {hertz.max():g} Hz"
        )
    return float(hertz.mean()) if hertz.size else None
