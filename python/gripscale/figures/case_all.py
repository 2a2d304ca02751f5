"""Which figures a case writes, and from what."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from gripscale.case.drawn import excited
from gripscale.figures.blocks import blocks_figure
from gripscale.figures.contact import contact_figure
from gripscale.figures.correlation import correlation_figure
from gripscale.figures.effects import effects_figure
from gripscale.figures.heat import heat_figure
from gripscale.figures.master_curve import master_curve_figure
from gripscale.figures.profile import profile_figure
from gripscale.figures.style import save_figure
from gripscale.figures.superposition import (
    shift_figure,
    superposition_figure,
    superposition_tests_figure,
)
from gripscale.figures.view import JUDGE, PredictionView
from gripscale.rubber import ShiftTable

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.case.prepare_rubber import PreparedRubber
    from gripscale.case.results import CaseResults
    from gripscale.surface import PreparedSurface


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
