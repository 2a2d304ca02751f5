"""How warm the rubber gets on each wave of a chain, as a table."""

from __future__ import annotations

import math

import xarray as xr
from rich.table import Table

from gripscale.figures.palette import MILLI
from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.units import ZERO_CELSIUS

PARTS = ("warming_uniform", "warming_larger_waves", "warming_own")


def heat_table(data: xr.Dataset) -> Table:
    """Return the temperature on each wave, by what it is made of.

    Parameters
    ----------
    data : xarray.Dataset
        Of `Prediction.to_dataset`, with heat.
    """
    table = printed_table(padding=2)
    for head in (
        "#\n",
        "λ\nmm",
        "all waves,\nevenly [K]",
        "larger\nwaves [K]",
        "own\n[K]",
        "T where\nlost [°C]",
        "T at the\nsurface [°C]",
    ):
        table.add_column(head, justify="right", no_wrap=True)
    for i in range(data.sizes["scale"]):
        wave = data.isel(scale=i)
        table.add_row(
            str(i + 1),
            significant(float(wave.wavelength) / MILLI),
            *(_kelvin(float(wave[name])) for name in PARTS),
            *(
                _kelvin(float(wave[name]) - ZERO_CELSIUS)
                for name in ("temperature", "contact_temperature")
            ),
        )
    return table


def _kelvin(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1f}"
