"""Samples of a case, with an `Uncertainty` made by hand."""

from __future__ import annotations

from typing import Any

import xarray as xr

from gripscale.case import Case
from gripscale.questions import Uncertainty
from gripscale.questions.uncertainty import propagation
from gripscale.questions.uncertainty.sampling import stated_options

_BENCH = ("folder", "workers", "client", "on_task", "on_answer")


def propagate(case: Case, uncertainty: Uncertainty | None = None, **asked: Any) -> xr.Dataset:
    """Return the Dataset of `gripscale.uncertainty`."""
    bench = {name: asked.pop(name) for name in _BENCH if name in asked}
    choice = uncertainty or Uncertainty.of_case(stated_options(case))
    return propagation.propagate(propagation.Plan.of(case, choice, **asked), **bench)
