"""What each effect is worth: the answers of the model with and without it, found by other means."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.chain import Chain
from gripscale.conditions import Conditions, ConstantStress
from gripscale.core.errors import InputError
from gripscale.experiment import Progress
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.io.table import as_text
from gripscale.questions import effect_tasks, effects, effects_figure
from gripscale.questions.vary.page_side_by_side import effects_table
from gripscale.rubber.softening import Kraus
from gripscale.surface import Measured, Surface
from gripscale.theory import HalfPlane, KlueppelHeinrich
from tests.samples import SHIFTED_LOAD as LOAD
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES
from tests.samples import THERMAL as HEAT

KRAUS = Kraus(
    storage_ratio=0.3, loss_ratio=0.2, critical_strain=0.02, measured_at=1e-3, deformation="shear"
)
EVERYTHING = Conditions(
    temperature=313.15, softening=KRAUS, heat=HEAT, shear_stress=ConstantStress(2e6)
)
CHAIN = Chain(HalfPlane(points=128), conditions=EVERYTHING)
NAMES = ["all", "no temperature", "no softening", "no heat", "none"]


def surface() -> Surface:
    x = np.arange(1024) * 1e-5
    turns = 2.0 * np.pi * x / (1024 * 1e-5)
    line = gs.Profile(x, 2e-4 * np.cos(3 * turns) + 3e-5 * np.cos(17 * turns + 1.0))
    return Surface(SINES, "two waves", measured=Measured.of([line]))


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> list[xr.Dataset]:
    direct = DirectContact(tolerance=None, periodic=True, conditions=EVERYTHING)
    folder = tmp_path_factory.mktemp("effects")
    return [effects(one, RUBBER, surface(), LOAD, folder=folder) for one in (CHAIN, direct)]


def test_each_answer_is_that_of_the_model_without_the_effect(both: list[xr.Dataset]) -> None:
    data = both[0]
    assert data.effect.values.tolist() == NAMES
    assert (data.prediction_status == "converged").all()
    without = ({}, {"temperature": None}, {"softening": None}, {"heat": None})
    for name, left_out in zip(NAMES, without, strict=False):
        own = gs.solve_chain(
            RUBBER,
            SINES,
            pressure=3e5,
            speed=1.0,
            footprint=0.05,
            solver="half_plane",
            points=128,
            conditions=replace(EVERYTHING, **left_out),
        )
        one = data.sel(effect=name)
        assert float(one.total_friction) == own.friction
        assert float(one.total_contact_fraction) == own.contact_fraction
        assert float(one.friction_with_area_term) == pytest.approx(own.total_friction, rel=1e-12)
    plain = CHAIN.predict(RUBBER, surface(), LOAD).total_friction
    assert float(data.total_friction[0]) == float(plain)


def test_without_any_effect_the_rubber_is_as_measured(both: list[xr.Dataset]) -> None:
    """The area term, which needs no solution, stays: tau_f A_r / (A_0 p_0)."""
    for data, model in zip(
        both, (CHAIN, DirectContact(tolerance=None, periodic=True)), strict=True
    ):
        plain = replace(model, conditions=None).predict(RUBBER, surface(), LOAD)
        none = data.sel(effect="none")
        assert float(none.total_friction) == pytest.approx(float(plain.total_friction), rel=1e-9)
        area = float(plain.total_contact_fraction)
        assert float(none.total_adhesive_friction) == pytest.approx(2e6 * area / 3e5, rel=1e-9)


def test_changes_are_those_of_the_answers(both: list[xr.Dataset]) -> None:
    for data in both:
        assert np.isnan(data.friction_change[0])
        for name, change in (
            ("total_friction", data.friction_change),
            ("total_contact_fraction", data.contact_fraction_change),
            ("friction_with_area_term", data.friction_with_area_term_change),
        ):
            expected = data[name].values[0] / data[name].values[1:] - 1.0
            np.testing.assert_allclose(change.values[1:], expected, rtol=1e-12)
        softened = float(data.contact_fraction_change.sel(effect="no softening"))
        assert softened > 0.2  # a softer rubber touches more


def test_finished_answers_are_not_found_again(tmp_path: Path) -> None:
    warm = replace(CHAIN, conditions=Conditions(temperature=313.15))
    told: list[Progress] = []
    first = effects(warm, RUBBER, surface(), LOAD, folder=tmp_path, on_task=told.append)
    # with one effect, leaving it out is leaving out everything: two different answers
    assert first.effect.values.tolist() == ["all", "no temperature", "none"]
    assert [one.stored for one in told] == [False, False]
    told.clear()
    again = effects(warm, RUBBER, surface(), LOAD, folder=tmp_path, on_task=told.append)
    assert [one.stored for one in told] == [True, True]
    assert again.identical(first)
    assert "friction_with_area_term" not in first


def test_numbers_have_units_and_the_file_says_what_it_is_of(
    both: list[xr.Dataset], tmp_path: Path
) -> None:
    kept = netcdf.load_dataset(netcdf.save(both[1], tmp_path / "effects.nc"))
    assert all({"units", "long_name"} <= set(kept[name].attrs) for name in kept.variables)
    assert kept.attrs["model"] == "direct"
    assert kept.attrs["nominal_speed"] == 1.0
    assert '"heat": {"conductivity": 0.25' in kept.attrs["conditions"]


def test_table_and_figure_show_both_models(both: list[xr.Dataset]) -> None:
    text = as_text(effects_table(*both))
    rows = [line for line in text.splitlines() if "converged" in line]
    assert len(rows) == 10
    change = float(both[0].friction_change.sel(effect="no heat"))
    assert f"{100 * change:+.1f} %" in next(row for row in rows if "no heat" in row)
    figure = effects_figure(*both)
    assert [axes.get_xlabel() for axes in figure.axes][2] == "friction with area term [-]"
    widths = [patch.get_width() for patch in figure.axes[1].patches]
    np.testing.assert_allclose(widths, np.concatenate([one.total_friction for one in both]))
    assert f"{100 * change:+.0f} %" in [note.get_text() for note in figure.axes[1].texts]
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert labels == ["all effects", *NAMES[1:-1], "no effects"]


def test_no_number_lies_under_the_dotted_line(both: list[xr.Dataset]) -> None:
    figure = effects_figure(*both)
    figure.draw_without_rendering()
    for axes in figure.axes:
        assert len(axes.lines) == 2
        assert max(line.get_zorder() for line in axes.lines) < axes.patches[0].get_zorder()
        for note in axes.texts:
            own = note.get_window_extent(), [bar.get_window_extent() for bar in axes.patches]
            on_a_bar = any(bar.x0 <= own[0].x0 and own[0].x1 <= bar.x1 for bar in own[1])
            assert on_a_bar or note.get_bbox_patch() is not None, note.get_text()


def test_what_did_not_converge_is_said_and_has_no_changes(both: list[xr.Dataset]) -> None:
    failed = both[0].copy(deep=True)
    for name in ("total_friction", "total_contact_fraction", "friction_change"):
        failed[name][{"effect": 3}] = np.nan
    failed.prediction_status[{"effect": 3}] = "conditions not settled"
    assert "conditions not settled" in as_text(effects_table(failed), width=120)
    texts = [note.get_text() for note in effects_figure(failed).axes[1].texts]
    assert texts.count("not converged") == 1


@pytest.mark.parametrize(
    ("model", "rubber", "words"),
    [
        (Chain(), RUBBER, "effects need conditions with a temperature, softening or heat"),
        (
            Chain(conditions=Conditions(shear_stress=ConstantStress(1e6))),
            RUBBER,
            "got none with the model chain",
        ),
        (KlueppelHeinrich(1.0, 1e-3), RUBBER, "got the model klueppel_heinrich"),
        (CHAIN, gs.Rubber(5e6, [1e7], [1e-3]), "reference_temperature and shift"),
    ],
)
def test_what_has_no_effects_is_one_sentence(model: object, rubber: gs.Rubber, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        effect_tasks(model, rubber, surface(), LOAD)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)
