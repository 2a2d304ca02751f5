"""The models of a comparison at the points of a measurement: predicted beside measured friction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from gripscale.comparison.ladder import LADDER
from gripscale.comparison.result import Comparison
from gripscale.comparison.rung import Subject
from gripscale.measured.differences import residuals
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.predicted import Predicted, averaged, predictions_at
from gripscale.study.store import Store
from gripscale.study.threads import OnTask

if TYPE_CHECKING:
    import xarray as xr

ASKED = ("chain", "chain_half_plane", "chain_upper", "direct", "persson", "klueppel_heinrich")
"""Rungs that predict; the others take a step from one of them to the next."""


def at_measured(
    made: Comparison,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what the rungs that predict say at each measured speed, temperature and pressure.

    Parameters
    ----------
    made : Comparison
        With the rungs that were asked for, and measured friction.
    store : path
        Folder of finished predictions: what it has is not solved again.
    workers, client, on_task
        As for `gripscale.study.solve_all`.

    Returns
    -------
    xarray.Dataset or None
        As `gripscale.measured.residuals`, over `model`; None without measured friction. The total
        is the hysteresis where a model knows no contact area.

    Raises
    ------
    InputError
        If a temperature was measured and the rubber has no shift to it.
    """
    measured, subject = made.measured, made.subject
    if measured is None:
        return None
    options: dict[str, Any] = {"workers": workers, "client": client, "on_task": on_task}
    there = [rung for rung in LADDER if rung.name in ASKED and rung.name in made.by_name]
    predicted = {
        rung.name: averaged(
            [
                predictions_at(
                    measured,
                    draw.model,
                    subject.rubber_for(draw.model),
                    draw.surface,
                    subject.load,
                    Store(store),
                    **options,
                )
                for draw in rung.draws(subject)
            ]
        )
        for rung in there
    }
    if not predicted:
        return None
    return _told(measured, subject, predicted, made.file.text)


def _told(
    measured: MeasuredFriction, subject: Subject, predicted: dict[str, Predicted], case: str
) -> xr.Dataset:
    law = None if subject.conditions is None else subject.conditions.shear_stress
    data = residuals(measured, predicted, law)
    return data.assign_attrs(case=case, measured_source=measured.source)
