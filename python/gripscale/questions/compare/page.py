"""Models side by side in tables and sentences: the ladder, and what large strain makes of it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.io.table import Column, Table, digits, fixed, percent, significant
from gripscale.questions.answer.estimate import DIRECT, large_strain_answer
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.reliance import estimated_names, is_measured, no_answer
from gripscale.questions.answer.variables import (
    HEADINGS,
    SYMBOLS,
    answer_number,
    has_answer,
    is_estimated,
)
from gripscale.questions.compare.charts import flawed
from gripscale.questions.inputs.record import signed_percent
from gripscale.questions.view import shown_unit
from gripscale.rubber.extrapolation import WORTH_SAYING

TINY = 0.05  # per cent below which a spread or an error is as good as none
_NOTE = (
    "×: factor on the model before; for theories, on the direct contact. Exponents: "
    "d ln/d ln of the smallest wavelength that counts, over its last octave. Beyond band (*): "
    "share of the friction at frequencies beyond those of the master curve, and how far they go."
)


def comparison_table(comparison: xr.Dataset) -> Table:
    """Return area and friction of each model of the ladder, with all that qualifies them.

    Spread and error are relative to the number, the factor is from the model before. `comparison`
    has no axis but `model`.
    """

    def per_cent(value: float) -> str:
        return "0" if value < TINY else significant(value, 2)

    beyond = comparison[model.FRICTION_OUTSIDE_BAND].values
    good, count = comparison.converged_samples.values, comparison.samples.values
    samples = [str(n) if k == n else f"{k}/{n}" for k, n in zip(good, count, strict=True)]
    marks = [" *" if share > WORTH_SAYING else "" for share in beyond]
    columns = [Column("model", comparison.label.values, marks=marks)]
    for name, symbol in SYMBOLS.items():
        value, group = comparison[f"total_{name}"].values, HEADINGS[name]
        columns.append(Column(f"total_{name}", value, symbol, group=group))
        if name == "friction":
            lost = comparison.total_friction_from_dissipation.values
            columns.append(Column("friction_from_dissipation", lost, "μ", "losses", group=group))
            both = model.with_adhesive(comparison)
            if both is not None:
                total = both.values
                columns.append(Column("with_area_term", total, "μ", "+ area term", group=group))
        for part in ("spread", "error"):
            column = f"{name}_{part}"
            share = comparison[column].values / np.where(value == 0.0, np.nan, value)
            columns.append(Column(column, share, part, "%", 0.01, format=per_cent, group=group))
        factors = comparison[f"{name}_factor"].values
        columns.append(Column(f"{name}_factor", factors, "×", group=group))
    columns.append(Column("samples", samples, "n", words=False))
    for name, symbol in zip(model.CUT_OFF_EXPONENTS, SYMBOLS.values(), strict=True):
        missing = np.full(len(samples), np.nan)
        values = comparison[name].values if name in comparison else missing
        columns.append(Column(name, values, symbol, group="exponents", format=fixed(2)))
    columns.append(
        Column("friction_outside_band", beyond, "μ", "beyond", group="band", format=percent)
    )
    far = Column("", unit="decades", group="band", format=digits(2))
    for end in ("below", "above"):
        decades = comparison[f"total_decades_{end}_band"].values
        columns.append(far.of(decades, name=f"decades_{end}_band", heading=end))
    strong = [i for i, name in enumerate(comparison.model.values) if str(name) == DIRECT]
    return Table(
        "ladder", columns, "The ladder of models", [_NOTE], bad=flawed(comparison), strong=strong
    )


def axis_table(comparison: xr.Dataset, axis: str, name: str) -> Table:
    """Return `contact_fraction` or `friction` of each model over the axis that was varied."""
    data = comparison.transpose(axis, ...)
    failed = flawed(data)
    beyond = data[model.FRICTION_OUTSIDE_BAND].values > WORTH_SAYING
    words, unit = axis.replace("_", " "), shown_unit(comparison[axis])
    look = unit.unit, unit.divisor, unit.zero, "{:.3g}".format
    columns = [Column(axis, data[axis].values, words, *look)]
    for at, member in enumerate(data.model.values):
        flags = zip(failed[:, at], beyond[:, at], strict=True)
        marks = [("!" if bad else "") + ("*" if far else "") for bad, far in flags]
        values = data[f"total_{name}"].values[:, at]
        heading = str(member).replace("_", " ")
        columns.append(Column(str(member), values, heading, marks=marks, bad=failed[:, at]))
    if is_estimated(data, name) and is_measured(data):
        texts = [str(answer_number(data.isel({axis: i}), name)) for i in range(data.sizes[axis])]
        columns.insert(1, Column("answer", texts, "answer (90 %)", words=False))
    caption = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]} over {words}"
    return Table(f"over-{axis}-{name}", columns, caption)


# Which models of a comparison have an effect.
_MODELS_WITH = {
    "softening": "Softening: in the chains, the direct contacts and Persson's theory.",
    "heat": "Heat: in the chains and the direct contacts.",
}


def temperature_only(comparison: xr.Dataset) -> Iterator[str]:
    """Yield which models leave effects out, where strain or heat change the rubber."""
    asked = json.loads(comparison.attrs.get("conditions", "null")) or {}
    if asked.get("water") is not None:
        yield "Water: in the direct contacts of maps. All other models are dry."
    effects = [text for name, text in _MODELS_WITH.items() if asked.get(name) is not None]
    if effects:
        yield " ".join([*effects, "Else only the temperature before the contact counts."])


def best_line(comparison: xr.Dataset) -> str:
    """Return the answer in one line, the same in every version: scripts read it."""
    doubt = "; not to be relied on" if no_answer(comparison) else ""
    return f"Best estimate ({100.0 * LEVEL:.0f} %): {with_half_widths(comparison)}{doubt}"


def with_half_widths(answer: xr.Dataset) -> str:
    """Return area and friction of an answer with the half widths of their intervals."""
    texts = []
    for symbol, name in (("A_r/A_0", "contact_fraction"), ("mu", "friction")):
        number = answer_number(answer, name)
        width = 0.5 * (number.high - number.low) / (number.value or math.nan)
        spread = f" ± {100.0 * width:.2g} %" if math.isfinite(width) else ""
        texts.append(f"{symbol} = {significant(number.value)}{spread}")
    return ", ".join(texts)


def large_strain_lines(comparison: xr.Dataset) -> Iterator[str]:
    """Yield what the answer becomes with large strain solved, where it was."""
    large = large_strain_answer(comparison)
    if large is None or not has_answer(large):
        return
    texts = []
    for name in estimated_names(large):
        number = answer_number(large, name)
        change = signed_percent(number.value / answer_number(comparison, name).value - 1.0)
        texts.append(f"{SYMBOLS[name]} = {number}, {change}")
    yield f"With large strain solved on windows: {'; '.join(texts)}."
