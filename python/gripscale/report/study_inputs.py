"""What a study rests on, as far as its file tells: load, surface and rubber of the case."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from gripscale.figures.palette import MEGA
from gripscale.report.elements import Element, Facts, Section, Table
from gripscale.report.input_tables import GIGA, waves_table, without_folder
from gripscale.report.numbers import NONE, number
from gripscale.report.source import Study
from gripscale.units import ZERO_CELSIUS

LOAD = (
    ("pressure", "Nominal pressure", "Pa"),
    ("speed", "Sliding speed", "m/s"),
    ("footprint", "Footprint", "m"),
)
"""Keys of [load], what they are called, and the unit of a plain number."""
VARIED = "varied"


def input_sections(study: Study) -> list[Section]:
    """Return the chapters on inputs; those the file does not tell of are empty."""
    return [
        Section("inputs", "Inputs and their origin", [_load(study)]),
        Section("surface", "Surface", list(_surface(study))),
        Section("rubber", "Rubber", list(_rubbers(study.data))),
    ]


def _load(study: Study) -> Facts:
    """Return load, model and origins, with the quantities as the case gives them."""
    attrs, case = study.data.attrs, _case(study.data)
    load = case.get("load", {})
    pairs = [
        (label, VARIED if key in study.axes else _quantity(load.get(key), unit))
        for key, label, unit in LOAD
    ]
    conditions = ", ".join(name.replace("_", " ") for name in case.get("conditions", {}))
    pairs += [
        ("Conditions", conditions or "none"),
        ("Model", str(attrs.get("model", NONE)).replace("_", " ")),
        ("Surface", without_folder(str(attrs.get("surfaces", NONE)))),
        ("Rubber", without_folder(str(attrs.get("rubbers", NONE)))),
    ]
    return Facts("Load and model", pairs)


def _case(data: xr.Dataset) -> dict[str, Any]:
    """Return the tables of the case, none of a text that is no case."""
    try:
        return tomllib.loads(str(data.attrs.get("case", "")))
    except tomllib.TOMLDecodeError:
        return {}


def _quantity(given: Any, unit: str) -> str:
    if given is None:
        return NONE
    return given if isinstance(given, str) else f"{number(given)} {unit}"


def _surface(study: Study) -> Iterator[Table]:
    """Yield the sine waves, where all predictions have the same."""
    data = study.data
    if not {"wavelength", "amplitude"} <= set(data.data_vars):
        return
    both = [data[name].transpose(..., "scale").values for name in ("wavelength", "amplitude")]
    rows = [values.reshape(-1, values.shape[-1]) for values in both]
    if all(np.array_equal(one, np.broadcast_to(one[0], one.shape)) for one in rows):
        stack = {f"sines_{name}": ("wave", one[0]) for name, one in zip(_WAVES, rows, strict=True)}
        yield waves_table(xr.Dataset(stack))


_WAVES = ("wavelength", "amplitude")


def _rubbers(data: xr.Dataset) -> Iterator[Element]:
    """Yield what each rubber is, from its exact parameters."""
    given = json.loads(str(data.attrs.get("rubber_parameters", "[]")))
    for i, one in enumerate(given):
        moduli = [float.fromhex(value) for value in one["moduli"]]
        relaxed = float.fromhex(one["equilibrium_modulus"])
        pairs = [
            ("Relaxed modulus of the series", f"{number(relaxed, MEGA)} MPa"),
            ("Glassy modulus of the series", f"{number(relaxed + sum(moduli), MEGA)} MPa"),
            ("Bulk modulus", f"{number(float.fromhex(one['bulk_modulus']), GIGA)} GPa"),
            ("Maxwell elements", str(len(moduli))),
        ]
        if one.get("valid_band"):
            low, high = (number(float.fromhex(end)) for end in one["valid_band"])
            pairs.append(("Measured band", f"{low} to {high} rad/s"))
        if one.get("reference_temperature"):
            kelvin = float.fromhex(one["reference_temperature"])
            pairs.append(("Temperature", f"{number(kelvin - ZERO_CELSIUS)} °C"))
        yield Facts(one.get("name") or f"Rubber {i + 1}", pairs)
