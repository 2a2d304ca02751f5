"""A whole design from a case: promised friction, gain with its interval, files, and the command."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.named_inputs import read_surface
from gripscale.case_file.prepare import case_surface
from gripscale.charts.paper import figure_file
from gripscale.core.errors import InputError
from gripscale.half_space import sampling_error
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import Load
from gripscale.questions import designed_rubber
from gripscale.questions.design import compound_design, question
from gripscale.questions.design.compound_limits import CompoundLimits, PointLimit, changed
from gripscale.questions.design.compound_search import design_problem
from gripscale.questions.design.goal_friction import CompoundGoal, Gain, gain
from gripscale.questions.design.question import CompoundDesign, design_figure
from gripscale.rubber import ShiftTable
from gripscale.surface import self_affine_profile
from tests.samples import HALF_PLANE, SHIFTED_RUBBER, case_text, write_road, write_short_road

SURFACE = 'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "1 mm"'
CASE = case_text(SURFACE, 'file = "dma.txt"', HALF_PLANE)
LEVELS = [0.8, 1.0, 1.2]


def losses(rubber, hertz):
    """tan(delta) and J'' [1/Pa], -Im(1/E*), at a frequency."""
    omega = 2.0 * np.pi * hertz
    compliance = -(1.0 / rubber.complex_modulus(omega)).imag
    return np.array([rubber.loss_factor(omega), compliance])


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    folder = tmp_path_factory.mktemp("design")
    write_short_road(folder)
    road = self_affine_profile(0.8, 3e-3, 8e-4, length=0.4, step=1e-4, seed=1)
    write_road(folder / "road.txt", road)  # long enough for a sampling error
    path = folder / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="module")
def data(case):
    return gs.design(read_case(case), levels=LEVELS).data


def test_friction_now_and_then_are_answers_with_the_gain_between(case, data):
    """What `gripscale run` prints, not the direct contact that the search is made of."""
    same = data.isel(point=1)
    now, then = float(same.today_answer_friction[0]), float(same.answer_friction[0])
    assert now == pytest.approx(gs.answer(read_case(case)).friction, rel=1e-12)
    assert then / now == pytest.approx(1.0 + float(same.gain), rel=1e-9)


def test_the_promised_friction_is_that_of_a_new_contact(case, data):
    """Solved by the model of every comparison, from nothing, for the rubber of the files."""
    surface = design_problem(read_case(case)).friction.parts[0].surface
    for at in range(data.sizes["point"]):
        rubber = designed_rubber(data, at)
        contact = gs.solve_rough_contact(
            rubber, surface, pressure=3e5, speed=0.3, smallest_wavelength=1e-3, tolerance=0.02
        )
        promised = float(data.friction[at, 0])
        assert contact.friction_from_dissipation == pytest.approx(promised, rel=0.01)
        # the search has a coarser grid, and its gain is the same within its own error
        assert float(data.gain_searched[at]) == pytest.approx(float(data.gain[at]), abs=0.02)


def test_the_curve_rises_and_keeps_to_its_levels(data):
    assert data.rolling_level.values.tolist() == LEVELS[: data.sizes["point"]]
    assert (data.rolling_ratio.values <= data.rolling_level.values * (1.0 + 1e-6)).all()
    assert (np.diff(data.gain_optimum.values) > -1e-4).all()
    # a design gives away 0.1 % to stay near today's compound
    assert (data.gain_optimum.values - data.gain_searched.values < 4e-3).all()
    assert (data.gap.values < 4e-3).all()
    assert ((data.gain_low < data.gain) & (data.gain < data.gain_high)).all()
    for at in range(data.sizes["point"]):
        rubber = designed_rubber(data, at)
        today = gs.Rubber.from_dict(json.loads(data.attrs["rubber_parameters"]))
        slow, between, fast = (losses(rubber, f) / losses(today, f) for f in (10.0, 25.0, 50.0))
        assert max(*slow, *fast) == pytest.approx(float(data.rolling_ratio[at]), rel=1e-9)
        assert max(between) <= float(data.rolling_level[at]) * 1.02
        omega = 2.0 * np.pi * 10.0
        stiff = float(rubber.complex_modulus(omega).real / today.complex_modulus(omega).real)
        assert stiff == pytest.approx(float(data.limited_ratio[at, 0]), rel=1e-9)
        assert 0.9 - 1e-6 < stiff < 1.1 + 1e-6


def test_the_sampling_error_of_a_gain_is_that_of_a_ratio(case):
    """Less than those of both frictions, of which most cancels, and that of one against none."""
    friction = design_problem(read_case(case)).friction
    ratio = np.linspace(1.3, 0.8, 1 + friction.rubber.moduli.size)
    before = friction.contacts(friction.rubber, tolerance=0.05)
    none = gain(friction, before, before)
    assert (none.log_ratio, none.sampling, none.grid, none.interval) == (0.0, 0.0, 0.0, (0.0, 0.0))
    after = friction.contacts(changed(friction.rubber, ratio), tolerance=0.05)
    piece = 2.0 * friction.parts[0].largest_wavelength
    each = [sampling_error.sampling_error(c[0], piece).friction for c in (before, after)]
    carrying = sampling_error.pieces_that_carry(before[0], piece)
    residuals = sampling_error.friction_residuals(before[0], piece)
    whole = sampling_error.error_of_residuals(residuals, carrying)
    assert whole == pytest.approx(each[0], rel=1e-12)
    result = gain(friction, before, after)
    assert 0.0 < result.sampling < 0.5 * np.hypot(*each)
    low, high = result.interval
    assert low < np.expm1(result.log_ratio) < high


def test_the_interval_of_a_gain_holds_the_measurement_of_the_rubber(data):
    """Road, grids and rubber are independent: their variances add up; the road's is a t value."""
    rubber = data.gain_rubber_error.values
    assert (rubber > 0.0).all()
    squares = data.gain_sampling_error**2 + data.gain_grid_error**2 / 3.0 + rubber**2
    width = 0.5 * np.log((1.0 + data.gain_high) / (1.0 + data.gain_low))
    # 1.645 standard deviations, more where the sampling has few degrees of freedom
    assert (width.values >= 1.6448 * np.sqrt(squares).values).all()
    assert (width.values < 2.2 * np.sqrt(squares).values).all()
    without = Gain(0.4, 0.4, 0.003, 20.0, 0.005)
    ends = [np.log1p(replace(without, rubber=error).interval) for error in (0.0, 0.01)]
    assert np.log1p(without.interval) == pytest.approx(ends[0])
    narrow, wide = (0.5 * (high - low) for low, high in ends)
    assert narrow == pytest.approx(1.6635 * np.hypot(0.003, 0.005 / np.sqrt(3.0)), rel=0.01)
    assert wide == pytest.approx(1.6454 * np.hypot(narrow / 1.6635, 0.01), rel=0.01)


def test_friction_never_falls_with_a_looser_level(case, monkeypatch):
    """A search that ends lower at a looser level makes no point: the one below is admissible."""
    nearest, found = compound_design.nearest_design, []

    def no_better(friction, admissible, optimum):
        found.append(nearest(friction, admissible, optimum))
        return replace(found[-1], ratio=found[0].ratio)

    monkeypatch.setattr(compound_design, "nearest_design", no_better)
    worst = gs.design(read_case(case), levels=LEVELS).data
    assert worst.rolling_level.values.tolist() == [0.8]
    assert json.loads(worst.attrs[compound_design.FRUITLESS]) == [1.0, 1.2]
    lines = CompoundDesign(worst).lines
    assert "with rolling resistance -20.0 %" in lines[0]
    assert "  More rolling resistance than -20.0 % gives no more friction." in lines


def test_a_design_on_sweeps_that_end_below_the_rolling_temperature(case, tmp_path, shell):
    """The rolling resistance is taken where the sweeps end, and the answer says so."""
    rows = ["Temperature [C],Frequency [Hz],E' [MPa],E'' [MPa]"]
    for celsius in (10, 20, 30, 40):
        for hertz in np.geomspace(0.01, 100.0, 15):
            body = SHIFTED_RUBBER.at(273.15 + celsius)
            modulus = body.complex_modulus(2.0 * np.pi * hertz) / 1e6
            rows.append(f"{celsius},{hertz:.5g},{modulus.real:.6g},{modulus.imag:.6g}")
    (tmp_path / "sweeps.csv").write_text("\n".join(rows), encoding="utf-8")
    text = CASE.replace("dma.txt", "sweeps.csv").replace("road.txt", str(case.parent / "road.txt"))
    text = text.replace("[load]", 'reference_temperature = "20 C"\n[load]')
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    result = shell("design", tmp_path / "case.toml", "--levels", "1", "--output", tmp_path / "out")
    written = " ".join(result.stdout.split())
    assert "at 10 to 50 Hz and 40 °C (the shift ends there), the worst of them" in written
    assert "at 10 Hz and 40 °C (the shift ends there, not at 60 °C)" in written
    assert "tan δ wet: at 10 Hz and 10 °C (the shift ends there, not at 0 °C)" in written

    short = ShiftTable([283.15, 293.15, 303.15], [1.0, 0.0, -0.8])
    others = {"short": replace(SHIFTED_RUBBER, shift=short)}
    data = gs.design(read_case(tmp_path / "case.toml"), levels=[1.0], rubbers=others).data
    assert np.isfinite(data.compound_gain).all()
    assert np.isnan(data.compound_rolling_ratio).all()
    assert "rolling resistance of short must lie within 10 to 30 °C" in data.attrs["notes"]


@pytest.mark.parametrize(
    ("which", "wider"),
    [
        (0, CompoundLimits(2.2, 2.0)),
        (1, CompoundLimits(2.0, 2.2)),
        (2, CompoundLimits(2.0, 2.0, (PointLimit("storage_modulus", 0.9 / 1.1, 1.21),))),
    ],
    ids=["factor", "per decade", "E'"],
)
def test_wider_limits_are_worth_what_is_said(case, data, which, wider):
    """First order against an optimum with a tenth more room."""
    point = data.isel(point=LEVELS.index(1.0))
    more = gs.design(read_case(case), levels=[1.0], limits=wider).data
    gained = np.log1p(float(more.gain_optimum[0])) - np.log1p(float(point.gain_optimum))
    # second order in a tenth; the contacts of the search start elsewhere
    assert float(point.limit_worth[which]) == pytest.approx(gained, rel=0.2, abs=1e-3)
    assert point.limit_worth.max() > 0.02


def test_todays_friction_between_two_points(data):
    """By hand: from -10 to +20 % between 0.6 and 0.9 today's friction is at 0.7."""
    made = data.isel(point=slice(0, 2)).assign(
        rolling_ratio=("point", [0.6, 0.9]), gain=("point", [-0.1, 0.2])
    )
    assert question.rolling_at_todays_friction(made) == pytest.approx(0.7)
    more = made.assign(gain=("point", [0.1, 0.2]))
    assert np.isnan(question.rolling_at_todays_friction(more))


def test_answer_first_and_the_limits_named(data):
    lines = CompoundDesign(data).lines
    now, then = float(data.today_answer_friction[0]), float(data.answer_friction[1, 0])
    assert lines[0].startswith(f"Answer: friction {now:.3f} now → {then:.3f} with the design ")
    (relaxed,) = (line for line in lines if "A limit relaxed by a tenth gives" in line)
    assert "E' at 10 Hz" in relaxed


def test_the_figure_draws_the_answer_and_no_near_copy_of_it(data):
    def labels(last):
        made = data.isel(point=[0, 1, 1]).assign(rolling_ratio=("point", [0.8, 1.0, last]))
        return {text.get_text() for text in design_figure(made).legends[0].get_texts()}

    assert {"same rolling resistance", "rolling resistance -20 %"} < labels(1.015)
    assert "rolling resistance +1 %" not in labels(1.015)
    assert "rolling resistance +15 %" in labels(1.15)


def test_frequencies_on_the_figure_keep_apart(data):
    wide = data.assign_coords(frequency=np.geomspace(0.01, 2e6, data.sizes["frequency"]))
    figure = design_figure(wide)
    figure_file(figure)
    for axes in figure.axes[1:]:
        low, high = axes.get_xlim()
        labels = zip(axes.get_xticklabels(), axes.get_xticks(), strict=True)
        boxes = [label.get_window_extent() for label, at in labels if low <= at <= high]
        assert len(boxes) > 2
        assert all(a.x1 + 4.0 < b.x0 for a, b in pairwise(boxes))


def test_no_level_within_the_limits_is_refused(case):
    stiff = CompoundLimits(points=[PointLimit("storage_modulus", 3.0, 4.0)])
    for options, words in (
        ({"levels": [0.01]}, "levels must include one above"),
        ({"limits": stiff}, "limits must leave an admissible change"),
    ):
        with pytest.raises(InputError, match=words):
            gs.design(read_case(case), **options)


def test_limits_that_today_does_not_keep(case):
    """A stiffer rubber is asked for: the search starts outside and ends inside."""
    stiff = CompoundLimits(points=[PointLimit("storage_modulus", 1.2, 1.5)])
    data = gs.design(read_case(case), levels=[1.0], limits=stiff).data
    assert float(data.limited_ratio[0, 0]) == pytest.approx(1.2, abs=1e-4)


def test_a_goal_on_another_road(case, tmp_path):
    """Each road counts with its weight, and has a friction of its own."""
    other = self_affine_profile(0.8, 3e-3, 4e-4, length=0.4, step=1e-4, seed=2)
    write_road(tmp_path / "smooth.txt", other)
    smooth = read_surface(str(tmp_path / "smooth.txt"), read_case_file(case))
    goals = [CompoundGoal(0.3, 3e5, weight=3.0), CompoundGoal(0.3, 3e5, road="smooth")]
    free, roads = CompoundLimits(points=[]), {"smooth": smooth}
    data = gs.design(read_case(case), goals=goals, levels=[1.0], limits=free, roads=roads).data
    assert data.sizes["limit"] == 0
    rough, mild = data.today_friction.values
    assert mild < 0.8 * rough
    ratios = np.log(data.friction.values[0] / data.today_friction.values)
    mean = float(np.array([0.75, 0.25]) @ ratios)
    assert float(data.gain[0]) == pytest.approx(np.expm1(mean), rel=1e-9)
    assert len(CompoundDesign(data).lines) > 3


def test_goals_and_limits_as_text():
    default = CompoundGoal(0.3, 3e5)
    goal = question.parse_goal("speed=3 mm/s, weight=2, temperature=0 C", default)
    assert goal == CompoundGoal(3e-3, 3e5, 273.15, 2.0)
    limit = question.parse_limit("loss_factor, 10 Hz, 0 C, 1:2")
    assert limit == PointLimit("loss_factor", 1.0, 2.0, 10.0, 273.15)
    assert question.parse_limit("storage_modulus,1 Hz,0.9:inf").temperature is None
    assert question.parse_levels("0.8,1") == [0.8, 1.0]


@pytest.mark.parametrize(
    ("parse", "text", "words"),
    [
        *((question.parse_goal, text, "goal") for text in ("colour=red", "speed", "speed=fast")),
        (question.parse_limit, "loss_factor, 10 Hz", "limit"),
        (question.parse_limit, "stiffness, 10 Hz, 0.9:1.1", "limit"),
        (question.parse_limit, "loss_factor, ten, 1:2", "limit"),
        (question.parse_limit, "loss_factor, 10 Hz, 2:1", "low must be below high"),
        (question.parse_levels, "0.8,much", "levels must be"),
    ],
)
def test_what_is_no_goal_limit_or_level_is_refused(parse, text, words):
    default = [CompoundGoal(0.3, 3e5)] if parse is question.parse_goal else []
    with pytest.raises(InputError, match=words):
        parse(text, *default)


def test_the_command_writes_what_it_says(case, shell, tmp_path):
    arguments = ["design", case, "--output", tmp_path, "--levels", "0.8,1,1.2"]
    result = shell(*arguments, "--rubber", "styrene_butadiene", "--goal", "speed=0.1 m/s")
    assert "Answer: " in result.stdout
    assert "styrene_butadiene" in result.stdout
    assert (tmp_path / "design.png").is_file()
    stored = netcdf.load_dataset(tmp_path / "design.nc")
    point = int(np.abs(stored.rolling_ratio.values - 1.0).argmin())
    name = designed_rubber(stored, point).name
    curve = gs.read_master_curve(tmp_path / f"{name}.csv", modulus="E")
    np.testing.assert_allclose(curve.storage, stored.storage.values[point], rtol=1e-12)
    rubber = gs.Rubber.from_dict(json.loads((tmp_path / f"{name}.json").read_text()))
    modulus = rubber.complex_modulus(2.0 * np.pi * stored.frequency.values)
    np.testing.assert_allclose(modulus.imag, stored.loss.values[point], rtol=1e-9)
    # the other compound's friction is that of its own direct contact
    answer = DirectContact(tolerance=0.05).predict(
        gs.rubber.styrene_butadiene(), case_surface(read_case_file(case)), Load(3e5, 0.1, 0.1)
    )
    ratio = float(answer.friction_from_dissipation[0]) / float(stored.today_friction[0])
    assert float(stored.compound_gain[0]) == pytest.approx(ratio - 1.0, rel=1e-6)
