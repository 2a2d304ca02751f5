"""A case for measured files: sorted by their content, read, proposed, written with reasons.

What was taken for granted is listed as doubts, the weightiest first.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gripscale.case import Case
from gripscale.case_file import proposals
from gripscale.case_file.keys import SCHEMA_LINE, sections, write_schema
from gripscale.case_file.kinds import RUBBERS, SURFACES, FileKeys, Taken
from gripscale.case_file.laboratory import Ask, Laboratory, first_choice, laboratory
from gripscale.case_file.prepare import read_case
from gripscale.case_file.proposals import Proposal
from gripscale.case_file.read import read_case_file
from gripscale.case_file.rubber_tables import NAMED_RUBBERS
from gripscale.case_file.schema import toml_text
from gripscale.core import CaseKey, ExtrapolationError, FileError, GripscaleError, InputError, Words
from gripscale.core.finding import Finding, ranked
from gripscale.core.units import plain, si_value
from gripscale.io.folders import make_folder, path_between, write_text
from gripscale.io.text_table import files_read_once
from gripscale.rubber.extrapolation import require_measured

# What is taken where the caller states nothing.
_LOAD = {"pressure": "3 bar", "speed": "1 m/s", "footprint": "100 mm"}
_UNITS_OF_LOAD = {"pressure": ("bar", 1e5), "speed": ("m/s", 1.0)}
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


_IS_FILLED = "Is the rubber filled (carbon black, silica), as every tread is?"
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
    files: tuple[Taken, ...] = ()
    """What each file is taken for."""


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
    tables, taken = propose(files, target.parent, **options)
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
    return NewCase(target, ranked_findings(tables, of_inputs), taken)


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
    kinds: Mapping[str | Path, str] | None = None,
    ask: Ask = first_choice,
) -> tuple[dict[str, Proposal], tuple[Taken, ...]]:
    """Return the tables of a case in a directory, and what each of its files is taken for.

    `files` are measured ones in any order, folders of them, or the name of a rubber among
    `NAMED_RUBBERS`. Quantities are stated as in a case; what is not stated, as the `load` or the
    `thickness`, is assumed with a doubt. `shift`, `layout` and `surface` have keys of
    [rubber] shift, [rubber] and [surface]; `kinds`, of `gripscale.case_file.kinds.NAMES`, go before
    the content of files. `ask` returns one of several answers to a question, by default the first,
    the likeliest. Raises `InputError` or `FileError` if the files hold no surface or no moduli, or
    cannot be read.
    """
    kelvin = si_value("temperature", temperature, "K")
    layout, of_surface = dict(layout or {}), dict(surface or {})
    reference = layout.pop("reference_temperature", None)
    names = [str(name) for name in files if str(name) in NAMED_RUBBERS and not Path(name).exists()]
    measured = [file for file in files if str(file) not in names]
    lab = laboratory(measured, FileKeys(step, of_surface, layout), kinds or {}, ask)
    _require_both(lab, names)
    inside = {file.path: path_between(directory, file.path) for file in lab.files}
    friction = lab.of("friction")
    if kelvin is None and friction:
        kelvin = friction[0].measured.middle("temperature")
    paths = [file.path for file in lab.of(*SURFACES)]
    road = proposals.surface_proposal(
        paths, [inside[path] for path in paths], step=step, keys=of_surface
    )
    rubbers, shifts = [file.path for file in lab.of(*RUBBERS)], lab.of("shift")
    if names:
        rubber = Proposal()
        rubber.add("name", names[0], "known by published parameters")
        proposals.add_shift(rubber, shift)
    else:
        units: Mapping[str, str] = {}
        options: dict[str, Any] = {"shift": shift, "reference": reference, "layout": layout}
        if shifts and shift is None and lab.of(*RUBBERS)[0].kind != "sweeps":
            options["shift"] = inside[shifts[0].path]
            unity = shifts[0].measured.unity
            if reference is None and unity is not None:
                reason = f"a_T of {shifts[0].path.name} is 1 there"
                options |= {"reference": proposals.celsius_text(unity), "reason": reason}
            units, shifts = shifts[0].missing, []
        files_inside = [inside[path] for path in rubbers]
        rubber = proposals.rubber_proposal(rubbers, files_inside, temperature=kelvin, **options)
        for key, unit in units.items():
            rubber.add(key, unit, "the shift factors do not state it", proposals.OF_ANOTHER_CASE)
    for file in () if shift is not None else shifts:
        cure = f'shift = "{inside[file.path]}" in [rubber] takes them'
        unused = f"{inside[file.path]} holds shift factors and is not used: {cure}"
        rubber.findings.append(proposals.assumption(proposals.BY_A_FACTOR, unused))
        lab.leave_out([file], "the sweeps find their own")
    if thickness is None:
        rubber.findings.append(proposals.assumption(proposals.TENS_OF_PERCENT, _WITHOUT_END))
    else:
        rubber.add("thickness", thickness)
    strain = [file.path for file in lab.of("strain-sweep")]
    if filled is None and not strain and not names:
        filled = {"yes": True, "no": False}.get(ask(_IS_FILLED, ("unknown", "yes", "no")))
    if filled is not None:
        rubber.add("filled", filled, "as stated")
    conditions = proposals.conditions_proposal(rubber, rubbers, kelvin)
    if strain:
        proposals.add_softening(conditions, strain, [inside[path] for path in strain])
    if interface is not None:
        conditions.add("interface", interface, "as stated")
    rubber.findings += lab.findings
    tables = {"surface": road, "rubber": rubber, "load": _load(load or {}, friction)}
    tables |= {"conditions": conditions, "measured": Proposal()}
    if friction:
        words = "drawn over the answer, and what `gripscale calibrate` fits the area term to"
        tables["measured"].add("friction", inside[friction[0].path], words)
    return tables, tuple(lab.files)


def _require_both(lab: Laboratory, named: Sequence[str]) -> None:
    """Raise `InputError` unless there is a surface, and a rubber that is measured or `named`."""
    surfaces, rubbers = lab.of(*SURFACES), lab.of(*RUBBERS)
    every = ", ".join([*(file.path.name for file in lab.files), *named])
    if named and (rubbers or named[1:]):
        raise InputError(f"expected one rubber, measured or known by name; got {every}")
    if not surfaces or not (rubbers or named):
        moduli = f"moduli (frequency, storage and loss) or a name ({', '.join(NAMED_RUBBERS)})"
        what = moduli if surfaces else "a surface"
        raise InputError(f"expected a file with {what}, too; got {every or 'no file'}")


def _load(load: Mapping[str, str | None], friction: Sequence[Taken]) -> Proposal:
    """Return the table [load]: as stated, else as friction was measured, else usual values."""
    proposal = Proposal()
    for key, default in _LOAD.items():
        measured = friction and key in _UNITS_OF_LOAD and friction[0].measured.middle(key)
        if load.get(key) is not None:
            proposal.add(key, load[key])
        elif measured:
            unit, size = _UNITS_OF_LOAD[key]
            words = f"the middle one of {friction[0].path.name}; --{key} states another"
            proposal.add(
                key, f"{plain(measured / size, 4)} {unit}", words, proposals.TENS_OF_PERCENT
            )
        else:
            effect = proposals.TENS_OF_PERCENT if key == "footprint" else proposals.BY_A_FACTOR
            proposal.add(key, default, f"not stated; --{key} states another", effect)
    return proposal


def ranked_findings(
    tables: Mapping[str, Proposal], further: Iterable[Finding] = ()
) -> Sequence[Finding]:
    """Return the findings of proposals and further ones, the most important first."""
    proposed = (finding for table in tables.values() for finding in table.findings)
    return ranked(dict.fromkeys([*proposed, *further]))


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
        yield proposals.assumption(proposals.TENS_OF_PERCENT, f"Rubber: {text}.")
    try:
        wavelengths = case.surface.sines.wavelength
        require_measured(case.rubber_before, wavelengths, case.load.speed)
    except ExtrapolationError as error:
        yield proposals.assumption(proposals.BY_A_FACTOR, str(error))
