"""Compounds side by side: one temperature, a ranking by the answer, errors that cancel."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.conditions.conditions import TREADS
from gripscale.core.errors import InputError
from gripscale.io.table import significant
from gripscale.questions import at_one_temperature, compare_compounds
from gripscale.questions.vary.charts import ranking_figure
from gripscale.questions.vary.friction_ratio import (
    FrictionRatio,
    ratio_changes,
    series_changes,
    series_error,
)
from gripscale.rubber import WLF, MasterCurve, fit_prony
from tests.samples import HALF_PLANE, case_text, write_road

COLD, ROOM, WARM = 273.15, 293.15, 313.15


def solid(kelvin, *, shift):
    law = WLF(8.86, 101.6, reference_temperature=kelvin) if shift else None
    return gs.Rubber(2e6, [4e6], [1e-3], reference_temperature=kelvin, shift=law)


def measured(factor, noise):
    """A rubber fitted to a made-up measurement, its relaxing moduli `factor` times as large."""
    omega = np.geomspace(1e-1, 1e6, 57)
    truth = gs.Rubber(3e6, factor * np.array([2e6, 4e6, 8e6]), [1e-1, 1e-3, 1e-5])
    values = truth.complex_modulus(omega)
    scatter = np.exp(noise * np.random.default_rng(1).standard_normal((2, omega.size)))
    curve = MasterCurve(omega / 2 / np.pi, values.real * scatter[0], values.imag * scatter[1])
    return fit_prony(curve)


def changed(**changes):
    """An answer with what conditions change in its friction."""
    values = ("sample", "condition"), [[*changes.values()]]
    return xr.Dataset({"friction_condition_error": values}, {"condition": [*changes]})


def test_what_is_not_known_of_both_compounds_cancels():
    """The scatter between treads is each compound's own, all else they have in common."""
    typical, other = changed(**{TREADS: 0.2, "shear": 0.1}), changed(**{TREADS: -0.3, "shear": 0.1})
    assert ratio_changes(typical, other) == pytest.approx([0.2, -0.3, 0.0])
    own_sweeps = changed(shear=0.04)
    assert ratio_changes(typical, own_sweeps) == pytest.approx([0.2, 0.0, 0.06])
    assert ratio_changes(typical, xr.Dataset()) == pytest.approx([0.2, 0.0, 0.1])
    assert ratio_changes(xr.Dataset(), xr.Dataset()) == []


def test_a_temperature_all_can_be_brought_to():
    """That of the rubber without a shift; the other is moved by its own."""
    given = {"moved": solid(COLD, shift=True), "fixed": solid(ROOM, shift=False)}
    together, notes = at_one_temperature(given)
    assert together["fixed"] is given["fixed"]
    assert together["moved"] == given["moved"].at(ROOM)
    assert notes == ("moved shifted from 0.0 °C to 20.0 °C",)
    together, notes = at_one_temperature({"a": solid(COLD, shift=True), "b": given["moved"]}, WARM)
    assert {one.reference_temperature for one in together.values()} == {WARM}
    assert len(notes) == 2


def test_temperatures_that_cannot_be_one_are_refused_or_said():
    fixed = {"cold": solid(COLD, shift=False), "room": solid(ROOM, shift=False)}
    with pytest.raises(InputError, match=r"room holds for 20\.0 °C and cannot be brought to 0\.0"):
        at_one_temperature(fixed)
    with pytest.raises(InputError, match=r"cold holds for 0\.0 °C and cannot be brought to 20\.0"):
        at_one_temperature(fixed, ROOM)
    unknown = {"room": fixed["room"], "other": solid(None, shift=False)}
    together, notes = at_one_temperature(unknown)
    assert together == unknown
    assert notes == ("the temperature of other is not known, that of room is",)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compounds")
    road = gs.surface.self_affine_profile(0.8, 3e-3, 4e-4, length=0.4, step=2e-4, seed=1)
    write_road(folder / "road.txt", gs.Profile(road.x, road.z))
    text = 'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"'
    (folder / "case.toml").write_text(case_text(text, solver=HALF_PLANE))
    return folder


@pytest.fixture(scope="module")
def made(folder):
    compounds = {
        "one": measured(1.0, 0.02),
        "twin": measured(1.0, 0.02),
        "lossy": measured(3.0, 0.02),
    }
    return compare_compounds(read_case(folder / "case.toml"), compounds, folder / "out")


def test_compounds_are_ranked_by_the_answer(folder, made):
    data, case = made.data, read_case(folder / "case.toml")
    answer = gs.answer(
        gs.Case(case.surface, made.rubbers["lossy"], pressure=3e5, speed=0.3, filled=False)
    )
    lossy = data.sel(rubber="lossy")
    assert lossy.answer_friction == pytest.approx(answer.friction, rel=1e-9)
    ends = float(lossy.answer_friction_low), float(lossy.answer_friction_high)
    assert ends == pytest.approx(answer.friction_interval, rel=1e-9)
    first, over_next, *_, basis = made.lines
    assert first.startswith("Answer: friction μ ranks lossy 0.")
    assert first.endswith("(50 %: no significant difference).")
    assert "by waves of" in over_next
    assert "by relaxation times of" in over_next
    assert "errors that all have in common cancel" in basis


def test_what_both_share_of_the_road_cancels(made):
    """A ratio on one road is better known than two numbers of different roads."""
    data = made.data
    own = np.log(data.answer_friction_high / data.answer_friction).sel(rubber=["one", "lossy"])
    pair = data.sel(rubber="lossy", over="one")
    both = np.log(float(pair.friction_ratio_high / pair.friction_ratio))
    assert 0.0 < both < 0.7 * np.hypot(*own.values)
    twin = data.sel(rubber="twin", over="one")
    assert float(twin.friction_ratio) == pytest.approx(1.0, rel=1e-9)
    assert float(twin.friction_ratio_low) < 1.0 < float(twin.friction_ratio_high)


def test_the_error_of_a_measurement_is_what_its_series_do(folder, made):
    """The largest change of ln mu over all series that fit, against contacts solved anew.

    To first order, and of a grid on which the borders of the contact move point by point.
    """
    case, best = read_case(folder / "case.toml"), made.rubbers["lossy"]
    (profile,) = case.surface.measured.surfaces
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 2e-3, "tolerance": 0.05}
    contact = gs.solve_rough_contact(best, profile, **load)
    solved = [
        gs.solve_rough_contact(each, profile, **load).friction_from_dissipation
        for each in best.admissible_rubbers()[:12]
    ]
    changes = np.log(np.array(solved) / contact.friction_from_dissipation)
    first_order = series_changes(contact, best)
    np.testing.assert_allclose(first_order[:12], changes, atol=0.1 * np.abs(changes).max())
    assert series_error(first_order) == pytest.approx(np.abs(first_order).max() / 3.0)


def test_confidence_is_that_of_students_t():
    ratio = FrictionRatio(0.2, 0.1, 5.0)
    assert ratio.confidence == pytest.approx(stats.t.cdf(2.0, 5.0))
    width = stats.t.ppf(0.95, 5.0) * 0.1
    assert np.log(ratio.interval) == pytest.approx([0.2 - width, 0.2 + width])
    assert np.isnan(FrictionRatio(0.2, np.nan).confidence)
    assert FrictionRatio(0.0, 0.0).confidence == 0.5


def test_the_ranking_is_drawn(made):
    ratios, running, decades = ranking_figure(made.data, "rubber").axes
    labels = [text.get_text() for text in ratios.get_xticklabels()]
    assert labels == [significant(mu, 2) for mu in made.data.answer_friction.values]
    assert len(running.get_lines()) == 3
    assert decades.get_xscale() == "log"
