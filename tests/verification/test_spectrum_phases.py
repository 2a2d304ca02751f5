"""An answer from the spectrum of a surface holds that of the surface as often as it says.

The factors of the phases were fitted to families of studies/surface_families.py. What judges them
are sixteen others, those whose heights have a negative skewness also as surfaces with worn tops,
and the stations of the shipped road. An hour of one core without the truths of the maps kept.
"""

import math

import numpy as np
import pytest
import scipy.stats

import gripscale as gs
from gripscale.questions.answer.estimate import ESTIMATED
from studies.shipped import road, tread
from studies.spectrum_phases import answered, small_strain, spectrum_of
from tests.verification.known_surfaces import LARGEST, UNSEEN, all_known, truth

pytestmark = pytest.mark.verification


def held(case: gs.Case, true: dict[str, float]) -> dict[str, bool]:
    """Return whether the intervals of area and friction hold true numbers."""
    best = answered(case)
    ends = {n: [float(best[f"answer_{n}_{end}"]) for end in ("low", "high")] for n in ESTIMATED}
    return {name: ends[name][0] <= true[name] <= ends[name][1] for name in ESTIMATED}


@pytest.mark.parametrize("phases", ["real", "worn"])
def test_nine_of_ten_intervals_hold_the_surface(phases: str) -> None:
    found: dict[str, list[bool]] = {name: [] for name in ESTIMATED}
    for which in all_known(UNSEEN):
        whole = which.map
        if phases == "worn" and scipy.stats.skew(whole.z, axis=None) > -0.2:
            continue
        area, friction = truth(which).values()
        known = {"contact_fraction": area, "friction": friction}
        spectrum = spectrum_of(whole, phases)
        filled = which.conditions is not None
        case = which.case(spectrum, footprint=LARGEST, filled=filled)
        for name, inside in held(case, known).items():
            found[name].append(inside)
    for name, all_inside in found.items():
        print(phases, name, f"{sum(all_inside)} of {len(all_inside)}")
        # "worn": 0.1 of forty surfaces by chance
        assert np.mean(all_inside) >= 0.9 - 1.64 * math.sqrt(0.09 / len(all_inside)), name


@pytest.mark.parametrize("pressure", [3e4, 3e5])
@pytest.mark.parametrize("station", [0, 1])
@pytest.mark.parametrize("phases", ["real", "worn"])
def test_the_measured_road_lies_within(phases: str, station: int, pressure: float) -> None:
    """Measured: 2.9 to 4.5 times the area, 0.22 to 0.36 times the friction of random phases."""
    line, solid = road(station), tread()
    load = {"pressure": pressure, "speed": 0.3, "smallest_wavelength": 1e-4}
    own = small_strain(gs.Case(line, solid, **load))
    assert all(held(gs.Case(spectrum_of(line, phases), solid, **load), own).values())
