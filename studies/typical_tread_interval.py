"""Whether the interval of a filled rubber without strain sweeps holds what its sweeps would give.

    python -m studies.typical_tread_interval

prints friction and contact area of the shipped road (3 bar, 0.3 m/s, 20 C, to 0.1 mm): the tread
without sweeps, unfilled, as a typical tread and with the sweeps of three other treads; then those
three treads with their sweeps withheld and with them. Six minutes of one core.
"""

from __future__ import annotations

import dataclasses

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.rubber import read_shift_table
from gripscale.rubber.softening import SofteningTable, softening_of_sweeps
from gripscale.rubber.strain_sweeps import read_strain_sweeps
from studies.shipped import DATA, road, tread

TREADS = DATA / "friction"
COMPOUNDS = ("S100", "S120", "S140")
AT_20_C = Conditions(temperature=293.15)


def measured_softening(compound: str) -> SofteningTable:
    """Return the softening of a tread by its strain sweeps."""
    sweeps = read_strain_sweeps(TREADS / f"{compound}_strain_sweeps.csv")
    return softening_of_sweeps(sweeps, measured_at=1e-3)


def measured_tread(compound: str) -> gs.Rubber:
    """Return a tread with its shift."""
    curve = TREADS / f"{compound}_master_curve.csv"
    rubber = gs.fit_prony(gs.read_master_curve(curve, reference_temperature=313.15))
    return dataclasses.replace(rubber, shift=read_shift_table(TREADS / f"{compound}_shift.csv"))


def row(title: str, case: gs.Case, interval: gs.Answer | None = None) -> gs.Answer:
    """Print an answer, and whether `interval` holds it; return it."""
    answer = gs.answer(case)
    friction, area = answer.friction, answer.contact_fraction
    text = f"{title:30} μ {friction:.3f} ({{:.3f}} to {{:.3f}})".format(*answer.friction_interval)
    text += f"  area {area:.4f} ({{:.4f}} to {{:.4f}})".format(*answer.contact_fraction_interval)
    if interval is not None:
        ends = interval.friction_interval, interval.contact_fraction_interval
        held = [
            low <= value <= high for value, (low, high) in zip((friction, area), ends, strict=True)
        ]
        text += "  held" if all(held) else "  not held"
    print(text, flush=True)
    return answer


def main() -> None:
    """Print both tables."""
    profiles = [road(0), road(1)]
    case = gs.Case(
        profiles, tread(), filled=True, pressure="3 bar", speed=0.3, smallest_wavelength="0.1 mm"
    )
    row("tread, unfilled", case.replace(filled=False))
    typical = row("tread, as a typical tread", case)
    for compound in COMPOUNDS:
        conditions = Conditions(softening=measured_softening(compound))
        row(f"tread, sweeps of {compound}", case.replace(conditions=conditions), typical)
    for compound in COMPOUNDS:
        measured = case.replace(rubber=measured_tread(compound), conditions=AT_20_C)
        typical = row(f"{compound}, sweeps withheld", measured)
        conditions = dataclasses.replace(AT_20_C, softening=measured_softening(compound))
        row(f"{compound}, with its sweeps", measured.replace(conditions=conditions), typical)


if __name__ == "__main__":
    main()
