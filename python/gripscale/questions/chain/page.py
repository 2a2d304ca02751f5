"""The chain of waves as tables and a chapter: what each wave receives, its contact and its heat."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.charts.draw import panels_on_page
from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import Column, Table, fixed, significant, whole_number
from gripscale.model import with_adhesive
from gripscale.questions.answer import variables
from gripscale.questions.answer.reliance import is_measured
from gripscale.questions.chain import findings
from gripscale.questions.chain.charts import contact_sheet
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.inputs.page import numbers
from gripscale.report.elements import Element, Section, Text
from gripscale.wave.result import LARGE_MISMATCH

if TYPE_CHECKING:
    import xarray as xr

_WAVELENGTH = Column("wavelength", heading="λ", unit="mm", size=MILLI)
# A narrow terminal shows the two groups below each other.
OF_WAVES = [
    _WAVELENGTH,
    Column("amplitude", (), "A", "mm", MILLI, group="load"),
    Column("slope", (), "slope", "2πA/λ", group="load"),
    Column("pressure_received", (), "p", group="load"),
    Column("modulus", (), "|E*|", "MPa", MEGA, group="load"),
    Column("loss_factor", (), "tan δ", group="load"),
    Column("contact_fraction", (), "area", "wave", group="contact"),
    Column("running_contact_fraction", (), "area", "A_r/A_0", group="contact"),
    Column("friction", (), "μ", "wave", group="contact"),
    Column("running_friction", (), "μ", "sum", group="contact"),
    Column("friction_from_dissipation", (), "μ", "losses", group="contact"),
]
ITERATIONS = Column(
    "newton_iterations", (), "Newton", "steps", format=whole_number, group="contact"
)
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
# Columns that say nothing of rubber at rest.
MOVING_ONLY = {"loss_factor", "friction", "running_friction", "friction_from_dissipation"}
# Columns in the unit of a key of the case.
_GIVEN = {"pressure_received": "pressure"}
LEGEND = (
    "area: contact length over wavelength, and A_r/A_0 down to the wave; μ: of the wave, summed "
    "down to it, and of the wave from the energy lost; |E*| and tan δ at 2πv/λ."
)
_TITLE = f"{variables.OF_THE_PAPER[0].upper()}{variables.OF_THE_PAPER[1:]}"
_STAR = "* the wave, or a harmonic of it, excites the rubber beyond the measured frequencies:"


def filled(view: PredictionView, column: Column) -> Column:
    """Return a column with the numbers of a prediction, NaN where it is at rest."""
    if column.name in _GIVEN:
        display_unit = view.display_unit(_GIVEN[column.name])
        column = replace(column, unit=display_unit.unit, size=display_unit.divisor)
    values = np.full(view.waves, np.nan)
    if view.has(column.name) and (view.moving or column.name not in MOVING_ONLY):
        values = view.column(column.name)
    return column.of(values, bad=~view.converged)


def prediction_table(data: xr.Dataset, title: str) -> Table:
    """Return one row a wave of a prediction, with its totals and what to know of them below.

    `data` is the answer of any model; of one without waves only the totals are shown.
    """
    view = PredictionView(data)
    notes = [totals(data), *filter(None, [findings.exponent_sentence(data)])]
    beyond = findings.prediction_sentence(view)
    if not view.waves:
        return Table("waves", [], title, [*notes, *filter(None, [beyond])])
    ends = [filled(view, Column(f"{end}_stretch")).values for end in ("min", "max")]
    columns = [
        numbers("wave", view.waves, "#"),
        *(filled(view, column) for column in OF_WAVES),
        Column("stretch", np.stack(ends, 1), None, "min-max", format=fixed(2), group="contact",
               joint="-"),
        filled(view, ITERATIONS),
        Column("status", [view.why(i) for i in range(view.waves)], group="contact", words=True),
    ]  # fmt: skip
    if view.moving and view.converged.all():
        apart = view.column("friction_mismatch").max()
        cure = "; take a finer mesh" if apart > LARGE_MISMATCH else ""
        notes.append(
            f"The two friction coefficients of a wave are at most {apart:.2%} apart{cure}."
        )
    if beyond:
        notes.append(f"{_STAR} {beyond}")
        marks = ["*" if flag else "" for flag in view.column("outside_band")]
        columns = [replace(c, marks=marks) if c.name == "loss_factor" else c for c in columns]
    notes += findings.conditions_notes(view)
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
    columns = [numbers("wave", view.waves, "#"), *(filled(view, c) for c in (_WAVELENGTH, *_HEAT))]
    return Table("heat", columns, "Temperature of the rubber on each wave")


def chain_tables(chain: xr.Dataset) -> list[Table]:
    """Return the waves of a chain and, solved with heat, how warm the rubber is on each."""
    tables = [prediction_table(chain, PredictionView(chain).title)]
    return tables + ([heat_table(chain)] if "contact_temperature" in chain else [])


def waves_in_brief(chain: xr.Dataset) -> Table:
    """Return the waves of a chain with the columns that a screen has room for."""
    view = PredictionView(chain)
    dropped = ("slope", "friction_from_dissipation")
    kept = (replace(column, group="") for column in OF_WAVES if column.name not in dropped)
    columns = [numbers("wave", view.waves, "#"), *(filled(view, column) for column in kept)]
    return Table("waves", columns, _TITLE, bad=~view.converged)


def judgement(chain: xr.Dataset, answer: xr.Dataset) -> str:
    """Return how the chain of waves compares with the answer of a measured surface, or failed."""
    view = PredictionView(chain)
    if not view.complete:
        return f"For comparison, {variables.OF_THE_PAPER}: {totals(chain)}"
    texts = []
    for name in reversed(variables.SYMBOLS) if view.moving else ["contact_fraction"]:
        both = with_adhesive(chain) if name == "friction" else None
        value = view.total(name) if both is None else float(both)
        text = f"{variables.SYMBOLS[name]} = {significant(value)}"
        if variables.has_answer(answer):
            ratio = significant(value / variables.answer_number(answer, name).value, 2)
            text += f", {ratio} times that of the answer"
        texts.append(text)
    return (
        f"For comparison, {variables.OF_THE_PAPER}: {'; '.join(texts)}. "
        "`gripscale compare` shows the cost of each assumption."
    )


def chain_section(chain: xr.Dataset, answer: xr.Dataset) -> Section:
    """Return the chapter of the chain; beside the answer of a measured surface a comparison."""
    view = PredictionView(chain, PredictionView(chain).title.lower())
    title = "Contact and friction, wave by wave"
    judge: dict[str, xr.Dataset] = {}
    elements: list[Element] = []
    if is_measured(answer):
        title, judge = f"{_TITLE}, for comparison", {variables.JUDGE: answer}
        elements.append(Text(judgement(chain, answer)))
    waves, *heat = chain_tables(chain)
    elements += [replace(waves, name="chain"), *heat]
    if view.waves:
        panels = contact_sheet({view.name: chain} | judge).panels
        elements += panels_on_page(panel for panel in panels if panel.marks)
    return Section("chain", title, elements)
