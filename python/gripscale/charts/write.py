"""Which figures each command writes into its folder, and from what."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.case.record import excited
from gripscale.charts import comparison, rubber, study, surface, uncertainty, wave_and_chain
from gripscale.charts.blocks import blocks_figure
from gripscale.charts.cut_off import cut_off_figure
from gripscale.charts.direct_contact import named_traces, trace_figure
from gripscale.charts.ladder import on_the_surface, varied, worth_drawing
from gripscale.charts.page_elements import Picture
from gripscale.charts.paper import save_figure
from gripscale.charts.view import JUDGE, PredictionView
from gripscale.experiment.axis import dimensions, numeric
from gripscale.experiment.speed_and_temperature import REDUCED_SPEED
from gripscale.rubber import ShiftTable

if TYPE_CHECKING:
    from gripscale.case.prepare import PreparedRubber
    from gripscale.case.results import CaseResults
    from gripscale.surface import Surface


def draw(pictures: Iterable[Picture], folder: Path) -> list[Path]:
    """Write pictures into `folder`; return the paths."""
    return [
        path for picture in pictures for path in save_figure(picture.figure, folder, picture.name)
    ]


def draw_inputs(results: CaseResults, folder: Path) -> None:
    """Draw profiles, correlation and master curve into `folder`."""
    surface_figures(results.surface, folder)
    omega = excited(results.file.case.load.speed, results.surface.sines)
    rubber_figures(results.rubber, omega, folder)


def surface_figures(prepared: Surface, folder: Path) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if prepared.measured is None or prepared.correlation is None:
        return
    save_figure(surface.profile_figure(prepared.measured.profiles), folder, "profile")
    waves = {f"{len(prepared.sines)} sine waves": prepared.sines}
    fit = prepared.measured.self_affine
    figure = surface.correlation_figure(prepared.correlation, waves, fit)
    save_figure(figure, folder, "correlation")


def rubber_figures(prepared: PreparedRubber, omega: ArrayLike, folder: Path) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked.

    Of sweeps at several temperatures also how they meet, and the shift factors.
    """
    sweeps, master, report = prepared.sweeps, prepared.master, prepared.superposition
    figure = rubber.master_curve_figure(prepared.rubber, master, prepared.fit, omega)
    save_figure(figure, folder, "master_curve")
    if sweeps is None or master is None or report is None or len(sweeps) < 2:
        return
    save_figure(rubber.superposition_figure(sweeps, master), folder, "superposition")
    save_figure(rubber.superposition_tests_figure(sweeps, report), folder, "superposition_tests")
    if isinstance(master.shift, ShiftTable):
        save_figure(rubber.shift_figure(master.shift, prepared.shift_fits()), folder, "shift")


def draw_blocks(results: CaseResults, name: str, folder: Path) -> None:
    """Draw the blocks of a prediction, "dynamic" or "static", into `folder`."""
    save_figure(blocks_figure(results.dataset(name)), folder, f"blocks_{name}")


def draw_contact(results: CaseResults, folder: Path) -> None:
    """Draw area and friction of all predictions, what judges them, and against the cut-off."""
    predictions = map(results.dataset, results.predictions)
    titles = {PredictionView(data).title.lower(): data for data in predictions}
    if results.direct is not None:
        titles[JUDGE] = results.direct
    save_figure(wave_and_chain.contact_figure(titles), folder, "contact_and_friction")
    for curve in results.continued.values():
        save_figure(cut_off_figure(curve), folder, "cut_off")


def draw_direct(results: CaseResults, folder: Path) -> None:
    """Draw rubber on surface, pressure and friction of the direct contacts, if they are solved."""
    traces = [] if results.direct is None else named_traces(results.direct)
    for number, (name, trace) in enumerate(traces, start=1):
        end = f"_{number}" if number > 1 else ""
        save_figure(trace_figure(trace, name), folder, f"direct_contact{end}")


def draw_heat(data: xr.Dataset, folder: Path) -> None:
    """Draw the temperature of each wave of a chain into `folder`."""
    save_figure(wave_and_chain.heat_figure(data), folder, "heat")


def draw_effects(results: Sequence[xr.Dataset], folder: Path) -> None:
    """Draw what each effect of the conditions is worth into `folder`."""
    save_figure(wave_and_chain.effects_figure(*results), folder, "effects")


def draw_study(result: xr.Dataset, folder: Path) -> None:
    """Draw totals and, over a single axis, what the waves do; over two axes the page does."""
    save_figure(study.totals_figure(result), folder, "totals")
    if REDUCED_SPEED in result.coords and np.isfinite(result.total_friction.values).any():
        save_figure(study.friction_master_figure(result), folder, "friction_master_curve")
        if min(result.sizes["speed"], result.sizes["temperature"]) > 1:
            save_figure(study.map_figure(result), folder, "map")
    several = [name for name in dimensions(result) if result.sizes[name] > 1]
    if len(several) != 1 or "wavelength" not in result:
        return
    axis = several[0]
    result = result.isel({name: 0 for name in dimensions(result) if name != axis})
    if not (result.prediction_status == "converged").any():
        return
    save_figure(study.wavelength_figure(result, axis), folder, "wavelength")
    if axis in numeric(result):
        save_figure(study.stacked_figure(result, axis), folder, "stacked")
        if "friction_by_decade" in result:
            save_figure(study.decades_figure(result, axis), folder, "decades")


def draw_comparison(data: xr.Dataset, folder: Path) -> None:
    """Draw a comparison into `folder`: its ladder and wavelengths, or all of it over its axis."""
    axis = varied(data)
    if axis:
        save_figure(comparison.comparison_axis_figure(data), folder, f"over_{axis}")
        return
    save_figure(comparison.comparison_figure(data), folder, "comparison")
    if worth_drawing(on_the_surface(data)).any():
        save_figure(comparison.comparison_wavelength_figure(data), folder, "by_wavelength")


def draw_calibration(data: xr.Dataset, folder: Path) -> list[Path]:
    """Write every figure of a calibration into `folder`; return the paths.

    Raises `FileError` if one cannot be written.
    """
    return draw(uncertainty.calibration_pictures(data), folder)
