"""Surfaces and rubbers by name and file; measured surfaces are fitted anew where waves vary."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.named_inputs import read_rubber, read_surface
from gripscale.case_file.prepare import case_surface
from gripscale.core.errors import FileError, InputError
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
