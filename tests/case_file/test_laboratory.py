"""A laboratory's folder: each file is taken for what it is, and the case needs no edit."""

import sys
import tomllib
from itertools import product

import numpy as np
import pytest

from gripscale.case_file.kinds import FileKeys
from gripscale.case_file.laboratory import all_taken
from gripscale.case_file.new import new_case
from gripscale.case_file.prepare import read_case
from gripscale.core.errors import FileError, InputError
from gripscale.io.text_table import files_read_once
from tests.case_file.test_new import SOLID, keys, moduli_rows, modulus, road

HERTZ = np.geomspace(1e-3, 1e6, 28)
STRAINS = np.geomspace(1e-3, 0.2, 12)


def moduli(titles, scale=1e-6, at=40.0):
    curve = ((f, modulus(at, f)) for f in HERTZ)
    return "\n".join(
        [titles, *(f"{f:.6g},{scale * e.real:.6g},{scale * e.imag:.6g}" for f, e in curve)]
    )


def strain_sweeps(titles, strain=100.0, prefix=""):
    """Moduli that fall to half of those at small strain, at two temperatures."""
    rows = [
        f"{t},{prefix}{strain * e:.5g},{(9 - 0.05 * t) / (1 + 20 * e):.5g},{2 / (1 + 10 * e):.5g}"
        for t in (0, 40)
        for e in STRAINS
    ]
    return "\n".join([titles, *rows])


def shifts(titles="temperature [C],a_T [-]"):
    """Factors of a table whose curve holds at 40 °C."""
    rows = (f"{t},{SOLID.shift.a(t + 273.15, 313.15):.6g}" for t in range(-20, 81, 10))
    return "\n".join([titles, *rows])


FRICTION = "speed [m/s],friction\n0.001,0.9\n0.01,1.2\n0.1,1.5\n1,1.6\n"
TITLES = "T [°C],f [Hz],E' [MPa],E'' [MPa]"
RAMP = "\n".join([TITLES, *moduli_rows(product(range(-20, 61, 4), [10.0]), 1e-6)])
BY_FREQUENCY = product(range(0, 41, 10), np.geomspace(0.1, 100, 10))
SWEEPS = "\n".join([TITLES, *moduli_rows(BY_FREQUENCY, 1e-6)])
MAP = "\n".join(
    ["x [mm],y [mm],z [um]"]
    + [
        f"{0.1 * i:.1f},{0.1 * j:.1f},{40 * np.sin(i / 3) * np.cos(j / 4):.3f}"
        for i in range(20)
        for j in range(20)
    ]
)
HEIGHTS = [f"{0.1 * i:.1f},{40 * np.sin(i / 3):.3f}" for i in range(60)]
PROFILE = "\n".join(["x [mm],z [um]", *HEIGHTS])
PREDICTION = "\n".join(
    ["speed [m/s],hysteresis friction [-],contact fraction [-]"]
    + [f"{speed:.3g},0.2,0.1" for speed in HERTZ]
)
KINDS = {
    "a profile": (PROFILE, "profile"),
    "a map": (MAP, "map"),
    "a profile with its speed": (
        "\n".join(["x [mm],z [um],Speed [km/h]", *(f"{row},60" for row in HEIGHTS)]),
        "profile",
    ),
    "a profile with temperatures": (
        "\n".join(["x [mm],z [um],Temperature", *(f"{row},23" for row in HEIGHTS)]),
        "profile",
    ),
    "a master curve": (moduli("frequency [Hz],E' [MPa],E'' [MPa]"), "master-curve"),
    "a curve without titles": (moduli("# measured in May").partition("\n")[2], "master-curve"),
    "sweeps": (SWEEPS, "sweeps"),
    "a ramp": (RAMP, "ramp"),
    "a Prony list": ("tau (s);E_i (MPa)\ninf;3,2\n0,001;5,5\n0,1;1,5\n", "prony"),
    "strain sweeps": (
        strain_sweeps("temperature [C],strain amplitude [%],E' [MPa],E'' [MPa]"),
        "strain-sweep",
    ),
    "strain sweeps at one frequency": (
        strain_sweeps("T (°C),f (Hz),Dehnung (%),E' (MPa),E'' (MPa)", prefix="10,"),
        "strain-sweep",
    ),
    "strains without a unit": (
        strain_sweeps("Temp. (°C),shear strain,G' (kPa),G'' (kPa)", strain=1.0),
        "strain-sweep",
    ),
    "ratios over strain": (
        "strain [-],f = storage over its small-strain value [-],g = loss over its value [-]\n"
        + "\n".join(f"{e:.4g},{1 / (1 + 20 * e):.4g},{1 / (1 + 9 * e):.4g}" for e in STRAINS),
        "strain-sweep",
    ),
    "shift factors": (shifts(), "shift"),
    "logarithms of shift factors": ("T [K];log aT\n273,15;2,1\n293,15;0\n313,15;-1,4\n", "shift"),
    "shift factors without a unit": ("Temperature,aT\n-20,1e5\n0,100\n20,1\n40,0.05\n", "shift"),
    "natural logarithms": ("T [°C];ln(aT)\n-20;9,2\n0;4,6\n20;0\n40;-3\n", "shift"),
    "shift factors in German": ("Temperatur [°C];Verschiebungsfaktor\n-20;1e5\n0;99\n", "shift"),
    "a quantity over temperature": (
        "Temp. [°C],hardness\n" + "\n".join(f"{t},{60 - t}" for t in range(40)),
        "unused",
    ),
    "strain sweeps in short": (
        "Temp.;Freq.;stat.Dehn.;dyn.Dehn.;E';E''\n°C;Hz;%;%;MPa;MPa\n"
        + "\n".join(f"20;10;10;{100 * e:.4g};{9 / (1 + 20 * e):.4g};{1 + e:.4g}" for e in STRAINS),
        "strain-sweep",
    ),
    "friction": (FRICTION, "friction"),
    "friction in other words": (
        "Gleitgeschwindigkeit (mm/s);Reibwert\n" + "0,5;0,9\n5;1,2\n50;1,5\n",
        "friction",
    ),
    "friction with its spread": (
        "Sliding speed [mm/s]\tCoefficient of friction\tStd\tTemp. [°C]\n"
        "1\t0.9\t0.1\t21\n10\t1.1\t0.1\t21\n",
        "friction",
    ),
    "friction whose temperature has no unit": ("v [m/s],mu,T\n1,0.9,20\n2,1,20\n", "unused"),
    "a prediction": (PREDICTION, "unused"),
    "remarks": ("measured on 3 May by the laboratory\n", "unused"),
}  # fmt: skip


@pytest.mark.parametrize("what", KINDS)
def test_a_file_is_taken_for_what_it_is(tmp_path, what):
    text, kind = KINDS[what]
    (tmp_path / "file.txt").write_text(text, encoding="utf-8")
    (taken,) = all_taken([tmp_path], FileKeys(), {})
    assert (taken.kind, bool(taken.why)) == (kind, True)
    if what == "a prediction":
        assert "expected a column named friction; got speed, hysteresis friction" in taken.why


def test_tables_of_as_many_rows_are_not_taken_for_each_other(tmp_path):
    """Inside one look at files, of which each is read once."""
    path = tmp_path / "file.txt"
    rows = "".join(
        f"T = {t} °C\nf [Hz],E' [MPa],E'' [MPa]\n"
        + "".join(f"{f:.4g},{f**0.1 + t:.4g},{f**0.1:.4g}\n" for f in np.geomspace(0.1, 100, 16))
        for t in (0, 20, 40)
    )
    path.write_text(rows, encoding="utf-8")
    with files_read_once():
        (taken,) = all_taken([tmp_path], FileKeys(), {})
    assert [round(sweep.storage[0] / 1e6) for sweep in taken.measured] == [1, 21, 41]


def folder_of(path, names):
    path.mkdir()
    road(path / "road.csv")
    for name, text in names.items():
        (path / name).write_text(text, encoding="utf-8")
    return path


COMPOUND = {
    "A_curve.csv": moduli("frequency [Hz],E' [MPa],E'' [MPa]"),
    "A_shift.csv": shifts(),
    "A_strain.csv": KINDS["strain sweeps"][0],
    "A_friction.csv": FRICTION,
    "notes.txt": "of compound A\n",
}


def test_the_files_of_a_compound_make_its_case(tmp_path):
    folder = folder_of(tmp_path / "A", COMPOUND)
    case = new_case([folder], folder / "case.toml")
    found = keys(case)
    assert found["surface"]["files"] == ["road.csv"]
    rubber = found["rubber"]
    assert (rubber["file"], rubber["shift"]) == ("A_curve.csv", "A_shift.csv")
    assert rubber["reference_temperature"] == "40 C"  # where a_T is 1
    assert found["conditions"] == {
        "temperature": "20 C",
        "softening": {"kind": "table", "files": ["A_strain.csv"]},
    }
    assert found["measured"] == {"friction": "A_friction.csv"}
    assert found["load"]["speed"] == "0.1 m/s"  # the middle one
    read = read_case(case.path)
    assert read.rubber_before.reference_temperature == pytest.approx(293.15)
    found_modulus = complex(read.rubber_before.complex_modulus(20.0 * np.pi))
    assert found_modulus == pytest.approx(modulus(20, 10.0), rel=0.02)


def test_of_two_compounds_the_files_of_one_are_taken(tmp_path):
    two = {
        **COMPOUND,
        **{f"B{name[1:]}": text for name, text in COMPOUND.items() if name[0] == "A"},
    }
    folder = folder_of(tmp_path / "both", two)
    asked = []

    def second(question, answers):
        asked.append((question, list(answers)))
        return str(answers[1])

    found = keys(new_case([folder], folder / "b.toml", ask=second))
    assert asked == [("Which is the rubber?", ["A_curve.csv", "B_curve.csv"])]
    assert (found["rubber"]["shift"], found["measured"]["friction"]) == (
        "B_shift.csv",
        "B_friction.csv",
    )
    assert found["conditions"]["softening"]["files"] == ["B_strain.csv"]
    silent = new_case([folder], folder / "a.toml")
    assert keys(silent)["rubber"]["file"] == "A_curve.csv"
    words = "A_curve.csv is taken as the rubber, not B_curve.csv: --as states another"
    assert any(words in str(finding) for finding in silent.findings)
    stated = new_case([folder], folder / "s.toml", kinds={"B_curve.csv": "master-curve"})
    assert keys(stated)["rubber"]["file"] == "B_curve.csv"


def test_a_terminal_asks_for_what_no_file_tells(tmp_path, shell, monkeypatch):
    texts = {"A.csv": COMPOUND["A_curve.csv"], "B.csv": COMPOUND["A_curve.csv"]}
    folder, asked = folder_of(tmp_path / "two", texts), []
    replies = iter(["3", "B.csv", "YES"])  # the first is no answer

    def reply(text, **_):
        asked.append(text.partition("\n")[0])
        return next(replies)

    monkeypatch.setattr("typer.prompt", reply)
    module = sys.modules["gripscale.cli.new"]  # the package has a command of this name
    monkeypatch.setattr(module, "in_terminal", lambda: True)
    shell("new", folder, "-o", folder / "case.toml")
    assert [text.partition(" ")[0] for text in asked] == ["Which", "Which", "Is"]
    rubber = tomllib.loads((folder / "case.toml").read_text(encoding="utf-8"))["rubber"]
    assert (rubber["file"], rubber["filled"]) == ("B.csv", True)


def test_friction_of_another_compound_is_left_out(tmp_path):
    other = {"B_curve.csv": COMPOUND["A_curve.csv"], "B_friction.csv": FRICTION}
    names = {name: text for name, text in COMPOUND.items() if name != "A_friction.csv"}
    folder = folder_of(tmp_path / "both", names | other)
    case = new_case([folder], folder / "case.toml", kinds={"A_curve.csv": "master-curve"})
    assert "measured" not in keys(case)
    why = next(file.why for file in case.files if file.path.name == "B_friction.csv")
    assert why == "friction; by its name not of A_curve.csv"


def test_friction_may_state_temperature_and_pressure(tmp_path):
    text = "v [mm/s],mu,T [C],pressure [kPa]\n1,0.8,35,200\n10,1.0,35,200\n100,1.1,35,200\n"
    folder = folder_of(tmp_path / "A", COMPOUND | {"A_friction.csv": text})
    found = keys(new_case([folder], folder / "case.toml"))
    assert found["conditions"]["temperature"] == "35 C"
    assert (found["load"]["pressure"], found["load"]["speed"]) == ("2 bar", "0.01 m/s")


@pytest.mark.parametrize(("zero", "unit"), [(0.0, "C"), (273.15, "K")])
def test_the_unit_of_the_shift_factors_is_proposed(tmp_path, zero, unit):
    titles, *rows = shifts("temperature,a_T").splitlines()
    bare = [f"{float(t) + zero:.2f},{a}" for t, a in (row.split(",") for row in rows)]
    text = "\n".join([titles, *bare])
    folder = folder_of(tmp_path / "A", COMPOUND | {"A_shift.csv": text})
    case = new_case([folder], folder / "case.toml")
    assert keys(case)["rubber"]["temperature_unit"] == unit
    assert keys(case)["rubber"]["reference_temperature"] == "40 C"
    assert any("the shift factors do not state it" in str(finding) for finding in case.findings)


def test_a_ramp_takes_the_shift_factors(tmp_path):
    folder = folder_of(tmp_path / "A", {"ramp.csv": RAMP, "shift.csv": shifts()})
    case = new_case([folder], folder / "case.toml", temperature="40 C")
    assert keys(case)["rubber"]["shift"] == "shift.csv"
    assert read_case(case.path).rubber_before.reference_temperature == pytest.approx(313.15)


def test_a_file_without_units_is_not_pooled_with_a_road(tmp_path):
    numbers = "\n".join(f"{t},{10.0 ** (-t / 20):.4g}" for t in range(-40, 80, 5))
    folder = folder_of(tmp_path / "A", COMPOUND | {"numbers.csv": numbers})
    case = new_case([folder], folder / "case.toml")
    assert keys(case)["surface"]["files"] == ["road.csv"]
    why = next(file.why for file in case.files if file.path.name == "numbers.csv")
    assert "names no unit, unlike others; --as profile takes it" in why


def test_a_kind_goes_before_the_content(tmp_path, shell):
    folder = folder_of(tmp_path / "A", COMPOUND)
    options = ("--as", "unused", "A_friction.csv", "--as", f"unused={folder / 'A_strain.csv'}")
    outcome = shell("new", folder, "-o", folder / "case.toml", *options)
    lines = [line.split() for line in outcome.output.splitlines()]
    kinds = {line[0]: line[1] for line in lines if len(line) > 1}
    assert kinds["A_friction.csv"] == kinds["A_strain.csv"] == "unused"
    assert (kinds["A_curve.csv"], kinds["road.csv"]) == ("master-curve", "profile")
    found = tomllib.loads((folder / "case.toml").read_text(encoding="utf-8"))
    assert "measured" not in found
    assert "softening" not in found["conditions"]
    with pytest.raises(InputError, match=r"kind of a file must be one of .*strain-sweep"):
        new_case([folder], folder / "b.toml", kinds={"A_strain.csv": "sweep"})
    with pytest.raises(FileError, match=r"road\.csv.*expected at least 3 columns"):
        new_case([folder], folder / "b.toml", kinds={"road.csv": "sweeps"})


def test_look_shows_how_a_file_is_read(tmp_path, shell):
    bare = tmp_path / "bare.csv"
    bare.write_text("\n".join(["x;z", *HEIGHTS]).replace(",", ";"))
    (tmp_path / "strain.csv").write_text(KINDS["strain sweeps"][0])
    curve = moduli("f (Hz),E' (MPa),E'' (MPa)")
    (tmp_path / "bad.csv").write_text(curve.replace("\n0.001,", "\n-0.001,"))
    outcome = shell("look", bare, tmp_path / "strain.csv", tmp_path / "bad.csv")
    text = " ".join(outcome.output.split())
    assert "bare.csv: profile; 60 heights over 5.9 mm columns 1 x, 2 z" in text
    assert "z_unit = um: bare.csv names no unit" in text
    assert "strain.csv: strain-sweep; strains of 0.100 to 20.0 %, at 0.0 °C; 40.0 °C" in text
    assert "2 strain amplitude [%], 3 E' [MPa]" in text
    assert "note: 1 of 28 rows left out, a value is zero or less (line 2)" in text
    picture = next(line for line in outcome.output.splitlines() if "µm" in line and "▁" in line)
    assert picture.count("█") > 2
