"""Samples that many tests share: rubbers, sine waves, loads, surfaces and rubbers as files, cases.

What only one file of tests uses stands there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import Result

from gripscale import Profile, Rubber, SineStack
from gripscale.conditions import ThermalProperties
from gripscale.core.status import Status
from gripscale.model import Load
from gripscale.rubber import WLF
from gripscale.rubber.softening import Kraus
from gripscale.surface import self_affine_profile
from gripscale.wave import FiniteStrainBlock, ScaleResult, WaveProblem

ROOT = Path(__file__).parents[1]
DOCS, EXAMPLES = ROOT / "docs", ROOT / "examples"
MEASURED_DMA = EXAMPLES / "data" / "rubber" / "measured_dma.txt"
"""The master curve of a filled tread rubber, as measured."""

Shell = Callable[..., Result]
"""Type of the fixture `shell`."""

MAXWELL = Rubber(6e6, [2e6, 3e6, 5e6], [1e-1, 1e-3, 1e-5])
"""Three relaxations, all within the frequencies of `write_maxwell`."""
ZENER = Rubber(1e6, [9e6], [1e-3])
"""One relaxation by a factor of ten."""
FAST_RUBBER = Rubber(3e6, [6e6, 9e6], [2e-5, 2e-4], bulk_modulus=1e9)
"""Relaxes while a wave of 1 mm passes at some metres per second."""
POWER_LAW_TIMES = np.geomspace(1e-8, 1e2, 41)
POWER_LAW = Rubber(6e6, 1e6 * (POWER_LAW_TIMES / 1e-2) ** -0.3, POWER_LAW_TIMES)
"""A broad spectrum, as of a filled rubber."""
SHIFTED_RUBBER = Rubber(
    5e6,
    np.geomspace(3e6, 3e8, 10),
    np.geomspace(1e-1, 1e-9, 10),
    reference_temperature=293.15,
    shift=WLF(c1=8.86, c2=101.6),
)
"""Ten relaxations and a shift, for conditions; with `SHIFTED_SINES` and `SHIFTED_LOAD`."""
SHIFTED_SINES = SineStack([4e-3, 1e-3], [2e-4, 6e-5])
SHIFTED_VALUES = {"pressure": 3e5, "speed": 1.0, "footprint": 0.05}
SHIFTED_LOAD = Load(**SHIFTED_VALUES)
THERMAL = ThermalProperties(conductivity=0.25, density=1150.0, specific_heat=1500.0)
KRAUS = Kraus(0.3, 0.15, 0.02, 1e-3, "shear")

THREE_SINES = SineStack(wavelength=[16e-3, 4e-3, 1e-3], amplitude=[1e-3, 0.5e-3, 0.125e-3])
GENTLE_SINES = SineStack([10e-3, 4e-3], [2e-4, 5e-5])
"""Slopes at which finite strain and small strain agree."""

STYRENE_BUTADIENE = 'name = "styrene_butadiene"'
COARSE_BLOCK = "columns = 32\nrows = 8"
"""Solver of a wave in a fraction of a second."""
HALF_PLANE = 'model = "half_plane"\npoints = 64'
"""Solver of a wave in milliseconds."""
TWO_WAVES = """\
[[surface.sines]]
wavelength = "10 mm"
amplitude = "0.8 mm"
[[surface.sines]]
wavelength = "3 mm"
amplitude = "0.25 mm"
"""
SOFTENING = """\
[conditions.softening]
kind = "kraus"
storage_ratio = 0.3
loss_ratio = 0.2
critical_strain = "2 %"
measured_at = "0.1 %"
deformation = "shear"
"""
THREE_WAVES = f"""\
{TWO_WAVES}[[surface.sines]]
wavelength = "1 mm"
amplitude = "0.08 mm"
"""


def case_text(surface: str, rubber: str = STYRENE_BUTADIENE, solver: str = COARSE_BLOCK) -> str:
    """Return the text of a case at 3 bar and 0.3 m/s with the keys of three of its tables.

    A measured rubber is unfilled: its moduli do not fall with the strain.
    """
    rubber = f"filled = false\n{rubber}" if "file = " in rubber else rubber
    return (
        f"[surface]\n{surface}\n\n[rubber]\n{rubber}\n\n"
        '[load]\npressure = "3 bar"\nspeed = "0.3 m/s"\nfootprint = "100 mm"\n'
        f"\n[solver]\n{solver}\n"
    )


def fail_waves(
    monkeypatch: pytest.MonkeyPatch, status: Status, fails: Callable[[WaveProblem], bool]
) -> None:
    """Let the block end with `status` on the waves that `fails` names, after it has solved them."""
    solve = FiniteStrainBlock.solve

    def failing(
        self: FiniteStrainBlock, problem: WaveProblem, start: ScaleResult | None = None
    ) -> ScaleResult:
        result = solve(self, problem, start)
        return replace(result, status=status) if fails(problem) else result

    monkeypatch.setattr(FiniteStrainBlock, "solve", failing)


PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c489"
    "0000000d49444154789c6360606060000000050001a5f645400000000049454e44ae426082"
)
"""One transparent pixel, in place of each figure."""


@contextmanager
def blank_figures() -> Iterator[None]:
    """Compose figures without rendering them, which takes a fifth of the time of a command."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gripscale.charts.paper.figure_file", lambda *_, **__: PNG)
        yield


def write_short_road(folder: Path) -> None:
    """Write a self-affine road.txt of 0.1 m and a dma.txt of two relaxations."""
    road = self_affine_profile(0.8, 3e-3, 8e-4, length=0.1, step=1e-4, seed=1)
    write_road(folder / "road.txt", road)
    frequency = np.geomspace(1e-1, 1e5, 30)
    modulus = Rubber(6e6, [3e6, 5e6], [1e-1, 1e-4]).complex_modulus(2 * np.pi * frequency)
    write_master_curve(folder / "dma.txt", frequency, modulus)


def write_road(path: Path, road: Profile) -> None:
    """Write a profile in mm, to a nanometre."""
    rows = [f"{x * 1e3:.6f}\t{z * 1e3:.6f}" for x, z in zip(road.x, road.z, strict=True)]
    _write(path, "x [mm]\tz [mm]", rows)


def write_master_curve(
    path: Path, frequency: NDArray[np.float64], modulus: NDArray[np.complex128]
) -> None:
    """Write complex moduli [Pa] over frequency [Hz], in MPa."""
    pairs = zip(frequency, modulus / 1e6, strict=True)
    rows = [f"{f:.5e} {e.real:.6e} {e.imag:.6e}" for f, e in pairs]
    _write(path, "# Frequency (Hz) E' (MPa) E'' (MPa)", rows)


def sine_profile(stack: SineStack, length: float, step: float, seed: int) -> Profile:
    """Return a profile of superposed sine waves, each with a random phase."""
    x = step * np.arange(round(length / step) + 1)
    phases = np.random.default_rng(seed).random(len(stack))
    waves = zip(stack.wavelength, stack.amplitude, phases, strict=True)
    return Profile(x, sum(a * np.cos(2.0 * np.pi * (x / w + phase)) for w, a, phase in waves))


def three_waves(phase: float = 0.0) -> Profile:
    """Return a road of three waves, 0.4 m long; `phase` is that of the longest."""
    x = np.arange(4000) * 0.1  # mm
    z = 2.0 * np.cos(x / 3.0 + phase) + 0.7 * np.cos(x + 1.0) + 0.2 * np.cos(3.1 * x + 2.0)
    return Profile(1e-3 * x, 1e-3 * z)


def write_maxwell(path: Path) -> None:
    """Write the moduli of `MAXWELL` over eight decades of frequency."""
    frequency = np.geomspace(1e-2, 1e6, 60)
    write_master_curve(path, frequency, MAXWELL.complex_modulus(2 * np.pi * frequency))


def _write(path: Path, title: str, rows: list[str]) -> None:
    path.write_text("\n".join([title, *rows]) + "\n", encoding="utf-8")
