"""How measured files are read, for the screen: kinds, columns, first rows and a small picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from gripscale.case_file.kinds import RUBBERS, SURFACES, FileKeys, Taken, take
from gripscale.case_file.proposals import rubber_proposal, surface_proposal
from gripscale.core import ZERO_CELSIUS, Array
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.io.table import Column, Table, least_to_most
from gripscale.rubber import MasterCurve, ShiftTable, StrainSweep, Sweeps
from gripscale.surface import HeightMap, Profile, Spectrum

_ROWS = 5  # first rows that are shown
_WIDTH, _BARS = 60, "▁▂▃▄▅▆▇█"  # letters of a picture
_DECADES = 1.5  # span of numbers from which on a picture has a logarithmic scale
_KELVIN = Column("temperature", unit="°C", zero=ZERO_CELSIUS)
_MODULI = (Column("storage", unit="MPa", size=1e6), Column("loss", unit="MPa", size=1e6))
_HEIGHTS = (Column("x", unit="mm", size=1e-3), Column("z", unit="µm", size=1e-6))
_HERTZ = Column("frequency", unit="Hz")
# Attributes of what was read, as they are shown.
_SHOWN: dict[type, tuple[Column, ...]] = {
    Profile: _HEIGHTS,
    Spectrum: (Column("wavenumber", unit="rad/m"), Column("density", unit="m^4")),
    MasterCurve: (_HERTZ, *_MODULI),
    Sweeps: (_KELVIN, _HERTZ, *_MODULI),
    StrainSweep: (Column("strain", unit="%", size=1e-2), *_MODULI),
    ShiftTable: (_KELVIN, Column("horizontal", heading="log10 a_T")),
    dict: (Column("relaxation_times", unit="s"), Column("moduli", unit="MPa", size=1e6)),
    MeasuredFriction: (Column("speed", unit="m/s"), Column("friction"), _KELVIN),
}


def kinds_table(files: Sequence[Taken]) -> Table:
    """Return what each file is taken for, and why."""
    columns = {
        "file": [file.path.name for file in files],
        "taken for": [file.kind for file in files],
        "why": ["; ".join(filter(None, [file.why, file.titles])) for file in files],
    }
    return Table("files", [Column(name, texts, words=True) for name, texts in columns.items()])


def _in_proposed_units(file: Taken, keys: FileKeys) -> tuple[Taken, list[str]]:
    """Return a file read in the units that `gripscale new` proposes, and why in these."""
    of_surface, name = file.kind in SURFACES, [file.path.name]
    if not file.missing or not (of_surface or file.kind in RUBBERS):
        return file, []
    if of_surface:
        proposal = surface_proposal([file.path], name, step=keys.step, keys=keys.surface)
    else:
        proposal = rubber_proposal([file.path], name, layout=keys.layout)
    units = {key: proposal.keys[key] for key in file.missing}
    reasons = [f"  {key} = {unit}: {proposal.reasons[key]}" for key, unit in units.items()]
    if isinstance(units.get("channel"), list):
        units["channel"] = units["channel"][0]
    table, of_table = ("surface", keys.surface) if of_surface else ("layout", keys.layout)
    read_by: Any = {table: {**of_table, **units}}
    read = take(file.path, replace(keys, **read_by), file.kind)
    return replace(read, columns=file.columns), reasons


def parts_of(file: Taken, keys: FileKeys) -> Iterator[str | Table]:
    """Yield how a file is read: kind, columns, notes, first rows and a picture of each column."""
    file, reasons = _in_proposed_units(file, keys)
    yield f"{file.path.name}: {file.kind}; {file.why}"
    yield from (line for line in (f"  {file.titles}",) if file.titles)
    yield from reasons
    yield from (f"  note: {note}" for note in getattr(file.measured, "notes", ()))
    measured = file.measured[0] if isinstance(file.measured, list) else file.measured
    if isinstance(measured, HeightMap):
        measured = measured.line(measured.z.shape[1] // 2)
        yield "  the middle line along x:"
    columns_of = _SHOWN.get(type(measured), ())
    held = measured if isinstance(measured, dict) else getattr(measured, "__dict__", {})
    columns = [column.of(np.asarray(held[column.name])) for column in columns_of]
    columns = [column for column in columns if np.isfinite(column.values).any()]
    if columns:
        heads = [column.of(column.values[:_ROWS]) for column in columns]
        yield Table("rows", heads, f"The first of {len(columns[0].values)} rows")
    for column in columns[1:]:
        values = (column.values - column.zero) / column.size
        missing = f", {n} missing" if (n := int(np.isnan(values).sum())) else ""
        yield f"{column.head:>12} {_picture(values)} {least_to_most(values)} {column.unit}{missing}"


def _picture(values: Array) -> str:
    """Return a line of bars: means of equal parts, blank where all values are missing."""
    finite = values[np.isfinite(values)]
    if finite.min() > 0.0 and np.log10(finite.max() / finite.min()) > _DECADES:
        values = np.log10(values)
    parts = np.array_split(values, min(_WIDTH, len(values)))
    means = np.array([np.nanmean(p) if np.isfinite(p).any() else np.nan for p in parts])
    low, span = np.nanmin(means), np.ptp(means[np.isfinite(means)]) or 1.0
    bars = np.nan_to_num((len(_BARS) - 1) * (means - low) / span, nan=-1.0).round().astype(int)
    return "".join(_BARS[bar] if bar >= 0 else " " for bar in bars)
