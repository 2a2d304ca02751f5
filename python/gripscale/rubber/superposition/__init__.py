"""Time-temperature superposition: sweeps at several temperatures onto one master curve."""

from gripscale.rubber.superposition.neighbours import Overlap
from gripscale.rubber.superposition.report import Superposition
from gripscale.rubber.superposition.superpose import superpose, superpose_report

__all__ = ["Overlap", "Superposition", "superpose", "superpose_report"]
