"""What a case may say of measured files, proposed from their content, and what is doubtful of it.

A file that states everything needs no proposal. What it does not state is proposed where the
numbers tell (a unit with which heights are those of a texture, moduli those of a rubber), and each
proposal is a doubt with a weight: how far the answer may be off if it is wrong.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import numpy as np

from gripscale import rubber as rubbers
from gripscale.case_file.read import validate
from gripscale.case_file.tables import SurfaceTable
from gripscale.core import CaseKey, Finding, GripscaleError, InputError, Severity, Words
from gripscale.core.units import ZERO_CELSIUS, in_mm
from gripscale.io.cells import SEPARATORS, cells_of, is_comment
from gripscale.io.text_table import TextTable, is_excel, read_lines
from gripscale.rubber.blocks import read_blocks
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.material import BULK_MODULUS, least_bulk_modulus
from gripscale.rubber.prony import holds_prony_table, largest_modulus, read_prony_table
from gripscale.rubber.softening import softening_of_sweeps
from gripscale.rubber.strain_sweeps import StrainSweep, read_strain_sweeps
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, holds_sweeps, read_shift_of_sweeps
from gripscale.surface import HeightMap, Profile, read_map, read_profile
from gripscale.surface.low_pass import POINTS_IN_CUT_OFF
from gripscale.surface.plausibility import has_likely_units, road_between, support_plates
from gripscale.surface.read import POINT_SUFFIXES, is_text_surface
from gripscale.surface.read_spectrum import holds_spectrum

_Measurement = TypeVar("_Measurement")
_STATED = "as stated"
_SCALES = 8  # waves of a surface that states none, as in `gripscale fit-surface`
_CUT_OFF = "instrument"  # where its roughness ends: where the measurement does
_ENOUGH_POINTS = 2**18  # of a line: its contact takes minutes with more
ROOM = 293.15  # temperature taken where neither a file nor the caller states one [K]
# Effects of what is taken for granted on the friction [-]: tens of per cent, a factor, or it is the
# friction of another road or rubber.
TENS_OF_PERCENT, BY_A_FACTOR, OF_ANOTHER_CASE = 0.1, 1.0, math.inf


def assumption(effect: float, sentence: str) -> Finding:
    """Return the finding that something is taken for granted, with its effect on the friction."""
    severity = Severity.DOUBT if effect == OF_ANOTHER_CASE else Severity.WARNING
    return Finding(severity, sentence, friction=effect)


@dataclass
class Proposal:
    """Keys of a table of a case, why some have their value, and what is taken for granted."""

    keys: dict[str, Any] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)

    def add(self, key: str, value: Any, reason: str = "", effect: float | None = None) -> None:
        """Propose a value; with an `effect` on the friction its reason is an assumption."""
        self.keys[key] = value
        if reason:
            self.reasons[key] = reason
        if effect is not None:
            sentence = f"{key} = {value!r}".replace("'", '"') + f": {reason}"
            self.findings.append(assumption(effect, sentence))
            if effect == OF_ANOTHER_CASE:  # the case carries it, so that its answers say it
                self.keys["assumed"] = [*self.keys.get("assumed", []), sentence]


LENGTHS = ("mm", "um", "m")
_SHORTEST, _LONGEST = 1e-3, 20.0  # lengths of profiles whose files state no unit [m]
UNITS_OF_SURFACE = {"x_unit": LENGTHS[0], "z_unit": LENGTHS[0]}
# What is tried first where a file does not state it.
UNITS_OF_RUBBER = {
    "frequency_unit": "Hz",
    "modulus_unit": "MPa",
    "modulus": "E",
    "temperature_unit": "C",
}


def read_with(
    read: Callable[..., _Measurement], path: Any, defaults: Mapping[str, str], **options: Any
) -> tuple[_Measurement, dict[str, str]]:
    """Return what a file holds, and the keys without which it cannot be read, by default."""
    asked: dict[str, str] = {}
    while True:
        try:
            return read(path, **options, **asked), asked
        except GripscaleError as error:
            if error.missing not in defaults.keys() - asked:
                raise
            asked[error.missing] = defaults[error.missing]


def surface_proposal(
    paths: list[Path],
    names: list[str],
    *,
    step: str | list[str] | None = None,
    keys: Mapping[str, Any] = MappingProxyType({}),
) -> Proposal:
    """Return the table [surface] for profiles, or for one map.

    `names` are those of the files in the case; `step` is the distance between points, where a file
    has none, and `keys` what else is stated in [surface]. Raises `FileError` and
    `InputError` as reading does.
    """
    proposal = Proposal()
    if holds_spectrum(paths[0]):
        proposal.keys = {"spectrum": names[0], **keys, "scales": _SCALES, "cut_off": _CUT_OFF}
        return proposal
    reading = reading_keys(keys)
    options: dict[str, Any] = _step_option(step) | reading
    surface, missing = open_surface(paths[0], step, UNITS_OF_SURFACE, **reading)
    if isinstance(surface, HeightMap):
        if len(paths) > 1:
            raise InputError(f"expected one map, or profiles; got {paths[0]} and {paths[1]}")
        proposal.add("map", names[0])
        sizes = " and ".join(in_mm(length, 4) for length in surface.length)
        words = f"the sliding direction; the map is {sizes} long in x and y"
        proposal.add("direction", "x", words, TENS_OF_PERCENT)
    else:
        proposal.add("files", names)
    if step is not None:
        proposal.add("step", step)
    for key, value in keys.items():
        proposal.add(key, value, _STATED)
    read = read_map if isinstance(surface, HeightMap) else read_profile
    tracks = [keys.get("channel")]
    if (channel := missing.pop("channel", None)) is not None:
        tracks = channel if isinstance(channel, list) else [channel]
        several = isinstance(channel, list)
        words = "each column of heights is a profile" if several else "the first of the channels"
        effect = TENS_OF_PERCENT if several else OF_ANOTHER_CASE
        proposal.add("channel", channel, f"{words}; --channel states another", effect)
    options |= {} if tracks == [None] else {"channel": tracks[0]}
    units: dict[str, Any] = {}
    # units that the file does not state with which its heights are those of a texture, if any are
    for choice in product(LENGTHS, repeat=len(missing)) if missing else ():
        trial: dict[str, Any] = dict(zip(missing, choice, strict=True))
        measured = read(paths[0], **options, **trial)
        middle = measured.z.shape[-1] // 2
        line = measured.line(middle) if isinstance(measured, HeightMap) else measured
        units = units or trial
        if _SHORTEST <= line.length <= _LONGEST and has_likely_units(line):
            units = trial
            break
    for key, unit in units.items():
        words = f"{paths[0].name} names no unit; with this one the heights are a texture"
        proposal.add(key, unit, words, OF_ANOTHER_CASE)
    if isinstance(surface, Profile) and "crop" not in keys:
        profiles = [
            read_profile(path, **options | units | {"channel": track})
            for path in paths
            for track in tracks
        ]
        ends = [part for profile in profiles if (part := road_between(profile)) is not None]
        if ends:
            first, last = max(part[0] for part in ends), min(part[1] for part in ends)
            supports = [
                f"{profile.name} {' and '.join(map(str, plates))}"
                for profile in profiles
                if (plates := support_plates(profile))
            ]
            words = f"between plates or supports: {'; '.join(supports)}"
            proposal.add("crop", [in_mm(first), in_mm(last)], words, BY_A_FACTOR)
    proposal.add("scales", _SCALES, "sine waves of the chain")
    words = "roughness below what the measurement carries is left out; it may add friction"
    cut_off = _CUT_OFF
    if isinstance(surface, Profile) and len(surface) > _ENOUGH_POINTS:
        cut_off = in_mm(POINTS_IN_CUT_OFF * surface.length / _ENOUGH_POINTS, 2)
        words = f"the contact of all {len(surface)} points takes too long; shorter {words}"
    proposal.add("cut_off", cut_off, words, TENS_OF_PERCENT)
    return proposal


def reading_keys(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of the stated keys of [surface] with which its files are read."""
    names = ("x_unit", "z_unit", "channel", "z_axis")
    return {name: keys[name] for name in names if name in keys}


def _step_option(step: str | list[str] | None) -> dict[str, Any]:
    if step is None:
        return {}
    table = validate(SurfaceTable, {"map": "map", "scales": 1, "step": step}, "step")
    return {"step": tuple(table.step) if isinstance(table.step, list) else table.step}


def open_surface(
    path: Path,
    step: str | list[str] | None = None,
    defaults: Mapping[str, str] = MappingProxyType({}),
    **reading: Any,
) -> tuple[Profile | HeightMap, dict[str, Any]]:
    """Return the profile or the map of a file, and those of the `defaults` that it needs.

    With `defaults` the first of several channels is read, and of a text all are named, as tracks.
    `reading` are further arguments of the readers. Raises `FileError` and `InputError` as
    reading does.
    """
    options = _step_option(step) | reading
    # an instrument's map has profiles, too; a text with a distance and a height is no map
    lines = is_text_surface(path) and path.suffix.lower() not in POINT_SUFFIXES
    readers = (read_profile, read_map) if lines else (read_map, read_profile)
    refusals = []
    for read in readers:
        try:
            return read_with(read, path, defaults, **options)
        except GripscaleError as error:
            refusals.append(error)
            if error.choices and defaults:
                channel = {"channel": error.choices[0]}
                surface: Any
                surface, missing = read_with(read, path, defaults, **options, **channel)
                if lines and isinstance(surface, Profile):
                    return surface, {**missing, "channel": list(error.choices)}
                return surface, {**missing, **channel}
    # a reader that only misses a key is the right one, and one that wants less stated the wrong one
    raise min(refusals, key=lambda error: (not error.missing, isinstance(error, InputError)))


def rubber_proposal(
    paths: list[Path],
    names: list[str],
    *,
    temperature: float | None = None,
    shift: Mapping[str, Any] | str | None = None,
    layout: Mapping[str, Any] = MappingProxyType({}),
    reference: str | None = None,
    reason: str = _STATED,
) -> Proposal:
    """Return the table [rubber] for a master curve or sweeps, to be used at a temperature [K].

    `names` are those of the files in the case, the `layout` what is stated of them, `reference` the
    temperature that a curve holds for or sweeps are shifted to, and `reason` why. Raises
    `FileError` and `InputError` as reading does.
    """
    proposal, settings = Proposal(), dict(layout)
    proposal.add("file", names[0] if len(names) == 1 else names)
    for key, value in settings.items():
        proposal.add(key, value, _STATED)
    if len(paths) == 1 and holds_prony_table(paths[0]):
        read_prony_table(paths[0], **settings)
        _add_reference(proposal, None, temperature, reference, reason)
        add_shift(proposal, shift)
        return proposal
    measured, asked = open_rubber(paths, settings)
    for key in asked:
        settings[key], words = _likely(key, paths, settings | asked)
        reason = f"{paths[0].name} does not state it; {words}"
        proposal.add(key, settings[key], reason, OF_ANOTHER_CASE)
    if asked:
        measured, _ = open_rubber(paths, settings)
    _add_reference(proposal, measured, temperature, reference, reason)
    if isinstance(measured, rubbers.Sweeps) and not measured.is_ramp:
        try:
            replace(measured, tolerance=TEMPERATURE_TOLERANCE)
        except InputError:
            words = "the temperatures have no gaps: moduli are interpolated at multiples of it"
            proposal.add("temperature_step", NOMINAL_STEP, words, TENS_OF_PERCENT)
    add_shift(proposal, shift)
    stiffest = float(measured.storage.max())
    if stiffest > _NO_SOLID:
        giga = f"{stiffest / 1e9:.3g} GPa"
        words = f": the largest E' is {giga}, which no solid has; numbers look like Pa: state it"
        raise InputError(Words(f"{paths[0]}: ", CaseKey("modulus_unit"), words))
    try:
        largest_modulus(stiffest, BULK_MODULUS)
    except InputError:
        least = math.ceil(least_bulk_modulus(stiffest) / 1e8) / 10.0
        words = (
            f"for Poisson's ratio of 0.3 at the largest E', {stiffest / 1e9:.3g} GPa, which no "
            "rubber has: is the unit of the moduli right? Leave bulk_modulus out once it is mended "
            "by modulus_unit"
        )
        proposal.add("bulk_modulus", f"{least:g} GPa", words, OF_ANOTHER_CASE)
    else:
        words = "assumed: a DMA measurement does not give it"
        proposal.add("bulk_modulus", f"{BULK_MODULUS / 1e9:g} GPa", words)
    return proposal


def open_rubber(
    paths: list[Path], layout: Mapping[str, Any]
) -> tuple[rubbers.MasterCurve | rubbers.Sweeps, dict[str, str]]:
    """Return sweeps or a master curve, and the keys of the layout that nothing states."""
    if len(paths) > 1 or holds_sweeps(paths[0], FileLayout(**layout)):
        return read_with(rubbers.read_sweeps, paths, UNITS_OF_RUBBER, tolerance=0.0, **layout)
    return read_with(rubbers.read_master_curve, paths[0], UNITS_OF_RUBBER, **layout)


_UNITS_OF_STRAIN = {"amplitude": "single", "strain_unit": "%", **UNITS_OF_RUBBER}
_LEAST_STRAIN = 5e-3  # largest strain of sweeps below which the numbers are no per cent
_NO_SOLID = 1.2e12  # Young's modulus of diamond [Pa]
_SOFTEST, _STIFFEST = 2e4, 1e8  # between these lies the smallest modulus of a measured rubber [Pa]
_HOTTEST = ZERO_CELSIUS + 180.0  # mean temperature that no sweeps have [K]


def open_strain_sweeps(paths: list[Path]) -> tuple[list[StrainSweep], dict[str, str]]:
    """Return strain sweeps that give a law of softening, and the keys that nothing states."""
    read: Callable[..., list[StrainSweep]] = read_strain_sweeps
    sweeps, asked = read_with(read, paths, _UNITS_OF_STRAIN)
    if "strain_unit" in asked and max(sweep.strain[-1] for sweep in sweeps) < _LEAST_STRAIN:
        asked["strain_unit"] = "1"
        sweeps = read(paths, **asked)
    softening_of_sweeps(sweeps)
    return sweeps, asked


def open_shift(path: Path) -> tuple[rubbers.ShiftTable, dict[str, str]]:
    """Return shift factors, and the unit of their temperatures if nothing states it."""
    table, asked = read_with(rubbers.read_shift_table, path, UNITS_OF_RUBBER)
    if asked and table.temperature.mean() > _HOTTEST:
        asked = {"temperature_unit": "K"}
        table = rubbers.read_shift_table(path, **asked)
    return table, asked


def add_softening(proposal: Proposal, paths: list[Path], names: list[str]) -> None:
    """Add the softening of strain sweeps to the table [conditions]."""
    _, asked = open_strain_sweeps(paths)
    softening = {"kind": "table", "files": names, **asked}
    proposal.add("softening", softening, "measured strain sweeps")
    for key in asked.keys() - {"modulus", "modulus_unit"}:  # the law is one of ratios
        effect = TENS_OF_PERCENT if key == "amplitude" else BY_A_FACTOR
        text = f'softening, {key} = "{asked[key]}": {paths[0].name} does not state it'
        proposal.findings.append(assumption(effect, text))


def _likely(key: str, paths: list[Path], layout: Mapping[str, Any]) -> tuple[str, str]:
    if key == "frequency_unit":
        return "Hz", "rad/s would move the curve by 0.8 decades"
    if key == "modulus":
        return "E", "shear moduli (G) would be a third"

    def measured(unit: str) -> Any:
        return open_rubber(paths, {**layout, key: unit})[0]

    if key == "temperature_unit":
        sweeps = measured("C")
        warm = isinstance(sweeps, rubbers.Sweeps) and float(sweeps.temperature.mean()) > _HOTTEST
        return ("K" if warm else "C"), "so the temperatures are those of a laboratory"
    units = ("MPa", "Pa", "kPa", "GPa")
    likely = (u for u in units if _SOFTEST < float(measured(u).storage.min()) < _STIFFEST)
    return next(likely, units[0]), "so the moduli are those of a rubber"


def _add_reference(
    proposal: Proposal,
    measured: rubbers.MasterCurve | rubbers.Sweeps | None,
    temperature: float | None,
    reference_text: str | None,
    reason: str,
) -> None:
    curve = isinstance(measured, rubbers.MasterCurve) and measured.reference_temperature is not None
    if reference_text is not None and not (curve and reason != _STATED):
        proposal.add("reference_temperature", reference_text, reason)
        return
    target = ROOM if temperature is None else temperature
    if not isinstance(measured, rubbers.Sweeps):
        if measured is None or measured.reference_temperature is None:
            words = "the file states no temperature; the moduli are assumed to be those at this one"
            if temperature is None:
                words += ", as is the contact; --temperature states another"
            proposal.add("reference_temperature", celsius_text(target), words, OF_ANOTHER_CASE)
        return
    kelvin = measured.temperature
    if np.ptp(kelvin) <= _ONE_SWEEP:
        return
    reference = float(np.clip(target, kelvin.min(), kelvin.max()))
    low, high = (celsius_text(value) for value in (kelvin.min(), kelvin.max()))
    words = f"sweeps from {low} to {high} are shifted to it"
    effect = None if reference == target or temperature is None else BY_A_FACTOR
    proposal.add("reference_temperature", celsius_text(reference), words, effect)
    if temperature is None:
        text = f"no temperature of the contact stated: {reference - ZERO_CELSIUS:.4g} °C assumed"
        proposal.findings.append(assumption(BY_A_FACTOR, f"{text}; --temperature states another"))


def add_shift(proposal: Proposal, shift: Mapping[str, Any] | str | None) -> None:
    """Add a shift, the name of a table or a law with its constants, to the table [rubber]."""
    if isinstance(shift, str):
        proposal.add("shift", shift, "the measured shift factors")
    elif shift is not None:
        proposal.add("shift", dict(shift), _STATED)


NOMINAL_STEP = "5 K"  # step of nominal temperatures of ramps at several frequencies
_ONE_SWEEP = 3.0  # span of temperatures of one sweep [K]


def celsius_text(kelvin: float) -> str:
    """Return a temperature [K] as a case states it, such as `20 C`."""
    return f"{kelvin - ZERO_CELSIUS:.4g} C"


def has_shift(paths: list[Path], proposal: Proposal) -> bool:
    """Return whether the rubber of a proposal can be had at other temperatures."""
    if "shift" in proposal.keys or len(paths) != 1:
        return "shift" in proposal.keys or bool(paths)
    layout = {k: v for k, v in proposal.keys.items() if k in FileLayout.__dataclass_fields__}
    if not holds_sweeps(paths[0], FileLayout(**layout)):
        return False
    sweeps = rubbers.read_sweeps(paths, tolerance=0.0, **layout)
    several = float(np.ptp(sweeps.temperature)) > _ONE_SWEEP
    return several or read_shift_of_sweeps(paths[0], layout) is not None


ENOUGH_LINES = 400  # lines that tell what a file holds


def holds_moduli(path: Path, layout: FileLayout) -> bool:
    """Return whether a file is one of moduli, by its titles, its numbers or its first line.

    The `layout` may state which columns hold them. Without titles, three columns as of a master
    curve are moduli.
    """
    try:
        if holds_prony_table(path):
            return True
        blocks = read_blocks(path, layout, temperature_unit="C", most=ENOUGH_LINES)
    except GripscaleError:
        return False
    for table in (block.table for block in blocks):
        try:
            if layout.suffices(table):
                return True
        except InputError:  # several titles mean one modulus, or columns are stated of another file
            if layout.columns is None:
                return True
            continue
        if not any(table.names) and len(table.columns) == 3 and not _titled(path, table):
            frequency, *moduli = (table.numbers(at, "a number", missing=True) for at in range(3))
            rising = frequency[0] > 0.0 and bool((np.diff(frequency) > 0.0).all())
            if rising and all(float(np.nanmin(column)) > 0.0 for column in moduli):
                return True
    return False


def _titled(path: Path, table: TextTable) -> bool:
    """Return whether words stand above the columns of a table, which then are of something else."""
    lines = [] if is_excel(path) else read_lines(path)
    above = [text for number, text in lines if number < table.line_numbers[0]][-1:]
    counts = {len(cells_of(text, separator)) for text in above for separator in SEPARATORS[:3]}
    return len(table.columns) in counts and not is_comment(above[0])


def conditions_proposal(rubber: Proposal, paths: list[Path], temperature: float | None) -> Proposal:
    """Return the table [conditions] with a temperature [K], or the doubt that it is not reached."""
    proposal = Proposal()
    if temperature is None and isinstance(rubber.keys.get("shift"), str):
        words = "no temperature of the contact is stated; --temperature states another"
        proposal.add("temperature", celsius_text(ROOM), words, BY_A_FACTOR)
    if temperature is None:
        return proposal
    if has_shift(paths, rubber):
        proposal.add("temperature", celsius_text(temperature), "of the rubber before the contact")
    elif "reference_temperature" not in rubber.keys:
        text = (
            f"the rubber has one temperature and no shift, and cannot be brought to "
            f"{celsius_text(temperature)}: state [rubber] shift and [conditions] temperature"
        )
        proposal.findings.append(assumption(BY_A_FACTOR, text))
    return proposal
