"""The figure: chain over direct contact, as printed and as changed, case by case."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from studies.chain_and_direct.judge import Errors

SHOWN = {
    "as printed, 7 waves": "as printed",
    "pressure classes, cut-off, 7 waves": "8 pressure classes, cut-off",
    "pressure classes, cut-off, upper half, 7 waves": "and of the upper half of the heights",
}
COLOURS = ("#8a8a8a", "#4f8fb8", "#c1502e")


def draw(found: dict[str, Errors], surfaces: list[str], path: Path) -> None:
    """Draw ln(chain / direct) of area and friction by surface, one point for each case."""
    figure, panels = plt.subplots(1, 2, figsize=(9.5, 5.0), sharey=True)
    for panel, column, title in zip(panels, (0, 1), ("contact area", "friction"), strict=True):
        for shift, colour, (name, label) in zip(
            (-0.22, 0.0, 0.22), COLOURS, SHOWN.items(), strict=True
        ):
            for row, surface in enumerate(surfaces):
                values = [e[column] for key, e in found[name].items() if key[0] == surface]
                ratio, at = np.exp(values), np.full(len(values), row + shift)
                panel.plot(
                    ratio,
                    at,
                    "o",
                    ms=3.5,
                    mew=0.0,
                    alpha=0.75,
                    color=colour,
                    label=label if row == 0 else None,
                )
        panel.axvline(1.0, color="black", lw=0.8)
        panel.set_xscale("log")
        ticks = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]
        panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        panel.minorticks_off()
        panel.set_xlabel(f"{title}: chain / direct contact")
        panel.grid(axis="x", lw=0.4, alpha=0.5)
    panels[0].set_yticks(range(len(surfaces)), surfaces)
    panels[0].invert_yaxis()
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="upper center", ncols=3, frameon=False
    )
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.94))
    figure.savefig(path, dpi=130)
    plt.close(figure)
