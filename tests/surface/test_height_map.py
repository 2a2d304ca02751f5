"""A height map: what it keeps, and what it refuses."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import HeightMap

X, Y = np.arange(20) * 1e-4, np.arange(30) * 2e-4
Z = np.outer(np.sin(X * 1e4), np.cos(Y * 1e4))


def test_a_map_knows_its_steps_and_gaps():
    z = Z.copy()
    z[3, 4] = np.nan
    surface = HeightMap(X, Y, z, name="slab")
    assert surface.step == pytest.approx((1e-4, 2e-4))
    assert surface.length == pytest.approx((19e-4, 58e-4))
    assert surface.missing == 1
    assert repr(surface).splitlines() == [
        "HeightMap",
        "  name  slab",
        "  x     20 points, step 100 um, length 1.9 mm",
        "  y     30 points, step 200 um, length 5.8 mm",
        "  z     20 x 30 values from -1 m to 1 m, rms 486.5 mm, 1 missing",
    ]


def test_lines_of_a_map():
    z = Z.copy()
    z[:, 4] = np.nan
    z[2, 5] = np.nan
    surface = HeightMap(X, Y, z, name="slab", source="slab.sur")
    along_x, along_y = surface.lines(), surface.lines("y")
    assert (len(along_x), len(along_y)) == (29, 20)  # the one without heights is left out
    assert along_x[4].name == "slab, line 5 along x"
    assert along_x[4].source == "slab.sur, line 5 along x"
    assert along_x[4].missing == 1
    np.testing.assert_array_equal(along_x[4].x, X)
    np.testing.assert_array_equal(along_y[7].x, Y)
    np.testing.assert_array_equal(along_y[7].z, z[7])
    assert HeightMap(X, Y, Z).lines()[3].name == "line 3 along x"
    with pytest.raises(InputError, match="direction must be one of x, y; got 'z'"):
        surface.lines("z")


def test_a_map_turns_by_a_quarter():
    surface = HeightMap(X, Y, Z + X[:, None], name="slab")
    turned = surface.turned()
    assert turned.z.shape == (30, 20)
    np.testing.assert_array_equal(turned.x, Y)
    # a point at (x, y) is at (y, -x) now
    i, j = 3, 8
    at = np.argmin(np.abs(turned.y + X[i]))
    assert turned.z[j, at] == surface.z[i, j]
    whole = turned.turned().turned().turned()
    np.testing.assert_allclose(whole.x, X)
    np.testing.assert_array_equal(whole.z, surface.z)


@pytest.mark.parametrize(
    ("x", "y", "z", "words"),
    [
        (X[:1], Y, Z[:1], "at least 16 points a way; got 1 along x"),
        (X, Y[:15], Z[:, :15], "got 15 along y"),
        (X, Y, Z.T, r"z must have shape \(20, 30\), heights along x and then y; got \(30, 20\)"),
        (X, Y, Z[0], "two dimensions; got 1"),
        (X, Y, "rough", "z must be a table of heights"),
        (X, Y, np.full(Z.shape, np.nan), "some heights; got 600 points, all missing"),
        (X, Y, np.where(Z > 0.9, np.inf, Z), "numbers or NaN.*got inf"),
        (X**2, Y, Z, "x must increase in equal steps"),
        (X[::-1], Y, Z, "x must increase"),
        (np.where(X > 0, X, np.nan), Y, Z, "x must be a list of finite numbers"),
    ],
)
def test_what_is_no_map_is_refused(x, y, z, words):
    with pytest.raises(InputError, match=words):
        HeightMap(x, y, z)
