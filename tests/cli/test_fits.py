"""`gripscale fit-surface` and `gripscale fit-rubber`, with one sweep or several temperatures."""

import json
import tomllib

import numpy as np
import pytest

from gripscale.rubber import WLF, Rubber, read_master_curve, read_shift_table, springpot_modulus


def test_surface_half_prints_the_waves(shell, inputs, tmp_path):
    target = tmp_path / "figures"
    options = ["--scales", 3, "--s-wavelength", 3, "--crop", "10 mm", "390 mm", "--output", target]
    result = shell("fit-surface", inputs / "road.txt", *options)
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


def test_surface_half_takes_units_that_no_file_states(shell, tmp_path):
    heights = np.random.default_rng(1).normal(size=(20, 20))
    line, table = tmp_path / "line.txt", tmp_path / "table.txt"
    line.write_text("\n".join(f"{n} {z:.4f}" for n, z in enumerate(heights.flat)))
    np.savetxt(table, heights, "%.4f")
    unit = ["--z-unit", "um"]
    for file, options in ((line, ["--x-unit", "um"]), (table, ["--step", "1 um, 2 um"])):
        refused = shell("fit-surface", file, *options, code=2)
        assert "give --z-unit; see `gripscale keys surface`" in refused.output
        shell("fit-surface", file, *options, *unit, "--scales", 2)
    np.savetxt(line, heights.ravel(), "%.4f")
    assert "give --step," in shell("fit-surface", line, code=2).output


def test_surface_half_doubts_depths_first_and_turns_them_over(shell, inputs, tmp_path):
    road = tmp_path / "depths.txt"
    road.write_text((inputs / "road.txt").read_text().replace("z [mm]", "depth [mm]"))
    options = ["--scales", 2, "--crop", "10 mm", "390 mm"]
    doubted = " ".join(shell("fit-surface", road, *options).stdout.split())
    assert doubted.startswith("doubt: depths: column 2, titled 'depth', is taken as height, up:")
    assert "--z-axis down turns it over" in doubted
    stated = shell("fit-surface", road, *options, "--z-axis", "down")
    assert "doubt:" not in stated.stdout


def test_surface_half_to_a_cut_off_of_the_upper_part(shell, inputs):
    options = ["--scales", 4, "--crop", "10 mm", "390 mm", "--top-height-fraction", 0.5]
    result = shell("fit-surface", inputs / "road.txt", *options, "--cut-off", "4 mm")
    words = " ".join(result.stdout.split())
    assert "correlation of the upper 50 % of the heights only" in words
    assert "for roughness down to 4 mm" in words
    both = shell("fit-surface", inputs / "road.txt", *options[:2], "--cut-off", "4 mm",
                 "--smallest-wavelength", "4 mm", code=2)  # fmt: skip
    assert "either smallest_wavelength (the last wave) or cut_off" in " ".join(both.stderr.split())


def test_surface_half_says_where_the_waves_end(shell, inputs):
    road, crop = inputs / "road.txt", ["--crop", "10 mm", "390 mm"]

    def notes(*options):
        result = shell("fit-surface", road, *crop, *options)
        return " ".join(result.stdout.split())

    assert "note: no smallest wavelength is stated" in notes("--scales", 2)
    below = notes("--scales", 2, "--smallest-wavelength", "0.05 mm")
    assert "note: The smallest wave, 0.05 mm, is shorter than the measurement resolves" in below
    measured = notes("--scales", 2, "--smallest-wavelength", "1 mm")
    assert "note: Profiles in one direction do not show ridges" in measured
    assert measured.count("note:") == 1


def test_rubber_half_draws_strain_sweeps(shell, inputs, tmp_path):
    strain, target = np.geomspace(0.01, 20.0, 12), tmp_path / "out"
    rows = [
        f"{celsius},{s:.6g},{2 + 6 / (1 + s / c):.6g},{1 / (1 + s / c):.6g}"
        for celsius, c in ((20.0, 1.0), (60.0, 3.0))
        for s in strain
    ]
    sweeps = tmp_path / "payne.csv"
    sweeps.write_text("\n".join(["temperature [C],strain [%],E' [MPa],E'' [MPa]", *rows]))
    asked = shell("fit-rubber", sweeps, code=2)
    assert "--amplitude must be given" in " ".join(asked.output.split())
    options = ["--amplitude", "single", "--measured-at", "0.2 %", "--output", target]
    result = shell("fit-rubber", sweeps, inputs / "dma.txt", *options)
    assert "Maxwell elements of" in result.stdout
    table = result.stdout[result.stdout.index("Moduli over those") :]
    kept = [[float(cell) for cell in line.split()] for line in table.splitlines()[4:6]]
    for (celsius, *factors), c in zip(kept, (1.0, 3.0), strict=True):
        law = [2 + 6 / (1 + s / c) for s in (0.2, 1.0, 10.0)]
        assert celsius == (20.0 if c == 1.0 else 60.0)
        # rows a quarter of a decade apart, three digits printed
        assert factors[:2] == pytest.approx([law[1] / law[0], law[2] / law[0]], rel=0.02)
    assert "half-way between tension and shear" in " ".join(table.split())
    names = {path.name for path in target.iterdir()}
    assert {"softening.png", "master_curve.png"} <= names


@pytest.fixture
def tracks(tmp_path):
    x = 0.1 * np.arange(2000)
    z = np.random.default_rng(1).standard_normal((2, 2000)).cumsum(axis=1) * 0.02
    path = tmp_path / "road.csv"
    np.savetxt(path, np.c_[x, *z], delimiter=",", header="x [furlong],left [mm],right [mm]")
    return path


def test_the_option_that_a_message_names_cures_it(shell, tracks, tmp_path):
    refused = shell("fit-surface", tracks, code=2)
    assert "give --channel, its title or number, such as --channel 2" in " ".join(
        refused.output.split()
    )
    refused = shell("fit-surface", tracks, "--channel", "2", code=2)
    assert "'furlong', which is no known unit of length" in " ".join(refused.output.split())
    shell("fit-surface", tracks, "--channel", "right", "--x-unit", "mm", "--scales", "2")
    options = ["--channel", "3", "--x-unit", "mm", "--crop", "10 mm", "150 mm"]
    curve = tmp_path / "dma.csv"
    rows = "\n".join(
        f"{f},{5 * f**0.1:.6g},{0.8 * f**0.12:.6g}" for f in np.geomspace(0.1, 1e6, 40)
    )
    curve.write_text("f (Hz),E' (MPa),E'' (MPa)\n" + rows)
    case = tmp_path / "case.toml"
    files = [tracks, curve, "--reference-temperature", "20 C", "--output", case]
    shell("new", *files, *options)
    tables = tomllib.loads(case.read_text(encoding="utf-8"))
    stated = {"channel": 3, "x_unit": "mm", "crop": ["10 mm", "150 mm"]}
    assert {key: tables["surface"][key] for key in stated} == stated
    assert tables["rubber"]["reference_temperature"] == "20 C"
    assert "assumed" not in tables["surface"].keys() | tables["rubber"].keys()


ROOM = 293.15
TRUE = WLF(8.86, 101.6, ROOM)


@pytest.fixture(scope="module")
def sweeps(tmp_path_factory):
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


def test_sweeps_become_a_rubber_and_files(shell, sweeps, tmp_path):
    target = tmp_path / "out"
    result = shell("fit-rubber", sweeps, "--reference-temperature", "20 C", "--output", target)
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


def test_a_table_edited_by_hand_is_honoured(shell, sweeps, tmp_path):
    table = tmp_path / "mine.csv"
    celsius = (-12.0, -4.0, 4.0, 12.0, 20.0, 28.0)
    table.write_text(
        "\n".join(["T (C),log_aT", *(f"{c},{(20 - c) / 8}" for c in celsius)]), encoding="utf-8"
    )
    options = ["--reference-temperature", "20 C", "--output", tmp_path / "out"]
    result = shell("fit-rubber", sweeps, "--shift", table, *options)
    assert "shift as given" in result.stdout
    master = read_master_curve(tmp_path / "out" / "master_curve.csv")
    assert master.frequency[-1] == pytest.approx(30.0 * 1e4)


def test_one_sweep_is_a_master_curve_at_its_temperature(shell, tmp_path):
    omega = np.geomspace(1e-2, 1e4, 30)
    modulus = Rubber(1e6, [2e6, 5e6], [1e-1, 1e-3]).complex_modulus(omega) / 3.0
    rows = [f" {w:.5E} {g.real:.5E} {g.imag:.5E}" for w, g in zip(omega, modulus, strict=True)]
    path = tmp_path / "PI.tts"
    path.write_text("\n".join(["T=-35;Mw=13.5;chem=PI;", *rows]), encoding="utf-8")
    result = shell("fit-rubber", path, "--output", tmp_path / "out")
    assert "one sweep at -35.0 °C" in result.stdout
    stated = json.loads((tmp_path / "out" / "rubber.json").read_text(encoding="utf-8"))
    assert stated["reference_temperature"] == pytest.approx(238.15)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "master_curve.csv",
        "master_curve.pdf",
        "master_curve.png",
        "rubber.json",
    }


def test_what_sweeps_need_and_a_master_curve_does_not(shell, sweeps, inputs):
    for words, sentence in (
        ((inputs / "dma.txt", "--vertical"), "sweeps at several temperatures; got a master curve"),
        ((sweeps, "--reference-temperature", "80 C"), "must lie within the temperatures measured"),
    ):
        result = shell("fit-rubber", *words, code=2)
        assert sentence in " ".join(result.stderr.split())
