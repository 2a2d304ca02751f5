"""`gripscale fit-surface`, `gripscale fit-rubber` and `--version`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gripscale.core.provenance import versions
from gripscale.surface import text_files
from tests.samples import Shell


def test_surface_half_prints_the_waves(shell: Shell, inputs: Path, tmp_path: Path) -> None:
    target = tmp_path / "figures"
    options = ["--scales", 3, "--s-wavelength", 3, "--crop", "10 mm", "390 mm", "--output", target]
    result = shell("fit-surface", inputs / "road.txt", *options)
    assert result.exit_code == 0, result.output
    table = result.stdout[result.stdout.index("The sine waves") :].splitlines()[4:7]
    lengths = [float(line.split()[1]) for line in table]
    assert lengths[0] / lengths[1] == pytest.approx(3.0, rel=2e-3)
    assert lengths[1] / lengths[2] == pytest.approx(3.0, rel=2e-3)
    assert "stacks tried follow it as well:" in " ".join(result.stdout.split())
    texture = result.stdout[result.stdout.index("Texture: ISO 13473-1") :]
    assert texture.index("MPD") < texture.index("profile 1")
    assert {p.name for p in target.iterdir()} == {
        f"{name}.{kind}"
        for name in ("profile", "correlation", "texture_levels")
        for kind in ("png", "pdf")
    }


def test_surface_half_reads_a_lone_file_once(
    shell: Shell, inputs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reads = []
    read_lines = text_files.read_lines

    def counted(path: Path, **options: Any) -> Any:
        reads.append(path)
        return read_lines(path, **options)

    monkeypatch.setattr(text_files, "read_lines", counted)
    result = shell("fit-surface", inputs / "road.txt", "--scales", 2, "--crop", "10 mm", "390 mm")
    assert result.exit_code == 0, result.output
    assert reads == [inputs / "road.txt"]


def test_surface_half_takes_units_that_no_file_states(shell: Shell, tmp_path: Path) -> None:
    heights = np.random.default_rng(1).normal(size=(20, 20))
    line, table = tmp_path / "line.txt", tmp_path / "table.txt"
    line.write_text("\n".join(f"{n} {z:.4f}" for n, z in enumerate(heights.flat)))
    np.savetxt(table, heights, "%.4f")
    unit = ["--z-unit", "um"]
    for file, options in ((line, ["--x-unit", "um"]), (table, ["--step", "1 um, 2 um"])):
        refused = shell("fit-surface", file, *options)
        assert refused.exit_code == 2
        assert "give --z-unit; see `gripscale keys surface`" in refused.output
        result = shell("fit-surface", file, *options, *unit, "--scales", 2)
        assert result.exit_code == 0, result.output


def test_surface_half_names_its_own_option_for_a_column_of_heights(
    shell: Shell, tmp_path: Path
) -> None:
    path = tmp_path / "heights.txt"
    np.savetxt(path, np.random.default_rng(1).normal(size=400), "%.4f")
    refused = shell("fit-surface", path, "--step", "0.05 mm")
    assert "title, such as 'z [mm]', or give --z-unit;" in refused.output
    assert "give --step," in shell("fit-surface", path).output


def test_surface_half_doubts_depths_first_and_turns_them_over(
    shell: Shell, inputs: Path, tmp_path: Path
) -> None:
    road = tmp_path / "depths.txt"
    road.write_text((inputs / "road.txt").read_text().replace("z [mm]", "depth [mm]"))
    options = ["--scales", 2, "--crop", "10 mm", "390 mm"]
    doubted = " ".join(shell("fit-surface", road, *options).stdout.split())
    assert doubted.startswith("doubt: depths: column 2, titled 'depth', is taken as height, up:")
    assert "--z-axis down turns it over" in doubted
    stated = shell("fit-surface", road, *options, "--z-axis", "down")
    assert stated.exit_code == 0, stated.output
    assert "doubt:" not in stated.stdout


def test_surface_half_to_a_cut_off_of_the_upper_part(shell: Shell, inputs: Path) -> None:
    options = ["--scales", 4, "--crop", "10 mm", "390 mm", "--top-height-fraction", 0.5]
    result = shell("fit-surface", inputs / "road.txt", *options, "--cut-off", "4 mm")
    assert result.exit_code == 0, result.output
    words = " ".join(result.stdout.split())
    assert "correlation of the upper 50 % of the heights only" in words
    assert "for roughness down to 4 mm" in words
    both = shell("fit-surface", inputs / "road.txt", *options[:2], "--cut-off", "4 mm",
                 "--smallest-wavelength", "4 mm")  # fmt: skip
    assert both.exit_code == 2
    assert "either smallest_wavelength (the last wave) or cut_off" in " ".join(both.stderr.split())


def test_surface_half_says_where_the_waves_end(shell: Shell, inputs: Path) -> None:
    road, crop = inputs / "road.txt", ["--crop", "10 mm", "390 mm"]

    def notes(*options: object) -> str:
        result = shell("fit-surface", road, *crop, *options)
        assert result.exit_code == 0, result.output
        return " ".join(result.stdout.split())

    assert "note: no smallest wavelength is stated" in notes("--scales", 2)
    below = notes("--scales", 2, "--smallest-wavelength", "0.05 mm")
    assert "note: The smallest wave, 0.05 mm, is shorter than the measurement resolves" in below
    measured = notes("--scales", 2, "--smallest-wavelength", "1 mm")
    assert "note: Profiles in one direction do not show ridges" in measured
    assert measured.count("note:") == 1


def test_rubber_half_prints_the_series(shell: Shell, inputs: Path) -> None:
    result = shell("fit-rubber", inputs / "dma.txt", "--terms", 9, "--bulk-modulus", "1 GPa")
    assert result.exit_code == 0, result.output
    assert "bulk modulus 1000 MPa" in result.stdout
    table = result.stdout[result.stdout.index("Maxwell elements of") :].splitlines()[4:]
    total = sum(float(line.split()[2]) for line in table)
    assert total == pytest.approx(10.0, rel=0.1)  # the elements the curve was made of [MPa]
    assert not list(inputs.glob("*.png"))


def test_rubber_half_draws_strain_sweeps(shell: Shell, inputs: Path, tmp_path: Path) -> None:
    strain, target = np.geomspace(0.01, 20.0, 12), tmp_path / "out"
    rows = [
        f"{celsius},{s:.6g},{2 + 6 / (1 + s / c):.6g},{1 / (1 + s / c):.6g}"
        for celsius, c in ((20.0, 1.0), (60.0, 3.0))
        for s in strain
    ]
    sweeps = tmp_path / "payne.csv"
    sweeps.write_text("\n".join(["temperature [C],strain [%],E' [MPa],E'' [MPa]", *rows]))
    asked = shell("fit-rubber", sweeps)
    assert asked.exit_code == 2
    assert "--amplitude must be given" in " ".join(asked.output.split())
    options = ["--amplitude", "single", "--measured-at", "0.2 %", "--output", target]
    result = shell("fit-rubber", sweeps, inputs / "dma.txt", *options)
    assert result.exit_code == 0, result.output
    assert "Maxwell elements of" in result.stdout
    table = result.stdout[result.stdout.index("Moduli over those") :]
    kept = [[float(cell) for cell in line.split()] for line in table.splitlines()[4:6]]
    for (celsius, *factors), c in zip(kept, (1.0, 3.0), strict=True):
        law = [2 + 6 / (1 + s / c) for s in (0.2, 1.0, 10.0)]
        assert celsius == (20.0 if c == 1.0 else 60.0)
        # rows a quarter of a decade apart, three digits printed
        assert factors[:2] == pytest.approx([law[1] / law[0], law[2] / law[0]], rel=0.02)
    assert "half-way between tension and shear" in " ".join(table.split())
    assert "measured at" not in table
    names = {path.name for path in target.iterdir()}
    assert {"softening.png", "master_curve.png"} <= names


def test_rubber_half_prints_what_the_data_leave_open(shell: Shell, inputs: Path) -> None:
    result = shell("fit-rubber", inputs / "dma.txt")
    rows = result.stdout[result.stdout.index("Moduli, and what") :].splitlines()[4:9]
    numbers = [[float(cell) for cell in row.replace("to", " ").split()] for row in rows]
    for _, storage, low, high, loss, least, most in numbers:
        assert low <= storage * 1.001  # printed to three digits
        assert storage <= high * 1.005
        assert least <= loss * 1.005
        assert loss <= most * 1.005
    frequency = [row[0] for row in numbers]
    assert frequency[1] / frequency[0] == pytest.approx(100.0, rel=0.01)
    assert frequency[4] / frequency[3] == pytest.approx(100.0, rel=0.01)


def test_version(shell: Shell) -> None:
    result = shell("--version")
    assert result.exit_code == 0
    assert result.stdout == f"gripscale {versions()['gripscale']}\n"
