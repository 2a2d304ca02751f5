"""Flow through a gap against closed forms, an independent solution and percolation by hand."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space.regions import periodic_regions
from tests import closed_forms
from tests.half_space.rough_cases import isotropic_map, solve

SQUARE = (1e-5, 1e-5)


def gaussian_heights(points, correlation, seed):
    """Return periodic heights of unit rms with a Gaussian correlation, its length in points."""
    q = 2.0 * np.pi * np.fft.fftfreq(points)
    passed = np.exp(-((correlation * np.hypot(q[:, None], q)) ** 2) / 8.0)
    noise = np.random.default_rng(seed).standard_normal((points, points))
    z = np.fft.ifft2(passed * np.fft.fft2(noise)).real
    return (z - z.mean()) / z.std()


def test_a_parallel_gap_flows_as_reynolds_says():
    flow = gs.gap_flow(np.full((24, 16), 2e-6), spacing=(1e-5, 3e-5))
    assert flow.flow_factor == pytest.approx((1.0, 1.0), rel=1e-6)
    assert flow.percolates == (True, True)
    np.testing.assert_allclose(flow.density, 1.0, rtol=1e-6)
    seal = {"length": 2e-3, "width": 0.3, "pressure_difference": 1e6, "viscosity": 1e-3}
    expected = 0.3 * 2e-6**3 * 1e6 / (12.0 * 1e-3 * 2e-3)
    assert flow.leak_rate(**seal) == pytest.approx((expected, expected), rel=1e-6)


@pytest.mark.parametrize("amplitude", [0.3, 0.7, 0.9])
def test_a_sine_across_and_along(amplitude):
    angle = 2.0 * np.pi * np.arange(64) / 64
    gap = np.tile(1e-6 * (1.0 + amplitude * np.sin(angle)), (12, 1))
    across, along = (closed_forms.flow_factor_across, closed_forms.flow_factor_along)
    for turned, order in ((gap, 1), (gap.T, -1)):
        expected = (along(amplitude), across(amplitude))[::order]
        flow = gs.gap_flow(turned, spacing=(1e-5, 2e-5)[::order])
        assert flow.flow_factor == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(
    "ratio", [3.0, *(pytest.param(r, marks=pytest.mark.verification) for r in (4.0, 5.0)), 6.0]
)
def test_gaussian_roughness_as_patir_and_cheng(ratio):
    """Their simulations scatter by some per cent; theirs have the roughness cut at three rms."""
    factors = []
    for seed in range(3):
        gap = np.maximum(ratio + np.maximum(gaussian_heights(192, 5.0, seed), -3.0), 0.0)
        factors += gs.gap_flow(gap * 1e-6, spacing=SQUARE).flow_factor
    assert np.mean(factors) == pytest.approx(closed_forms.patir_cheng_flow_factor(ratio), rel=0.05)


def dense_flow_factor(gap):
    """Return the flow factor along x by elimination of all nodes, cell by cell."""
    nx, ny = gap.shape
    cubed = (gap / gap.mean()) ** 3
    matrix, right = np.zeros((gap.size, gap.size)), np.zeros(gap.size)
    faces = []
    for i in range(nx):
        for j in range(ny):
            for along, (k, m) in enumerate((((i + 1) % nx, j), (i, (j + 1) % ny))):
                a, b = cubed[i, j], cubed[k, m]
                c = 2.0 * a * b / (a + b) if a + b > 0.0 else 0.0
                p, q, jump = i * ny + j, k * ny + m, float(along == 0)
                faces.append((p, q, c, jump))
                matrix[[p, q], [p, q]] += c
                matrix[[p, q], [q, p]] -= c
                right[[p, q]] += [c * jump, -c * jump]
    pressure = np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
    return float(sum(c * jump * (pressure[q] - pressure[p] + jump) for p, q, c, jump in faces)) / (
        gap.size
    )


def test_a_gap_with_contacts_against_elimination():
    heights = gaussian_heights(24, 4.0, 5)
    for level in (0.6, 0.2):
        gap = np.maximum(level - heights, 0.0)
        flow = gs.gap_flow(gap, spacing=(1.0, 1.0))
        assert flow.flow_factor[0] == pytest.approx(dense_flow_factor(gap), rel=1e-5, abs=1e-9)


def test_regions_that_meet_their_image():
    """A diagonal path percolates along both axes; a path that ends at itself along none."""
    ring = np.zeros((8, 8), dtype=bool)
    ring[2:6, 2:6], ring[3:5, 3:5] = True, False
    stair = np.eye(8, dtype=bool) | np.roll(np.eye(8, dtype=bool), 1, axis=1)
    row = np.zeros((8, 8), dtype=bool)
    row[:, 3] = True
    twice = np.zeros((8, 8), dtype=bool)  # along x twice before it closes
    twice[:, [1, 5]] = True
    twice[7, 1:6] = twice[0, 1:6] = True
    cases = ((ring, [False, False]), (stair, [True, True]), (row, [True, False]))
    for mask, expected in (*cases, (twice, [True, False])):
        regions = periodic_regions(mask)
        assert regions.percolates.tolist() == [expected]
    across_corner = np.roll(ring, (4, 4), (0, 1))
    assert np.bincount(periodic_regions(across_corner).labels.ravel()).tolist() == [52, 12]


def test_nothing_flows_without_a_path():
    gap = np.full((16, 16), 1e-6)
    gap[:, 5] = 0.0
    flow = gs.gap_flow(gap, spacing=SQUARE)
    assert flow.percolates == (True, False)
    assert flow.flow_factor[1] == 0.0
    assert flow.junction[1] is None
    assert str(flow).splitlines()[-1].endswith("no open path, flow factor 0")
    assert gs.gap_flow(np.zeros((8, 8)), spacing=SQUARE).flow_factor == (0.0, 0.0)


def test_the_critical_junction_is_the_widest_hole_in_a_wall():
    gap = np.full((32, 32), 5e-6)
    gap[20] = 0.0
    gap[20, 8:11] = 2e-6
    gap[20, 25] = 3e-6
    junction = gs.gap_flow(gap, spacing=(1e-5, 2e-5)).junction[0]
    assert (junction.x, junction.y) == pytest.approx((20 * 1e-5, 25 * 2e-5))
    assert junction.gap == pytest.approx(3e-6)


def test_a_contact_and_its_gap_have_the_same_flow():
    contact = solve(isotropic_map(64, shortest=1.6e-3), pressure=4e4, tolerance=None)
    flow = gs.gap_flow(contact)
    again = gs.gap_flow(contact.gap, spacing=contact.grid.spacing)
    assert flow.flow_factor == again.flow_factor
    data = flow.to_dataset()
    assert data.flow_factor.values == pytest.approx(flow.flow_factor)
    assert data.fluid_pressure.attrs["units"] == "1"
    inside = flow.pressure[0][~np.isnan(flow.pressure[0])]
    assert -0.5 < inside.min() < inside.max() < 1.5
    assert len(flow.plot().axes) >= 2


@pytest.mark.parametrize(
    ("gap", "spacing", "words"),
    [
        (np.ones(8), SQUARE, "two axes"),
        (np.full((8, 8), -1e-6), SQUARE, "64 missing, infinite or negative"),
        (np.full((8, 8), np.nan), SQUARE, "64 missing"),
        (np.ones((8, 8)), None, "spacing"),
        (np.ones((8, 8)), (1e-5,), "spacing"),
    ],
)
def test_bad_gaps_are_refused(gap, spacing, words):
    with pytest.raises(gs.InputError, match=words):
        gs.gap_flow(gap, spacing=spacing)


def test_a_line_has_no_flow():
    x = np.arange(256) * 1e-5
    profile = gs.Profile(x, 1e-5 * np.cos(2.0 * np.pi * x / 2.56e-3))
    with pytest.raises(gs.InputError, match="of a map"):
        gs.gap_flow(solve(profile, tolerance=None))
