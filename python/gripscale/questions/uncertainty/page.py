"""The uncertainty of a case: quantiles, what matters most, and what the samples cannot show."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.charts.draw import image
from gripscale.core.finding import Finding, Topic
from gripscale.io.table import Column, Table, percent
from gripscale.questions import view
from gripscale.questions.answer import page as answer
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.intervals import UPPER_LIMITS, interval_ends
from gripscale.questions.answer.reliance import is_measured, is_moving
from gripscale.questions.answer.variables import (
    SYMBOLS,
    AnswerNumber,
    has_answer,
    of_hysteresis,
)
from gripscale.questions.uncertainty import propagation
from gripscale.questions.uncertainty.charts import axis_of, uncertainty_pictures
from gripscale.questions.uncertainty.next_measurement import next_measurements
from gripscale.questions.uncertainty.sampled_answer import NOT_ALONE, OF_RUN
from gripscale.questions.uncertainty.sources import SOURCES, STATED
from gripscale.questions.uncertainty.variance_shares import SIGNIFICANCE
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Element, Page, Section, Text, as_elements
from gripscale.report.failures import Failure, explained, failures_in

# Symbols of the quantities, in their order.
HEADS = {name: SYMBOLS[name] for name in propagation.PROPAGATED_QUANTITIES}
UNCERTAINTY = (
    "The case was solved many times, each time with other values of the inputs that are not known "
    "exactly. 90 % of the samples of a model lie between its quantiles of 5 and 95 %."
)
# Share of the samples of a model without an answer up to which the others stand for all.
MOST_FAILED = 0.25


def model_places(data: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield what each model and load is called, with its part."""
    for name in data.model.values:
        for label, part in view.points(data.sel(model=name)):
            yield f"{name}{f', {label}' if label else ''}", part


def answer_table(data: xr.Dataset) -> Table:
    """Return the answer at each load."""
    columns = view.number_columns(data, view.answers(data))
    return view.table(data, columns, "answers", f"Answer by {axis_of(data)}")


def interval_sentence(data: xr.Dataset) -> str:
    """Return what the interval of an answer holds, and how that of `gripscale run` differs."""
    count = data.sizes["sample"]
    if not is_measured(data):
        return (
            f"interval: {count} samples of the chain with the errors of the inputs; no measured "
            "surface judges it"
        )
    if DIRECT not in data.model.values:
        return (
            "interval: that of `gripscale run`, without errors of the inputs: the direct contact "
            "was not sampled (model: direct or both)"
        )
    text = f"interval: with the errors of the inputs, from {count} samples"
    # what only a case can state
    if missing := [SOURCES[name].label for name in STATED if name not in data.source]:
        text += f", but for {', '.join(missing)}"
    ranges = []
    for name, symbol in HEADS.items() if not axis_of(data) else ():
        best = f"answer_{name}"
        ends = interval_ends(data[best], data[f"{best}_{OF_RUN}"], UPPER_LIMITS.get(name, math.inf))
        if interval := AnswerNumber(math.nan, *map(float, ends)).interval:
            ranges.append(f"{symbol} {interval}")
    if not ranges:
        return f"{text}; `gripscale run` states sampling of the surface, grid and factors only"
    return f"{text}; `gripscale run`, without them: {', '.join(ranges)}"


def part_tables(data: xr.Dataset) -> Iterator[Table]:
    """Yield what the interval of the answer is made of, at each load, most first.

    At a single load what to measure next stands below.
    """
    for label, part in view.points(data):
        if has_answer(part) and part.sizes["part"]:
            yield part_table(
                part, f"What matters most to the answer{f' ({label})' if label else ''}"
            )
            if not label and is_moving(part) and (table := next_measurements(part)):
                yield table


def part_table(part: xr.Dataset, title: str) -> Table:
    """Return the parts of the interval of an answer: standard errors and shares of variance."""
    names = list(HEADS) if is_moving(part) else ["contact_fraction"]
    ranked = np.argsort(-part[f"answer_{names[0]}_part_error"].values, kind="stable")
    part = part.isel(part=ranked)
    labels = part.part_label.values.tolist()
    columns = [Column("part", labels, "not known")]
    for name in names:
        sigma = part[f"answer_{name}_part_error"].values
        share = sigma**2 / float(part[f"answer_{of_hysteresis(part, name)}_uncertainty"]) ** 2
        of_sum = of_hysteresis(part, name) != name
        group = f"{HEADS[name]} of hysteresis" if of_sum else HEADS[name]
        columns += [
            Column(f"{name}_error", sigma, "±", group=group, format=percent),
            Column(f"{name}_share", share, "share", group=group, format="{:.0%}".format),
        ]
    notes = ["±: standard error of the logarithm; share: its square over that of the interval."]
    if NOT_ALONE in labels:
        notes.append(
            f"{NOT_ALONE[0].upper()}{NOT_ALONE[1:]}: steps, interactions, and what a stretch of "
            "surface does beyond its correlation."
        )
    # NaN where no samples know the error of a share
    error = part[f"answer_{names[0]}_part_share_error"].values
    if unseen := [labels[k] for k in np.flatnonzero(columns[2].values < SIGNIFICANCE * error)]:
        count = part.sizes["sample"]
        notes.append(f"No significant effect with {count} samples: {', '.join(unseen)}.")
    return Table("parts", columns, title, notes)


def share_parts(data: xr.Dataset) -> Iterator[str | Table]:
    """Yield what matters most to the samples of a model whose answer has no parts."""
    without_shares, count = [], data.sizes["sample"]
    for title, part in model_places(data):
        if np.isfinite(part.friction_share).any():
            if str(part.model.item()) != DIRECT:
                yield share_table(part, title)
        elif int(part.failed) < part.sizes["sample"]:
            without_shares.append(title)
    if without_shares:
        where = f" ({'; '.join(without_shares)})" if len(without_shares) > 1 else ""
        moving = bool((data.friction_case > 0.0).any())
        why = f"{count} samples are too few" if moving else "Without friction it is not possible"
        yield f"{why} to split the error between inputs{where}."


def left_out_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield which sources were not sampled, and why."""
    labels: dict[str, list[str]] = {}
    for sentence in json.loads(data.attrs["left_out"]):
        label, why = sentence.split(": ", 1)
        labels.setdefault(why, []).append(label)
    yield from (f"Not sampled: {', '.join(each)}: {why}." for why, each in labels.items())


def quantile_table(data: xr.Dataset) -> Table:
    """Return the quantiles of friction and contact fraction of each model and load."""
    rows = [(title, part, name) for title, part in model_places(data) for name in HEADS]
    quantiles = np.array([part[f"{name}_quantile"].values for _, part, name in rows])
    columns = [
        Column("model", [title for title, _, _ in rows]),
        Column("quantity", [HEADS[name] for _, _, name in rows]),
        Column("case", [float(part[f"{name}_case"]) for _, part, name in rows], "the case"),
        *(
            Column(f"quantile_{level:g}", quantiles[:, at], f"{level:.0%}")
            for at, level in enumerate(propagation.LEVELS)
        ),
        Column("samples", [part.sizes["sample"] for _, part, _ in rows], format="{:.0f}".format),
        Column("failed", [int(part.failed) for _, part, _ in rows], format="{:.0f}".format),
    ]
    return Table(
        "quantiles", columns, "Quantiles of the samples, without the factors of the answer", keys=2
    )


def share_table(part: xr.Dataset, title: str) -> Table:
    """Return the share of each source in the samples of one model at one load, most first."""
    part = part.isel(source=np.argsort(-part.friction_share.values, kind="stable"))
    columns, whole = [Column("source", [*part.label.values.tolist(), NOT_ALONE])], "{:.0%}".format
    for name, symbol in HEADS.items():
        share = part[f"{name}_share"].values
        every = np.maximum([*share, 1.0 - share.sum()], 0.0)
        error = [*part[f"{name}_share_error"].values, np.nan]
        columns += [
            Column(f"{name}_share", every, "share of variance", group=symbol, format=whole),
            Column(f"{name}_share_error", error, "±", group=symbol, format=whole),
        ]
    return Table("shares", columns, f"What matters most ({title})")


def sampling_failure(data: xr.Dataset) -> Failure | None:
    """Return how many samples have no answer, and why most of them; None if all have one."""
    bad, of_case = Counter(failures_in(data, "status")), failures_in(data, "status_case")[:1]
    sentences, failures = [], of_case
    if bad:
        most, count = bad.most_common(1)[0]
        failures = [most, *of_case]
        sentences = [
            f"{bad.total()} of {data.status.size} samples have no answer and count in no quantile; "
            f"{count} of them: {most}"
        ]
    sentences += [f"the case itself has no answer: {failure}" for failure in of_case]
    word = next((failure.word for failure in failures if failure.word), "")
    return Failure("; ".join(sentences), word) if sentences else None


def too_many_failed(data: xr.Dataset) -> bool:
    """Return whether the case has no answer, or too few samples have one to stand for all."""
    return bool(failures_in(data, "status_case")) or bool(
        (data.failed > MOST_FAILED * data.sizes["sample"]).any()
    )


def page_notices(data: xr.Dataset) -> list[Finding]:
    """Return failures: an error where too many failed."""
    failed = sampling_failure(data)
    level = "error" if too_many_failed(data) else "warning"
    return [Finding(level, f"{explained(failed)}.", topic=Topic.SOLUTION)] if failed else []


def uncertainty_page(data: xr.Dataset) -> Page:
    """Return what matters most to an answer with one figure, then the details, folded."""
    case, models = case_title(data.attrs), ", ".join(map(str, data.model.values))
    first, *others = map(image, uncertainty_pictures(data))
    axis, parts = axis_of(data), list(part_tables(data))
    head: list[Element] = [answer_table(data), first] if axis else [first, *parts]
    held, title = interval_sentence(data), "What matters most"
    samples: list[str | Table] = [UNCERTAINTY, quantile_table(data), *left_out_sentences(data)]
    answered = not axis and has_answer(data)
    return Page.of(
        f"Friction and contact area, inputs sampled{f': {case}' if case else ''}",
        f"{data.sizes['sample']} samples; {models}",
        page_notices(data),
        answer.answer_cards(data) if answered else [],
        [
            Section(
                "answer",
                "Answer" if axis else title,
                [*head, Text(f"{held[0].upper()}{held[1:]}.")],
            ),
            Section("parts", title, parts if axis else []),
            Section("samples", "Samples of each model", as_elements(samples)),
            Section(
                "shares",
                "What matters most to the samples",
                [*as_elements(share_parts(data)), *others],
            ),
            rerun_section(data.attrs),
        ],
        answer.basis_lines(data),
    )
