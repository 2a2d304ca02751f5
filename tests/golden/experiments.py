"""Small cases through the command line: what every command prints and writes.

The shipped road is cut short and thinned, and its meshes are coarse: the numbers pin the code, they
say nothing of a road. Figures are not drawn.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner

import gripscale as gs
from gripscale.charts.draw import Sheet
from gripscale.cli import app
from tests.samples import SOFTENING, blank_figures, write_road

EXAMPLES = Path(__file__).parents[2] / "examples"

WIDE, KEYS_WIDE = 2000, 160
"""Characters of a line: no sentence is wrapped, so that none depends on the length of a path."""

RUBBER = """
[rubber]
file = "measured_dma.txt"
reference_temperature = "20 C"
bulk_modulus = "2 GPa"
shift = { kind = "wlf", c1 = 8.0, c2 = "120 K", valid_range = ["0 C", "100 C"] }
"""

LOAD = """
[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
"""

HALF_PLANE = """
[solver]
model = "half_plane"
points = 64
"""

ROAD = f"""\
[surface]
files = ["road.txt", "lane.txt"]
scales = 4
smallest_wavelength = "1 mm"
{RUBBER}{LOAD}
[solver]
columns = 16
rows = 4

[measured]
friction = "friction.csv"

[compare]
layer_ratio = 1.3
penetration_depth = "0.5 mm"
"""
"""Everything a run says: two profiles, finite strain, measured friction."""

PLAIN = f"""\
[surface]
files = ["road.txt", "lane.txt"]
scales = 3
smallest_wavelength = "4 mm"
{RUBBER}{LOAD}{HALF_PLANE}"""
"""What many predictions are made of: half-planes."""

WARM = f"""\
[surface]
files = ["road.txt"]
scales = 3
smallest_wavelength = "2 mm"
{RUBBER}
[conditions]
temperature = "40 C"

{SOFTENING}
[conditions.heat]
conductivity = "0.25 W/(m K)"
density = "1150 kg/m^3"
specific_heat = "1500 J/(kg K)"

[conditions.shear_stress]
kind = "gaussian"
stress_0 = "1 MPa"
width = 0.1
speed_0 = "6 mm/s"
{LOAD}{HALF_PLANE}"""
"""All effects at once."""

MAP = f"""\
[surface]
map = "map.txt"
step = ["0.2 mm", "0.4 mm"]
z_unit = "mm"
scales = 3
smallest_wavelength = "1.6 mm"

[rubber]
name = "styrene_butadiene"
{LOAD}{HALF_PLANE}"""

FRICTION = "speed [m/s],friction,spread\n0.1,0.7,0.05\n1,0.8,0.05\n"

COMMANDS: dict[str, tuple[str, ...]] = {
    "run": ("run", "road.toml", "--output", "run"),
    "run_conditions": ("run", "warm.toml", "--output", "run_conditions"),
    "run_map": ("run", "map.toml", "--output", "run_map"),
    "compare": (
        "compare", "road.toml", "--output", "compare", "--seeds", "1",
        "--models", "chain,direct,theory",
    ),
    "compare_ladder": (
        "compare", "plain.toml", "--output", "compare_ladder", "--seeds", "1",
        "--models", "waves,measured,theory,windows",
    ),
    "study": (
        "study", "plain.toml", "--output", "study", "--model", "chain",
        "--vary", "speed=0.1,1", "--vary", "temperature=20 C,40 C",
    ),
    "study_direct": (
        "study", "plain.toml", "--output", "study_direct", "--vary", "pressure=2 bar,4 bar",
    ),
    "study_effects": (
        "study", "warm.toml", "--output", "study_effects", "--vary", "effects=all,no_heat,none",
        "--model", "chain",
    ),
    "uncertainty": (
        "uncertainty", "plain.toml", "--output", "uncertainty", "--samples", "16",
        "--without", "waves", "--without", "load_time",
    ),
    "calibrate": (
        "calibrate", "measured/case.toml", "--output", "calibrate", "--model", "chain",
        "--hold-out", "temperature",
    ),
    "compare_rubbers": (
        "compare-rubbers", "plain.toml", "styrene_butadiene", "--output", "compare_rubbers",
    ),
    "compare_surfaces": (
        "compare-surfaces", "road.txt", "lane.txt", "--case", "plain.toml",
        "--output", "compare_surfaces",
    ),
    "cut_off": ("cut-off", "plain.toml", "--down-to", "0.2 mm", "--output", "cut_off"),
    "sensitivity": ("sensitivity", "plain.toml", "--bands", "2", "--output", "sensitivity"),
    "sensitivity_conditions": (
        "sensitivity", "warm.toml", "--vary", "speed=0.1,1", "--bands", "1", "--contact-fraction",
        "--output", "sensitivity_conditions",
    ),
    "design": (
        "design", "plain.toml", "--levels", "0.9,1", "--rubber", "styrene_butadiene",
        "--output", "design",
    ),
    "fit_surface": (
        "fit-surface", "road.txt", "lane.txt", "--scales", "4", "--smallest-wavelength", "1 mm",
        "--slopes", "--output", "fit_surface",
    ),
    "fit_rubber": (
        "fit-rubber", "measured_dma.txt", "--reference-temperature", "20 C",
        "--output", "fit_rubber",
    ),
    "fit_rubber_sweeps": (
        "fit-rubber", "sweeps.csv", "--reference-temperature", "20 C", "--bulk-modulus", "20 GPa",
        "--output", "fit_rubber_sweeps",
    ),
    "keys": ("keys",),
}  # fmt: skip
"""The words of each command, by the name of its pin and, where it writes one, of its folder."""


@dataclass(frozen=True)
class Experiments:
    """What the commands left behind in a folder, and printed."""

    folder: Path
    printed: dict[str, str] = field(repr=False)


def run_experiments(folder: Path) -> Experiments:
    """Run all commands in `folder`, on one core: what is done first is printed first."""
    _write_inputs(folder)
    with pytest.MonkeyPatch.context() as patch, blank_figures():
        patch.chdir(folder)
        patch.setattr(Sheet, "on_paper", lambda _: None)
        patch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
        patch.setattr(os, "cpu_count", lambda: 1)
        printed = {name: _printed(words) for name, words in COMMANDS.items()}
    return Experiments(folder, printed)


def _write_inputs(folder: Path) -> None:
    for name, text in (("road", ROAD), ("plain", PLAIN), ("warm", WARM), ("map", MAP)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    (folder / "friction.csv").write_text(FRICTION, encoding="utf-8")
    for name, station in (("road", 0), ("lane", 1)):
        whole = gs.read_profile(
            EXAMPLES / f"data/road/20211011_aylesbury_dec_station_{station}.dat"
        )
        kept = slice(4000, 20000, 8)  # without the steel plate at its beginning, every 0.3 mm
        write_road(folder / f"{name}.txt", gs.Profile(whole.x[kept], whole.z[kept]))
    np.savetxt(folder / "map.txt", _heights(), fmt="%.6f")
    data = EXAMPLES / "data/rubber"
    for source, name in (
        (data / "measured_dma.txt", "measured_dma.txt"),
        (data / "multi_temperature_polymer/freq_user_raw.csv", "sweeps.csv"),
        (EXAMPLES / "measured_friction/case.toml", "measured/case.toml"),
        (EXAMPLES / "measured_friction/synthetic_friction.csv", "measured/synthetic_friction.csv"),
    ):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(source.read_bytes())


def _heights() -> NDArray[np.float64]:
    """Return a map of 32 by 64 heights [mm]: waves of falling amplitude in all directions."""
    random = np.random.default_rng(0)
    y, x = np.meshgrid(0.4 * np.arange(32), 0.2 * np.arange(64), indexing="ij")
    heights = np.zeros_like(x)
    for wavelength in np.geomspace(12.0, 0.8, 40):
        angle, phase = random.uniform(0.0, 2.0 * np.pi, 2)
        along = np.cos(angle) * x + np.sin(angle) * y
        heights += 0.01 * wavelength * np.cos(2.0 * np.pi * along / wavelength + phase)
    return heights


def _printed(words: tuple[str, ...]) -> str:
    """Return what a command prints, and its exit code."""
    columns = KEYS_WIDE if words[0] == "keys" else WIDE
    environment = {"COLUMNS": str(columns), "NO_COLOR": "1", "TERM": "dumb"}
    result = CliRunner().invoke(app, list(words), env=environment)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return f"{result.output.rstrip()}\n\nexit code {result.exit_code}\n"
