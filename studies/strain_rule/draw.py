"""The figure: areas and frictions by the rules over those of blocks, family by family."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from studies.strain_rule.tables import Row, by_family, sliding_error, static_error, unsoftened

Rules = dict[str, tuple[str, Callable[[Row], float]]]
GREY, BLUE, RED = "#8a8a8a", "#4f8fb8", "#c1502e"


def draw(static: Sequence[Row], sliding: Sequence[Row], path: Path) -> None:
    """Draw rule over block by family: area at rest, then area and friction in sliding."""
    at_rest: Rules = {
        "no softening": (GREY, unsoftened),
        "half the rms slope": (BLUE, partial(static_error, rule="slope 0.5")),
        "strain at the depth of the scale": (RED, static_error),
    }
    slides: dict[str, Rules] = {
        what: {
            "no softening": (GREY, partial(sliding_error, what=what, rule="hard")),
            "strain at the depth of the scale": (RED, partial(sliding_error, what=what)),
        }
        for what in ("area", "friction")
    }
    figure, panels = plt.subplots(1, 3, figsize=(10.5, 4.8), sharey=True)
    shown: list[tuple[str, Sequence[Row], Rules]] = [
        ("area at rest: half-space / block", static, at_rest),
        ("area in sliding: half-space / layers", sliding, slides["area"]),
        ("friction: half-space / layers", sliding, slides["friction"]),
    ]
    for panel, (title, rows, rules) in zip(panels, shown, strict=True):
        for shift, (label, (colour, error)) in zip((-0.24, 0.0, 0.24), rules.items(), strict=False):
            for number, errors in enumerate(by_family(rows, error).values()):
                panel.plot(
                    np.exp(errors),
                    np.full(errors.size, number + (0.24 if colour == RED else shift)),
                    "o",
                    ms=3.0,
                    mew=0.0,
                    alpha=0.6,
                    color=colour,
                    label=label if number == 0 else None,
                )
        panel.axvline(1.0, color="black", lw=0.8)
        panel.axvspan(0.9, 1.1, color="black", alpha=0.06, lw=0.0)
        panel.set_xscale("log")
        ticks = [0.3, 0.5, 0.7, 1.0, 1.4]
        panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        panel.minorticks_off()
        panel.set_xlabel(title)
        panel.grid(axis="x", lw=0.4, alpha=0.5)
    families = list(dict.fromkeys(row["family"] for row in static))
    panels[0].set_yticks(range(len(families)), families)
    panels[0].invert_yaxis()
    legend = panels[0].get_legend_handles_labels()
    figure.legend(*legend, loc="upper center", ncols=3, frameon=False)
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.94))
    figure.savefig(path, dpi=130)
    plt.close(figure)
