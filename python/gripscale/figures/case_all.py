"""Which figures a case writes, and from what."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from gripscale.case.drawn import excited
from gripscale.figures.blocks import blocks_figure
from gripscale.figures.contact import contact_figure
from gripscale.figures.correlation import correlation_figure
from gripscale.figures.master_curve import master_curve_figure
from gripscale.figures.profile import profile_figure
from gripscale.figures.style import save_figure
from gripscale.figures.view import PredictionView

if TYPE_CHECKING:
    from gripscale.case.prepare import PreparedRubber
    from gripscale.case.results import CaseResults
    from gripscale.surface import PreparedSurface


def draw_inputs(results: CaseResults, folder: Path) -> None:
    """Draw profiles, correlation and master curve into `folder`."""
    surface_figures(results.surface, folder)
    omega = excited(results.file.case.load.speed, results.surface.sines)
    rubber_figure(results.rubber, omega, folder)


def draw_predictions(results: CaseResults, folder: Path) -> None:
    """Draw area and friction of all predictions into `folder`, and the blocks of each."""
    found = {name: one.to_dataset() for name, one in results.predictions.items()}
    if not found:
        return
    titles = {PredictionView(data).title.lower(): data for data in found.values()}
    save_figure(contact_figure(titles), folder, "contact_and_friction")
    for name, data in found.items():
        save_figure(blocks_figure(data), folder, f"blocks_{name}")


def surface_figures(surface: PreparedSurface, folder: Path) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if surface.measured is None or surface.correlation is None:
        return
    save_figure(profile_figure(surface.measured.profiles), folder, "profile")
    waves = {f"{len(surface.sines)} sine waves": surface.sines}
    figure = correlation_figure(surface.correlation, waves, surface.measured.self_affine)
    save_figure(figure, folder, "correlation")


def rubber_figure(rubber: PreparedRubber, omega: ArrayLike, folder: Path) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked."""
    figure = master_curve_figure(rubber.rubber, rubber.master, rubber.fit, omega)
    save_figure(figure, folder, "master_curve")
