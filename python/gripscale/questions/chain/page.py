"""The waves of a prediction as tables: what each one receives, its contact, errors and mesh.

The terminal shows a choice of the columns that a page shows in several tables, the predictions
beside each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import (
    NONE,
    Column,
    Table,
    digits,
    fixed,
    percent,
    significant,
    whole_number,
    yes_no,
)
from gripscale.model import with_adhesive
from gripscale.questions.chain.findings import (
    conditions_notices,
    exponent_sentence,
    prediction_sentence,
)
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.inputs.page import numbers

if TYPE_CHECKING:
    import xarray as xr

WAVE = [
    Column("wavelength", heading="λ", unit="mm", size=MILLI),
    Column("amplitude", heading="A", unit="mm", size=MILLI),
    Column("slope", heading="slope", unit="2πA/λ"),
]
_LOAD = [
    Column("pressure_received", heading="p"),
    Column("sliding_speed", heading="v"),
    Column("load_time", heading="load time", unit="s"),
    Column("angular_frequency", heading="ω", unit="rad/s"),
    Column("modulus", heading="|E*|", unit="MPa", size=MEGA),
    Column("loss_factor", heading="tan δ"),
    Column("outside_band", heading="beyond band", format=yes_no),
    Column("decades_below_band", heading="below band", unit="decades"),
    Column("decades_above_band", heading="above band", unit="decades"),
]
CONTACT = [
    Column("contact_length", heading="contact length", unit="mm", size=MILLI),
    Column("contact_fraction", heading="area", unit="wave"),
    Column("running_contact_fraction", heading="area", unit="A_r/A_0"),
    Column("friction", heading="μ", unit="wave"),
    Column("running_friction", heading="μ", unit="sum"),
    Column("friction_from_dissipation", heading="μ", unit="losses"),
]
# What warms the rubber of a wave, and how warm it is.
_RISE = "flash_temperature_rise_"
_CELSIUS: dict[str, Any] = {"zero": ZERO_CELSIUS, "format": fixed(1)}
_HEAT = [
    Column(f"{_RISE}uniform", (), "warming", "uniform, K", format=fixed(2)),
    Column(f"{_RISE}larger_waves", (), "warming", "larger waves, K", format=fixed(2)),
    Column(f"{_RISE}own", (), "warming", "own, K", format=fixed(2)),
    Column("temperature", (), "temperature", "where lost, °C", **_CELSIUS),
    Column("contact_temperature", (), "temperature", "in contact, °C", **_CELSIUS),
]
_CONDITIONS = [
    Column("strain", heading="strain", unit="%", size=0.01),
    Column("storage_modulus_ratio", heading="E′ left", format=percent),
    Column("loss_modulus_ratio", heading="E″ left", format=percent),
    Column("series_misfit", heading="misfit", unit="of the series", format=percent),
    Column("strain_extrapolated", heading="beyond sweep", format=yes_no),
    *_HEAT,
    Column("temperature_extrapolated", heading="beyond shift", format=yes_no),
    Column("passes", heading="passes", format=whole_number),
]
ERRORS = [
    Column("friction_mismatch", heading="mismatch of μ", format=percent),
    Column("friction_bound", heading="allowed", unit="difference of μ"),
    Column("contact_fraction_error", heading="est. error", unit="area"),
    Column("friction_error", heading="est. error", unit="μ"),
    Column("min_stretch", heading="stretch", unit="least", format=fixed(2)),
    Column("max_stretch", heading="stretch", unit="largest", format=fixed(2)),
]
SOLUTION = [
    Column("residual", heading="residual", unit="force", format=digits(2)),
    Column("load_steps", heading="load steps", format=whole_number),
    Column("newton_iterations", heading="Newton", unit="steps", format=whole_number),
]
MESH = [
    Column("columns", heading="columns", format=whole_number),
    Column("coarser_columns", heading="columns", unit="of the coarser mesh", format=whole_number),
    Column("rows", heading="rows", format=whole_number),
    Column("depth", heading="depth", unit="wavelengths"),
    Column("element_order", heading="order", format=whole_number),
    Column("indentation", heading="indentation", unit="mm", size=MILLI),
    Column("load_reached", heading="load reached", format=percent),
]
# Columns that say nothing of rubber at rest.
MOVING_ONLY = {
    *("sliding_speed", "angular_frequency", "loss_factor"),
    *("outside_band", "decades_below_band", "decades_above_band"),
    *("friction", "running_friction", "friction_from_dissipation"),
    *("friction_mismatch", "friction_bound", "friction_error"),
}
# Columns in the unit of a key of the case.
_GIVEN = {"pressure_received": "pressure", "sliding_speed": "speed"}
# Tables of a page by name: caption and columns.
_TABLES = {
    "load": ("Load and rubber of each wave", _LOAD),
    "contact": ("Contact and friction of each wave", CONTACT),
    "conditions": ("The rubber in its conditions", _CONDITIONS),
    "errors": ("Errors and stretches of each wave", ERRORS),
    "solution": ("Solution of each wave", SOLUTION),
    "mesh": ("Mesh of each wave", MESH),
}
ALL_WAVES = {
    column.name: column for column in chain(WAVE, *(columns for _, columns in _TABLES.values()))
}
_NOTE = f"{NONE}: not reached, not defined, or not usable because the wave did not converge."

# Columns in the terminal; a narrow one shows the two groups below each other.
IN_TERMINAL = {
    "": ("wavelength",),
    "load": ("amplitude", "slope", "pressure_received", "modulus", "loss_factor"),
    "contact": (
        "contact_fraction",
        "running_contact_fraction",
        "friction",
        "running_friction",
        "friction_from_dissipation",
    ),
}
LEGEND = (
    "area: contact length over wavelength, and A_r/A_0 down to the wave; μ: of the wave, summed "
    "down to it, and of the wave from the energy lost; |E*| and tan δ at 2πv/λ."
)
_STAR = "* the wave, or a harmonic of it, excites the rubber beyond the measured frequencies:"


def filled(view: PredictionView, column: Column, rows: int = 0) -> Column:
    """Return a column with the numbers of a prediction, NaN where it is at rest or ended before."""
    if column.name in _GIVEN:
        display_unit = view.display_unit(_GIVEN[column.name])
        column = replace(column, unit=display_unit.unit, size=display_unit.divisor)
    values = np.full(max(rows, view.waves), np.nan)
    if view.has(column.name) and (view.moving or column.name not in MOVING_ONLY):
        values[: view.waves] = view.column(column.name)
    return column.of(values, bad=_failed(view, values.size))


def prediction_table(data: xr.Dataset, title: str) -> Table:
    """Return one row a wave of a prediction, with its totals and what to know of them below.

    `data` is the answer of any model; of one without waves only the totals are shown.
    """
    view = PredictionView(data)
    notes = [totals(data), *filter(None, [exponent_sentence(data)])]
    beyond = prediction_sentence(view)
    if not view.waves:
        return Table("waves", [], title, [*notes, *filter(None, [beyond])])
    columns = [
        numbers("wave", view.waves, "#"),
        *(
            replace(filled(view, ALL_WAVES[name]), group=group)
            for group, names in IN_TERMINAL.items()
            for name in names
        ),
    ]
    ends = [filled(view, ALL_WAVES[f"{end}_stretch"]).values for end in ("min", "max")]
    stretch = Column("stretch", np.stack(ends, 1), unit="min-max", format=fixed(2), joint="-")
    states = Column("status", [view.why(i) for i in range(view.waves)], words=True)
    iterations = filled(view, ALL_WAVES["newton_iterations"])
    columns += [replace(column, group="contact") for column in (stretch, iterations, states)]
    if view.moving and view.converged.all():
        apart = view.column("friction_mismatch").max()
        notes.append(f"The two friction coefficients of a wave are at most {apart:.2%} apart.")
    if beyond:
        notes.append(f"{_STAR} {beyond}")
        marks = ["*" if flag else "" for flag in view.column("outside_band")]
        columns = [replace(c, marks=marks) if c.name == "loss_factor" else c for c in columns]
    notes += [notice.sentence for notice in conditions_notices(view)]
    return Table("waves", columns, title, notes, keys=2, bad=~view.converged)


def totals(data: xr.Dataset) -> str:
    """Return the sentence with the real contact area and the friction of a prediction."""
    view = PredictionView(data)
    if not view.converged.all():
        return f"No totals: wave {view.waves} did not converge ({view.why(view.waves - 1)})."
    if not view.waves and view.status != CONVERGED:
        return f"No totals: {view.status}."
    waves = f"{view.waves} wave{'s' if view.waves != 1 else ''}: " if view.waves else ""
    area = f"{waves}real contact area A_r/A_0 = {significant(view.total('contact_fraction'))}"
    if not view.moving:
        return f"{area}; no friction at rest."
    friction, losses = (
        significant(view.total(name)) for name in ("friction", "friction_from_dissipation")
    )
    text = f"{area}, friction mu = {friction} ({losses} from dissipation)"
    both = with_adhesive(data)
    return f"{text}." if both is None else f"{text}; with the area term {significant(float(both))}."


def heat_table(data: xr.Dataset) -> Table:
    """Return how warm the rubber is on each wave of a chain solved with heat, and what warms it."""
    view = PredictionView(data)
    columns = (filled(view, column) for column in (WAVE[0], *_HEAT))
    caption = "Temperature of the rubber on each wave"
    return Table("heat", [numbers("wave", view.waves, "#"), *columns], caption)


def wave_tables(predictions: Sequence[PredictionView]) -> list[Table]:
    """Return the tables of a page: those of `_TABLES` and one of any further numbers per wave."""
    if not predictions:
        return []

    def count_or_number(value: float) -> str:
        return whole_number(value) if value.is_integer() else significant(value)

    further: dict[str, Column] = {}
    for name, variable in chain(*(view.data.data_vars.items() for view in predictions)):
        if name not in ALL_WAVES and variable.dims == ("scale",) and variable.dtype.kind in "fiu":
            unit = str(variable.attrs.get("units", "")).replace("1", "")
            further[str(name)] = Column(str(name), unit=unit, format=count_or_number)
    all_tables = _TABLES | {"further": ("Further columns of the result", [*further.values()])}
    longest = max(predictions, key=lambda view: view.waves)
    rows = longest.waves
    failed = np.logical_or.reduce([_failed(view, rows) for view in predictions])
    tables = []
    for name, (caption, columns) in all_tables.items():
        parts = []
        for view in predictions:
            parts += [
                replace(filled(view, column, rows), group=view.title)
                for column in columns
                if view.has(column.name) and (view.moving or column.name not in MOVING_ONLY)
            ]
            if name == "solution":
                states = [
                    f"{'' if good else 'NOT CONVERGED: '}{view.why(i)}"
                    for i, good in enumerate(view.converged)
                ]
                states += ["not reached"] * (rows - view.waves)
                parts.append(Column("status", states, group=view.title, bad=_failed(view, rows)))
        if parts:
            waves = WAVE if name == "load" else WAVE[:1]
            keys = [numbers("wave", rows, bad=failed)]
            keys += [replace(filled(longest, column), bad=()) for column in waves]
            gaps = any("-" in column.texts() for column in parts)
            tables.append(Table(name, [*keys, *parts], caption, [_NOTE] if gaps else []))
    return tables


def _failed(view: PredictionView, rows: int) -> NDArray[np.bool_]:
    """Return which rows are of a wave that did not converge."""
    flags = np.zeros(rows, dtype=bool)
    flags[: view.waves] = ~view.converged
    return flags
