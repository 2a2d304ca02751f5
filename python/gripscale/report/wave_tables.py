"""The tables per wave: every column of the result, the predictions side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.charts.page_elements import NONE, Heading, Table, number, percent, whole
from gripscale.charts.view import PredictionView
from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS


@dataclass(frozen=True)
class Column:
    """A column of the result: its name there, its heading, and how its values are shown."""

    name: str
    heading: str
    unit: str = ""
    show: Callable[[float], str] = number
    moving_only: bool = False
    given: str = ""
    """The key of the load whose unit it has, in place of `unit`."""

    def unit_in(self, one: PredictionView) -> str:
        """Return its unit in a table of a prediction."""
        return one.shown(self.given).unit if self.given else self.unit

    def cell(self, one: PredictionView, i: int) -> str:
        """Return its text for wave `i` of a prediction."""
        value = float(one.column(self.name)[i])
        return self.show(float(one.shown(self.given).of(value)) if self.given else value)


def _in(unit: float, digits: int = 3) -> Callable[[float], str]:
    return lambda value: number(value, unit, digits)


def _plain(value: float) -> str:
    return whole(value) if float(value).is_integer() else number(value)


def _celsius(value: float) -> str:
    return number(value - ZERO_CELSIUS)


def _kelvin(value: float) -> str:
    """Return a difference of temperatures to a hundredth of a kelvin."""
    return NONE if math.isnan(value) else f"{value + 0.0:z.2f}".replace("-", "−")


def _yes_no(value: float) -> str:
    return NONE if np.isnan(value) else "yes" if value else "no"


WAVE = [
    Column("wavelength", "λ", "mm", _in(MILLI)),
    Column("amplitude", "A", "mm", _in(MILLI)),
    Column("slope", "slope", "2πA/λ"),
]
LOAD = [
    Column("pressure_received", "p", given="pressure"),
    Column("sliding_speed", "v", moving_only=True, given="speed"),
    Column("load_time", "load time", "s"),
    Column("angular_frequency", "ω", "rad/s", moving_only=True),
    Column("modulus", "|E*|", "MPa", _in(MEGA)),
    Column("loss_factor", "tan δ", moving_only=True),
    Column("outside_band", "beyond band", show=_yes_no, moving_only=True),
    Column("decades_below_band", "below band", "decades", moving_only=True),
    Column("decades_above_band", "above band", "decades", moving_only=True),
]
CONTACT = [
    Column("contact_length", "contact length", "mm", _in(MILLI)),
    Column("contact_fraction", "area", "of the wave"),
    Column("running_contact_fraction", "area", "A_r/A_0 so far"),
    Column("friction", "μ", "of the wave", moving_only=True),
    Column("running_friction", "μ", "sum so far", moving_only=True),
    Column("friction_from_dissipation", "μ", "from energy lost", moving_only=True),
]
ERRORS = [
    Column("friction_mismatch", "mismatch of μ", "", percent, moving_only=True),
    Column("friction_bound", "allowed", "difference of μ", moving_only=True),
    Column("contact_fraction_error", "est. error", "area"),
    Column("friction_error", "est. error", "μ", moving_only=True),
    Column("min_stretch", "stretch", "least"),
    Column("max_stretch", "stretch", "largest"),
]
CONDITIONS = [
    Column("strain", "strain", "%", _in(0.01)),
    Column("storage_modulus_ratio", "E′ left", "", percent),
    Column("loss_modulus_ratio", "E″ left", "", percent),
    Column("series_misfit", "misfit", "of the series", percent),
    Column("strain_extrapolated", "beyond sweep", show=_yes_no),
    Column("flash_temperature_rise_uniform", "warming", "uniform, K", _kelvin),
    Column("flash_temperature_rise_larger_waves", "warming", "larger waves, K", _kelvin),
    Column("flash_temperature_rise_own", "warming", "own, K", _kelvin),
    Column("temperature", "temperature", "°C", _celsius),
    Column("contact_temperature", "in contact", "°C", _celsius),
    Column("temperature_extrapolated", "beyond shift", show=_yes_no),
    Column("passes", "passes", "", whole),
]
SOLUTION = [
    Column("residual", "residual", "force", _in(1.0, 2)),
    Column("load_steps", "load steps", "", whole),
    Column("newton_iterations", "Newton iterations", "", whole),
]
MESH = [
    Column("columns", "columns", "", whole),
    Column("coarser_columns", "columns", "of the coarser mesh", whole),
    Column("rows", "rows", "", whole),
    Column("depth", "depth", "wavelengths"),
    Column("element_order", "order", "", whole),
    Column("indentation", "indentation", "mm", _in(MILLI)),
    Column("load_reached", "load reached", "", percent),
]
NOTE = f"{NONE}: not reached, not defined, or not usable because the wave did not converge."


def wave_tables(predictions: Sequence[PredictionView]) -> list[Table]:
    """Return the tables of load, contact, errors, solution and mesh, and of any further column."""
    if not predictions:
        return []
    tables = [
        _table("load", "What each wave receives, and the rubber there", predictions, LOAD),
        _table("contact", "Contact and friction of each wave", predictions, CONTACT),
        _table("conditions", "The rubber in its conditions", predictions, CONDITIONS),
        _table("errors", "Errors and stretches of each wave", predictions, ERRORS),
        _table("solution", "Solution of each wave", predictions, SOLUTION, status=True),
        _table("mesh", "Mesh of each wave", predictions, MESH),
        _table("further", "Further columns of the result", predictions, _further(predictions)),
    ]
    return [table for table in tables if len(table.headings) > 2]


def _further(predictions: Sequence[PredictionView]) -> list[Column]:
    """Return a column for every number per wave that no other table shows."""
    known = {
        column.name for column in [*WAVE, *LOAD, *CONTACT, *CONDITIONS, *ERRORS, *SOLUTION, *MESH]
    }
    found: dict[str, Column] = {}
    for name, variable in (item for one in predictions for item in one.data.data_vars.items()):
        if name not in known and variable.dims == ("scale",) and variable.dtype.kind in "fiu":
            unit = str(variable.attrs.get("units", ""))
            found.setdefault(
                str(name), Column(str(name), str(name), "" if unit == "1" else unit, _plain)
            )
    return list(found.values())


def _table(
    name: str,
    caption: str,
    predictions: Sequence[PredictionView],
    columns: Sequence[Column],
    *,
    status: bool = False,
) -> Table:
    shown = [[c for c in columns if _applies(one, c)] for one in predictions]
    own = WAVE if name == "load" else WAVE[:1]
    headings = [Heading("wave"), *(Heading(c.heading, c.unit) for c in own)]
    groups = [("", len(headings))]
    for one, each in zip(predictions, shown, strict=True):
        headings += [Heading(c.heading, c.unit_in(one)) for c in each]
        headings += [Heading("status", words=True)] * status
        groups.append((one.title, len(each) + status))
    longest = max(predictions, key=lambda one: one.waves)
    rows = []
    for i in range(longest.waves):
        row = [str(i + 1), *(c.cell(longest, i) for c in own)]
        for one, each in zip(predictions, shown, strict=True):
            row += _cells(one, each, i, status=status)
        rows.append(row)
    bad = _failed(predictions, [count for _, count in groups])
    used = [(label, count) for label, count in groups if count]
    if len(used) == 1:
        headings = headings[:1]
    note = NOTE if any(NONE in row for row in rows) else ""
    return Table(name, caption, headings, rows, used, bad, note)


def _failed(
    predictions: Sequence[PredictionView], counts: Sequence[int]
) -> frozenset[tuple[int, int]]:
    """Return the cells of waves that did not converge, and the numbers of those waves."""
    bad = set()
    first = counts[0]
    for one, count in zip(predictions, counts[1:], strict=True):
        for i in map(int, np.flatnonzero(~one.converged)):
            bad |= {(i, 0), *((i, first + j) for j in range(count))}
        first += count
    return frozenset(bad)


def _applies(one: PredictionView, column: Column) -> bool:
    return one.has(column.name) and (one.moving or not column.moving_only)


def _cells(one: PredictionView, columns: Sequence[Column], i: int, *, status: bool) -> list[str]:
    """Return the cells of wave `i`, which this prediction may not have reached."""
    if i >= one.waves:
        return [NONE] * len(columns) + ["not reached"] * status
    cells = [column.cell(one, i) for column in columns]
    if status:
        state = one.why(i)
        cells.append(state if one.converged[i] else f"NOT CONVERGED: {state}")
    return cells
