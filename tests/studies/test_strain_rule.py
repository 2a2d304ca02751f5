"""The strain of a scale: lines, the sweeps' law, and a few contacts against both judges."""

from unittest.mock import patch

import numpy as np
import pytest

import gripscale as gs
from gripscale.rubber import KrausEnergy
from gripscale.rubber.softening import Kraus
from studies.strain_rule import static
from studies.strain_rule.lines import FAMILIES, PER_FAMILY, SINES, WAVES, line, rms_slope
from studies.strain_rule.sliding import solve_layers
from studies.strain_rule.static import Sweep, softening, solve
from studies.strain_rule.tables import by_family, covered, static_error
from tests.half_space.rough_cases import ZENER

LAW = Sweep(0.147, 0.0433, 0.03)
"""Near that of the first sweep."""


def test_lines_have_the_slope_of_their_number_and_no_wave_beyond_the_last() -> None:
    sine = line("sine", 0)
    assert rms_slope(sine.z) == pytest.approx(np.sqrt(2.0) * np.pi * SINES[0], rel=1e-9)
    for family in FAMILIES:
        spectrum = np.abs(np.fft.rfft(line(family, PER_FAMILY - 1).z))
        assert spectrum[WAVES + 1 :].max() < 1e-9 * spectrum.max()
    steep = line("self-affine", PER_FAMILY - 1)
    assert rms_slope(steep.z) == pytest.approx(0.8)


def test_the_law_of_the_half_space_is_that_of_the_block() -> None:
    """Secant modulus of shear at the same strain, a twentieth of the real one."""
    law = softening(LAW).softening
    assert isinstance(law, Kraus)
    shear = static.FLATTER * np.array([0.05, 0.1, 0.5])
    energy = KrausEnergy(0.147, 0.0433 * np.sqrt(3.0) / 20.0, 1e-3 * np.sqrt(3.0) / 20.0)
    factors = law.factors(shear / np.sqrt(3.0)).storage
    assert energy.shear_factor(shear) == pytest.approx(factors, rel=2e-3)
    assert LAW.kept(0.05 / np.sqrt(3.0)) == pytest.approx(factors[0], rel=2e-3)


def test_coverage_is_by_the_scatter_of_the_other_families() -> None:
    families = {"a": np.full(4, 0.1), "b": np.array([0.1, 0.3, -0.1, 0.1]), "c": np.zeros(2)}
    shares = covered(families)
    assert shares[2] == 1.0
    assert shares[1] == 0.75


def test_layers_without_softening_are_the_half_space() -> None:
    """The stack is one period deep: its longest wave decays to exp(-2 pi)."""
    road = line("three waves", 0)
    at = {"pressure": 2e4, "speed": 0.1}
    stack = solve_layers(ZENER, road, None, smallest=road.step * 512 / WAVES, **at)
    whole = gs.solve_rough_contact(ZENER, road, periodic=True, **at)
    assert stack.contact.contact_fraction == pytest.approx(whole.contact_fraction, rel=5e-3)
    assert stack.contact.friction == pytest.approx(whole.friction, rel=5e-3)


@pytest.mark.verification
@pytest.mark.parametrize("family", ["sine", "two waves", "mounded"])
def test_areas_are_those_of_the_softening_block(family: str) -> None:
    """Within 0.06: over all cases the rms is 0.05, and factors of 0.5 and 1.3 err by 0.1."""
    with patch.object(static, "sweep", lambda _: LAW):
        rows = solve(family, 0, "S100")
    errors = by_family([{k: str(v) for k, v in row.items()} for row in rows], static_error)
    assert np.abs(errors[family]).max() < 0.06
