"""A tread that wears down: contact and friction of the shipped road by thickness of the rubber.

    python -m studies.tread_wear

Tables and figure of docs/direct-contact.md: both stations, waves to 0.1 mm, 3 bar, 0.3 m/s,
estimated errors of 2 %; then what each half of a stack loses. About a minute of one core.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import gripscale as gs
from studies.shipped import road, tread

THICKNESS = (None, 20e-3, 8e-3, 4e-3, 2e-3, 1e-3)
"""[m]; None: a half-space."""
SHORTEST = 1e-4
"""Smallest wave [m]."""
LOAD: dict[str, Any] = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": SHORTEST}


def means(lines: list[gs.Profile], rubber: gs.Rubber, thickness: float | None) -> list[float]:
    """Return the mean area and friction of lines of equal length."""
    contacts = [gs.solve_rough_contact(rubber, z, thickness=thickness, **LOAD) for z in lines]
    if not all(contact.converged for contact in contacts):
        raise RuntimeError(f"a contact of {thickness} m did not converge")
    names = ("contact_fraction", "friction_from_dissipation")
    return [float(np.mean([getattr(c, name) for c in contacts])) for name in names]


def draw(rows: list[list[float]], path: Path) -> None:
    """Draw area and friction over the thickness, with those of the half-space."""
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    FigureCanvasAgg(figure)
    depths = [1e3 * depth for depth in THICKNESS if depth is not None]
    titles = ("real contact area $A_r/A_0$", "friction coefficient $\\mu$")
    for at, (axes, title) in enumerate(zip(figure.subplots(1, 2), titles, strict=True)):
        axes.axhline(rows[0][at], color="0.5", linestyle="--", label="half-space")
        axes.semilogx(depths, [row[at] for row in rows[1:]], "o-", label="layer on a rigid base")
        axes.set_xlabel("thickness [mm]")
        axes.set_ylabel(title)
        axes.set_ylim(bottom=0.0)
        axes.set_xticks(depths, [f"{depth:g}" for depth in depths])
        axes.minorticks_off()
    axes.legend()
    figure.savefig(path, dpi=100, pil_kwargs={"optimize": True})


def main(folder: str = "docs/figures") -> None:
    """Print the tables and write the figure to a folder."""
    lines, rubber = [road(0), road(1)], tread()
    rows = []
    for thickness in THICKNESS:
        rows.append(means(lines, rubber, thickness))
        name = "infinite" if thickness is None else f"{1e3 * thickness:g} mm"
        print(f"| {name} | {rows[-1][0]:.4f} | {rows[-1][1]:.3f} |", flush=True)
    stack = gs.Layers([(rubber, 4e-3), (rubber, 4e-3)])
    contact = gs.solve_rough_contact(stack, lines[0], **LOAD)
    share = contact.friction_by_layer / contact.friction_from_dissipation
    print("upper and lower half of 8 mm:", ", ".join(f"{part:.1%}" for part in share))
    draw(rows, Path(folder) / "tread_wear.png")


if __name__ == "__main__":
    main(*sys.argv[1:2])
