"""A case for measured files: sorted by their content, read, proposed, written with reasons.

What was taken for granted is listed as doubts, the weightiest first.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gripscale.case import Case
from gripscale.case_file.keys import SCHEMA_LINE, sections, write_schema
from gripscale.case_file.prepare import read_case
from gripscale.case_file.proposals import (
    BY_A_FACTOR,
    TENS_OF_PERCENT,
    UNITS_OF_SURFACE,
    Proposal,
    assumption,
    conditions_proposal,
    holds_moduli,
    open_rubber,
    open_surface,
    reading_keys,
    rubber_proposal,
    surface_proposal,
)
from gripscale.case_file.read import read_case_file
from gripscale.case_file.rubber_tables import NAMED_RUBBERS
from gripscale.case_file.schema import toml_text
from gripscale.core import CaseKey, ExtrapolationError, FileError, GripscaleError, InputError, Words
from gripscale.core.finding import Finding, ranked
from gripscale.core.units import si_value
from gripscale.io.folders import make_folder, path_between, write_text
from gripscale.io.text_table import files_read_once
from gripscale.rubber import read_shift_table
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.sweeps import holds_sweeps

# What is taken where the caller states nothing.
_LOAD = {"pressure": "3 bar", "speed": "1 m/s", "footprint": "100 mm"}
_HEAD = f"""{SCHEMA_LINE}\
# Written by `gripscale new`. Quantities are texts with their unit; paths start at this file.
# `gripscale keys` lists every key with its default and meaning.
"""
_WIDTH = 98
_COMMENT: dict[str, Any] = {
    "initial_indent": "# ",
    "subsequent_indent": "# ",
    "break_long_words": False,
    "break_on_hyphens": False,
}


_WITHOUT_END = (
    "the rubber is taken to have no end; --thickness states where it ends on a rigid base: 8 mm of "
    "a new tread, 2 mm of a worn one, 5 mm of a sole"
)


@dataclass(frozen=True)
class NewCase:
    """A case that was written, and what is doubtful about it."""

    path: Path
    findings: Sequence[Finding]
    """What was taken for granted, the most important first."""
    skipped: tuple[Path, ...] = ()
    """Files of a folder that hold neither a surface nor moduli."""


@files_read_once()
def new_case(files: Sequence[str | Path], path: str | Path, **options: Any) -> NewCase:
    """Write a case for measured files, found as by `propose` with its options, to `path`.

    Its results go to the folder `results`, or to `results-NAME` of a case with another name than
    case.toml. Raises `InputError` and `FileError` as `propose` does, where `path` exists, and where
    nothing states whether moduli are E or G: no number tells.
    """
    target = Path(path)
    if target.exists():
        raise FileError(f"{target} is there already and is not overwritten; give another name")
    tables, skipped = propose(files, target.parent, **options)
    if "modulus" in tables["rubber"].keys.keys() - (options.get("layout") or {}).keys():
        words = " must be given, E for Young's moduli or G for shear moduli, a third of them: the "
        key, file = CaseKey("modulus"), tables["rubber"].keys["file"]
        raise InputError(Words(f"{file}: ", key, words, "titles do not tell"), missing="modulus")
    make_folder(target.parent)
    results = "results" if target.stem == "case" else f"results-{target.stem}"
    write_text(target, case_text(tables, results=results))
    try:
        of_inputs = [*findings_of_inputs(read_case(read_case_file(target)))]
    except GripscaleError:
        target.unlink()
        raise
    write_text(target, case_text(tables, of_inputs, results))
    write_schema(_HEAD, target.parent)
    return NewCase(target, ranked_findings(tables, of_inputs), skipped)


def propose(
    files: Sequence[str | Path],
    directory: Path,
    *,
    load: Mapping[str, str | None] | None = None,
    temperature: str | None = None,
    step: str | list[str] | None = None,
    shift: Mapping[str, Any] | None = None,
    layout: Mapping[str, Any] | None = None,
    thickness: str | None = None,
    filled: bool | None = None,
    interface: str | None = None,
    surface: Mapping[str, Any] | None = None,
) -> tuple[dict[str, Proposal], tuple[Path, ...]]:
    """Return the tables of a case in a directory for measured files, and the files without use.

    Raises `InputError` or `FileError` if the files hold no surface or no moduli, or cannot be read.

    Parameters
    ----------
    files : sequence of path-like
        Profiles or a map, and a master curve or sweeps, in any order, or folders of them; in place
        of moduli the name of a rubber of `NAMED_RUBBERS`.
    directory : Path
        Where the case file will be.
    load : mapping, optional
        `pressure`, `speed` and `footprint` as in a case; 3 bar, 1 m/s and 100 mm by default.
    temperature : str, optional
        Of the rubber before the contact, such as "20 C".
    step : str or list, optional
        Distance between points where a file has none, such as "0.1 mm".
    shift : mapping, optional
        Time-temperature shift of the rubber, as in a case: kind, c1 and c2.
    layout : mapping, optional
        What the file of the rubber does not state: keys of [rubber], such as columns or
        reference_temperature.
    surface : mapping, optional
        What the files of the surface do not state: keys of [surface], such as z_unit or channel.
    thickness : str, optional
        Of the rubber on its base, such as "8 mm"; without it the rubber has no end, with a doubt.
    filled : bool, optional
        Whether the rubber is filled; without it the answer has both numbers, with a doubt.
    interface : str, optional
        "dry" adds the interface of a dry road to the friction of the hysteresis.
    """
    kelvin = si_value("temperature", temperature, "K")
    layout, of_surface = dict(layout or {}), dict(surface or {})
    reference = layout.pop("reference_temperature", None)
    named = [str(name) for name in files if str(name) in NAMED_RUBBERS and not Path(name).exists()]
    paths = [Path(file) for file in files if str(file) not in named]
    surfaces, rubbers, shifts, skipped = _sorted(paths, step, layout, named, of_surface)
    names = {file: path_between(directory, file) for file in (*surfaces, *rubbers, *shifts)}
    of_load = Proposal()
    for key, default in _LOAD.items():
        if load and load.get(key) is not None:
            of_load.add(key, load[key])
        else:
            effect = TENS_OF_PERCENT if key == "footprint" else BY_A_FACTOR
            of_load.add(key, default, f"not stated; --{key} states another", effect)
    road = surface_proposal(
        surfaces, [names[file] for file in surfaces], step=step, keys=of_surface
    )
    if named:
        rubber = Proposal()
        rubber.add("name", named[0], "known by published parameters")
        if shift is not None:
            rubber.add("shift", dict(shift), "as stated")
    else:
        measurement = {"temperature": kelvin, "shift": shift, "layout": layout}
        measurement["reference"] = reference
        rubber = _one_rubber(rubbers, [names[file] for file in rubbers], **measurement)
    if shift is None:
        for name in (names[file] for file in shifts):
            cure = f'shift = "{name}" in [rubber] takes them'
            unused = f"{name} holds shift factors and is not used: {cure}"
            rubber.findings.append(assumption(BY_A_FACTOR, unused))
    if thickness is None:
        rubber.findings.append(assumption(TENS_OF_PERCENT, _WITHOUT_END))
    else:
        rubber.add("thickness", thickness)
    if filled is not None:
        rubber.add("filled", filled, "as stated")
    conditions = conditions_proposal(rubber, rubbers, kelvin)
    if interface is not None:
        conditions.add("interface", interface, "as stated")
    tables = {"surface": road, "rubber": rubber, "load": of_load, "conditions": conditions}
    return tables, skipped


def ranked_findings(
    tables: Mapping[str, Proposal], further: Iterable[Finding] = ()
) -> Sequence[Finding]:
    """Return the findings of proposals and further ones, the most important first."""
    proposed = (finding for table in tables.values() for finding in table.findings)
    return ranked(dict.fromkeys([*proposed, *further]))


def _sorted(
    files: Sequence[Path],
    step: str | list[str] | None,
    layout: Mapping[str, Any],
    named: Sequence[str] = (),
    of_surface: Mapping[str, Any] = MappingProxyType({}),
) -> tuple[list[Path], list[Path], list[Path], tuple[Path, ...]]:
    """Return the files of surfaces, of moduli and of shifts, and those of folders without use.

    Where a rubber is `named` there are no moduli.
    """
    surfaces: list[Path] = []
    rubbers: list[Path] = []
    shifts: list[Path] = []
    skipped: list[Path] = []
    refused: list[tuple[Path, GripscaleError]] = []
    for file in files:
        for path in sorted(file.glob("[!.]*")) if file.is_dir() else [file]:
            if holds_moduli(path, FileLayout(**layout)):
                rubbers.append(path)
                continue
            with suppress(GripscaleError):
                read_shift_table(path)
                shifts.append(path)
                continue
            try:
                open_surface(path, step, UNITS_OF_SURFACE, **reading_keys(of_surface))
            except GripscaleError as error:
                if file.is_dir():
                    skipped.append(path)
                else:
                    refused.append((path, error))
            else:
                surfaces.append(path)
    if refused:
        path, refusal = refused[0]
        if surfaces and not rubbers:
            open_rubber([path], layout)  # raises why there are no moduli in it
        raise refusal
    every = ", ".join([*(path.name for path in (*surfaces, *rubbers, *shifts, *skipped)), *named])
    if named and (rubbers or named[1:]):
        raise InputError(f"expected one rubber, measured or known by name; got {every}")
    if not surfaces or not (rubbers or named):
        moduli = f"moduli (frequency, storage and loss) or a name ({', '.join(NAMED_RUBBERS)})"
        what = moduli if surfaces else "a surface"
        raise InputError(f"expected a file with {what}, too; got {every or 'no file'}")
    return surfaces, rubbers, shifts, tuple(skipped)


def _one_rubber(files: list[Path], names: list[str], **options: Any) -> Proposal:
    """Return the proposal for files of one rubber; name those of a folder that do not fit."""
    try:
        return rubber_proposal(files, names, **options)
    except GripscaleError as error:
        sweeps = [file.name for file in files if holds_sweeps(file)]
        others = [file.name for file in files if file.name not in sweeps]
        if not sweeps or not others:
            raise
        raise InputError(
            f"{' and '.join(others)} cannot be joined with the sweeps of {' and '.join(sweeps)}; "
            "name the file of one of them in place of the folder"
        ) from error


def case_text(
    tables: Mapping[str, Proposal], further: Iterable[Finding] = (), results: str = "results"
) -> str:
    """Return the text of a case: its doubts, and each key with why it has its value or its meaning.

    The findings are those of the proposals and `further` ones; `results` is the folder of results.
    """
    parts = [_HEAD]
    findings = ranked_findings(tables, further)
    if findings:
        parts += ["# Doubts, the most important first:"]
        for number, finding in enumerate(findings, start=1):
            parts += textwrap.wrap(f"{number}. {finding}", _WIDTH, **_COMMENT)
        parts += [""]
    meanings = {
        (section.name, key.name): key.meaning for section in sections() for key in section.keys
    }
    for name, proposal in tables.items():
        if not proposal.keys:
            continue
        parts.append(f"[{name}]")
        for key, value in proposal.keys.items():
            reason = proposal.reasons.get(key) or meanings[name, key].rstrip(".")
            parts += [*textwrap.wrap(reason, _WIDTH, **_COMMENT), f"{key} = {toml_text(value)}"]
        parts.append("")
    return "\n".join([*parts, "[output]", f"folder = {toml_text(results)}", ""])


def findings_of_inputs(case: Case) -> Iterator[Finding]:
    """Yield what reading and fitting the files of a case puts in doubt."""
    yield from case.findings()
    joint = case.measured_rubber.superposition
    for text in () if joint is None else joint.findings:
        yield assumption(TENS_OF_PERCENT, f"Rubber: {text}.")
    try:
        wavelengths = case.surface.sines.wavelength
        require_measured(case.rubber_before, wavelengths, case.load.speed)
    except ExtrapolationError as error:
        yield assumption(BY_A_FACTOR, str(error))
