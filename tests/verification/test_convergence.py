"""Errors fall with the mesh at rates of at least their order: rows = columns / 8, rms over loads.

Friction is an energy over a sliding distance: with bilinear elements an error of order h^2. The
contact fraction is known to a share of the node spacing, order h at least; edges placed within the
elements do better on coarse meshes. Rms over several loads, because the place of an edge between
two nodes makes the error of a single load jump.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

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

COLUMNS = (32, 48, 64, 96, 128, 192)


def mesh(columns: int) -> Mesh:
    """Return a mesh refined in both directions alike."""
    return Mesh(columns, columns // 8)


FAMILIES: dict[str, tuple[Callable[[], Family], tuple[int, ...]]] = {
    "Westergaard": (westergaard, COLUMNS),
    "Zener": (zener_loads, COLUMNS),
    # 192 columns are too close to the 320 they would be judged by.
    "large strain": (lambda: large_strain(mesh(320)), COLUMNS[:-1]),
}


@dataclass
class Errors:
    """Rms errors of a family on each mesh; no frictions where nothing slides."""

    columns: tuple[int, ...]
    area: list[float] = field(default_factory=list)
    friction: list[float] = field(default_factory=list)

    def rate(self, quantity: str) -> float:
        """Return r in error ~ columns^-r, least squares in logarithms."""
        errors = getattr(self, quantity)
        return float(-np.polyfit(np.log(self.columns), np.log(errors), 1)[0])


def errors_of(name: str) -> Errors:
    """Solve a family on all its meshes."""
    make, columns = FAMILIES[name]
    family, errors = make(), Errors(columns)
    for number in columns:
        results = family.solve(mesh(number))
        errors.area.append(root_mean_square(family.area_errors(results)))
        if family.friction is not None:
            errors.friction.append(root_mean_square(family.friction_errors(results)))
    return errors


LONG = pytest.mark.verification


@pytest.mark.parametrize(
    "name",
    ["Westergaard", pytest.param("Zener", marks=LONG), pytest.param("large strain", marks=LONG)],
)
def test_rates_and_errors_on_128_columns(name: str) -> None:
    """At least orders 1 and 2; a quarter of a spacing, (k h)^2 = 0.24 % and as much of 16 rows."""
    errors = errors_of(name)
    at = COLUMNS.index(128)
    assert errors.rate("area") > 1.0
    assert errors.area[at] < 0.25 / 128
    if errors.friction:
        assert errors.rate("friction") > 2.0
        assert errors.friction[at] < 0.005
