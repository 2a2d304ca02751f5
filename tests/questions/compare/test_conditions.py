"""A comparison in its conditions: what reaches which model, and what is said of it."""

import math
from dataclasses import replace

import pytest

import gripscale as gs
from gripscale.chain import Chain
from gripscale.conditions import Conditions, ConstantStress
from gripscale.questions.compare.question import temperature_only
from gripscale.rubber import WLF, styrene_butadiene
from gripscale.surface import self_affine_profile
from gripscale.theory import HalfPlane
from tests.samples import KRAUS

CASE = gs.Case(
    self_affine_profile(0.8, 5e-3, 0.1e-3, 0.1, 1e-4, seed=4),
    replace(styrene_butadiene(), shift=WLF(8.0, 120.0)),
    pressure=3e5,
    speed=0.1,
    footprint=0.05,
    waves=3,
    smallest_wavelength=0.5e-3,
    chain=Chain(HalfPlane()),
    conditions=Conditions(temperature=308.15, softening=KRAUS, shear_stress=ConstantStress(2e6)),
)


@pytest.fixture(scope="module")
def made():
    return gs.compare(CASE, seeds=1, models=["chain_half_plane", "direct", "persson"]).ladder


def test_chain_and_direct_contact_know_every_effect(made):
    (subject,) = made.setups
    alone = gs.solve_rough_contact(
        subject.rubber,
        subject.surface.measured.cleaned[0],
        pressure=3e5,
        speed=0.1,
        footprint=0.05,
        smallest_wavelength=float(subject.surface.sines.wavelength[-1]),
        tolerance=subject.tolerance,
        conditions=subject.conditions,
    )
    direct, chain = (made.data.sel(model=name) for name in ("direct", "chain_half_plane"))
    assert direct.total_friction == pytest.approx(alone.friction, rel=1e-12)
    areas = alone.contact_fraction, float(chain.total_contact_fraction)
    for member, area in zip((direct, chain), areas, strict=True):
        assert member.total_adhesive_friction == pytest.approx(2e6 * area / 3e5, rel=1e-12)


def test_a_theory_knows_temperature_and_softening(made):
    subject, persson = made.setups[0], made.data.sel(model="persson")
    line = subject.surface.measured.cleaned[0]
    spectrum = gs.surface.areal_spectrum(gs.surface.profile_spectrum(line))
    end = 2 * math.pi / spectrum.wavenumber[-1]
    smallest = max(float(subject.surface.sines.wavelength[-1]), end)
    load = {"pressure": 3e5, "speed": 0.1, "smallest_wavelength": smallest}
    asked = Conditions(temperature=308.15, softening=subject.conditions.softening)
    alone = gs.theory.persson(subject.rubber, spectrum, conditions=asked, **load)
    warm = gs.theory.persson(subject.rubber.at(308.15), spectrum, **load)
    assert alone.friction > 1.5 * warm.friction  # full contact: g alone counts, near its peak
    assert persson.total_friction == pytest.approx(alone.friction, rel=1e-9)
    own = 2e6 * alone.contact_fraction / 3e5
    assert persson.total_adhesive_friction == pytest.approx(own, rel=1e-9)
    words = "Softening: in the chains, the direct contacts and Persson"
    assert any(words in line for line in temperature_only(made.data))


def test_a_comparison_over_the_temperature_asks_every_model_at_it(made):
    models, temperatures = ["chain_half_plane", "persson"], {"temperature": "20 C,35 C"}
    over = gs.compare(CASE, vary=temperatures, seeds=1, models=models)
    data = over.data
    warm = data.sel(temperature=308.15)
    for member in models:
        own = float(made.data.total_friction.sel(model=member))
        assert float(warm.total_friction.sel(model=member)) == pytest.approx(own, rel=1e-12)
        cold = float(data.total_friction.sel(temperature=293.15, model=member))
        assert abs(cold / own - 1.0) > 0.01
    kelvins = [setup.continuation.conditions.temperature for setup in over.ladder.setups]
    assert kelvins == [293.15, 308.15], "roughness below the measurement, too"
