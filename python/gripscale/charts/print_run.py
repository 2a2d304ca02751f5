"""Which figures a case writes, and from what."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from gripscale.analysis.effects import CHANGES, WITH_AREA_TERM
from gripscale.case.record import excited
from gripscale.charts.blocks import blocks_figure
from gripscale.charts.print_inputs import (
    correlation_figure,
    master_curve_figure,
    profile_figure,
    shift_figure,
    superposition_figure,
    superposition_tests_figure,
)
from gripscale.charts.style import (
    BLUE,
    COLOURS,
    DOTTED,
    GREEN,
    GREY,
    INK,
    NARROW,
    ORANGE,
    SKY,
    WIDE,
    area_axis,
    dashed_entry,
    down_to,
    falling_wavelength,
    line,
    save_figure,
    sheet,
    styled,
    waves_beyond,
)
from gripscale.charts.view import JUDGE, PredictionView
from gripscale.core.errors import InputError
from gripscale.core.units import MILLI, ZERO_CELSIUS
from gripscale.experiment.axis import EFFECTS, MODELS
from gripscale.half_space.result import RoughContact
from gripscale.rubber import ShiftTable

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.case.prepare import PreparedRubber
    from gripscale.case.results import CaseResults
    from gripscale.surface import PreparedSurface


# Contact area and friction against wavelength, per wave and running (figures 5 and 8 of LW).


@styled
def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw relative contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols are the running values, open symbols and thin lines those of each wave; a model
    without waves is a level line at its total. Friction leaves out what is at rest, which has none;
    of a prediction without a single converged wave the legend says that there is nothing to draw.
    Lines are dashed beyond the measured band of the rubber.
    """
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = axes[0]
    views = [PredictionView(data, name) for name, data in predictions.items()]
    for view, colour in zip(views, COLOURS, strict=False):
        _pair(area, view, "contact_fraction", colour)
        if view.moving:
            _pair(friction, view, "friction", colour)
    area_axis(area, top=1.15)
    area.set_ylabel("relative contact area [-]")
    friction.set_ylabel("friction coefficient [-]")
    friction.set_ylim(bottom=0.0)
    waves = [length for view in views if view.waves for length in view.column("wavelength") / MILLI]
    for panel in (area, friction):
        if waves:
            falling_wavelength(panel, waves)
        else:
            panel.set_xticks([])
    dashed_entry(area)
    figure.legend(*area.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def _pair(axes: Axes, view: PredictionView, quantity: str, colour: str) -> None:
    """Draw the running value and the value of each wave against wavelength [mm]."""
    if not view.waves:
        total = view.total(quantity)
        if np.isfinite(total):
            axes.axhline(total, color=colour, ls=DOTTED, label=f"{view.name}, total")
        return
    if not view.converged.any():
        axes.plot([], [], ls="", label=f"{view.name}: {view.why(view.waves - 1)}")
        return
    wavelength = view.column("wavelength") / MILLI
    running = view.usable(f"running_{quantity}")
    beyond = waves_beyond(view.data)
    look: dict[str, Any] = {"color": colour, "marker": "o"}
    line(axes, wavelength, running, down_to(beyond), f"{view.name}, running", **look)
    look |= {"mfc": "white", "lw": 0.8}
    line(axes, wavelength, view.usable(quantity), beyond, f"{view.name}, each wave", **look)


# How warm the rubber gets in a contact: on every scale, and along the surface.

PARTS = {
    "flash_temperature_rise_uniform": ("all waves, spread evenly", SKY),
    "flash_temperature_rise_larger_waves": ("in the contact of larger waves", BLUE),
    "flash_temperature_rise_own": ("the wave's own", ORANGE),
}
"""What warms a wave where it loses energy: name in results, in legends, and colour."""
BAR = 1.25
"""Left end of a bar over its wavelength, and that over its right end."""


def require_warming(data: xr.Dataset) -> None:
    """Raise `InputError` unless a chain's Dataset has temperatures of its waves."""
    if not set(PARTS) <= set(data.data_vars) or "scale" not in data.dims:
        raise InputError("data must be of a chain solved with heat; got one without temperatures")


@styled
def heat_figure(data: xr.Dataset, title: str = "") -> Figure:
    """Draw by how much each wave of a chain is warmer than the rubber before the contact.

    Bars are the temperature where the wave loses its energy, in the parts that add to it, those
    that cool it below zero: heat that comes up from the depth when the contact has passed. Dots are
    at the surface, in the contact of the wave. Waves without solution are left out.

    Parameters
    ----------
    data : xarray.Dataset
        Of `Prediction.to_dataset`, with heat.
    title : str
        Above the panel.

    Raises
    ------
    InputError
        If there are no temperatures in it.
    """
    require_warming(data)
    data = data.isel(scale=np.isfinite(data.flash_temperature_rise_own.values))
    figure, panels = sheet(NARROW, 3.4)
    axes = panels[0, 0]
    length = data.wavelength.values / MILLI
    above, below = np.zeros(length.size), np.zeros(length.size)
    for name, (label, colour) in PARTS.items():
        part = data[name].values
        axes.bar(
            length / BAR,
            part,
            length * (BAR - 1.0 / BAR),
            bottom=np.where(part > 0.0, above, below),
            align="edge",
            color=colour,
            label=label,
        )
        above, below = above + np.maximum(part, 0.0), below + np.minimum(part, 0.0)
    before = _before(data)
    look: dict[str, Any] = {"marker": "o", "ms": 4.0, "mfc": "white", "mec": INK, "ls": ""}
    axes.plot(length, data.contact_temperature - before, label="at the surface, in contact", **look)
    falling_wavelength(axes, length)
    axes.axhline(0.0, color=INK, lw=0.7)
    axes.use_sticky_edges = False  # of bars upon bars, which would leave none above the topmost
    axes.margins(y=0.08)
    axes.set_ylabel(f"above the {before - ZERO_CELSIUS:.3g} °C before the contact [K]")
    figure.legend(loc="outside upper center", ncols=2, title=title)
    return figure


def _before(data: xr.Dataset) -> float:
    """Return the temperature before the contact [K], NaN without waves.

    Stated, or else the least that is left of any wave's without what warms it: of the temperature a
    wave was solved at and the warming it found, which agree to some tenths of a kelvin.
    """
    stated = (json.loads(data.attrs.get("conditions", "null")) or {}).get("temperature")
    if stated is not None:
        return float(stated)
    left = data.temperature - sum(data[name] for name in PARTS)
    return float(left.mean()) if left.size else math.nan


@styled
def direct_heat_figure(contact: RoughContact, title: str = "") -> Figure:
    """Draw by how much the rubber is warmer than before a direct contact.

    On one side where the octaves of wavelengths lose their energy; on the other at the surface, of
    a line with its contact marked below.

    Parameters
    ----------
    contact : RoughContact
        Solved with heat, sliding.
    title : str
        Above the panels.

    Raises
    ------
    InputError
        If it has no temperatures.
    """
    if contact.surface_warming is None or contact.scales is None:
        raise InputError("contact must be solved with heat and slide; got one without temperatures")
    figure, panels = sheet(WIDE, 3.2, 1, 2, gap=0.06, width_ratios=[1.0, 1.5])
    octaves, surface = panels[0]
    length = 2.0 * math.pi / contact.scales.wavenumber / MILLI
    octaves.plot(length, contact.scales.warming, "o-", color=ORANGE)
    falling_wavelength(octaves, length)
    octaves.set_ylim(0.0, 1.1 * float(contact.scales.warming.max()))
    octaves.set_ylabel("warming where the octave loses energy [K]")
    if contact.height.ndim == 1:
        _along(surface, contact, contact.surface_warming)
    else:
        _map(figure, surface, contact, contact.surface_warming)
    if title:
        figure.suptitle(title, fontsize=9.0)
    return figure


def _along(axes: Axes, contact: RoughContact, warming: Any) -> None:
    """Draw the surface temperature along a line, and where it touches."""
    x, top = contact.x / MILLI, float(np.max(warming))
    axes.plot(x, warming, color=ORANGE, lw=0.9, rasterized=True)
    level = float(np.average(warming, weights=contact.pressure))
    axes.axhline(level, color=GREY, lw=0.8, ls="-.", label="mean in the contact, by pressure")
    touching = np.where(contact.active, -0.06 * top, np.nan)
    axes.plot(x, touching, color=GREEN, lw=4.0, solid_capstyle="butt", label="contact")
    axes.set_ylim(-0.12 * top, 1.25 * top)
    axes.margins(x=0.0)
    axes.set_xlabel("along the way of sliding $x$ [mm]")
    axes.set_ylabel("warming of the surface [K]")
    axes.legend(loc="upper right", ncols=2)


def _map(figure: Figure, axes: Axes, contact: RoughContact, warming: Any) -> None:
    shown = axes.pcolormesh(
        contact.x / MILLI, contact.y / MILLI, np.asarray(warming).T, cmap="inferno", rasterized=True
    )
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xlabel("along the way of sliding $x$ [mm]")
    axes.set_ylabel("$y$ [mm]")
    bar = figure.colorbar(shown, ax=axes, label="warming of the surface [K]")
    bar.outline.set_linewidth(0.0)


# What each effect of the conditions is worth: area and friction with and without it.

HEIGHT, ROW = 1.5, 0.32
"""Of the figure without rows, and of each [inch]."""
INSIDE = 0.45
"""Of the longest bar; in one longer than that its number stands inside."""
BESIDE = 0.6
"""Of the height of a row that the bars of all models take."""


PANELS = {
    "total_contact_fraction": "real contact area $A_r/A_0$ [-]",
    "total_friction": "friction, hysteresis $\\mu$ [-]",
    WITH_AREA_TERM: "friction with area term [-]",
}
PER_CENT = "at a bar: what the effects left out change"


@styled
def effects_figure(*results: xr.Dataset, title: str = "") -> Figure:
    """Draw A_r/A_0 and friction as bars: with all effects, without each in turn, without any.

    A dotted line goes on from the answer with all effects. At each other bar stands what the
    effects left out change, in per cent of it. Where an area term was asked for, friction with it
    has a panel of its own.

    Parameters
    ----------
    *results : xarray.Dataset
        As `gripscale.analysis.effects` returns them, one for each model, one at least; all of the
        same conditions.
    title : str
        Above the panels.
    """
    names = [str(name) for name in results[0].effect.values]
    shown = [name for name in PANELS if any(name in result for result in results)]
    height = HEIGHT + ROW * len(names) * max(len(results), 1.5)
    figure, panels = sheet(WIDE, height, 1, len(shown), gap=0.04, sharey=True)
    for axes, name in zip(panels[0], shown, strict=True):
        drawn = [result[name].values for result in results if name in result]
        longest = float(np.nanmax(np.concatenate(drawn), initial=0.0))
        for k, (result, colour) in enumerate(zip(results, COLOURS, strict=False)):
            place = np.arange(len(names)) + BESIDE * ((k + 0.5) / len(results) - 0.5)
            if name in result:
                look: dict[str, Any] = {"height": 0.9 * BESIDE / len(results), "color": colour}
                axes.barh(place, np.nan_to_num(result[name].values), **look, label=_name(result))
                _say(axes, result, name, place, colour, longest)
        axes.set_xlabel(PANELS[name])
        axes.grid(visible=False, axis="y")
        axes.margins(x=0.3)
        axes.set_xlim(left=0.0)
        axes.xaxis.set_major_locator(MaxNLocator(4))
    first = panels[0, 0]
    first.set_yticks(np.arange(len(names)), [EFFECTS.get(name, name) for name in names])
    first.invert_yaxis()
    handles, labels = first.get_legend_handles_labels()
    above = "\n".join(filter(None, [title, PER_CENT]))
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles), title=above)
    return figure


def _name(result: xr.Dataset) -> str:
    model = str(result.attrs["model"])
    return MODELS.get(model, model)


def _say(
    axes: Axes, result: xr.Dataset, name: str, place: Any, colour: str, longest: float
) -> None:
    """Write the changes beside the bars, and draw the answer with all effects behind them."""
    values, changes = result[name].values, result[CHANGES[name]].values
    if np.isfinite(values[0]):
        axes.axvline(values[0], color=colour, lw=0.8, ls=DOTTED, zorder=0.9)
    for at, value, change in zip(place, values, changes, strict=True):
        if np.isfinite(value) and not np.isfinite(change):
            continue
        text = f"{100.0 * change:+.0f} %" if np.isfinite(value) else "not converged"
        within = value > INSIDE * longest
        look: dict[str, Any] = {"color": "white", "ha": "right"} if within else {"color": INK}
        if not within:  # a short bar may end just before the line, which then passes behind
            look["bbox"] = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        axes.annotate(
            text,
            (float(np.nan_to_num(value)), at),
            (-3.0 if within else 3.0, 0.0),
            textcoords="offset points",
            va="center",
            fontsize=7.0,
            **look,
        )


def draw_inputs(results: CaseResults, folder: Path) -> None:
    """Draw profiles, correlation and master curve into `folder`."""
    surface_figures(results.surface, folder)
    omega = excited(results.file.case.load.speed, results.surface.sines)
    rubber_figures(results.rubber, omega, folder)


def draw_blocks(results: CaseResults, name: str, folder: Path) -> None:
    """Draw the blocks of a prediction, "dynamic" or "static", into `folder`."""
    save_figure(blocks_figure(results.dataset(name)), folder, f"blocks_{name}")


def draw_contact(results: CaseResults, folder: Path) -> None:
    """Draw area and friction of all predictions into `folder`, and what judges them."""
    found = map(results.dataset, results.predictions)
    titles = {PredictionView(data).title.lower(): data for data in found}
    if results.direct is not None:
        titles[JUDGE] = results.direct
    save_figure(contact_figure(titles), folder, "contact_and_friction")


def draw_heat(data: xr.Dataset, folder: Path) -> None:
    """Draw the temperature of each wave of a chain into `folder`."""
    save_figure(heat_figure(data), folder, "heat")


def draw_effects(results: Sequence[xr.Dataset], folder: Path) -> None:
    """Draw what each effect of the conditions is worth into `folder`."""
    save_figure(effects_figure(*results), folder, "effects")


def surface_figures(surface: PreparedSurface, folder: Path) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if surface.measured is None or surface.correlation is None:
        return
    save_figure(profile_figure(surface.measured.profiles), folder, "profile")
    waves = {f"{len(surface.sines)} sine waves": surface.sines}
    figure = correlation_figure(surface.correlation, waves, surface.measured.self_affine)
    save_figure(figure, folder, "correlation")


def rubber_figures(rubber: PreparedRubber, omega: ArrayLike, folder: Path) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked.

    Of sweeps at several temperatures also how they meet, and the shift factors.
    """
    figure = master_curve_figure(rubber.rubber, rubber.master, rubber.fit, omega)
    save_figure(figure, folder, "master_curve")
    sweeps, master, report = rubber.sweeps, rubber.master, rubber.superposition
    if sweeps is None or master is None or report is None or len(sweeps) < 2:
        return
    save_figure(superposition_figure(sweeps, master), folder, "superposition")
    save_figure(superposition_tests_figure(sweeps, report), folder, "superposition_tests")
    if isinstance(master.shift, ShiftTable):
        save_figure(shift_figure(master.shift, rubber.shift_fits()), folder, "shift")


# The figures of a case drawn in a thread of their own, while the kernel solves.
#
# The kernel leaves Python's lock free, so that importing matplotlib and drawing cost next to
# nothing.


@contextmanager
def background_figures(results: CaseResults, folder: Path) -> Iterator[Callable[[str], None]]:
    """Draw all figures of a case into `folder` while it is being solved.

    Gives a function to be called with the name of the prediction that a wave was just solved for:
    what is complete is drawn. On leaving all the rest is drawn; what went wrong is raised there.
    """
    begun: list[str] = []
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: list[Future[None]] = []

        def draw(what: str, *arguments: Any) -> None:
            jobs.append(pool.submit(_draw, what, results, *arguments, folder))

        def solving(name: str) -> None:
            if name in begun:
                return
            if begun:
                draw("draw_blocks", begun[-1])
            else:
                draw("draw_inputs")
            begun.append(name)

        yield solving
        if begun:
            draw("draw_blocks", begun[-1])
            draw("draw_contact")
        for job in jobs:
            job.result()


def _draw(what: str, *arguments: Any) -> None:
    getattr(import_module("gripscale.charts.print_run"), what)(*arguments)
