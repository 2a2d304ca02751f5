"""Klueppel and Heinrich against closed forms of the integral, its limits and its scalings."""

import importlib
from dataclasses import replace

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.model import Load, Model
from gripscale.rubber import Rubber, styrene_butadiene
from gripscale.surface import HeightDifference, SelfAffineFit, fit_self_affine, height_difference
from gripscale.theory import KlueppelHeinrich, klueppel_heinrich
from tests.theory.test_persson import road

module = importlib.import_module("gripscale.theory.klueppel_heinrich")

PARALLEL, PERPENDICULAR, SMALLEST = 4e-3, 1e-3, 1e-5
STATED = {
    "pressure": 3e5,
    "speed": 0.3,
    "layer_ratio": 2.0,
    "penetration_depth": 5e-4,
    "smallest_wavelength": SMALLEST,
}
ZENER = Rubber(3e6, [27e6], [1e-4])
QUADRATURE = 1e-6
"""The last doubling changed less than this; what is left is a third of it."""


def surface(hurst: float, scale: float = 1.0) -> SelfAffineFit:
    return SelfAffineFit(hurst, PARALLEL * scale, PERPENDICULAR * scale, 1e-5, 1e-3, 0.0)


def slide(rubber=ZENER, hurst=0.5, **changed):
    return klueppel_heinrich(rubber, surface(hurst), **{**STATED, **changed})


def prefactor(hurst: float) -> float:
    """Return 1/2 delta/(p_0 v) S_0 w_min^2 [1/Pa], with S_0 = H xi_perp^2/(2 pi v xi_par)."""
    first = 2 * np.pi * STATED["speed"] / PARALLEL
    level = hurst * PERPENDICULAR**2 / (2 * np.pi * STATED["speed"] * PARALLEL)
    depth = STATED["layer_ratio"] * STATED["penetration_depth"]
    return 0.5 * depth / (STATED["pressure"] * STATED["speed"]) * level * first**2


@pytest.mark.parametrize("time", [1e-7, 1e-4, 1.0])
def test_one_maxwell_element_on_the_roughest_surface(time):
    """H = 1/2: int w E'' (w/w_min)^-2 dw = w_min^2 E (atan(w_max tau) - atan(w_min tau))."""
    found = slide(Rubber(3e6, [27e6], [time]))
    low, high = (2 * np.pi * STATED["speed"] * time / length for length in (PARALLEL, SMALLEST))
    expected = prefactor(0.5) * 27e6 * (np.arctan(high) - np.arctan(low))
    assert found.converged
    assert found.friction == pytest.approx(expected, rel=QUADRATURE)


@pytest.mark.parametrize("hurst", [0.3, 0.5, 0.8, 1.0])
def test_the_same_loss_at_every_frequency(hurst):
    """E'' = c: mu = prefactor c (r^(1 - 2H) - 1)/(1 - 2H), r = xi_par/lambda; log r for H = 1/2.

    Equal elements a factor e apart have E'' = pi E/2 with a ripple of 2/cosh(pi^2) = 2.1e-4."""
    times = np.exp(np.arange(-40.0, 30.0))
    found = slide(Rubber(3e6, np.full(times.size, 1e5), times), hurst)
    loss = 0.5 * np.pi * 1e5
    ratio = PARALLEL / SMALLEST
    power = 1 - 2 * hurst
    shape = np.log(ratio) if hurst == 0.5 else (ratio**power - 1) / power
    assert found.friction == pytest.approx(prefactor(hurst) * loss * shape, rel=2.2e-4)


def test_the_strain_spectrum_holds_the_variance():
    """int S dw from w_min on is the variance xi_perp^2/2 over xi_par^2."""
    fit = surface(0.8)
    q = 2 * np.pi / PARALLEL * np.exp(np.linspace(0, 20, 20_001))
    held = np.trapezoid(module.strain_spectrum(q, fit) * q, np.log(q))
    assert held == pytest.approx(0.5 * (PERPENDICULAR / PARALLEL) ** 2, rel=1e-6)


def test_no_loss_no_friction():
    assert slide(Rubber(3e6)).friction == 0.0
    assert slide(Rubber(3e6)).converged
    assert slide(speed=0.0).friction == 0.0
    assert np.isnan(slide().contact_fraction)


def test_each_wavelength_so_far_is_a_result_of_its_own():
    found = slide(styrene_butadiene(), 0.8)
    assert found.wavelength[[0, -1]] == pytest.approx([PARALLEL, SMALLEST])
    for at in (8, 20):
        shorter = slide(styrene_butadiene(), 0.8, smallest_wavelength=found.wavelength[at])
        assert shorter.friction == pytest.approx(found.running_friction[at], rel=1e-5)


def test_profiles_count_by_their_upper_part():
    [(line, _)] = road(16_001).measured.profiles
    upper = replace(line, z=np.where(line.z >= np.median(line.z), line.z, np.nan))
    assert upper.missing == len(line) // 2
    correlation = height_difference(line, top_height_fraction=0.5)
    assert fit_self_affine(height_difference(upper)).hurst == pytest.approx(
        fit_self_affine(correlation).hurst, rel=1e-9
    )
    found = klueppel_heinrich(ZENER, line, **STATED)
    assert found.surface == fit_self_affine(correlation)
    assert klueppel_heinrich(ZENER, correlation, **STATED).friction == found.friction
    assert klueppel_heinrich(ZENER, [line], **STATED).friction == found.friction
    assert (
        found.surface.xi_perpendicular
        < 0.8 * fit_self_affine(height_difference(line)).xi_perpendicular
    )


def test_as_a_model_of_a_measured_surface():
    prepared, load = road(16_001), Load(2e5, 0.2, 0.1)
    model = KlueppelHeinrich(layer_ratio=2.0, penetration_depth=5e-4)
    assert isinstance(model, Model)
    seen = []
    data = model.predict(ZENER, prepared, load, on_progress=seen.append)
    stated = {**STATED, "pressure": 2e5, "speed": 0.2, "smallest_wavelength": 1e-3}
    found = klueppel_heinrich(ZENER, prepared.measured.profiles[0][1], **stated)
    assert seen[0].friction == float(data.total_friction) == found.friction
    assert float(data.total_friction_from_dissipation) == found.friction
    assert np.isnan(data.total_contact_fraction)
    assert float(data.footprint) == 0.1
    assert data.attrs["model"] == "klueppel_heinrich"
    assert all({"units", "long_name", "source"} <= set(data[name].attrs) for name in data.data_vars)
    assert model.predict(ZENER, prepared.only(model.needs), load).identical(data)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"layer_ratio": 0.0}, "layer_ratio must be greater than zero"),
        ({"penetration_depth": -1.0}, "penetration_depth must be greater than zero"),
        ({"smallest_wavelength": 1e-2}, "must be below the cut-off length of the surface, 0.004 m"),
        ({"pressure": 0.0}, "pressure must be greater than zero"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(InputError, match=message):
        slide(**change)


def test_a_surface_must_be_one():
    with pytest.raises(InputError, match="profile must be a Profile or a list of them"):
        klueppel_heinrich(ZENER, [1.0], **STATED)
    straight = HeightDifference(np.geomspace(1e-5, 1e-2, 40), np.geomspace(1e-5, 1e-2, 40))
    with pytest.raises(InputError, match="plateau"):
        klueppel_heinrich(ZENER, straight, **STATED)
