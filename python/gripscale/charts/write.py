"""Which figures each command writes into its folder, and from what."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.charts.figure_folder import FigureFolder, Figures
from gripscale.charts.page_elements import Picture
from gripscale.questions.answer.charts import named_traces, profile_names, trace_sheet
from gripscale.questions.chain import charts as wave_and_chain
from gripscale.questions.chain.charts_of_blocks import all_blocks
from gripscale.questions.chain.view import JUDGE, PredictionView
from gripscale.questions.compare import charts as comparison
from gripscale.questions.compare.charts_of_ladder import on_the_surface, varied, worth_drawing
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.inputs import charts_of_rubber as rubber
from gripscale.questions.inputs import charts_of_surface as surface
from gripscale.questions.inputs.record import excited
from gripscale.questions.vary import charts as study
from gripscale.questions.vary.axis import dimensions, numeric
from gripscale.questions.vary.speed_and_temperature import REDUCED_SPEED
from gripscale.rubber import ShiftTable

if TYPE_CHECKING:
    from gripscale.case import Case
    from gripscale.questions.answer.answer import Answer
    from gripscale.questions.chain.run import ChainRun
    from gripscale.rubber.measured_rubber import MeasuredRubber
    from gripscale.surface import Surface


def draw(pictures: Iterable[Picture], figures: FigureFolder) -> None:
    """Write pictures into a folder."""
    for picture in pictures:
        figures.save(picture.figure, picture.name)


def draw_inputs(case: Case, figures: Figures) -> None:
    """Draw profiles, correlation and master curve."""
    surface_figures(case.surface, figures)
    omega = excited(case.load.speed, case.surface.sines)
    rubber_figures(case.measured_rubber, omega, figures)


def surface_figures(prepared: Surface, figures: Figures) -> None:
    """Draw the profiles and their correlation; waves stated by hand have neither."""
    if prepared.measured is None or prepared.correlation is None:
        return
    figures.save(surface.profile_sheet(prepared.measured.profiles), "profile")
    waves = {f"{len(prepared.sines)} sine waves": prepared.sines}
    fit = prepared.measured.self_affine
    figure = surface.correlation_sheet(prepared.correlation, waves, fit)
    figures.save(figure, "correlation")


def rubber_figures(prepared: MeasuredRubber, omega: ArrayLike, figures: Figures) -> None:
    """Draw the master curve with the angular frequencies `omega` [rad/s] marked.

    Of sweeps at several temperatures also how they meet, and the shift factors.
    """
    sweeps, master, report = prepared.sweeps, prepared.master, prepared.superposition
    figure = rubber.master_curve_sheet(prepared.rubber, master, prepared.fit, omega)
    figures.save(figure, "master_curve")
    if sweeps is None or master is None or report is None or len(sweeps) < 2:
        return
    figures.save(rubber.superposition_sheet(sweeps, master), "superposition")
    figures.save(rubber.superposition_tests_sheet(sweeps, report), "superposition_tests")
    if isinstance(master.shift, ShiftTable):
        figures.save(rubber.shift_sheet(master.shift, prepared.shift_fits()), "shift")


def draw_blocks(run: ChainRun, name: str, figures: Figures) -> None:
    """Draw the blocks of a prediction, "dynamic" or "static"."""
    figures.save(all_blocks(run.dataset(name)), f"blocks_{name}")


def draw_contact(run: ChainRun, figures: Figures) -> None:
    """Draw area and friction of all predictions, what judges them, and against the cut-off."""
    predictions = map(run.dataset, run.predictions)
    titles = {PredictionView(data).title.lower(): data for data in predictions}
    if run.answer is not None and run.answer.is_solved:
        titles[JUDGE] = run.answer.data
    figures.save(wave_and_chain.contact_sheet(titles), "contact_and_friction")
    if run.answer is not None and run.answer.curve is not None:
        figures.save(cut_off_sheet(run.answer.curve), "cut_off")


def draw_direct(answer: Answer, figures: Figures) -> None:
    """Draw rubber on surface, pressure and friction of the first direct contact, if it is solved.

    The page shows the others.
    """
    for name, trace in named_traces(answer.data, profile_names(answer.inputs))[:1]:
        figures.save(trace_sheet(trace, name), "direct_contact")


def draw_heat(data: xr.Dataset, figures: Figures) -> None:
    """Draw the temperature of each wave of a chain."""
    figures.save(wave_and_chain.heat_sheet(data), "heat")


def draw_effects(results: Sequence[xr.Dataset], figures: Figures) -> None:
    """Draw what each effect of the conditions is worth."""
    figures.save(wave_and_chain.effects_sheet(*results), "effects")


def draw_study(result: xr.Dataset, figures: FigureFolder) -> None:
    """Draw totals and, over a single axis, what the waves do; over two axes the page does."""
    figures.save(study.totals_figure(result), "totals")
    if REDUCED_SPEED in result.coords and np.isfinite(result.total_friction.values).any():
        figures.save(study.friction_master_figure(result), "friction_master_curve")
        if min(result.sizes["speed"], result.sizes["temperature"]) > 1:
            figures.save(study.map_figure(result), "map")
    several = [name for name in dimensions(result) if result.sizes[name] > 1]
    if len(several) != 1 or "wavelength" not in result:
        return
    axis = several[0]
    result = result.isel({name: 0 for name in dimensions(result) if name != axis})
    if not (result.prediction_status == "converged").any():
        return
    figures.save(study.wavelength_figure(result, axis), "wavelength")
    if axis in numeric(result):
        figures.save(study.stacked_figure(result, axis), "stacked")
        if "friction_by_decade" in result:
            figures.save(study.decades_figure(result, axis), "decades")


def draw_comparison(data: xr.Dataset, figures: FigureFolder) -> None:
    """Draw a comparison: its ladder and wavelengths, or all of it over its axis."""
    axis = varied(data)
    if axis:
        figures.save(comparison.comparison_axis_figure(data), f"over_{axis}")
        return
    figures.save(comparison.comparison_figure(data), "comparison")
    if worth_drawing(on_the_surface(data)).any():
        figures.save(comparison.comparison_wavelength_figure(data), "by_wavelength")
