"""A design is solved into one Dataset: missing, refused and repeated points, what sizes differ."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.experiment import Bench, Design, Point, Store, Task, solve_design
from gripscale.experiment.design import stack
from gripscale.model import Load, Model, predicted_answer
from gripscale.surface import Surface

SURFACE = Surface(gs.SineStack(wavelength=[1e-2], amplitude=[1e-4]), "one wave")
RUBBER = gs.rubber.styrene_butadiene()
LOAD = Load(3e5, 0.3, 0.1)


@dataclass(frozen=True)
class Amontons(Model):
    """Friction that is a number times the pressure."""

    factor: float
    name = "amontons"
    needs = frozenset({"waves"})

    def predict(self, rubber, surface, load, **_):
        mu = self.factor * load.pressure
        totals = dict.fromkeys(("total_friction", "total_friction_from_dissipation"), mu)
        totals["total_contact_fraction"] = 0.1
        waves = xr.Dataset({"part": ("wave", np.arange(int(self.factor)))})
        return predicted_answer(waves, totals, "converged", self.name, load)


def task(factor, pressure=1.0):
    return Task(RUBBER, SURFACE, replace(LOAD, pressure=pressure), Amontons(factor))


@pytest.fixture
def seen():
    return []


@pytest.fixture
def bench(tmp_path, seen):
    return Bench(Store(tmp_path), workers=1, on_task=seen.append)


def test_points_are_solved_once_and_labelled(bench, seen):
    points = [
        Point((0, 0), "first", task(1.0)),
        Point((0, 1), "second", task(2.0)),
        Point((1, 0), "first again", task(1.0)),
    ]
    coords = {"pressure": ("pressure", [1.0, 2.0], {"units": "Pa"})}
    design = Design({"pressure": 2, "draw": 2}, points, coords, {(1, 1): "no room for waves"})
    data = solve_design(design, bench)
    assert [progress.label for progress in seen] == ["first", "second"]
    assert [progress.total for progress in seen] == [2, 2]
    assert data.total_friction.dims == ("pressure", "draw")
    np.testing.assert_array_equal(data.total_friction, [[1.0, 2.0], [1.0, np.nan]])
    assert data.prediction_status.values.tolist()[1] == ["converged", "no room for waves"]
    assert data.prediction_status_word.values.tolist()[1] == ["converged", ""]
    assert data.prediction_key.values[0, 0] == data.prediction_key.values[1, 0] == task(1.0).key
    assert data.pressure.attrs["units"] == "Pa"
    assert (data.seconds.values[0] > 0.0).all()
    assert float(data.total_friction.mean("draw")[1]) == 1.0


def test_a_point_that_is_missing_has_no_status(bench):
    data = solve_design(Design({"draw": 2}, [Point((1,), "only", task(1.0))]), bench)
    assert data.prediction_status.values.tolist() == ["", "converged"]
    assert np.isnan(data.total_friction[0])


def test_what_is_picked_is_padded(bench):
    points = [Point((at,), str(at), task(float(at + 1))) for at in range(3)]
    pick = lambda found, _: found[["part", "prediction_status"]]  # noqa: E731
    data = solve_design(Design({"draw": 3}, points), bench, pick)
    status = {"prediction_status", "prediction_status_word"}
    assert set(data) == {"part", *status, "prediction_key", "seconds"}
    nan = np.nan
    np.testing.assert_array_equal(data.part, [[0, nan, nan], [0, 1, nan], [0, 1, 2]])


def test_a_second_time_nothing_is_solved(bench, seen):
    design = Design({"draw": 1}, [Point((0,), "only", task(1.0))])
    first, second = (solve_design(design, bench) for _ in range(2))
    assert [progress.stored for progress in seen] == [False, True]
    assert second.identical(first)


def test_parts_are_aligned_by_their_coordinates():
    parts = {
        (0,): xr.Dataset({"y": ("decade", [1.0, 2.0])}, {"decade": [-1, 0]}),
        (1,): xr.Dataset({"y": ("decade", [3.0]), "text": "words"}, {"decade": [2]}),
    }
    data = stack(parts, {"speed": 2})
    assert data.decade.values.tolist() == [-1, 0, 2]
    np.testing.assert_array_equal(data.y, [[1.0, 2.0, np.nan], [np.nan, np.nan, 3.0]])
    assert data.text.values.tolist() == ["", "words"]
