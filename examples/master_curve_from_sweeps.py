"""From frequency sweeps at several temperatures to a master curve and a rubber at any temperature.

The sweeps are those of a stiff polymer, because they are free and shift factors were published with
them: E' superposes, E'' of the glass does not, and the report says so. The last rows of every sweep
are lossier at all temperatures alike, which is the instrument and no material; the rubber is fitted
without them.

Run as `python examples/master_curve_from_sweeps.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import gripscale as gs
from gripscale.charts import save_figure
from gripscale.questions import shift_figure, superposition_figure, superposition_tests_figure
from gripscale.rubber import fit_arrhenius, fit_wlf, read_shift_table, superpose_report

DATA = Path(__file__).parent / "data" / "rubber" / "multi_temperature_polymer"
REFERENCE = 268.15
HOTTEST, COLDEST = 373.0, 224.0
HIGHEST = 30.0  # Hz


def main(folder: str = "results/examples") -> None:
    """Superpose, compare with what was published, fit, and take the rubber to 40 °C."""
    sweeps = gs.read_sweeps(DATA / "freq_user_raw.csv")
    print(sweeps.summary())
    master, report = superpose_report(sweeps, reference_temperature=REFERENCE)
    print(report.summary())

    published = read_shift_table(DATA / "published_shift_factors.csv")
    _, theirs = superpose_report(sweeps, reference_temperature=REFERENCE, shift=published)
    for kelvin in (HOTTEST, COLDEST):
        own, other = (float(one.log_a(kelvin, REFERENCE)) for one in (master.shift, published))
        print(f"log10 a_T at {kelvin - 273.15:.0f} °C: {own:.2f}, published {other:.2f}")
    for whose, one in (("these", report), ("published", theirs)):
        worst = max(pair.storage for pair in one.overlaps)
        print(f"E' of neighbours apart by up to {worst:.4f} decades, {whose} shift factors")

    laws = [
        fit_wlf(master.shift, lowest=313.0, reference_temperature=333.15),
        fit_arrhenius(master.shift, lowest=268.0, highest=306.0),
    ]
    print("\n".join(law.summary() for law in laws))

    believed = sweeps.between(0.1, HIGHEST)
    curve = gs.superpose(believed, reference_temperature=REFERENCE, shift=master.shift)
    rubber, fit = gs.rubber.fit_prony_report(curve, bulk_modulus=10e9)
    print(fit.summary())
    warm = rubber.at(313.15)
    for one in (rubber, warm):
        modulus = one.complex_modulus(6.283)
        celsius = one.reference_temperature - 273.15
        storage, loss = modulus.real / 1e6, modulus.imag / 1e6
        print(f"E' {storage:.0f} MPa, E'' {loss:.0f} MPa at {celsius:.0f} °C")

    figures = {
        "shifted": superposition_figure(sweeps, master),
        "shift": shift_figure(master.shift, laws),
        "tests": superposition_tests_figure(sweeps, report),
    }
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        save_figure(figure, Path(folder), f"{Path(__file__).stem}_{name}")


if __name__ == "__main__":
    main(*sys.argv[1:])
