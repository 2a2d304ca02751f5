"""Parts of the direct contact on their own: linear system, grids, area, estimated errors."""

import dataclasses
import math

import numpy as np
import pytest
import scipy.fft

import gripscale as gs
from gripscale._kernel import GapExtension
from gripscale.half_space import active_set
from gripscale.half_space.active_set import CONTACT_REACH, FAR, LOSSY
from gripscale.half_space.grid import Grid, resampled
from gripscale.half_space.grid_sequence import GridRecord, errors, grid_contact_fraction
from gripscale.half_space.response import HalfSpace, Response
from gripscale.surface import self_affine_profile

from .rough_cases import ZENER, isotropic_map, lossy, on_grid

TWO_CONTACTS = np.array([True, True, False, False, False, True, False, True])
RECORD = GridRecord(64, 1e-3, 0.1, 0.0, 0.05, 0.05, 5, 50, True, False, 400)


def records(*changes):
    return [dataclasses.replace(RECORD, **change) for change in changes]


def test_iterations_and_elimination_close_the_same_gap(monkeypatch):
    """Elimination is exact; iterations stop at a missing pressure of 1e-6, of which the solution
    may be off by a few times as much."""
    grid = Grid((32, 32), (0.0256, 0.0256))
    response = Response.of(HalfSpace(ZENER, 0.3), grid, 1)
    height = isotropic_map(32, shortest=3.2e-3).z.reshape(-1)
    where = np.flatnonzero(height > np.quantile(height, 0.6))
    start = np.full(len(where), 1e5)

    def lift(pressure):
        full = np.zeros(grid.points)
        full[where] = pressure
        return response.displacement(full.reshape(grid.shape)).reshape(-1)

    def closed(*, check=True):
        gap = lift(start) - height
        return active_set.close_gap(response, where, gap, start, 1e-6, check=check), gap

    iterated, _ = closed()
    monkeypatch.setattr(active_set, "_SHORTEST", 1)
    direct, left = closed()
    assert direct.products == 2
    assert iterated.products > 5
    assert direct.pressure.sum() == pytest.approx(start.sum(), rel=1e-9)
    size = np.abs(direct.pressure).max()
    assert np.abs(iterated.pressure - direct.pressure).max() < 1e-4 * size
    assert closed(check=False)[0].missing < 1e-6
    gap = lift(direct.pressure) - height
    assert np.ptp(gap[where]) < 1e-9 * np.ptp(height)
    np.testing.assert_allclose(left, gap, atol=1e-12 * np.ptp(height))


def extended_on(line, gaps, reach=None):
    """The gaps of the points of a line in contact, over the line."""
    values = np.zeros(line.size, dtype=np.float32)
    values[line] = gaps
    GapExtension.of_line(line, reach).extend(values)
    return values


def test_a_gap_of_a_line_is_a_harmonic_function():
    """A half-plane with the values 2 and 3 on the contacts beside a gap, and zero in other gaps."""
    wide = np.zeros(4000, dtype=bool)
    wide[1000:1300] = wide[1500:1600] = True
    values = np.where(np.flatnonzero(wide) < 1400, 2.0, 3.0)
    extended = extended_on(wide, values, CONTACT_REACH)[1300:1500]
    # the solid angle of each contact in a strip: a conformal map takes the gap to a half-line
    centre, half = 1399.5, 100.5
    point = (np.arange(1300, 1500) - centre) / half

    def seen(length):  # the Poisson kernel of the gap, over a contact at its upper end
        at = 1.0 + np.linspace(0.0, np.sqrt(length / half), 20001)[1:] ** 2
        kernel = np.sqrt((1.0 - point[:, None] ** 2) / (at**2 - 1.0)) / (at - point[:, None])
        return np.trapezoid(kernel, at, axis=1) / np.pi if length else 0.0

    wanted = 3.0 * seen(CONTACT_REACH * 100.0) + 2.0 * seen(CONTACT_REACH * 300.0)[::-1]
    np.testing.assert_allclose(extended[5:-5], wanted[5:-5], rtol=0.01)
    line = extended_on(TWO_CONTACTS, [2.0, 3.0, 5.0, 7.0], CONTACT_REACH)
    np.testing.assert_allclose(line[TWO_CONTACTS], [2.0, 3.0, 5.0, 7.0])
    # contacts across the end of the period are one: of three points, seen over a gap of three
    first = (
        2.0
        / np.pi
        * np.arctan(
            np.sqrt(
                [
                    CONTACT_REACH * 3 / (CONTACT_REACH * 3 + 4) * 3,
                    CONTACT_REACH / (CONTACT_REACH + 4) / 3,
                ]
            )
        )
    )
    np.testing.assert_allclose(line[2], first @ [3.0, 5.0], rtol=1e-6)


def test_a_gap_is_carried_to_the_points_beside_the_contacts_of_a_map():
    """Weights 1/distance^3, and FAR of nothing beyond."""
    active = np.zeros((4, 5), dtype=bool)
    active[0, 0] = active[1, 0] = True
    extended = np.zeros(active.shape, dtype=np.float32)
    extended[0, 0], extended[1, 0] = 2.0, 3.0
    GapExtension.of_map(active, FAR).extend(extended.reshape(-1))
    assert np.count_nonzero(extended) == 12  # over both edges of the map
    wanted = (2.0 + 3.0 / 2**1.5) / (1 + 1 / 2**1.5 + FAR)
    assert extended[0, 4] == pytest.approx(wanted, rel=1e-6)  # next to (0, 0) and (1, 0)
    assert (extended[0, 0], extended[1, 0]) == (2.0, 3.0)
    with pytest.raises(ValueError, match="a value for each point"):
        GapExtension.of_map(active, FAR).extend(np.zeros(16, dtype=np.float32))


def test_a_gap_of_a_lossy_line_is_linear_between_its_ends():
    extended = extended_on(TWO_CONTACTS, [2.0, 3.0, 7.0, 9.0])
    np.testing.assert_allclose(extended, [2, 3, 4, 5, 6, 7, 8, 9], rtol=1e-6)
    np.testing.assert_allclose(extended_on(np.arange(3) == 1, [4.0]), 4.0)
    around = extended_on(np.isin(np.arange(6), [1, 4]), [1.0, 4.0])
    np.testing.assert_allclose(around, [2, 1, 2, 3, 4, 3], rtol=1e-6)
    np.testing.assert_allclose(extended_on(np.ones(3, dtype=bool), [1.0, 2.0, 3.0]), [1, 2, 3])


def test_lossy_lines_take_few_products(monkeypatch):
    """Loss angle 0.55 on a line of 16384 points; the contact does not depend on the extension."""
    rubber = lossy(0.35)
    line = self_affine_profile(0.8, 0.02, 1e-3, 0.4, 2.5e-5, seed=1)
    contacts = {}
    for limit in (LOSSY, np.inf):
        monkeypatch.setattr(active_set, "LOSSY", limit)
        contacts[limit] = gs.solve_rough_contact(
            rubber, line, pressure=2e5, speed=0.3, tolerance=None
        )
    across, around = contacts[LOSSY], contacts[np.inf]
    assert across.converged
    assert across.contact_fraction == pytest.approx(around.contact_fraction, rel=1e-4)
    assert across.friction == pytest.approx(around.friction, rel=1e-5)
    products = [sum(grid.products for grid in contact.grids) for contact in (across, around)]
    assert products[0] < 0.6 * products[1], products


@pytest.mark.parametrize(("shape", "onto"), [((48,), (75,)), ((24, 30), (45, 32)), ((30,), (20,))])
def test_resampling_is_exact_for_what_both_grids_carry(shape, onto):
    def wave(n):
        place = np.meshgrid(*(2 * np.pi * np.arange(k) / k for k in n), indexing="ij")
        return np.cos(sum((5 - 2 * i) * p for i, p in enumerate(place)) + 0.4)

    found = resampled(scipy.fft.rfftn(wave(shape)), shape, Grid(onto, (1.0,) * len(onto)))
    np.testing.assert_allclose(found, wave(onto), atol=1e-12)


@pytest.mark.verification
def test_area_of_a_map_hardly_depends_on_the_grid():
    """Four points in the smallest wave against sixteen: counted points fall by 3 to 10 %, the
    corrected fraction by less than 2 %, in the mean of four maps by less than 1 %."""
    counted, corrected = [], []
    for seed in range(4):
        surface = isotropic_map(64, shortest=1.6e-3, seed=seed)
        coarse, fine = (
            on_grid(ZENER, surface, pressure=3e5, speed=0.3, shape=(n, n), shortest=1.6e-3).record
            for n in (64, 256)
        )
        share = [grid.in_contact / n**2 for grid, n in ((coarse, 64), (fine, 256))]
        counted.append(share[0] / share[1] - 1.0)
        corrected.append(coarse.contact_fraction / fine.contact_fraction - 1.0)
    assert np.mean(counted) > 0.03
    assert np.abs(corrected).max() < 0.02
    assert abs(np.mean(corrected)) < 0.01


def test_errors_follow_from_the_changes():
    coarse, middle, fine = records(
        {"contact_fraction": 0.15, "friction": 0.02},
        {"contact_fraction": 0.11, "friction": 0.049},
        {"contact_fraction": 0.10, "friction": 0.050},
    )
    assert errors([middle, fine]) == pytest.approx((0.4 * 0.01, 0.4 * 0.001))
    # one small change may be chance: the one before it still counts
    assert errors([coarse, middle, fine]) == pytest.approx((0.16 * 0.04, 0.16 * 0.029))


def test_two_frictions_apart_and_borders_between_points_are_errors():
    same, apart, border = records({}, {"friction_from_dissipation": 0.056}, {"border_error": 0.003})
    assert errors([same, same]) == (0.0, 0.0)
    assert errors([same, apart]) == pytest.approx((0.0, 0.006 + 0.4 * 0.006))
    assert errors([same, border]) == pytest.approx((0.003, 0.0))
    assert np.isnan(errors([same])).all()


def test_borders_that_a_grid_adds_are_an_error():
    """Four times the borders: 0.5 sqrt(borders)/points stays where the points double."""
    few, many = records(
        {"border_error": 0.001}, {"border_error": 0.001, "points": 128, "contact_fraction": 0.12}
    )
    assert errors([few, many])[0] == pytest.approx(np.hypot((0.4 + 0.75) * 0.02, 0.001))


@pytest.mark.parametrize("loss_angle", [0.0, 0.8, -0.8])
def test_a_contact_ends_where_the_opening_of_lossy_rubber_begins(loss_angle):
    """A gap of (distance)^(3/2) at one end and (distance)^(3/2 + 2/pi loss angle) at the other."""
    x = np.arange(32.0)
    lower, upper = (1.5 + 2.0 / np.pi * max(0.0, side * loss_angle) for side in (-1, 1))
    gap = np.maximum(10.3 - x, 0.0) ** lower + np.maximum(x - 20.6, 0.0) ** upper
    found = grid_contact_fraction(gap == 0.0, gap, loss_angle)
    assert found == pytest.approx((20.6 - 10.3) / 32)


def test_borders_of_a_map_count_by_the_law_of_yastrebov():
    """Of a square of four points a side, with 16 pairs at its border, over the end of the map."""
    active = np.zeros((16, 16), dtype=bool)
    active[np.ix_([15, 0, 1, 2], [3, 4, 5, 6])] = True
    wanted = (16 - (math.pi - 1.0 + math.log(2.0)) / 24.0 * 16) / 256
    assert grid_contact_fraction(active, np.zeros((16, 16))) == pytest.approx(wanted, rel=1e-12)
