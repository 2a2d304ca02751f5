"""`gripscale fit-rubber` with sweeps at several temperatures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gripscale.rubber import WLF, Rubber, read_master_curve, read_shift_table, springpot_modulus
from tests.samples import Shell

ROOM = 293.15
TRUE = WLF(8.86, 101.6, ROOM)


@pytest.fixture(scope="module")
def sweeps(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six sweeps of an unfilled rubber with one per cent of scatter."""
    generator, lines = np.random.default_rng(3), ["T (C);f (Hz);E' (MPa);E'' (MPa)"]
    for celsius in (-12.0, -4.0, 4.0, 12.0, 20.0, 28.0):
        hertz = np.geomspace(0.1, 30.0, 8)
        shifted = 2 * np.pi * hertz * TRUE.a(celsius + 273.15, ROOM)
        for f, value in zip(hertz, springpot_modulus(shifted) / 1e6, strict=True):
            storage, loss = np.exp(0.01 * generator.standard_normal(2)) * [value.real, value.imag]
            lines.append(f"{celsius + 0.1};{f:.5g};{storage:.6g};{loss:.6g}")
    path = tmp_path_factory.mktemp("dma") / "sweeps.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_sweeps_become_a_rubber_and_files(shell: Shell, sweeps: Path, tmp_path: Path) -> None:
    target = tmp_path / "out"
    result = shell("fit-rubber", sweeps, "--reference-temperature", "20 C", "--output", target)
    assert result.exit_code == 0, result.output
    words = " ".join(result.stdout.split())
    assert "6 sweeps from -11.9 to 28.1 °C" in words
    assert "shift found from the sweeps" in words
    assert "wlf: c1 =" in words
    table = read_shift_table(target / "shift_table.csv")
    assert table.log_a(265.0, ROOM) == pytest.approx(float(TRUE.log_a(265.0, ROOM)), abs=0.05)
    rubber = Rubber.from_dict(json.loads((target / "rubber.json").read_text(encoding="utf-8")))
    assert rubber.reference_temperature == ROOM
    assert rubber.at(273.15).relaxation_times[0] > rubber.relaxation_times[0]
    assert len(read_master_curve(target / "master_curve.csv")) == 48
    assert {path.stem for path in target.glob("*.png")} == {
        "master_curve",
        "superposition",
        "superposition_tests",
        "shift",
    }


def test_a_table_edited_by_hand_is_honoured(shell: Shell, sweeps: Path, tmp_path: Path) -> None:
    table = tmp_path / "mine.csv"
    celsius = (-12.0, -4.0, 4.0, 12.0, 20.0, 28.0)
    table.write_text(
        "\n".join(["T (C),log_aT", *(f"{c},{(20 - c) / 8}" for c in celsius)]), encoding="utf-8"
    )
    options = ["--reference-temperature", "20 C", "--output", tmp_path / "out"]
    result = shell("fit-rubber", sweeps, "--shift", table, *options)
    assert result.exit_code == 0, result.output
    assert "shift as given" in result.stdout
    master = read_master_curve(tmp_path / "out" / "master_curve.csv")
    assert master.frequency[-1] == pytest.approx(30.0 * 1e4)


def test_one_sweep_is_a_master_curve_at_its_temperature(shell: Shell, tmp_path: Path) -> None:
    omega = np.geomspace(1e-2, 1e4, 30)
    modulus = Rubber(1e6, [2e6, 5e6], [1e-1, 1e-3]).complex_modulus(omega) / 3.0
    rows = [f" {w:.5E} {g.real:.5E} {g.imag:.5E}" for w, g in zip(omega, modulus, strict=True)]
    path = tmp_path / "PI.tts"
    path.write_text("\n".join(["T=-35;Mw=13.5;chem=PI;", *rows]), encoding="utf-8")
    result = shell("fit-rubber", path, "--output", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert "one sweep at -35.0 °C" in result.stdout
    stated = json.loads((tmp_path / "out" / "rubber.json").read_text(encoding="utf-8"))
    assert stated["reference_temperature"] == pytest.approx(238.15)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "master_curve.csv",
        "master_curve.pdf",
        "master_curve.png",
        "rubber.json",
    }


def test_what_sweeps_need_and_a_master_curve_does_not(
    shell: Shell, sweeps: Path, inputs: Path
) -> None:
    result = shell("fit-rubber", sweeps)
    assert result.exit_code == 2
    assert "--reference-temperature must be given" in " ".join(result.stderr.split())
    result = shell("fit-rubber", inputs / "dma.txt", "--vertical")
    assert result.exit_code == 2
    assert "for sweeps at several temperatures; got a master curve" in " ".join(
        result.stderr.split()
    )
    cold = shell("fit-rubber", sweeps, "--reference-temperature", "80 C")
    assert cold.exit_code == 2
    assert "must lie within the temperatures measured" in " ".join(cold.stderr.split())
