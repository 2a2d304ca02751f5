"""Which predictions each figure needs; equal predictions of several figures are solved once."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from gripscale.experiment import Task
from reproduction.inputs import (
    DENSE,
    FAST,
    FASTEST,
    ROAD,
    SBR,
    SPEED,
    SPEEDS,
    TREAD,
    Inputs,
)

Panels = dict[str, dict[str, Task]]
"""Predictions by panel of a figure and by name of the line."""

Solved = dict[str, dict[str, xr.Dataset]]
"""Their results."""

STATIC = "static"


def speed_name(speed: float) -> str:
    """Return what a line of one speed is called."""
    return f"{speed * 1e3:g} mm/s" if speed > 0.0 else STATIC


def panels_of(figure: str, inputs: Inputs) -> Panels:
    """Return the predictions of a figure by panel and line; none for figures of the inputs."""
    if figure in ("fig5a", "fig5b", "fig8a"):
        speed = 0.0 if figure == "fig5a" else SPEED
        return {
            surface: {
                name: inputs.task(surface, TREAD, speed, stack)
                for name, stack in inputs.magnified(surface).items()
            }
            for surface in (DENSE, ROAD)
        }
    if figure == "fig6a":
        return {TREAD: {speed_name(v): inputs.task(ROAD, TREAD, v) for v in (0.0, *SPEEDS)}}
    if figure == "fig8b":
        return {
            rubber: {speed_name(v): inputs.task(ROAD, rubber, v) for v in SPEEDS}
            for rubber in (SBR, TREAD)
        }
    if figure in ("fig6b", "fig9a"):
        speeds = (SPEED,) if figure == "fig6b" else (SPEED, FAST, FASTEST)
        return {
            speed_name(v): {rubber: inputs.task(ROAD, rubber, v) for rubber in (TREAD, SBR)}
            for v in speeds
        }
    if figure in ("fig7a", "fig7b", "fig9b"):
        speed = FAST if figure == "fig7b" else SPEED
        return {speed_name(speed): {r: inputs.task(r, TREAD, speed) for r in (ROAD, DENSE)}}
    return {}


def results_of(panels: Panels, solved: Mapping[str, xr.Dataset]) -> Solved:
    """Return the results of `panels` from results by key, without waves that did not converge."""
    return {
        panel: {name: _converged(solved[task.key]) for name, task in lines.items()}
        for panel, lines in panels.items()
    }


def _converged(prediction: xr.Dataset) -> xr.Dataset:
    return prediction.isel(scale=np.flatnonzero(np.isfinite(prediction.running_contact_fraction)))
