"""Surfaces side by side: a twin differs by nothing, a rougher road surely; octaves add up."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.named_inputs import read_surface
from gripscale.core.errors import InputError
from gripscale.questions import compare_surfaces
from gripscale.surface import Profile, self_affine_profile
from tests.samples import HALF_PLANE, case_text, write_road

CASE = case_text(
    'files = ["road.txt"]\nscales = 4\nsmallest_wavelength = "1 mm"', solver=HALF_PLANE
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A case on a gentle road, the same road again, and three times as high."""
    folder = tmp_path_factory.mktemp("roads")
    road = self_affine_profile(0.8, 3e-3, 2e-4, length=0.4, step=2e-4, seed=1)
    for name, factor in (("road", 1.0), ("twin", 1.0), ("rough", 3.0)):
        write_road(folder / f"{name}.txt", Profile(road.x, factor * road.z))
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.fixture(scope="module")
def made(folder):
    file = read_case_file(folder / "case.toml")
    names = ("road", "twin", "rough")
    surfaces = {name: read_surface(str(folder / f"{name}.txt"), file) for name in names}
    return compare_surfaces(read_case(folder / "case.toml"), surfaces, folder / "out")


def test_roads_have_the_answer_and_are_ranked_by_it(folder, made):
    data = made.data
    answer = gs.answer(read_case(folder / "case.toml"))
    assert data.answer_friction.sel(surface="road") == pytest.approx(answer.friction, rel=1e-12)
    ends = [float(data[f"answer_friction_{end}"].sel(surface="road")) for end in ("low", "high")]
    assert ends == pytest.approx(answer.friction_interval, rel=1e-12)
    first, *steps, _ = made.lines
    assert first.startswith("Answer: friction μ ranks rough 0.")
    assert "(> 99 % sure) over twin" in first or "(> 99 % sure) over road" in first
    assert first.endswith("(50 %: no significant difference).")
    assert [step.strip().split(":")[0] for step in steps] == ["rough over road", "road over twin"]
    rows = made.table().columns[0].values
    assert rows == ["rough", "road", "twin"]


def test_the_ratio_is_as_uncertain_as_both_answers(made):
    """Two roads share no error."""
    data = made.data
    pair = data.sel(surface="rough", over="road")
    friction = data.answer_friction
    assert pair.friction_ratio == pytest.approx(
        float(friction.sel(surface="rough") / friction.sel(surface="road")), rel=1e-12
    )
    widths = np.log(data.answer_friction_high / friction).sel(surface=["rough", "road"])
    width = np.log(float(pair.friction_ratio_high / pair.friction_ratio))
    assert width == pytest.approx(np.hypot(*widths.values), rel=1e-3)
    assert float(pair.confidence) > 0.99
    assert float(data.confidence.sel(surface="twin", over="road")) == 0.5
    np.testing.assert_allclose(data.confidence + data.confidence.T.values, 1.0, rtol=1e-12)


def test_statistics_of_the_rough_road_are_nine_times_those_of_the_other(made):
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


def test_waves_by_hand_are_ranked_by_the_chain_without_a_confidence(folder):
    stated = {"road": "case", "waves": gs.SineStack([5e-3, 1e-3], [2e-4, 4e-5])}
    made = compare_surfaces(read_case(folder / "case.toml"), stated)
    assert "note: waves was not measured" in made.parts()
    first, *_, basis = made.lines
    assert "sure" not in first
    assert "chain of sine waves, without an interval: not all of the surfaces" in basis
    assert np.isnan(made.data.confidence.values[0, 1])
    total = made.data.octave_friction.sum("octave")
    np.testing.assert_allclose(total, made.data.total_friction, rtol=1e-12)
    assert made.data.depth_note.sel(surface="waves") == "not measured"


@pytest.mark.usefixtures("made")
def test_the_command_writes_its_figures(folder, shell):
    """Where the answers of `made` are."""
    target = folder / "out"
    done = shell("compare-surfaces", folder / "case.toml", folder / "rough.txt", "--output", target)
    assert f" over {folder.name} 0." in done.stdout.partition("Answer: friction μ ranks rough")[2]
    assert {path.stem for path in target.glob("*.p*")} == {"roads_statistics", "roads_friction"}


def test_two_to_six_roads(folder):
    with pytest.raises(InputError, match="surfaces must be 2 to 6 surfaces to be compared; got 1"):
        compare_surfaces(read_case(folder / "case.toml"), {"one": "case"})
