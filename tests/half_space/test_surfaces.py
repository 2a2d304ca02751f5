"""Measured surfaces made periodic: gaps, ends, cut-off, any size, windows; and synthetic ones."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.half_space import one_period, spread_windows, surface_of_sines, windows
from gripscale.half_space.grid import joined, periodic_heights
from gripscale.surface import HeightMap, Profile, SineStack, self_affine_profile

from .rough_cases import ZENER, isotropic_heights, isotropic_map, solve

LINE = self_affine_profile(0.8, 5e-3, 1e-3, 0.2, 1e-4, seed=4)


def test_ends_of_a_line_are_joined_by_a_straight_line():
    z = joined(LINE.z)
    taken = LINE.z - z
    assert np.ptp(np.diff(taken)) < 1e-9 * np.ptp(LINE.z)
    assert abs(z[0] - z[-1]) <= 1.5 * np.abs(np.diff(LINE.z)).max()


def test_a_tilt_of_a_map_is_taken_out_and_the_middle_is_left():
    surface = isotropic_map(64)
    tilted = surface.z + 0.05 * surface.x[:, None] - 0.02 * surface.y[None, :]
    change = joined(tilted) - (surface.z - surface.z.mean())
    assert np.abs(change[16:48, 16:48]).max() < 0.1 * surface.z.std()


def test_the_way_ends_are_joined_does_not_matter():
    """Mirrored, the line repeats without a jump; half of it slides backwards, so at rest. Contact
    fraction 0.07 from some ten asperities a side: the ends are one of them."""
    load = {"rubber": ZENER, "speed": 0.0, "pressure": 5e4, "smallest_wavelength": 1e-3}
    plain = solve(LINE, periodic=False, **load)
    double = np.concatenate((LINE.z, LINE.z[::-1]))
    mirror = solve(Profile(np.arange(double.size) * LINE.step, double), **load)
    assert plain.contact_fraction == pytest.approx(mirror.contact_fraction, rel=0.1)


def test_the_cut_off_transmits_half_of_its_wave_whatever_the_direction():
    """ISO 16610-61: exp(-ln 2 (cut-off / wavelength)^2) of each wave that the grid carries."""
    surface, cut_off = isotropic_map(64, shortest=8e-4), 3.2e-3
    heights = periodic_heights(surface, smallest_wavelength=cut_off, periodic=True)
    there = np.fft.rfft2(heights.on((64, 64)))
    before = np.fft.rfft2(surface.z)
    inside = (heights.grid.wavenumber > 0.0) & (heights.grid.wavenumber < np.pi / 4e-4)
    share = np.abs(there[inside]) / np.abs(before[inside])
    expected = 2.0 ** -((heights.grid.wavenumber[inside] * cut_off / (2.0 * np.pi)) ** 2)
    big = np.abs(before[inside]) > 1e-6 * np.abs(before).max()
    np.testing.assert_allclose(share[big], expected[big], rtol=1e-9, atol=1e-12)


def test_any_number_of_points_will_do():
    """The same three waves sampled in several ways: the same contact, to the linear solver."""
    found = []
    for points in (256, 127, 128, 131):
        x = np.arange(points) * 0.02 / points
        z = sum(1e-4 / n * np.cos(2 * np.pi * n * x / 0.02 + n) for n in (1, 3, 7))
        found.append(solve(Profile(x, z), smallest_wavelength=1e-3, tolerance=None))
        assert found[-1].friction == pytest.approx(found[0].friction, rel=1e-4)
        assert found[-1].grid.shape == found[0].grid.shape


def test_contact_on_missing_heights_is_counted():
    x = np.arange(512) * 1e-4
    z = 1e-4 * np.cos(2 * np.pi * x / x.size * 1e4 * 4)
    whole = Profile(x, z)
    holes = Profile(x, np.where(z < -0.9e-4, np.nan, z))
    tops = Profile(x, np.where((x < 0.0128) & (z > 0.9e-4), np.nan, z))
    load = {"pressure": 1e4, "smallest_wavelength": 2e-3}
    assert solve(whole, **load).missing_share == 0.0
    assert solve(holes, **load).missing_share == 0.0
    # one top of four, made flat and so carrying less than the others
    assert 0.1 < solve(tops, **load).missing_share < 0.3


@pytest.mark.parametrize(
    ("missing", "share", "area", "friction"),
    [("valleys", 0.0, 0.03, 0.01), ("single", 0.1, 0.05, 0.03)],
)
@pytest.mark.parametrize("seed", [3, 5])
def test_a_tenth_of_a_map_missing_changes_little(missing, share, area, friction, seed):
    """Valleys, where dropouts are, carry no load; single points a tenth of it. Of four maps area
    changed by up to 2 and 3.4 %, friction by up to 0.2 and 2.3 %."""
    surface = isotropic_map(64, seed=seed)
    deep = surface.z < np.quantile(surface.z, 0.1)
    gaps = deep if missing == "valleys" else np.random.default_rng(seed).random((64, 64)) < 0.1
    holed = HeightMap(surface.x, surface.y, np.where(gaps, np.nan, surface.z))
    load = {"smallest_wavelength": 1.6e-3, "tolerance": None, "pressure": 1e5}
    whole, found = solve(surface, **load), solve(holed, **load)
    assert found.missing_share == pytest.approx(share, abs=0.04)
    assert found.contact_fraction == pytest.approx(whole.contact_fraction, rel=area)
    assert found.friction == pytest.approx(whole.friction, rel=friction)


def test_windows_leave_out_what_is_mostly_missing():
    z = LINE.z.copy()
    z[:200] = np.nan
    pieces = windows(Profile(LINE.x, z), 0.02)
    assert len(pieces) == 9
    assert pieces[0].x[0] == pytest.approx(LINE.x[200])
    surface = isotropic_map(64)
    assert [piece.z.shape for piece in windows(surface, 0.0128)] == [(32, 64), (32, 64)]
    with pytest.raises(InputError, match=r"length must be from 0\.0016 m"):
        windows(LINE, 1.0)


def test_windows_of_a_map_along_both_ways():
    z = isotropic_heights(64)
    z[:16, 40:] = np.nan
    surface = HeightMap(np.arange(64) * 4e-4, np.arange(64) * 2e-4, z, name="slab")
    pieces = windows(surface, (16 * 4e-4, 20 * 2e-4))
    assert [piece.z.shape for piece in pieces] == [(16, 20)] * 11  # 4 x 3, one of them empty
    assert pieces[1].y[0] == pytest.approx(22 * 2e-4)
    np.testing.assert_array_equal(pieces[-1].z, z[48:, 42:62])
    with pytest.raises(InputError, match="one of a profile, one or two of a map; got"):
        windows(LINE, (0.02, 0.02))
    with pytest.raises(InputError, match="leaves no window with half of its heights"):
        windows(HeightMap(surface.x, surface.y, np.where(np.eye(64) > 0, z, np.nan)), 6.4e-3)


def test_surface_of_sines_has_their_slopes():
    stack = SineStack([0.01, 0.003], [1e-3, 2e-4])
    surface = surface_of_sines(stack, 0.05, seed=2)
    spectrum = 2 * np.abs(np.fft.rfft(surface.z)) / len(surface)
    counts = np.flatnonzero(spectrum > 1e-12)
    np.testing.assert_array_equal(counts, [5, 17])
    np.testing.assert_allclose(spectrum[counts] * counts / 0.05, stack.amplitude / stack.wavelength)
    with pytest.raises(InputError, match="length must be at least the largest wavelength"):
        surface_of_sines(stack, 0.005, seed=1)


# Windows of a profile, spread over it and made one period.


def test_one_period_is_what_the_direct_contact_sees():
    period = one_period(LINE, 2e-3)
    there = periodic_heights(LINE, smallest_wavelength=2e-3, periodic=False)
    here = periodic_heights(period, smallest_wavelength=None, periodic=True)
    assert here.grid.lengths == pytest.approx(there.grid.lengths, rel=1e-12)
    # but for waves below half the cut-off, of which 1/16 is left: the period has no points for them
    np.testing.assert_allclose(here.on((800,)), there.on((800,)), atol=1e-2 * np.ptp(LINE.z))


def test_windows_are_spread_over_all_profiles():
    other = Profile(LINE.x + 1.0, LINE.z)
    found = spread_windows([LINE, other], 0.02, 5)
    assert len(found) == 5
    assert found[0].x[0] < 0.02
    assert found[-1].x[0] > 1.15
    assert len(spread_windows([LINE], 0.02, 1000)) == 10


@pytest.mark.parametrize("most", [0, 2.5])
def test_the_number_of_windows_is_a_whole_one(most):
    with pytest.raises(InputError, match="most"):
        spread_windows([LINE], 0.02, most)
