"""The law from lines to their surface: its statistic, its limits, and one map it never saw."""

from __future__ import annotations

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.half_space import line_to_map

WAVE = 0.01


def test_upper_height_of_known_distributions() -> None:
    random = np.random.default_rng(0)
    x = 1e-4 * np.arange(200_000)
    for heights, known in (
        (random.standard_normal(x.size), 2.326),  # normal quantile of 0.99
        (random.random(x.size), 0.49 * math.sqrt(12.0)),
        (-random.exponential(size=x.size), 1.0 + math.log(0.99)),
    ):
        # the 99 % quantile of 1,600 values a piece scatters by 4 %; of 125 pieces by 0.4 %
        assert line_to_map.upper_height(gs.Profile(x, heights), WAVE) == pytest.approx(
            known, abs=0.03
        )


def test_trends_gaps_and_offsets_do_not_count() -> None:
    random = np.random.default_rng(1)
    x = 1e-4 * np.arange(64_000)
    z = 1e-3 * random.standard_normal(x.size)
    plain = line_to_map.upper_height(gs.Profile(x, z), WAVE)
    long_wave = 0.05 * np.sin(2.0 * np.pi * x / x[-1])
    steps = np.where(np.arange(x.size) < 32_000, 0.0, 1.0)
    assert line_to_map.upper_height(gs.Profile(x, z + steps), WAVE) == pytest.approx(plain)
    assert line_to_map.upper_height(gs.Profile(x, z + 0.02 * long_wave), WAVE) == pytest.approx(
        plain, rel=0.02
    )
    z[::7] = np.nan
    assert line_to_map.upper_height(gs.Profile(x, z), WAVE) == pytest.approx(plain, rel=0.02)
    with pytest.raises(InputError, match="two different heights"):
        line_to_map.upper_height(gs.Profile(x, np.zeros(x.size)), WAVE)


def test_limits() -> None:
    for reach in (1.0, 2.3, 4.0):
        area = line_to_map.contact_fraction_ratio(reach, [1e-6, 1.0])
        assert area.ratio == pytest.approx(
            [line_to_map.CONTACT_FRACTION_LAW.at(reach), 1.0], rel=1e-5
        )
        assert area.uncertainty == pytest.approx(
            [line_to_map.CONTACT_FRACTION_LAW.scatter, 0.0], abs=1e-5
        )
        friction = line_to_map.friction_ratio(reach, [1e-6, 1.0])
        assert friction.ratio == pytest.approx(
            [line_to_map.FRICTION_LAW.at(reach), line_to_map.FULL_CONTACT_FRICTION]
        )
        between = line_to_map.contact_fraction_ratio(reach, np.linspace(0.01, 0.99, 50))
        on_the_surface = between.ratio * np.linspace(0.01, 0.99, 50)
        assert (np.diff(on_the_surface) > 0.0).all()


def test_a_gaussian_map_is_within_the_scatter() -> None:
    """A family that the law was not fitted to, small enough for a test."""
    points, step = 256, 2e-4
    k = np.hypot(np.fft.fftfreq(points, step)[:, None], np.fft.rfftfreq(points, step)[None, :])
    inside = (k > 0.9 / 12.8e-3) & (k < 1.0 / 8e-4)
    noise = np.fft.rfft2(np.random.default_rng(5).standard_normal((points, points)))
    z = np.fft.irfft2(noise * np.where(inside, np.maximum(k, 1.0) ** -1.8, 0.0), (points, points))
    x = step * np.arange(points)
    z *= 8e-4 / z.std()
    rubber = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)
    load = {
        "pressure": 3e5, "speed": 0.3, "smallest_wavelength": 8e-4, "periodic": True,
        "tolerance": None,
    }  # fmt: skip
    whole = gs.solve_rough_contact(rubber, gs.HeightMap(x, x, z), **load)
    profiles = [gs.Profile(x, z[:, at]) for at in range(0, points, 4)]
    lines = [gs.solve_rough_contact(rubber, profile, **load) for profile in profiles]
    area = np.mean([line.contact_fraction for line in lines])
    friction = np.mean([line.friction_from_dissipation for line in lines])
    reach = line_to_map.upper_height(profiles, 12.8e-3)
    for measured, law in (
        (whole.contact_fraction / area, line_to_map.contact_fraction_ratio(reach, area)),
        (whole.friction_from_dissipation / friction, line_to_map.friction_ratio(reach, area)),
    ):
        assert abs(math.log(measured / float(law.ratio))) < 2.0 * float(law.uncertainty)
        assert abs(math.log(measured)) > 0.02
