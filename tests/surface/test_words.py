"""What the surface says of itself is in millimetres and without names of the code."""

from __future__ import annotations

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import HeightDifference, Profile, clean, fit_self_affine, fit_sines


def test_a_crop_is_told_in_millimetres() -> None:
    x = np.arange(2001) * 1e-3
    profile = Profile(x, 1e-3 * np.sin(20.0 * x))
    report = clean(profile, crop=(0.12, 1.78), valid_range=(-0.05, 0.05))[1]
    assert report["crop"].note == "kept 120 mm to 1780 mm"
    assert report["dropouts"].note.endswith("kept -50 mm to 50 mm")


@pytest.mark.parametrize("fit", [fit_self_affine, lambda curve: fit_sines(curve, scales=2)])
def test_a_curve_that_vanishes_is_named_in_words(fit) -> None:
    lag = np.geomspace(1e-4, 1e-1, 30)
    curve = HeightDifference(lag, np.zeros_like(lag), np.full(lag.size, 10.0))
    with pytest.raises(InputError, match=r"^the heights must differ, a plane has no roughness"):
        fit(curve)
