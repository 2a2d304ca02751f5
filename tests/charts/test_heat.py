"""Temperatures by scale and along the surface: figures and table of the numbers they were given."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.patches import Rectangle

import gripscale as gs
from gripscale.conditions import Conditions, ThermalProperties
from gripscale.core.errors import InputError
from gripscale.io.table import as_text
from gripscale.questions import direct_heat_figure, heat_figure
from gripscale.questions.chain.page import heat_table
from gripscale.surface import HeightMap
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_VALUES as LOAD

HEAT = Conditions(heat=ThermalProperties(conductivity=0.25, density=1150.0, specific_heat=1500.0))
STEP = 1e-5


def waves(x: np.ndarray) -> np.ndarray:
    turns = 2.0 * np.pi * x / (x.size * STEP)
    return 2e-4 * np.cos(3 * turns) + 3e-5 * np.cos(17 * turns + 1.0)


@pytest.fixture(scope="module")
def chain() -> xr.Dataset:
    sines = gs.SineStack([4e-3, 1e-3], [2e-4, 6e-5])
    options = {"solver": "half_plane", "points": 128, "conditions": HEAT}
    return gs.solve_chain(RUBBER, sines, **LOAD, **options).to_dataset()


def contact(surface: gs.Profile | HeightMap, conditions: Conditions | None = HEAT):
    options = {"periodic": True, "tolerance": None, "conditions": conditions}
    return gs.solve_rough_contact(RUBBER, surface, **LOAD, **options)


def line() -> gs.Profile:
    x = np.arange(1024) * STEP
    return gs.Profile(x, waves(x))


def test_bars_stay_clear_of_the_frame(chain: xr.Dataset) -> None:
    axes = heat_figure(chain).axes[0]
    bars = [bar for bar in axes.patches if isinstance(bar, Rectangle)]
    low, high = axes.get_ylim()
    ends = [end for bar in bars for end in (bar.get_y(), bar.get_y() + bar.get_height())]
    assert max(ends) < high - 0.03 * (high - low)
    assert min(ends) > low + 0.03 * (high - low)


def test_bars_stack_to_the_temperature_of_each_wave(chain: xr.Dataset) -> None:
    axes = heat_figure(chain, "heat").axes[0]
    bars = [bar for bar in axes.patches if isinstance(bar, Rectangle)]
    assert len(bars) == 6
    for i in range(2):
        ends = [(bar.get_y(), bar.get_y() + bar.get_height()) for bar in bars[i::2]]
        top = max(max(pair) for pair in ends)
        bottom = min(0.0, *(min(pair) for pair in ends))
        # as warm as it was assumed to be, as far as the passes settle: 2e-3 of a logarithm
        assert top + bottom == pytest.approx(float(chain.temperature[i]) - 293.15, rel=5e-3)
    assert axes.get_ylabel() == "above the 20 °C before the contact [K]"
    dots = next(one for one in axes.lines if one.get_label() == "at the surface, in contact")
    np.testing.assert_allclose(
        np.asarray(dots.get_ydata()), chain.contact_temperature - 293.15, atol=0.02
    )


def test_parts_that_cool_hang_below_zero(chain: xr.Dataset) -> None:
    cooled = chain.assign(
        flash_temperature_rise_larger_waves=-0.1 * chain.flash_temperature_rise_uniform
    )
    bars = heat_figure(cooled).axes[0].patches[2:4]
    for bar, wave in zip(bars, cooled.flash_temperature_rise_larger_waves.values, strict=True):
        assert (bar.get_y(), bar.get_height()) == (0.0, pytest.approx(float(wave)))


def test_table_has_a_row_for_each_wave(chain: xr.Dataset) -> None:
    rows = as_text(heat_table(chain)).splitlines()
    first = next(row for row in rows if row.split()[:2] == ["1", "4.00"])
    assert first.split()[5] == f"{float(chain.temperature[0]) - 273.15:.1f}"


def test_line_shows_octaves_and_the_temperature_along_it() -> None:
    solved = contact(line())
    octaves, along = direct_heat_figure(solved).axes
    np.testing.assert_allclose(octaves.lines[0].get_ydata(), solved.scales.warming)
    np.testing.assert_allclose(octaves.lines[0].get_xdata(), 2e3 * np.pi / solved.scales.wavenumber)
    np.testing.assert_allclose(along.lines[0].get_ydata(), solved.surface_warming)
    marks = np.asarray(next(one for one in along.lines if one.get_label() == "contact").get_ydata())
    np.testing.assert_array_equal(np.isfinite(marks), solved.active)


def test_map_shows_the_temperature_everywhere() -> None:
    x = np.arange(64) * STEP
    shape = np.cos(2 * np.pi * x / (64 * STEP))
    solved = contact(HeightMap(x, x, 1e-5 * (shape[:, None] + shape[None, :])))
    shown = direct_heat_figure(solved, "heat").axes[1].collections[0]
    np.testing.assert_allclose(np.ravel(shown.get_array()), np.ravel(solved.surface_warming.T))


def test_results_without_heat_are_refused(chain: xr.Dataset) -> None:
    with pytest.raises(InputError, match="data must be of a chain solved with heat"):
        heat_figure(chain.drop_vars("flash_temperature_rise_own"))
    with pytest.raises(InputError, match="contact must be solved with heat and slide"):
        direct_heat_figure(contact(line(), None))
