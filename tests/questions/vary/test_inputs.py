"""What may be varied: surfaces and rubbers by name and file, axes, what is said of wrong ones."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.named_inputs import read_rubber, read_surface
from gripscale.case_file.prepare import case_surface
from gripscale.core.errors import FileError, InputError
from gripscale.questions.vary.axis import axes_of, parse_axes
from gripscale.questions.vary.inputs import measured_rubber_of, surface_of
from tests.samples import EXAMPLES, sine_profile, write_road

EXAMPLE = EXAMPLES / "road_and_tread" / "case.toml"
STACK = gs.SineStack(wavelength=20e-3 / 3.0 ** np.arange(5), amplitude=2e-3 / 2.2 ** np.arange(5))


@pytest.fixture
def measured(tmp_path):
    """A case on a made-up road of five waves, and a copy of the road under another name."""
    profile = sine_profile(STACK, length=0.5, step=1e-4, seed=3)
    for name in ("road.txt", "other.txt"):
        write_road(tmp_path / name, profile)
    path = tmp_path / "case.toml"
    path.write_text(
        '[surface]\nfiles = ["road.txt"]\nspikes = "none"\nscales = 5\n'
        'smallest_wavelength = "0.25 mm"\n'
        '[rubber]\nname = "styrene_butadiene"\nbulk_modulus = "1.5 GPa"\n'
        '[load]\npressure = "3 bar"\nspeed = 0.3\nfootprint = 0.1\n'
    )
    return path


def test_measured_surface_is_fitted_anew(measured):
    road = case_surface(read_case_file(measured))
    base = road.varied().sines
    assert (len(base), base.wavelength[-1]) == (5, pytest.approx(0.25e-3))
    four = road.varied(waves=4).sines
    assert (len(four), four.wavelength[-1]) == (4, pytest.approx(0.25e-3))
    finer = road.varied(smallest_wavelength=0.1e-3).sines
    assert (len(finer), finer.wavelength[-1]) == (5, pytest.approx(0.1e-3))


def test_fixed_factor_leaves_room_for_what_varies(measured):
    text = measured.read_text().replace('smallest_wavelength = "0.25 mm"', "s_wavelength = 3")
    measured.write_text(text)
    road = case_surface(read_case_file(measured))
    assert len(road.varied(waves=3).sines) == 3
    finer = road.varied(smallest_wavelength=1e-4).sines
    assert finer.s_wavelength == pytest.approx(3.0)
    assert 1e-4 <= finer.wavelength[-1] < 3e-4


def test_cut_off_is_fitted_anew(measured):
    road = case_surface(read_case_file(measured))
    cut = road.varied(cut_off=0.2e-3, waves=4).sines
    own = gs.fit_sines(road.correlation, scales=4, cut_off=0.2e-3)
    np.testing.assert_array_equal(cut.amplitude, own.amplitude)
    # back from a cut-off to a last wave
    back = replace(
        road, waves=cut, fit={**road.fit, "smallest_wavelength": None, "cut_off": 0.2e-3}
    )
    assert back.varied(smallest_wavelength=0.3e-3).sines.wavelength[-1] == pytest.approx(0.3e-3)


def test_what_needs_a_measured_surface_says_so():
    by_hand = surface_of(STACK, read_case(EXAMPLE))
    with pytest.raises(InputError, match="cut_off varies waves that were fitted"):
        by_hand.varied(cut_off=1e-3)
    with pytest.raises(InputError, match=r"smallest_wavelength .* or cut_off .*, not both"):
        by_hand.varied(cut_off=1e-3, smallest_wavelength=1e-3)


def test_surface_by_name_file_or_case(measured, tmp_path):
    file = read_case_file(measured)
    case = read_case(file)
    own = surface_of("case", case)
    beside = read_surface("other.txt", file)
    other_case = read_surface(str(measured), file)
    for road in (beside, other_case):
        np.testing.assert_array_equal(road.sines.wavelength, own.sines.wavelength)
    assert beside.source.endswith("other.txt")
    made = surface_of("synthetic_dense_asphalt", case)
    assert "synthetic, self-affine, H = 0.8" in made.source
    assert made.sines.wavelength[-1] == pytest.approx(0.1e-3)
    assert len(made.varied(waves=4).sines) == 4
    with pytest.raises(FileError, match="nor one of case, synthetic_dense_asphalt"):
        read_surface("synthetic_lawn", file)


def test_rubber_by_name_file_or_case(measured):
    file = read_case_file(measured)
    own = read_case(file).rubber
    assert own.bulk_modulus == 1.5e9
    assert read_rubber("styrene_butadiene", file).rubber == own
    tread = read_rubber(str(EXAMPLE), file).rubber
    assert tread.bulk_modulus == 2e9
    dma = EXAMPLE.parents[1] / "data" / "friction" / "S100_master_curve.csv"
    again = read_rubber(str(dma), file).rubber
    assert again.bulk_modulus == 1.5e9
    np.testing.assert_array_equal(again.relaxation_times, tread.relaxation_times)


def test_waves_by_hand_are_cut_off():
    road = surface_of(STACK, read_case(EXAMPLE))
    assert len(road.varied(waves=2).sines) == 2
    assert len(road.varied(smallest_wavelength=1e-3).sines) == 3
    with pytest.raises(InputError, match="smallest_wavelength must not exceed"):
        road.varied(smallest_wavelength=1.0)


def test_varied_rubber_keeps_what_the_case_says_beside_its_curve(measured):
    energy = 'strain_energy = { kind = "yeoh", second = -0.1, third = 0.02 }\n[load]'
    measured.write_text(measured.read_text().replace("[load]", energy))
    file = read_case_file(measured)
    dma = EXAMPLE.parents[1] / "data" / "rubber" / "measured_dma.txt"
    for value in ("case", "styrene_butadiene", str(dma)):
        rubber = measured_rubber_of(read_rubber(value, file), read_case(file)).rubber
        assert rubber.strain_energy == gs.rubber.Yeoh(-0.1, 0.02)
        assert rubber.bulk_modulus == 1.5e9


def test_varied_file_is_read_like_that_of_the_case_where_it_does_not_say(measured):
    """One curve three times: bare numbers, titles that contradict the case, a loss factor."""
    omega = np.geomspace(1e-2, 1e6, 40)
    modulus = gs.rubber.springpot_modulus(omega)
    hertz, storage, loss = omega / 2 / np.pi, modulus.real, modulus.imag
    files = {
        "own.txt": ("", (omega, loss / 1e6 / 3, storage / 1e6 / 3)),
        "bare.txt": ("", (omega, loss / 1e6 / 3, storage / 1e6 / 3)),
        "told.txt": (
            "T = 40 °C\nf (Hz)\tE' (kPa)\tE'' (kPa)\n",
            (hertz, storage / 1e3, loss / 1e3),
        ),
        "tan.txt": ("f (Hz)\tE' (kPa)\ttan d\n", (hertz, storage / 1e3, loss / storage)),
    }
    for name, (titles, columns) in files.items():
        rows = ["\t".join(f"{v:.9e}" for v in row) for row in zip(*columns, strict=True)]
        measured.with_name(name).write_text(titles + "\n".join(rows) + "\n", encoding="utf-8")
    stated = (
        'file = "own.txt"\nfrequency_unit = "rad/s"\nmodulus_unit = "MPa"\nmodulus = "G"\n'
        'columns = [1, 3, 2]\nreference_temperature = "20 C"\n'
    )
    measured.write_text(measured.read_text().replace('name = "styrene_butadiene"\n', stated))
    file = read_case_file(measured)
    own = read_rubber("own.txt", file).rubber
    others = [read_rubber(name, file).rubber for name in ("bare.txt", "told.txt", "tan.txt")]
    for other in others:
        at = [other.complex_modulus(w) / own.complex_modulus(w) for w in (1.0, 1e4)]
        np.testing.assert_allclose(at, 1.0, rtol=1e-6)
    assert [one.reference_temperature for one in others] == [293.15, 313.15, 293.15]
    assert "read with these settings of the rubber of the case: freq" in others[0].source


@pytest.mark.parametrize(
    ("name", "given", "values"),
    [
        ("speed", "0.001:10:log5", (0.001, 0.01, 0.1, 1.0, 10.0)),
        ("speed", "1 mm/s:10 m/s:log5", (0.001, 0.01, 0.1, 1.0, 10.0)),
        ("speed", "0:2:lin3", (0.0, 1.0, 2.0)),
        ("speed", "0, 36 km/h", (0.0, 10.0)),
        ("pressure", "1 bar,3 bar", (1e5, 3e5)),
        ("pressure", 2e5, (2e5,)),
        ("pressure", ["1 bar", "300 kPa", 2e5], (1e5, 3e5, 2e5)),
        ("speed", np.geomspace(0.01, 1.0, 3), (0.01, 0.1, 1.0)),
        ("speed", np.array(["0.1 m/s", "36 km/h"]), (0.1, 10.0)),
        ("speed", xr.DataArray([0.1, 1.0], dims="speed"), (0.1, 1.0)),
        ("temperature", np.array([293.15, 313.15]), (293.15, 313.15)),
        ("temperature", [293.15, "40 C"], (293.15, 313.15)),
        ("smallest_wavelength", "0.01 mm:1 mm:log3", (1e-5, 1e-4, 1e-3)),
        ("cut_off", "0.1 mm, 1 mm", (1e-4, 1e-3)),
        ("rubber", "case,here/dma.txt", ("case", "here/dma.txt")),
    ],
)
def test_values_are_read(name, given, values):
    axis = axes_of({name: given})[0]
    assert axis.values == values
    assert len(axis.labels) == len(values)


def test_labels_are_short_unless_they_would_be_equal():
    assert axes_of({"temperature": [293.15, "40 C"]})[0].labels == ("20 C", "40 C")
    assert axes_of({"rubber": "case,a/dma.txt"})[0].labels == ("case", "dma")
    assert axes_of({"rubber": "b/dma.txt,a/dma.txt"})[0].labels == ("b/dma.txt", "a/dma.txt")


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "varies one or two of speed, pressure"),
        ({"speed": [1], "thickness": [2], "pressure": [3]}, "one or two of .*; got 3"),
        ({"sped": [1]}, "vary must be one of speed, .*; got 'sped'"),
        ({"speed": []}, "speed must have 1 to 1000 values; got 0"),
        ({"speed": "1:10:sqrt3"}, 'such as "0.01 m/s:10 m/s:log7"; got .1:10:sqrt3.'),
        ({"speed": "1 m/s:10 m/s"}, "must be a range of .*; got '1 m/s:10 m/s'"),
        ({"speed": "1:2:3:log4"}, "must be a range of .*; got '1:2:3:log4'"),
        ({"speed": "1:10:log1"}, "number of values must be a whole number from 2"),
        ({"speed": "10:1:log3"}, "speed must go from low to high"),
        ({"speed": "0:1:log3"}, "log range must be greater than zero"),
        ({"speed": "1:10 m/s:log3"}, "a unit at both ends or none"),
        ({"speed": "-1"}, "speed must not be negative"),
        ({"speed": "fast"}, "speed = 'fast': expected a speed"),
        ({"speed": "1,1.0"}, "different values; got 1 more than once"),
        ({"pressure": "3 furlong"}, "pressure = '3 furlong': unknown unit"),
        ({"pressure": "0"}, "pressure must be greater than zero"),
        ({"pressure": [float("nan")]}, "pressure must be a finite number"),
        ({"effects": "2:3:lin3"}, "effects must be a list, not a range"),
        ({"effects": 3}, "effects must be a str; got int"),
        ({"rubber": [3]}, "rubber must be names and files"),
        ({"rubber": 3}, "rubber must be names and files, or a mapping from names; got 3"),
        ({"temperature": [20, 60]}, 'in kelvin or have a unit, such as "20 C"; got 20 K'),
        ({"speed": np.ones((2, 2))}, "speed must be a finite number .*; got an array of shape"),
    ],
)
def test_wrong_axis_is_one_sentence(vary, words):
    with pytest.raises(InputError, match=words) as caught:
        axes_of(vary)
    assert "\n" not in str(caught.value)


def test_option_is_a_name_and_its_values():
    assert parse_axes(["speed = 1:2:lin2"]) == {"speed": "1:2:lin2"}
    for wrong in ("speed", "speed=", "sped=1"):
        with pytest.raises(InputError, match="vary must be"):
            parse_axes([wrong])
