"""What the figures of a study share: axes, colours, pieces, the legend at the side."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gripscale.figures.palette import COLOURS, MILLI
from gripscale.figures.style import log_axis
from gripscale.study.display import axis_label, axis_shown, dimensions, name_of

Array = NDArray[np.float64]


def along(axes: Axes, result: xr.Dataset, name: str) -> Array:
    """Label `axes` below with a varied axis and return its values as they are drawn."""
    values = axis_shown(result, name).of(result[name].values)
    axes.set_xlabel(axis_label(result, name))
    if values.min() > 0.0 and values.max() > 20.0 * values.min():
        log_axis(axes, "x")
    axes.set_xlim(values.min(), values.max())
    return values


def pieces(result: xr.Dataset, keep: str) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield name and Dataset over `keep` alone, for each value of the other axis."""
    others = [name for name in dimensions(result) if name != keep]
    if not others:
        yield "", result
        return
    for i in range(result.sizes[others[0]]):
        yield name_of(result, others[0], i), result.isel({others[0]: i})


def colours(count: int, *, ordered: bool) -> Sequence[str]:
    """Return as many colours: of the palette, or along a scale where there is an order."""
    if not ordered and count <= len(COLOURS):
        return COLOURS[:count]
    shades = mpl.colormaps["viridis"](np.linspace(0.0, 0.9, count))
    return [mpl.colors.to_hex(shade) for shade in shades]


def wavelength_names(result: xr.Dataset) -> list[str]:
    """Return the wavelengths of a study over one axis, for a legend; ranges where they vary."""
    names = []
    for i in range(result.sizes["scale"]):
        values = result.wavelength.isel(scale=i).values / MILLI
        values = values[np.isfinite(values)]
        low, high = (values.min(), values.max()) if values.size else (math.nan, math.nan)
        same = high <= low * 1.01
        names.append(f"{high:.3g} mm" if same else f"{low:.3g} to {high:.3g} mm")
    return names


def legend_beside(
    figure: Figure, handles: Sequence[Any], labels: Sequence[str], title: str | None = None
) -> None:
    """Put a legend to the right of all panels."""
    place: Any = "outside right center"
    figure.legend(handles, labels, loc=place, title=title, alignment="left")
