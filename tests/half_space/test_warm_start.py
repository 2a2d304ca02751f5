"""A contact that starts from that of another rubber, and what it may not start from."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from tests.samples import SHIFTED_RUBBER

from .rough_cases import isotropic_map, solve
from .test_sensitivity import line

SURFACES = {"line": (line(4096, 0.064, 1e-3), 1e-3), "map": (isotropic_map(64), 1.6e-3)}


@pytest.fixture(scope="module", params=SURFACES)
def contact(request):
    surface, shortest = SURFACES[request.param]
    return surface, solve(
        surface, rubber=SHIFTED_RUBBER, smallest_wavelength=shortest, tolerance=None
    )


def solve_from(surface, start, **more):
    rubber = replace(SHIFTED_RUBBER, moduli=1.3 * SHIFTED_RUBBER.moduli, bulk_modulus=3e9)
    length = {"smallest_wavelength": 1e-3 if isinstance(surface, gs.Profile) else 1.6e-3}
    return solve(surface, rubber=rubber, start=start, **length | {"tolerance": None} | more)


def test_it_is_the_contact_from_nothing(contact):
    surface, start = contact
    cold, warm = solve_from(surface, None), solve_from(surface, start)
    # both end at the residual of the solver, 1e-6 of the pressure
    assert warm.friction_from_dissipation == pytest.approx(cold.friction_from_dissipation, rel=1e-5)
    assert np.array_equal(warm.active, cold.active)
    assert len(warm.grids) == 1
    assert sum(grid.products for grid in warm.grids) < sum(grid.products for grid in cold.grids)


def test_grids_are_refined_from_the_start(contact):
    surface, start = contact
    cold, warm = (solve_from(surface, first, tolerance=0.05) for first in (None, start))
    assert warm.converged
    assert [grid.points for grid in warm.grids] == [
        grid.points for grid in cold.grids[-len(warm.grids) :]
    ]
    assert warm.friction_from_dissipation == pytest.approx(cold.friction_from_dissipation, rel=1e-5)
    assert warm.friction_error == pytest.approx(cold.friction_error, rel=1e-3)
    # the coarse grid is solved to 1e-3 only, with up to a hundredth of its points on the wrong side
    exponents = [each.cut_off_exponents.friction for each in (warm, cold)]
    assert exponents[0] == pytest.approx(exponents[1], abs=1e-2)


def test_it_starts_from_other_heights_and_another_cut_off(contact):
    surface, start = contact
    rough = replace(surface, z=1.05 * np.roll(surface.z, 1, axis=0))
    shortest = 0.5 * start.smallest_wavelength
    cold, warm = (solve_from(rough, first, smallest_wavelength=shortest) for first in (None, start))
    assert warm.friction_from_dissipation == pytest.approx(cold.friction_from_dissipation, rel=1e-5)
    assert np.array_equal(warm.active, cold.active)
    assert len(warm.grids) == 2  # that of the start, with the new waves, and twice as fine
    assert sum(grid.products for grid in warm.grids) < sum(grid.products for grid in cold.grids)


def test_a_surface_of_another_size_is_refused(contact):
    surface, start = contact
    longer = replace(surface, x=1.01 * surface.x)
    with pytest.raises(InputError, match="start must be a contact of a surface of the same size"):
        solve_from(longer, start, smallest_wavelength=2e-3)
    with pytest.raises(InputError, match="start must be a RoughContact"):
        solve_from(surface, "before")
