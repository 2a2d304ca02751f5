"""What the figures of a superposition show, read back from their axes."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.questions import shift_figure, superposition_figure, superposition_tests_figure
from gripscale.rubber import (
    WLF,
    MasterCurve,
    ShiftTable,
    Sweeps,
    fit_wlf,
    springpot_modulus,
    superpose_report,
)

TRUE = WLF(8.86, 101.6, 293.15)


@pytest.fixture(scope="module")
def sweeps():
    hertz = np.geomspace(0.1, 30.0, 6)
    rows = []
    for kelvin in (263.15, 273.15, 283.15, 293.15):
        value = springpot_modulus(2 * np.pi * hertz * TRUE.a(kelvin, 293.15))
        rows.append([np.full(6, kelvin), hertz, value.real, value.imag])
    return Sweeps(*np.hstack(rows))


def test_sweeps_as_measured_and_shifted(sweeps):
    master, _ = superpose_report(sweeps, reference_temperature=293.15, shift=TRUE)
    figure = superposition_figure(sweeps, master)
    left, right = figure.axes[0], figure.axes[1]
    assert len(left.lines) == len(right.lines) == 4
    assert left.lines[0].get_xdata() == pytest.approx(sweeps.frequency[:6])
    x = np.sort(np.concatenate([line.get_xdata() for line in right.lines]))
    assert x == pytest.approx(master.frequency)
    assert len({line.get_color() for line in right.lines}) == 4
    with pytest.raises(InputError, match="master must have a shift"):
        superposition_figure(sweeps, MasterCurve([1.0, 2.0], [1e6, 1e6], [1e5, 1e5]))


def test_shift_factors_with_formula_and_residual():
    kelvin = 293.15 + np.arange(-30.0, 31.0, 10.0)
    table = ShiftTable(
        kelvin,
        TRUE.log_a(kelvin, 293.15) + 0.1 * np.sin(kelvin),
        np.full(7, 0.1),
        reference_temperature=293.15,
    )
    fit = fit_wlf(table, lowest=272.0)
    figure = shift_figure(table, [fit])
    assert len(figure.axes) == 2
    above, below = figure.axes
    drawn = next(line for line in above.lines if line.get_label() == "WLF")
    celsius, values = drawn.get_xdata(), drawn.get_ydata()
    known = np.isfinite(values)
    assert celsius[known].min() == pytest.approx(0.0, abs=0.5)  # solid where it was fitted
    expected = fit.shift.log_a(celsius[known] + 273.15, 293.15)
    assert values[known] == pytest.approx(expected + table.horizontal[3], abs=1e-9)
    assert above.get_ylim()[1] < table.horizontal.max() + 2.0
    assert below.lines[-1].get_ydata() == pytest.approx(-fit.residual)
    assert below.get_ylabel() == "formula minus\nsweeps [-]"
    lifted = ShiftTable(kelvin, table.horizontal, vertical=np.linspace(-0.02, 0.02, 7))
    assert len(shift_figure(lifted).axes) == 3


def test_tests_of_the_superposition(sweeps):
    _, report = superpose_report(sweeps, reference_temperature=293.15, shift=TRUE)
    figure = superposition_tests_figure(sweeps, report)
    gurp, cole, width, apart = figure.axes[:4]
    angle = np.degrees(np.arctan(sweeps.loss_factor))
    assert np.concatenate([line.get_ydata() for line in gurp.lines]) == pytest.approx(angle)
    assert cole.lines[0].get_xdata() == pytest.approx(sweeps.storage[:6] / 1e6)
    assert width.lines[0].get_ydata() == pytest.approx([one.decades for one in report.overlaps])
    assert [line.get_label() for line in apart.lines] == ["$E'$", "$E''$", "$E''/E'$"]
