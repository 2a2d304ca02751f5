"""Measured profiles: as read with the points cleaning removed, cleaned, and a piece close up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gripscale.case.drawn import CLOSE_UP, close_up, envelope, trace
from gripscale.figures.palette import BLUE, GREY, MILLI, ORANGE, WIDE
from gripscale.figures.style import sheet, styled
from gripscale.surface.profile import Profile

THIN: Any = {"lw": 0.45, "rasterized": True}
PIECES = 5000
"""Pieces a profile is drawn in: several to a pixel, so that most gaps are still seen."""


@styled
def profile_figure(pairs: Sequence[tuple[Profile, Profile]]) -> Figure:
    """Draw (as read, cleaned) pairs of profiles side by side.

    Rows: as read, with the points cleaning removed or cut off; cleaned; 30 mm of it close up,
    where the missing heights are gaps.
    """
    width = WIDE if len(pairs) > 1 else 0.7 * WIDE
    figure, axes = sheet(width, 5.2, 3, len(pairs), sharey="row")
    for column, (raw, cleaned) in enumerate(pairs):
        _as_read(axes[0, column], raw, cleaned)
        _cleaned(axes[1, column], cleaned)
        _close_up(axes[2, column], raw, cleaned)
        axes[0, column].set_title(raw.name or f"profile {column + 1}", loc="left")
        axes[1, column].sharex(axes[0, column])
        axes[0, column].tick_params(labelbottom=False)
        for panel in axes[1:, column]:
            panel.set_xlabel("distance $x$ [mm]")
    for panel, text in zip(axes[:, 0], ("as read", "cleaned", "close up"), strict=True):
        panel.set_ylabel(f"height $z$ [mm]\n{text}")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    close, names = axes[2, 0].get_legend_handles_labels()
    figure.legend(handles + close, labels + names, loc="outside upper center", ncols=4)
    return figure


def kept_points(raw: Profile, cleaned: Profile) -> NDArray[np.bool_]:
    """Return which points of `raw` still have a height in `cleaned`."""
    still = cleaned.x[np.isfinite(cleaned.z)]
    at = np.clip(np.searchsorted(still, raw.x), 1, max(still.size - 1, 1))
    nearest = np.minimum(np.abs(raw.x - still[at - 1]), np.abs(raw.x - still[at % still.size]))
    return np.asarray((nearest < 0.1 * raw.step) & np.isfinite(raw.z))


def _as_read(axes: Axes, raw: Profile, cleaned: Profile) -> None:
    kept = kept_points(raw, cleaned)
    x, z = raw.x / MILLI, raw.z / MILLI
    axes.plot(*_outline(x, np.where(kept, z, np.nan)), color=GREY, label="kept", **THIN)
    gone = ~kept & np.isfinite(raw.z)
    dots: dict[str, Any] = {"color": ORANGE, "rasterized": True, "zorder": 1.5}
    axes.plot(x[gone], z[gone], ".", ms=1.0, mew=0.0, **dots)
    axes.plot([], [], ".", color=ORANGE, ms=4.0, label="removed")


def _cleaned(axes: Axes, cleaned: Profile) -> None:
    axes.plot(*_outline(cleaned.x / MILLI, cleaned.z / MILLI), color=BLUE, **THIN)


def _outline(x: NDArray[np.float64], z: NDArray[np.float64]) -> tuple[Any, Any]:
    """Return what a line of all points would show, in so few that it is quickly drawn."""
    return trace(*envelope(x, z, PIECES))


def _close_up(axes: Axes, raw: Profile, cleaned: Profile) -> None:
    """Draw a piece from the middle, with the removed points at their cleaned level."""
    x, z = close_up(cleaned)
    axes.plot(x / MILLI, z / MILLI, color=BLUE, lw=0.9, label="cleaned")
    both = np.interp(cleaned.x, raw.x, raw.z) - cleaned.z  # the trend, where a height is left
    trend = np.polyfit(cleaned.x[np.isfinite(both)], both[np.isfinite(both)], 1)
    piece = (raw.x >= x[0]) & (raw.x <= x[0] + CLOSE_UP) & ~kept_points(raw, cleaned)
    level = raw.z[piece] - np.polyval(trend, raw.x[piece])
    axes.plot(raw.x[piece] / MILLI, level / MILLI, ".", color=ORANGE, ms=2.5)
