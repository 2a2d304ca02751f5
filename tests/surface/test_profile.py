import numpy as np
import pytest

from gripscale.errors import InputError
from gripscale.surface import Profile

X = 1e-4 * np.arange(20)
Z = np.sin(np.arange(20.0))


def changed(values, at, to):
    values = values.copy()
    values[at] = to
    return values


def test_profile_knows_its_step_length_and_missing_points():
    profile = Profile(X, changed(Z, 3, np.nan), name="road")
    assert profile.step == pytest.approx(1e-4, rel=1e-12)
    assert profile.length == pytest.approx(19e-4, rel=1e-12)
    assert (len(profile), profile.missing) == (20, 1)
    assert "road" in repr(profile)


def test_profile_keeps_its_own_copy_that_cannot_be_written():
    z = Z.copy()
    profile = Profile(X, z)
    z[0] = 99.0
    assert profile.z[0] == Z[0]
    with pytest.raises(ValueError, match="read-only"):
        profile.z[0] = 1.0


def test_steps_may_differ_by_rounding_but_not_more():
    Profile(X + 1000.0, Z)  # x far from zero: floating-point steps are coarse
    Profile(changed(X, 7, X[7] + 0.9e-7), Z)
    with pytest.raises(InputError, match=r"after index 6"):
        Profile(changed(X, 7, X[7] + 1.1e-7), Z)


@pytest.mark.parametrize(
    ("x", "z", "says"),
    [
        (X[:15], Z[:15], "at least 16 points; got 15"),
        (X, Z[:19], "same length; got 20 and 19"),
        (changed(X, 5, np.nan), Z, "got nan at index 5"),
        (changed(X, 5, X[4]), Z, "must increase .* at index 4 .* at index 5"),
        (X[::-1], Z, "must increase"),
        (X**2 + X, Z, "equidistant"),
        (X, changed(Z, 2, np.inf), "got inf at index 2"),
        (X, np.full(20, np.nan), "20 points, all missing"),
        (X[:, None], Z, "got 2 dimensions"),
        ("road", Z, "list of finite numbers"),
    ],
)
def test_a_bad_profile_is_refused_by_name(x, z, says):
    with pytest.raises(InputError, match=says):
        Profile(x, z)
