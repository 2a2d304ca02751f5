"""Charts of surfaces: profiles as read and cleaned, and C_z with its fits (LW, figures 3b and 4).

Beyond a quarter of the first wavelength the sine waves are drawn as they were fitted, the first
one by its mean over phases, A_1^2 (see `gripscale.surface.fit_sines`). The pure sines, which fall
back there, are dotted. Neither is drawn beyond the first wavelength.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import draw
from gripscale.charts.chart import (
    CrossLine,
    Mark,
    Outline,
    Panel,
    PlotAxis,
    Series,
    ShadedBand,
    ValueMap,
    wavelength_axis,
)
from gripscale.charts.draw import Chart, Sheet
from gripscale.charts.style import BLUE, COLOURS, GREY, INK, NARROW, ORANGE, WIDE
from gripscale.core.arrays import Array
from gripscale.core.units import MILLI, SQUARE_MM
from gripscale.questions.inputs.record import drawn_profiles, envelope, sine_curves
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack
from gripscale.surface.profile import HeightMap, Profile

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.charts.draw import FigureFolder
    from gripscale.surface import Surface

DISTANCE, _HEIGHT = PlotAxis("distance $x$ [mm]"), PlotAxis("height $z$ [mm]")
SELF_AFFINE = "correlation_self_affine"


def profile_figure(pairs: Sequence[tuple[Profile, Profile]]) -> Figure:
    """Draw (as read, cleaned) pairs of profiles side by side: the whole of them and a piece."""
    panels = _profile_panels(xr.Dataset(drawn_profiles(pairs)))
    width = WIDE if len(pairs) > 1 else 0.7 * WIDE
    layout = {"sharey": "row"}
    rows = [*panels[::2], *panels[1::2]]
    sheet = Sheet(rows, len(pairs), width, 4.0, legend_columns=4, gap=0.02, layout=layout)
    return sheet.on_paper()


def _outline(x: Array, ends: Sequence[Array], label: str, colour: str) -> Outline:
    """Return a profile by the lowest and highest heights of its pieces."""
    inside = np.isfinite(x)
    low, high = (end[inside] / MILLI for end in ends)
    return Outline(x[inside] / MILLI, low, high, colour, label, width=0.45)


def profile_charts(inputs: xr.Dataset) -> list[Chart]:
    """Return, for each profile of recorded inputs, the whole of it and a piece close up."""
    return draw.panels_on_page(_profile_panels(inputs))


def _profile_panels(inputs: xr.Dataset) -> list[Panel]:
    panels = []
    for i, name in enumerate(inputs["profile_name"].values):
        profile = inputs.isel(profile=i)
        outlines = [
            _outline(profile[f"{part}_x"].values,
                     [profile[f"{part}_{end}"].values for end in ("lowest", "highest")],
                     label, colour)
            for part, label, colour in (("read", "as read", GREY), ("cleaned", "cleaned", BLUE))
        ]  # fmt: skip
        x, z = profile["close_up_x"].values / MILLI, profile["close_up_z"].values / MILLI
        every_point = [Series(x, z, label="cleaned, every point", width=1.1)]
        for kind, marks, caption in (
            ("profile", outlines, f"as read and cleaned, lowest and highest height of each of "
             f"{profile.sizes['bin']} pieces."),
            ("close-up", every_point, "a piece from the middle, every point. Missing heights are "
             "gaps."),
        ):  # fmt: skip
            alt = f"Height of profile {name} against distance: {caption}"
            title = str(name) if kind == "profile" else ""
            panels.append(
                Panel(DISTANCE, _HEIGHT, marks, title, f"{kind}-{i + 1}", f"{name}: {caption}",
                      alt, height=300)
            )  # fmt: skip
    return panels


MOST_PIXELS = 400  # points of a map along each side that are drawn
# Colour of what a crop keeps.
_KEPT = "#cfe3f3"


def surface_figure(surface: HeightMap | Profile) -> Figure:
    """Draw the heights of a map from above, or of a profile."""
    raw = surface if isinstance(surface, HeightMap) else [surface]
    panel = replace(_raw_panel(raw), title=surface.name)
    height = 3.4 if isinstance(surface, HeightMap) else 2.2
    return Sheet([panel], 1, NARROW, height, legend="").on_paper()


def raw_chart(raw: HeightMap | Sequence[Profile], crop: Sequence[float] | None = None) -> Chart:
    """Return a surface as it was measured, the part that a crop along x [m] keeps in a shade."""
    return draw.panels_on_page([_raw_panel(raw, crop)])[0]


def _raw_panel(raw: HeightMap | Sequence[Profile], crop: Sequence[float] | None = None) -> Panel:
    marks: list[Mark]
    if isinstance(raw, HeightMap):
        along, across = (-(-size // MOST_PIXELS) for size in raw.z.shape)
        heights = (raw.z - np.nanmin(raw.z))[::along, ::across].T / MILLI
        x, y = raw.x[::along] / MILLI, raw.y[::across] / MILLI
        marks = [ValueMap(x, y, heights, "height above the lowest [mm]")]
        words = "The map as measured; the rubber slides along x, to the right."
        ordinate = PlotAxis("distance across $y$ [mm]")
    else:
        pieces = [envelope(profile.x, profile.z) for profile in raw]
        marks = [_outline(x, ends, "as read", GREY) for x, *ends in pieces]
        words, ordinate = "The profiles as measured.", _HEIGHT
    if crop is not None:
        low, high = (end / MILLI for end in crop)
        marks.append(CrossLine(low, _KEPT, upright=True, to=high))
    return Panel(
        DISTANCE,
        ordinate,
        marks,
        name="raw",
        caption=words,
        alt="The surface as measured, before cleaning.",
        height=300,
        to_scale=isinstance(raw, HeightMap),
    )


def correlation_figure(
    measured: HeightDifference,
    sines: Mapping[str, SineStack],
    self_affine: SelfAffineFit | None = None,
) -> Figure:
    """Draw C_z [mm^2] against lag [mm], with the named sine stacks and their wavelengths marked."""
    panel = _correlation_panel(measured.lag, measured.value, measured.lower, measured.upper)
    marks: list[Mark] = []
    if self_affine is not None:
        label = f"self-affine, $H$ = {self_affine.hurst:.2f}"
        marks.append(_self_affine(measured.lag, self_affine.evaluate(measured.lag), label))
    lag = np.geomspace(measured.lag[0], measured.lag[-1], 1000)
    for (name, stack), colour in zip(sines.items(), [BLUE, *COLOURS[2:]], strict=False):
        inside = lag[lag <= stack.wavelength[0]]
        marks += _waves(inside, *sine_curves(stack, inside), name, colour)
        foot = np.full(len(stack), panel.y.low)
        marks.append(Series(stack.wavelength / MILLI, foot, colour, "their wavelengths", dash="",
                            marker="|", size=9.0, width=1.4, clip=False))  # fmt: skip
    panel = panel.with_marks(marks)
    return Sheet([panel], columns=1, width=NARROW, height=3.7, legend="", gap=0.02).on_paper()


def correlation_charts(inputs: xr.Dataset) -> list[Chart]:
    """Return C_z of recorded inputs with its fits."""
    lag, value = inputs["lag"].values, inputs["correlation_value"].values
    ends = (inputs[f"correlation_{end}"].values for end in ("lower", "upper"))
    names = ("fine_lag", "fine_sines", "fine_pure_sines")
    lags, fitted, pure = (inputs[name].values for name in names)
    fits = _waves(lags, fitted, pure, "sine waves, as fitted", BLUE)
    if SELF_AFFINE in inputs:
        label = f"self-affine, $H$ = {inputs.attrs['self_affine_hurst']:.2f}"
        fits.append(_self_affine(lag, inputs[SELF_AFFINE].values, label))
    panel = _correlation_panel(lag, value, *ends).with_marks(fits)
    return draw.panels_on_page([panel])


def _correlation_panel(lag: Array, value: Array, low: Array | None, high: Array | None) -> Panel:
    """Return the measured C_z and its 95 % band, to which fits are added."""
    positive = value[value > 0.0] / SQUARE_MM
    marks: list[Mark] = []
    if low is not None and high is not None:
        marks.append(
            ShadedBand(lag / MILLI, low / SQUARE_MM, high / SQUARE_MM, GREY, "95 % band", 0.35)
        )
    marks.append(Series(lag / MILLI, value / SQUARE_MM, INK, "measured", "", marker=".", size=4.0))
    return Panel(
        PlotAxis("lag $l$ [mm]", log=True),
        PlotAxis("height difference correlation $C_z$ [mm$^2$]", log=True,
             low=0.3 * float(positive.min()), high=3.0 * float(positive.max())),
        marks,
        name="correlation",
        caption="Height difference correlation: measured, superposed sine waves, self-affine fit. "
        "Beyond a quarter of its length the first wave is fitted by its mean over phases.",
        alt="Height difference correlation against lag on logarithmic axes, with its fits.",
        height=400,
        legend="lower right",
    )  # fmt: skip


def _waves(lag: Array, fitted: Array, pure: Array, label: str, colour: str) -> list[Mark]:
    """Return sine waves up to the first wavelength, as fitted and as pure sines."""
    repeating = np.where(lag > 0.25 * lag[-1], pure, np.nan)  # before, the same as fitted
    return [
        Series(lag / MILLI, fitted / SQUARE_MM, colour, label),
        Series(lag / MILLI, repeating / SQUARE_MM, colour, "as pure sines, which repeat", "dotted",
               width=0.8),
    ]  # fmt: skip


def _self_affine(lag: Array, value: Array, label: str) -> Series:
    return Series(lag / MILLI, value / SQUARE_MM, ORANGE, label, "dashed")


def surface_figures(prepared: Surface, figures: FigureFolder) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if prepared.measured is None or prepared.correlation is None:
        return
    figures.save(profile_figure(prepared.measured.profiles), "profile")
    waves = {f"{len(prepared.sines)} sine waves": prepared.sines}
    fit = prepared.measured.self_affine
    figure = correlation_figure(prepared.correlation, waves, fit)
    figures.save(figure, "correlation")
    if (levels := prepared.measured.texture_levels) is not None:
        lengths = levels.wavelength.values / MILLI
        panel = Panel(
            wavelength_axis(lengths),
            PlotAxis("texture level re 1 µm [dB]"),
            [Series(lengths, levels.level.values, BLUE, marker="o", size=3.5)],
        )
        figures.save(Sheet([panel], 1, NARROW, 3.4), "texture_levels")
