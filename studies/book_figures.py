"""The pictures of the pages that explain the model, drawn from the shipped road.

    python -m studies.book_figures [FOLDER]

writes docs/figures/book_*.png; about a minute of one core. Each picture comes from results of the
shipped case with a rubber as measured at small strain, without softening and heat: waves and chain
at finite strain, the direct contact, and its derivatives. That of the conditions comes from the
shipped case as it is.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.charts.chart import (
    Bars,
    CrossLine,
    Mark,
    Note,
    Panel,
    PlotAxis,
    Series,
    ShadedBand,
    ValueMap,
)
from gripscale.charts.draw import Sheet
from gripscale.charts.paper import save_figure
from gripscale.charts.style import BLUE, FAINT, GREEN, GREY, INK, ORANGE, SKY, shades
from gripscale.core.units import MEGA, MILLI
from gripscale.questions import blocks_figure
from gripscale.questions.answer.answer import answer
from gripscale.questions.answer.charts import named_traces
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.sensitivity.question import sensitivity_figure
from gripscale.questions.uncertainty.charts import parts_figure
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import transmission
from gripscale.theory import Persson
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.result import waves_to_dataset
from studies.shipped import tread
from studies.shipped_numbers import CASE, ROOT

Array = NDArray[np.float64]

FIGURES = ROOT / "docs" / "figures"
WAVE = 1
"""The second of the waves, whose contact is neither narrow nor nearly closed."""
PRESSURES = (0.3e6, 2e6, 6e6)
"""On the block [Pa]."""
SPEEDS = np.geomspace(1e-6, 1e2, 25)
"""Of a wave [m/s]: from relaxed rubber to the end of what was measured."""
STACKED = (1, 2, 4, 8)
"""Numbers of waves whose sum is drawn."""
PIECES = ((120.0, 1780.0), (640.0, 760.0), (668.0, 676.0))
"""Of the road [mm], each a close-up of the one before."""
STRETCH = 60.0
"""Length of the road under the draped rubber [mm]."""
SENSITIVITY_SPEEDS = [0.003, 0.3, 30.0]
"""Of the derivatives over the speed [m/s]."""
MAP_STEP, MAP_POINTS = 1e-4, 256
"""Step [m] and points along a side of the map of the line and its map."""


class Shipped:
    """The shipped road under the tread without softening and heat, each answer solved once."""

    def __init__(self) -> None:
        self.case = read_case(CASE).replace(rubber=tread(), filled=False, conditions=None)
        self.rubber, self.sines = self.case.rubber, self.case.surface.sines
        assert self.sines is not None

    @cached_property
    def chain(self) -> xr.Dataset:
        """The prediction of the chain."""
        return self.case.chain.predict(self.rubber, self.case.surface, self.case.load)

    @cached_property
    def direct(self) -> xr.Dataset:
        """The direct contact of the profiles, with the answer of `gripscale run`."""
        return answer(self.case).data

    @cached_property
    def sensitivity(self) -> xr.Dataset:
        """The derivatives of the friction."""
        with tempfile.TemporaryDirectory() as folder:
            return gs.sensitivity(self.case, folder=folder).data

    @cached_property
    def uncertainty(self) -> xr.Dataset:
        """The answer with the errors of its inputs, from samples."""
        return gs.uncertainty(self.case).data

    def wave(self, speed: float, pressure: float | None = None) -> gs.ScaleResult:
        """Solve the wave of the pictures under a pressure [Pa], that of the chain by default."""
        assert self.sines is not None
        return gs.solve_scale(
            self.rubber,
            wavelength=float(self.sines.wavelength[WAVE]),
            amplitude=float(self.sines.amplitude[WAVE]),
            pressure=pressure or float(self.chain.pressure_received[WAVE]),
            speed=speed,
        )


def block(shipped: Shipped) -> Figure:
    """Draw the deformed block of one wave under three pressures, and its contact pressure."""
    speed = shipped.case.load.speed
    results = [shipped.wave(speed, pressure) for pressure in PRESSURES]
    return blocks_figure(waves_to_dataset(results))


def blocks(shipped: Shipped) -> Figure:
    """Draw the deformed block of every wave of the chain."""
    return blocks_figure(shipped.chain)


def wave(shipped: Shipped) -> Figure:
    """Draw the pressure of one wave at rest and sliding, and its friction over the speed."""
    looks = {0.0: (GREY, "at rest"), 10.0: (ORANGE, "sliding, 10 m/s")}
    pressure: list[Mark] = []
    view = PredictionView(waves_to_dataset([shipped.wave(speed) for speed in looks]))
    for number, (colour, label) in enumerate(looks.values()):
        x, pascal = view.pressure_along(number)
        p = pascal / MEGA
        pressure += [
            ShadedBand(x, np.zeros(x.size), p, colour, alpha=0.15),
            Series(x, p, colour, label),
        ]
    results = [shipped.wave(speed) for speed in SPEEDS]
    frequency = 2.0 * np.pi * SPEEDS / results[0].wavelength
    modulus = shipped.rubber.complex_modulus(frequency)
    solved = [result.converged for result in results]
    friction = np.where(solved, [result.friction for result in results], np.nan)
    panels = [
        Panel(
            PlotAxis("place along the wave $x/\\lambda$ [-]", low=-0.5, high=0.5),
            PlotAxis("contact pressure [MPa]", low=0.0),
            [
                *pressure,
                CrossLine(0.0, GREY, "", "dotted", upright=True),
                Note(0.03, 0.95, "rubber slides $\\rightarrow$", frame="xy", top=True),
            ],
        ),
        Panel(
            PlotAxis("sliding speed [m/s]", log=True, numbers=6),
            PlotAxis("friction $\\mu$, loss factor [-]", low=0.0),
            [
                Series(SPEEDS, friction, BLUE, "friction of the wave", marker="o", size=3.0),
                Series(SPEEDS, modulus.imag / modulus.real, GREEN, "loss factor", "dashed"),
            ],
        ),
    ]
    return Sheet(panels, height=2.9, legend_columns=4).on_paper()


def stack(shipped: Shipped) -> Figure:
    """Draw sums of the first waves, and contact area and friction as waves are added."""
    sines, data = shipped.sines, shipped.chain
    assert sines is not None
    x = np.linspace(0.0, 1.5 * float(sines.wavelength[0]), 6000)
    waves = sines.amplitude[:, None] * np.cos(2.0 * np.pi * x / sines.wavelength[:, None])
    drop = 4.0 * float(sines.amplitude[0]) / MILLI
    sums = [
        Series(x / MILLI, waves[:count].sum(0) / MILLI - row * drop, colour, width=0.8)
        for row, (count, colour) in enumerate(zip(STACKED, shades(len(STACKED)), strict=True))
    ]
    names = [
        Note(0.98, (0.3 - row) * drop, f"{count} wave{'s' * (count > 1)}", frame="x", align="right")
        for row, count in enumerate(STACKED)
    ]
    number = 1.0 + np.arange(data.sizes["scale"])
    counted = PlotAxis("waves taken in [-]", ticks={float(i): f"{i:.0f}" for i in number})
    panels = [
        Panel(
            PlotAxis("distance $x$ [mm]"),
            PlotAxis("height", ticks={}, grid=False),
            [*sums, *names],
        ),
        Panel(
            counted,
            PlotAxis("share that touches, friction [-]", log=True),
            [
                Series(number, data.running_contact_fraction, BLUE, "share that touches",
                       marker="o"),
                Series(number, data.running_friction, ORANGE, "friction", marker="s"),
            ],
        ),
    ]  # fmt: skip
    return Sheet(panels, height=3.2).on_paper()


def road(shipped: Shipped) -> Figure:
    """Draw the measured road in close-ups."""
    measured = shipped.case.surface.measured
    assert measured is not None
    profile = measured.surfaces[0]
    x, z = profile.x / MILLI, profile.z / MILLI
    panels = []
    for number, (start, end) in enumerate(PIECES):
        inside = (x >= start) & (x <= end)
        marks: list[Mark] = [Series(x[inside], z[inside], INK, width=0.7)]
        if number + 1 < len(PIECES):
            low, high = PIECES[number + 1]
            marks.append(CrossLine(low, SKY, upright=True, to=high))
        heights = PlotAxis("height $z$ [mm]")
        panels.append(Panel(PlotAxis("distance $x$ [mm]", low=start, high=end), heights, marks))
    return Sheet(panels, 1, height=5.0).on_paper()


def cut_off(_: Shipped) -> Figure:
    """Draw a groove between flat faces behind a sharp cut of the spectrum and the Gaussian."""
    step, cut = 5e-6, 0.4e-3
    x = step * np.arange(2048)
    z = np.where(np.abs(x - x.mean()) < 0.5e-3, -0.5e-3, 0.0)
    waves = 2.0 * np.pi * np.asarray(np.fft.rfftfreq(x.size, step), dtype=float)
    share = {
        "as measured": np.ones(waves.size),
        "sharp cut": np.where(waves <= 2.0 * np.pi / cut, 1.0, 0.0),
        "Gaussian": transmission(waves, cut),
    }
    marks: list[Mark] = []
    for (label, passed), colour in zip(share.items(), (GREY, ORANGE, BLUE), strict=True):
        kept = np.fft.irfft(np.fft.rfft(z) * passed, x.size)
        marks.append(Series((x - x.mean()) / MILLI, kept / MILLI, colour, label))
    distance = PlotAxis("distance $x$ [mm]", low=-2.0, high=2.0)
    panel = Panel(distance, PlotAxis("height $z$ [mm]"), marks, legend="lower right")
    return Sheet([panel], 1, height=2.8).on_paper()


def draped(shipped: Shipped) -> Figure:
    """Draw the rubber of the direct contact on the road, from afar and close up."""
    _, trace = named_traces(shipped.direct)[0]
    start, end = (float(trace[f"stretch_{name}"]) / MILLI for name in ("start", "end"))
    afar = start - 0.35 * STRETCH
    far = _draped_panel(trace, (afar, afar + STRETCH), room=0.0)
    far = far.with_marks([CrossLine(start, SKY, upright=True, to=end)])
    close = _draped_panel(trace, (start, end), room=0.35)
    return Sheet(
        [replace(far, x=replace(far.x, label="")), close], 1, height=5.4, legend_columns=4
    ).on_paper()


def _draped_panel(trace: xr.Dataset, ends: tuple[float, float], room: float) -> Panel:
    """Return rubber on the road between two places [mm].

    The largest pressure takes the share `room` of the heights.
    """
    x = trace.x.values / MILLI
    inside = (x >= ends[0]) & (x <= ends[1])
    x = x[inside]
    surface, rubber, pressure = (
        trace[name].values[inside] / unit
        for name, unit in (("height_low", MILLI), ("rubber_low", MILLI), ("pressure_high", MEGA))
    )
    low = float(surface.min())
    span = float(rubber.max()) - low
    top = low + (1.15 + room) * span
    touching = np.where(pressure > 0.0, rubber, np.nan)
    marks: list[Mark] = [
        ShadedBand(x, np.full(x.size, low), surface, FAINT, "road", alpha=1.0),
        ShadedBand(x, rubber, np.full(x.size, top), SKY, "rubber", alpha=0.3),
    ]
    if room:
        height = rubber + room * span * pressure / pressure.max()
        marks.append(ShadedBand(x, rubber, height, ORANGE, "pressure", alpha=0.5))
    marks += [
        Series(x, surface, INK, width=0.6),
        Series(x, rubber, BLUE, width=0.9),
        Series(x, touching, ORANGE, "contact", width=2.4),
        Note(0.02, 0.93, "rubber slides $\\rightarrow$", frame="xy", top=True, boxed=True),
    ]
    along = PlotAxis("distance $x$ [mm]", low=ends[0], high=ends[1])
    return Panel(along, PlotAxis("height $z$ [mm]", low=low, high=top), marks)


def isotropic_heights() -> Array:
    """Return a self-affine Gaussian map (H = 0.8) of rms height 0.5 mm."""
    along, across = np.fft.fftfreq(MAP_POINTS, MAP_STEP), np.fft.rfftfreq(MAP_POINTS, MAP_STEP)
    number = np.hypot(along[:, None], across)
    longest = 2.0 / (MAP_POINTS * MAP_STEP)
    amplitude = np.where(number > 0.0, np.maximum(number, longest) ** -1.8, 0.0)
    shape = (MAP_POINTS, MAP_POINTS)
    noise = np.fft.rfft2(np.random.default_rng(3).standard_normal(shape))
    heights = np.fft.irfft2(amplitude * noise, s=shape)
    return np.asarray(0.5e-3 * heights / heights.std())


def line_and_map(shipped: Shipped) -> Figure:
    """Draw the contact of a map, and its rubber along a line beside that of the line alone."""
    x, heights = MAP_STEP * np.arange(MAP_POINTS, dtype=np.float64), isotropic_heights()
    row, length = MAP_POINTS // 2, MAP_POINTS * MAP_STEP / MILLI
    load = shipped.case.load
    alone, whole = (
        gs.solve_rough_contact(
            shipped.rubber,
            surface,
            pressure=load.pressure,
            speed=load.speed,
            smallest_wavelength=4.0 * MAP_STEP,
            periodic=True,
        )
        for surface in (Profile(x, heights[:, row]), HeightMap(x, x, heights))
    )
    assert whole.y is not None
    section = int(np.argmin(np.abs(whole.y - row * MAP_STEP)))
    surface = whole.height[:, section]
    x_map, y_map = whole.x / MILLI, whole.y / MILLI
    marks: list[Mark] = [
        ShadedBand(x_map, np.full(x_map.size, 0.1), surface / MILLI, FAINT, "surface", alpha=1.0)
    ]
    lines = (
        (alone.x, alone.height + alone.gap, alone.pressure, ORANGE, "rubber on the line alone"),
        (whole.x, (whole.height + whole.gap)[:, section], whole.pressure[:, section], BLUE,
         "rubber on the map"),
    )  # fmt: skip
    for place, rubber, pressure, colour, label in lines:
        # a line has a mean height of its own
        level = 0.0 if colour == BLUE else float(surface.mean() - alone.height.mean())
        z = (rubber + level) / MILLI
        touching = np.where(pressure > 0.0, z, np.nan)
        width = 1.6 if colour == BLUE else 4.0
        marks += [
            Series(place / MILLI, z, colour, label, width=1.0),
            Series(place / MILLI, touching, colour, width=width),
        ]
    field = np.where(whole.pressure > 0.0, whole.pressure / MEGA, np.nan)
    across = CrossLine(float(y_map[section]), INK, "", "dashed")
    along = PlotAxis("distance $x$ [mm]", low=0.0, high=length)
    panels = [
        Panel(
            along,
            PlotAxis("$y$ [mm]", low=0.0, high=length),
            [ValueMap(x_map, y_map, field.T, "contact pressure [MPa]"), across],
            title=f"the map touches {100.0 * whole.contact_fraction:.1f} %",
            to_scale=True,
        ),
        Panel(
            along,
            PlotAxis("height $z$ along the dashed line [mm]", low=0.1),
            marks,
            title=f"the line alone touches {100.0 * alone.contact_fraction:.1f} %",
        ),
    ]
    return Sheet(panels, height=3.4).on_paper()


def sensitivity(shipped: Shipped) -> Figure:
    """Draw the master curve, and below it what each decade of it is worth."""
    return sensitivity_figure(shipped.sensitivity)


def speeds(shipped: Shipped) -> Figure:
    """Draw the same at three speeds."""
    with tempfile.TemporaryDirectory() as folder:
        vary = {"speed": SENSITIVITY_SPEEDS}
        return sensitivity_figure(gs.sensitivity(shipped.case, folder=folder, vary=vary).data)


def conditions(_: Shipped) -> Figure:
    """Draw what each effect of the conditions is worth in the chain."""
    selections = ["all", "no temperature", "no softening", "no heat", "none"]
    data = gs.vary(read_case(CASE), effects=selections, model="chain").data
    ticks = {float(i): name for i, name in enumerate(selections)}
    rows = PlotAxis("", low=len(ticks) - 0.5, high=-0.5, ticks=ticks, grid=False)
    at = np.array([*ticks])
    panels = []
    for name, label in (
        ("total_contact_fraction", "real contact area $A_r/A_0$ [-]"),
        ("total_friction", "friction, hysteresis $\\mu$ [-]"),
    ):
        ends = data[name].values
        bars = Bars(0.0, ends, at - 0.27, at + 0.27, BLUE)
        line = CrossLine(ends[0], BLUE, "", "dotted", upright=True)
        panels.append(Panel(PlotAxis(label, low=0.0, numbers=4), rows, [bars, line]))
    return Sheet(panels, height=3.0, legend="", layout={"sharey": True}).on_paper()


def answers(shipped: Shipped) -> dict[str, xr.Dataset]:
    """Return what the models answer for the shipped road."""
    case, rubber = shipped.case, shipped.rubber
    small = replace(case.chain, solver=HalfPlane())
    return {
        "chain, finite strain": shipped.chain,
        "chain, small strain": small.predict(rubber, case.surface, case.load),
        "Persson": Persson().predict(rubber, case.surface, case.load),
        "direct contact": shipped.direct,
    }


def models(shipped: Shipped) -> Figure:
    """Draw what the models answer for one road, friction over contact area."""
    direct = shipped.direct
    marks: list[Mark] = []
    looks = zip(answers(shipped).items(), (BLUE, SKY, GREY, ORANGE), "osD^", strict=True)
    for (label, data), colour, marker in looks:
        at = [float(data.total_contact_fraction)], [float(data.total_friction)]
        marks.append(Series(*at, colour, label, "", marker=marker, size=7.0))
    area, friction = float(direct.answer_contact_fraction), float(direct.answer_friction)
    widths = (
        np.arcsinh(float(direct[f"answer_{name}_half_width"]))
        for name in ("contact_fraction", "friction")
    )
    (left, right), (low, high) = (
        (best * np.exp(-width), best * np.exp(width))
        for best, width in zip((area, friction), widths, strict=True)
    )
    interval = Bars(left, right, low, high, ORANGE, "answer, 90 %", alpha=0.2)
    star = Series([area], [friction], INK, "answer of gripscale run", "", marker="*", size=10.0)
    panel = Panel(
        PlotAxis("real contact area $A_r/A_0$ [-]", True, 0.005, 0.1),
        PlotAxis("friction $\\mu$ [-]", True, 0.1, 1.0),
        [interval, *marks, star],
    )
    return Sheet([panel], 1, 6.4, 3.4, legend="beside").on_paper()


def errors(shipped: Shipped) -> Figure:
    """Draw the standard errors of the answer: of inputs, and of the model."""
    return parts_figure(shipped.uncertainty)


PICTURES = (
    block,
    blocks,
    wave,
    stack,
    road,
    cut_off,
    draped,
    line_and_map,
    sensitivity,
    speeds,
    conditions,
    models,
    errors,
)


def pictures() -> Iterator[tuple[str, Figure]]:
    """Yield the name of each picture and the picture."""
    shipped = Shipped()
    for picture in PICTURES:
        yield f"book_{picture.__name__}", picture(shipped)


def main(folder: Path = FIGURES) -> None:
    """Write the pictures into a folder."""
    for name, figure in pictures():
        save_figure(figure, folder, name, ["png"])


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
