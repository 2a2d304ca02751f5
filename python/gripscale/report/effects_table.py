"""What each effect of the conditions is worth, as a table: with all of them, without each."""

from __future__ import annotations

import math

import xarray as xr
from rich.table import Table

from gripscale.effects.effects import CHANGES, WITH_AREA_TERM
from gripscale.model import ADHESIVE_FRICTION
from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.study.display import EFFECTS


def effects_table(*results: xr.Dataset) -> Table:
    """Return area and friction with all effects, without each in turn, and without any.

    Beside each number without an effect stands what the effect changes, in per cent of it.

    Parameters
    ----------
    *results : xarray.Dataset
        As `gripscale.effects.effects` returns them, one for each model.
    """
    table = printed_table()
    table.add_column("model", no_wrap=True)
    table.add_column("effects", no_wrap=True)
    area_term = any(WITH_AREA_TERM in one for one in results)
    heads = ["A_r/A_0", "change", "μ", "change"]
    heads += ["μ area\nterm", "μ with\nit", "change"] if area_term else []
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("status", overflow="fold")
    for result in results:
        for i, effect in enumerate(result.effect.values.tolist()):
            one = result.isel(effect=i)
            status = str(one.prediction_status.item())
            table.add_row(
                str(result.attrs["model"]) if i == 0 else "",
                EFFECTS.get(effect, effect),
                *_changed(one, "total_contact_fraction"),
                *_changed(one, "total_friction"),
                *(_area_term(one) if area_term else ()),
                status,
                style=None if status == "converged" else "bold red",
                end_section=i == result.sizes["effect"] - 1,
            )
    return table


def _area_term(one: xr.Dataset) -> tuple[str, str, str]:
    if WITH_AREA_TERM not in one:
        return "-", "-", "-"
    return significant(float(one[ADHESIVE_FRICTION])), *_changed(one, WITH_AREA_TERM)


def _changed(one: xr.Dataset, name: str) -> tuple[str, str]:
    """Return a number, and what the effect left out makes of it, in per cent."""
    change = float(one[CHANGES[name]])
    return significant(float(one[name])), "" if math.isnan(change) else f"{100.0 * change:+.1f} %"
