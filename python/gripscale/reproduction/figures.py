"""The figures of the paper by name: the predictions each needs and the panels it shows."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series, wavelength_axis
from gripscale.charts.draw import Sheet
from gripscale.charts.style import COLOURS, GREY, INK, ORANGE, WIDE, colours
from gripscale.core import InputError
from gripscale.core.units import MEGA, MILLI, SQUARE_MM
from gripscale.experiment import Task
from gripscale.questions.inputs.charts_of_rubber import OMEGA
from gripscale.reproduction.inputs import FAST, SPEED, SPEEDS, PaperInputs
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack, fit_self_affine, fit_sines

TITLES = {
    "fig2": "Master curves of the compounds",
    "fig3b": "Height difference correlation and its power law",
    "fig4": "Sine waves with one and two magnification factors",
    "fig5a": "Contact area for pairs of magnification factors, static, 3 bar, {rubber}",
    "fig5b": "Contact area for pairs of magnification factors, 300 mm/s, 3 bar, {rubber}",
    "fig6a": "Contact area and sliding speed, 3 bar, {rubber}, {surface}",
    "fig6b": "Contact area of two compounds, 3000 mm/s, 3 bar, {surface}",
    "fig7a": "Height difference correlation of both surfaces",
    "fig7b": "Contact area on two surfaces, 300 mm/s, 3 bar, {rubber}",
    "fig8a": "Friction for pairs of magnification factors, 300 mm/s, 3 bar, {rubber}",
    "fig8b": "Friction and sliding speed, 3 bar, {surface}",
    "fig9a": "Friction of two compounds, 3 bar, {surface}",
    "fig9b": "Friction and contact area on two surfaces, 300 mm/s, 3 bar, {rubber}",
}

Tasks = dict[str, dict[str, Task]]  # predictions by panel of a figure and by name of the line
Lines = dict[str, xr.Dataset]
Results = dict[str, Lines]  # results of predictions, without waves that did not converge

_LAG = PlotAxis("lag $l$ [mm]", log=True)
_CORRELATION = PlotAxis("height difference correlation $C_z$ [mm$^2$]", log=True)
_STORAGE = PlotAxis("storage modulus $E'$ [MPa]", log=True)
_LOSS = PlotAxis("loss modulus $E''$ [MPa]", log=True)
_AREA = PlotAxis("relative contact area $A_r/A_0$ [-]", log=True)
_FRICTION = PlotAxis("friction of each wave $\\mu_i$ [-]", low=0.0)
_MARKERS = "osD^vP*"
_SLOWEST = 1e-2  # no wave excites the rubber slower than this [rad/s]
STATIC = "static"


def speed_name(speed: float) -> str:
    """Return what a line of one speed is called."""
    return f"{speed * 1e3:g} mm/s" if speed > 0.0 else STATIC


def pair_name(pair: tuple[str, str], speed: float) -> str:
    """Return what a panel of two compounds at one speed is called."""
    return f"{pair[1]} and {pair[0]}, {speed_name(speed)}"


def title_of(figure: str, inputs: PaperInputs) -> str:
    """Return what stands above a figure."""
    return TITLES[figure].format(rubber=inputs.rubber, surface=inputs.surface)


def tasks_of(figure: str, inputs: PaperInputs) -> Tasks:
    """Return the predictions of a figure by panel and line; none for figures of the inputs."""
    surface, rubber, pairs = inputs.surface, inputs.rubber, inputs.pairs
    if figure in ("fig5a", "fig5b", "fig8a"):
        speed = 0.0 if figure == "fig5a" else SPEED
        return {
            road: {name: inputs.task(road, rubber, speed, waves) for name, waves in each.items()}
            for road, each in inputs.stacks.items()
        }
    if figure in ("fig6a", "fig8b"):
        several = figure == "fig8b"
        speeds = SPEEDS if several else (0.0, *SPEEDS)
        return {
            name: {speed_name(v): inputs.task(surface, name, v) for v in speeds}
            for name in (rubber, *(second for _, second in pairs if several))
        }
    if figure in ("fig6b", "fig9a"):
        return {
            pair_name(pair, v): {name: inputs.task(surface, name, v) for name in pair}
            for pair in (pairs[:1] if figure == "fig6b" else pairs)
            for v in ((FAST,) if figure == "fig6b" else (SPEED, FAST))
        }
    if figure in ("fig7b", "fig9b"):
        return {speed_name(SPEED): {r: inputs.task(r, rubber, SPEED) for r in inputs.surfaces}}
    return {}


def draw(figure: str, inputs: PaperInputs, results: Results) -> Sheet:
    """Describe a figure: panels beside and below each other, with one legend or their own."""
    of_inputs = {"fig2": _moduli, "fig3b": _power_laws, "fig4": _waves, "fig7a": _both_correlations}
    panels = of_inputs[figure](inputs) if figure in of_inputs else list(_predicted(figure, results))
    several, columns = len(panels) > 1, 3 if len(panels) == 3 else min(len(panels), 2)
    rows = -(-len(panels) // columns)
    labels = [[m.label for m in panel.marks if isinstance(m, Series)] for panel in panels]
    alike = all(names == labels[0] for names in labels)
    for i, panel in enumerate(panels):
        title = textwrap.fill(panel.title, 40) if several else ""
        panels[i] = replace(panel, title=title, legend="" if alike else panel.legend or "best")
    return Sheet(
        panels,
        columns,
        WIDE * {1: 0.75, 2: 1.0, 3: 1.3}[columns],
        height=3.7 if rows == 1 else 2.8 * rows,
        legend="below" if alike else "",
        legend_columns=6 if several else 3,
        title=textwrap.fill(title_of(figure, inputs), 100 if several else 78),
        layout={"sharey": panels[0].y is _CORRELATION},
    )


def _moduli(inputs: PaperInputs) -> list[Panel]:
    """Return storage and loss modulus of the compounds, with the points measured of them."""
    marks: dict[str, list[Mark]] = {"real": [], "imag": []}
    for (name, compound), colour in zip(inputs.compounds.items(), COLOURS, strict=False):
        rubber, rows = compound.rubber, compound.master
        low, high = rubber.valid_band or (_SLOWEST, 1e12)
        omega, look = np.geomspace(max(low, _SLOWEST), high, 400), dict[str, Any](label=name)
        curves = [(omega, rubber.complex_modulus(omega), look)]
        if rows is not None:
            x, moduli = rows.angular_frequency, rows.storage + 1j * rows.loss
            here, there = rubber.reference_temperature, rows.reference_temperature
            if rubber.shift is not None and here is not None and there is not None:
                x, moduli = x / rubber.shift.a(here, there), moduli / rubber.shift.b(here, there)
            look = {"dash": "", "marker": ".", "size": 3.0, "alpha": 0.5}
            curves.append((np.where(x >= _SLOWEST, x, np.nan), moduli, look))
        for x, modulus, look in curves:
            for part in marks:
                marks[part].append(Series(x, getattr(modulus, part) / MEGA, colour, **look))
    return [Panel(OMEGA, _STORAGE, marks["real"]), Panel(OMEGA, _LOSS, marks["imag"])]


def _points(curve: HeightDifference, **look: Any) -> Series:
    return Series(curve.lag / MILLI, curve.value / SQUARE_MM, **look)


def _correlation(road: str, curve: HeightDifference, *more: Mark) -> Panel:
    points = _points(curve, colour=INK, label="surface", dash="", marker=".")
    return Panel(_LAG, _CORRELATION, [points, *more], road, legend="lower right")


def self_affine(inputs: PaperInputs, road: str) -> SelfAffineFit | InputError:
    """Return the power law of a surface, or why it has none."""
    try:
        return fit_self_affine(inputs.correlation(road))
    except InputError as error:
        return error


def _power_laws(inputs: PaperInputs) -> list[Panel]:
    panels = []
    for road in inputs.surfaces:
        curve, fit = inputs.correlation(road), self_affine(inputs, road)
        marks: list[Mark] = []
        if isinstance(fit, SelfAffineFit):
            lag = np.geomspace(curve.lag[0], curve.lag[-1], 400)
            values, label = fit.evaluate(lag) / SQUARE_MM, f"eq. 6, $H$ = {fit.hurst:.2f}"
            cut_off = CrossLine(fit.xi_parallel / MILLI, GREY, dash="dashed", upright=True)
            marks = [Series(lag / MILLI, values, ORANGE, label), cut_off]
        panels.append(_correlation(road, curve, *marks))
    return panels


def single_factor(inputs: PaperInputs, road: str) -> tuple[SineStack, SineStack]:
    """Return waves fitted with two factors and with one, same number and smallest wavelength."""
    stack, curve = next(iter(inputs.stacks[road].values())), inputs.correlation(road)
    same = dict[str, Any](scales=len(stack), smallest_wavelength=float(stack.wavelength[-1]))
    return fit_sines(curve, **same), fit_sines(curve, **same, single_factor=True)


def _waves(inputs: PaperInputs) -> list[Panel]:
    """Return C_z of surfaces and of waves; legends name s_lambda/s_A and the residual.

    Waves are drawn up to a quarter of the first wavelength, where its share in the fit ends.
    """
    panels = []
    for road, pairs in inputs.stacks.items():
        two, single = single_factor(inputs, road)
        both = f"{two.s_wavelength:.2f}/{two.s_amplitude:.2f}, all fitted"
        stacks = {**pairs, both: two, f"{single.s_wavelength:.2f}, one factor": single}
        curve, marks = inputs.correlation(road), []
        for (label, stack), colour in zip(stacks.items(), COLOURS, strict=False):
            lag = np.geomspace(curve.lag[0], 0.25 * stack.wavelength[0], 800)
            dash, label = "dashed" if stack is single else "solid", f"{label}, {stack.residual:.2f}"
            value = stack.height_difference(lag) / SQUARE_MM
            marks.append(Series(lag / MILLI, value, colour, f"{label} decades", dash, 1.1))
        panels.append(_correlation(road, curve, *marks))
    return panels


def _both_correlations(inputs: PaperInputs) -> list[Panel]:
    marks = [
        _points(inputs.correlation(road), colour=colour, label=road, marker=marker, size=3.0)
        for road, colour, marker in zip(inputs.surfaces, COLOURS, _MARKERS, strict=False)
    ]
    return [Panel(_LAG, _CORRELATION, marks)]


def _predicted(figure: str, results: Results) -> Iterator[Panel]:
    """Yield predictions against wavelength, large waves left as in the paper."""
    axes = [_FRICTION] if figure in ("fig8a", "fig8b", "fig9a", "fig9b") else [_AREA]
    axes += [_AREA] if figure == "fig9b" else []
    for name, lines in results.items():
        x = wavelength_axis(np.concatenate([data.wavelength / MILLI for data in lines.values()]))
        for axis in axes:
            rubs = axis is _FRICTION
            variable = "friction" if rubs else "running_contact_fraction"
            title = f"{'friction' if rubs else 'contact area'}, {name}" if axes[1:] else name
            marks = list(_lines(lines, variable, ordered=figure in ("fig6a", "fig8b")))
            yield Panel(x, axis, marks, title)


def _lines(lines: Lines, variable: str, *, ordered: bool) -> Iterator[Series]:
    """Yield predictions; those `ordered`, such as by speed, are to be seen in their colours."""
    shades = colours(sum(name != STATIC for name in lines), ordered=ordered)
    moving = iter(zip(shades, _MARKERS, strict=False))
    for name, data in lines.items():
        colour, marker = (GREY, "x") if name == STATIC else next(moving)
        dash = "dashed" if name == STATIC else "solid"
        whole = data.prediction_status.item() == "converged"
        label = name if whole else f"{name}, next wave not solved"
        x, y = data.wavelength / MILLI, data[variable]
        yield Series(x.values, y.values, colour, label, dash, marker=marker, size=4.0)


def drawn_data(sheet: Sheet) -> xr.Dataset:
    """Return the curves of a figure, `x_i` and `y_i` with their panel, name and axes."""
    data = xr.Dataset()
    curves = ((panel, m) for panel in sheet.panels for m in panel.marks if isinstance(m, Series))
    for i, (panel, curve) in enumerate(curves, start=1):
        label = {"panel": panel.title, "of": curve.label or "measured"}
        for name, values, axis in (("x", curve.x, panel.x), ("y", curve.y, panel.y)):
            attrs = {**label, "axis": axis.label}
            data[f"{name}_{i}"] = (f"point_{i}", np.asarray(values), attrs)
    return data
