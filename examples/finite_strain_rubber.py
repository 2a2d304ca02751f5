"""How far does finite linear viscoelasticity carry? Four loops of an acrylic elastomer, three fits.

Run as `python examples/finite_strain_rubber.py [FOLDER]`: prints the errors as a Markdown table
and draws the loops into FOLDER (default `results/finite_strain`), from the data in
`data/rubber/finite_strain_vhb`.

On given relaxation times the nominal stress is linear in the moduli,

    P(t) = sum_k c_k P_k(s) + sum_i G_i (s A_i,11 - s^-2 A_i,22)

(P_k and c_k are those of `LAWS`), so that the least squares of P over
the peak stress of each test, each test counting alike, is a convex problem with bounds and one
minimum: no start values, no local minima. Bounded-variable least squares: P. B. Stark & R. L.
Parker, Comput. Stat. 10 (1995) 129.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from openpyxl import load_workbook
from scipy.integrate import trapezoid
from scipy.optimize import lsq_linear

from gripscale.charts import save_figure
from gripscale.charts.chart import Mark, Note, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.style import COLOURS, GREY
from gripscale.rubber import MooneyRivlin, NeoHookean, Rubber, Yeoh, uniaxial_stress
from gripscale.rubber.finite_strain import uniaxial_network_stresses
from gripscale.rubber.strain_energy import StrainEnergy

Array = NDArray[np.float64]
DATA = Path(__file__).parent / "data" / "rubber" / "finite_strain_vhb"

FILES = {
    "loading_1d5_unloading_0d01.xlsx": "to 1.5 at 0.01 /s",
    "loading_2d0_unloading_0d03.xlsx": "to 2.0 at 0.03 /s",
    "loading_3d0_unloading_0d01.xlsx": "to 3.0 at 0.01 /s",
    "loading_3d0_unloading_0d05.xlsx": "to 3.0 at 0.05 /s",
}


@dataclass(frozen=True)
class Law:
    """A strain energy as a fit takes it: G times the law is linear in coefficients c_k [Pa]."""

    least: tuple[float, ...]  # lower bounds of c_k [Pa]
    units: tuple[tuple[StrainEnergy, StrainEnergy | None], ...]
    """Of each c_k the law with it over G, less the other."""
    made: Callable[..., StrainEnergy]  # of all c_k [Pa]

    def basis(self, stretch: Array) -> list[Array]:
        """Return the uniaxial factor per unit of each c_k over G [-], each like `stretch` [-]."""
        pairs = (
            (a.uniaxial_factor(stretch), b and b.uniaxial_factor(stretch)) for a, b in self.units
        )
        return [one if other is None else one - other for one, other in pairs]


LAWS = {
    "neo_hookean": Law((0.0,), ((NeoHookean(), None),), lambda g: NeoHookean()),
    "mooney_rivlin": Law(
        (0.0, 0.0),
        ((MooneyRivlin(0.0), None), (MooneyRivlin(1.0), None)),
        lambda a, b: MooneyRivlin(b / (a + b)),
    ),
    "yeoh": Law(
        (0.0, -np.inf, 0.0),
        ((NeoHookean(), None), (Yeoh(1.0, 0.0), NeoHookean()), (Yeoh(0.0, 1.0), NeoHookean())),
        lambda g, second, third: Yeoh(second / g, third / g),
    ),
}
ENERGIES = {
    "neo-Hookean": "neo_hookean",
    "Mooney-Rivlin": "mooney_rivlin",
    "Yeoh": "yeoh",
}


@dataclass(frozen=True)
class UniaxialTest:
    """A history of stretch with its nominal stress."""

    name: str
    time: Array  # [s], rising
    stretch: Array  # deformed over undeformed length [-]
    stress: Array  # nominal [Pa]

    @property
    def peak(self) -> float:
        """Largest nominal stress [Pa]."""
        return float(self.stress.max())

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])


def read_test(path: Path, name: str) -> UniaxialTest:
    """Read time [s], stretch and nominal stress [kPa] from the first three columns of a sheet."""
    sheet = load_workbook(path, data_only=True).worksheets[0]
    table = np.array([row[:3] for row in sheet.iter_rows(values_only=True)], dtype=float)
    return UniaxialTest(name, table[:, 0], table[:, 1], 1e3 * table[:, 2])


def read_tests() -> list[UniaxialTest]:
    """Return the four measured loops, slowest and smallest first."""
    return [read_test(DATA / file, name) for file, name in FILES.items()]


@dataclass(frozen=True)
class FiniteStrainFit:
    """The rubber found, and how well it carries each test."""

    rubber: Rubber  # without elements whose fitted modulus is zero
    tests: tuple[UniaxialTest, ...]

    @property
    def rms_errors(self) -> Array:
        """Root mean square error of the stress over the peak stress [-], shape (tests,)."""
        return np.array([rms_error(self.rubber, test) for test in self.tests])

    @property
    def work_errors(self) -> Array:
        """Predicted over measured work lost in the loop, less one [-], shape (tests,)."""
        return np.array([work_error(self.rubber, test) for test in self.tests])


def rms_error(rubber: Rubber, test: UniaxialTest) -> float:
    """Return the root mean square error of the predicted stress over the measured peak [-]."""
    error = uniaxial_stress(rubber, test.time, test.stretch) - test.stress
    return float(np.sqrt(np.mean(error**2)) / test.peak)


def work_error(rubber: Rubber, test: UniaxialTest) -> float:
    """Return the predicted over the measured work int P ds of the test, less one [-].

    For a loop that ends free of stress this is the work lost, as heat or in networks still
    stretched. Trapezoidal rule on the samples, the same for both.
    """
    predicted = uniaxial_stress(rubber, test.time, test.stretch)
    return float(trapezoid(predicted, test.stretch) / trapezoid(test.stress, test.stretch)) - 1


# The fitted G_inf is at least this share of the smallest peak stress: a rubber must have one.
LEAST_EQUILIBRIUM = 1e-3
FASTEST = 0.01  # shortest fitted relaxation time, as a share of the shortest test


def fit_finite_strain(
    tests: Sequence[UniaxialTest],
    *,
    energy: str = "neo_hookean",
    terms: int = 6,
    band: tuple[float, float] | None = None,
) -> FiniteStrainFit:
    """Fit one rubber to all tests together, each by its error relative to its own peak stress.

    The relaxation times of the `terms` temporary networks are evenly spaced in their logarithm over
    `band` [s], by default from a hundredth of the shortest test to the longest: beyond it nothing
    tells a slow network from a permanent one.
    """
    law = LAWS[energy]
    durations = [test.duration for test in tests]
    low, high = (FASTEST * min(durations), max(durations)) if band is None else band
    times = np.geomspace(low, high, terms) if terms > 1 else np.array([np.sqrt(low * high)])
    # Nominal stress per unit of each coefficient; the squares of a test sum to its rms_error^2.
    columns, measured = [], []
    for test in tests:
        stretch, weight = test.stretch, 1.0 / (test.peak * np.sqrt(len(test.time)))
        networks = uniaxial_network_stresses(times, test.time, stretch)
        permanent = [(stretch - stretch**-2) * factor for factor in law.basis(stretch)]
        columns.append(np.column_stack([*permanent, networks]) * weight)
        measured.append(test.stress * weight)
    matrix = np.vstack(columns)
    lower = np.zeros(matrix.shape[1])
    lower[: len(law.least)] = law.least
    lower[0] = LEAST_EQUILIBRIUM * min(test.peak for test in tests)
    scale = np.linalg.norm(matrix, axis=0)
    bounds = (lower * scale, np.full(len(scale), np.inf))
    fit = lsq_linear(matrix / scale, np.concatenate(measured), bounds, method="bvls", tol=1e-14)
    coefficients = np.asarray(fit.x / scale, dtype=float)
    count = len(coefficients) - len(times)
    found, moduli = coefficients[:count].tolist(), coefficients[count:]
    # of Mooney and Rivlin's law G is the sum of both
    shear = sum(found) if energy == "mooney_rivlin" else found[0]
    used = moduli > 1e-9 * (shear + moduli.sum())
    rubber = Rubber(3.0 * shear, 3.0 * moduli[used], times[used], strain_energy=law.made(*found))
    return FiniteStrainFit(rubber, tuple(tests))


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
