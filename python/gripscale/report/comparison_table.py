"""Models side by side in text: a table of the rungs, and what the chain is worth by them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich import box
from rich.table import Table

from gripscale.report.tables import significant

if TYPE_CHECKING:
    from gripscale.case.compare import Comparison, Rung
    from gripscale.chain.prediction import Prediction

NAMES = ("contact_fraction", "friction")


def comparison_table(comparison: Comparison) -> Table:
    """Return area and friction of each rung, with the spread over its samples."""
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("model", no_wrap=True)
    for head in ("A_r/A_0", "spread", "μ", "spread", "samples", "s"):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("status", overflow="fold")
    for rung in comparison.rungs:
        numbers = [cell for name in NAMES for cell in _cells(rung, name)]
        style = None if rung.status == "converged" else "bold red"
        count, seconds = str(len(rung.samples)), f"{rung.seconds:.1f}"
        table.add_row(rung.label, *numbers, count, seconds, rung.status, style=style)
    return table


def judgement(prediction: Prediction, direct: Rung) -> Iterator[str]:
    """Yield what the direct contact of the measured profiles says, and the chain beside it."""
    if direct.status != "converged":
        yield f"The direct contact of the measured profiles gives no judgement: {direct.status}."
        return
    area, friction = (direct.mean(name) for name in NAMES)
    words = f"A_r/A_0 = {significant(area)}"
    if prediction.load.speed > 0.0:
        words += f", mu = {significant(friction)}"
    yield f"Direct contact of the measured profiles, all waves at once at small strain: {words}."
    if not prediction.converged:
        return
    against = f"{prediction.contact_fraction / area:.2g} times its contact area"
    if prediction.load.speed > 0.0:
        against += f" and {prediction.friction / friction:.2g} times its friction"
    yield f"The chain has {against}; `gripscale compare` shows which assumption costs what."


def _cells(rung: Rung, name: str) -> Iterator[str]:
    spread = rung.spread(name)
    yield significant(rung.mean(name))
    yield "-" if math.isnan(spread) else significant(spread, 2)
