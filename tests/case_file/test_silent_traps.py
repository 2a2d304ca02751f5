"""Wrong inputs of daily life: none passes in silence, the answer or the refusal says so.

Each trap changes one thing of a case that has no doubt.
"""

import math

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case_file
from gripscale.case_file.named_inputs import read_named_inputs, read_rubber, read_surface
from gripscale.case_file.prepare import read_case
from gripscale.core.errors import FileError, InputError
from gripscale.core.finding import doubt, to_json
from gripscale.model import INPUT_DOUBTS, Load, input_doubts_of, load_doubts
from gripscale.questions import Study, compare_compounds, compare_surfaces
from gripscale.questions.answer.answer import answer
from gripscale.questions.answer.findings import case_notices
from gripscale.questions.answer.page import answer_lines
from gripscale.questions.answer.reliance import no_answer
from gripscale.questions.inputs import record
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.page_of_folder import write_report
from gripscale.surface import self_affine_profile
from tests.report.reading import Page

ROUGH = self_affine_profile(0.8, 2e-3, 0.4e-3, 0.2, 1e-4, 3)
CASE = """\
[surface]
files = ["road.txt"]
scales = 4
smallest_wavelength = "1 mm"
[rubber]
file = "dma.txt"
reference_temperature = "20 C"
filled = false
[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
"""
DMA = "f [Hz]\tE' [MPa]\tE'' [MPa]\n" + "\n".join(
    f"{f:.5g}\t{5.0 * f**0.1:.6g}\t{1.0 * f**0.1:.6g}" for f in np.geomspace(1e-2, 1e6, 33)
)


def dma_text(storage, loss, titles="E' [MPa],E'' [MPa]"):
    """A power law as in `DMA` with moduli of other sizes; E'' a number of its size or a text."""
    rows = (
        f"{f:.5g},{storage * f**0.1:.6g},{loss if isinstance(loss, str) else loss * f**0.1}"
        for f in np.geomspace(1e-2, 1e6, 33)
    )
    return "\n".join([f"f [Hz],{titles}", *rows])


def road_text(z=ROUGH.z, titles="x [mm]\tz [mm]"):
    rows = (f"{1e3 * a:.2f}\t{1e3 * b:.5f}" for a, b in zip(ROUGH.x, z, strict=True))
    return "\n".join([titles, *rows])


def write(folder, *, case=CASE, road="", dma=DMA):
    content = road or road_text()
    raw = content if isinstance(content, bytes) else content.encode("utf-8")
    (folder / "road.txt").write_bytes(raw)
    (folder / "dma.txt").write_text(dma, encoding="utf-8")
    (folder / "case.toml").write_text(case, encoding="utf-8")
    return read_case_file(folder / "case.toml")


def with_plate(height, *, where=slice(0, 300)):
    z = ROUGH.z.copy()
    z[where] = height + 0.02 * ROUGH.z[where]
    return road_text(z)


def with_sentinel():
    z = ROUGH.z.copy()
    z[500:540] = -0.05
    return road_text(z)


EXCHANGED = "\n".join(
    ["f [Hz],E'' [MPa],E' [MPa],tan delta"]
    + [f"{f:.5g},{5 * f**0.1:.6g},{f**0.1:.6g},0.2" for f in np.geomspace(1, 1e6, 20)]
)
UNNAMED = "\n".join(
    ["f [Hz],E' [MPa],E'' [MPa]"]
    + [f"{f * s**0.1:.5g},{5 * s:g},{s:g}" for f in (0.1, 1, 10) for s in range(1, 25)]
)
TRAPS = {
    "a plate at one end": ({"road": with_plate(20e-3)}, "plates, supports or filled gaps"),
    "a support below": ({"road": with_plate(-9e-3)}, "mm below the road"),
    "a plate in the middle": ({"road": with_plate(12e-3, where=slice(900, 1200))},
     "they carry the rubber in place of the surface"),
    "a crop that keeps the plate": ({"road": with_plate(20e-3),
     "case": CASE.replace("scales", 'crop = ["0 mm", "150 mm"]\nscales')},
     "plates, supports or filled gaps"),
    "a mark of missing heights": ({"road": with_sentinel()}, "does it mark missing heights?"),
    "heights in another unit": ({"road": road_text(titles="x [mm]\tz [um]")},
     "is the unit of heights right?"),
    "distances in another unit": ({"road": road_text(titles="x [m]\tz [mm]")}, "is the unit of"),
    "axes exchanged": ({"road": "\n".join(["z [mm]\tx [mm]", *road_text().split("\n")[1:]])},
     "expected"),
    "a picture as a road": ({"road": b"\x89PNG\r\n" + bytes(range(256)) * 9},
     "expected a file with measured values; got a picture (PNG)"),
    "no temperature anywhere": ({"case": CASE.replace('reference_temperature = "20 C"\n', "")},
     "states the temperature of its moduli"),
    "moduli exchanged": ({"dma": EXCHANGED}, "look exchanged"),
    "tan delta as a loss modulus": ({"dma": dma_text(60.0, "0.2")},
     "E'' looks like the loss factor (tan delta)"),
    "a loss modulus in another unit": ({"dma": dma_text(5.0, 1e3)},
     "E'' looks 1000 times too large"),
    "a loss factor in % without its unit": ({"dma": dma_text(5.0, "20", "E' [MPa],tan delta")},
     "E'' looks like one of a loss factor in %"),
    "an angle in degrees as a loss factor": ({"dma": dma_text(5.0, "11.3", "E' [MPa],tan delta")},
     "E'' looks like one of a phase angle in degrees"),
    "a loss modulus above the storage modulus": ({"dma": dma_text(5.0, 20.0)},
     "storage and loss modulus look exchanged"),
    "moduli in another unit, too large": ({"dma": dma_text(5e6, 1e6),
     "case": CASE.replace("[load]", 'bulk_modulus = "1e8 GPa"\n[load]')},
     "is that of no rubber: is the unit of the moduli right (modulus_unit)?"),
    "moduli in another unit, beyond the bulk modulus": ({"dma": dma_text(5e6, 1e6)},
     "is the unit of the moduli another?"),
    "moduli in another unit, too small": ({"dma": dma_text(5.0, 1.0, "E' [Pa],E'' [Pa]")},
     "is that of no rubber: is the unit of the moduli right (modulus_unit)?"),
    "sweeps without their temperatures": ({"dma": "\n".join([dma_text(5.0, 1.0),
     *dma_text(50.0, 10.0).split("\n")[1:]])},
     "the same frequencies again with moduli 10 times apart"),
    "moduli of temperatures that are not named": ({"dma": UNNAMED},
     "rows of nearly one frequency differ"),
    "heights in another unit, too large": ({"road": road_text(1e3 * ROUGH.z)},
     "of the heights stand at steps"),
    "distances in another unit, too small": ({"road": road_text(titles="x [um]\tz [mm]")},
     "is the unit of heights or of distances right?"),
    "a pressure without its unit": ({"case": CASE.replace('"3 bar"', "3")}, "is its unit right?"),
    "a pressure in another unit": ({"case": CASE.replace('"3 bar"', '"3 GPa"')}, "Pressure = 3"),
    "a speed in another unit": ({"case": CASE.replace('"0.3 m/s"', "300")}, "Speed = 300 m/s"),
    "a footprint without its unit": ({"case": CASE.replace('"100 mm"', "100")}, "Footprint = "),
    "a rubber in place of a road": ({"road": DMA},
     "road.txt, line 2: expected two columns, distance"),
    "a road in place of a rubber": ({"dma": road_text()}, "at least 3 columns (frequency,"),
    "a footprint in another unit": ({"case": CASE.replace('"100 mm"', '"100 um"')},
     "is its unit right?"),
}  # fmt: skip


def said(folder, changes):
    """Return what stands first in the answer of a case, or why it is refused."""
    try:
        results = read_case(write(folder, **changes))
    except (FileError, InputError) as error:
        return str(error)
    return " | ".join(str(doubt) for doubt in results.findings() if doubt.effect == math.inf)


@pytest.mark.parametrize("trap", TRAPS)
def test_no_trap_is_silent(tmp_path, trap):
    changes, words = TRAPS[trap]
    assert words in said(tmp_path, changes)


def test_the_case_without_a_trap_has_no_doubt(tmp_path):
    assert said(tmp_path, {}) == ""


def test_an_answer_of_no_rubber_is_none_to_rely_on(tmp_path):
    direct = answer(read_case(write(tmp_path, dma=dma_text(60.0, "0.2")))).data
    assert no_answer(direct).startswith("none to rely on. E' and E'' do not belong to one rubber:")


def test_questions_on_a_misread_rubber_say_so(tmp_path):
    misread = dma_text(60.0, "0.2")
    case = read_case(write(tmp_path, dma=misread))
    answers = [
        gs.compare(case, models=["direct"]).data,
        compare_surfaces(case, {"a": "case", "b": "case"}).data,
        Study(case, {"speed": "0.1,1"}, model="chain").run(tmp_path / "speeds", workers=1),
    ]
    (tmp_path / "other.txt").write_text(misread, encoding="utf-8")
    file = write(tmp_path)
    case, rubbers = read_case(file), {"right": "case", "misread": read_rubber("other.txt", file)}
    answers.append(compare_compounds(case, rubbers).data)
    named = read_named_inputs({"rubber": ["case", "other.txt"]}, file)
    answers.append(Study(case, named, model="chain").run(tmp_path / "rubbers", workers=1))
    for data in answers:
        assert str(input_doubts_of(data)[0]).startswith("E' and E'' do not belong to one rubber:")


def test_doubts_of_the_inputs_come_first():
    doubted = {INPUT_DOUBTS: to_json([doubt("Is the unit right?")])}
    assert no_answer(xr.Dataset({"status": "contact too narrow"}, attrs=doubted)) == (
        "none. Is the unit right? The chain of waves has no result: contact too narrow."
    )
    names = ("answer_friction", "answer_contact_fraction")
    values = dict.fromkeys(names, 0.5) | {f"{name}_half_width": 0.1 for name in names}
    data = xr.Dataset({**values, "nominal_speed": 1.0})
    assert no_answer(data) == ""
    assert no_answer(data.assign_attrs(doubted)) == "none to rely on. Is the unit right?"


@pytest.mark.parametrize(
    ("area", "friction", "speed", "doubted"),
    [
        (0.995, 5e-4, 1.0, True),
        (0.985, 5e-4, 1.0, False),
        (0.995, 2e-3, 1.0, False),
        (0.995, 5e-4, 0.0, False),  # at rest there is no friction
    ],
)
def test_an_answer_of_a_smooth_plate_doubts_its_units(area, friction, speed, doubted):
    numbers = {"contact_fraction": area, "friction": friction}
    values = {f"answer_{name}": value for name, value in numbers.items()}
    values |= {f"answer_{name}_half_width": 0.1 for name in numbers}
    said = no_answer(xr.Dataset({**values, "nominal_speed": speed}))
    plate = "as on a smooth plate: are the units of heights, distances and moduli right?"
    assert (plate in said) is doubted


def test_the_farthest_load_of_a_study_is_named():
    loads = [Load(3e5, speed, 0.1) for speed in (0.0, 1.0, 200.0, 1e7)]
    (text,) = load_doubts(loads, {"speed": "km/h"})
    assert str(text).startswith("Speed = 3.6e+07 km/h is not between 3.6e-09 km/h and 360 km/h")
    assert load_doubts(loads[:2], {}) == []


TRAPPED = (
    CASE.replace('reference_temperature = "20 C"\n', "").replace('"100 mm"', '"1 mm"')
    + '[solver]\nmodel = "half_plane"\npoints = 64\n'
    + '[measured]\nfriction = "friction.csv"\n[output]\nfolder = "results"\n'
)
"""The temperature of the moduli is missing, and the footprint is shorter than the largest wave."""
AT_200 = "Speed = 200 m/s is not between 1e-09 m/s and 100 m/s: is its unit right?"


@pytest.mark.parametrize(
    ("command", "of_its_load"),
    [
        (("sensitivity", "--vary", "speed=0.3,200"), AT_200),
        (("calibrate", "--model", "chain", "--law", "constant"), ""),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_commands_and_their_pages_say_the_doubts_of_a_run(tmp_path, shell, command, of_its_load):
    file = write(tmp_path, case=TRAPPED, road=with_plate(20e-3))
    (tmp_path / "friction.csv").write_text("speed [m/s],friction\n0.1,2\n1,2\n200,2\n")
    of_inputs = record.input_findings(InputRecord(record.inputs(read_case(file))))
    said = [finding.sentence for finding in of_inputs]
    first = [*said[:3], *filter(None, [of_its_load])]
    for words in ("plates", "states the temperature of its moduli", "The footprint, 1 mm"):
        assert any(words in text for text in first)
    name, *options = command
    out = tmp_path / name
    printed = shell(name, file.path, *options, "--output", out, columns=1000)
    answer, _, warnings = printed.stdout.partition("Warnings, by what they change:\n")
    assert "Answer: " in answer
    assert (name == "calibrate") == ("none to rely on. The measured speeds, 0.1 to 200" in answer)
    assert {line.strip() for line in warnings.splitlines()[: len(first)]} == {*first}
    page = "".join(Page(write_report(out)).text.split())
    for text in {*said, *first}:
        assert "".join(text.replace("`", "").split()) in page


def test_a_foreign_road_has_not_the_crop_of_the_case(tmp_path):
    crop = CASE.replace("scales", 'crop = ["50 mm", "150 mm"]\nspike_slope = 2\nscales')
    file = write(tmp_path, case=crop)
    (tmp_path / "other.txt").write_text(road_text(ROUGH.z[::-1]), encoding="utf-8")
    for name, length in (("road.txt", 0.1), ("other.txt", 0.2)):
        measured = read_surface(name, file).measured
        assert measured.cleaned[0].length == pytest.approx(length, abs=1e-9)
    assert read_surface("road.txt", file).note == ""
    assert read_surface("other.txt", file).note == (
        "other.txt: read with scales, smallest_wavelength, spike_slope of the case, but not crop, "
        "which belongs to the road of the case"
    )


def test_an_answer_ends_where_the_heights_do_whatever_the_cut_off(tmp_path):
    file = write(tmp_path, case=CASE.replace('smallest_wavelength = "1 mm"', 'cut_off = "0.02 mm"'))
    results = read_case(file)
    direct = answer(results, folder=tmp_path).data
    assert "roughness down to 0.2 mm" in " ".join(answer_lines(direct))  # two steps
    warnings = case_notices(direct, InputRecord(record.inputs(results)))
    assert warnings[0].sentence.startswith(
        "The cut-off of the case is 0.02 mm, but the heights hold"
    )


def test_a_foreign_rubber_without_a_temperature_says_whose_it_takes(tmp_path):
    file = write(tmp_path)
    (tmp_path / "other.txt").write_text(DMA, encoding="utf-8")
    (tmp_path / "warm.txt").write_text(f"T = 40 °C\n{DMA}", encoding="utf-8")
    assert "its moduli are assumed to be those at 20 °C" in read_rubber("other.txt", file).note
    assert read_rubber("warm.txt", file).note == ""


def test_a_sensitivity_doubts_a_foreign_rubber_without_a_temperature(tmp_path):
    file = write(tmp_path)
    (tmp_path / "other.txt").write_text(DMA, encoding="utf-8")
    vary = read_named_inputs({"rubber": ["case", "other.txt"]}, file)
    warnings = gs.sensitivity(read_case(file), vary=vary).findings
    assert warnings[0].sentence.startswith("other.txt: the file states no temperature")
