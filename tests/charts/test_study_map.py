"""Figures over a_T v and of superpositions, read back from their axes."""

import re

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from gripscale.core.errors import InputError
from gripscale.model import TOTALS
from gripscale.questions import (
    Variation,
    friction_master_figure,
    shift_figure,
    superposition_figure,
    superposition_tests_figure,
)
from gripscale.questions.vary.study import BEYOND_SHIFT, with_master_curve
from gripscale.rubber import (
    WLF,
    MasterCurve,
    Rubber,
    ShiftTable,
    Sweeps,
    fit_wlf,
    springpot_modulus,
    superpose_report,
)
from tests.samples import DOCS

RUBBER = Rubber(5e6, [4e6], [1e-2], reference_temperature=293.15, shift=WLF(c1=8.0, c2=120.0))
SPEED = np.geomspace(1e-2, 10.0, 25)
KELVIN = np.array([283.15, 293.15, 313.15])


@pytest.fixture
def study():
    """A study whose friction is a function of a_T v alone, one prediction of which failed."""
    reduced = SPEED[:, None] * RUBBER.shift.a(KELVIN, 293.15)
    friction = 0.5 + 0.1 * np.tanh(np.log10(reduced))
    friction[3, 1] = np.nan
    status = np.full(friction.shape, "converged", dtype=object)
    status[3, 1] = "iteration limit"
    axes = ("speed", "temperature")
    data = xr.Dataset(
        {
            "total_friction": (axes, friction),
            "total_friction_from_dissipation": (axes, friction),
            "total_contact_fraction": (axes, 0.1 / friction),
            "prediction_status": (axes, status),
            BEYOND_SHIFT: (axes, np.broadcast_to(KELVIN > 300.0, friction.shape)),
        },
        coords={"speed": SPEED, "temperature": KELVIN},
        attrs={"title": "Study", "case": "", "version_gripscale": "0.1.0", "model": "direct"},
    )
    data["speed"].attrs |= {"units": "m/s", "long_name": "sliding speed"}
    data["temperature"].attrs |= {"units": "K", "long_name": "temperature", "symbol": "T"}
    for name in data.data_vars:
        data[name].attrs |= {"units": "1", "long_name": str(name)}
    return with_master_curve(data, RUBBER)


def test_the_variables_are_listed_with_their_units(study):
    text = (DOCS / "conditions.md").read_text(encoding="utf-8")
    listed = dict(re.findall(r"^\| `(\w+)` \| (\S+) \|", text, re.MULTILINE))
    known = {"speed", "temperature", "prediction_status", *TOTALS}
    assert listed == {
        str(name): study[name].attrs["units"] for name in study.variables if name not in known
    }


def test_temperatures_are_drawn_over_reduced_speed(study):
    friction = friction_master_figure(study).axes[0]
    assert len(friction.lines) == 3
    for i, one in enumerate(friction.lines):
        np.testing.assert_allclose(one.get_xdata(), study.reduced_speed.isel(temperature=i))
        np.testing.assert_allclose(one.get_ydata(), study.total_friction.isel(temperature=i))
    assert len({mpl.colors.to_hex(one.get_color()) for one in friction.lines}) == 3


def test_page_shows_celsius_and_reduced_speed(study, tmp_path):
    page = Variation(study).page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "25 of 75 predictions lie beyond the temperatures of the shift" in page
    assert 'id="figure-friction-master-curve"' in page


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
