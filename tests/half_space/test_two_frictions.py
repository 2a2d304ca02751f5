"""Without a tolerance the two frictions of a direct contact still judge its grid."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.status import Status
from gripscale.half_space.model import DirectContact
from gripscale.model import Load
from gripscale.surface import Measured, Surface

from .rough_cases import isotropic_map, random_case, solve


@pytest.mark.parametrize("seed", [85, 175])
def test_friction_of_the_wrong_sign_is_not_converged(seed):
    """A few points on steep crests, four in the smallest wave: -0.049 and -0.054 from traction.

    A grid eight times finer has 0.018 and 0.042 both from traction and from dissipation.
    """
    found = random_case(seed, points_of_map=32).solve(tolerance=None)
    assert found.friction < -0.04
    assert 0.01 < found.friction_from_dissipation < 0.05
    assert found.status == Status.FRICTIONS_DISAGREE
    (note,) = [note for note in found.notes if "from dissipation" in note]
    assert f"Friction is {found.friction:.3g} from traction" in note


def test_an_answer_keeps_the_numbers_and_the_status_of_the_contact():
    case = random_case(97, points_of_map=32)
    cut_off = 2.0 * float(np.max(case.surface.step))
    options = {"smallest_wavelength": cut_off, "tolerance": None, "periodic": True}
    load = {"pressure": case.pressure, "speed": case.speed}
    alone = gs.solve_rough_contact(case.rubber, case.surface, **load, **options)
    model = DirectContact(**options)
    surface = Surface(None, "", measured=Measured.of(case.surface))
    answer = model.predict(case.rubber, surface, Load(case.pressure, case.speed, footprint=0.1))
    assert float(answer.total_friction) == alone.friction
    assert answer.status.values.tolist() == ["frictions disagree"]
    assert "from dissipation" in answer.attrs["notes"]


def test_frictions_that_roughly_agree_converged():
    """On four points in the smallest wave 10 to 20 % apart is usual."""
    found = solve(isotropic_map(64), tolerance=None)
    assert 0.01 < found.friction_mismatch < 0.3
    assert found.converged
    assert not any("from dissipation" in note for note in found.notes)


def test_at_rest_there_is_no_friction_to_judge():
    found = random_case(175, points_of_map=32)
    at_rest = solve(
        found.surface, rubber=found.rubber, pressure=found.pressure, speed=0.0, tolerance=None
    )
    assert at_rest.converged
