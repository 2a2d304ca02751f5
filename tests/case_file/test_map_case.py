"""A case on a measured map: all its lines describe it, the direct contact is that of the map."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import prepare_surface, read_case, read_case_file
from gripscale.case_file.named_inputs import read_surface
from gripscale.charts.draw import FigureFolder
from gripscale.core.errors import InputError
from gripscale.experiment.task import Task
from gripscale.half_space import DirectContact
from gripscale.model import Load
from gripscale.questions.inputs.charts_of_surface import surface_figures
from gripscale.questions.inputs.page import surface_lines
from tests.half_space.rough_cases import ZENER, isotropic_heights

LOAD = Load(3e5, 0.3, 0.1)
STATED = """
[surface]
map = "road.txt"
step = ["0.2 mm", "0.4 mm"]
z_unit = "mm"
scales = 3
smallest_wavelength = "1.6 mm"
valid_range = ["-5 mm", "5 mm"]
[rubber]
name = "styrene_butadiene"
[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "0.1 m"
"""


def road():
    z = isotropic_heights(64, length=0.0128, rms=2e-4, shortest=8e-4)[:, :32].copy()
    z[30:33, 10:12] = np.nan
    z[5, 5] = 9.0
    return z


@pytest.fixture
def case(tmp_path):
    """Write a table of heights and a case that names it; `also` are further keys."""
    np.savetxt(tmp_path / "road.txt", 1e3 * road().T)

    def write(also="", text=STATED):
        path = tmp_path / "case.toml"
        path.write_text(text.replace("scales = 3", f"scales = 3\n{also}"), encoding="utf-8")
        return read_case_file(path)

    return write


def prepared(file):
    return prepare_surface(file.case.surface, file.resolve)


def test_the_map_is_read_cleaned_and_described_by_its_lines(case):
    surface = prepared(case())
    measured = surface.measured
    assert measured.map.z.shape == (64, 32)
    assert measured.map.step == pytest.approx((2e-4, 4e-4))
    assert measured.map.missing == 7
    assert np.nanmean(measured.map.z) == pytest.approx(0.0, abs=1e-12)
    assert measured.surfaces == [measured.map]
    assert len(measured.cleaned) == 32
    curve = gs.height_difference(measured.map.lines())
    np.testing.assert_array_equal(surface.correlation.value, curve.value)
    assert surface.sines.wavelength[-1] == pytest.approx(1.6e-3)
    assert measured.cleaning[0]["dropouts"].made_missing == 1


def test_sliding_the_other_way_turns_the_map(case):
    across = prepared(case('direction = "y"')).measured.map
    assert across.step == pytest.approx((4e-4, 2e-4))
    assert across.z.shape == (32, 64)


def test_the_direct_contact_is_that_of_the_map(case):
    surface = prepared(case())
    found = DirectContact(tolerance=0.1).predict(ZENER, surface, LOAD)
    alone = gs.solve_rough_contact(
        ZENER,
        surface.measured.map,
        pressure=3e5,
        speed=0.3,
        smallest_wavelength=float(surface.sines.wavelength[-1]),
        tolerance=0.1,
    )
    assert found.prediction_status.item() == "converged"
    assert found.sizes["profile"] == 1
    assert float(found.total_friction) == alone.friction
    assert float(found.total_contact_fraction) == alone.contact_fraction


def test_a_result_depends_on_the_map_and_on_nothing_else(case):
    keys = [
        Task(ZENER, prepared(case(also)), LOAD, DirectContact()).key
        for also in ("", "form = 1", "form = 2")
    ]
    assert keys[0] == keys[1] != keys[2]
    file = case()
    before = read_case(file).key
    np.savetxt(file.resolve("road.txt"), 2e3 * road().T)
    assert read_case(file).key != before


def test_a_study_varies_the_map(case, tmp_path):
    file = case("form = 2")
    np.savetxt(tmp_path / "other.txt", 2e3 * road().T)
    other = read_surface("other.txt", file).measured.map
    own = prepared(file).measured.map
    assert np.nanstd(other.z) == pytest.approx(2.0 * np.nanstd(own.z), rel=0.02)
    assert other.step == own.step


def test_one_line_of_the_map_is_shown(case, tmp_path):
    surface = prepared(case('crop_across = ["2 mm", "12 mm"]'))
    text = "\n".join(surface_lines(surface))
    assert "line 18 along x: 64 points, step 0.2 mm" in text
    assert "trim" in text
    assert "order 1: mean" in text
    (raw, cleaned), *others = surface.measured.profiles
    assert not others
    plane = raw.z - cleaned.z
    assert np.ptp(np.diff(plane, 2)) < 1e-12
    surface_figures(surface, FigureFolder(tmp_path))
    assert (tmp_path / "profile.png").exists()


def test_keys_that_need_a_map(case):
    text = STATED.replace('map = "road.txt"', 'files = ["road.txt"]')
    with pytest.raises(InputError, match="step of a profile is one length; two are those of a map"):
        case(text=text)
    unreadable = prepared, case('crop_across = ["2 mm", "3 mm"]')
    with pytest.raises(InputError, match=r"road\.txt: crop must leave at least 16 points along y"):
        unreadable[0](unreadable[1])
