"""Charts of a comparison: from model to model, down to each wavelength, over a varied input."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.charts import chart, style
from gripscale.charts.chart import Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BEYOND_LABEL, BLUE, FAINT, FLAG, GREY, INK, ORANGE, WIDE
from gripscale.core.units import DisplayUnit, display_unit_of
from gripscale.experiment.measured_friction import MeasuredSeries, measured_series
from gripscale.half_space.model import DirectContact
from gripscale.model import with_adhesive
from gripscale.questions import view
from gripscale.questions.answer.intervals import UPPER_LIMITS
from gripscale.questions.answer.variables import AXIS_TITLES, answer_number, believed
from gripscale.questions.view import STAR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ASIDE = ("windows",)  # groups of other surfaces, which only give factors of the answer
# Share of friction or area from which on a wavelength is drawn: longer waves do nothing.
SEEN = 0.01


def flawed(comparison: xr.Dataset) -> NDArray[np.bool_]:
    """Return whether a sample of each model failed."""
    return np.asarray((comparison["converged_samples"] < comparison["samples"]).values)


def varied(comparison: xr.Dataset) -> str:
    """Return the axis of a comparison, or an empty text if nothing was varied."""
    return next((str(dim) for dim in comparison.total_friction.dims if dim != "model"), "")


def on_the_surface(comparison: xr.Dataset) -> xr.Dataset:
    """Return the comparison without the models of other surfaces, unless it has no others."""
    chosen = [str(group) not in ASIDE for group in comparison.group.values]
    return comparison.isel(model=chosen) if any(chosen) else comparison


def by_label(comparison: xr.Dataset) -> xr.Dataset:
    """Return the models called by what figures and texts call them."""
    return comparison.assign_coords(model=("model", comparison["label"].values))


MARKERS = "osD^v"  # of measurements at several temperatures or pressures


def measured_points(data: xr.Dataset, speed_unit: DisplayUnit) -> Iterator[Series]:
    """Yield the points of each measured series over speed, in `speed_unit`, with their spread."""
    for number, series in enumerate(measured_series(data)):
        spread = np.nan_to_num(series.spread)
        ends: dict[str, Any] = {"low": series.friction - spread, "high": series.friction + spread}
        yield Series(speed_unit.of(series.speed), series.friction, INK, series.label, "",
                     marker=MARKERS[number % len(MARKERS)], size=5.5, filled=False, order=5.0,
                     clip=False, **ends)  # fmt: skip


BEST = "answer"


@dataclass(frozen=True)
class Row:
    """A line of the figure: a number, and the bar from the number it follows."""

    label: str
    value: float
    uncertainty: float = math.nan
    before: float = math.nan  # where the bar begins; NaN for none
    factor: float = math.nan
    samples: Sequence[float] = ()
    marker: str = "o"
    colour: str = INK
    filled: bool = True
    note: str = ""  # said in place of a number there is not
    most: float = math.inf  # upper limit of the number, where it has one

    @property
    def ends(self) -> tuple[float, float]:
        """The number less and plus one standard uncertainty; NaN where that is unknown."""
        spread = math.exp(self.uncertainty)
        return self.value / spread, min(self.value * spread, self.most)

    @property
    def numbers(self) -> list[float]:
        """All that is drawn on the line."""
        numbers = (self.value, self.before, *self.samples, *self.ends)
        return [number for number in numbers if math.isfinite(number)]


def rows_of(comparison: xr.Dataset, name: str) -> Iterator[Row]:
    """Yield the lines of one panel, the same in both: models, factors and answer, measurements."""
    comparison, most = on_the_surface(comparison), UPPER_LIMITS.get(name, math.inf)
    totals = comparison[f"total_{name}"].values.tolist()
    values = dict(zip(comparison.model.values, totals, strict=True))
    for at, (member, bad) in enumerate(zip(values, flawed(comparison), strict=True)):
        solved = comparison.isel(model=at)
        theory, judge = str(solved.group.item()) == "theory", member == DirectContact.name
        samples = solved[f"sample_{name}"].values
        yield Row(
            f"{solved.label.item()}{STAR if style.predictions_beyond(solved) else ''}",
            values[member],
            float(solved[f"{name}_uncertainty"]),
            math.nan if theory else values.get(str(solved.follows.item()), math.nan),
            float(solved[f"{name}_factor"]),
            samples[np.isfinite(samples)].tolist() if int(solved.samples) > 1 else (),
            marker="D" if judge else "s" if theory else "o",
            colour=GREY if theory else ORANGE if judge else INK,
            filled=not bad,
            note="failed" if math.isnan(values[member]) and not theory else "none",
            most=most,
        )
    factors = comparison[f"answer_{name}_factor"].values
    answer, value = answer_number(comparison, name), values.get(DirectContact.name, math.nan)
    for at, factor in enumerate(factors if math.isfinite(answer.value) else ()):
        label = f"× {comparison.factor_label.values[at]}"
        if not math.isfinite(factor):
            yield Row(label, math.nan, note="not included")
            continue
        sigma = float(comparison[f"answer_{name}_factor_uncertainty"][at])
        yield Row(label, value * factor, sigma, value, factor, most=most)
        value *= factor
    if math.isfinite(answer.value) and np.isfinite(factors).any():
        width = math.log(answer.value / answer.low) if answer.value > 0.0 else math.nan
        yield Row(BEST, answer.value, width, marker="*", colour=ORANGE, most=most)
    for series in measured_series(comparison):
        point = series.at(float(comparison.nominal_speed)) if name == "friction" else None
        friction, spread = point or (math.nan, math.nan)
        note = "not at this speed" if name == "friction" else "–"
        yield Row(series.label, friction, spread / friction, marker="P", note=note)


# Largest over smallest number of an axis, at least: less has no numbers of a log axis in it.
_LEAST_RANGE = 3.0
HALF = 0.27  # half the height of a bar, in rows


def comparison_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of each model and the factor from the model it follows.

    Dots are the samples. A model with failed samples is open.
    """
    panels = [_ladder_panel(comparison, name) for name in _quantities(comparison)]
    labels = list((panels[0].y.ticks or {}).values())
    star = any(label.endswith(STAR) for label in labels)
    return Sheet(
        panels,
        height=0.95 + 0.33 * len(labels),
        gap=0.05,
        legend="below" if star else "",
        keys=[Series([], [], INK, BEYOND_LABEL, dash="", marker="$*$")] if star else (),
        layout={"sharey": True},
    ).on_paper()


def _quantities(comparison: xr.Dataset) -> list[str]:
    """Return what is drawn of a comparison of one load: no friction at rest."""
    moving = float(comparison.nominal_speed) > 0.0
    return [name for name in AXIS_TITLES if moving or name != "friction"]


def _ladder_panel(comparison: xr.Dataset, name: str) -> Panel:
    rows = list(rows_of(comparison, name))
    numbers = [end for row in rows for end in row.numbers if end > 0.0] or [0.1, 1.0]
    widen = max(_LEAST_RANGE * min(numbers) / max(numbers), 1.0) ** 0.5
    low, high = min(numbers) / widen, max(numbers) * widen
    room = (high / low) ** 0.13
    theories = int((comparison.group == "theory").sum())
    models = on_the_surface(comparison).sizes["model"]
    borders = [models - theories - 0.5, models - 0.5] if theories else [models - 0.5]
    marks: list[Mark] = [chart.CrossLine(at, FAINT, order=0.0) for at in borders]
    for at, (row, follower) in enumerate(pairwise(rows)):
        if math.isfinite(follower.before) and follower.before == row.value:
            marks.append(Series([row.value] * 2, [at, at + 1 - HALF], GREY, width=0.7, order=1.0))
    marks += [mark for at, row in enumerate(rows) for mark in _row_marks(at, row)]
    strong = frozenset(row.label for row in rows if row.colour == ORANGE)
    ticks = {float(at): row.label for at, row in enumerate(rows)}
    x = PlotAxis(f"{AXIS_TITLES[name]} [-]", log=True, low=low / room, high=high * room**3)
    y = PlotAxis("", low=len(rows) - 0.4, high=-0.6, grid=False, bold=strong, ticks=ticks)
    return Panel(x, y, marks, legend="none")


def _row_marks(at: int, row: Row) -> Iterator[Mark]:
    if not (math.isfinite(row.value) and row.value > 0.0):
        yield chart.Note(0.03, at, row.note, GREY, frame="x", italic=True)
        return
    factor = ""
    if math.isfinite(row.before):
        shade = ORANGE if row.value > row.before else BLUE
        least, most = sorted((row.before, row.value))
        yield chart.Bars(least, most, at - HALF, at + HALF, shade, alpha=0.35, order=1.5)
        factor = f"×{row.factor:.2f}"
        yield chart.Note(1.0, at, factor, offset=(3.0, 0.0), frame="x")
    if row.samples:
        yield Series(row.samples, [at] * len(row.samples), GREY, dash="", width=0.8, marker="|",
                     size=6.0)  # fmt: skip
    low, high = ([end] if math.isfinite(end) else None for end in row.ends)
    label, size = f"{row.label} {factor}".strip(), 9.0 if row.marker == "*" else 4.8
    yield Series([row.value], [at], row.colour, label, "", marker=row.marker, size=size,
                 filled=row.filled, low=low, high=high, level_bars=True, order=4.0)  # fmt: skip
    text = f"{row.value:#.2g}".rstrip(".")  # two significant digits, zeros too
    yield chart.Note(max(row.numbers), at, text, offset=(5.0, 0.0))


def _wavelength_panels(comparison: xr.Dataset) -> list[Panel]:
    """Describe area and friction of each model down to each wavelength; nothing without octaves.

    Friction of the direct contacts goes on below the smallest wave, by the edges of the contact.
    """
    data = by_label(on_the_surface(comparison))
    if not data.running_friction.size:  # of maps and windows at finite strain
        return []
    friction = np.abs(data.running_friction)
    begun = friction > SEEN * friction.max("wavelength")
    begun |= data.running_contact_fraction < 1.0 - SEEN
    data = data.isel(wavelength=begun.any("model").values)
    flags = xr.DataArray(False)
    if FLAG in data:
        flags = data[FLAG].copy(data=style.down_to(data[FLAG] == 1))
    panels = []
    for name in _quantities(data) if data.sizes["wavelength"] else ():
        panel = view.panel(data, f"running_{name}", "wavelength", flags=flags)
        label = f"{AXIS_TITLES[name]},\nlonger waves [-]"
        panels.append(replace(panel, y=replace(panel.y, label=label)))
    return panels


def comparison_axis_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of all models over the axis of a comparison, and measurements."""
    return Sheet([_axis_panel(comparison, name) for name in AXIS_TITLES], height=3.7).on_paper()


def _axis_panel(comparison: xr.Dataset, name: str) -> Panel:
    total, axis = f"total_{name}", varied(comparison)
    data = by_label(on_the_surface(comparison))
    spread = data[f"{name}_spread"]
    # a spread above the number itself has no end on a logarithmic axis
    low = np.maximum(data[total] - spread, 1e-3 * data[total])
    high = np.minimum(data[total] + spread, UPPER_LIMITS.get(name, np.inf))
    data = data.assign(spread_low=low, spread_high=high)
    data[total].attrs["interval"] = "spread_low spread_high"
    panel = view.panel(data, total, axis)
    marks, abscissa, x = list(panel.marks), panel.x, view.plot_axis(comparison[axis])[1]
    if np.isfinite(comparison[f"answer_{name}_factor"]).any():
        answer = believed(comparison, name)
        values, low, high = (comparison[f"{answer}{end}"].values for end in ("", "_low", "_high"))
        marks.append(Series(x, values, INK, BEST, "", marker="*", size=8.0, order=4.0, low=low,
                            high=high))  # fmt: skip
    if name == "friction" and (adhesive := with_adhesive(data)) is not None:
        curves = view.panel(data.assign(adhesive=adhesive), "adhesive", axis).marks
        look: dict[str, Any] = {"label": "with the area term", "dash": "dashdot", "marker": ""}
        marks += [replace(mark, width=0.9, **look) for mark in curves if isinstance(mark, Series)]
    if axis == "speed" and name == "friction":
        points = list(measured_points(comparison, view.shown_unit(comparison[axis])))
        marks += points
        ends = [*x, *(speed for series in points for speed in np.asarray(series.x))]
        least, most = float(min(ends)), float(max(ends))
        log = least > 0.0 and most > 8.0 * least
        abscissa = replace(abscissa, log=log, low=least, high=most)
    return Panel(abscissa, replace(panel.y, label=f"{AXIS_TITLES[name]} [-]"), marks)


MOST_COLUMNS = 3
MOST_PANELS = 9  # series that are drawn; more would not be read
LEAST_WIDTH = 4.5  # width below which the legend has no room [inch]


def at_measured_figure(data: xr.Dataset, labels: dict[str, str]) -> Figure:
    """Draw measured friction with its spread, and the total of every model at the same points."""
    colours = style.colours(data.sizes["model"], ordered=False)

    def models(series: MeasuredSeries, speed_unit: DisplayUnit) -> Iterator[Mark]:
        for name, colour in zip(data.model.values.tolist(), colours, strict=True):
            values = data.friction.sel(model=name).values[series.rows]
            if np.isfinite(values).any():
                yield Series(speed_unit.of(series.speed), values, colour, labels.get(name, name),
                             width=1.2, marker="o", size=3.5)  # fmt: skip

    return measured_sheet(data, models, head=1.2).on_paper()


def measured_sheet(
    data: xr.Dataset, marks_of: Callable[[MeasuredSeries, DisplayUnit], Iterable[Mark]], head: float
) -> Sheet:
    """Return a panel for each measured series, its points over the marks of `marks_of`.

    `head` is the height of the legend [inch].
    """
    speed_unit = display_unit_of(data.attrs, "speed")
    x = PlotAxis(f"sliding speed $v$ [{speed_unit.unit}]", log=True)
    y = PlotAxis(f"{AXIS_TITLES['friction']} [-]", low=0.0)
    panels = []
    series = zip(measured_series(data), measured_points(data, speed_unit), strict=True)
    for values, points in islice(series, MOST_PANELS):
        points = replace(points, marker="o", size=4.5, label="measured")
        marks = [*marks_of(values, speed_unit), points]
        panels.append(Panel(x, y, marks, title=values.state))
    columns = min(len(panels), MOST_COLUMNS)
    return Sheet(
        panels,
        columns,
        width=max(WIDE * columns / MOST_COLUMNS, LEAST_WIDTH),
        height=head + 2.2 * -(-len(panels) // columns),
        legend_columns=3 if columns > 1 else 2,
        gap=0.05,
        layout={"sharex": True, "sharey": True},
    )


def comparison_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the figures of a comparison: its ladder and wavelengths, or all over its axis."""
    if axis := varied(data):
        caption = (
            f"Area and friction of every model over {axis.replace('_', ' ')}; bands are the "
            "standard deviation over its samples, dashed is beyond the measured band."
        )
        alt = "Two panels with a curve for each model."
        yield Picture(f"over_{axis}", comparison_axis_figure(data), caption, alt)
        return
    yield Picture(
        "comparison",
        comparison_figure(data),
        "Area and friction from model to model: a bar runs from the model before, blue where the "
        "number falls, orange where it rises; lines are one standard uncertainty, a star is for "
        "friction partly beyond the measured band.",
        "Area and friction of each model, with the step from the one before.",
    )
    if panels := _wavelength_panels(data):
        yield Picture(
            "by_wavelength",
            Sheet(panels, height=3.5).on_paper(),
            "Area and friction down to each wavelength, of every model: where area is lost and "
            "friction made. Dashed is beyond the measured band.",
            "Two panels with a curve for each model against wavelength, which falls to the right.",
        )
