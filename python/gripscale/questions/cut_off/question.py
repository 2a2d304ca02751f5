"""What lies below the measurement: friction and contact area against the cut-off.

result = gs.cut_off(case, down_to="10 um")
result.data.curve_friction_from_dissipation
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts import chart, draw
from gripscale.charts.draw import Picture
from gripscale.charts.style import BLUE, COLOURS, GREY, ORANGE, WIDE
from gripscale.core import Finding
from gripscale.core.units import MILLI, in_mm, si_value
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, change, significant
from gripscale.model import STATUS, OnProgress
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.variables import SYMBOLS, AnswerNumber
from gripscale.questions.cut_off.curve import (
    AREA,
    CONTACT_SLOPE,
    FRICTION,
    SLOPE_IN_CONTACT,
    at_cut_off,
    continuation_doubts,
    cut_off_curve,
    refusals,
)
from gripscale.questions.inputs import record
from gripscale.questions.result import Result
from gripscale.questions.view import load_in_words

_CURVES = {
    FRICTION: ("friction $\\mu$ [-]", ORANGE),
    AREA: ("contact area $A_r/A_0$ [-]", BLUE),
    SLOPE_IN_CONTACT: ("rms slope in contact [-]", GREY),
}


def cut_off_sheet(data: xr.Dataset) -> draw.Sheet:
    """Describe friction, contact and the slope in contact by cut-off, continued parts dotted."""
    lengths, measured = data.cut_off.values / MILLI, data.curve_measured.values.astype(bool)
    x = replace(
        chart.wavelength_axis(lengths), label="cut-off: shortest wavelength of the surface [mm]"
    )
    below = ~measured | np.append(~measured[1:], False)  # from the last measured point on
    parts = (measured, "solid", "measured roughness"), (below, "dotted", "continued roughness")
    panels = []
    for name, (label, colour) in _CURVES.items():
        first, values = name == FRICTION, data[name].values
        marks: list[chart.Mark] = [
            chart.Series(lengths[where], values[where], colour, words * first, dash, marker="o",
                         size=3.0)
            for where, dash, words in parts
            if where.any()
        ]  # fmt: skip
        if name == SLOPE_IN_CONTACT:
            marks.append(chart.CrossLine(CONTACT_SLOPE))
        else:
            low, high = (data[f"{name}_{end}"].values for end in ("lower", "upper"))
            words = "90 % band of the continuation" * first
            marks.insert(0, chart.ShadedBand(lengths, low, high, colour, words))
        area = name == AREA
        y = chart.PlotAxis(label, log=area, low=None if area else 0.0)
        panels.append(chart.Panel(x, y, [*marks, *_rules(data)]))
    layout = {"sharex": True, "height_ratios": [1.2, 1.0, 0.8]}
    return draw.Sheet(panels, 1, WIDE, 6.6, gap=0.03, legend_columns=2, layout=layout)


def _rules(data: xr.Dataset) -> Iterator[chart.CrossLine]:
    """Yield the rules of cut-off that lie on the axis; those within 1 % of each other are one."""
    first, last = data.cut_off.values[[0, -1]]
    names: dict[float, list[str]] = {}
    for name, at in zip(data.rule.values, data.rule_cut_off.values, strict=True):
        if last <= at <= first:
            length = next((other for other in names if abs(at / other - 1.0) < 0.01), float(at))
            names.setdefault(length, []).append(str(name))
    for i, (at, alike) in enumerate(names.items()):
        colour = COLOURS[(i + 2) % len(COLOURS)]
        label = f"{', '.join(alike)}: {at / MILLI:.2g} mm"
        yield chart.CrossLine(at / MILLI, colour, label, "dashed", 0.9, upright=True)


_LEVEL = f"{100.0 * LEVEL:.0f} %"


class CutOff(Result):
    """Friction and contact area of a case against the cut-off."""

    kind = "cut_off"

    @property
    def lines(self) -> Sequence[str]:
        data = self.data
        if self.failure:
            return [f"Answer: none. {self.failure}"]
        measured, resolved = bool(data.curve_measured[-1]), float(data.resolved)
        level = "" if measured else f" ({_LEVEL} bands)"
        if any(refusals(data)):
            level = ", where the measurement ends: it foretells no octave"
        numbers, last = self._in_words(self._last), in_mm(float(data.cut_off[-1]), 3)
        load = " and ".join(load_in_words(data))
        lines = [
            f"Answer: {numbers} with roughness down to {last}{level}",
            f"  for {load}; direct contact of the measured surface, without factors",
        ]
        if not measured:
            numbers = self._in_words(lambda name: significant(at_cut_off(data, name, resolved)))
            lines.append(f"  measured down to {in_mm(resolved, 3)}: {numbers}")
        return lines

    @property
    def failure(self) -> str:
        sentence = str(self.data[STATUS].item())
        return "" if sentence == CONVERGED or "cut_off" in self.data.dims else sentence

    @property
    def findings(self) -> Sequence[Finding]:
        doubts = () if self.failure else continuation_doubts(self.data)
        return (*doubts, *super().findings)

    def parts(self) -> Iterator[str | Table]:
        if not self.failure:
            yield self.rules_table()
            yield self.table()

    def rules_table(self) -> Table:
        """Return the cut-off of each rule, with friction and contact there."""
        data = self.data
        columns = [
            Column("rule", data.rule.values.tolist()),
            Column("rule_cut_off", data.rule_cut_off.values, "cut-off", "mm", MILLI),
        ]
        columns += [
            Column(f"rule_{name}", data[f"rule_{name}"].values, SYMBOLS[name])
            for name, _ in self._curves
        ]
        beyond = bool(np.isnan(data.rule_contact_fraction.values).any())
        notes = ["Without numbers: beyond the curve."] if beyond else []
        return Table("rules", columns, "Rules of cut-off", notes)

    def table(self) -> Table:
        data, measured = self.data, self.data.curve_measured.values.astype(bool)
        columns = [
            Column("cut_off", data.cut_off.values, "cut-off", "mm", MILLI),
            Column("roughness", ["measured" if flag else "continued" for flag in measured]),
        ]
        for name, curve in self._curves:
            columns.append(Column(name, data[curve].values, SYMBOLS[name]))
            ends = np.stack([data[f"{curve}_{end}"].values for end in ("lower", "upper")], axis=-1)
            ends[measured] = np.nan
            columns.append(Column(f"{name}_band", ends, f"{_LEVEL} band"))
        columns.append(Column("slope", data[SLOPE_IN_CONTACT].values, "slope in contact"))
        notes = [] if measured[-1] else [f"Continued {_source(data)}."]
        return Table("curve", columns, "By octave of the cut-off", notes)

    def pictures(self) -> Iterator[Picture]:
        if not self.failure:
            yield Picture(
                "cut_off",
                cut_off_sheet(self.data).on_paper(),
                "Friction, area and the rms slope where the surface touches against the cut-off: "
                "measured roughness solid, continued dotted, with its 90 % band. Upright lines are "
                "rules of cut-off; small strain ends near a slope of 1.",
                "Three panels of curves against the shortest wavelength of the surface.",
            )

    @property
    def _curves(self) -> list[tuple[str, str]]:
        """Names of the numbers of an answer and of their curves; no friction at rest."""
        area = ("contact_fraction", AREA)
        return [("friction", FRICTION), area] if float(self.data.nominal_speed) > 0.0 else [area]

    def _in_words(self, number: Callable[[str], object]) -> str:
        return ", ".join(f"{SYMBOLS[name]} = {number(curve)}" for name, curve in self._curves)

    def _last(self, curve: str) -> AnswerNumber:
        """Return a number at the last cut-off, with its band where this is continued."""
        last = self.data[[curve, f"{curve}_lower", f"{curve}_upper"]].isel(cut_off=-1)
        value, *ends = (float(number) for number in last.values())
        measured = bool(self.data.curve_measured[-1])
        return AnswerNumber(value, *((math.nan, math.nan) if measured else ends))


def _source(data: xr.Dataset) -> str:
    """Return where the continued roughness comes from, and how well it did."""
    if "slope_ratio" not in data:
        text = "with the slopes of the finer measurement; "
        overlap = float(data.get("overlap", math.nan))
        if math.isnan(overlap):
            return f"{text}no wavelength is measured by both"
        times = significant(overlap, 2)
        return f"{text}the faces that touch are {times} times as steep where both are measured"
    ends = [data.get("withheld_slope_ratio", data.slope_ratio), data.slope_ratio]
    first, end = (significant(float(ratio), 3) for ratio in ends)
    text = f"with slopes {end} times those of the octave above"
    if first != end:
        text += f" in the last octave, {first} times in the last measured one"
    if "withheld_friction_error" not in data:
        return f"{text}, as stated or as usual"
    errors = ", ".join(
        f"{words} {change(float(data[f'withheld_{name}_error']))}"
        for name, words in (("friction", "friction"), ("contact_fraction", "contact area"))
    )
    return f"{text}; the last measured octave, withheld and continued the same way: {errors}"


def cut_off(
    case: Case,
    *,
    down_to: float | str | None = None,
    hurst: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
    on_step: OnProgress = None,
) -> CutOff:
    """Return contact and friction of a case against the cut-off.

    Over `cut_off` the result has the curves of `gripscale.continuation.contact_by_cut_off` with the
    prefix `curve_`; over `rule` the cut-off that each rule gives, with friction and contact there.
    The totals are those of the last cut-off; not numbers where the faces foretell no octave below
    the measurement, at which the curves then end (`findings`). Raises `InputError` or `FileError`
    for what cannot be used; if nothing was measured.

        >>> gs.cut_off(case, down_to="1 mm").to_dataset().rule.values.tolist()
        ['shortest wavelength measured', 'cut-off of the case']

    Parameters
    ----------
    case : Case
        Its surface must be measured profiles.
    down_to : float or str, optional
        Last cut-off [m], or a text such as "10 um"; that of the case by default, else 10 um.
    hurst : float, optional
        Hurst exponent of the continued roughness [-], in place of what the case states.
    folder : path, optional
        Keeps the solution as soon as it is there: what was interrupted resumes.
    workers, on_task, on_step
        As for `gripscale.experiment.Bench`; a step is the `RoughContact` of a line at a cut-off.
    """
    end = si_value("down_to", down_to, "m")
    with bench_in(folder, workers, None, on_task, on_step) as bench:
        data = cut_off_curve(case, case.load, bench, down_to=end, hurst=hurst)
    return cut_off_result(data, case)


def cut_off_result(data: xr.Dataset, case: Case) -> CutOff:
    """Return the curves of a case as the result of the question."""
    data = data.assign_attrs(case.attributes, title="Contact and friction against the cut-off")
    return CutOff(data, record.inputs(case))
