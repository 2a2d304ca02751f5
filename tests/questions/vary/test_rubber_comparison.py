"""Compounds side by side: one temperature, differences that add up, ranges from the data."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.io.table import significant
from gripscale.questions import Compounds, at_one_temperature, compare_compounds
from gripscale.questions.page_of_folder import write_report
from gripscale.questions.vary.charts_side_by_side import compound_friction_figure
from gripscale.questions.vary.page_side_by_side import (
    CHAIN_RANKS_NOTHING,
    compounds_sentences,
    ratio_lines,
    side_by_side_totals,
)
from gripscale.rubber import WLF, MasterCurve, fit_prony
from tests.samples import HALF_PLANE, ROOT, case_text, write_road

COLD, ROOM, WARM = 273.15, 293.15, 313.15

CASE = case_text(
    'sines = [{ wavelength = "10 mm", amplitude = "1 mm" }, '
    '{ wavelength = "2 mm", amplitude = "0.2 mm" }]',
    solver=HALF_PLANE.replace("64", "128"),
)


def solid(kelvin: float | None, *, shift: bool) -> gs.Rubber:
    law = WLF(8.86, 101.6, reference_temperature=kelvin) if shift else None
    return gs.Rubber(2e6, [4e6], [1e-3], reference_temperature=kelvin, shift=law)


def measured(factor: float, noise: float) -> gs.Rubber:
    """A rubber fitted to a made-up measurement, its relaxing moduli `factor` times as large."""
    omega = np.geomspace(1e-1, 1e6, 57)
    truth = gs.Rubber(3e6, factor * np.array([2e6, 4e6, 8e6]), [1e-1, 1e-3, 1e-5])
    values = truth.complex_modulus(omega)
    scatter = np.exp(noise * np.random.default_rng(1).standard_normal((2, omega.size)))
    curve = MasterCurve(omega / 2 / np.pi, values.real * scatter[0], values.imag * scatter[1])
    return fit_prony(curve)


def test_a_temperature_all_can_be_brought_to() -> None:
    """That of the rubber without a shift; the other is moved by its own."""
    given = {"moved": solid(COLD, shift=True), "fixed": solid(ROOM, shift=False)}
    together, notes = at_one_temperature(given)
    assert together["fixed"] is given["fixed"]
    assert together["moved"] == given["moved"].at(ROOM)
    assert notes == ("moved shifted from 0.0 °C to 20.0 °C",)
    together, notes = at_one_temperature({"a": solid(COLD, shift=True), "b": given["moved"]}, WARM)
    assert {one.reference_temperature for one in together.values()} == {WARM}
    assert len(notes) == 2


def test_temperatures_that_cannot_be_one_are_refused_or_said() -> None:
    fixed = {"cold": solid(COLD, shift=False), "room": solid(ROOM, shift=False)}
    with pytest.raises(InputError, match=r"got cold for 0\.0 °C, room for 20\.0 °C without one"):
        at_one_temperature(fixed)
    with pytest.raises(InputError, match=r"cold holds for 0\.0 °C and cannot be brought to 20\.0"):
        at_one_temperature(fixed, ROOM)
    unknown = {"room": fixed["room"], "other": solid(None, shift=False)}
    together, notes = at_one_temperature(unknown)
    assert together == unknown
    assert notes == ("the temperature of other is not known, that of room is",)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Compounds:
    folder = tmp_path_factory.mktemp("compounds")
    (folder / "case.toml").write_text(CASE)
    compounds = {
        "one": measured(1.0, 0.02),
        "twin": measured(1.0, 0.02),
        "lossy": measured(3.0, 0.02),
    }
    return compare_compounds(read_case(folder / "case.toml"), compounds, folder / "out")


def test_differences_add_up(made: Compounds) -> None:
    data = made.data
    total = data.total_friction.values
    np.testing.assert_allclose(data.friction_running.values[:, -1], total, rtol=1e-12)
    by_wave = data.friction_difference.sum("scale").values
    by_decade = data.friction_by_decade_difference.fillna(0.0).sum("decade").values
    for parts in (by_wave, by_decade):
        np.testing.assert_allclose(parts, total - total[0], atol=1e-12)
    assert abs(data.total_friction_difference.values[2]) > 0.02


def test_their_report_is_that_of_a_study_over_rubbers(made: Compounds, tmp_path: Path) -> None:
    netcdf.save(made.data, tmp_path / "compounds.nc")
    page = write_report(tmp_path).read_text()
    for word in ("lossy", "Totals of all 3 predictions", "Compounds side by side"):
        assert word in page


def test_a_twin_differs_by_less_than_what_the_data_leave_open(made: Compounds) -> None:
    twin = made.data.sel(rubber="twin")
    assert twin.total_friction_difference == 0.0
    assert twin.total_friction_difference_low < 0.0 < twin.total_friction_difference_high
    twins, lossy = compounds_sentences(made.data)
    assert ", not beyond what the measured moduli leave open; most" in twins
    assert ", beyond what the measured moduli leave open" in lossy


def test_ranges_hold_every_admissible_series(made: Compounds) -> None:
    """Solved one by one with the case's own half-planes, of which ratios are exact here."""
    lossy = made.data.sel(rubber="lossy")
    load = {"pressure": 3e5, "speed": 0.3, "footprint": 0.1}
    sines = gs.SineStack([10e-3, 2e-3], [1e-3, 0.2e-3])
    found = [
        gs.solve_chain(one, sines, solver=gs.theory.HalfPlane(points=128), **load).friction
        for one in made.rubbers["lossy"].admissible_rubbers()
    ]
    assert lossy.total_friction_low == pytest.approx(min(*found, float(lossy.total_friction)))
    assert lossy.total_friction_high == pytest.approx(max(*found, float(lossy.total_friction)))
    assert lossy.total_friction_low < lossy.total_friction < lossy.total_friction_high


def test_the_answer_is_the_ratio_with_what_both_measurements_leave_open(made: Compounds) -> None:
    """Waves by hand: of the chain, and nothing but the moduli."""
    data = made.data
    total = data.total_friction
    np.testing.assert_allclose(data.friction_ratio, total / total.values[0], rtol=1e-12)
    down = np.log(total / data.total_friction_low)
    up = np.log(data.total_friction_high / total)
    # two even ranges, added as if normal
    both = 1.645 / np.sqrt(3.0) * np.hypot(up.values[2], down.values[0])
    ratio = data.sel(rubber="lossy")
    assert np.log(ratio.friction_ratio_high / ratio.friction_ratio) == pytest.approx(both)
    first, basis = ratio_lines(data, "rubber")
    assert first.startswith("Answer: lossy has the most friction. Over one: twin friction × 1.00 (")
    assert basis == "  by the chain of sine waves: not all of the surfaces were measured"


def test_on_a_measured_road_the_direct_contact_answers(tmp_path: Path) -> None:
    road = gs.surface.self_affine_profile(0.8, 3e-3, 4e-4, length=0.4, step=2e-4, seed=1)
    write_road(tmp_path / "road.txt", gs.Profile(road.x, road.z))
    text = 'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"'
    (tmp_path / "case.toml").write_text(case_text(text, solver=HALF_PLANE))
    compounds = {"one": measured(1.0, 0.02), "lossy": measured(3.0, 0.02)}
    result = compare_compounds(read_case(tmp_path / "case.toml"), compounds, tmp_path / "out")
    data = result.data
    np.testing.assert_allclose(
        data.friction_ratio, data.best_friction / data.best_friction.values[0], rtol=1e-12
    )
    # what both know of the road makes a ratio better known than two numbers
    own = np.log(data.best_friction_high / data.best_friction).values
    both = float(np.log(data.friction_ratio_high / data.friction_ratio)[1])
    assert 0.0 < both < np.hypot(*own)
    first, basis = ratio_lines(data, "rubber")
    assert first.startswith("Answer: lossy grips more than one: friction × ")
    assert "direct contact of the measured surface, the same for all" in basis
    *said, last = compounds_sentences(data)
    assert [text.startswith("chain: μ of lossy is ") for text in said] == [True]
    assert "leave open" not in said[0]
    assert last == CHAIN_RANKS_NOTHING
    headings = [
        column.heading for column in side_by_side_totals(data, "rubber", "compound").columns
    ]
    assert headings[-2] == "difference of μ from the first"
    ranking, chain, _ = compound_friction_figure(data).axes
    assert ranking.get_title() == "direct contact: the ranking"
    assert chain.get_title() == "chain, less reliable"
    best = [text.get_text() for text in ranking.get_xticklabels()]
    assert best == [significant(mu, 2) for mu in data.best_friction.values]
    page = result.page(tmp_path / "page.html").read_text()
    assert page.index("μ of lossy") < page.index("Best estimates, from the direct contact")


def test_two_to_six_compounds(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="rubbers must be 2 to 6 compounds to be compared; got 1"):
        compare_compounds(
            read_case(ROOT / "examples" / "three_waves" / "case.toml"), {"one": "case"}, tmp_path
        )
