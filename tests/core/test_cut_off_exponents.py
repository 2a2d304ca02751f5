"""How predictions change with the smallest wavelength: closed forms of curves, means, reasons."""

import math

import numpy as np
import pytest

from gripscale.cut_off_exponents import NOT_TOLD, CutOffExponents, between, of_curve, of_mean


@pytest.mark.parametrize("factor", [2.0**0.25, 2.0, 3.5])
def test_power_laws_and_logarithms_are_exact_however_far_waves_are_apart(factor):
    wavelength = 0.01 / factor ** np.arange(6)
    area, mu = wavelength**0.3, 0.1 + 0.05 * np.log(0.01 / wavelength)
    found = of_curve(wavelength, area, mu, moving=True)
    octave = mu[-1] - 0.05 * math.log(2.0)
    assert found.contact_fraction == pytest.approx(0.3)
    assert found.friction == pytest.approx(math.log(octave / mu[-1]) / math.log(2.0))
    assert found.why_not == ""


def test_waves_less_than_an_octave_apart_all_count():
    found = of_curve([1.0, 0.8], [0.5, 0.4], [0.1, 0.2], moving=True)
    assert found.contact_fraction == pytest.approx(1.0)
    assert found.friction == pytest.approx(-math.log(2.0) / math.log(1.25))


@pytest.mark.parametrize(
    ("found", "why"),
    [
        (of_curve([1.0], [0.5], [0.1], moving=True), "only one wave"),
        (of_curve([2.0, 1.0], [0.5, 0.4], [0.0, 0.0], moving=False), "no friction at rest"),
        (of_curve([2.0, 1.0], [0.5, 0.4], [0.0, 0.1], moving=True), "friction not above zero"),
        (between(2.0, (math.nan, math.nan), (0.1, 0.2), moving=True), "does not tell the contact"),
        (of_mean([], [], []), NOT_TOLD.why_not),
    ],
)
def test_what_is_not_known_has_a_reason(found, why):
    assert math.isnan(found.friction) or math.isnan(found.contact_fraction)
    assert why in found.why_not


def test_a_mean_changes_as_its_parts_do_together():
    areas, frictions = np.array([0.1, 0.3]), np.array([0.2, 0.6])
    exponents = [CutOffExponents(0.2, -0.1), CutOffExponents(0.5, -0.4)]
    step = 1e-6
    moved = sum(
        mu * math.exp(one.friction * step) for mu, one in zip(frictions, exponents, strict=True)
    )
    found = of_mean(exponents, areas, frictions)
    assert found.friction == pytest.approx(math.log(moved / frictions.sum()) / step, rel=1e-5)
    assert found.contact_fraction == pytest.approx((0.1 * 0.2 + 0.3 * 0.5) / 0.4)
