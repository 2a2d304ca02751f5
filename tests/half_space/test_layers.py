"""Rubber of finite thickness: its kernel against an independent solution, and its contacts."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.half_space.grid import Grid
from gripscale.half_space.response import HalfSpace
from gripscale.theory.layers import shear_and_compression, stack_compliance, thickness_factor

from .rough_cases import many_waves

BULK = 2e9
CAP = gs.Rubber(2e6, [3e6, 2e6], [1e-3, 1e-5], BULK, name="cap")
BASE = gs.Rubber(1e6, [0.5e6], [1e-4], BULK, name="base")
LINE = many_waves(512, 25, 3e-4, seed=1)
LOAD = {"pressure": 1e5, "speed": 0.3, "periodic": True, "smallest_wavelength": 4e-3}


def compliance(depth, number, modulus, bulk):
    shear, compression = shear_and_compression(np.full(number.shape, modulus), bulk)
    half_space = (1.0 - 0.5 * (1.0 - compression)) / (shear * number)
    return half_space * thickness_factor(number * depth, compression)[0]


def boundary_values(depth, number, modulus, bulk):
    """Return K by an Airy function, phi = (a + b z) cosh qz + (c + e z) sinh qz, bonded at z = 0.

    Plane strain: s_zz = -q^2 phi, s_xz = -i q phi', s_xx = phi''. The displacements follow from
    2 G e_xx = (1 - nu) s_xx - nu s_zz; phi''' gives that across.
    """
    shear = modulus / 3.0
    nu = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    q = number

    def derivatives(z):
        """Return phi, phi', phi'', phi''' of the four functions at z, shape (4, 4)."""
        c, s = np.cosh(q * z), np.sinh(q * z)
        return np.array(
            [
                [c, z * c, s, z * s],
                [q * s, c + q * z * s, q * c, s + q * z * c],
                [q**2 * c, 2 * q * s + q**2 * z * c, q**2 * s, 2 * q * c + q**2 * z * s],
                [q**3 * s, 3 * q**2 * c + q**3 * z * s, q**3 * c, 3 * q**2 * s + q**3 * z * c],
            ]
        )

    def displacements(z):
        """Return i q 2 G u_x and 2 G q^2 u_z, rows of four."""
        phi, first, second, third = derivatives(z)
        along = (1.0 - nu) * second + nu * q**2 * phi
        # 2 G e_xz = s_xz gives u_z from u_x: q^2 u_z = (i q u_x)' + q^2 phi' / G
        across = (1.0 - nu) * third + nu * q**2 * first - 2.0 * q**2 * first
        return np.array([along, across])

    top = derivatives(depth)
    matrix = np.array([*displacements(0.0), top[1], -(q**2) * top[0]])
    scale = np.abs(matrix).max(axis=1)
    columns = np.abs(matrix / scale[:, None]).max(axis=0)
    right = np.array([0.0, 0.0, 0.0, 1.0]) / scale
    solution = np.linalg.solve(matrix / scale[:, None] / columns, right) / columns
    return complex(displacements(depth)[1] @ solution / (2.0 * shear * q**2))


@pytest.mark.parametrize("bulk", [2e7, 2e9])
@pytest.mark.parametrize("modulus", [6e6, 6e6 + 3e6j])
def test_closed_form_solves_the_boundary_value_problem(modulus, bulk):
    number = np.array([0.5, 1.0, 2.0, 5.0]) / 0.01
    expected = [boundary_values(0.01, q, modulus, bulk) for q in number]
    # the matrix of the reference has a condition up to 1e4 at these depths
    np.testing.assert_allclose(compliance(0.01, number, modulus, bulk), expected, rtol=1e-11)


def test_limits_are_half_space_thin_sheet_and_oedometer():
    compression = shear_and_compression(np.full(1, 6e6 + 1e6j), BULK)[1]
    assert thickness_factor(np.array([1e4]), compression)[0] == 1.0
    thin = thickness_factor(np.array([1e-2]), np.zeros(1, complex))[0]
    assert thin == pytest.approx(2.0 / 3.0 * 1e-6, rel=2e-4)  # next terms are s^2
    modulus = BULK + 4.0 / 3.0 * (6e6 + 1e6j) / 3.0
    flat = compliance(1e-3, np.array([1e-3]), 6e6 + 1e6j, BULK)
    assert flat == pytest.approx(1e-3 / modulus, rel=1e-8)


def test_two_equal_layers_are_one_and_losses_sum():
    number = np.geomspace(0.3, 2000.0, 40) / 0.01
    modulus = np.full(number.shape, 6e6 + 3e6j)
    # at |q| d < 0.3 rounding of the 4 x 4 matrices exceeds this
    for parts in ([0.01], [0.004, 0.006], [0.002, 0.003, 0.005]):
        value, losses = stack_compliance(number, [modulus] * len(parts), [2e8] * len(parts), parts)
        one = compliance(0.01, number, 6e6 + 3e6j, 2e8)
        np.testing.assert_allclose(value, one, rtol=1e-12)
        np.testing.assert_allclose(losses.sum(axis=0), value.imag, rtol=1e-12)
        assert (losses <= 1e-15 * np.abs(value)).all()


def test_only_lossy_layers_lose():
    number = np.geomspace(0.5, 5.0, 5) / 0.01
    stiff, lossy = np.full(5, 6e6 + 0j), np.full(5, 3e6 + 1e6j)
    losses = stack_compliance(number, [stiff, lossy], [BULK, BULK], [0.004, 0.006])[1]
    assert np.abs(losses[0]).max() < 1e-12 * np.abs(losses[1]).max()
    assert (losses[1] < 0.0).all()


def test_derivatives_of_the_modulus_are_those_of_differences():
    grid = Grid((64,), (0.1,))
    by_modulus, by_bulk = HalfSpace(CAP, 0.3, thickness=4e-3).log_modulus_by(grid)

    def log_modulus(stiffer, bulk):
        rubber = gs.Rubber(2e6 * stiffer, CAP.moduli * stiffer, CAP.relaxation_times, BULK * bulk)
        return np.log(HalfSpace(rubber, 0.3, thickness=4e-3).modulus(grid))[1:-1]

    step = 1e-4
    for derivative, direction in ((by_modulus, (1.0, 0.0)), (by_bulk, (0.0, 1.0))):
        high, low = (
            log_modulus(*(np.exp(sign * step * part) for part in direction)) for sign in (1, -1)
        )
        np.testing.assert_allclose((high - low) / (2.0 * step), derivative[1:-1], atol=1e-7)


def test_thick_rubber_is_a_half_space_and_thin_rubber_is_stiffer():
    areas = [
        gs.solve_rough_contact(CAP, LINE, thickness=d, **LOAD).contact_fraction
        for d in (None, 1.0, 8e-3, 2e-3)
    ]
    assert areas[1] == pytest.approx(areas[0], rel=1e-12)
    assert areas[0] > 1.1 * areas[2] > 1.1**2 * areas[3]


def test_equal_layers_have_the_contact_of_one():
    """Rounding of K changes iterations that stop at 1e-6 of the pressure, and totals by 1e-8."""
    one = gs.solve_rough_contact(CAP, LINE, thickness=8e-3, **LOAD)
    two = gs.solve_rough_contact(gs.Layers([(CAP, 3e-3), (CAP, 5e-3)]), LINE, **LOAD)
    assert two.contact_fraction == pytest.approx(one.contact_fraction, rel=1e-7)
    assert two.friction == pytest.approx(one.friction, rel=1e-7)


def test_losses_of_the_layers_sum_to_the_friction():
    layers = gs.Layers([(CAP, 3e-3), (BASE, 5e-3)])
    contact = gs.solve_rough_contact(layers, LINE, **LOAD)
    data = contact.to_dataset(fields=False)
    total = contact.friction_from_dissipation
    assert float(data.friction_by_layer.sum()) == pytest.approx(total, rel=1e-12)
    assert data.friction_by_layer.attrs["units"] == "1"
    assert data.friction_by_layer.attrs["long_name"]
    assert data.layer_thickness.values.tolist() == [3e-3, 5e-3]
    assert contact.friction == pytest.approx(total, rel=0.03)


def test_a_map_across_the_sliding_direction_has_the_contact_of_its_line():
    heights = gs.HeightMap(LINE.x, np.arange(32) * LINE.step, np.repeat(LINE.z[:, None], 32, 1))
    load = LOAD | {"tolerance": None}
    for rubber, d in ((CAP, 8e-3), (gs.Layers([(CAP, 3e-3), (BASE, 5e-3)]), None)):
        flat, wide = (
            gs.solve_rough_contact(rubber, surface, thickness=d, **load)
            for surface in (LINE, heights)
        )
        assert wide.contact_fraction == pytest.approx(flat.contact_fraction, rel=0.05)
        assert wide.friction_from_dissipation == pytest.approx(
            flat.friction_from_dissipation, rel=0.05
        )


STIFFENED = ("ln_storage", "ln_loss", "ln_modulus", "ln_bulk_modulus")


def test_derivatives_of_equal_layers_sum_to_those_of_one():
    """Moduli of both layers together are those of the rubber; speed is that of the stack."""
    load = LOAD | {"tolerance": 0.02}
    one = gs.half_space.contact_sensitivity(
        gs.solve_rough_contact(CAP, LINE, thickness=8e-3, **load)
    )
    stack = gs.solve_rough_contact(gs.Layers([(CAP, 3e-3), (CAP, 5e-3)]), LINE, **load)
    upper, lower = (gs.half_space.contact_sensitivity(stack, layer=number) for number in (0, 1))
    for name in STIFFENED:
        key = f"d_ln_friction_d_{name}"
        np.testing.assert_allclose(upper[key] + lower[key], one[key], rtol=1e-5, atol=1e-6)
    key = "d_ln_friction_d_ln_speed"
    assert float(upper[key]) == pytest.approx(float(one[key]), rel=1e-5)
    assert float(lower[key]) == pytest.approx(float(one[key]), rel=1e-5)


@pytest.mark.parametrize("layer", [0, 1])
def test_derivatives_of_a_layer_are_those_of_solved_stacks(layer):
    """Cap or base stiffer by a factor. Borders err by 0.011 on 2048 points, by 0.003 on 8192."""
    load = LOAD | {"tolerance": 1e-3}
    contact = gs.solve_rough_contact(gs.Layers([(CAP, 1e-3), (BASE, 5e-3)]), LINE, **load)
    derivative = gs.half_space.contact_sensitivity(contact, layer=layer)
    value = float(derivative["d_ln_friction_d_ln_modulus"].sum())
    assert derivative.sizes["term"] == (3, 2)[layer]
    step = 0.02

    def friction(by):
        rubbers = [CAP, BASE]
        old, factor = rubbers[layer], np.exp(by)
        rubbers[layer] = gs.Rubber(
            old.equilibrium_modulus * factor, old.moduli * factor, old.relaxation_times, BULK
        )
        layers = gs.Layers(list(zip(rubbers, (1e-3, 5e-3), strict=True)))
        solved = gs.solve_rough_contact(layers, LINE, start=contact, **load)
        return float(solved.friction_from_dissipation)

    difference = np.log(friction(step) / friction(-step)) / (2.0 * step)
    assert value == pytest.approx(difference, abs=0.02)
    assert abs(value) > 0.1


def test_what_layers_do_not_have_is_refused():
    layers = gs.Layers([(CAP, 3e-3), (BASE, 5e-3)])
    contact = gs.solve_rough_contact(layers, LINE, **LOAD)
    with pytest.raises(InputError, match="layer must be a whole number from 0 to 1; got 2"):
        gs.half_space.contact_sensitivity(contact, layer=2)
    with pytest.raises(InputError, match=r"thickness must be None with Layers.*0\.01"):
        gs.solve_rough_contact(layers, LINE, thickness=0.01, **LOAD)
    with pytest.raises(InputError, match="thickness must be greater than zero"):
        gs.solve_rough_contact(CAP, LINE, thickness=-1.0, **LOAD)


@pytest.mark.parametrize(
    ("layers", "words"),
    [
        ([], "pairs of a Rubber"),
        (3.0, "pairs of a Rubber"),
        ([CAP], "pairs of a Rubber"),
        ([(CAP, 1e-3), ("base", 1e-3)], "rubber of layer 1 must be a Rubber; got str"),
        ([(CAP, 0.0)], "thickness of layer 0"),
        ([(CAP, np.inf)], "thickness of layer 0"),
    ],
)
def test_layers_name_what_is_wrong(layers, words):
    with pytest.raises(InputError, match=words):
        gs.Layers(layers)


LOW = gs.Rubber(2e6, [1e6, 1e6], [1e-2, 1e-3], BULK)


def block_over_layer(amplitude, depth, speed):
    """Return area and friction of the finite-strain block over those of the layer.

    The amplitude and the depth are in wavelengths; the pressure is in proportion to the amplitude,
    so that the layer has the same area at each.
    """
    length = 1e-2
    load = {"pressure": 5e6 * amplitude, "speed": speed}
    block = gs.solve_scale(
        LOW, wavelength=length, amplitude=amplitude * length, depth=depth, columns=256, **load
    )
    x = np.arange(256) / 256 * length
    sine = gs.Profile(x, amplitude * length * np.cos(2.0 * np.pi * x / length))
    layer = gs.solve_rough_contact(
        LOW, sine, thickness=depth * length, periodic=True, tolerance=1e-3, **load
    )
    assert block.converged
    assert layer.converged
    area = block.contact_fraction / layer.contact_fraction
    friction = 1.0 if speed == 0.0 else block.friction_from_dissipation / layer.friction
    return np.array([area, friction])


def test_layer_is_the_finite_strain_block_of_its_height():
    np.testing.assert_allclose(block_over_layer(0.004, 0.2, 0.3), 1.0, atol=0.005)


@pytest.mark.verification
@pytest.mark.parametrize("speed", [0.0, 0.3])
@pytest.mark.parametrize("depth", [0.1, 0.2, 0.4, 1.0])
def test_layers_are_the_finite_strain_blocks_of_their_height(depth, speed):
    """The two differ by the strain of the block, in proportion to amplitude over depth."""
    steep = block_over_layer(0.004, depth, speed)
    np.testing.assert_allclose(steep, 1.0, atol=0.005 if depth > 0.1 else 0.007)
    gentle = block_over_layer(0.002, depth, speed)
    # without strain, by extrapolation; the grid of the block is good for 0.2 % in area
    np.testing.assert_allclose(2.0 * gentle - steep, 1.0, atol=0.004)


def test_layers_are_printed_by_the_number_that_a_sensitivity_takes():
    shown = dict(gs.Layers([(CAP, 4e-3), (CAP, 6e-3)]).shown_rows())
    assert [*shown] == ["layer 0", "layer 1"]
    assert shown["layer 1"].startswith("6")
