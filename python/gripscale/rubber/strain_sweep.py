"""Strain sweeps: storage and loss modulus against the amplitude of strain, one temperature.

Softening at larger strain (Payne) is taken from them. Instruments print the single amplitude or the
peak-to-peak (double) one; a factor of two that no curve shows, so that it has to be stated.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array, Vector
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import FileError, InputError
from gripscale.io.text_table import TextTable, file_path
from gripscale.rubber.blocks import read_blocks
from gripscale.rubber.columns import MODULI, RATIOS, FileLayout, young_moduli
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, row_temperatures

AMPLITUDES = {"single": 1.0, "peak-to-peak": 0.5}
_DOUBLE = re.compile(
    r"peak[\s-]*(to[\s-]*)?peak|p\s?-\s?p\b|pk-pk|double|dsa\b|doppel|spitze", re.I
)
_SINGLE = re.compile(r"single|ssa\b|0\s?-\s?p|zero[\s-]*to[\s-]*peak|einfach", re.I)
_ONE_FREQUENCY = 0.02
"""Share by which frequencies of one sweep may differ."""


class StrainSweep(Checked, eq=False):
    """Storage and loss modulus against strain, in order of rising strain.

    Raises `InputError` if a value is not finite, not positive or beyond 1e-100 to 1e100, or the
    lengths differ.
    """

    strain: Vector = checked(checks.in_limits, repr=False)
    """Single amplitude of strain [-], shape (rows,), above zero."""
    storage: Vector = checked(checks.in_limits, unit="Pa", repr=False)
    loss: Vector = checked(checks.in_limits, unit="Pa", repr=False)
    """E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], shape (rows,)."""
    deformation: str = checked(checks.one_of, choices=("uniaxial", "shear"))
    """What the strain is: of length (uniaxial), or shear."""
    temperature: float | None = checked(checks.positive, unit="K", default=None)
    frequency: float | None = checked(checks.positive, unit="Hz", default=None)
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What was measured, and where the numbers come from."""

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = {"strain": self.strain, "storage": self.storage, "loss": self.loss}
        checks.same_length(1, **columns)
        order = np.argsort(self.strain, kind="stable")
        self._set(**{name: column[order] for name, column in columns.items()})

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
    temperature: float | None = None,
    frequency: float | None = None,
    name: str | None = None,
    source: str = "",
    **options: Any,
) -> StrainSweep:
    """Read one strain sweep from a text, CSV or Excel file.

    Temperature and frequency are None if neither stated nor given. Titles are those `read_sweeps`
    knows; what the file states need not be given. Raises `FileError` if the file cannot be read or
    holds more than one temperature or frequency. Raises `InputError` if a unit, the kind of modulus
    or of amplitude, or a column is neither stated nor given.

    Parameters
    ----------
    path : str or Path
        The file.
    amplitude : {"single", "peak-to-peak"}, optional
        What the strain column holds, unless its title says so (peak-to-peak, double, DSA; single,
        SSA). The peak-to-peak amplitude is halved.
    temperature : float, optional
        Temperature [K], if no column states it.
    frequency : float, optional
        Frequency [Hz], if no column states it.
    name, source : str, optional
        Carried along; the file's stem by default, and nothing.
    **options
        `columns`, `sheet`, `header`, `strain_unit`, `modulus_unit`, `temperature_unit`,
        `frequency_unit` and `modulus`, as fields of `gripscale.rubber.FileLayout`. Shear moduli (G)
        come with shear strain, Young's with that of length.
    """
    file, layout = file_path(path), FileLayout(**options)
    blocks = read_blocks(file, layout, temperature_unit=layout.temperature_unit)
    if len(blocks) > 1:
        raise FileError(f"{file}: expected one strain sweep; got {len(blocks)} tables")
    table = blocks[0].table
    strain = _single_amplitude(table, layout, amplitude)
    storage, loss = young_moduli(table, layout)
    complete = np.isfinite([strain, storage, loss]).all(axis=0)
    strain, storage, loss = (values[complete] for values in (strain, storage, loss))
    moduli = [layout.column(table, name) for name in MODULI if name not in RATIOS]
    kind = layout.modulus_of(table, [column for column in moduli if column is not None])
    column = layout.column(table, "temperature")
    if temperature is None and (blocks[0].temperature is not None or column is not None):
        kelvin = row_temperatures(blocks[0], layout, None)
        kelvin = kelvin[np.isfinite(kelvin)]
        if kelvin.size and np.ptp(kelvin) > 2.0 * TEMPERATURE_TOLERANCE:
            raise FileError(
                f"{file}: expected one temperature; got {kelvin.min():.2f} to {kelvin.max():.2f} K"
            )
        temperature = float(kelvin.mean()) if kelvin.size else None
    column = layout.column(table, "frequency")
    if frequency is None and column is not None:
        hertz = layout.read(table, "frequency")
        hertz = hertz[np.isfinite(hertz)]
        if hertz.size and hertz.max() > (1.0 + _ONE_FREQUENCY) * hertz.min():
            raise FileError(
                f"{file}: expected one frequency; got {hertz.min():g} to {hertz.max():g} Hz"
            )
        frequency = float(hertz.mean()) if hertz.size else None
    deformation = "shear" if kind == "G" else "uniaxial"
    name = file.stem if name is None else name
    return StrainSweep(strain, storage, loss, deformation, temperature, frequency, name, source)


def _single_amplitude(table: TextTable, layout: FileLayout, amplitude: str | None) -> Array:
    """Return the single amplitude of strain [-]."""
    title = table.columns[layout.needed_column(table, "strain")].name
    if amplitude is None:
        patterns = {"peak-to-peak": _DOUBLE, "single": _SINGLE}
        meanings = [word for word, pattern in patterns.items() if pattern.search(title)]
        if len(meanings) != 1:
            raise InputError(
                f"{table.path}: amplitude must be given (single or peak-to-peak), because the "
                f"title {title or 'of the strain'} does not tell",
                missing="amplitude",
            )
        amplitude = meanings[0]
    size = AMPLITUDES[checks.one_of("amplitude", amplitude, AMPLITUDES)]
    return size * layout.read(table, "strain")
