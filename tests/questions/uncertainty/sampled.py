"""Samples of a case with an `Uncertainty` made by hand, and of a case that is changed."""

from __future__ import annotations

from copy import copy
from typing import Any

import xarray as xr

from gripscale.case import Case
from gripscale.questions import Uncertainty
from gripscale.questions.uncertainty import propagation


def changed(case: Case, **parts: Any) -> Case:
    """Return a case with other parts, which are taken as they are."""
    other = copy(case)
    vars(other).update(parts)
    return other


_BENCH = ("folder", "workers", "client", "on_task", "on_answer")


def propagate(case: Case, uncertainty: Uncertainty | None = None, **asked: Any) -> xr.Dataset:
    """Return the Dataset of `gripscale.uncertainty`."""
    bench = {name: asked.pop(name) for name in _BENCH if name in asked}
    if uncertainty is not None:
        asked |= vars(uncertainty)
    return propagation.propagate(propagation.Plan.of(case, **asked), **bench)
