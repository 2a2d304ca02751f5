"""What a result rests on: load, files, cleaning, surface, rubber, conditions.

`gripscale run` prints it from the prepared inputs, a page reads it from an `InputRecord`.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from dataclasses import fields
from pathlib import PurePath, PureWindowsPath
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.conditions.flash_temperature import ThermalProperties
from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS, display_unit_of, in_mm
from gripscale.io.table import NONE, Column, Table, digits, fixed, significant, whole_number
from gripscale.questions.inputs.charts_of_rubber import rubber_charts
from gripscale.questions.inputs.charts_of_surface import correlation_charts, profile_charts
from gripscale.questions.inputs.record import InputRecord, rubber_variables
from gripscale.report.elements import Element, Facts, Section, Text, number_text, percent_text
from gripscale.rubber import Rubber, ShiftTable
from gripscale.rubber.material import BEYOND, End, fast_end, slow_end
from gripscale.rubber.softening import SofteningTable, assumptions
from gripscale.surface.texture import DEPTH_NOTE, TEXTURE_NUMBERS, beside_label

if TYPE_CHECKING:
    from gripscale.conditions.conditions import Conditions
    from gripscale.rubber.measured_rubber import MeasuredRubber
    from gripscale.surface import HeightMap, SineStack, SlopeByWavelength, Surface


def numbers(name: str, count: int, heading: str | None = None) -> Column:
    """Return a column of numbers from 1."""
    return Column(name, list(range(1, count + 1)), heading, format="{:.0f}".format)


def waves_table(wavelength: ArrayLike, amplitude: ArrayLike) -> Table:
    """Return the sine waves of a surface, largest first."""
    length, height = np.asarray(wavelength), np.asarray(amplitude)
    columns = [
        numbers("wave", length.size),
        Column("wavelength", length, "λ", "mm", MILLI, format=digits(4)),
        Column("amplitude", height, "A", "mm", MILLI, format=digits(4)),
        Column("slope", 2.0 * math.pi * height / length, unit="2πA/λ"),
    ]
    return Table("waves", columns, "The sine waves")


def rms_slopes_table(slopes: SlopeByWavelength) -> Table:
    """Return the rms slope down to each wavelength."""
    lengths = slopes.wavelength
    columns = [Column("wavelength", lengths, "down to", "mm", MILLI)]
    for kind, heading in (("surface", "of the surface"), ("profile", "along a profile")):
        values = [slopes.down_to(float(length), kind) for length in lengths]
        columns.append(Column(f"{kind}_slope", values, f"rms slope {heading}"))
    return Table("slopes", columns, "Rms slope by the smallest wavelength that counts")


def texture_table(data: xr.Dataset, dim: str = "texture_of", heading: str = "") -> Table:
    """Return the texture of surfaces along `dim`, without the numbers that none of them has."""
    columns = [Column(dim, data[dim].values.astype(str).tolist(), heading)]
    units = {"m": ("mm", MILLI), "rad": ("°", math.radians(1.0))}
    for name, (symbol, unit, _) in TEXTURE_NUMBERS.items():
        values = data[name].values.astype(float) if name in data else np.full(1, np.nan)
        if np.nan_to_num(values).any():
            printed, size = units.get(unit, ("", 1.0))
            form = whole_number if name == "depth_segments" else significant
            columns.append(Column(name, values, symbol, printed, size, format=form))
    notes = [str(text) for text in data[DEPTH_NOTE].values]
    if any(notes):
        columns.append(Column(DEPTH_NOTE, notes, "no MPD", words=True))
    title = "Texture: ISO 13473-1 and -2, ISO 21920-2 and ISO 25178-2"
    other_road = "" if heading else beside_label(float(data["mean_profile_depth"][-1]))
    return Table("texture", columns, title, [other_road] if other_road else [])


def texture_levels_table(data: xr.Dataset) -> Table:
    """Return texture levels by wavelength, as `gripscale.surface.texture`."""
    columns = [
        Column("wavelength", data.wavelength.values, "λ", "mm", MILLI, format=digits(3)),
        Column("level", data.level.values, "L_tx", "dB", format=fixed(1)),
    ]
    return Table("levels", columns, "Third-octave texture levels re 1 µm: ISO 13473-4")


def prony_table(times: ArrayLike, moduli: ArrayLike) -> Table:
    """Return the Maxwell elements of a Prony series."""
    columns = [
        numbers("element", np.size(times)),
        Column("relaxation_time", np.asarray(times), "τ", "s", format=digits(4)),
        Column("modulus", np.asarray(moduli), "E", "MPa", MEGA, format=digits(5)),
    ]
    return Table("prony", columns, "Maxwell elements of the Prony series")


def band_table(rubber: Rubber) -> Table | None:
    """Return E' and E'' with what the data leave open, at and beyond the ends of the data."""
    if rubber.valid_band is None or rubber.admissible is None:
        return None
    slow, fast = rubber.valid_band
    omega = np.array([slow / BEYOND, slow, (slow * fast) ** 0.5, fast, fast * BEYOND])
    modulus, (low, high) = rubber.complex_modulus(omega), rubber.complex_modulus_band(omega)
    columns = [
        Column("angular_frequency", omega, "ω", "rad/s"),
        Column("storage", modulus.real, "E'", "MPa", MEGA, format=digits(4)),
        Column("storage_admissible", np.stack([low.real, high.real], 1), "admissible", "MPa", MEGA),
        Column("loss", modulus.imag, "E''", "MPa", MEGA, format=digits(4)),
        Column("loss_admissible", np.stack([low.imag, high.imag], 1), "admissible", "MPa", MEGA),
    ]
    return Table("band", columns, "Moduli, and what the data leave open")


def shift_table(shift: ShiftTable) -> Table:
    """Return the shift factors of a master curve made of sweeps."""
    columns = [
        Column("temperature", shift.temperature, unit="°C", zero=ZERO_CELSIUS, format=fixed(1)),
        Column("horizontal", shift.horizontal, "log10 a_T", format=fixed(3)),
        Column("horizontal_error", shift.horizontal_error, "±", format=fixed(3)),
        Column("vertical", 10.0 ** np.asarray(shift.vertical), "b_T", format=fixed(3)),
    ]
    return Table("shift", columns, "Shift factors")


def softening_parts(law: SofteningTable) -> Iterator[str | Table]:
    """Yield what strain sweeps keep of both moduli, by temperature, and what is assumed."""
    strains = np.array([1e-2, 0.1])
    kept = np.array([law.of_sweep(at, strains) for at in range(len(law.strain))])
    for at, measured in enumerate(law.strain):
        kept[at, :, (strains < measured[0]) | (strains > measured[-1])] = math.nan
    kelvin = np.full(len(law.strain), math.nan) if law.temperature is None else law.temperature
    columns = [Column("temperature", kelvin, unit="°C", zero=ZERO_CELSIUS, format=fixed(1))]
    columns += [
        Column(f"{name}_{strain:g}", kept[:, row, at], f"{symbol} at {100 * strain:g} %")
        for row, (name, symbol) in enumerate((("storage", "E'"), ("loss", "E''")))
        for at, strain in enumerate(strains)
    ]
    yield Table("softening", columns, "Moduli over those of the master curve, by strain")
    yield from (f"assumed: {text}" for text in assumptions(law))


def files_table(record: InputRecord) -> Table:
    """Return the measured files with size and checksum."""
    names = [without_folder(str(name)) for name in record.data["file_name"].values]
    columns = [
        Column("file", names, "file, as the case names it"),
        Column("role", record.data["file_role"].values, "used for"),
        Column("bytes", record.data["file_bytes"].values, format=whole_number),
        Column("sha256", record.data["file_sha256"].values, "SHA-256"),
    ]
    return Table("files", columns, "Measured files")


def cleaning_tables(record: InputRecord) -> Iterator[Table]:
    """Yield for each profile what each step of its cleaning did."""
    data = record.data
    headings = {
        "points": "points left",
        "removed": "cut off",
        "made_missing": "made missing",
        "missing": "missing now",
    }
    for i, profile in enumerate(data["profile_name"].values):
        part = data.isel(profile=i)
        columns = [
            Column("step", data["cleaning_step_name"].values),
            *(
                Column(name, part[f"cleaning_{name}"].values, heading, format=whole_number)
                for name, heading in headings.items()
            ),
            Column("note", part["cleaning_note"].values, "what was done", words=True),
        ]
        ends = (part[f"profile_{end}"] for end in ("step", "length"))
        step, length = (number_text(value, MILLI, digits(4)) for value in ends)
        points = number_text(part["profile_points"], format=whole_number)
        caption = f"Cleaning of {profile}: {points} points read, step {step} mm, length {length} mm"
        yield Table(f"cleaning-{i + 1}", columns, caption)


def surface_lines(surface: Surface) -> Iterator[str]:
    """Yield what was read and removed, the fits, the sine waves and the cut-off."""
    measured = surface.measured
    if measured is not None:
        # heights taken as they are have no reports
        reports = [str(report) for report in measured.cleaning] or [""] * len(measured.profiles)
        for (raw, cleaned), report in zip(measured.profiles, reports, strict=True):
            yield f"{raw.name or raw.source}: {len(cleaned)} points, step {raw.step / MILLI:.4g} mm"
            yield from (f"  {line}" for line in report.splitlines())
        if measured.map is not None:
            yield map_line(measured.map)
        share = surface.counted.get("top_height_fraction", 1.0)
        if share < 1.0:
            yield f"correlation of the upper {100.0 * share:.3g} % of the heights only"
        if measured.self_affine is None:
            yield f"not self-affine: {measured.no_self_affine}"
        else:
            fit = measured.self_affine
            yield (
                f"self-affine from {fit.lag_min / MILLI:.3g} to {fit.lag_max / MILLI:.3g} mm: "
                f"H = {fit.hurst:.3f}, D = {fit.fractal_dimension:.3f}, "
                f"xi_parallel = {fit.xi_parallel / MILLI:.3g} mm, "
                f"xi_perpendicular = {fit.xi_perpendicular / MILLI:.3g} mm"
            )
    yield sines_line(surface.sines)
    if surface.cut_off is not None:
        yield f"cut-off: {surface.cut_off}"


def map_line(surface: HeightMap) -> str:
    """Return which way of a map is which, and how long it is: a picture of its axes in words."""
    ways = ("along the way of sliding (x)", "across it (y)")
    axes = (
        f"{way}: {size} points over {in_mm(length, 4)}"
        for way, size, length in zip(ways, surface.z.shape, surface.length, strict=True)
    )
    array = PurePath(surface.source).suffix.lower() in (".npy", ".npz")
    return "; ".join([*axes, *(["the first index of the array is x of the file"] * array)])


def sines_line(sines: SineStack) -> str:
    """Return the stack of sine waves in one sentence."""
    largest, smallest = sines.wavelength[0] / MILLI, sines.wavelength[-1] / MILLI
    text = f"{len(sines)} sine waves from {largest:.3g} to {smallest:.3g} mm"
    if sines.s_wavelength is not None and sines.s_amplitude is not None:
        text += f", s_wavelength = {sines.s_wavelength:.3f}, s_amplitude = {sines.s_amplitude:.3f}"
    if sines.cut_off is not None:
        text += f", for roughness down to {sines.cut_off / MILLI:.3g} mm"
    if sines.residual is not None:
        text += f", residual {sines.residual:.3f} decades of C_z"
    return text


def rubber_parts(prepared: MeasuredRubber) -> Iterator[str | Table]:
    """Yield what the rubber is and how well its Prony series fits, in sentences and a table."""
    rubber = prepared.rubber
    slow, fast = _end(slow_end(rubber), "relaxed"), _end(fast_end(rubber), "glassy")
    bulk = significant(rubber.bulk_modulus / MEGA)
    yield f"{rubber.name or 'rubber'}: E' from {slow} to {fast}, bulk modulus {bulk} MPa"
    if prepared.fit is not None:
        yield from prepared.fit.summary(findings=False).splitlines()
    if prepared.source:
        yield f"source: {prepared.source}"
    yield from shift_parts(prepared)


def shift_parts(prepared: MeasuredRubber) -> Iterator[str | Table]:
    """Yield the sweeps of a master curve, how they meet, and the shift factors as a table."""
    shift, reference = prepared.rubber.shift, prepared.rubber.reference_temperature
    if prepared.sweeps is not None and prepared.superposition is not None:
        yield prepared.sweeps.summary()
        yield from prepared.superposition.summary().splitlines()
    elif shift is not None and reference is not None:
        yield f"shift, as stated: {shift.kind}, from {reference - ZERO_CELSIUS:.4g} C"
    if isinstance(shift, ShiftTable) and prepared.sweeps is not None:
        yield shift_table(shift)
    yield from (fit.summary() for fit in prepared.shift_fits())


def conditions_lines(conditions: Conditions, rubber: Rubber) -> Iterator[str]:
    """Yield the effects that are asked for, with their numbers."""
    kelvin = conditions.temperature_of(rubber)
    if kelvin is not None:
        origin = "" if conditions.temperature is not None else ", of the master curve"
        yield f"temperature before the contact {kelvin - ZERO_CELSIUS:.4g} C{origin}"
    softening = conditions.softening
    if isinstance(softening, SofteningTable):
        kelvins = softening.temperature or ()
        at = " and ".join(f"{kelvin - ZERO_CELSIUS:.3g} C" for kelvin in kelvins)
        sweeps = f"{len(softening.strain)} strain sweep{'s' * (len(softening.strain) > 1)}"
        yield f"softening: {sweeps}{f' at {at}' if at else ''}, as measured"
    elif softening is not None:
        yield f"softening: {_numbers(softening)}"
    if softening is not None:
        yield from (f"softening, assumed: {text}" for text in assumptions(softening))
    if conditions.heat is not None:
        typical = ", typical of rubber" if conditions.heat == ThermalProperties() else ""
        yield f"heat of friction: {_numbers(conditions.heat)}{typical}"
    if conditions.shear_stress is not None:
        yield f"interface: {_numbers(conditions.shear_stress)}"
    if conditions.water is not None:
        flooded = math.isinf(conditions.water)
        film = "flooded" if flooded else f"a film of {in_mm(conditions.water, 3)}"
        yield f"water: {film}, trapped where contact surrounds it"


def _numbers(law: Any) -> str:
    """Return kind and numbers of a law; of tables how many."""
    values = {f.name: getattr(law, f.name) for f in fields(law) if f.repr}
    texts = (
        f"{name} {len(value)} values"
        if isinstance(value, tuple)
        else f"{name} {value if isinstance(value, str) else format(value, 'g')}"
        for name, value in values.items()
        if value is not None and not isinstance(value, bool)
    )
    return ", ".join([*filter(None, [getattr(law, "kind", "")]), *texts])


def _end(end: End, plateau: str) -> str:
    kind = plateau if end.plateau else "end of the data"
    return f"{significant(end.modulus / MEGA)} MPa ({kind})"


def without_folder(text: str) -> str:
    """Return `text` with only the names of absolute paths in it: folders are of one machine."""
    parts = re.split(r"(; |, |: |\n)", text)
    for kind in (PurePath, PureWindowsPath):
        parts = [kind(part).name if kind(part).is_absolute() else part for part in parts]
    return "".join(parts)


def surface_facts(record: InputRecord, count: int) -> list[Facts]:
    """Return the fits to the height difference correlation, with `count` waves."""

    def span(name: str) -> str:
        ends = (number_text(record.number(f"{name}_lag_{end}_m"), MILLI) for end in ("min", "max"))
        return f"{' to '.join(ends)} mm"

    waves = [
        ("Waves", str(count)),
        ("Factor of wavelength", record.quantity("sines_s_wavelength", format=digits(4))),
        ("Factor of amplitude", record.quantity("sines_s_amplitude", format=digits(4))),
    ]
    if record.has("sines_cut_off_m"):
        waves.append(("For roughness down to", record.quantity("sines_cut_off_m", "mm", MILLI)))
    waves.append(("Residual", record.quantity("sines_residual_decades", "decades of C_z")))
    waves.append(("Fitted lags", span("sines")))
    if record.number("correlation_top_height_fraction") < 1.0:
        share = 100.0 * record.number("correlation_top_height_fraction")
        waves.append(("Heights that count", f"the upper {share:.3g} %"))
    facts = [Facts("Sine waves", waves)]
    if record.has("cut_off_m"):
        pairs = [
            ("Shortest wavelength that counts", record.quantity("cut_off_m", "mm", MILLI)),
            ("Rule", record.text("cut_off_rule") or NONE),
            ("Rms slope of the surface", record.quantity("cut_off_surface_slope")),
            ("Rms slope along a profile", record.quantity("cut_off_profile_slope")),
            ("The measurement resolves", record.quantity("cut_off_carried_m", "mm", MILLI)),
        ]
        if record.number("cut_off_beyond_measurement") > 0.0:
            pairs.append(("Beyond the measurement", "extrapolated: slopes and waves below it"))
        facts.append(Facts("The cut-off", pairs))
    if record.has("self_affine_hurst"):
        pairs = [
            ("Hurst exponent H", record.quantity("self_affine_hurst")),
            ("Fractal dimension D", number_text(3.0 - record.number("self_affine_hurst"))),
            ("Cut-off length ξ∥", record.quantity("self_affine_xi_parallel_m", "mm", MILLI)),
            ("Cut-off height ξ⊥", record.quantity("self_affine_xi_perpendicular_m", "mm", MILLI)),
            ("Residual", record.quantity("self_affine_residual_decades", "decades of C_z")),
            ("Fitted lags", span("self_affine")),
        ]
        facts.append(Facts("Self-affine description (not used by the chain)", pairs))
    elif record.has("no_self_affine"):
        facts.append(Facts("Self-affine description", [("None", record.text("no_self_affine"))]))
    return facts


def rubber_facts(record: InputRecord) -> Facts:
    """Return moduli, band and quality of the Prony series."""

    def end(name: str, plateau: str, otherwise: str) -> tuple[str, str]:
        # a plateau is claimed only where one was measured
        label = plateau if record.number(f"{name}_plateau") > 0.0 else otherwise
        return label, record.quantity(f"{name}_modulus_Pa", "MPa", MEGA)

    band = [record.number(f"band_{end_name}_rad_per_s") for end_name in ("low", "high")]
    low, high = (number_text(frequency) for frequency in band)
    slow, fast = (number_text(frequency, 2.0 * math.pi) for frequency in band)
    kelvin = record.number("reference_temperature_K")
    pairs = [
        end("slow_end", "Relaxed modulus", "Slow end of the data, E′"),
        end("fast_end", "Glassy modulus", "Fast end of the data, E′"),
        ("Bulk modulus", record.quantity("bulk_modulus_Pa", "GPa", 1e9)),
        ("Maxwell elements", str(record.data.sizes.get("maxwell_element", 0))),
        ("Measured band", f"{low} to {high} rad/s ({slow} to {fast} Hz)"),
        ("Temperature", f"{number_text(kelvin)} K ({number_text(kelvin - ZERO_CELSIUS)} °C)"),
    ]
    if record.has("prony_rms_storage"):
        for name, label in (
            ("rms_storage", "Rms error of E′"),
            ("rms_loss", "Rms error of E″"),
            ("rms_loss_factor", "Rms error of E″/E′"),
            ("mean_loss_factor_error", "Mean error of E″/E′"),
            ("storage_scatter", "Scatter of measured E′"),
            ("loss_scatter", "Scatter of measured E″"),
        ):
            pairs.append((label, percent_text(record.number(f"prony_{name}"))))
        left_out = record.data["master_frequency"].values[record.data["master_left_out"].values > 0]
        texts = ", ".join(number_text(frequency) for frequency in left_out)
        pairs.append(("Rows left out as outliers", f"{texts} Hz" if texts else "none"))
    return Facts(record.text("rubber_name") or "Rubber", pairs)


def input_sections(data: xr.Dataset) -> list[Section]:
    """Return the chapters on the inputs of a study; those its file does not tell of are empty."""
    attrs, axes = data.attrs, data["total_friction"].dims

    def quantity(key: str, attribute: str) -> str:
        if key in axes:
            return "varied"
        unit = display_unit_of(attrs, key)
        return unit.text(attrs[attribute]) if attribute in attrs else NONE

    effects = json.loads(attrs.get("conditions", "null")) or {}
    names = ("temperature", "softening", "heat", "shear_stress")
    conditions = ", ".join(n.replace("_", " ") for n in names if effects.get(n) is not None)
    load = Facts(
        "Load and model",
        [
            ("Nominal pressure", quantity("pressure", "nominal_pressure")),
            ("Sliding speed", quantity("speed", "nominal_speed")),
            ("Footprint", quantity("footprint", "footprint")),
            ("Conditions", conditions or ("none" if "conditions" in attrs else NONE)),
            ("Model", str(attrs.get("model", NONE)).replace("_", " ")),
            ("Surface", without_folder(str(attrs.get("surfaces", NONE)))),
            ("Rubber", without_folder(str(attrs.get("rubbers", NONE)))),
        ],
    )
    waves = []
    if {"wavelength", "amplitude"} <= set(data.data_vars):
        length, height = (
            data[name].transpose(..., "scale").values.reshape(-1, data.sizes["scale"])
            for name in ("wavelength", "amplitude")
        )
        if (length == length[0]).all() and (height == height[0]).all():  # of all predictions
            waves.append(waves_table(length[0], height[0]))
    rubbers = []
    for rubber in rubbers_of(data):
        variables, about = rubber_variables(rubber, None, None, np.zeros(0))
        about["reference_temperature_K"] = rubber.reference_temperature
        rubbers.append(rubber_facts(InputRecord(xr.Dataset(variables, attrs=about))))
    return [
        Section("inputs", "Inputs and their origin", [load]),
        Section("surface", "Surface", waves),
        Section("rubber", "Rubber", rubbers),
    ]


def rubbers_of(data: xr.Dataset) -> list[Rubber]:
    """Return the rubbers of a study; none of a file that does not hold them."""
    return list(map(Rubber.from_dict, json.loads(data.attrs.get("rubber_parameters", "[]"))))


def surface_section(record: InputRecord, waves: SineStack | None = None) -> list[Element]:
    """Return cleaning, profiles, texture and correlation of a surface, and its sine waves."""
    if record.is_empty:
        return []
    elements: list[Element] = []
    if record.has("cleaning_points"):
        elements += cleaning_tables(record)
    if record.has("profile_name"):
        elements += profile_charts(record.data)
    if record.has("texture_of"):
        elements.append(texture_table(record.data))
    if record.has("lag"):
        facts = surface_facts(record, 0 if waves is None else len(waves))
        elements += [*facts, *correlation_charts(record.data)]
    else:
        elements.append(Text("The sine waves are stated in the case; no surface was measured."))
    if waves is not None:
        elements.append(waves_table(waves.wavelength, waves.amplitude))
    return elements


def rubber_section(record: InputRecord, moving: xr.Dataset | None = None) -> list[Element]:
    """Return facts, moduli with their fit and Prony series of a rubber.

    `moving` is a prediction of the chain in motion, whose waves are marked.
    """
    if not record.has("equilibrium_modulus_Pa"):
        return []
    elements: list[Element] = [rubber_facts(record), *rubber_charts(record.data, moving)]
    if "term_modulus" in record.data:
        times, moduli = record.data["term_relaxation_time"], record.data["term_modulus"]
        elements.append(prony_table(times.values, moduli.values))
    return elements
