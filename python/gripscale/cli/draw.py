"""Which figures a run writes, and from what."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from gripscale.cli.inputs import RubberStudy, SurfaceStudy
from gripscale.cli.solving import Chain
from gripscale.figures import (
    blocks_figure,
    contact_figure,
    correlation_figure,
    master_curve_figure,
    profile_figure,
    save_figure,
)


def inputs(target: Path, surface: SurfaceStudy, rubber: RubberStudy, speed: float) -> None:
    """Draw profiles, correlation and master curve into `target`."""
    surface_figures(target, surface)
    omega = 2.0 * math.pi * speed / np.asarray(surface.sines.wavelength)
    rubber_figure(target, rubber, omega if speed > 0.0 else np.array([]))


def surface_figures(target: Path, surface: SurfaceStudy) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if surface.measured is None:
        return
    save_figure(profile_figure(surface.measured.profiles), target, "profile")
    waves = {f"{len(surface.sines)} sine waves": surface.sines}
    fit = surface.measured.self_affine
    save_figure(correlation_figure(surface.measured.correlation, waves, fit), target, "correlation")


def rubber_figure(target: Path, rubber: RubberStudy, omega: np.ndarray) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked."""
    figure = master_curve_figure(rubber.rubber, rubber.master, rubber.fit, omega)
    save_figure(figure, target, "master_curve")


def chains(target: Path, solved: Sequence[Chain]) -> None:
    """Draw area and friction of all chains, and the blocks of each."""
    if not solved:
        return
    predictions = {chain.title.lower(): chain.solved for chain in solved}
    save_figure(contact_figure(predictions), target, "contact_and_friction")
    for chain in solved:
        save_figure(blocks_figure(chain.solved.scales), target, f"blocks_{chain.name}")
