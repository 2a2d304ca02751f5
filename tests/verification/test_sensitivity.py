"""Derivatives of friction by one adjoint solution against central differences, at random."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space.sensitivity import Bands, FrictionAdjoint, modulus_changes, scalar_changes
from tests.half_space.rough_cases import isotropic_map
from tests.half_space.test_sensitivity import again, line

pytestmark = pytest.mark.verification

LINES, MAPS = 30, 10
STEP = 1e-5
"""Of ln M and ln p_0. On a line an asperity that comes into contact within the step bends mu(p_0):
with 3e-3 the difference of six patches by pressure is off by 21 %, on a grid eight times finer by
20 %, and with 3e-4 by 0.6 and 0.06 %. Contacts solved to 1e-9 of their pressure add 1e-4 of a
derivative."""


def random_rubber(random: np.random.Generator) -> gs.Rubber:
    """One to fifteen relaxations; nearly elastic ones and very lossy ones."""
    terms = int(random.integers(1, 16))
    relaxed = 10 ** random.uniform(5.5, 7.0)
    return gs.Rubber(
        equilibrium_modulus=relaxed,
        moduli=relaxed * 10 ** random.uniform(-1.0, 1.7, terms),
        relaxation_times=np.sort(10 ** random.uniform(-9.0, 0.0, terms))[::-1],
        bulk_modulus=2e11,
        reference_temperature=293.15,
        shift=gs.rubber.WLF(c1=8.0, c2=100.0),
    )


def random_contact(seed: int, dimensions: int):
    """A contact of 0.2 % to all of the area at 1e-4 to 30 m/s, on a fine grid."""
    random = np.random.default_rng(1000 * dimensions + seed)
    rubber = random_rubber(random)
    if dimensions == 1:
        surface, shortest = line(32768, 0.256, 5e-4, random), 5e-4
    else:
        shortest = 2.4e-3
        surface = isotropic_map(64, seed=int(random.integers(1e6)), shortest=shortest)
    speed, load = 10 ** random.uniform(-4.0, 1.5), 10 ** random.uniform(-3.0, -0.05)
    modulus = abs(rubber.plane_strain_modulus(2.0 * np.pi * speed / 2e-3))
    return gs.solve_rough_contact(
        rubber,
        surface,
        pressure=0.15 * load * float(modulus),
        speed=speed,
        smallest_wavelength=shortest,
        periodic=True,
        tolerance=0.005 if dimensions == 1 else 0.02,
    )


def log_friction(contact, change, pressure=1.0) -> float:
    """ln mu on the same grid with ln M changed and the pressure multiplied."""
    return float(
        np.log(again(contact, change=change, pressure=pressure * contact.nominal_pressure))
    )


def errors(contact) -> dict[str, float]:
    """Errors of E', E'' by decade, speed, 10 K and pressure, over the largest derivative."""
    adjoint, bands = FrictionAdjoint.of(contact), Bands.of(contact, 1)
    friction = contact.friction_from_dissipation

    def difference(change) -> float:
        pair = (log_friction(contact, sign * STEP * change) for sign in (1.0, -1.0))
        return float(np.subtract(*pair)) / (2.0 * STEP)

    storage, loss = modulus_changes(contact)
    scalars = scalar_changes(contact)
    changes = {
        name: [np.where(bands.of_wave == band, change, 0.0) for band in range(bands.centre.size)]
        for name, change in (("storage", storage), ("loss", loss))
    }
    changes |= {"speed": [scalars["ln_speed"]], "10 K": [10.0 * scalars["temperature"]]}
    pairs = {
        name: [(adjoint.by_modulus(each).sum() / friction, difference(each)) for each in every]
        for name, every in changes.items()
    }
    ends = (log_friction(contact, 0.0, np.exp(sign * STEP)) for sign in (1.0, -1.0))
    expected = float(np.subtract(*ends)) / (2.0 * STEP)
    pairs["pressure"] = [(adjoint.by_log_pressure / friction, expected)]
    largest = max(abs(b) for name in ("storage", "loss") for _, b in pairs[name])
    return {name: max(abs(a - b) for a, b in each) / largest for name, each in pairs.items()}


@pytest.mark.parametrize(("dimensions", "count"), [(1, LINES), (2, MAPS)], ids=["lines", "maps"])
def test_derivatives_as_central_differences(dimensions, count):
    """See `docs/sensitivity.md` for the numbers."""
    table = []
    for seed in range(count):
        contact = random_contact(seed, dimensions)
        if contact.full_contact or not contact.friction_from_dissipation > 0.0:
            continue
        each = errors(contact)
        text = ", ".join(f"{name} {value:.4f}" for name, value in each.items())
        area, friction = contact.contact_fraction, contact.friction_from_dissipation
        print(f"{seed}: A {area:.3f}, mu {friction:.4f}, {contact.active.sum()} points: {text}")
        table.append(list(each.values()))
    rows = np.array(table)
    print("median", np.median(rows, axis=0), "nine of ten", np.quantile(rows, 0.9, axis=0))
    assert len(rows) >= 0.8 * count
    # measured 0.012, 0.04 and 0.53 % on lines, 0.004, 0.03 and 0.03 % on maps
    assert (np.median(rows, axis=0) <= 0.0003).all()
    assert (np.quantile(rows, 0.9, axis=0) <= 0.001).all()
    assert (rows <= 0.01).all()
