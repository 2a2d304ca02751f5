"""What a measured file holds, by its titles and numbers: its kind, and why it is taken for it.

Kinds are tried in the order of `READERS`: titles that name quantities go before numbers without a
name, which are heights.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.case_file import proposals
from gripscale.core import ZERO_CELSIUS, GripscaleError, checks, in_mm, spelled
from gripscale.core.checks import shortened
from gripscale.experiment.measured_friction import MeasuredFriction, read_measured_friction
from gripscale.io.table import least_to_most
from gripscale.io.text_table import ColumnTitle, columns_noted
from gripscale.rubber import MasterCurve, ShiftTable, Sweeps
from gripscale.rubber.blocks import read_blocks, with_named_temperature
from gripscale.rubber.columns import FileLayout, other_content, quantity
from gripscale.rubber.prony import holds_prony_table, read_prony_table
from gripscale.rubber.strain_sweeps import holds_strain_sweeps
from gripscale.surface import HeightMap, Profile, Spectrum, read_spectrum
from gripscale.surface.read_spectrum import holds_spectrum

UNUSED = "unused"
SURFACES = ("profile", "map", "spectrum")
RUBBERS = ("sweeps", "master-curve", "ramp", "prony")
"""Kinds of moduli, those first that are taken before others of one folder."""
_MOST_TITLES = 6  # columns that are listed one by one


@dataclass(frozen=True)
class FileKeys:
    """What a caller states of files beside their kinds, as keys of [surface] and [rubber]."""

    step: str | list[str] | None = None
    surface: Mapping[str, Any] = field(default_factory=dict)
    layout: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Taken:
    """A file, what it is taken for, and why."""

    path: Path
    kind: str
    why: str
    measured: Any = None  # what was read; of strain sweeps a list, of a Prony series a dictionary
    # Keys that nothing states and without which it cannot be read, as assumed to read it.
    missing: Mapping[str, Any] = field(default_factory=dict)
    columns: Mapping[int, ColumnTitle] = field(default_factory=dict)  # that were read, from 1
    refusal: GripscaleError | None = None  # why it cannot be read as what it seems to be
    by_caller: bool = False  # whether the caller states its kind

    @property
    def titles(self) -> str:
        """The columns that were read, in the words of the file."""
        if not 0 < len(self.columns) <= _MOST_TITLES:
            return f"{len(self.columns)} columns" if self.columns else ""
        titles = (
            f"{number} {shortened(title.name)}{f' [{title.unit}]' if title.unit else ''}".strip()
            for number, title in sorted(self.columns.items())
        )
        return f"column{'s' * (len(self.columns) > 1)} {', '.join(titles)}"


# How the files of each kind are read, and the keys that nothing states; of moduli and of surfaces
# all kinds alike.
READERS: dict[str, Callable[[Path, FileKeys], tuple[Any, dict[str, Any]]]] = {
    "strain-sweep": lambda path, _: proposals.open_strain_sweeps([path]),
    "prony": lambda path, _: proposals.read_with(read_prony_table, path, proposals.UNITS_OF_RUBBER),
    "moduli": lambda path, keys: proposals.open_rubber([path], keys.layout),
    "shift": lambda path, _: proposals.open_shift(path),
    "friction": lambda path, _: (read_measured_friction(path), {}),
    "spectrum": lambda path, _: (read_spectrum(path), {}),
    "surface": lambda path, keys: proposals.open_surface(
        path, keys.step, proposals.UNITS_OF_SURFACE, **proposals.reading_keys(keys.surface)
    ),
}
_READER_OF = {**dict.fromkeys(SURFACES[:2], "surface"), **dict.fromkeys(RUBBERS[:3], "moduli")}
NAMES = (*SURFACES, *RUBBERS, "strain-sweep", "shift", "friction", UNUSED)
"""Kinds that a caller may state."""


def take(path: Path, keys: FileKeys, name: str | None = None) -> Taken:
    """Return what a file is taken for; a stated `name` of `NAMES` goes before its content.

    Raises `InputError` for another name.
    """
    if name is not None:
        checks.one_of("kind of a file", name, NAMES)
    if name == UNUSED or path.is_dir():
        why = "as stated" if name else "a folder: name it, too, to read it"
        return Taken(path, UNUSED, why)
    seems = [_READER_OF.get(name, name)] if name else _seems(path, keys)
    refusals: list[GripscaleError] = []
    of_speeds: GripscaleError | None = None
    for kind in seems:
        try:
            with columns_noted() as columns:
                measured, missing = READERS[kind](path, keys)
        except GripscaleError as error:
            refusals.append(error)
            if error.missing in ("friction", "temperature"):
                of_speeds = error
            continue
        if of_speeds and not any(spelled(title.unit, "length") for title in columns.values()):
            break  # speeds are no heights, unlike lengths beside them
        return Taken(path, *_kind_and_size(measured), measured, missing, columns)
    refusal = of_speeds or refusals[-1]
    why = str(refusal).removeprefix(f"{path}: ").removeprefix(f"{path}, ")
    kind = {"moduli": RUBBERS[1]}.get(seems[0], seems[0] if len(seems) == 1 else UNUSED)
    return Taken(path, kind, why, refusal=refusal)


def _seems(path: Path, keys: FileKeys) -> list[str]:
    """Return the readers to try: of moduli only theirs, which says what is wrong with them."""
    layout = FileLayout(**keys.layout)
    if holds_prony_table(path):
        return ["prony"]
    if holds_spectrum(path):
        return ["spectrum"]
    titled: set[str | None] = set()
    with suppress(GripscaleError):
        of_titles = replace(layout, frequency=None)
        blocks = read_blocks(path, of_titles, temperature_unit="C", most=proposals.ENOUGH_LINES)
        titled = {quantity(name) for block in blocks for name in block.table.names}
        titled |= {"loss" for block in blocks if other_content(block.table)}
    if "strain" in titled and holds_strain_sweeps(path):
        return ["strain-sweep"]
    if titled & {"frequency", "storage", "loss"} or proposals.holds_moduli(path, layout):
        return ["moduli"]
    if titled and {quantity(n) for n in blocks[0].table.names[:1]} & {"temperature", "strain"}:
        return ["shift", "friction"]  # no distances
    return ["shift", "friction", "surface"]


def joinable(file: Taken, layout: Mapping[str, Any]) -> bool:
    """Return whether a file of moduli, or its name, states the temperature of its rows."""
    if file.kind != "master-curve" or file.refusal:
        return file.kind == "sweeps"
    blocks = read_blocks(file.path, FileLayout(**layout), temperature_unit="C")
    named = (with_named_temperature(b, file.path.stem, FileLayout(**layout)) for b in blocks)
    return all(block.states_temperature(FileLayout(**layout)) for block in named)


def _kind_and_size(measured: Any) -> tuple[str, str]:
    """Return the kind of what was read, and how much it is in a clause."""
    match measured:
        case dict():
            return "prony", f"{len(measured['moduli'])} relaxation times and an equilibrium modulus"
        case Profile():
            return "profile", f"{len(measured.z)} heights over {in_mm(measured.length, 4)}"
        case HeightMap():
            size = " x ".join(in_mm(length, 4) for length in measured.length)
            return "map", f"{' x '.join(map(str, measured.z.shape))} heights over {size}"
        case Spectrum():
            height, slope = in_mm(measured.rms_height, 3), measured.rms_gradient()
            points = len(measured.density)
            return "spectrum", f"{points} points, rms height {height}, rms slope {slope:.3g}"
        case Sweeps():
            return "ramp" if measured.is_ramp else "sweeps", measured.summary()
        case MasterCurve():
            hertz = measured.frequency
            return "master-curve", f"{len(hertz)} rows, {least_to_most(hertz)} Hz"
        case ShiftTable():
            celsius = measured.temperature - ZERO_CELSIUS
            return "shift", f"{len(celsius)} shift factors from {least_to_most(celsius)} °C"
        case MeasuredFriction():
            speed = measured.speed
            return "friction", f"{len(speed)} values at {least_to_most(speed)} m/s"
    strains = np.concatenate([100.0 * sweep.strain for sweep in measured])
    conditions = "; ".join(sweep.condition for sweep in measured)
    return "strain-sweep", f"strains of {least_to_most(strains)} %, at {conditions}"
