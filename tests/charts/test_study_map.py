"""Studies over speed and temperature: all temperatures over a_T v, on paper and on the page."""

import re

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from gripscale.model import TOTALS
from gripscale.questions import Variation, friction_master_figure
from gripscale.questions.vary.study import BEYOND_SHIFT, with_master_curve
from gripscale.rubber import WLF, Rubber
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
