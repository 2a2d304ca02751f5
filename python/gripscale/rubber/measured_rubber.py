"""A rubber together with the measurement it was fitted to."""

from __future__ import annotations

from dataclasses import dataclass

from gripscale.core import Finding, InputError
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.prony_report import PronyFit
from gripscale.rubber.shift import ShiftTable
from gripscale.rubber.shift_fit import ShiftFit, fit_wlf
from gripscale.rubber.superposition import Superposition
from gripscale.rubber.sweeps import Sweeps


@dataclass(frozen=True)
class MeasuredRubber:
    """A rubber and what it comes from; a rubber made by hand comes from nothing else."""

    rubber: Rubber
    source: str
    master: MasterCurve | None = None  # the master curve that the Prony series was fitted to
    fit: PronyFit | None = None  # the report on that fit
    sweeps: Sweeps | None = None  # sweeps at several temperatures that make the master curve
    superposition: Superposition | None = None  # how these sweeps meet
    note: str = ""  # what was assumed when its file was read, as a sentence; empty if nothing was

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Why its moduli may be those of no rubber."""
        return () if self.fit is None else self.fit.doubts

    def shift_fits(self) -> list[ShiftFit]:
        """Return the WLF law that the measured shift follows; none where it follows no such law."""
        if self.master is None or not isinstance(self.master.shift, ShiftTable):
            return []
        try:
            reference = self.master.reference_temperature
            return [fit_wlf(self.master.shift, reference_temperature=reference)]
        except InputError:
            return []
