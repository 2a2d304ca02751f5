"""The same lines in the block and in the half-space: what finite strain changes."""

from dataclasses import replace

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.core.status import Status
from gripscale.half_space import surface_of_sines
from studies.finite_strain_pairs import solve_both_ways
from tests.half_space.rough_cases import ZENER
from tests.samples import GENTLE_SINES as GENTLE

LOAD = {"pressure": 5e4, "speed": 0.1}


@pytest.fixture(scope="module")
def pairs():
    lines = [surface_of_sines(GENTLE, 20e-3, seed) for seed in range(4)]
    return solve_both_ways(ZENER, lines, **LOAD)


def test_gentle_lines_touch_as_small_strain_says(pairs):
    """Slopes of 0.15: finite strain changes some per cent (second order in the slope)."""
    assert len(pairs.converged) == 4
    for name in ("contact_fraction", "friction_from_dissipation"):
        found = pairs.correction(name)
        assert abs(found.factor - 1.0) < 0.04
        assert found.low <= found.factor <= found.high
        assert 0.0 <= found.log_error < 0.02


def test_what_did_not_converge_does_not_count(pairs):
    first, *rest = pairs.pairs
    failed = replace(first, block=replace(first.block, status="iteration limit"))
    useless = replace(first, block=replace(first.block, status=Status.FRICTIONS_DISAGREE))
    changed = replace(pairs, pairs=[failed, useless, *rest])
    assert [pair.converged for pair in changed.pairs] == [False, False, True, True, True]
    assert "iteration limit" in failed.status
    assert "frictions disagree" in useless.status
    assert changed.mean("friction") == np.mean([pair.block.friction for pair in rest])
    data = changed.to_dataset()
    found = changed.correction("friction_from_dissipation")
    assert list(data.status.values[2:]) == ["converged"] * 3
    assert data.attrs["friction_from_dissipation_correction"] == found.factor


def test_few_pairs_and_empty_classes_have_no_interval(pairs):
    found = replace(pairs, pairs=pairs.pairs[:2]).correction("friction")
    assert np.isfinite(found.factor)
    assert np.isnan([found.low, found.high]).all()
    classes, total = pairs.by_class("slope", [10.0]), pairs.correction("contact_fraction")
    assert classes.contact_fraction_factor[0] == pytest.approx(total.factor, rel=1e-12)
    assert classes.contact_fraction_factor_low[0] == pytest.approx(total.low, rel=1e-12)
    assert np.isnan(classes.friction_factor[1])


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda pairs: solve_both_ways(ZENER, [], **LOAD), "lines"),
        (lambda pairs: pairs.by_class("height", [1.0]), "by must be"),
        (lambda pairs: pairs.by_class("slope", [1.0, 0.5]), "edges must increase"),
    ],
)
def test_what_cannot_be_asked_is_refused(pairs, ask, says):
    with pytest.raises(InputError, match=says):
        ask(pairs)


def test_classes_add_up_to_the_whole(pairs):
    for by, edges in (("slope", [0.05, 0.1]), ("pressure", [1e5, 4e5])):
        classes = pairs.by_class(by, edges)
        assert dict(classes.sizes) == {"model": 2, "class": 3}
        np.testing.assert_allclose(classes.load_share.sum("class"), 1.0, rtol=1e-12)
        for model in classes.model.values:
            parts = classes.sel(model=model)
            for name in ("contact_fraction", "friction"):
                assert parts[name].sum() == pytest.approx(pairs.mean(name, model), rel=1e-12)
    # crests are gentle and carry the load; friction comes from beside them
    steep = pairs.by_class("slope", [0.05]).isel({"class": 1, "model": 0})
    assert steep.friction / pairs.mean("friction") > steep.load_share
