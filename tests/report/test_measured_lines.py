"""What a run says of measured friction at its speed."""

import pytest

from gripscale.core.units import display_unit
from gripscale.experiment import MeasuredFriction
from gripscale.questions.calibration.page import measured_lines


def test_measured_friction_at_a_speed_is_interpolated_in_its_logarithm() -> None:
    found = MeasuredFriction(
        [1.0, 0.01, 1.0, 0.01],
        [1.2, 0.8, 1.0, 0.6],
        spread=[0.08, 0.04, 0.02, 0.02],
        temperature=[293.15, 293.15, 313.15, 313.15],
    )
    cold, warm = measured_lines(found, 0.1, display_unit("speed"))
    assert cold.startswith("Measured, 20 °C: μ = 1.00 ± 0.060 at 0.1 m/s")
    assert warm.startswith("Measured, 40 °C: μ = 0.800 ± 0.020 at 0.1 m/s")


@pytest.mark.parametrize("speed", [0.001, 10.0])
def test_nothing_is_extrapolated(speed: float) -> None:
    [line] = measured_lines(MeasuredFriction([0.01, 1.0], [0.8, 1.2]), speed, display_unit("speed"))
    assert line == f"Measured: nothing at {speed:g} m/s, only from 0.0100 to 1.00 m/s."


def test_speeds_are_those_of_the_case() -> None:
    [line] = measured_lines(
        MeasuredFriction([0.01, 1.0], [0.8, 1.2]), 10.0, display_unit("speed", {"speed": "km/h"})
    )
    assert line == "Measured: nothing at 36 km/h, only from 0.0360 to 3.60 km/h."
