"""How far does finite linear viscoelasticity carry? Four loops of an acrylic elastomer, three fits.

Run as `python examples/finite_strain_rubber.py [FOLDER]`: prints the errors as a Markdown table
and draws the loops into FOLDER (default `results/finite_strain`), from the data in
`data/rubber/finite_strain_vhb`.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from gripscale.charts import save_figure
from gripscale.charts.chart import Mark, Note, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.style import COLOURS, GREY
from gripscale.rubber import (
    FiniteStrainFit,
    UniaxialTest,
    fit_finite_strain,
    read_uniaxial_test,
    rms_error,
    uniaxial_stress,
)

DATA = Path(__file__).parent / "data" / "rubber" / "finite_strain_vhb"

FILES = {
    "loading_1d5_unloading_0d01.xlsx": "to 1.5 at 0.01 /s",
    "loading_2d0_unloading_0d03.xlsx": "to 2.0 at 0.03 /s",
    "loading_3d0_unloading_0d01.xlsx": "to 3.0 at 0.01 /s",
    "loading_3d0_unloading_0d05.xlsx": "to 3.0 at 0.05 /s",
}

ENERGIES = {
    "neo-Hookean": "neo_hookean",
    "Mooney-Rivlin": "mooney_rivlin",
    "Yeoh": "yeoh",
}


def read_tests() -> list[UniaxialTest]:
    """Return the four measured loops, slowest and smallest first."""
    return [
        replace(read_uniaxial_test(DATA / file, stress_unit="kPa"), name=name)
        for file, name in FILES.items()
    ]


def alone(test: UniaxialTest, energy: str) -> float:
    """Return the rms error of a rubber fitted to this test only [-]."""
    return float(fit_finite_strain([test], energy=energy).rms_errors[0])


def foretold(test: UniaxialTest, tests: list[UniaxialTest], energy: str) -> float:
    """Return the rms error on this test of a rubber fitted to the others only [-]."""
    others = [other for other in tests if other is not test]
    return rms_error(fit_finite_strain(others, energy=energy).rubber, test)


def table(fits: dict[str, FiniteStrainFit]) -> list[str]:
    """Return the errors of all fits as lines of Markdown, in percent."""
    tests = list(next(iter(fits.values())).tests)
    lines = [
        "| strain energy | fitted to | " + " | ".join(test.name for test in tests) + " |",
        "|---|---|" + "---|" * len(tests),
    ]
    for label, fit in fits.items():
        energy = ENERGIES[label]
        rows = {
            "all four: rms": [f"{100 * error:.1f}" for error in fit.rms_errors],
            "all four: work lost": [f"{100 * error:+.0f}" for error in fit.work_errors],
            "this one: rms": [f"{100 * alone(test, energy):.1f}" for test in tests],
            "other three: rms": [f"{100 * foretold(test, tests, energy):.1f}" for test in tests],
        }
        lines += [f"| {label} | {what} | " + " | ".join(row) + " |" for what, row in rows.items()]
    return lines


def finite_strain_figure(fits: dict[str, FiniteStrainFit]) -> Figure:
    """Draw nominal stress [kPa] against stretch, one panel for each test, with labelled fits.

    The errors of the fits stand in their colours.
    """
    dashes = ("solid", "solid", "dashed", "dotted", "dashdot", "solid")
    panels = []
    for number, test in enumerate(next(iter(fits.values())).tests):
        measured = test.stress / 1e3
        marks: list[Mark] = [
            Series(test.stretch, measured, GREY, "measured", "", marker="o", size=3.0,
                   filled=False),
            Note(0.03, 0.97, "error: rms, work lost", frame="xy", top=True),
        ]  # fmt: skip
        looks = zip(fits.items(), COLOURS, dashes, strict=False)
        for row, ((label, fit), colour, dash) in enumerate(looks, 1):
            stress = uniaxial_stress(fit.rubber, test.time, test.stretch) / 1e3
            marks.append(Series(test.stretch, stress, colour, label, dash, width=1.1))
            rms, work = 100.0 * fit.rms_errors[number], 100.0 * fit.work_errors[number]
            text = f"{rms:.1f} %, {work:+.0f} %"
            marks.append(Note(0.03, 0.97 - 0.075 * row, text, colour, frame="xy", top=True))
        top = float(np.max(measured))
        ends = min(0.0, float(np.min(measured))) - 0.04 * top, 1.25 * top
        stress_axis = PlotAxis("nominal stress $P$ [kPa]", False, *ends)
        panels.append(Panel(PlotAxis("stretch $s$ [-]"), stress_axis, marks, test.name))
    height = 2.6 * -(-len(panels) // 2) + 0.3
    return Sheet(panels, height=height, legend_columns=1 + len(fits), gap=0.02).on_paper()


def main(folder: str = "results/finite_strain") -> None:
    """Fit, print, draw."""
    tests = read_tests()
    fits = {label: fit_finite_strain(tests, energy=name) for label, name in ENERGIES.items()}
    print("\n".join(table(fits)))
    for label, fit in fits.items():
        moduli = ", ".join(
            f"{modulus / 1e3:.1f} kPa at {time:.3g} s"
            for modulus, time in zip(
                fit.rubber.shear_moduli, fit.rubber.relaxation_times, strict=True
            )
        )
        equilibrium = fit.rubber.equilibrium_shear_modulus / 1e3
        print(f"{label}: G_inf {equilibrium:.1f} kPa, {fit.rubber.strain_energy}; {moduli}")
    Path(folder).mkdir(parents=True, exist_ok=True)
    for path in save_figure(finite_strain_figure(fits), Path(folder), "finite_strain_vhb"):
        print(path)


if __name__ == "__main__":
    main(*sys.argv[1:2])
