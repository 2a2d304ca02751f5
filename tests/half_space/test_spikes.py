"""Lines with spikes of one to three samples, as lasers make them, against those without.

Sixteen lines of eight kinds of surface: four with sharp edges, four without. 0.4 % of the points
are spikes of 0.5 to 4 mm, cleaned by the default rule, cut off at 0.4 mm.
"""

import numpy as np
import pytest

import gripscale as gs
from tests.verification.families import tread
from tests.verification.line_families import FAMILIES, STEP, Draw

POINTS = 4096
POSITION = STEP * np.arange(POINTS)
CUT_OFF = 0.4e-3
SHARP, SMOOTH = ("tiles", "porous", "cones", "polished"), ("gaussian", "skewed", "bells", "caps")
KINDS = SHARP + SMOOTH


def with_spikes(z, random):
    """Add runs of one to three samples, up or down, to 0.4 % of the points."""
    out = z.copy()
    for at in random.choice(POINTS - 4, round(0.004 * POINTS / 2.0), replace=False):
        width = random.integers(1, 4)
        out[at : at + width] += random.choice([-1.0, 1.0]) * random.uniform(0.5e-3, 4e-3)
    return out


def contact(z):
    line, _ = gs.clean(gs.Profile(POSITION, z))
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": CUT_OFF}
    return gs.solve_rough_contact(tread(), line, **load)


def ratios(kind, seed):
    """Contact area and friction of the line with spikes, cleaned, over those without."""
    random = np.random.default_rng([seed, KINDS.index(kind)])
    z = FAMILIES[kind](Draw(random, POSITION.size * STEP))
    clean, cleaned = contact(z), contact(with_spikes(z, random))
    return [
        getattr(cleaned, name) / getattr(clean, name)
        for name in ("contact_fraction", "friction_from_dissipation")
    ]


def test_spikes_change_area_and_friction_little():
    """Each within 8 %, the median of all within 2 %."""
    found = np.array([ratios(kind, seed) for kind in KINDS for seed in (1, 2)])
    assert np.abs(found - 1.0).max() < 0.08, found
    assert np.abs(np.median(found, axis=0) - 1.0).max() < 0.02, found


def test_without_the_rule_spikes_are_all_there_is():
    """The measure can fail: left in, they take half of the contact."""
    random = np.random.default_rng([1, 0])
    z = FAMILIES["tiles"](Draw(random, POSITION.size * STEP))
    spiky = gs.Profile(POSITION, with_spikes(z, random))
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": CUT_OFF}
    left = gs.solve_rough_contact(tread(), spiky, **load)
    assert left.contact_fraction < 0.9 * contact(z).contact_fraction
    assert left.friction_from_dissipation > 1.2 * contact(z).friction_from_dissipation


@pytest.mark.verification
@pytest.mark.parametrize("station", [0, 1])
def test_the_shipped_road_does_not_depend_on_its_cleaning(station):
    """No spikes taken, ISO 13473-1 and the default: friction within 3 % of one another."""
    from studies.shipped import DATA, PLATES

    name = f"20211011_aylesbury_dec_station_{station}.dat"
    road = gs.read_profile(DATA / "road" / name)
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 1e-4}
    frictions = [
        gs.solve_rough_contact(
            tread(), gs.clean(road, crop=PLATES, spikes=rule)[0], **load
        ).friction_from_dissipation
        for rule in (None, "iso13473", "isolated")
    ]
    assert max(frictions) < 1.03 * min(frictions)
