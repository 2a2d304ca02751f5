"""The pressure handed down as a distribution, against closed forms and finer classes."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from gripscale.chain import Chain, ChainError, solve_chain
from gripscale.chain.prediction import PressureClasses
from gripscale.core.errors import InputError
from gripscale.core.status import Status
from gripscale.rubber import Rubber
from gripscale.surface import SineStack
from gripscale.theory import HalfPlane
from gripscale.wave import Sine, WaveLoad, WaveProblem
from tests.samples import THREE_SINES as THREE

from .stand_ins import Scripted, Spring, solved

RUBBER = Rubber(6e6, [12e6, 40e6], [1e-3, 1e-5], bulk_modulus=2e9)
SINES = SineStack([12e-3, 4e-3, 1.3e-3], [0.6e-3, 0.15e-3, 0.04e-3])
LOAD = {"pressure": 3e5, "speed": 0.3, "footprint": 0.1}
SOLVER = HalfPlane(points=512)


@dataclass(frozen=True)
class Hertzian:
    """Contact and friction that grow as the root of the pressure, which is half an ellipse."""

    name: ClassVar[str] = "hertzian"

    closed: float
    """Pressure of full contact [Pa]."""
    fails_above: float = np.inf

    def solve(self, problem, start=None):
        wavelength, pressure = problem.profile.wavelength, problem.load.pressure
        half = 0.5 * (pressure / self.closed) ** 0.5
        x = wavelength * ((np.arange(4096) + 0.5) / 4096 - 0.5)
        ellipse = np.sqrt(np.maximum(1.0 - (x / (half * wavelength)) ** 2, 0.0))
        return solved(
            problem,
            contact_fraction=2.0 * half,
            friction=half,
            friction_from_dissipation=half,
            status=Status("converged" if pressure <= self.fails_above else "fold in the load path"),
            x=x,
            pressure=pressure * ellipse * 2.0 / (np.pi * half),
        )


def test_second_wave_sees_half_an_ellipse_of_pressure():
    # Under p(x) = p_m (4/pi) sqrt(1 - x^2), area grows with the mean of sqrt(p), friction with that
    # of p sqrt(p) / p_m: beta functions, with c = sqrt(4/pi).
    #   mean of (1 - x^2)^(1/4) = 0.8740, mean of (1 - x^2)^(3/4) = 0.7189 over -1 < x < 1
    two = SineStack([8e-3, 1e-3], [1e-3, 1e-4])
    solver, load = Hertzian(1e8), {"pressure": 1e5, "speed": 1.0, "footprint": 0.1}
    mean = solve_chain(RUBBER, two, solver=solver, **load).scales[1]
    many = solve_chain(RUBBER, two, solver=solver, pressure_classes=64, **load).scales[1]
    root = np.sqrt(4.0 / np.pi)
    assert many.contact_fraction / mean.contact_fraction == pytest.approx(root * 0.87402, rel=1e-3)
    assert many.friction / mean.friction == pytest.approx(root**3 * 0.71888, rel=1e-3)


@pytest.mark.parametrize("count", [2, 5, 8])
def test_load_and_area_are_kept(count):
    result = solve_chain(RUBBER, SINES, solver=SOLVER, pressure_classes=count, **LOAD)
    above = np.concatenate([[1.0], result.running_contact_fraction[:-1]])
    received = np.array([s.pressure_received for s in result.scales])
    np.testing.assert_allclose(received * above, LOAD["pressure"], rtol=1e-9)
    for scale in result.scales[1:]:
        pressures = scale.details["class_pressures"]
        assert len(pressures) == count
        assert (np.diff(pressures) > 0.0).all()
        # equal loads: the mean over the area is the harmonic mean
        assert scale.pressure_received == pytest.approx(1.0 / np.mean(1.0 / pressures), rel=1e-9)


@pytest.mark.verification
def test_eight_classes_are_enough():
    found = {
        n: solve_chain(RUBBER, SINES, solver=SOLVER, pressure_classes=n, **LOAD) for n in (1, 8, 32)
    }
    area = {
        n: np.log(one.contact_fraction / found[32].contact_fraction) for n, one in found.items()
    }
    friction = {n: np.log(one.friction / found[32].friction) for n, one in found.items()}
    assert abs(area[8]) < 0.02
    assert abs(friction[8]) < 0.02
    assert friction[1] > 0.05  # what the mean pressure costs here: 6 %


def test_friction_is_the_energy_lost():
    result = solve_chain(RUBBER, SINES, solver=SOLVER, pressure_classes=8, **LOAD)
    assert result.friction == pytest.approx(result.friction_from_dissipation, rel=5e-3)


def test_uniform_full_contact_stays_uniform():
    classes = PressureClasses.uniform(2e5)
    problem = WaveProblem(RUBBER, Sine(8e-3, 1e-3), WaveLoad(2e5))
    flat = replace(Hertzian(2e5).solve(problem), pressure=np.full(4096, 2e5), contact_fraction=1.0)
    down = classes.handed_down([flat], 4)
    np.testing.assert_allclose(down.pressure, 2e5, rtol=1e-12)
    np.testing.assert_allclose(down.area, 0.25, rtol=1e-12)


def test_class_that_fails_is_named_and_ends_the_chain():
    two, solver = SineStack([8e-3, 1e-3], [1e-3, 1e-4]), Hertzian(1e8, fails_above=4e6)
    with pytest.raises(ChainError, match=r"wave 2 of 2.*fold in the load path") as caught:
        solve_chain(RUBBER, two, solver=solver, pressure_classes=8, **LOAD)
    failed = caught.value.partial.scales[-1]
    assert failed.pressure_received > 4e6
    assert np.isnan(caught.value.partial.friction)


@pytest.mark.parametrize("count", [0, 1.5, 65])
def test_bad_number_of_classes_is_refused(count):
    words = "pressure_classes must be a whole number from 1 to 64"
    with pytest.raises(InputError, match=words):
        solve_chain(RUBBER, SINES, pressure_classes=count, **LOAD)
    with pytest.raises(InputError, match=words):
        Chain(pressure_classes=count)


def test_solver_without_pressures_cannot_hand_down_classes():
    solver = Scripted([0.5, 0.5, 0.5])
    silent = Silent(solver)
    with pytest.raises(InputError, match="gives no pressure along the wave"):
        solve_chain(Spring(), THREE, solver=silent, pressure_classes=2, **LOAD)


@dataclass
class Silent:
    """A solver that keeps its pressures to itself."""

    inner: Scripted
    name: ClassVar[str] = "silent"

    def solve(self, problem, start=None):
        solved = self.inner.solve(problem, start)
        return replace(solved, pressure=np.zeros_like(solved.pressure))
