"""Every row of a study is the answer of its case; friction by relaxation time."""

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.questions.vary.friction_parts import friction_by_decade, in_decades
from gripscale.rubber import Rubber
from gripscale.surface import Profile, self_affine_profile
from tests.samples import HALF_PLANE, SOFTENING, case_text, write_road

PROFILES = 'files = ["road.txt", "lane.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"'
CASES = {
    "profiles": "",
    "continued": '\n[below_measurement]\ndown_to = "0.3 mm"\nhurst = 0.8\n',
    "conditions": f"\n{SOFTENING}",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two profiles of different lengths, so that means over them differ by their weights."""
    folder = tmp_path_factory.mktemp("answers")
    for name, length, seed in (("road", 0.4, 1), ("lane", 0.2, 2)):
        road = self_affine_profile(0.8, 3e-3, 4e-4, length=length, step=2e-4, seed=seed)
        write_road(folder / f"{name}.txt", Profile(road.x, road.z))
    for name, more in CASES.items():
        (folder / f"{name}.toml").write_text(case_text(PROFILES, solver=HALF_PLANE) + more)
    return folder


@pytest.mark.parametrize("name", CASES)
def test_a_row_is_the_answer(folder, name):
    case = read_case(folder / f"{name}.toml")
    row = gs.vary(case, speed=[0.3]).data.isel(speed=0)
    answer = gs.answer(case)
    for quantity in ("friction", "contact_fraction"):
        ends = [float(row[f"answer_{quantity}_{end}"]) for end in ("low", "high")]
        assert float(row[f"answer_{quantity}"]) == pytest.approx(
            getattr(answer, quantity), rel=1e-12
        )
        assert ends == pytest.approx(getattr(answer, f"{quantity}_interval"), rel=1e-12)
    if name == "continued":
        assert any("roughness continued" in str(label) for label in row.factor_label.values)


def test_a_varied_row_is_the_answer_of_the_varied_case(folder):
    case = read_case(folder / "profiles.toml")
    rows = gs.vary(case, pressure=["2 bar", "5 bar"], speed=3.0).data
    other = gs.Case(case.surface, case.rubber, pressure="5 bar", speed=3.0)
    row = rows.isel(pressure=1, speed=0)
    assert float(row.answer_friction) == pytest.approx(gs.answer(other).friction, rel=1e-12)


def test_friction_by_octave_and_by_relaxation_time_add_up(folder):
    data = gs.vary(read_case(folder / "profiles.toml"), speed=[0.3, 3.0]).data
    np.testing.assert_allclose(data.octave_friction.sum("octave"), data.answer_friction, rtol=1e-9)
    octave = np.log2(data.octave.values / 1e-3)
    np.testing.assert_allclose(octave, np.round(octave))
    by_decade = data.friction_by_decade.fillna(0.0)
    np.testing.assert_allclose(by_decade.sum("decade"), data.answer_friction, rtol=1e-9)
    # ten times the speed is lost by relaxation times a tenth as long
    mean = (by_decade * np.log10(data.decade)).sum("decade") / by_decade.sum("decade")
    assert -1.2 < float(mean[1] - mean[0]) < -0.5


def test_there_is_no_friction_at_rest(folder):
    result = gs.vary(read_case(folder / "profiles.toml"), speed=[0.0, 0.3])
    texts = {column.name: column.texts() for column in result.table().columns}
    assert texts["answer_friction"][0] == "-"
    assert texts["answer_friction_interval"][0] == "-"
    assert texts["answer_contact_fraction"][0] != "-"
    assert " at 0 m/s" not in result.lines[0].partition("real contact area")[0]


def test_waves_by_hand_have_no_direct_contact():
    waves = gs.SineStack([5e-3, 1e-3], [2e-4, 4e-5])
    case = gs.Case(waves, gs.Rubber(2e6, [4e6], [1e-3]), pressure=3e5, speed=0.3)
    with pytest.raises(InputError, match="needs a measured profile; got waves stated by hand"):
        gs.vary(case, speed=[0.3], model="direct")


RUBBER = Rubber(2e6, [3e6, 4e6], [2e-2, 5e-4])
WAVELENGTH, SPEED, FRICTION = 10e-3, 0.3, 0.2
OMEGA = 2.0 * np.pi * SPEED / WAVELENGTH


def one_wave(first, second, status="converged"):
    """Return a wave whose pressure has two harmonics, at uneven abscissas, padded with NaN."""
    x = WAVELENGTH * (np.linspace(0.0, 1.0, 400, endpoint=False) - 0.5)
    x = x + 0.01 * WAVELENGTH * np.sin(2.0 * np.pi * x / WAVELENGTH)
    phase = 2.0 * np.pi * x / WAVELENGTH
    pressure = 1e6 * (1.0 + first * np.cos(phase) + second * np.sin(2.0 * phase))
    padded = [np.append(values, np.nan)[None, :] for values in (x, pressure)]
    return xr.Dataset(
        {
            "wavelength": ("scale", [WAVELENGTH]),
            "angular_frequency": ("scale", [OMEGA]),
            "friction": ("scale", [FRICTION]),
            "surface_x": (("scale", "surface_node"), padded[0]),
            "surface_pressure": (("scale", "surface_node"), padded[1]),
        }
    ).assign(prediction_status=status, nominal_speed=SPEED)


def by_hand(first, second):
    """Return the friction of the slower element: D_k = |p_k|^2 E''/|E*|^2, k = 1 and 2."""
    slow, both = 0.0, 0.0
    for order, height in ((1, first), (2, second)):
        modulus = RUBBER.complex_modulus(order * OMEGA)
        phase = order * OMEGA * RUBBER.relaxation_times[0]
        part = height**2 / abs(modulus) ** 2
        slow += part * RUBBER.moduli[0] * phase / (1.0 + phase**2)
        both += part * float(modulus.imag)
    return FRICTION * slow / both


@pytest.mark.parametrize(("first", "second"), [(0.8, 0.0), (0.0, 0.8), (0.5, 0.3)])
def test_split_is_that_of_the_harmonics(first, second):
    parts = friction_by_decade(one_wave(first, second), RUBBER)
    assert set(parts) == {-2, -4}
    # The trapezoidal rule on smooth uneven nodes is exact to second order: (1/400)^2.
    assert parts[-2] == pytest.approx(by_hand(first, second), rel=1e-3)
    assert sum(parts.values()) == pytest.approx(FRICTION, rel=1e-12)


def test_no_split_without_a_solution_or_sliding():
    assert friction_by_decade(one_wave(0.8, 0.1, "iteration limit"), RUBBER) == {}
    rest = one_wave(0.8, 0.1).assign(nominal_speed=0.0)
    assert friction_by_decade(rest, RUBBER) == {}


@pytest.mark.parametrize("shift", [0.0, 0.3, 0.5, 0.99])
def test_elements_as_dense_as_a_spectrum_do_not_jump_between_decades(shift):
    """Elements 2/3 of a decade apart with equal shares: 3/2 of one in each decade, wherever."""
    place = np.arange(-6.0, 2.0, 2.0 / 3.0) + shift
    parts = {}
    for n, part in in_decades(place, np.ones_like(place)):
        parts[n] = parts.get(n, 0.0) + part
    inner = [parts[n] for n in range(-5, 1)]
    np.testing.assert_allclose(inner, 1.5, rtol=1e-12)
    assert sum(parts.values()) == pytest.approx(place.size, rel=1e-12)
