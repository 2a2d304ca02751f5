"""What the result rests on: load, files, cleaning, fits, Maxwell elements."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import PurePath, PureWindowsPath
from typing import Any

import numpy as np
import xarray as xr

from gripscale.charts.page_elements import (
    NONE,
    Element,
    Facts,
    Heading,
    Section,
    Table,
    number,
    percent,
    whole,
)
from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS
from gripscale.report.source import Run, Study

GIGA = 1e9


def load_facts(run: Run) -> Facts:
    """Return load, rubber, surface and model in words."""
    attrs, data = run.attrs, run.data
    first = run.predictions[0]

    def given(name: str, value: float) -> str:
        how = first.shown(name)
        return f"{number(how.of(value))} {how.unit}"

    speeds = ", ".join(given("speed", one.speed) for one in run.predictions if one.moving)
    if any(not one.moving for one in run.predictions):
        speeds = f"{speeds or 'none'}; and at rest (relaxed rubber)"
    pressure, footprint = float(data["nominal_pressure"]), float(data["footprint"])
    model = str(attrs.get("model", NONE))
    if "wave_solver" in data:
        solvers = dict.fromkeys(str(name) for name in data["wave_solver"].values)
        model += f", waves by {', '.join(solvers)}"
    return Facts(
        "Load and model",
        [
            ("Nominal pressure", given("pressure", pressure)),
            ("Sliding speed", speeds),
            ("Footprint", given("footprint", footprint)),
            ("Rubber", rubber_source(run)),
            ("Model", model.replace("_", " ")),
            ("Strain energy", _energy(str(run.inputs.attrs.get("strain_energy", NONE)))),
            ("Method", str(attrs.get("method", NONE))),
        ],
    )


def _energy(stated: str) -> str:
    """Return the name of a strain energy in words, with its parameters if it has any."""
    name, _, rest = stated.partition("(")
    words = "-".join(re.findall(r"[A-Z][a-z]+", name)) or name
    parameters = rest.removesuffix(")")
    return f"{words}, {parameters}" if parameters else words


def rubber_source(run: Run) -> str:
    """Return name and source of the rubber; of a source that is a path, the file name."""
    name = str(run.inputs.attrs.get("rubber_name", ""))
    source = str(run.attrs.get("rubber_source", run.attrs.get("rubber", "")))
    return "; ".join(part for part in (name, without_folder(source)) if part) or NONE


def without_folder(text: str) -> str:
    """Return `text` with only the names of absolute paths in it: folders are of one machine."""
    return "".join(_name(part) for part in re.split(r"(; |, |: |\n)", text))


def _name(text: str) -> str:
    for kind in (PurePath, PureWindowsPath):
        if kind(text).is_absolute():
            return kind(text).name
    return text


def files_table(inputs: xr.Dataset) -> Table:
    """Return the measured files with size and checksum."""
    columns = [inputs[f"file_{name}"].values for name in ("name", "role", "bytes", "sha256")]
    rows = [
        [without_folder(str(name)), str(role), whole(size), str(checksum)]
        for name, role, size, checksum in zip(*columns, strict=True)
    ]
    headings = [
        Heading("file, as the case names it"),
        Heading("used for", words=True),
        Heading("bytes"),
    ]
    return Table("files", "Measured files", [*headings, Heading("SHA-256", words=True)], rows)


def cleaning_tables(inputs: xr.Dataset) -> list[Table]:
    """Return, for each profile, what each step of cleaning did."""
    tables = []
    steps = [str(step) for step in inputs["cleaning_step_name"].values]
    headings = [
        Heading("step"),
        Heading("points left"),
        Heading("cut off"),
        Heading("made missing"),
        Heading("missing now"),
        Heading("what was done", words=True),
    ]
    for i, name in enumerate(str(name) for name in inputs["profile_name"].values):
        one = inputs.isel(profile=i)
        fields = ("points", "removed", "made_missing", "missing")
        rows = [
            [
                step,
                *(whole(one[f"cleaning_{field}"].values[j]) for field in fields),
                str(one["cleaning_note"].values[j]) or NONE,
            ]
            for j, step in enumerate(steps)
        ]
        step, length = float(one["profile_step"]), float(one["profile_length"])
        caption = (
            f"Cleaning of {name}: {whole(one['profile_points'])} points read, step "
            f"{number(step, MILLI, 4)} mm, length {number(length, MILLI, 4)} mm"
        )
        tables.append(Table(f"cleaning-{i + 1}", caption, headings, rows))
    return tables


def surface_facts(inputs: xr.Dataset, count: int) -> list[Facts]:
    """Return what the fits to the height difference correlation found, with `count` waves."""
    get = inputs.attrs.get
    waves = [("Waves", str(count))]
    for key, label in (
        ("s_wavelength", "Factor of wavelength"),
        ("s_amplitude", "Factor of amplitude"),
    ):
        waves.append((label, number(get(f"sines_{key}", math.nan), digits=4)))
    if "sines_cut_off_m" in inputs.attrs:
        waves.append(("For roughness down to", f"{number(get('sines_cut_off_m'), MILLI)} mm"))
    waves.append(("Residual", f"{number(get('sines_residual_decades', math.nan))} decades of C_z"))
    waves.append(("Fitted lags", _span(get, "sines_lag_min_m", "sines_lag_max_m")))
    if (share := get("correlation_upper_share", 1.0)) < 1.0:
        waves.append(("Heights that count", f"the upper {100.0 * share:.3g} %"))
    facts = [Facts("Sine waves", waves), *_cut_off(get)]
    if "self_affine_hurst" in inputs.attrs:
        hurst = float(inputs.attrs["self_affine_hurst"])
        residual = number(get("self_affine_residual_decades", math.nan))
        pairs = [
            ("Hurst exponent H", number(hurst)),
            ("Fractal dimension D", number(3.0 - hurst)),
            ("Cut-off length ξ∥", f"{number(get('self_affine_xi_parallel_m'), MILLI)} mm"),
            ("Cut-off height ξ⊥", f"{number(get('self_affine_xi_perpendicular_m'), MILLI)} mm"),
            ("Residual", f"{residual} decades of C_z"),
            ("Fitted lags", _span(get, "self_affine_lag_min_m", "self_affine_lag_max_m")),
        ]
        facts.append(Facts("Self-affine description (not used by the chain)", pairs))
    elif "no_self_affine" in inputs.attrs:
        facts.append(Facts("Self-affine description", [("None", str(get("no_self_affine")))]))
    return facts


def _cut_off(get: Any) -> list[Facts]:
    """Return where the roughness ends; nothing of a file that does not tell."""
    if get("cut_off_m") is None:
        return []
    beyond = get("cut_off_beyond_measurement", 0)
    pairs = [
        ("Shortest wavelength that counts", f"{number(get('cut_off_m'), MILLI)} mm"),
        ("Rule", str(get("cut_off_rule", NONE))),
        ("Rms slope of the surface", number(get("cut_off_surface_slope", math.nan))),
        ("Rms slope along a profile", number(get("cut_off_profile_slope", math.nan))),
        ("The measurement carries", f"{number(get('cut_off_carried_m', math.nan), MILLI)} mm"),
    ]
    if beyond:
        pairs.append(("Beyond the measurement", "extrapolated: slopes and waves below it"))
    return [Facts("The cut-off", pairs)]


def _span(get: Any, first: str, last: str) -> str:
    low, high = get(first, math.nan), get(last, math.nan)
    return f"{number(low, MILLI)} to {number(high, MILLI)} mm"


def waves_table(data: xr.Dataset) -> Table:
    """Return the sine waves of a prediction."""
    lengths, heights = data["sines_wavelength"].values, data["sines_amplitude"].values
    rows = [
        [str(i + 1), number(w, MILLI, 4), number(a, MILLI, 4), number(2.0 * math.pi * a / w)]
        for i, (w, a) in enumerate(zip(lengths, heights, strict=True))
    ]
    headings = [Heading("wave"), Heading("λ", "mm"), Heading("A", "mm"), Heading("slope", "2πA/λ")]
    return Table("waves", "The sine waves", headings, rows)


def rubber_facts(inputs: xr.Dataset) -> Facts:
    """Return moduli, band and quality of the Prony series."""
    get = inputs.attrs.get
    moduli = inputs["term_modulus"].values if "term_modulus" in inputs else np.zeros(0)
    kelvin = float(get("reference_temperature_K", math.nan))
    ends = [float(get(f"band_{end}_rad_per_s", math.nan)) for end in ("low", "high")]
    (low, high), hertz = map(number, ends), [number(end, 2.0 * math.pi) for end in ends]
    pairs = [
        _end_text(inputs, "slow_end", "Relaxed modulus", "Slow end of the data, E′"),
        _end_text(inputs, "fast_end", "Glassy modulus", "Fast end of the data, E′"),
        ("Bulk modulus", f"{number(get('bulk_modulus_Pa', math.nan), GIGA)} GPa"),
        ("Maxwell elements", str(moduli.size)),
        ("Measured band", f"{low} to {high} rad/s ({hertz[0]} to {hertz[1]} Hz)"),
        ("Temperature", f"{number(kelvin)} K ({number(kelvin - ZERO_CELSIUS)} °C)"),
    ]
    if "prony_rms_storage" in inputs.attrs:
        names = (
            ("rms_storage", "Rms error of E′"),
            ("rms_loss", "Rms error of E″"),
            ("rms_loss_factor", "Rms error of E″/E′"),
            ("mean_loss_factor_error", "Mean error of E″/E′"),
            ("storage_scatter", "Scatter of measured E′"),
            ("loss_scatter", "Scatter of measured E″"),
        )
        pairs += [(label, percent(get(f"prony_{name}", math.nan))) for name, label in names]
        left_out = inputs["master_frequency"].values[inputs["master_left_out"].values != 0]
        texts = ", ".join(number(frequency) for frequency in left_out)
        pairs.append(("Rows left out as outliers", f"{texts} Hz" if texts else "none"))
    return Facts("Rubber", pairs)


def _end_text(inputs: xr.Dataset, name: str, plateau: str, otherwise: str) -> tuple[str, str]:
    """Return label and modulus of an end of the data: of a plateau only where one was measured."""
    modulus = number(inputs.attrs.get(f"{name}_modulus_Pa", math.nan), MEGA)
    label = plateau if inputs.attrs.get(f"{name}_plateau", 0) else otherwise
    return label, f"{modulus} MPa"


def prony_table(inputs: xr.Dataset) -> Table:
    """Return the Maxwell elements."""
    times, moduli = inputs["term_relaxation_time"].values, inputs["term_modulus"].values
    rows = [
        [str(i + 1), number(time, 1.0, 4), number(modulus, MEGA, 4)]
        for i, (time, modulus) in enumerate(zip(times, moduli, strict=True))
    ]
    headings = [Heading("element"), Heading("τ", "s"), Heading("E", "MPa")]
    return Table("prony", "Maxwell elements of the Prony series", headings, rows)


# What a study rests on, as far as its file tells: load, surface and rubber of the case.

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
