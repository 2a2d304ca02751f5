"""Models side by side: the ladder, its answer, and the chain against it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.charts.draw import image
from gripscale.core.finding import Finding, Topic, from_json
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.measured_friction import FRICTION_DOUBTS
from gripscale.io.table import Column, Table, digits, fixed, percent, significant
from gripscale.questions.answer.estimate import DIRECT, large_strain_answer
from gripscale.questions.answer.findings import answer_notices, no_answer_notices
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.page import answer_cards, answer_lines, basis_lines
from gripscale.questions.answer.reliance import estimated_names, is_measured, no_answer
from gripscale.questions.answer.variables import (
    HEADINGS,
    SYMBOLS,
    answer_number,
    has_answer,
    is_estimated,
)
from gripscale.questions.chain.findings import comparison_notices
from gripscale.questions.compare.charts import comparison_pictures
from gripscale.questions.compare.charts_of_ladder import flawed, varied
from gripscale.questions.inputs.findings import signed_percent
from gripscale.questions.stored import predicted_tree
from gripscale.questions.view import shown_unit
from gripscale.report import elements
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text
from gripscale.report.failures import Failure, explained
from gripscale.rubber.extrapolation import WORTH_SAYING

COMPARISON = "comparison"  # folder of a comparison in that of the run, and the name of its file
OVER = "over_*.nc"  # files of comparisons over a varied input


@dataclass(frozen=True)
class Compared:
    """The comparisons of one case: under its own load, and over varied inputs."""

    parts: list[xr.Dataset] = field(default_factory=list)

    @property
    def ladder(self) -> xr.Dataset | None:
        """The comparison under the load of the case; None without one."""
        return next((data for data in self.parts if not varied(data)), None)

    @property
    def over(self) -> list[xr.Dataset]:
        """The comparisons over varied inputs."""
        return [data for data in self.parts if varied(data)]


def stored_comparisons(folder: Path) -> Compared:
    """Read the comparisons in `folder`."""
    paths = [folder / f"{COMPARISON}.nc", *sorted(folder.glob(OVER))]
    return Compared([predicted_tree(path).to_dataset() for path in paths if path.is_file()])


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


def remarks(comparison: xr.Dataset) -> Iterator[str]:
    """Yield what a table of one load cannot say: failures, and effects that models leave out."""
    for at, bad in enumerate(flawed(comparison)):
        if bad:
            yield f"{comparison.label.values[at]}: {comparison.status.values[at]}."
    yield from temperature_only(comparison)


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


def ladder_cards(ladder: xr.Dataset | None) -> Iterator[Card]:
    """Yield the answer, or else area and friction of the first model."""
    if ladder is None:
        return
    if has_answer(ladder):
        yield from answer_cards(ladder)
        return
    member = ladder.isel(model=0)
    bad = bool(flawed(member))
    for name, symbol in SYMBOLS.items():
        words = f"{HEADINGS[name].capitalize()} {symbol}"
        detail = f"{member.label.item()}; ± {elements.percent_text(member[f'{name}_uncertainty'])}"
        yield Card(words, elements.number_text(member[f"total_{name}"]), detail, bad)


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


def comparison_lines(comparison: xr.Dataset) -> Iterator[str]:
    """Yield the answer as `gripscale run` has it, what large strain makes of it, and its basis."""
    lead, *basis = answer_lines(comparison)
    yield lead
    yield from (f"  {line}" for line in large_strain_lines(comparison))
    yield from basis


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


def comparison_failures(comparison: xr.Dataset) -> Iterator[tuple[str, Failure]]:
    """Yield where a model has a sample that did not converge, and what it says."""
    axis = varied(comparison)
    points = [{axis: at} for at in range(comparison.sizes[axis])] if axis else [{}]
    for point in points:
        data, where = comparison.isel(point), ""
        if axis:
            value = shown_unit(comparison[axis]).text(float(data[axis]), 4)
            where = f"{axis.replace('_', ' ')} {value}, "
        words = model.status_words(data, "status").values
        for label, text, word in zip(data.label.values, data.status.values, words, strict=True):
            if str(text) != CONVERGED:
                yield f"{where}{label}", Failure(str(text), str(word))


_LADDER = (
    "All models use the same measurements. From each model to the next one assumption is given up. "
    "A factor relates a model to the one before, a theory to the direct contact of the measured "
    "profile. Spread is the standard deviation over the samples, error the estimate of the model "
    "itself; both are relative."
)


def comparison_page(compared: Compared) -> Page:
    """Return the report of a comparison alone."""
    first, ladder = compared.parts[0], compared.ladder
    case = case_title(first.attrs)
    elements = comparison_elements(compared)
    return Page.of(
        f"Models side by side: {case}",
        str(first.attrs.get("title", "")),
        [
            *from_json(str(first.attrs.get(FRICTION_DOUBTS, ""))),
            *([*no_answer_notices(ladder), *answer_notices(ladder)] if ladder is not None else ()),
            *(element for element in elements if isinstance(element, Finding)),
        ],
        ladder_cards(ladder),
        [Section("comparison", "Models side by side", elements), rerun_section(first.attrs)],
        () if ladder is None else [*large_strain_lines(ladder), *basis_lines(ladder)],
    )


def comparison_elements(compared: Compared) -> list[Element]:
    """Return tables and figures of what there is; nothing if there is nothing."""
    if not compared.parts:
        return []
    elements: list[Element] = [Text(_LADDER)]
    for data in compared.parts:
        level = "warning" if is_estimated(data, "contact_fraction") else "error"
        for where, failure in comparison_failures(data):
            text = f"{explained(replace(failure, sentence=f'{where}: {failure}'))}."
            elements.append(Finding(level, text, topic=Topic.SOLUTION))
    for data in compared.over:
        over = f"Over {varied(data).replace('_', ' ')}"
        for notice in comparison_notices(data):
            elements.append(replace(notice, sentence=f"{over}, {notice.sentence}"))
    ladder = compared.ladder
    if ladder is not None:
        elements.append(comparison_table(ladder))
        elements += map(Text, temperature_only(ladder))
        elements += map(image, comparison_pictures(ladder))
    for data in compared.over:
        elements += [axis_table(data, varied(data), name) for name in SYMBOLS]
        elements += map(image, comparison_pictures(data))
    return elements
