"""The direct contact as a labelled Dataset.

By octave of wavelength, `wavelength` being its lower end:

- `friction`: the energy lost in the harmonics of the pressure of these wavelengths 2 pi/|q|, in the
  contact with the whole surface. The octaves sum to `friction_from_dissipation` exactly. Waves
  shorter than the smallest of the surface belong to the edges of the contact.
- `contact_fraction`: of another contact, with only the waves of the surface not shorter than
  `wavelength`, on a grid of four points in it; NaN where none was solved.
"""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale import versions
from gripscale.rough.grids import GridRecord
from gripscale.wave.dataset import labelled

if TYPE_CHECKING:
    from gripscale.rough.solved import SolvedContact

SOURCE = "gripscale direct contact"
SHARES = (0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
"""Shares of the contact whose pressures a Dataset holds."""

NUMBERS = {
    "contact_fraction": ("1", "real over nominal contact area"),
    "contact_fraction_error": ("1", "its estimated error of the grid"),
    "friction": ("1", "friction coefficient from the contact traction"),
    "friction_from_dissipation": ("1", "friction coefficient from the energy lost in the rubber"),
    "friction_error": ("1", "estimated error of the friction coefficients of the grid"),
    "friction_mismatch": ("1", "relative difference of the two friction coefficients"),
    "slope_in_contact": ("1", "rms slope of the surface in the contact"),
    "missing_share": ("1", "share of the contact on interpolated heights"),
    "smallest_wavelength": ("m", "smallest wavelength of the surface as solved"),
    "full_contact": ("1", "1 where the contact is full"),
}

OUTSIDE_BAND = {
    "friction_outside_band": ("share", "share of the friction lost outside the measured band"),
    "decades_below_band": ("below", "decades by which excitation goes below it"),
    "decades_above_band": ("above", "decades by which excitation goes above it"),
}
"""What of the friction rests on the rubber beyond its measured frequencies."""

CUT_OFF_EXPONENTS = {
    "contact_fraction_cut_off_exponent": ("contact_fraction", "contact fraction"),
    "friction_cut_off_exponent": ("friction", "friction coefficient"),
}
"""How it changes with the cut-off length, over the last octave."""


def by_wavelength(contact: SolvedContact) -> xr.Dataset:
    """Return friction and contact fraction over `wavelength`, from long to short."""
    number = np.broadcast_to(contact.grid.wavenumber, contact.grid.spectrum_shape).reshape(-1)[1:]
    lost = contact.lost_by_harmonic().reshape(-1)[1:]
    # a wave of exactly the lower end belongs to the octave, rounding or not
    octave = np.floor(np.log2(2.0 * np.pi / number / contact.smallest_wavelength) + 1e-9)
    order = np.arange(octave.max(), octave.min() - 1.0, -1.0)
    friction = np.bincount((octave.max() - octave).astype(int), weights=lost)
    fraction = np.full(order.size, np.nan)
    for grid in contact.grids:
        place = round(float(octave.max() - np.log2(grid.cut_off / contact.smallest_wavelength)))
        if grid.settled and 0 <= place < order.size:
            fraction[place] = grid.contact_fraction
    wavelength = contact.smallest_wavelength * 2.0**order
    return xr.Dataset(
        {
            "friction": labelled("wavelength", friction, "1", "friction of the octave", SOURCE),
            "running_friction": labelled(
                "wavelength", np.cumsum(friction), "1", "friction down to the octave", SOURCE
            ),
            "contact_fraction": labelled(
                "wavelength", fraction, "1", "contact fraction without shorter waves", SOURCE
            ),
        },
        coords={
            "wavelength": labelled("wavelength", wavelength, "m", "lower end of octave", "input")
        },
    )


def to_dataset(contact: SolvedContact, *, fields: bool) -> xr.Dataset:
    """Return the numbers of `contact`, by octave and by grid, and its `fields` on the last grid."""
    data = {
        name: labelled((), float(getattr(contact, name)), unit, text, SOURCE)
        for name, (unit, text) in NUMBERS.items()
    }
    beyond = contact.extrapolation
    data |= {
        name: labelled((), getattr(beyond, part), "1", text, SOURCE)
        for name, (part, text) in OUTSIDE_BAND.items()
    }
    exponents = contact.cut_off_exponents
    data |= {
        name: labelled((), getattr(exponents, part), "1", f"d ln({text})/d ln(cut-off)", SOURCE)
        for name, (part, text) in CUT_OFF_EXPONENTS.items()
    }
    octaves = by_wavelength(contact).rename(contact_fraction="contact_fraction_without_shorter")
    data |= {
        (name if name.startswith("contact") else f"octave_{name}"): values
        for name, values in ((str(key), octaves[key].variable) for key in octaves.data_vars)
    }
    for name in (entry.name for entry in dataclasses.fields(GridRecord)):
        values = [float(getattr(grid, name)) for grid in contact.grids]
        data[f"grid_{name}"] = labelled("grid", values, "1", f"{name} on each grid", SOURCE)
    data["contact_pressure"] = labelled(
        "share", contact.pressure_quantiles(SHARES), "Pa", "not exceeded on the share", SOURCE
    )
    data["patch_size"] = labelled(
        "patch", contact.patches, "m" if contact.height.ndim == 1 else "m2", "patches", SOURCE
    )
    if fields:
        data |= _fields(contact)
    for name, value in contact.residuals.items():
        data[f"residual_{name}"] = labelled((), value, "1", f"residual of the {name}", SOURCE)
    data["status"] = labelled((), np.array(str(contact.status), dtype=object), "1", "", SOURCE)
    return xr.Dataset(
        data,
        coords={"share": list(SHARES), "wavelength": octaves["wavelength"].variable},
        attrs={
            "title": "Direct contact of rubber with a whole rough surface",
            "rubber": f"{contact.rubber.name}; {contact.rubber.source}".strip("; "),
            "rubber_parameters": json.dumps(contact.rubber.to_dict()),
            "nominal_pressure": contact.nominal_pressure,
            "speed": contact.speed,
            "notes": " ".join(contact.notes),
            **versions.attributes(),
        },
    )


def _fields(contact: SolvedContact) -> dict[str, xr.Variable]:
    axes = ("x", "y")[: contact.height.ndim]
    coords = {axis: labelled(axis, getattr(contact, axis), "m", axis, SOURCE) for axis in axes}
    table = {
        "height": ("m", "height of the surface as solved", contact.height),
        "pressure": ("Pa", "contact pressure", contact.pressure),
        "gap": ("m", "gap between rubber and surface", contact.gap),
    }
    return coords | {
        name: labelled(axes, values, unit, text, SOURCE)
        for name, (unit, text, values) in table.items()
    }
