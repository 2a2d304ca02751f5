"""The algebra of the chain, with powers of two so that every number is exact."""

import math

import numpy as np
import pytest

from gripscale.chain import ChainError, solve_chain
from gripscale.core.errors import ConvergenceError, InputError
from gripscale.rubber import Rubber
from gripscale.surface import SineStack
from gripscale.theory import HalfPlane
from tests.samples import THREE_SINES as THREE

from .stand_ins import Scripted, Spring

LOAD = {"pressure": 2.0**18, "speed": 0.25, "footprint": 0.125}


def test_pressure_area_and_friction_follow_equations_1_to_3():
    solver = Scripted([0.5, 0.25, 0.125])
    result = solve_chain(Spring(), THREE, solver=solver, **LOAD)
    assert [s.pressure_received for s in result.scales] == [2.0**18, 2.0**19, 2.0**21]
    assert result.running_contact_fraction.tolist() == [2.0**-1, 2.0**-3, 2.0**-6]
    assert result.contact_fraction == 2.0**-6
    assert result.running_friction.tolist() == [0.125, 0.375, 0.875]
    assert result.friction == 0.875
    assert result.friction_from_dissipation == 0.75 * 0.875


def test_full_contact_passes_the_pressure_on_unchanged():
    result = solve_chain(Spring(), THREE, solver=Scripted([1.0, 1.0, 0.5]), **LOAD)
    assert [s.pressure_received for s in result.scales] == [LOAD["pressure"]] * 3


def test_load_time_is_the_passage_of_the_contact_above():
    solver = Scripted([0.5, 0.25, 0.125])
    solve_chain(Spring(), THREE, solver=solver, **LOAD)
    assert [problem.load.load_time for problem in solver.asked] == [
        0.125 / 0.25,
        16e-3 * 0.5 / 0.25,
        4e-3 * 0.25 / 0.25,
    ]


@pytest.mark.parametrize(("stated", "used"), [(math.inf, math.inf), (2.0, 2.0)])
def test_stated_load_time_holds_for_every_wave(stated, used):
    solver = Scripted([0.5, 0.5, 0.5])
    solve_chain(Spring(), THREE, solver=solver, load_time=stated, **LOAD)
    assert [problem.load.load_time for problem in solver.asked] == [used] * 3


@pytest.mark.parametrize("stated", ["passage", 2.0])
def test_at_rest_the_load_lasts_for_ever(stated):
    solver = Scripted([0.5, 0.5, 0.5])
    solve_chain(Spring(), THREE, solver=solver, load_time=stated, **{**LOAD, "speed": 0.0})
    assert [problem.load.load_time for problem in solver.asked] == [math.inf] * 3


def test_solver_by_name_or_by_its_face_gets_the_options():
    rubber, load = Rubber(5e6, [1e6], [1e-3]), {"pressure": 3e5, "speed": 0.3, "footprint": 0.1}
    one = SineStack([10e-3], [0.8e-3])
    block = solve_chain(rubber, one, columns=32, rows=8, depth=2.0, **load).scales[0]
    assert (block.details["columns"], block.details["depth"]) == (32, 2.0)
    plane = solve_chain(rubber, one, solver="half_plane", points=64, **load).scales[0]
    assert (plane.model, len(plane.x)) == ("half_plane", 64)
    by_object = solve_chain(rubber, one, solver=HalfPlane(points=64), **load)
    assert by_object.friction == plane.friction


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"solver": "quarter_plane"}, "solver must be one of finite_strain, half_plane"),
        ({"solver": 3}, "or a WaveSolver such as HalfPlane"),
        ({"colums": 32}, "unknown option colums; did you mean columns?"),
        ({"solver": HalfPlane(), "points": 64}, "points belongs to the solver"),
    ],
)
def test_solver_or_option_that_is_none_is_refused(given, words):
    with pytest.raises(InputError) as caught:
        solve_chain(Rubber(5e6), SineStack([10e-3], [0.8e-3]), **{**LOAD, **given})
    assert words in str(caught.value)


def test_start_shorter_than_the_stack_starts_only_its_own_waves():
    first = solve_chain(Spring(), THREE, solver=Scripted([0.5]), smallest_wavelength=5e-3, **LOAD)
    solver = Scripted([0.5, 0.5, 0.5])
    solve_chain(Spring(), THREE, solver=solver, start=first, **LOAD)
    assert solver.starts == [first.scales[0], None, None]


def test_half_plane_neither_gives_nor_takes_a_start():
    rubber, one = Rubber(5e6, [1e6], [1e-3]), SineStack([10e-3], [0.8e-3])
    plane = solve_chain(rubber, one, solver="half_plane", **LOAD)
    with pytest.raises(InputError, match="start must be None: the half-plane model"):
        solve_chain(rubber, one, solver="half_plane", start=plane, **LOAD)
    with pytest.raises(InputError, match=r"a result of the finite-strain block .* half_plane"):
        solve_chain(rubber, one, start=plane, **LOAD)


def test_rubber_of_a_wave_may_depend_on_what_was_solved():
    def softer(wave, so_far):
        return Rubber(4e6 / (1 + len(so_far.scales)), name=f"{wave.wavelength:g}")

    solver = Scripted([0.5, 0.5, 0.5])
    result = solve_chain(Rubber(4e6), THREE, solver=solver, rubber_at=softer, **LOAD)
    assert [problem.rubber.name for problem in solver.asked] == ["0.016", "0.004", "0.001"]
    np.testing.assert_allclose([wave.modulus for wave in result.scales], [4e6, 2e6, 4e6 / 3])
    assert result.rubber == Rubber(4e6)


@pytest.mark.parametrize(
    ("limits", "count"),
    [({}, 3), ({"smallest_wavelength": 4e-3}, 2), ({"smallest_wavelength": 4.001e-3}, 1)],
)
def test_chain_stops_at_the_cut_off(limits, count):
    result = solve_chain(Spring(), THREE, solver=Scripted([0.5, 0.5, 0.5]), **limits, **LOAD)
    assert len(result.scales) == count


def test_modulus_and_loss_factor_are_taken_at_the_fundamental_frequency():
    class Dashpot(Spring):
        def complex_modulus(self, omega):
            return 4.0 + 1j * np.asarray(omega)

    result = solve_chain(Dashpot(), THREE, solver=Scripted([0.5, 0.5, 0.5]), **LOAD)
    omega = 2 * math.pi * 0.25 / np.array(THREE.wavelength)
    np.testing.assert_allclose([s.angular_frequency for s in result.scales], omega, rtol=1e-15)
    np.testing.assert_allclose([s.modulus for s in result.scales], np.hypot(4.0, omega), rtol=1e-15)
    np.testing.assert_allclose([s.loss_factor for s in result.scales], omega / 4.0, rtol=1e-15)


def test_wave_that_fails_stops_the_chain_and_loses_nothing():
    solver = Scripted([0.5, 0.25, 0.5], statuses=["converged", "iteration limit", "converged"])
    seen = []
    with pytest.raises(ConvergenceError, match=r"wave 2 of 3.*4 mm.*iteration limit") as caught:
        solve_chain(
            Spring(),
            THREE,
            solver=solver,
            on_scale=lambda so_far: seen.append(so_far.scales[-1].status),
            **LOAD,
        )
    assert isinstance(caught.value, ChainError)
    partial = caught.value.partial
    assert len(solver.asked) == 2
    assert seen == ["converged", "iteration limit"]
    assert [s.status for s in partial.scales] == seen
    assert partial.running_friction[0] == 0.125
    assert math.isnan(partial.running_friction[1])
    assert math.isnan(partial.friction)
    assert math.isnan(partial.contact_fraction)
    assert math.isnan(partial.friction_from_dissipation)


@pytest.mark.parametrize("fraction", [0.0, -0.1, 1.1, math.nan])
def test_wave_without_a_usable_contact_stops_the_chain(fraction):
    with pytest.raises(ChainError, match=r"wave 1 of 3.*contact fraction"):
        solve_chain(Spring(), THREE, solver=Scripted([fraction, 0.5, 0.5]), **LOAD)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pressure": 0.0}, "pressure must be greater than zero [Pa]; got 0"),
        ({"pressure": "3 barrels"}, "pressure = '3 barrels': unknown unit"),
        ({"speed": -1.0}, "speed must not be negative [m/s]; got -1"),
        ({"footprint": -0.1}, "footprint must be greater than zero [m]; got -0.1"),
        ({"load_time": 0.0}, "load_time must be greater than zero [s]; got 0"),
        ({"load_time": "soon"}, 'load_time must be "passage", "infinite" or a time'),
        ({"smallest_wavelength": 0.0}, "smallest_wavelength must be greater than zero [m]"),
        ({"smallest_wavelength": 1.0}, "smallest_wavelength must not exceed the largest wave"),
    ],
)
def test_bad_input_is_refused_before_any_wave_is_solved(change, words):
    solver = Scripted([0.5, 0.5, 0.5])
    with pytest.raises(InputError) as caught:
        solve_chain(Spring(), THREE, solver=solver, **{**LOAD, **change})
    assert words in str(caught.value)
    assert solver.asked == []
