"""The mesh of a wave: other programs open it, and its stress is in equilibrium with the contact."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.core.status import Status
from gripscale.export import block_stress, wave_of, write_mesh
from gripscale.rubber import Isihara, MooneyRivlin, NeoHookean, Yeoh
from gripscale.wave.result import waves_to_dataset

LAW = {"wavelength": 1e-2, "amplitude": 1e-3, "pressure": 1e6, "rows": 6, "columns": 32}
CASES = [
    (order, speed, load_time, energy)
    for order in (1, 2)
    for speed, load_time, energy in (
        (0.3, 0.05, NeoHookean()),
        (0.3, np.inf, Yeoh(-0.05, 0.004)),
        (0.0, np.inf, MooneyRivlin(0.3)),
        (3.0, 1e-3, Isihara(0.2, -0.02)),
    )
]


def solved(order=1, speed=0.3, load_time=0.05, energy=None, **other):
    rubber = gs.Rubber(
        6e6, [3e6, 5e6, 2e7], [1e-2, 1e-4, 1e-7], strain_energy=energy or NeoHookean()
    )
    options = {**LAW, "residual_tolerance": 1e-11, **other}
    return gs.solve_scale(rubber, speed=speed, load_time=load_time, element_order=order, **options)


@pytest.fixture(scope="module")
def waves():
    return {order: solved(order) for order in (1, 2)}


def virtual_work(found, x, z):
    """Return the work of the stress per virtual displacement of the nodes: int P : grad w dX."""
    inverse = np.linalg.inv(found.gradient)
    plane = found.cauchy[..., ::2, ::2]
    nominal = found.jacobian[..., None, None] * np.einsum("...ij,...Kj->...iK", plane, inverse)
    slopes = np.stack([found.block.slopes(x), found.block.slopes(z)], axis=-2)
    return float((found.block.weights[..., None, None] * nominal * slopes).sum())


@pytest.mark.parametrize(("order", "speed", "load_time", "energy"), CASES)
def test_the_stress_is_in_equilibrium(order, speed, load_time, energy):
    """Virtual work of random displacements within the block is none, that of its surface the load.

    The kernel found the mesh to a residual force of 1e-11 of the load; a random field weighs the
    residuals of some 200 to 800 nodes, and p projected from J differs from the kernel's by bulk
    over shear modulus, some 1000, times its own residual.
    """
    result = solved(order, speed, load_time, energy)
    assert result.status == Status.CONVERGED
    found = block_stress(result)
    load = result.pressure_received * result.wavelength
    random = np.random.default_rng(3)
    for _ in range(5):
        inside = random.standard_normal((2, *found.block.shape))
        inside[:, [0, -1]] = 0.0
        inside[:, :, -1] = inside[:, :, 0]
        assert abs(virtual_work(found, *inside)) < 1e-7 * load
    nothing, surface = np.zeros(found.block.shape), np.zeros(found.block.shape)
    surface[0] = 1.0
    assert virtual_work(found, nothing, surface) == pytest.approx(load, rel=1e-7)
    drag = -virtual_work(found, surface, nothing)
    assert drag == pytest.approx(result.friction * load, abs=1e-7 * load)


@pytest.fixture(scope="module")
def meshes(waves, tmp_path_factory):
    """What another program reads of their files."""
    meshio = pytest.importorskip("meshio", reason="needs gripscale[dev]")
    folder = tmp_path_factory.mktemp("meshes")
    for order, result in waves.items():
        write_mesh(result, folder / f"{order}.vtu")
    return {order: meshio.read(folder / f"{order}.vtu") for order in waves}


@pytest.mark.parametrize("order", [1, 2])
def test_other_programs_open_the_file(waves, meshes, order):
    result, mesh = waves[order], meshes[order]
    (cells,) = mesh.cells
    assert cells.type == {1: "quad", 2: "quad9"}[order]
    assert len(cells.data) == 32 * 6
    x, y, z = mesh.points.T
    np.testing.assert_array_equal(y, 0.0)
    for found, own in zip((x, z), result.deformed_mesh, strict=True):
        np.testing.assert_array_equal(found, own.ravel())
    corners = mesh.points[cells.data[:, :4]]
    across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    areas = 0.5 * (across[:, 0] * along[:, 2] - across[:, 2] * along[:, 0])
    assert (areas > 0.0).all()
    assert np.unique(cells.data).size == len(mesh.points)
    if order == 2:
        middles = mesh.points[cells.data[:, 4:8]]
        chords = 0.5 * (corners + np.roll(corners, -1, axis=1))
        size = np.sqrt(areas)[:, None]
        assert (np.linalg.norm(middles - chords, axis=2) < 0.1 * size).all()
        centre = mesh.points[cells.data[:, 8]]
        assert (np.linalg.norm(centre - corners.mean(axis=1), axis=1) < 0.1 * size[:, 0]).all()


@pytest.mark.parametrize("order", [1, 2])
def test_the_pressure_of_the_file_carries_the_load(waves, meshes, order):
    """Trapezoids on linear edges, Simpson's rule on quadratic ones, as the kernel shares forces."""
    mesh = meshes[order]
    first = mesh.cells[0].data[:32]
    edge = first[:, [0, 1]] if order == 1 else first[:, [0, 4, 1]]
    weight = np.array([0.5, 0.5]) if order == 1 else np.array([1.0, 4.0, 1.0]) / 6.0
    x, pressure = mesh.points[:, 0][edge], mesh.point_data["contact_pressure"][edge]
    carried = ((x[:, -1] - x[:, 0]) * (pressure @ weight)).sum()
    assert carried == pytest.approx(1e6 * 1e-2, rel=1e-9)
    away = np.setdiff1d(np.arange(len(mesh.points)), edge)
    assert not mesh.point_data["contact_pressure"][away].any()
    assert mesh.field_data["friction"][0] == waves[order].friction
    assert mesh.field_data["pressure_received"][0] == 1e6


def test_the_fields_of_the_file_mean_what_they_say(meshes):
    mesh = meshes[1]
    stress = mesh.cell_data["stress"][0].reshape(-1, 3, 3)
    pressure, ratio = mesh.cell_data["pressure"][0], mesh.cell_data["volume_ratio"][0]
    np.testing.assert_allclose(stress, np.swapaxes(stress, 1, 2), rtol=0, atol=1e-9 * 1e6)
    np.testing.assert_allclose(pressure, -np.trace(stress, axis1=1, axis2=2) / 3.0, rtol=1e-12)
    # One pressure an element: the mean stress is K (J - 1), the deviator has no trace.
    np.testing.assert_allclose(pressure, -2e9 * (ratio - 1.0), rtol=1e-6, atol=1.0)
    # The lid is pressed evenly: far from the wave the rubber is under the mean pressure.
    assert stress[-32:, 2, 2].mean() == pytest.approx(-1e6, rel=2e-3)
    displaced = mesh.point_data["displacement"]
    rest = mesh.points - displaced
    np.testing.assert_allclose(rest[:33, 2], 0.0, atol=1e-15)
    np.testing.assert_allclose(rest[:33, 0], np.linspace(0.0, 1e-2, 33), atol=1e-15)
    assert rest[-1, 2] == pytest.approx(1.5e-2, rel=1e-12)
    assert displaced[:32, 0].mean() == pytest.approx(0.0, abs=1e-14)
    assert np.ptp(displaced[-33:, 2]) < 1e-14


@pytest.mark.parametrize("order", [1, 2])
def test_means_are_over_the_deformed_element(waves, order):
    """The mean of 1/J over it is its undeformed area over its deformed one, whatever J is."""
    found = block_stress(waves[order])
    block, jacobian = found.block, found.jacobian
    undeformed = block.width * block.heights[:, None]
    deformed = (block.weights * jacobian).sum(axis=(2, 3))
    assert np.ptp(jacobian) > 1e-3
    np.testing.assert_allclose(
        found.element_mean(1.0 / jacobian), undeformed / deformed, rtol=1e-13
    )


def test_a_wave_of_a_file_is_the_wave(waves, tmp_path):
    data = waves_to_dataset([waves[1], waves[2]])
    back = wave_of(data, 2)
    assert (back.friction, back.status) == (waves[2].friction, waves[2].status)
    np.testing.assert_array_equal(block_stress(back).cauchy, block_stress(waves[2]).cauchy)
    profiles = data.drop_vars("scale").rename(scale="profile")
    np.testing.assert_array_equal(wave_of(profiles, 1).pressure, waves[1].pressure)


def test_a_wave_that_was_not_solved_has_a_mesh_without_stress(waves, tmp_path):
    meshio = pytest.importorskip("meshio", reason="needs gripscale[dev]")
    failed = replace(waves[1], status=Status.ITERATION_LIMIT)
    with pytest.raises(InputError, match="got a wave with status iteration limit"):
        block_stress(failed)
    write_mesh(failed, tmp_path / "a.vtu")
    mesh = meshio.read(tmp_path / "a.vtu")
    assert not mesh.cell_data
    assert set(mesh.point_data) == {"displacement", "contact_pressure"}


def test_what_has_no_mesh_is_refused(waves, tmp_path):
    bare = replace(waves[1], deformed_mesh=None, model="half_plane")
    other = replace(waves[1], details={**waves[1].details, "rows": 7})
    both, target = waves_to_dataset([waves[1], waves[2]]), tmp_path / "a.vtu"
    for sentence, refused in (
        ("finite-strain block, which has a mesh; got half_plane", lambda: write_mesh(bare, target)),
        (r"deformed_mesh must be of \(8, 33\) nodes", lambda: write_mesh(other, target)),
        ("result must be a ScaleResult; got int", lambda: write_mesh(3, target)),
        ("prediction with meshes", lambda: wave_of(waves_to_dataset([bare]), 1)),
        ("wave must be a whole number from 1 to 2; got 3", lambda: wave_of(both, 3)),
    ):
        with pytest.raises(InputError, match=sentence):
            refused()
    with pytest.raises(FileError, match="cannot be written"):
        write_mesh(waves[1], tmp_path / "none" / "a.vtu")
    assert not list(tmp_path.iterdir())
