"""Strain sweeps of filled rubber as laboratories deliver them.

Titles say what the numbers mean. Single or double amplitude, a factor of 2 in strain, is asked for
without a word; "amplitude" alone is the single one, from zero to peak, as mechanics has the word.
Tension or shear, a factor of sqrt(3), stays open: programs print E' = 3 G', too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from gripscale.core import ZERO_CELSIUS, Array, Checked, Vector, checked, checks
from gripscale.core.errors import FileError, GripscaleError, unstated
from gripscale.io.text_table import TextTable, file_paths
from gripscale.rubber.blocks import Block, read_blocks, with_named_temperature
from gripscale.rubber.columns import (
    APART,
    MODULI,
    RATIOS,
    FileLayout,
    modulus_kind,
    spread_of_repeats,
    young_moduli,
)
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, neighbours_of, row_temperatures

Deformation = Literal["tension", "shear"]
DEFORMATIONS = ("tension", "shear")
AMPLITUDES = {"single": 1.0, "peak-to-peak": 0.5}
_MEANINGS = {
    "peak-to-peak": re.compile(
        r"peak[\s-]*(to[\s-]*)?peak|p\s?-\s?p\b|pk-pk|double|dsa\b|doppel|spitze", re.I
    ),
    "single": re.compile(r"single|ssa\b|0\s?-\s?p|zero[\s-]*to[\s-]*peak|einfach|±", re.I),
}
_AMPLITUDE = re.compile(r"amplitude", re.I)
_DEFORMATIONS = {
    "shear": re.compile(r"shear|scher|schub|gamma|γ", re.I),
    "tension": re.compile(r"tensi|uniaxial|elongation|stretch|zug|compressi|druck", re.I),
}
_RATIO = re.compile(r"\bover\b|ratio|relativ|normali[sz]ed|/\s*[EG]'|^[fg]$", re.I)
ONE_FREQUENCY = 0.02  # share by which frequencies of one sweep may differ
_SPAN = 3.0  # largest strain over the smallest in a file of strain sweeps, at least


class StrainSweep(Checked, eq=False):
    """Storage and loss modulus against strain, in order of rising strain.

    Raises `InputError` if a value is not finite, not positive or beyond 1e-100 to 1e100, or the
    lengths differ.
    """

    strain: Vector = checked(checks.positive_vector, repr=False)
    """Single amplitude of strain [-], shape (rows,), above zero."""
    storage: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    loss: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    """E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], shape (rows,), or both
    over their values at small strain [-]."""
    deformation: Deformation | None = checked(checks.one_of, choices=DEFORMATIONS, default=None)
    """What the strain is: of length in tension or compression, or shear; None if not stated."""
    temperature: float | None = checked(checks.positive, unit="K", default=None)
    frequency: float | None = checked(checks.positive, unit="Hz", default=None)
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What was measured, and where the numbers come from."""
    amplitude_assumed: bool = checked(checks.flag, default=False)
    """Whether the amplitude is single by assumption only."""

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

    @property
    def condition(self) -> str:
        """Temperature and frequency as words."""
        kelvin = "" if self.temperature is None else f"{self.temperature - ZERO_CELSIUS:.1f} °C"
        hertz = "" if self.frequency is None else f"{self.frequency:g} Hz"
        return ", ".join(filter(None, [kelvin, hertz])) or "no temperature"


def read_strain_sweeps(
    path: str | Path | Sequence[str | Path],
    *,
    amplitude: str | None = None,
    deformation: Deformation | None = None,
    frequency: float | None = None,
    **options: Any,
) -> list[StrainSweep]:
    """Read strain sweeps at one or several temperatures and frequencies from text, CSV or Excel.

    Rows within 1 K and 2 % of frequency of their neighbours are one sweep; moduli of equal strains
    are averaged. Raises `FileError` if a file cannot be read, or moduli at one condition are of
    several specimens. Raises `InputError` if a unit, the kind of modulus or of amplitude, or a
    column is neither stated nor given.

    Parameters
    ----------
    path, **options
        As in `read_sweeps`, temperatures in the names of several files, too; the options have
        `strain_unit` and `modulus`, which ratios to the moduli at small strain do not need.
    amplitude : {"single", "peak-to-peak"}, optional
        What the strain column holds, unless its title says so (peak-to-peak, double, DSA; single,
        SSA). The peak-to-peak amplitude is halved.
    deformation : {"tension", "shear"}, optional
        What the strain is. Titles and shear moduli may say so; Young's moduli do not.
    frequency : float, optional
        Frequency [Hz], if no column states it; None if nothing does.
    """
    paths, layout = file_paths(path), FileLayout(**options)
    if deformation is not None:
        checks.one_of("deformation", deformation, DEFORMATIONS)
    sweeps = []
    for file in paths:
        for block in read_blocks(file, layout, temperature_unit=layout.temperature_unit):
            block = with_named_temperature(block, file.stem, layout) if len(paths) > 1 else block
            for sweep in _sweeps_in(block, layout, amplitude, frequency):
                kind = sweep.deformation if deformation is None else deformation
                sweeps.append(replace(sweep, deformation=kind, name=file.stem))
    return sweeps


def holds_strain_sweeps(path: str | Path, **layout: Any) -> bool:
    """Return whether most rows of a file are of strain sweeps; units and the like do not count."""
    anything = {"modulus": "E", "modulus_unit": "Pa", "strain_unit": "1", "amplitude": "single"}
    anything |= {"frequency_unit": "Hz", "temperature_unit": "C"}
    try:
        sweeps = read_strain_sweeps(path, **anything | layout)
    except GripscaleError:
        return False
    rising = [s for s in sweeps if len(s) > 2 and s.strain[-1] > _SPAN * s.strain[0]]
    return 2 * sum(map(len, rising)) > sum(map(len, sweeps))


def _sweeps_in(
    block: Block, layout: FileLayout, amplitude: str | None, frequency: float | None
) -> Iterator[StrainSweep]:
    """Yield the sweeps of a table; `frequency` is the caller's."""
    table = block.table
    strain, assumed = _single_amplitude(table, layout, amplitude)
    moduli = young_moduli(table, _for_ratios(table, layout))
    kelvin, hertz = np.full((2, len(strain)), np.nan)
    if block.states_temperature(layout):
        kelvin = row_temperatures(block, layout, None)
    if frequency is not None:
        hertz[:] = checks.positive("frequency", frequency, unit="Hz")
    elif layout.column(table, "frequency") is not None:
        hertz = layout.read(table, "frequency")
    rows = np.array([strain, *moduli, kelvin, hertz])
    rows = rows[:, np.isfinite(rows[:3]).all(axis=0)]
    if not rows.size:
        raise FileError(f"{table.path}: expected rows without missing values; got none")
    colder = _labels(rows[3], TEMPERATURE_TOLERANCE, table, "temperature")
    faster = _labels(np.log(rows[4]), ONE_FREQUENCY, table, "frequency")
    kind = _deformation_in(table, layout)
    for both in np.unique([colder, faster], axis=1).T:
        of_sweep = rows[:, (colder == both[0]) & (faster == both[1])]
        apart = spread_of_repeats(of_sweep[0], of_sweep[1], of_sweep[2], 0.0 * of_sweep[0])
        if apart > APART:
            raise FileError(
                f"{table.path}: expected one measurement at each strain; got moduli {apart:.2g} "
                "times apart, as of several specimens: keep the rows of one of them"
            )
        amplitudes, at = np.unique(of_sweep[0], return_inverse=True)
        storage, loss = (np.bincount(at, values) / np.bincount(at) for values in of_sweep[1:3])
        degrees, cycles = (
            0.5 * float(np.nanmin(values) + np.nanmax(values)) if (values > 0.0).any() else None
            for values in of_sweep[3:]
        )
        yield StrainSweep(
            amplitudes, storage, loss, kind, degrees, cycles, amplitude_assumed=assumed
        )


def _labels(values: Array, tolerance: float, table: TextTable, what: str) -> NDArray[np.intp]:
    """Return which temperature or frequency each row has, counted from the lowest."""
    finite, labels = np.isfinite(values), np.zeros(values.size, dtype=np.intp)
    if finite.any():
        labels[finite] = neighbours_of(values[finite], tolerance)
    if labels.any() and not finite.all():
        gaps = f"none in {int((~finite).sum())} of {values.size} rows"
        raise FileError(f"{table.path}: expected a {what} in every row of several; got {gaps}")
    return labels


def _for_ratios(table: TextTable, layout: FileLayout) -> FileLayout:
    """Return the layout that takes ratios of moduli, if a table holds these, as they are."""
    at = [layout.column(table, name) for name in ("storage", "loss")]
    titles = [table.columns[column] for column in at if column is not None]
    ratios = [t.unit in ("-", "1") or (t.unit is None and _RATIO.search(t.name)) for t in titles]
    if layout.modulus_unit is None and len(titles) == 2 and all(ratios):
        return replace(layout, modulus_unit="Pa", modulus="E")
    return layout


def _deformation_in(table: TextTable, layout: FileLayout) -> Deformation | None:
    columns = (layout.column(table, name) for name in ("strain", *MODULI) if name not in RATIOS)
    titles = [table.columns[column].name for column in columns if column is not None]
    kinds = [kind for kind, words in _DEFORMATIONS.items() if words.search(" ".join(titles))]
    if not kinds and "G" in (layout.modulus, *map(modulus_kind, titles)):
        kinds = ["shear"]
    return kinds[0] if len(kinds) == 1 else None  # type: ignore[return-value]


def _single_amplitude(
    table: TextTable, layout: FileLayout, amplitude: str | None
) -> tuple[Array, bool]:
    """Return the single amplitude of strain, and whether it is single by assumption."""
    column, assumed = table.columns[layout.needed_column(table, "strain")], False
    title = column.name
    if column.unit == "-" and layout.strain_unit is None:
        layout = replace(layout, strain_unit="1")
    if amplitude is None:
        meanings = [word for word, pattern in _MEANINGS.items() if pattern.search(title)]
        assumed = not meanings and bool(_AMPLITUDE.search(title))
        if len(meanings) != 1 and not assumed:
            why = f"because the title {title or 'of the strain'} does not tell"
            words = f" must be given (single or peak-to-peak), {why}"
            raise unstated(f"{table.path}: ", "amplitude", words)
        amplitude = "single" if assumed else meanings[0]
    size = AMPLITUDES[checks.one_of("amplitude", amplitude, AMPLITUDES)]
    return size * layout.read(table, "strain"), assumed
