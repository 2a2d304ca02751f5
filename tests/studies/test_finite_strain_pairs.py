"""The same lines in the block and in the half-space: what finite strain changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.core.status import Status
from gripscale.half_space import surface_of_sines
from gripscale.surface import SineStack
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


def test_gentler_lines_touch_more_as_small_strain_says(pairs):
    """A tenth of heights and pressure, nearly the same contact: the correction must fade."""
    stack = SineStack(GENTLE.wavelength, 0.1 * GENTLE.amplitude)
    lines = [surface_of_sines(stack, 20e-3, seed) for seed in range(4)]
    faint = solve_both_ways(ZENER, lines, pressure=5e3, speed=0.1)
    deviation = faint.mean("contact_fraction") / faint.mean("contact_fraction", "half_space") - 1
    assert abs(deviation) < 0.01


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


def test_few_pairs_have_no_interval(pairs):
    found = replace(pairs, pairs=pairs.pairs[:2]).correction("friction")
    assert np.isfinite(found.factor)
    assert np.isnan([found.low, found.high]).all()


def test_workers_change_nothing(pairs):
    lines = [pair.line for pair in pairs.pairs]
    told = []
    alone = solve_both_ways(ZENER, lines, workers=1, on_pair=told.append, **LOAD)
    assert len(told) == len(lines)
    for one, other in zip(alone.pairs, pairs.pairs, strict=True):
        assert one.block.friction == other.block.friction
        assert one.half_space.friction == other.half_space.friction


def test_no_lines():
    with pytest.raises(InputError, match="lines"):
        solve_both_ways(ZENER, [], **LOAD)


def test_bad_load_is_one_sentence(pairs):
    with pytest.raises(gs.InputError, match="pressure"):
        solve_both_ways(ZENER, [pairs.pairs[0].line], pressure=-1.0, speed=0.1)


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


def test_the_whole_in_one_class_has_the_factor_of_all(pairs):
    classes = pairs.by_class("slope", [10.0])
    total = pairs.correction("contact_fraction")
    assert classes.contact_fraction_factor[0] == pytest.approx(total.factor, rel=1e-12)
    assert classes.contact_fraction_factor_low[0] == pytest.approx(total.low, rel=1e-12)
    assert np.isnan(classes.friction_factor[1])


def test_classes_are_refused_by_name(pairs):
    with pytest.raises(InputError, match="by must be"):
        pairs.by_class("height", [1.0])
    with pytest.raises(InputError, match="edges must increase"):
        pairs.by_class("slope", [1.0, 0.5])
