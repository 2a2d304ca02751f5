"""Roads side by side: a twin differs by nothing, a rougher road by more, octaves add up."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.named_inputs import read_surface
from gripscale.cli import app
from gripscale.core.errors import InputError
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.model import Load
from gripscale.questions import Roads, compare_surfaces
from gripscale.questions.uncertainty.sampled_inputs import Measurement
from gripscale.questions.vary.inputs import surface_of
from gripscale.questions.vary.page_side_by_side import (
    CHAIN_RANKS_NOTHING,
    ratio_lines,
    roads_sentences,
)
from gripscale.questions.vary.surface_comparison import (
    REFERENCE,
    _drawn,
    friction_curve,
    octave_ends,
    roads_dataset,
    running_friction,
)
from gripscale.surface import Profile, self_affine_profile
from tests.samples import HALF_PLANE, POWER_LAW_TIMES, case_text, write_road

CASE = case_text(
    'files = ["road.txt"]\nscales = 4\nsmallest_wavelength = "1 mm"\ns_amplitude = 2.1',
    solver=HALF_PLANE,
)
"""With a factor stated, as each sample fits its waves anew."""


def running(answer: xr.Dataset, ends: np.ndarray) -> np.ndarray:
    curve = friction_curve(answer)
    return running_friction(curve.curve_wavelength.values, curve.curve_friction.values, ends)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case on a gentle road, the same road again, and three times as high."""
    folder = tmp_path_factory.mktemp("roads")
    road = self_affine_profile(0.8, 3e-3, 2e-4, length=0.4, step=2e-4, seed=1)
    for name, factor in (("road", 1.0), ("twin", 1.0), ("rough", 3.0)):
        write_road(folder / f"{name}.txt", Profile(road.x, factor * road.z))
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.fixture(scope="module")
def solves() -> list[str]:
    """What was solved for `made`, a label each."""
    return []


@pytest.fixture(scope="module")
def made(folder: Path, solves: list[str]) -> Roads:
    file = read_case_file(folder / "case.toml")
    names = ("road", "twin", "rough")
    surfaces = {name: read_surface(str(folder / f"{name}.txt"), file) for name in names}
    return compare_surfaces(
        read_case(folder / "case.toml"),
        surfaces,
        folder / "out",
        samples=10,
        on_task=lambda one: solves.append(one.label),
    )


def test_a_twin_differs_by_nothing_and_a_rough_road_by_more_than_its_stretches(made: Roads) -> None:
    data = made.data
    twin, rough = data.sel(surface="twin"), data.sel(surface="rough")
    assert (twin.total_friction_difference == 0.0).all()
    assert (twin.total_friction_difference_low < 0.0).all()
    assert (twin.total_friction_difference_high > 0.0).all()
    assert (rough.total_friction_difference_low > 0.0).all()
    assert (rough.total_contact_fraction_difference_high < 0.0).all()
    *said, last = roads_sentences(data)
    assert len(said) == 4
    # the chain judges nothing: its ranking may be another one than that of the answer
    assert [", beyond what" in text for text in said] == [False, False, False, True]
    assert last == CHAIN_RANKS_NOTHING


def test_octaves_add_up_to_the_totals(made: Roads) -> None:
    """Chain and direct contact end within the last octave, whose end is not below theirs."""
    data = made.data
    running = data.friction_running.isel(octave=-1)
    totals = {"chain": data.total_friction, "direct": data.total_friction_from_dissipation}
    for model, total in totals.items():
        np.testing.assert_allclose(running.sel(model=model), total.sel(model=model), rtol=1e-9)
    np.testing.assert_allclose(
        data.friction_difference.sum("octave"),
        running - running.isel(surface=0, drop=True),
        atol=1e-12,
    )


def test_samples_are_compared_with_a_road_solved_as_they_are(
    made: Roads, solves: list[str]
) -> None:
    """Half-planes in the chain; in the direct contact grids nearly as fine as for the road."""
    assert np.isfinite(made.data.total_friction_low).all()
    for model in ("chain", "direct"):
        labels = [label for label in solves if label.startswith(f"{model}, rough, ")]
        assert len(labels) == 2 + 10


def test_samples_have_the_friction_of_a_road_solved_as_finely(tmp_path: Path) -> None:
    """On the first full grid traction on this lossy rubber loses a tenth of the friction."""
    road = self_affine_profile(0.8, 4e-4, 4e-5, length=0.1, step=5e-5, seed=1)
    write_road(tmp_path / "road.txt", road)
    text = CASE.replace("1 mm", "0.1 mm")
    (tmp_path / "case.toml").write_text(text)
    surface = surface_of("case", read_case(tmp_path / "case.toml"))
    moduli = 2e5 * (POWER_LAW_TIMES / 1e-2) ** -0.7
    lossy = gs.Rubber(4e6, moduli, POWER_LAW_TIMES, bulk_modulus=1e13)
    model, load = DirectContact(tolerance=JUDGED_TO), Load(3e5, 0.3, 0.1)
    measured = float(model.predict(lossy, surface, load).total_friction)
    measurement = Measurement(surface, lossy, load)
    compared = _drawn(measurement, model, load, 10)[REFERENCE]
    sample = float(compared.model.predict(lossy, compared.surface, load).total_friction)
    assert sample == pytest.approx(measured, rel=0.05)


def test_the_range_of_friction_is_that_of_friction_from_dissipation() -> None:
    """Friction from traction of samples on a coarse grid may be anything."""
    names = ("total_friction", "total_friction_from_dissipation", "total_contact_fraction")
    dims, shape = ("model", "surface", "sample"), (2, 2, 12)
    numbers = np.ones(shape)
    numbers[..., 2:] = np.linspace(0.9, 1.1, 10)
    solved = xr.Dataset(
        {name: (dims, numbers, {"long_name": name}) for name in names},
        {"model": ["chain", "direct"], "surface": ["road", "other"]},
    )
    solved["total_friction"].values = numbers**7
    for name in ("curve_wavelength", "curve_friction"):
        solved[name] = (*dims, "curve"), np.broadcast_to([2e-3, 1e-3], (*shape, 2))
    for name in ("prediction_status", "prediction_status_word"):
        solved[name] = dims, np.full(shape, "converged", dtype=object)
    solved["prediction_status"][1] = ""
    data = roads_dataset({}, solved)
    for end in ("low", "high"):
        area = data[f"total_contact_fraction_{end}"]
        np.testing.assert_allclose(data[f"total_friction_{end}"], area)
    assert (data.total_friction_low < 1.0).all()


def test_the_answer_is_the_ratio_of_best_estimates_as_uncertain_as_both(made: Roads) -> None:
    data = made.data
    np.testing.assert_allclose(
        data.friction_ratio, data.answer_friction / data.answer_friction.values[0], rtol=1e-12
    )
    own = np.log(data.answer_friction_high / data.answer_friction)
    both = np.log(data.friction_ratio_high / data.friction_ratio)
    np.testing.assert_allclose(both[1:], np.hypot(own, own[0])[1:], rtol=1e-12)
    assert float(data.friction_ratio.sel(surface="twin")) == 1.0
    first, basis = ratio_lines(data, "surface")
    assert first.startswith(
        "Answer: rough has the most friction. Over road: twin friction × 1.00 ("
    )
    assert "direct contact of the measured surfaces" in basis
    pair = data.sel(surface=["road", "rough"])
    assert next(ratio_lines(pair, "surface")).startswith("Answer: rough grips more than road: fric")
    twins = data.sel(surface=["road", "twin"])
    assert "twin and road have no significant difference in grip" in next(
        ratio_lines(twins, "surface")
    )


def test_ranges_are_of_the_drawn_blocks(folder: Path, made: Roads) -> None:
    """With half-planes as its solver the chain's range is that of its uncertainty by profiles."""
    sources = ["cleaning", "modulus", "bulk_modulus", "load_time", "cut_off", "waves"]
    choice = gs.questions.Uncertainty(sources)
    case = folder / "case.toml"
    case_of = case.with_name("fine.toml")
    case_of.write_text(case.read_text().replace("points = 64", "points = 128"))
    told = gs.questions.propagate(read_case(case_of), choice, samples=10, models=["chain"])
    ratio = told.friction_quantile.values[0, [0, -1]] / float(told.friction_case[0])
    one = made.data.sel(surface="road", model="chain")
    assert float(one.total_friction_low / one.total_friction) == pytest.approx(ratio[0])
    assert float(one.total_friction_high / one.total_friction) == pytest.approx(ratio[1])


def test_statistics_of_the_rough_road_are_nine_times_those_of_the_other(made: Roads) -> None:
    for name in ("correlation", "spectrum"):
        curve = made.data[name]
        ratio = (curve.sel(surface="rough") / curve.sel(surface="road")).dropna(curve.dims[-1])
        assert ratio.size > 20
        np.testing.assert_allclose(ratio, 9.0, rtol=1e-3)  # heights are written to a nanometre
    for name, ratio in {"mean_profile_depth": 3.0, "rms_height": 3.0, "skewness": 1.0}.items():
        number = made.data[name]
        assert number.sel(surface="rough") == pytest.approx(
            ratio * number.sel(surface="road").item(), rel=1e-3
        )


def test_friction_between_waves_is_linear_in_the_logarithm() -> None:
    ends = octave_ends(8e-3, 1e-3)
    np.testing.assert_allclose(ends, [8e-3, 4e-3, 2e-3, 1e-3])
    answer = gs.solve_chain(
        gs.Rubber(2e6, [4e6], [1e-3]),
        gs.SineStack([8e-3, 2e-3], [4e-4, 1e-4]),
        pressure=3e5,
        speed=0.3,
        footprint=0.1,
        solver=gs.theory.HalfPlane(points=64),
    ).to_dataset()
    first, second = answer.friction.values
    expected = [first, first + 0.5 * second, first + second, first + second]
    np.testing.assert_allclose(running(answer, ends), expected)


def test_octaves_of_profiles_count_by_their_length() -> None:
    """One of them a quarter of the length, and without the shortest octave."""
    parts = [[0.1, 0.2, np.nan], [0.3, 0.1, 0.2]]
    answer = xr.Dataset(
        {
            "octave_friction": (("profile", "wavelength"), parts),
            "weight": ("profile", [0.25, 0.75]),
        },
        {"wavelength": [4e-3, 2e-3, 1e-3]},
    )
    found = running(answer, octave_ends(8e-3, 1e-3))
    np.testing.assert_allclose(found, [0.0, 0.25, 0.375, 0.525])


@pytest.mark.usefixtures("made")
def test_waves_by_hand_have_no_direct_contact_and_no_range(folder: Path) -> None:
    stated = {"road": "case", "waves": gs.SineStack([5e-3, 1e-3], [2e-4, 4e-5])}
    made = compare_surfaces(read_case(folder / "case.toml"), stated, folder / "out", samples=10)
    assert made.notes == (
        "waves, chain: no range; no profile was measured",
        "waves was not measured: no direct contact",
    )
    first, basis = ratio_lines(made.data, "surface")
    assert first.endswith(", without an interval.")
    assert basis == "  by the chain of sine waves: not all of the surfaces were measured"
    waves = made.data.sel(surface="waves")
    assert np.isfinite(waves.total_friction.sel(model="chain"))
    assert np.isnan(waves.total_friction.sel(model="direct"))
    assert waves.depth_note == "not measured"
    assert np.isnan(waves.rms_height)


@pytest.mark.usefixtures("made")
def test_the_command_writes_table_figures_and_page(folder: Path) -> None:
    """Where the samples of `made` are."""
    target = folder / "out"
    given = [str(folder / "case.toml"), str(folder / "rough.txt")]
    options = ["--samples", "10", "--output", str(target)]
    outcome = CliRunner().invoke(app, ["compare-surfaces", *given, *options])
    assert outcome.exit_code == 0, outcome.output
    text = (target / "surfaces.txt").read_text()
    assert (target / "summary.xlsx").is_file()
    assert text.startswith(f"Answer: rough grips more than {folder.name}: friction × ")
    assert "direct: μ of rough is" in text
    figures = {path.stem for path in target.glob("*.p*")}
    assert figures == {"roads_statistics", "roads_friction"}
    page = (target / "report.html").read_text()
    assert "Roads side by side" in page
    assert page.index("μ of rough") < page.index("Answers, from the direct contact")
    assert "direct: μ of rough is" in page
    assert "Texture: ISO 13473-1" in text
    assert "MPD" in page
    assert f"gripscale compare-surfaces {given[0]} {given[1]}" in page


def test_two_to_six_roads(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="surfaces must be 2 to 6 roads to be compared; got 1"):
        compare_surfaces(read_case(folder / "case.toml"), {"one": "case"}, tmp_path)
    with pytest.raises(InputError, match="samples"):
        compare_surfaces(
            read_case(folder / "case.toml"), {"a": "case", "b": "case"}, tmp_path, samples=3
        )
