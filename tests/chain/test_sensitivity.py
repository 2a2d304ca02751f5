"""Derivatives of the friction of waves against full solutions and closed forms."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain.sensitivity import STEP
from gripscale.conditions import Conditions
from gripscale.core.errors import InputError
from gripscale.rubber.banded import Band, BandedRubber
from gripscale.theory import full_contact_friction
from tests.samples import (
    FAST_RUBBER,
    SHIFTED_RUBBER,
    SHIFTED_SINES,
    SHIFTED_VALUES,
    THERMAL,
    THREE_SINES,
    ZENER,
)

WAVE = {"wavelength": 1e-3, "amplitude": 1.2e-4, "pressure": 3e6, "speed": 1.0, "load_time": 1e-3}
MESH = {"columns": 256, "rows": 30}
JUDGE = {**MESH, "residual_tolerance": 1e-10}
"""Of waves solved from nothing."""
TOLERANCE = 0.01
"""Of the largest derivative, near one. Steps of the two differences are a half of one another."""

QUANTITIES = ("friction", "contact_fraction")
NAMES = ("ln_storage", "ln_loss", "ln_bulk_modulus", "ln_pressure")


@pytest.fixture(scope="module")
def wave():
    """Half of the wave in contact, with strains of a quarter."""
    return gs.solve_scale(FAST_RUBBER, **WAVE, **MESH)


@pytest.fixture(scope="module")
def data(wave):
    return gs.sensitivity(wave, bands_per_decade=5)


def difference(low, high, step) -> np.ndarray:
    """Central difference of ln mu and ln A, over the whole range of both results."""
    logs = [np.log([each.friction, each.contact_fraction]) for each in (low, high)]
    return (logs[1] - logs[0]) / (2.0 * step)


def judged(data, name, expected) -> None:
    for quantity, value in zip(QUANTITIES, expected, strict=True):
        derivative = float(data[f"d_ln_{quantity}_d_{name}"].sum())
        assert derivative == pytest.approx(value, abs=TOLERANCE), quantity


def stiffer(rubber: gs.Rubber, factor: float) -> gs.Rubber:
    return replace(
        rubber,
        equilibrium_modulus=rubber.equilibrium_modulus * factor,
        moduli=rubber.moduli * factor,
    )


@pytest.mark.parametrize("name", ["speed", "pressure"])
def test_load_as_waves_solved_from_nothing(data, name):
    low, high = (
        gs.solve_scale(FAST_RUBBER, **WAVE | {name: WAVE[name] * np.exp(by)}, **JUDGE)
        for by in (-STEP / 2, STEP / 2)
    )
    judged(data, f"ln_{name}", difference(low, high, STEP / 2))


def test_all_moduli_together_as_a_stiffer_rubber_and_as_less_pressure(data):
    low, high = (
        gs.solve_scale(stiffer(FAST_RUBBER, np.exp(by)), **WAVE, **JUDGE)
        for by in (-STEP / 2, STEP / 2)
    )
    expected = difference(low, high, STEP / 2)
    for quantity, value in zip(QUANTITIES, expected, strict=True):
        of = {name: float(data[f"d_ln_{quantity}_d_{name}"].sum()) for name in NAMES}
        assert of["ln_storage"] + of["ln_loss"] == pytest.approx(value, abs=TOLERANCE)
        # moduli and pressure have one unit
        assert sum(of.values()) == pytest.approx(0.0, abs=2 * TOLERANCE)  # of four differences
    assert abs(float(data.d_ln_friction_d_ln_pressure)) > 5 * TOLERANCE


@pytest.mark.parametrize("term", range(2))
def test_bands_as_another_prony_series(data, term):
    """What a term changes in E' and E'' of each band, times their derivatives, is what the wave
    with the other series has: no band is in it. The lowest harmonic of a band stands for it; the
    mean state, which the lowest band holds too, has relaxed and changes by less than that."""
    first = 2.0 * np.pi * WAVE["speed"] / WAVE["wavelength"]
    harmonic = first * np.arange(1, MESH["columns"] // 2 + 1)
    edges = np.geomspace(
        data.frequency[0] / 10**0.1, data.frequency[-1] * 10**0.1, data.sizes["frequency"] + 1
    )

    def of(by: float) -> gs.Rubber:
        moduli = FAST_RUBBER.moduli.copy()
        moduli[term] *= np.exp(by)
        return replace(FAST_RUBBER, moduli=moduli)

    change = []
    for low, high in itertools.pairwise(edges):
        within = harmonic[(harmonic >= low * 0.999) & (harmonic < high)]
        at = within[0] if within.size else high
        less, more = (of(by).complex_modulus(at) for by in (-1e-3, 1e-3))
        change.append([np.log(more.real / less.real) / 2e-3, np.log(more.imag / less.imag) / 2e-3])
    storage, loss = np.transpose(change)
    less, more = (float(of(by).relaxation_modulus(WAVE["load_time"])) for by in (-1e-3, 1e-3))
    missing = np.log(more / less) / 2e-3 - storage[0]
    ends = (0.0, 0.5 * first)
    of_mean = difference(
        *(
            gs.solve_scale(BandedRubber.of(FAST_RUBBER, Band(*ends, np.exp(by))), **WAVE, **JUDGE)
            for by in (-STEP, STEP)
        ),
        STEP,
    )
    low, high = (gs.solve_scale(of(by), **WAVE, **JUDGE) for by in (-STEP / 2, STEP / 2))
    expected = difference(low, high, STEP / 2)
    assert np.abs(expected).max() > 0.1
    for quantity, value in zip(QUANTITIES, expected - missing * of_mean, strict=True):
        by_storage, by_loss = (
            data[f"d_ln_{quantity}_d_{name}"].values for name in ("ln_storage", "ln_loss")
        )
        # edges between nodes scatter the logarithm of the contact fraction by 1e-3
        scatter = 0.02 if quantity == "contact_fraction" else 0.0
        together = by_storage @ storage + by_loss @ loss
        assert together == pytest.approx(value, abs=TOLERANCE + scatter)


@pytest.mark.parametrize("term", range(3))
def test_terms_as_waves_solved_from_nothing(data, term):
    """The same step on the same mesh: only starts and residuals differ."""

    def logs(by: float) -> np.ndarray:
        moduli = np.array([FAST_RUBBER.equilibrium_modulus, *FAST_RUBBER.moduli])
        moduli[term] *= np.exp(by)
        rubber = replace(FAST_RUBBER, equilibrium_modulus=moduli[0], moduli=moduli[1:])
        wave = gs.solve_scale(rubber, **WAVE, **JUDGE)
        return np.log([wave.friction, wave.contact_fraction])

    expected = (logs(STEP) - logs(-STEP)) / (2.0 * STEP)
    assert np.abs(expected).max() > 0.1
    for quantity, value in zip(QUANTITIES, expected, strict=True):
        by_term = data[f"d_ln_{quantity}_d_ln_modulus"]
        assert float(by_term[term]) == pytest.approx(value, abs=1e-3)
    assert data.relaxation_time.values[1:] == pytest.approx(FAST_RUBBER.relaxation_times)


@pytest.mark.parametrize("solver", ["finite_strain", "half_plane"])
def test_full_contact_of_a_flat_sine_in_closed_form(solver):
    """mu of full contact is proportional to Im M / p: by E'' one, by E' none, by pressure minus
    one, by speed d ln Im M / d ln w. At a slope of 0.03 finite strain differs by its square."""
    size = {"wavelength": 1e-3, "amplitude": 5e-6}
    rubber, load = replace(ZENER, bulk_modulus=1e12), {"pressure": 3e6, "speed": 0.1}
    if solver == "half_plane":
        wave = gs.theory.solve_half_plane(rubber, **size, **load, points=64)
    else:
        wave = gs.solve_scale(replace(rubber, bulk_modulus=1e10), **size, **load, **MESH)
    assert wave.contact_fraction == 1.0
    data = gs.sensitivity(wave, bands_per_decade=1)

    def friction(speed: float) -> float:
        modulus = rubber.plane_strain_modulus(2.0 * np.pi * speed / size["wavelength"])
        return float(full_contact_friction(modulus, pressure=load["pressure"], **size))

    by_speed = np.log(friction(0.101) / friction(0.099)) / np.log(0.101 / 0.099)
    expected = {"ln_loss": 1.0, "ln_storage": 0.0, "ln_pressure": -1.0, "ln_speed": by_speed}
    for name, value in expected.items():
        assert float(data[f"d_ln_friction_d_{name}"].sum()) == pytest.approx(value, abs=TOLERANCE)
    assert float(data.d_ln_contact_fraction_d_ln_pressure) == 0.0


CHAIN = {"pressure": 3e5, "speed": 1.0, "footprint": 0.1}


@pytest.mark.parametrize("classes", [1, 2])
def test_chain_as_chains_solved_from_nothing(classes):
    """The load time of each wave and the pressure on it follow the wave before."""
    options = {"columns": 128, "pressure_classes": classes}
    sines = gs.SineStack(THREE_SINES.wavelength[1:], 0.3 * THREE_SINES.amplitude[1:])
    data = gs.sensitivity(gs.solve_chain(FAST_RUBBER, sines, **CHAIN, **options))
    for name in ("speed", "pressure"):
        low, high = (
            gs.solve_chain(
                FAST_RUBBER, sines, **CHAIN | {name: CHAIN[name] * np.exp(by)}, **options
            )
            for by in (-STEP, STEP)
        )
        judged(data, f"ln_{name}", difference(low, high, STEP))
    low, high = (
        gs.solve_chain(stiffer(FAST_RUBBER, np.exp(by)), sines, **CHAIN, **options)
        for by in (-STEP, STEP)
    )
    together = data.d_ln_friction_d_ln_storage.sum() + data.d_ln_friction_d_ln_loss.sum()
    # two differences of half the change each, on a mesh that scatters friction by 1e-3
    assert float(together) == pytest.approx(difference(low, high, STEP)[0], abs=0.03)


def test_settled_rubber_and_its_frequencies():
    """Waves keep the rubber that heat has made; frequencies are those of the master curve."""
    conditions = Conditions(temperature=313.15, heat=THERMAL)
    options = {"solver": "half_plane", "points": 64, "conditions": conditions}
    chain = gs.solve_chain(SHIFTED_RUBBER, SHIFTED_SINES, **SHIFTED_VALUES, **options)
    data, cold = (gs.sensitivity(chain, reference_temperature=t) for t in (None, 293.15))
    assert data.attrs["settled"] == 1
    shift = float(SHIFTED_RUBBER.shift.a(313.15, 293.15))
    assert float(cold.frequency[0] / data.frequency[0]) == pytest.approx(shift, rel=10**0.5 - 1)
    assert float(cold.d_ln_friction_d_ln_loss.sum()) == pytest.approx(
        float(data.d_ln_friction_d_ln_loss.sum()), abs=TOLERANCE
    )
    by_kelvin = float(data.d_ln_friction_d_temperature)
    rubbers = [
        [w.rubber.at(w.rubber.reference_temperature + t) for w in chain.scales] for t in (-2, 2)
    ]
    low, high = (
        gs.solve_chain(
            SHIFTED_RUBBER,
            SHIFTED_SINES,
            **SHIFTED_VALUES,
            solver="half_plane",
            points=64,
            rubber_at=lambda wave, so_far, each=each: each[len(so_far.scales)],
        )
        for each in rubbers
    )
    assert by_kelvin == pytest.approx(difference(low, high, 2.0)[0], rel=1e-9)


def test_banded_rubber_changes_the_moduli_of_its_band():
    rubber = BandedRubber.of(ZENER, Band(100.0, 1000.0, 1.1, 0.7))
    omega = np.array([0.0, 99.0, 100.0, -500.0, 999.0, 1000.0])
    plain, changed = ZENER.complex_modulus(omega), rubber.complex_modulus(omega)
    inside = np.array([False, False, True, True, True, False])
    assert changed.real == pytest.approx(np.where(inside, 1.1, 1.0) * plain.real)
    assert changed.imag == pytest.approx(np.where(inside, 0.7, 1.0) * plain.imag)


def test_refuses_what_has_no_derivatives(wave):
    with pytest.raises(InputError, match="RoughContact, ScaleResult or ChainResult; got 'wave'"):
        gs.sensitivity("wave")
    at_rest = gs.solve_scale(FAST_RUBBER, **WAVE | {"speed": 0.0}, **MESH)
    with pytest.raises(InputError, match="got speed 0 m/s"):
        gs.sensitivity(at_rest)
    with pytest.raises(InputError, match=r"of finite_strain or half_plane .*; got toy"):
        gs.sensitivity(replace(wave, model="toy"))
