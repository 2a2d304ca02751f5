"""The deformed rubber block of each wave on its rigid sine, with the contact pressure above it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gripscale.figures.style import BLUE, FAINT, GREY, INK, MEGA, ORANGE, WIDE, styled
from gripscale.scale import ScaleResult

Array = NDArray[np.float64]
MESH_DEPTH = 0.55
"""Depth of the block that is shown [wavelengths]."""


@styled
def block_figure(scale: ScaleResult) -> Figure:
    """Draw one wave: contact pressure above the deformed mesh and the rigid sine."""
    return _draw([scale], columns=1, width=4.2)


@styled
def blocks_figure(scales: Sequence[ScaleResult]) -> Figure:
    """Draw every wave of a chain, largest first, four side by side."""
    return _draw(scales, columns=4, width=WIDE)


def _draw(scales: Sequence[ScaleResult], columns: int, width: float) -> Figure:
    columns = min(columns, max(len(scales), 1))
    rows = max(math.ceil(len(scales) / columns), 1)
    low, high = _window(scales)
    panel = width / columns
    inside = panel - 0.46  # what tick labels leave of a panel [inch]
    height = rows * (inside * (0.42 + high - low) + 0.86) + 0.25
    figure = Figure(figsize=(width, height), layout="constrained")
    ratios = [0.42, high - low] * rows
    grid = figure.add_gridspec(2 * rows, columns, height_ratios=ratios)
    for i, scale in enumerate(scales):
        row, column = divmod(i, columns)
        above = figure.add_subplot(grid[2 * row, column])
        below = figure.add_subplot(grid[2 * row + 1, column], sharex=above)
        _pressure(above, scale)
        _block(below, scale, (low, high))
        above.set_title(_caption(scale), loc="left", fontsize=7.0)
        above.set_box_aspect(0.42)
        below.set_box_aspect(high - low)
        if i == 0:
            _annotate(above, below, scale)
        if column == 0:
            above.set_ylabel("$p_c$ [MPa]")
            below.set_ylabel("$z/\\lambda$ [-]")
        else:
            below.tick_params(labelleft=False)
        if i + columns >= len(scales):
            below.set_xlabel("$x/\\lambda$ [-]")
    return figure


def _window(scales: Sequence[ScaleResult]) -> tuple[float, float]:
    """Return the heights shown [wavelengths]: the deepest valley and a part of the block."""
    steepest = max((scale.amplitude / scale.wavelength for scale in scales), default=0.1)
    meshed = any(scale.deformed_mesh is not None for scale in scales)
    return -steepest - 0.06, steepest + (MESH_DEPTH if meshed else 0.06)


def _caption(scale: ScaleResult) -> str:
    state = "" if scale.converged else f"\n{scale.status}"
    return (
        f"$\\lambda$ = {scale.wavelength * 1e3:.3g} mm\n"
        f"$A$ = {scale.amplitude * 1e3:.3g} mm\n"
        f"$p$ = {scale.pressure_received / MEGA:.3g} MPa, contact {scale.contact_fraction:.2f}"
        f"{state}"
    )


def _pressure(axes: Axes, scale: ScaleResult) -> None:
    """Draw the contact pressure [MPa] and its mean along one wavelength."""
    x, pressure = _unrolled(scale.x, scale.pressure, scale.wavelength)
    axes.fill_between(x / scale.wavelength, pressure / MEGA, color=ORANGE, alpha=0.35, lw=0)
    axes.plot(x / scale.wavelength, pressure / MEGA, color=ORANGE, lw=1.0)
    axes.axhline(scale.pressure_received / MEGA, color=GREY, lw=0.8, ls=(0, (4, 2)))
    axes.set_ylim(bottom=0.0)
    axes.tick_params(labelbottom=False)


def _block(axes: Axes, scale: ScaleResult, window: tuple[float, float]) -> None:
    """Draw the rigid wave and, if the solver returned it, the deformed mesh."""
    ratio = scale.amplitude / scale.wavelength
    x = np.linspace(-0.5, 0.5, 400)
    wave = ratio * np.cos(2.0 * math.pi * x)
    axes.fill_between(x, wave, window[0], color=FAINT, lw=0)
    if scale.deformed_mesh is not None:
        _mesh(axes, *_in_contact(scale, *scale.deformed_mesh))
    axes.plot(x, wave, color=INK, lw=0.9)
    axes.set_xlim(-0.5, 0.5)
    axes.set_ylim(*window)
    axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
    axes.grid(False)


def _annotate(above: Axes, below: Axes, scale: ScaleResult) -> None:
    """Name the dashed line and, where the rubber slides, its direction (along x)."""
    mean = (-0.48, scale.pressure_received / MEGA)
    above.annotate("mean", mean, (0, 2), textcoords="offset points", color=GREY, fontsize=6.5)
    if scale.speed > 0.0:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
        place: dict[str, Any] = {
            "transform": below.transAxes,
            "fontsize": 7.0,
            "va": "top",
            "bbox": box,
        }
        below.text(0.05, 0.95, "rubber slides $\\rightarrow$", **place)


def _mesh(axes: Axes, x: Array, z: Array) -> None:
    """Draw the mesh lines over three wavelengths, thinned where they would merge."""
    columns = max((x.shape[1] - 1) // 32, 1)
    layers = max(x.shape[0] // 24, 1)
    lines: list[Array] = []
    for shift in (-1.0, 0.0, 1.0):
        grid = np.stack([x + shift, z], axis=-1)
        lines.extend(grid[::layers])
        lines.extend(grid[:, :-1:columns].transpose(1, 0, 2))
        edge = np.concatenate([grid[0], grid[-1][::-1]])
        axes.fill(edge[:, 0], edge[:, 1], color=BLUE, alpha=0.10, lw=0)
        axes.plot(grid[0, :, 0], grid[0, :, 1], color=BLUE, lw=1.2)
    axes.add_collection(LineCollection(lines, colors=BLUE, linewidths=0.3, alpha=0.6))


def _in_contact(scale: ScaleResult, x: Array, z: Array) -> tuple[Array, Array]:
    """Return the mesh in wavelengths, moved vertically until its surface touches the wave."""
    wave = scale.amplitude * np.cos(2.0 * math.pi * x[0] / scale.wavelength)
    return x / scale.wavelength, (z - np.min(z[0] - wave)) / scale.wavelength


def _unrolled(x: Array, values: Array, period: float) -> tuple[Array, Array]:
    """Return periodic `values` in order of `x` over the three periods around the crest."""
    order = np.argsort(np.mod(x, period))
    once, kept = np.mod(x, period)[order], values[order]
    return np.concatenate([once - period, once, once + period]), np.tile(kept, 3)
