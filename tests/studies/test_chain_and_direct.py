"""The parts of the study of chain and direct contact, on numbers by hand."""

from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale.surface import self_affine_profile
from studies.chain_and_direct.judge import errors, held_out, mean, rms, worst
from studies.chain_and_direct.surfaces import lowered_tops
from studies.chain_and_direct.table import Key, Numbers, numbers
from studies.chain_and_direct.variants import CUT_OFF, spectral_bands, touching

E = np.e


def test_errors_are_logarithms_of_ratios() -> None:
    direct = {("a", "r", "1"): Numbers(0.1, 0.2), ("b", "r", "1"): Numbers(0.1, 0.2)}
    chain = {("a", "r", "1"): Numbers(0.1 * E, 0.2), ("b", "r", "1"): Numbers(0.1, 0.2 / E**2)}
    found = errors(chain, direct)
    np.testing.assert_allclose(rms(found), np.sqrt([0.5, 2.0]))
    np.testing.assert_allclose(mean(found), [0.5, -1.0])
    np.testing.assert_allclose(worst(found), [1.0, 2.0])


def test_a_family_is_judged_by_what_the_others_choose() -> None:
    def of(a: float, b: float, c: float) -> dict[Key, np.ndarray]:
        return {(s,): np.array([e, e]) for s, e in (("a", a), ("b", b), ("c", c))}

    candidates = {"good on a": of(0.0, 0.5, 0.5), "even": of(0.3, 0.3, 0.3)}
    out, chosen = held_out(candidates, {"a": "A", "b": "B", "c": "C"})
    # Without A "even" wins (0.3 against 0.5); without B or C 0.0 and 0.5 have an rms of 0.35.
    assert chosen == {"A": "even", "B": "even", "C": "even"}
    assert out[("a",)][0] == 0.3


def test_known_numbers_are_not_solved_again(tmp_path: Path) -> None:
    solved: list[Key] = []

    def solve(key: Key) -> Numbers:
        solved.append(key)
        return Numbers(float(key[1]), 2.0)

    path, keys = tmp_path / "n.csv", [("x, y", "1"), ("z", "2")]
    first = numbers(path, keys[:1], solve)
    both = numbers(path, keys, solve)
    assert solved == keys
    assert both == {keys[0]: Numbers(1.0, 2.0), keys[1]: Numbers(2.0, 2.0)} | first


def test_tops_are_lowered_and_nothing_else() -> None:
    profile = gs.Profile(1e-3 * np.arange(101), 1e-3 * np.linspace(0.0, 1.0, 101))
    worn = lowered_tops(profile, 0.4, 0.25)
    np.testing.assert_allclose(worn.z[:61], profile.z[:61])
    assert worn.z[-1] == pytest.approx(1e-3 * (0.6 + 0.25 * 0.4))


def test_bands_keep_height_and_slope_of_the_spectrum() -> None:
    profile = self_affine_profile(0.8, 2e-3, 0.6e-3, 0.8, 50e-6, 7)
    spectrum = gs.surface.profile_spectrum(profile)
    power = spectrum.density * spectrum.width
    kept = spectrum.wavenumber <= 2.0 * np.pi / CUT_OFF
    for waves in (3, 6):
        stack = spectral_bands(profile, gs.Rubber(5e6), waves)
        assert len(stack) == waves
        assert 0.5 * np.sum(stack.amplitude**2) == pytest.approx(power[kept].sum(), rel=1e-3)
        slope = np.sqrt((spectrum.wavenumber**2 * power)[kept].sum())
        assert stack.rms_slope == pytest.approx(slope, rel=1e-3)


def test_heights_that_touch_are_smoother_on_a_worn_profile() -> None:
    rough = self_affine_profile(0.8, 3e-3, 1e-3, 0.3, 50e-6, 5)
    worn = lowered_tops(rough, 0.4, 0.15)
    tread = gs.Rubber(10e6, [20e6], [1e-4])
    touched = touching(worn, tread, 4)
    everywhere = gs.fit_sines(gs.height_difference(worn), scales=4, cut_off=CUT_OFF)
    assert touched.rms_slope < 0.6 * everywhere.rms_slope
