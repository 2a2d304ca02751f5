"""A rubber as the material of a finite element program: Abaqus, Ansys MAPDL or FEBio.

The equations of the programs, and what becomes of a rubber in each, are in docs/export.md. Sources:
Abaqus Keywords Reference Guide (2016) and Analysis User's Guide, sections 22.5.1 and 22.7.1; Ansys
Mechanical APDL, Material Reference, "Hyperelasticity" and "Viscoelasticity"; FEBio User Manual 4,
"Uncoupled Viscoelastic Materials" and "Uncoupled Solid Mixture".
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from inspect import signature
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

from gripscale.core import InputError, checks
from gripscale.export import rubber as parts
from gripscale.export.rubber import ProgramFile, Units, coefficients, comment, prony_shares
from gripscale.io.folders import write_text
from gripscale.io.text_table import file_path
from gripscale.rubber import Rubber

# Of each strain energy the form in Abaqus, option and number of TB,HYPER, order of the C_ij and
# number of the D_k; D_2 and on are zero, which leaves their terms out.
FORMS: dict[str, tuple[str, str, int, tuple[tuple[int, int], ...], int]] = {
    "neo_hookean": ("NEO HOOKE", "NEO", 2, ((1, 0),), 1),
    "mooney_rivlin": ("MOONEY-RIVLIN", "MOONEY", 2, ((1, 0), (0, 1)), 1),
    "yeoh": ("YEOH", "YEOH", 3, ((1, 0), (2, 0), (3, 0)), 3),
    "isihara": ("POLYNOMIAL, N=2", "POLY", 2, ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)), 2),
}


def _abaqus(
    rubber: Rubber,
    name: str | None = None,
    modulus_unit: str = "Pa",
    temperature_unit: str = "K",
) -> ProgramFile:
    """Return an Abaqus material, to be included in an input file."""
    units = Units(modulus_unit, temperature_unit)
    about = "MODULI=LONG TERM: the constants of *HYPERELASTIC are those of the relaxed rubber."
    remarks, law = parts.with_one_series(rubber, units, "Abaqus", "hybrid elements", about)
    c = coefficients(rubber)
    form, _, _, orders, compliances = FORMS[rubber.strain_energy.kind]
    constants = [units.stress(c.get(powers, 0.0)) for powers in orders]
    constants += [2.0 / units.stress(rubber.bulk_modulus), *[0.0] * (compliances - 1)]
    moduli = ", MODULI=LONG TERM" if len(rubber.moduli) else ""
    lines = [
        *comment(remarks, "**"),
        f"*MATERIAL, NAME={parts.label(rubber, name)}",
        f"*HYPERELASTIC, {form}{moduli}",
        _row(constants),
    ]
    if len(rubber.moduli):
        lines.append("*VISCOELASTIC, TIME=PRONY")
        pairs = zip(prony_shares(rubber), rubber.relaxation_times, strict=True)
        lines += [_row((share, 0.0, time)) for share, time in pairs]
        if law is not None and law.reference_temperature is not None:
            reference = units.temperature_of(law.reference_temperature)
            lines += ["*TRS, DEFINITION=WLF", _row((reference, law.c1, law.c2))]
    return ProgramFile("\n".join(lines) + "\n", tuple(remarks))


def _row(numbers: Sequence[float]) -> str:
    """Return numbers in the 20 characters that Abaqus reads: 15 digits, fewer with more signs."""
    texts = (
        next(t for digits in (14, 13, 12) if len(t := f"{float(number):.{digits}E}") <= 20)
        for number in numbers
    )
    return ", ".join(texts)


def _ansys(
    rubber: Rubber, material: int = 1, modulus_unit: str = "Pa", temperature_unit: str = "K"
) -> ProgramFile:
    """Return commands for Ansys MAPDL, to be read with /INPUT in PREP7."""
    number = checks.whole("material", material, least=1, most=99999)
    units = Units(modulus_unit, temperature_unit)
    about = "The constants of TB,HYPER are those of the fast limit, as TB,PRONY wants them."
    program = "Ansys MAPDL", "elements with mixed u-P"
    remarks, law = parts.with_one_series(rubber, units, *program, about)
    fast = rubber.glassy_modulus / rubber.equilibrium_modulus
    relaxed = coefficients(rubber)
    compliance = 2.0 / units.stress(rubber.bulk_modulus)

    def c(i: int, j: int) -> float:
        return units.stress(relaxed.get((i, j), 0.0)) * fast

    kind = rubber.strain_energy.kind
    _, option, count, orders, compliances = FORMS[kind]
    data = [2.0 * c(1, 0)] if kind == "neo_hookean" else [c(*powers) for powers in orders]
    data += [compliance, *[0.0] * (compliances - 1)]
    lines = [*comment(remarks, "!"), f"TB,HYPER,{number},1,{count},{option}", *_data(data)]
    if len(rubber.moduli):
        pairs = zip(prony_shares(rubber), rubber.relaxation_times, strict=True)
        lines.append(f"TB,PRONY,{number},1,{len(rubber.moduli)},SHEAR")
        lines += _data([value for pair in pairs for value in pair])
        if law is not None and law.reference_temperature is not None:
            reference = units.temperature_of(law.reference_temperature)
            lines += ["! T_r, C1, C2", f"TB,SHIFT,{number},1,3,WLF"]
            lines += _data([reference, law.c1, law.c2])
    return ProgramFile("\n".join(lines) + "\n", tuple(remarks))


def _data(values: Sequence[float]) -> list[str]:
    """Return lines of TBDATA: the number of the first constant, and six constants at most."""
    numbers = [repr(float(value)) for value in values]
    return [
        ",".join(["TBDATA", str(start + 1), *numbers[start : start + 6]])
        for start in range(0, len(values), 6)
    ]


TERMS = 6  # terms of an "uncoupled viscoelastic" material


def _febio(
    rubber: Rubber, name: str | None = None, material: int = 1, modulus_unit: str = "Pa"
) -> ProgramFile:
    """Return the Material section of an FEBio file of version 4.0, to be copied or included."""
    number = checks.whole("material", material, least=1, most=99999)
    units = Units(modulus_unit)
    root = ET.Element("febio_spec", version="4.0")
    section = ET.SubElement(root, "Material")
    attributes = {"id": str(number), "name": parts.label(rubber, name)}
    solids = 1 + -(-len(rubber.moduli) // TERMS)
    bulk = units.stress(rubber.bulk_modulus)
    if solids == 1:
        _permanent(ET.SubElement(section, "material", attributes), rubber, bulk, units)
    else:
        attributes["type"] = "uncoupled solid mixture"
        mixture = ET.SubElement(section, "material", attributes)
        _value(mixture, "k", bulk)
        _permanent(ET.SubElement(mixture, "solid"), rubber, bulk / solids, units)
        for first in range(0, len(rubber.moduli), TERMS):
            moduli = rubber.shear_moduli[first : first + TERMS]
            times = rubber.relaxation_times[first : first + TERMS]
            total = float(moduli.sum())
            solid = ET.SubElement(mixture, "solid", {"type": "uncoupled viscoelastic"})
            _value(solid, "g0", 0.0)
            for number, (modulus, time) in enumerate(zip(moduli, times, strict=True), start=1):
                _value(solid, f"g{number}", modulus / total)
                _value(solid, f"t{number}", time)
            elastic = ET.SubElement(solid, "elastic", {"type": "Mooney-Rivlin"})
            _value(elastic, "k", bulk / solids)
            _value(elastic, "c1", units.stress(0.5 * total))
            _value(elastic, "c2", 0.0)
    remarks = [
        *parts.heading(rubber, units, "FEBio"),
        "FEBio's volume energy is K/2 (ln J)^2, gripscale's K/2 (J-1)^2: equal at small changes of "
        "volume.",
    ]
    if solids > 1:
        law, shift_remark = parts.wlf(rubber)
        if law is not None:
            shift_remark = "FEBio has no time-temperature shift: for another temperature, export "
            shift_remark += "the rubber there."
        remarks += [
            f"{solids - 1} solids of at most {TERMS} Maxwell elements and the permanent network: "
            "the whole series, not a fit of it.",
            "At finite strain FEBio relaxes the second Piola-Kirchhoff stress of each solid by a "
            "hereditary integral, gripscale has temporary networks that are born free of stress "
            "(Lubliner 1985): equal at small strain and relaxed, different in between.",
            shift_remark,
        ]
    ET.indent(root)
    body = ET.tostring(root, encoding="unicode")
    # XML allows no two hyphens in a comment.
    comments = [re.sub("-(?=-)", "- ", line) for line in comment(remarks, " ")]
    head = ['<?xml version="1.0" encoding="UTF-8"?>', "<!--", *comments, "-->"]
    return ProgramFile("\n".join([*head, body]) + "\n", tuple(remarks))


def _permanent(into: ET.Element, rubber: Rubber, bulk: float, units: Units) -> None:
    """Fill a material with the strain energy of the permanent network."""
    c = coefficients(rubber)
    kind = rubber.strain_energy.kind
    if kind == "isihara" or c[1, 0] <= 0.0:
        raise InputError(
            "strain_energy must be neo_hookean, yeoh, or mooney_rivlin with a share below 1 for "
            f"FEBio; got {kind} with {rubber.strain_energy.parameters()}"
        )
    into.set("type", "Yeoh" if kind == "yeoh" else "Mooney-Rivlin")
    _value(into, "k", bulk)
    powers = [(1, 0), (2, 0), (3, 0)] if kind == "yeoh" else [(1, 0), (0, 1)]
    for number, order in enumerate(powers, start=1):
        _value(into, f"c{number}", units.stress(c.get(order, 0.0)))


def _value(into: ET.Element, name: str, value: float) -> None:
    ET.SubElement(into, name).text = repr(float(value))


PROGRAMS: dict[str, Callable[..., ProgramFile]] = {
    "abaqus": _abaqus,
    "ansys": _ansys,
    "febio": _febio,
}


def rubber_file(rubber: Rubber, *, to: str, **options: Any) -> ProgramFile:
    """Return a rubber as a material of a finite element program, at its reference temperature.

    Raises `InputError` if the program is unknown, does not take an option or its value, has no such
    material, or takes E_inf as 1 - sum g_i and it is below 1e-7 of E_inf + sum E_i.

    Parameters
    ----------
    rubber : Rubber
        At the temperature of the analysis (`Rubber.at`). Abaqus and Ansys take any strain energy,
        Isihara's as a polynomial, and a shift that is, or can be fitted by, WLF; FEBio takes
        neo-Hookean, Mooney-Rivlin with a share below one, or Yeoh, and no shift.
    to : str
        abaqus, ansys or febio.
    name : str, optional
        Name of the material, by default derived from that of the rubber; not for ansys.
    material : int
        Number of the material, 1 to 99999; not for abaqus.
    modulus_unit : str
        Pa, kPa, MPa, N/mm^2 or GPa, for all stresses in the file.
    temperature_unit : str
        K or C, for the reference temperature of the shift; not for febio.
    """
    checks.instance("rubber", rubber, Rubber)
    program = PROGRAMS[checks.one_of("to", to, PROGRAMS)]
    allowed = [name for name in signature(program).parameters if name != "rubber"]
    checks.allowed_names(f"option of {to}", options, allowed)
    return program(rubber, **options)


def write_rubber(rubber: Rubber, path: str | Path, *, to: str, **options: Any) -> ProgramFile:
    """Write what `rubber_file` returns to the file `path`, and return it.

    Raises `InputError` as `rubber_file` does, `FileError` if the file cannot be written.
    """
    file = rubber_file(rubber, to=to, **options)
    write_text(file_path(path), file.text)
    return file
