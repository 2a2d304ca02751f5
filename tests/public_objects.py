"""Small objects and files that the examples of docstrings name, each made in a moment."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.experiment import MeasuredFriction
from gripscale.rubber import WLF, Sweeps, write_master_curve
from gripscale.surface import self_affine_profile
from tests.samples import write_road

TEMPERATURES = np.array([263.15, 278.15, 293.15, 308.15])
FREQUENCIES = np.geomspace(0.1, 100.0, 13)


def tread() -> gs.Rubber:
    """Return a rubber with twelve relaxation times and a shift."""
    times = np.geomspace(1e-9, 1e2, 12)
    return gs.Rubber(
        5e6,
        4e6 * (times / 1e-2) ** -0.25,
        times,
        name="tread",
        reference_temperature=293.15,
        shift=WLF(c1=8.86, c2=101.6),
    )


def sweeps_of(rubber: gs.Rubber) -> Sweeps:
    """Return frequency sweeps of a rubber at four temperatures."""
    kelvin, hertz = (a.ravel() for a in np.meshgrid(TEMPERATURES, FREQUENCIES, indexing="ij"))
    moduli = [
        complex(rubber.at(float(k)).complex_modulus(2.0 * np.pi * f))
        for k, f in zip(kelvin, hertz, strict=True)
    ]
    return Sweeps(kelvin, hertz, np.real(moduli), np.imag(moduli), name="tread")


def master_of(rubber: gs.Rubber) -> gs.MasterCurve:
    """Return the master curve of a rubber over ten decades."""
    hertz = np.geomspace(1e-2, 1e8, 61)
    modulus = rubber.complex_modulus(2.0 * np.pi * hertz)
    return gs.MasterCurve(hertz, modulus.real, modulus.imag, 293.15, "tread")


def public_objects() -> dict[str, Any]:
    """Return the names that examples use, with what they stand for."""
    rubber = tread()
    road, other_road = (
        self_affine_profile(0.8, 3e-3, 4e-4, length=0.2, step=1e-4, seed=seed) for seed in (1, 2)
    )
    x = np.arange(64) * 2e-4
    waves = np.cos(2.0 * np.pi * x / 6.4e-3)
    case = gs.Case(
        [road, other_road],
        rubber,
        filled=False,
        pressure="3 bar",
        speed=0.3,
        smallest_wavelength="2 mm",
        conditions=Conditions(heat="none"),  # what an example shows is quick
    )
    return {
        "gs": gs,
        "np": np,
        "rubber": rubber,
        "master": master_of(rubber),
        "sweeps": sweeps_of(rubber),
        "road": road,
        "other_road": other_road,
        "sampled": gs.Profile(x, 1e-4 * waves, name="sine"),
        "height_map": gs.HeightMap(x, x, 1e-4 * np.outer(waves, waves), name="texture"),
        "sines": gs.SineStack(["8 mm", "2 mm"], ["0.5 mm", "0.1 mm"]),
        "case": case,
        "contact": gs.solve_rough_contact(
            rubber, road, pressure=3e5, speed=0.3, smallest_wavelength=2e-3, tolerance=None
        ),
        "chain": gs.solve_chain(
            rubber,
            gs.SineStack([8e-3, 2e-3], [5e-4, 1e-4]),
            pressure=3e5,
            speed=0.3,
            footprint=0.1,
            solver="half_plane",
        ),
        "measured": MeasuredFriction([0.01, 0.1, 1.0], [0.5, 0.7, 0.9]),
    }


def write_files(folder: Path, objects: dict[str, Any]) -> None:
    """Write the files that examples read: surfaces, moduli, measured friction and a case."""
    np.savetxt(folder / "map.txt", objects["height_map"].z.T * 1e3, "%.6f")
    write_road(folder / "road.txt", objects["road"])
    write_master_curve(folder / "dma.txt", objects["master"])
    sweeps = objects["sweeps"]
    columns = sweeps.temperature - 273.15, sweeps.frequency, sweeps.storage / 1e6, sweeps.loss / 1e6
    titles = "temperature (C),frequency (Hz),storage modulus E' (MPa),loss modulus E'' (MPa)"
    rows = [",".join(f"{value:.8g}" for value in row) for row in zip(*columns, strict=True)]
    (folder / "sweeps.csv").write_text("\n".join([titles, *rows, ""]), encoding="utf-8")
    friction = "speed (m/s),friction\n0.01,0.5\n0.1,0.7\n1.0,0.9\n"
    (folder / "friction.csv").write_text(friction, encoding="utf-8")
    spectrum = "q (1/m),C (m^4)\n1e3,1e-14\n1e4,2e-18\n1e5,5e-22\n"
    (folder / "psd.csv").write_text(spectrum, encoding="utf-8")
    objects["case"].save(folder / "case.toml")
