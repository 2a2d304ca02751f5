"""`gripscale new`: measured files in, a case that runs and its doubts out."""

import re
import tomllib
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import prepare_rubber, read_case_file
from gripscale.case_file.new import new_case
from gripscale.case_file.prepare import read_case
from gripscale.case_file.proposals import BY_A_FACTOR, OF_ANOTHER_CASE, TENS_OF_PERCENT
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import WLF

DATA = Path(__file__).parents[2] / "examples" / "data"
ROADS = sorted((DATA / "road").glob("*.dat"))
TREAD = DATA / "rubber" / "measured_dma.txt"
SOLID = gs.Rubber(3e6, [2e6, 20e6, 200e6], [1e-1, 1e-3, 1e-5], reference_temperature=293.15,
                  shift=WLF(8.86, 101.6))  # fmt: skip
ROUGH = gs.surface.self_affine_profile(0.8, 2e-3, 0.4e-3, 0.15, 1e-4, 3)


def road(path, titles="x [mm];z [mm]", size=1e3):
    """A rough profile whose first 15 mm are a plate; `size` of the lengths in a metre."""
    z = np.where(ROUGH.x < 15e-3, 8e-3 + 1e-3 * ROUGH.z, ROUGH.z)
    rows = (
        f"{size * a:.7g};{size * b:.7g}".replace(".", ",") for a, b in zip(ROUGH.x, z, strict=True)
    )
    path.write_text("\n".join([titles, *rows]), encoding="utf-8")
    return path


def sweeps(path, titles="T [°C],f [Hz],E' [MPa],E'' [MPa]", size=1e-6):
    rows = moduli_rows(product((0, 10, 20, 30, 40), np.geomspace(0.1, 100.0, 10)), size)
    path.write_text("\n".join([titles, *rows]), encoding="utf-8")
    return path


def moduli_rows(points, size=1.0, zero=0.0):
    """Temperature above `zero` [C], frequency [Hz] and moduli [Pa] times `size`, line by line."""
    return [
        f"{t + zero:.6g},{f:.6g},{size * (e := modulus(t, f)).real:.6g},{size * e.imag:.6g}"
        for t, f in points
    ]


def modulus(celsius, hertz):
    return complex(SOLID.at(celsius + 273.15).complex_modulus(2.0 * np.pi * hertz))


def keys(case):
    return tomllib.loads(case.path.read_text(encoding="utf-8"))


def doubted(case, effect):
    return " | ".join(str(f) for f in case.findings if f.effect == effect)


def test_the_shipped_files_give_the_shipped_case(tmp_path):
    case = new_case([TREAD, DATA / "road"], tmp_path / "case.toml", temperature="20 degC")
    surface = keys(case)["surface"]
    first, last = (float(end.removesuffix(" mm")) for end in surface["crop"])
    shipped = tomllib.loads((DATA.parent / "road_and_tread" / "case.toml").read_text())["surface"]
    for end, other in zip((first, last), shipped["crop"], strict=True):
        assert end == pytest.approx(float(other.removesuffix(" mm")), abs=50.0)  # "some cm"
    assert [Path(name).name for name in surface["files"]] == [path.name for path in ROADS]
    unused = {file.path.name for file in case.files if file.kind == "unused"}
    assert unused == {"LICENSE", "SOURCE.txt"}
    assert keys(case)["rubber"]["reference_temperature"] == "20 C"
    assert "states no temperature" in doubted(case, OF_ANOTHER_CASE)
    assert "between plates or supports" in doubted(case, BY_A_FACTOR)
    assert [finding.effect for finding in case.findings] == sorted(
        (finding.effect for finding in case.findings), reverse=True
    )
    text = case.path.read_text(encoding="utf-8")
    assert "# 1. reference_temperature" in text
    assert "plates, supports" not in doubted(case, OF_ANOTHER_CASE)


def test_order_does_not_matter_and_what_is_stated_is_no_doubt(tmp_path):
    files = [road(tmp_path / "road.csv"), sweeps(tmp_path / "dma.csv")]
    load = {"pressure": "2 bar", "speed": "0.5 m/s", "footprint": "50 mm"}
    texts = []
    for order in (files, files[::-1]):
        stated = {"load": load, "temperature": "25 C", "filled": False}
        case = new_case(order, tmp_path / "case.toml", **stated)
        texts.append(case.path.read_text(encoding="utf-8"))
        case.path.unlink()
    assert texts[0] == texts[1]
    found = tomllib.loads(texts[0])
    assert found["surface"]["crop"][0] == "19 mm"  # 15 mm and a guard of a fortieth of 150 mm
    assert found["rubber"]["reference_temperature"] == "25 C"
    assert found["conditions"] == {"temperature": "25 C"}
    assert found["load"] == load
    assert found["rubber"]["filled"] is False
    assert not doubted(case, OF_ANOTHER_CASE)


def test_units_that_no_file_states_are_proposed_and_doubted(tmp_path):
    files = [
        road(tmp_path / "road.csv", "Weg;Hoehe", 1.0),
        sweeps(tmp_path / "dma.csv", "Temperatur,Frequenz,Speichermodul,Verlustmodul", 1.0),
    ]
    with pytest.raises(InputError, match=r"dma\.csv: modulus must be given, E for"):
        new_case(files, tmp_path / "case.toml")
    case = new_case(files, tmp_path / "case.toml", layout={"modulus": "E"})
    found = keys(case)
    assert (found["surface"]["x_unit"], found["surface"]["z_unit"]) == ("m", "m")
    rubber = found["rubber"]
    units = ("frequency_unit", "temperature_unit", "modulus_unit")
    assert [rubber[unit] for unit in (*units, "modulus")] == ["Hz", "C", "Pa", "E"]
    for key in ("x_unit", "z_unit", *units):
        assert f"{key} = " in doubted(case, OF_ANOTHER_CASE)
    storage = prepare_rubber(
        read_case_file(case.path).case.rubber, read_case_file(case.path).resolve
    )
    assert storage.sweeps.storage[0] == pytest.approx(modulus(0, 0.1).real, rel=1e-5)


def test_kelvin_and_a_map_are_seen_by_their_numbers(tmp_path):
    dma = tmp_path / "dma.csv"
    rows = moduli_rows(product((10, 20, 30), np.geomspace(0.1, 100.0, 10)), zero=273.15)
    dma.write_text("\n".join(["T,f [Hz],E' [Pa],E'' [Pa]", *rows]))
    x, y = 0.2 * np.arange(64)[:, None], 0.3 * np.arange(48)
    heights = 0.05 * (np.sin(2.0 * x + y) + 0.3 * np.cos(5.0 * x - 2.0 * y))
    np.save(tmp_path / "map.npy", heights)
    step = ["0.2 mm", "0.3 mm"]
    case = new_case([dma, tmp_path / "map.npy"], tmp_path / "case.toml", step=step)
    found = keys(case)
    assert found["rubber"]["temperature_unit"] == "K"
    assert found["surface"]["map"] == "map.npy"
    assert found["surface"]["step"] == step
    assert "the map is 12.6 mm and 14.1 mm long in x and y" in doubted(case, TENS_OF_PERCENT)


def test_a_temperature_that_cannot_be_reached_is_a_doubt(tmp_path):
    curve = tmp_path / "curve.csv"
    rows = [
        f"{f:.6g},{(e := modulus(20, f)).real:.6g},{e.imag:.6g}" for f in np.geomspace(1, 1e6, 30)
    ]
    curve.write_text("\n".join(["T = 20 °C", "f [Hz],E' [Pa],E'' [Pa]", *rows]), encoding="utf-8")
    files = [road(tmp_path / "road.csv"), curve]
    case = new_case(files, tmp_path / "case.toml", temperature="60 C")
    assert "conditions" not in keys(case)
    assert "one temperature and no shift, and cannot be brought to 60 C" in doubted(
        case, BY_A_FACTOR
    )
    shift = {"kind": "wlf", "c1": 8.86, "c2": "101.6 K"}
    case = new_case(files, tmp_path / "shifted.toml", temperature="60 C", shift=shift)
    assert keys(case)["conditions"] == {"temperature": "60 C"}
    assert read_case(case.path).rubber_before.reference_temperature == pytest.approx(333.15)


def test_ramps_at_several_frequencies_get_nominal_temperatures(tmp_path):
    rows = moduli_rows(product(np.arange(-10.0, 40.1, 0.9), (1.0, 3.0, 10.0, 30.0)))
    ramps = tmp_path / "ramps.csv"
    ramps.write_text("\n".join(["T [°C],f [Hz],E' [Pa],E'' [Pa]", *rows]), encoding="utf-8")
    case = new_case([road(tmp_path / "road.csv"), ramps], tmp_path / "case.toml")
    assert keys(case)["rubber"]["temperature_step"] == "5 K"
    assert "moduli are interpolated at multiples" in doubted(case, TENS_OF_PERCENT)


@pytest.mark.parametrize(
    ("files", "words"),
    [
        (["road"], "expected a file with moduli"),
        (["dma"], "expected a file with a surface"),
        (["road", "picture"], "picture.png"),
        (["road", "ansys"], "expected rows of frequency, storage and loss"),
        (["dma", "ansys"], "ansys.MPL: expected rows with two columns"),
        (["road", "dma", "gone"], "gone.dat"),
    ],
)
def test_files_without_use_are_refused(tmp_path, files, words):
    picture = tmp_path / "picture.png"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)))
    ansys = tmp_path / "ansys.MPL"
    ansys.write_text("/COM,ANSYS RELEASE 2020 R1\nTB,PRON,_MATL,1,27,SHEA\n")
    paths = {
        "ansys": ansys,
        "road": road(tmp_path / "road.csv"),
        "dma": sweeps(tmp_path / "dma.csv"),
        "picture": picture,
        "gone": tmp_path / "gone.dat",
    }
    with pytest.raises((InputError, FileError), match=words):
        new_case([paths[name] for name in files], tmp_path / "case.toml")
    assert not (tmp_path / "case.toml").exists()


def test_moduli_of_no_rubber_get_a_bulk_modulus_and_a_doubt(tmp_path):
    """E' of a hundred times the rubber's: with 2 GPa Poisson's ratio would be negative."""
    stiff = sweeps(tmp_path / "dma.csv", size=100e-6)
    case = new_case([road(tmp_path / "road.csv"), stiff], tmp_path / "case.toml")
    largest = max(100.0 * modulus(t, 100.0).real for t in (0, 40))
    bulk = float(keys(case)["rubber"]["bulk_modulus"].removesuffix(" GPa")) * 1e9
    shear, ratio = largest / 3.0, 0.3
    assert bulk == pytest.approx(2.0 * shear * (1.0 + ratio) / (3.0 - 6.0 * ratio), rel=0.02)
    assert "is the unit of the moduli right" in doubted(case, OF_ANOTHER_CASE)
    mended = new_case(
        [road(tmp_path / "road.csv"), stiff],
        tmp_path / "mended.toml",
        layout={"modulus_unit": "kPa"},
    )
    assert keys(mended)["rubber"]["modulus_unit"] == "kPa"
    assert keys(mended)["rubber"]["bulk_modulus"] == "2 GPa"


def test_sweeps_that_do_not_overlap_name_the_shift(tmp_path, shell):
    dma = tmp_path / "dma.csv"
    rows = moduli_rows(product((-40, 60), (1.0, 2.0, 4.0)))
    dma.write_text("\n".join(["T [°C],f [Hz],E' [Pa],E'' [Pa]", *rows]), encoding="utf-8")
    files = [road(tmp_path / "road.csv"), dma]
    with pytest.raises(InputError, match=r'dma\.csv: .* give the shift = \{ kind = "wlf"'):
        new_case(files, tmp_path / "case.toml")
    with pytest.raises(InputError, match=r"give shift=gripscale\.rubber\.WLF\(8\.86, 101\.6\)$"):
        gs.superpose(gs.read_sweeps(dma), reference_temperature=293.15)
    for command in (("new", *files, "-o", tmp_path / "case.toml"), ("fit-rubber", dma)):
        outcome = shell(
            *command, *(("--reference-temperature", "20 C") * (command[0] != "new")), code=2
        )
        assert 'here with --wlf C1 C2, such as --wlf 8.86 "101.6 K"' in outcome.output
    shift = ("--wlf", "8.86", "101.6 K", "--reference-temperature", "20 C")
    outcome = shell("fit-rubber", dma, *shift)
    assert "shift as given" in outcome.output


def test_a_case_is_not_overwritten(tmp_path):
    target = tmp_path / "case.toml"
    target.write_text("mine")
    with pytest.raises(FileError, match="is there already and is not overwritten"):
        new_case([road(tmp_path / "road.csv"), sweeps(tmp_path / "dma.csv")], target)
    assert target.read_text() == "mine"


OPTIONS = ("--pressure", "1 bar", "--speed", "1 m/s", "--footprint", "20 mm")


def test_the_command_says_what_is_doubtful_and_what_comes_next(tmp_path, shell):
    folder = tmp_path / "own"
    folder.mkdir()
    road(folder / "road.csv")
    sweeps(folder / "dma.csv")
    target = tmp_path / "case.toml"
    outcome = shell("new", folder, "-o", target, "--temperature", "20 C", *OPTIONS)
    assert "Doubts, the most important first:\n  1. Whether the rubber is" in outcome.output
    assert f"gripscale run {target}" in " ".join(outcome.output.split())
    outcome = shell("new", folder, "-o", tmp_path / "b.toml", "--unfilled", *OPTIONS)
    assert "Doubts, the most important first:\n  1. crop = " in outcome.output


def test_a_refusal_names_the_option_that_cures_it(tmp_path, shell):
    line = tmp_path / "line.txt"
    line.write_text("\n".join(f"{1e3 * z:.4f}" for z in ROUGH.z))
    command = ("new", line, sweeps(tmp_path / "dma.csv"), "-o", tmp_path / "case.toml")
    outcome = shell(*command, code=2)
    assert 'give --step, the distance between its points, such as "0.1 mm"' in outcome.output
    outcome = shell(*command, "--step", "0.1 mm")


ROWS = [f"{t},{f:g},{100.0 - t + f:g},20" for t in (-20, 0, 20, 40) for f in (0.1, 1.0, 10.0)]


@pytest.mark.parametrize(
    ("titles", "rows", "words"),
    [
        ("Temp,freq_Hz,E1_MPa,E2_MPa", ROWS, "modulus as two of storage, .*, such as --columns f"),
        (
            "T [°C],E' [MPa],E'' [MPa]",
            [",".join([*row.split(",")[::2], "20"]) for row in ROWS],
            'columns must give the frequency; .* --frequency states it, such as "10 Hz"',
        ),
    ],
)
def test_sweeps_that_cannot_be_read_say_why_and_what_cures_it(tmp_path, shell, titles, rows, words):
    dma = tmp_path / "dma.csv"
    dma.write_text("\n".join([titles, *rows]), encoding="utf-8")
    outcome = shell("new", road(tmp_path / "r.csv"), dma, "-o", tmp_path / "case.toml", code=2)
    assert re.search(words, " ".join(outcome.output.split()))
    assert "read_sweeps" not in outcome.output


def test_columns_and_units_of_the_rubber_can_be_stated(tmp_path, shell):
    dma = tmp_path / "dma.csv"
    sweeps(dma, "Temp,freq_Hz,E1_MPa,E2_MPa")
    rows = (row.split(",", 1) for row in dma.read_text().splitlines()[1:])
    fahrenheit = [f"{32.0 + 1.8 * float(t)},{rest}" for t, rest in rows]
    dma.write_text("\n".join(["Temp,freq_Hz,E1_MPa,E2_MPa", *fahrenheit]))
    options = ("--columns", "frequency=freq,storage=E1,loss=E2", "--temperature-unit", "F")
    files = (dma, road(tmp_path / "r.csv"))
    shell("new", *files, "-o", tmp_path / "case.toml", *options)
    case = read_case_file(tmp_path / "case.toml")
    prepared = prepare_rubber(case.case.rubber, case.resolve)
    assert prepared.sweeps.temperatures == pytest.approx(273.15 + np.arange(0, 50, 10))


def test_sweeps_without_a_temperature_of_the_contact_are_doubted(tmp_path):
    files = [road(tmp_path / "road.csv"), sweeps(tmp_path / "dma.csv")]
    words = "no temperature of the contact stated: 20 °C assumed; --temperature states another"
    assert words in doubted(new_case(files, tmp_path / "a.toml"), BY_A_FACTOR)
    curve = new_case([*ROADS[:1], TREAD], tmp_path / "c.toml")
    assert "as is the contact; --temperature states" in doubted(curve, OF_ANOTHER_CASE)
    stated = new_case(files, tmp_path / "b.toml", temperature="20 C")
    assert "temperature" not in doubted(stated, BY_A_FACTOR)


def test_a_title_that_says_depth_is_a_doubt_of_weight(tmp_path):
    path = road(tmp_path / "road.csv", "x [mm];Tiefe [mm]")
    files = [path, sweeps(tmp_path / "dma.csv")]
    case = new_case(files, tmp_path / "case.toml", filled=False)
    assert case.findings[0].effect == OF_ANOTHER_CASE
    assert "titled 'Tiefe', is taken as height, up" in case.findings[0].sentence
    results = read_case(read_case_file(case.path))
    assert any("titled 'Tiefe'" in str(doubt) for doubt in results.doubts())
    stated = case.path.read_text(encoding="utf-8").replace(
        "[surface]", '[surface]\nz_axis = "down"'
    )
    case.path.write_text(stated, encoding="utf-8")
    turned = read_case(read_case_file(case.path))
    assert not any("Tiefe" in str(doubt) for doubt in turned.doubts())
    before, after = (each.surface.measured.profiles[0][0].z for each in (results, turned))
    assert np.array_equal(after, -before)


def test_a_folder_of_a_rubber_names_what_is_not_moduli(tmp_path):
    path, laboratory = road(tmp_path / "road.csv"), tmp_path / "laboratory"
    laboratory.mkdir()
    sweeps(laboratory / "raw.csv")
    (laboratory / "shifts.csv").write_text("T [C],log_aT\n0,2.0\n20,0\n40,-1.6\n")
    case = new_case([path, laboratory], tmp_path / "case.toml")
    assert keys(case)["rubber"]["file"] == "laboratory/raw.csv"
    assert [Path(name).name for name in keys(case)["surface"]["files"]] == ["road.csv"]
    words = 'laboratory/shifts.csv holds shift factors and is not used: shift = "laboratory/shifts'
    assert words in doubted(case, BY_A_FACTOR)
    (laboratory / "master.csv").write_text(
        "f [Hz],E' [MPa],E'' [MPa]\n" + "\n".join(f"{10.0**n},{5 + n},0.5" for n in range(8))
    )
    both = new_case([path, laboratory], tmp_path / "other.toml")
    words = "master.csv is taken as the rubber, not raw.csv: --as states another"
    assert words in doubted(both, BY_A_FACTOR)
    assert keys(both)["rubber"]["shift"] == "laboratory/shifts.csv"


def test_cases_in_one_folder_have_results_of_their_own(tmp_path):
    files = [road(tmp_path / "road.csv"), sweeps(tmp_path / "dma.csv")]
    for name, results in (("case", "results"), ("wet", "results-wet")):
        assert keys(new_case(files, tmp_path / f"{name}.toml"))["output"]["folder"] == results


def test_what_is_proposed_is_among_the_doubts_of_the_case(tmp_path):
    bare = road(tmp_path / "bare.csv", "x;z")
    new = new_case([bare, TREAD], tmp_path / "case.toml")
    case = gs.read_case(new.path)
    proposed = [str(finding) for finding in case.doubts()][:3]
    assert [text.partition(" = ")[0] for text in proposed] == [
        "x_unit",
        "z_unit",
        "reference_temperature",
    ]
    sentences = [str(finding) for finding in new.findings]
    assert sentences[:3] == proposed
    assert len(sentences) == len(set(sentences))
    stated = {"x_unit": "mm", "z_unit": "mm"}
    layout = {"reference_temperature": "20 C"}
    known = new_case([bare, TREAD], tmp_path / "known.toml", surface=stated, layout=layout)
    assert not gs.read_case(known.path).origin.assumed
