"""Stand-ins for the rubber, the sines and the solver, with numbers that are exact by hand."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from gripscale.core.status import Status
from gripscale.rubber import Rubber
from gripscale.wave import ScaleResult, WaveProblem


def solved(problem: WaveProblem, **changed: Any) -> ScaleResult:
    """Return the result of a wave with stated numbers, converged unless said otherwise."""
    profile, load = problem.profile, problem.load
    values = {
        "status": Status.CONVERGED,
        "newton_iterations": 1,
        "residual": 1e-10,
        "min_stretch": 0.5,
        "max_stretch": 1.5,
    }
    return ScaleResult(
        wavelength=profile.wavelength,
        amplitude=profile.amplitude,
        pressure_received=load.pressure,
        speed=load.speed,
        load_time=load.load_time,
        rubber=problem.rubber,
        **values | changed,
    )


class Spring(Rubber):
    """A rubber with E* = 4 MPa + 3 MPa i at any frequency, so that |E*| is 5 MPa."""

    def __init__(self) -> None:
        super().__init__(4e6, name="spring", source="by hand", valid_band=(1e-9, 2 * np.pi * 100.0))

    def complex_modulus(self, omega: Any) -> Any:
        return np.full(np.shape(omega), 4e6 + 3e6j)


@dataclass
class Scripted:
    """A solver that returns stated contact fractions and remembers what it was asked."""

    name: ClassVar[str] = "scripted"

    fractions: list[float]
    frictions: list[float] = field(default_factory=lambda: [0.125, 0.25, 0.5])
    statuses: list[str] = field(default_factory=lambda: ["converged"] * 3)
    asked: list[WaveProblem] = field(default_factory=list)
    starts: list[ScaleResult | None] = field(default_factory=list)

    def solve(self, problem: WaveProblem, start: ScaleResult | None = None) -> ScaleResult:
        i = len(self.asked)
        self.asked.append(problem)
        self.starts.append(start)
        nodes = 4 + 2 * i
        return solved(
            problem,
            contact_fraction=self.fractions[i],
            friction=self.frictions[i],
            friction_from_dissipation=self.frictions[i] * 0.75,
            status=Status(self.statuses[i]),
            newton_iterations=5 + i,
            x=np.linspace(-0.5, 0.5, nodes) * problem.profile.wavelength,
            pressure=np.full(nodes, problem.load.pressure),
        )
