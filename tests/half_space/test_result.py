"""What a direct contact tells, as a result, a Dataset and a model, and what it refuses."""

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.core.status import Status
from gripscale.half_space import DirectContact
from gripscale.io import netcdf
from gripscale.model import TOTALS, Load, Model
from gripscale.surface import HeightMap, Measured, Profile, Surface

from .rough_cases import LOAD, PROFILES, SURFACE, ZENER, isotropic_map, random_case, solve

FOUND = solve(isotropic_map(64, shortest=1.6e-3), tolerance=0.05)


def test_patches_and_pressures_add_up():
    cell = np.prod(FOUND.grid.spacing)
    assert FOUND.patches.sum() == pytest.approx(FOUND.active.sum() * cell)
    quartiles = FOUND.pressure_quantiles([0.0, 0.5, 1.0])
    assert 0.0 < quartiles[0] < quartiles[1] < quartiles[2] == FOUND.pressure.max()
    assert FOUND.missing_share == 0.0


def test_steep_contact_is_noted():
    flat, steep = FOUND, solve(isotropic_map(64, shortest=1.6e-3, rms=3e-3), tolerance=None)
    assert flat.slope_in_contact < 0.5
    assert flat.notes == []
    assert steep.slope_in_contact > 0.5
    assert "small strain is no longer a good approximation" in steep.notes[0]


def test_the_dataset_holds_the_result(tmp_path):
    data = FOUND.to_dataset()
    assert float(data["contact_fraction"]) == FOUND.contact_fraction
    assert data["pressure"].dims == ("x", "y")
    np.testing.assert_array_equal(data["gap"], FOUND.gap)
    np.testing.assert_array_equal(data["x"], FOUND.x)
    assert data["octave_friction"].dims == ("wavelength",)
    assert data["status"].item() == "converged"
    assert all({"units", "long_name", "source"} <= set(v.attrs) for v in data.data_vars.values())
    assert "pressure" not in FOUND.to_dataset(fields=False)
    xr.testing.assert_identical(
        netcdf.load_dataset(netcdf.save(data, tmp_path / "direct.nc")), data
    )


def test_area_by_octave_is_that_of_the_smoothed_surface():
    """Its definition: the contact without the shorter waves, on four points in the shortest."""
    surface = isotropic_map(128, shortest=8e-4)
    found = solve(surface, tolerance=None)
    octaves = found.friction_by_wavelength["contact_fraction"].dropna("wavelength")
    assert octaves.sizes["wavelength"] >= 3
    assert octaves.values[-1] == found.contact_fraction
    second = float(octaves["wavelength"][-2])
    smooth = solve(surface, smallest_wavelength=second, tolerance=None)
    assert octaves.values[-2] == pytest.approx(smooth.contact_fraction, rel=1e-6)


def test_the_tolerance_is_met_or_the_status_says_so():
    surface = isotropic_map(64, shortest=1.6e-3)
    fine = solve(surface, tolerance=0.01, most_points=2**20)
    assert fine.converged
    assert fine.contact_fraction_error <= 0.01 * fine.contact_fraction
    assert fine.friction_error <= 0.01 * fine.friction_from_dissipation
    coarse = solve(surface, tolerance=0.001, most_points=64**2)
    assert coarse.status == "tolerance not met"


def test_a_contact_of_few_points_is_too_narrow():
    x = np.arange(64) * 1e-4
    found = solve(
        Profile(x, 1e-4 * np.cos(2 * np.pi * x / 64e-4)),
        pressure=0.1,
        tolerance=None,
        speed=0.0,
        most_points=128,
    )
    assert found.status == "contact too narrow"


def test_the_model_averages_profiles_by_length():
    model = DirectContact(smallest_wavelength=1e-3, tolerance=0.05)
    assert isinstance(model, Model)
    seen = []
    data = model.predict(ZENER, SURFACE, LOAD, on_progress=seen.append)
    assert set(TOTALS) <= set(data)
    assert data["prediction_status"].item() == "converged"
    assert data.attrs["model"] == "direct"
    lengths = np.array([len(profile) for profile in PROFILES])
    expected = np.average([contact.friction for contact in seen], weights=lengths)
    assert float(data["total_friction"]) == pytest.approx(expected, rel=1e-12)
    np.testing.assert_array_equal(data["friction"], [contact.friction for contact in seen])
    again = model.predict(ZENER, SURFACE.only(model.needs), LOAD)
    assert float(again["total_friction"]) == float(data["total_friction"])


def test_the_model_ends_where_the_waves_end_and_refuses_waves_alone():
    data = DirectContact(tolerance=None).predict(ZENER, SURFACE, LOAD)
    np.testing.assert_allclose(data["smallest_wavelength"], 1e-3)
    with pytest.raises(InputError, match="needs a measured profile; got sine waves"):
        DirectContact().predict(ZENER, Surface(SURFACE.sines, "by hand"), LOAD)


def test_a_profile_that_fails_makes_the_totals_nan():
    failing = DirectContact(smallest_wavelength=1e-3, tolerance=1e-5, most_points=2**12)
    load = Load(pressure=1e3, speed=0.0, footprint=0.1)
    short = Surface(
        SURFACE.sines, "made", measured=Measured([(PROFILES[0], PROFILES[0])], [], None, "")
    )
    data = failing.predict(ZENER, short, load)
    assert np.isnan(float(data["total_friction"]))
    assert data["prediction_status"].item() == "profile 1 of 1: tolerance not met"
    assert data["prediction_status_word"].item() == "tolerance not met"


X = np.arange(64) * 1e-4
WAVE = Profile(X, 1e-5 * np.cos(2 * np.pi * X / 64e-4))


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("level", [0.0, 1.3e-3, 7.0])
@pytest.mark.parametrize("shape", [(48,), (90,), (48, 48)])
def test_a_flat_surface_is_full_contact(shape, level, periodic):
    """Nothing to divide by; the rounding of a level, transformed, is far below 1e-20 of a slope."""
    x, z = 1e-4 * np.arange(shape[0]), np.full(shape, level)
    surface = Profile(x, z) if len(shape) == 1 else HeightMap(x, x, z)
    found = solve(surface, periodic=periodic)
    assert found.converged
    assert found.full_contact
    assert (found.contact_fraction, found.contact_fraction_error) == (1.0, 0.0)
    assert found.friction == pytest.approx(0.0, abs=1e-20)
    assert found.friction_from_dissipation == pytest.approx(0.0, abs=1e-20)
    assert found.residuals == pytest.approx({"pressure": 0.0, "gap": 0.0, "load": 0.0}, abs=1e-12)
    np.testing.assert_allclose(found.pressure, 3e5, rtol=1e-12)
    assert found.to_dataset()["octave_friction"].sum() == pytest.approx(0.0, abs=1e-20)


# Without a tolerance the two frictions still judge the grid.


@pytest.mark.parametrize("seed", [85, 175])
def test_friction_of_the_wrong_sign_is_not_converged(seed):
    """A few points on steep crests, four in the smallest wave: -0.049 and -0.054 from traction.

    A grid eight times finer has 0.018 and 0.042 both from traction and from dissipation.
    """
    found = random_case(seed, points_of_map=32).solve(tolerance=None)
    assert found.friction < -0.04
    assert 0.01 < found.friction_from_dissipation < 0.05
    assert found.status == Status.FRICTIONS_DISAGREE
    (note,) = [note for note in found.notes if "from dissipation" in note]
    assert f"Friction is {found.friction:.3g} from traction" in note


def test_an_answer_keeps_the_numbers_and_the_status_of_the_contact():
    case = random_case(97, points_of_map=32)
    cut_off = 2.0 * float(np.max(case.surface.step))
    options = {"smallest_wavelength": cut_off, "tolerance": None, "periodic": True}
    load = {"pressure": case.pressure, "speed": case.speed}
    alone = gs.solve_rough_contact(case.rubber, case.surface, **load, **options)
    model = DirectContact(**options)
    surface = Surface(None, "", measured=Measured.of(case.surface))
    answer = model.predict(case.rubber, surface, Load(case.pressure, case.speed, footprint=0.1))
    assert float(answer.total_friction) == alone.friction
    assert answer.status.values.tolist() == ["frictions disagree"]
    assert "from dissipation" in answer.attrs["notes"]


def test_frictions_that_roughly_agree_converged():
    """On four points in the smallest wave 10 to 20 % apart is usual."""
    found = solve(isotropic_map(64), tolerance=None)
    assert 0.01 < found.friction_mismatch < 0.3
    assert found.converged
    assert not any("from dissipation" in note for note in found.notes)


def test_at_rest_there_is_no_friction_to_judge():
    found = random_case(175, points_of_map=32)
    at_rest = solve(
        found.surface, rubber=found.rubber, pressure=found.pressure, speed=0.0, tolerance=None
    )
    assert at_rest.converged
