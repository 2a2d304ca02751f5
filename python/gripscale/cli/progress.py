"""A line of the terminal for each prediction of many as it is done."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from gripscale.cli.terminal import say

if TYPE_CHECKING:
    from rich.console import Console

    from gripscale.study import Progress


def teller(console: Console) -> Callable[[Progress], None]:
    """Return what prints a line for each prediction."""

    def tell(progress: Progress) -> None:
        found = progress.result
        width = len(str(progress.total))
        text = f"[{progress.done:>{width}}/{progress.total}] {progress.label}: "
        if found.prediction_status != "converged":
            text += str(found.prediction_status.item())
        else:
            text += f"area {float(found.total_contact_fraction):.4g}"
            if found.nominal_speed > 0.0:
                text += f", friction {float(found.total_friction):.3f}"
        how = "already solved" if progress.stored else f"{progress.seconds:.1f} s"
        say(console, f"{text}, {how}")

    return tell
