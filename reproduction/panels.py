"""Which predictions each figure needs; equal predictions of several figures are solved once."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from gripscale.experiment import Task
from reproduction.inputs import FAST, SPEED, SPEEDS, Inputs

Panels = dict[str, dict[str, Task]]
"""Predictions by panel of a figure and by name of the line."""

Solved = dict[str, dict[str, xr.Dataset]]
"""Their results."""

STATIC = "static"


def speed_name(speed: float) -> str:
    """Return what a line of one speed is called."""
    return f"{speed * 1e3:g} mm/s" if speed > 0.0 else STATIC


def pair_name(pair: tuple[str, str], speed: float) -> str:
    """Return what a panel of two compounds at one speed is called."""
    return f"{pair[1]} and {pair[0]}, {speed_name(speed)}"


def panels_of(figure: str, inputs: Inputs) -> Panels:
    """Return the predictions of a figure by panel and line; none for figures of the inputs."""
    surface, rubber = inputs.surface, inputs.rubber
    if figure in ("fig5a", "fig5b", "fig8a"):
        speed = 0.0 if figure == "fig5a" else SPEED
        return {
            road: {name: inputs.task(road, rubber, speed, stack) for name, stack in stacks.items()}
            for road, stacks in inputs.stacks.items()
        }
    if figure == "fig6a":
        return {rubber: {speed_name(v): inputs.task(surface, rubber, v) for v in (0.0, *SPEEDS)}}
    if figure == "fig8b":
        return {
            compound: {speed_name(v): inputs.task(surface, compound, v) for v in SPEEDS}
            for compound in (rubber, *(second for _, second in inputs.pairs))
        }
    if figure in ("fig6b", "fig9a"):
        pairs = inputs.pairs[:1] if figure == "fig6b" else inputs.pairs
        speeds = (FAST,) if figure == "fig6b" else (SPEED, FAST)
        return {
            pair_name(pair, v): {compound: inputs.task(surface, compound, v) for compound in pair}
            for pair in pairs
            for v in speeds
        }
    if figure in ("fig7b", "fig9b"):
        return {speed_name(SPEED): {r: inputs.task(r, rubber, SPEED) for r in inputs.surfaces}}
    return {}


def results_of(panels: Panels, solved: Mapping[str, xr.Dataset]) -> Solved:
    """Return the results of `panels` from results by key, without waves that did not converge."""
    return {
        panel: {name: _converged(solved[task.key]) for name, task in lines.items()}
        for panel, lines in panels.items()
    }


def _converged(prediction: xr.Dataset) -> xr.Dataset:
    return prediction.isel(scale=np.flatnonzero(np.isfinite(prediction.running_contact_fraction)))
