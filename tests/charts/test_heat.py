"""The table of temperatures by wave has the numbers of the chain."""

from __future__ import annotations

import pytest
import xarray as xr

import gripscale as gs
from gripscale.conditions import Conditions, ThermalProperties
from gripscale.io.table import as_text
from gripscale.questions.chain.page import heat_table
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_VALUES as LOAD

HEAT = Conditions(heat=ThermalProperties(conductivity=0.25, density=1150.0, specific_heat=1500.0))


@pytest.fixture(scope="module")
def chain() -> xr.Dataset:
    sines = gs.SineStack([4e-3, 1e-3], [2e-4, 6e-5])
    options = {"solver": "half_plane", "points": 128, "conditions": HEAT}
    return gs.solve_chain(RUBBER, sines, **LOAD, **options).to_dataset()


def test_table_has_a_row_for_each_wave(chain: xr.Dataset) -> None:
    rows = as_text(heat_table(chain)).splitlines()
    first = next(row for row in rows if row.split()[:2] == ["1", "4.00"])
    assert first.split()[5] == f"{float(chain.temperature[0]) - 273.15:.1f}"
