"""Charts of what is not known of a case."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.chart import Bars, CrossLine, Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BLUE, COLOURS, INK, ORANGE
from gripscale.questions.answer.variables import (
    ANSWER,
    AXIS_TITLES,
    answer_number,
    believed,
    of_hysteresis,
)
from gripscale.questions.uncertainty.sampled_answer import NOT_ALONE, TOGETHER
from gripscale.questions.view import dimensions, interval_ends_of, ordinate, plot_axis

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TOTALS = {name: f"{title} [-]" for name, title in reversed(AXIS_TITLES.items())}  # titles of axes
SYMBOL_TEXTS = {"friction": "$\\mu$", "contact_fraction": "$A_r/A_0$"}
AS_STATED = "model, inputs as stated"  # what figures call the case itself, without anything drawn
MOST_BINS = 24
MEDIAN, END = 1.6, 0.9  # widths of the lines at median and ends


def axis_of(data: xr.Dataset) -> str:
    """Return what is varied beside the samples, or nothing."""
    return next(iter(dimensions(data)), "")


def uncertainty_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the parts of the interval, distributions and what matters most; of loads bands."""
    if axis := axis_of(data):
        yield Picture(
            f"over_{axis}",
            band_figure(data, axis),
            f"The answer over the {axis} with its 90 % interval, and of each model the median with "
            "bands of 50 and 90 % of the samples.",
            f"Friction and contact area over the {axis} with their bands.",
        )
        return
    if data.sizes.get("part") and np.isfinite(data.answer_contact_fraction_uncertainty):
        yield Picture(
            "answer",
            parts_figure(data),
            "What the interval of the answer is made of: standard errors, which add up in squares.",
            "Bars for each part of the interval, the most important on top.",
        )
    yield Picture(
        "distributions",
        distribution_figure(data),
        "How friction and contact area are distributed: quantiles of the samples, the model with "
        "the inputs as stated, and the answer.",
        "Histograms of the samples, a row for each model.",
    )


def parts_figure(data: xr.Dataset) -> Figure:
    """Draw the standard errors that the interval of an answer is made of, the largest on top."""
    names = [name for name in _TOTALS if np.isfinite(data[f"answer_{name}_uncertainty"])]
    ranked = np.argsort(data[f"answer_{names[0]}_part_error"].values, kind="stable")
    labels = data.part_label.values[ranked]
    drawn = {*data.label.values.tolist(), NOT_ALONE, TOGETHER}
    rows = PlotAxis(ticks={float(row): str(label) for row, label in enumerate(labels)})
    panels = []
    for name in names:
        sigma = 100.0 * data[f"answer_{name}_part_error"].values[ranked]
        bars: list[Mark] = [
            Bars(0.0, error, row - 0.3, row + 0.3, BLUE if label in drawn else ORANGE)
            for row, (label, error) in enumerate(zip(labels, sigma, strict=True))
        ]
        panels.append(
            Panel(PlotAxis(f"standard error of {SYMBOL_TEXTS[name]} [%]", low=0.0), rows, bars)
        )
    keys = [
        Bars(0, 0, 0, 0, BLUE, "from the inputs, sampled"),
        Bars(0, 0, 0, 0, ORANGE, "from the model"),
    ]
    height = 1.2 + 0.3 * len(ranked)
    return Sheet(panels, height=height, keys=keys, gap=0.03, layout={"sharey": True}).on_paper()


def distribution_figure(data: xr.Dataset) -> Figure:
    """Draw how friction and contact fraction are distributed, a row for each model."""
    panels = []
    for model, colour in zip(data.model.values, COLOURS, strict=False):
        samples = data.sel(model=model)
        count = samples.sizes["sample"] - int(samples.failed)
        for name, label in _TOTALS.items():
            first = name == "friction"
            values = samples[name].values
            answer = answer_number(data, of_hysteresis(data, name))
            marks = list(_distribution(samples, name, values[np.isfinite(values)], colour, answer))
            top = max((float(np.max(m.y1)) for m in marks if isinstance(m, Bars)), default=None)
            panels.append(Panel(
                PlotAxis(label, numbers=6),
                PlotAxis(f"samples (of {count})" if first else "", low=0.0, numbers=5, whole=True,
                     high=None if top is None else 1.45 * top),
                marks,
                title={"direct": "direct contact"}.get(str(model), str(model)),
            ))  # fmt: skip
    keys: list[Mark] = [
        CrossLine(0.0, INK, "median of the samples", width=MEDIAN),
        CrossLine(0.0, INK, "5 and 95 %", width=END),
        Series([], [], INK, AS_STATED, dash="", marker="v"),
    ]
    return Sheet(
        panels, height=1.2 + 1.8 * data.sizes["model"], legend_columns=4, keys=keys
    ).on_paper()


def _distribution(
    samples: xr.Dataset,
    name: str,
    values: np.ndarray,
    colour: str,
    answer: tuple[float, float, float],
) -> Iterator[Mark]:
    if values.size < 2:
        return
    counts, edges = np.histogram(values, min(MOST_BINS, 1 + values.size // 6))
    yield Bars(edges[:-1], edges[1:], 0.0, counts, colour, alpha=0.45)
    low, middle, high = samples[f"{name}_quantile"].values[[0, 2, 4]]
    for at, width in ((low, END), (middle, MEDIAN), (high, END)):
        yield CrossLine(at, INK, width=width, upright=True)
    top = float(np.max(counts))
    case = float(samples[f"{name}_case"])
    yield Series([case], [1.12 * top], INK, dash="", marker="v", clip=False)
    best, low, high = answer
    if np.isfinite(best):
        label = ANSWER if np.isfinite(low) else "answer"
        yield Series([best], [1.29 * top], INK, label, "", marker="*", size=8.0, low=[low],
                     high=[high], level_bars=True, clip=False)  # fmt: skip


def band_figure(data: xr.Dataset, axis: str) -> Figure:
    """Draw the answer over what is varied, and medians with bands of 50 and 90 % of samples."""
    abscissa, x = plot_axis(data[axis])
    panels = []
    for name in _TOTALS:
        marks: list[Mark] = []
        for model, colour in zip(data.model.values, COLOURS, strict=False):
            samples = data.sel(model=model).transpose(axis, ...)
            quantiles = samples[f"{name}_quantile"].values.T
            marks += [
                ShadedBand(x, quantiles[0], quantiles[4], colour, alpha=0.18),
                ShadedBand(x, quantiles[1], quantiles[3], colour, alpha=0.3),
                Series(x, quantiles[2], colour, f"{model}: median, 50 and 90 %"),
                Series(x, samples[f"{name}_case"].values, colour, dash="", marker="o", size=3.5,
                       filled=False, clip=False),
            ]  # fmt: skip
        answer = data[believed(data, name)]
        if ends := interval_ends_of(data, str(answer.name)):
            marks.append(ShadedBand(x, ends[0].values, ends[1].values, INK, alpha=0.12))
        marks.append(Series(x, answer.values, INK, ANSWER))
        panels.append(Panel(abscissa, ordinate(answer), marks))
    case = Series([], [], INK, AS_STATED, dash="", marker="o", size=3.5, filled=False)
    return Sheet(panels, keys=[case]).on_paper()
