"""The bonded slab against its limits and against an independent solution of its equations."""

import numpy as np
import pytest
from scipy.linalg import expm

from gripscale.core.errors import InputError
from gripscale.theory import slab_compliance


def compliance_by_transfer_matrix(k: float, depth: float, young: float, nu: float) -> float:
    """Integrate plane-strain equilibrium across the slab, from the bonded to the free face.

    u = U sin kx, w = W cos kx, normal stress S cos kx, shear stress T sin kx; L, G Lame's moduli:
    U' = kW + T/G, W' = (S - L k U)/(L+2G), T' = k [(L+2G) k U + L W'], S' = -k T.
    """
    shear = young / (2 * (1 + nu))
    lame = young * nu / ((1 + nu) * (1 - 2 * nu))
    stiff = lame + 2 * shear
    w_row = np.array([-lame * k / stiff, 0.0, 1.0 / stiff, 0.0])
    system = np.array(
        [
            [0.0, k, 0.0, 1.0 / shear],
            w_row,
            [0.0, 0.0, 0.0, -k],
            k * np.array([stiff * k, 0.0, 0.0, 0.0]) + k * lame * w_row,
        ]
    )
    across = expm(system * depth)
    # bonded: U = W = 0; free of shear on top: T = 0
    start = np.linalg.solve(across[[2, 3]][:, [2, 3]], [1.0, 0.0])
    return float(across[1, [2, 3]] @ start)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("depth_phase", [0.05, 0.5, 2.0, 6.0])
def test_slab_satisfies_plane_strain_equilibrium(depth_phase, nu):
    """Rounding grows with exp(2 k h): 1e-16 exp(12) = 2e-11."""
    expected = compliance_by_transfer_matrix(1.0, depth_phase, 1.0, nu)
    found = slab_compliance(1.0, depth=depth_phase, youngs_modulus=1.0, poisson_ratio=nu)
    assert float(found) == pytest.approx(expected, rel=1e-8)


def test_deep_slab_is_a_half_plane():
    half_plane = 2 * (1 - 0.49**2) / (3e6 * 1e3)
    given = {"youngs_modulus": 3e6, "poisson_ratio": 0.49}
    for depth in (np.inf, 1.0):
        assert slab_compliance(1e3, depth=depth, **given) == pytest.approx(half_plane, rel=1e-14)
    # one wavelength deep: within 0.1 %, and softer than nothing less
    one_deep = float(slab_compliance(1e3, depth=2e-3 * np.pi, **given))
    assert one_deep == pytest.approx(half_plane, rel=1e-3)
    assert one_deep < half_plane * (1 - 5e-4)


def test_shallow_slab_is_in_uniaxial_strain():
    """Next term is of order (k h)^2 = 1e-8."""
    nu = 0.3
    oedometer = 1e-4 * (1 + nu) * (1 - 2 * nu) / (3e6 * (1 - nu))
    found = slab_compliance([1.0], depth=1e-4, youngs_modulus=3e6, poisson_ratio=nu)
    assert found == pytest.approx([oedometer], rel=1e-6)


@pytest.mark.parametrize(
    ("number", "change", "message"),
    [
        (0.0, {}, "wavenumber must be greater than zero"),
        (1.0, {"depth": 0.0}, "depth must be greater than zero"),
        (1.0, {"youngs_modulus": -1.0}, "youngs_modulus must be greater than zero"),
        (1.0, {"poisson_ratio": 0.51}, "poisson_ratio must be above -1 and at most 0.5"),
    ],
)
def test_bad_input(number, change, message):
    good = {"depth": 1.0, "youngs_modulus": 1.0, "poisson_ratio": 0.3}
    with pytest.raises(InputError, match=message):
        slab_compliance(number, **{**good, **change})
