"""Errors fall with the mesh at rates of at least their order: rows = columns / 8, rms over loads.

Friction is an energy over a sliding distance: with bilinear elements an error of order h^2. The
contact fraction is known to a share of the node spacing, order h at least; edges placed within the
elements do better on coarse meshes. Rms over several loads, because the place of an edge between
two nodes makes the error of a single load jump.
"""

from collections.abc import Callable

import numpy as np
import pytest

from gripscale.wave import Mesh
from tests.verification.families import (
    Family,
    large_strain,
    root_mean_square,
    westergaard,
    zener_loads,
)

COLUMNS = (32, 48, 64, 96, 128)
AREA_RATE, FRICTION_RATE = 1.0, 2.0

Errors = dict[str, list[float]]


def mesh(columns: int) -> Mesh:
    """Return a mesh refined in both directions alike."""
    return Mesh(columns, columns // 8)


FAMILIES: dict[str, Callable[[], Family]] = {
    "Westergaard": westergaard,
    "Zener": zener_loads,
    "large strain": lambda: large_strain(mesh(320)),
}


def errors_of(family: Family) -> Errors:
    """Return rms errors of contact fraction and friction on each of the meshes."""
    errors: Errors = {"area": [], "friction": []}
    for columns in COLUMNS:
        results = family.solve(mesh(columns))
        errors["area"].append(root_mean_square(family.area_errors(results)))
        if family.friction is not None:
            errors["friction"].append(root_mean_square(family.friction_errors(results)))
    return errors


def rate(errors: list[float]) -> float:
    """Return r in error ~ columns^-r, least squares in logarithms."""
    return float(-np.polyfit(np.log(COLUMNS), np.log(errors), 1)[0])


@pytest.mark.parametrize(
    ("name", "finest_area", "finest_friction"),
    [
        ("Westergaard", 0.002, 0.0),
        pytest.param("Zener", 0.002, 0.004, marks=pytest.mark.verification),
        pytest.param("large strain", 0.002, 0.004, marks=pytest.mark.verification),
    ],
)
def test_rates(name: str, finest_area: float, finest_friction: float) -> None:
    """On 128 columns: a quarter of a spacing, 0.002; (k h)^2 = 0.24 % and as much of 16 rows."""
    errors = errors_of(FAMILIES[name]())
    assert rate(errors["area"]) > AREA_RATE
    assert errors["area"][-1] < finest_area
    if finest_friction:
        assert rate(errors["friction"]) > FRICTION_RATE
        assert errors["friction"][-1] < finest_friction
