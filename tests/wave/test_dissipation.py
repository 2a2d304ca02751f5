"""Friction from the energy lost where the mesh is too coarse, and the doubt that tells of it."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.wave import SampledProfile, Status
from tests.verification.families import tread
from tests.verification.profiles import road_windows, sums_of_sines

STEEP = {"wavelength": 180e-6, "amplitude": 111e-6, "pressure": 14.95e6, "load_time": 1.326e-3}


def test_dissipation_on_a_mesh_too_coarse_keeps_sign_and_size():
    """Stretches to 4: friction 0.407, and 0.389 on four times the columns.

    As work on the derivative of the strain along x it was -19 here, and 16.6 on 128 columns.
    """
    one = gs.solve_scale(tread(), **STEEP, speed=0.3, columns=64, rows=12)
    assert one.converged
    assert 1.0 < one.friction_from_dissipation / one.friction < 1.6
    assert one.why.startswith("converged, but the two frictions, 0.407 from traction and 0.60")


@pytest.fixture(scope="module")
def plain():
    return gs.solve_scale(
        tread(), wavelength=1e-3, amplitude=1e-4, pressure=2e6, speed=0.3, columns=32, rows=8
    )


def test_frictions_within_five_per_cent_are_no_doubt(plain):
    nearly = replace(plain, friction_from_dissipation=0.951 * plain.friction)
    assert plain.doubt == nearly.doubt == ""
    assert nearly.why == "converged"


def test_frictions_apart_are_a_doubt_unless_nothing_slides_or_is_solved(plain):
    apart = replace(plain, friction=0.1, friction_from_dissipation=0.0949)
    sentence = (
        "the two frictions, 0.1 from traction and 0.0949 from dissipation, differ: "
        "more columns are needed"
    )
    assert apart.doubt == sentence
    assert apart.why == f"converged, but {sentence}"
    where = replace(apart, details={"contact_slope": 2.62})
    assert "differ with contact on slopes up to 2.6: more" in where.doubt
    assert replace(apart, speed=0.0).doubt == ""
    failed = replace(apart, status=Status.FOLD)
    assert failed.doubt == ""
    assert failed.why == "fold in the load path at 100 % of the pressure"


@pytest.mark.parametrize("points", [8, 9, 48])
def test_the_slope_of_sampled_heights_is_that_of_the_sine(points):
    angle = 2.0 * np.pi * np.arange(points) / points
    profile = SampledProfile(0.2, np.cos(angle) - 0.3 * np.sin(2.0 * angle))
    x = np.linspace(-0.1, 0.3, 23)
    turn = 2.0 * np.pi / 0.2
    expected = -turn * (np.sin(turn * x) + 0.6 * np.cos(2.0 * turn * x))
    np.testing.assert_allclose(profile.slope(x), expected, atol=1e-11 * turn)


def test_the_slope_in_contact_is_told():
    """A crest touched symmetrically, as nothing slides: sin of half the contact, to a column."""
    x = 1e-3 * np.arange(48) / 48
    sine = gs.Profile(x, 1e-4 * np.cos(2.0 * np.pi * x / 1e-3))
    one = gs.solve_profile(tread(), sine, periodic=True, pressure=3e5, speed=0.0, columns=128)
    steepest = 2.0 * np.pi * 0.1
    expected = steepest * np.sin(np.pi * one.contact_fraction)
    assert one.details["contact_slope"] == pytest.approx(expected, abs=steepest * 2 * np.pi / 128)
    assert one.details["contact_slope"] < steepest


@pytest.mark.parametrize("case", sums_of_sines(8)[2:5], ids=lambda case: case.name)
def test_a_random_sum_of_sines_is_near_the_half_plane(case):
    """Slopes to 0.7 in contact: finite strain is worth 5 %, the mesh the rest."""
    one, plane = case.solve(), case.half_plane()
    assert one.why == "converged"
    assert one.friction_mismatch < 0.03
    assert one.friction_from_dissipation == pytest.approx(plane.friction, rel=0.06)


def test_a_window_of_the_road_is_near_the_half_plane():
    """A gentle one, slopes to 0.3 in contact, down to 2 mm."""
    case = road_windows(0, 2e-3)[0]
    one, plane = case.solve(), case.half_plane()
    assert one.why == "converged"
    assert one.friction_mismatch < 0.03
    assert one.friction == pytest.approx(plane.friction, rel=0.03)
