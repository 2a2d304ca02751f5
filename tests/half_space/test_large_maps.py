"""What large maps are solved by: single precision, waves in parts, a grid kept in a file."""

import time

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.half_space import grid
from gripscale.half_space.grid import Grid, points_in_memory
from gripscale.half_space.response import half_space
from gripscale.theory.layers import Layers
from tests.samples import MAXWELL, SHIFTED_RUBBER, THERMAL

from .rough_cases import ZENER, isotropic_map, solve

FOLDER_FILE = "grid.npz"


@pytest.mark.parametrize("speed", [0.0, 0.3])
def test_single_precision_moves_numbers_less_than_their_errors(speed, monkeypatch):
    """A tenth of the error of the area, a thousandth of that of the friction; the loads agree."""
    double = solve(isotropic_map(256), speed=speed, tolerance=None)
    monkeypatch.setattr(grid, "SINGLE_FROM", 128**2)
    single = solve(isotropic_map(256), speed=speed, tolerance=None)
    assert double.pressure.dtype == np.float64
    for values in (single.pressure, single.gap, single.height):
        assert values.dtype == np.float32
    assert single.converged
    moved = abs(single.contact_fraction - double.contact_fraction)
    assert 0.0 < moved < 0.1 * double.contact_fraction_error
    if speed > 0.0:
        for name in ("friction", "friction_from_dissipation"):
            moved = abs(getattr(single, name) - getattr(double, name))
            assert 0.0 < moved < 1e-3 * double.friction_error
    assert single.residuals["load"] < 1e-6
    assert single.grids[0].contact_fraction == double.grids[0].contact_fraction


@pytest.mark.parametrize(
    ("rubber", "thickness"),
    [(MAXWELL, None), (MAXWELL, 5e-3), (Layers([(MAXWELL, 2e-3), (ZENER, 4e-3)]), None)],
)
def test_waves_in_parts_are_those_of_the_whole(rubber, thickness, monkeypatch):
    body, where = half_space(rubber, 0.3, thickness), Grid((48, 30), (0.02, 0.0125))
    whole = body.compliance(where)
    monkeypatch.setattr(grid, "_PART", 100)
    assert len(list(where.parts())) == 8
    np.testing.assert_array_equal(body.compliance(where), whole)
    assert whole[0, 0] == 0.0
    assert np.count_nonzero(whole == 0.0) == 1


def test_what_was_stopped_resumes_to_the_last_bit(tmp_path, monkeypatch):
    """The time ends on the third of four grids; the same call then solves the last two alone."""
    whole, before, seen = solve(isotropic_map(128), tolerance=None), [], []
    with monkeypatch.context() as patch:
        patch.setattr(time, "monotonic", lambda: 2.0 if len(before) == 2 else 0.0)
        limited = {"time_limit": 1.0, "folder": tmp_path, "on_grid": before.append}
        stopped = solve(isotropic_map(128), tolerance=None, **limited)
    assert stopped.status == "time limit"
    assert (tmp_path / FOLDER_FILE).exists()
    resumed = solve(isotropic_map(128), tolerance=None, folder=tmp_path, on_grid=seen.append)
    assert seen == whole.grids[2:]
    assert resumed.grids == whole.grids
    np.testing.assert_array_equal(resumed.pressure, whole.pressure)
    assert not (tmp_path / FOLDER_FILE).exists()


def test_the_grid_of_another_problem_is_not_taken(tmp_path):
    np.savez(tmp_path / FOLDER_FILE, key="another problem")
    surface, seen = isotropic_map(64), []
    found = solve(surface, tolerance=None, folder=tmp_path, on_grid=seen.append)
    assert seen == found.grids == solve(surface, tolerance=None).grids


def test_conditions_keep_no_grid(tmp_path):
    warm = {"conditions": Conditions(heat=THERMAL), "footprint": 0.1, "folder": tmp_path}
    with pytest.raises(gs.InputError, match="folder must be None with softening or heat"):
        solve(isotropic_map(32), rubber=SHIFTED_RUBBER, **warm)


def test_a_map_may_fill_half_of_the_memory():
    line, square = Grid((64,), (0.01,)), Grid((64, 64), (0.01, 0.01))
    assert points_in_memory(line) == grid.MOST_POINTS
    assert points_in_memory(square) >= grid.MOST_POINTS
