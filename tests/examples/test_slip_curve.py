"""Braking force over slip of a short piece of road: table, intervals, distances, formulas."""

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from examples.slip_curve import friction_table, question
from examples.slip_curve.__main__ import main
from examples.slip_curve.brush import Brush
from examples.slip_curve.friction_table import AXES, FORMULAS, TABLE, TableFriction
from gripscale.core.errors import InputError
from gripscale.half_space.model import DirectContact
from tests.questions.answer.test_answer_object import CASE

INTERFACE = '\n[conditions.shear_stress]\nkind = "constant"\nstress_0 = "6 MPa"\n'
DRY, WET = (1.2801, 23.99, 0.52), (0.857, 33.82, 0.347)
"""Burckhardt's parameters of a tyre on dry and on wet asphalt."""
SLIPS = np.geomspace(0.003, 1.0, 30)


@pytest.fixture(scope="module", autouse=True)
def _few_speeds():
    """Half the speeds of a table, and half the contacts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(friction_table, "_SPEEDS", 3)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a case and the results of its command."""
    folder = tmp_path_factory.mktemp("slip")
    (folder / "case.toml").write_text(CASE + INTERFACE, encoding="utf-8")
    main(folder / "case.toml", output=folder / "slip")
    return folder


@pytest.fixture(scope="module")
def case(folder):
    """The case, read once: its road is cleaned and its master curve fitted in seconds."""
    return gs.read_case(folder / "case.toml")


@pytest.fixture
def curve(folder):
    return gs.load(folder / "slip" / "slip.nc")


def test_python_has_the_curves_of_the_command_from_its_table(case, folder, curve, monkeypatch):
    """From the stored table nothing is solved again."""

    def refuse(*_, **__):
        raise AssertionError("solved again")

    monkeypatch.setattr(DirectContact, "predict", refuse)
    again = question.slip_curve(case, folder=folder / "slip")
    xr.testing.assert_equal(again.data.force, curve.data.force)
    assert str(again.lines[0]).startswith("Answer: peak braking force")
    assert str(again) == str(curve)
    assert {"slip.nc", "slip.png", "report.html"} <= {p.name for p in (folder / "slip").iterdir()}


def test_curves_lie_within_their_bands(curve):
    """The area term adds friction; a higher friction brakes in a shorter distance."""
    low, value, high = (curve.data.force.sel(bound=bound) for bound in ("low", "value", "high"))
    assert (low <= value).all()
    assert (value <= high).all()
    assert (high > 1.1 * low).any()
    hysteresis, both = (curve.data.sel(kind=kind) for kind in ("hysteresis", "with area term"))
    assert (both.locked > hysteresis.locked).all()
    assert (both.braking_distance < hysteresis.braking_distance).all()
    distance = curve.data.braking_distance
    assert (distance.sel(bound="low") < distance.sel(bound="high")).all()
    # k L/(2 p_0) at small slip, less by half of sigma/sigma*, as in the closed form
    force, slip = float(both.force.sel(bound="value")[0, 0, 0]), float(curve.data.slip[0])
    stuck = question.STIFFNESS * 0.1 / (2.0 * 3e5) * slip / (1.0 - slip)
    assert 0.7 * stuck < force < stuck


def test_locked_wheel_has_the_friction_of_the_road_speed(curve):
    """Weighed by the parabola of the pressure, with mu linear in ln p within the table's ends.

    These ends are kinks along the patch: 12 points of quadrature are within 3e-4.
    """
    data = curve.data
    pressure = data.local_pressure.values
    y = (np.arange(4000) + 0.5) / 4000
    weight = 6.0 * y * (1.0 - y)
    local = np.clip(weight * 3e5, *pressure)
    table = data[TABLE].isel(kind=0, bound=1, rubber_temperature=0)
    at_speed = [
        np.interp(np.log(80 / 3.6), np.log(data.sliding_speed), row) for row in table.values.T
    ]
    friction = np.interp(np.log(local), np.log(pressure), at_speed)
    locked = float(data.locked.isel(kind=0, bound=1, temperature=0, speed=0))
    assert locked == pytest.approx(float((weight * friction).mean()), rel=3e-4)


def test_braking_distance_of_constant_friction():
    """(v_1^2 - v_2^2)/(2 g mu); the peak of a constant friction is its plateau.

    The cubics overshoot by some 1 % where the plateau begins.
    """
    shape = (1, 3, 2, 1, 2)
    values = np.full(shape, 0.8) * np.array([0.5, 1.0, 2.0]).reshape(1, 3, 1, 1, 1)
    coords = dict(zip(AXES, ([0.1, 10.0], [293.0], [1e5, 4e5]), strict=True))
    named = {"kind": ["hysteresis"], "bound": ["low", "value", "high"], **coords}
    table = xr.Dataset({TABLE: (("kind", "bound", *AXES), values)}, named)
    speeds = 80 / 3.6, 20 / 3.6
    brush = Brush(0.1, 3e5, question.STIFFNESS)
    data = question._curves(brush, table, np.array([293.0]), [20.0], SLIPS, speeds)
    expected = (speeds[0] ** 2 - speeds[1] ** 2) / (2.0 * 9.80665 * 0.8)
    found = data.braking_distance.isel(kind=0, temperature=0)
    assert found.sel(bound="value", brake="locked") == pytest.approx(expected, rel=1e-6)
    assert found.sel(bound="low", brake="locked") == pytest.approx(0.5 * expected, rel=1e-6)
    assert found.sel(bound="value", brake="peak") == pytest.approx(expected, rel=2e-2)


def test_table_is_read_between_its_points_and_kept_beyond():
    speed, kelvin, pressure = [0.01, 1.0], [280.0, 320.0], [1e5, 4e5]
    grid = np.meshgrid(np.log(speed), kelvin, np.log(pressure), indexing="ij")
    values = 0.5 + 0.02 * grid[0] - 0.003 * (grid[1] - 300.0) + 0.01 * (grid[2] - np.log(1e5))
    coords = dict(zip(AXES, (speed, kelvin, pressure), strict=True))
    table = xr.DataArray(values[None, None], coords, ("kind", "bound", *AXES))
    friction = TableFriction(table, np.array([290.0, 300.0]))
    at = [np.full((1, 1, 1), x) for x in (0.1, 2e5, 10.0)]
    expected = 0.5 + 0.02 * np.log(0.1) + 0.01 * np.log(2.0)
    assert friction(*at).ravel() == pytest.approx([expected, expected - 0.03])
    beyond = [np.full((1, 1, 1), x) for x in (1e-6, 1e9, 500.0)]
    corner = 0.5 + 0.02 * np.log(0.01) - 0.06 + 0.01 * np.log(4.0)
    assert friction(*beyond).ravel() == pytest.approx([corner, corner])


def test_a_table_without_an_interval_has_its_value():
    """The ends are unknown; the value between them is not touched by it."""
    coords = dict(zip(AXES, ([0.1, 10.0], [293.0], [1e5, 4e5]), strict=True))
    values = np.full((1, 3, 2, 1, 2), 0.5)
    values[:, [0, 2]] = np.nan
    table = xr.DataArray(values, coords, ("kind", "bound", *AXES))
    at = [np.full((1, 1, 1), x) for x in (1.0, 2e5, 0.0)]
    low, value, high = TableFriction(table, np.array([293.0]))(*at).ravel()
    assert value == 0.5
    assert np.isnan([low, high]).all()


@pytest.mark.parametrize("parameters", [DRY, WET])
def test_formulas_are_found_again(parameters):
    """The Magic Formula follows Burckhardt's curves within 3 % of the peak, rms."""
    burckhardt, magic = FORMULAS["burckhardt"], FORMULAS["magic_formula"]
    force = burckhardt.function(SLIPS, *parameters)
    *found, misfit = burckhardt.fit(SLIPS, force)
    assert found == pytest.approx(parameters, rel=1e-4)
    assert misfit < 1e-6
    assert magic.fit(SLIPS, force)[-1] < 0.03
    assert magic.fit(SLIPS, magic.function(SLIPS, 12.0, 1.6, 1.0, 0.3))[-1] < 1e-3


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"slip": [0.1, 0.2]}, "slip must have at least 5 rising values"),
        ({"slip": [0.1, 0.2, 0.3, 0.4, 1.2]}, "up to 1"),
        ({"speed": 0.0}, "speed must be above zero"),
        ({"braking": ("20 km/h", "80 km/h")}, "from a higher to a lower speed"),
        ({"braking": ("80", "20 km/h")}, "the unit is missing"),
        ({"stiffness": -1.0}, "stiffness must be greater than zero"),
        ({"temperature": "40 C"}, "time-temperature shift is missing"),
    ],
)
def test_options_that_cannot_be_used_are_refused(case, options, words):
    with pytest.raises(InputError, match=words):
        question.slip_curve(case, **options)
