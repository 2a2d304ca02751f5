"""The figures of a run."""

from __future__ import annotations

from gripscale.charts.figure_folder import Figures
from gripscale.questions.answer.reliance import is_measured
from gripscale.questions.chain.charts import contact_sheet
from gripscale.questions.chain.run import ChainRun
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.inputs.charts_of_rubber import rubber_figures
from gripscale.questions.inputs.charts_of_surface import surface_figures
from gripscale.questions.inputs.record import excited
from gripscale.questions.words import JUDGE, OF_THE_PAPER


def draw_inputs(run: ChainRun, figures: Figures) -> None:
    """Draw surface and rubber, and the measured contact where it is solved."""
    surface_figures(run.case.surface, figures)
    rubber_figures(run.case.measured_rubber, excited(run.case), figures)
    for name, figure in [] if run.answer is None else run.answer.figures():
        figures.save(figure, name)


def draw_contact(run: ChainRun, figures: Figures) -> None:
    """Draw area and friction of all predictions, what judges them, and against the cut-off."""
    titles = {}
    for name in run.predictions:
        view = PredictionView(run.dataset(name))
        of = "" if run.case.surface.measured is None else f"{OF_THE_PAPER}, "
        titles[f"{of}{view.title.lower()}"] = view.data
    if run.answer is not None and is_measured(run.answer.data):
        titles[JUDGE] = run.answer.data
    figures.save(contact_sheet(titles), "contact_and_friction")
    if run.answer is not None and run.answer.curve is not None:
        figures.save(cut_off_sheet(run.answer.curve), "cut_off")
