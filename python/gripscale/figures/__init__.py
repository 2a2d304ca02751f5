"""Figures: functions that take the package's data objects and return matplotlib figures."""

from gripscale.figures.blocks import block_figure, blocks_figure
from gripscale.figures.contact import contact_figure
from gripscale.figures.correlation import correlation_figure
from gripscale.figures.master_curve import master_curve_figure
from gripscale.figures.profile import profile_figure
from gripscale.figures.style import save_figure

__all__ = [
    "block_figure",
    "blocks_figure",
    "contact_figure",
    "correlation_figure",
    "master_curve_figure",
    "profile_figure",
    "save_figure",
]
