"""A rubber as an FEBio material: a mixture of the permanent network and temporary networks.

    S_dev = sum over solids of g_0 S_e + sum g_i int exp(-(t - s)/t_i) dS_e/ds ds
    U     = K/2 (ln J)^2,   S_e of W = c1 (I1 - 3) + c2 (I2 - 3)

"uncoupled viscoelastic" has six terms. A mixture of uncoupled solids adds their deviatoric
stresses, so that any number of terms is carried as it is: the permanent network is one solid, and
each six Maxwell elements are another, neo-Hookean as in gripscale, with g_0 = 0. The bulk modulus
stands on the mixture, and in equal parts on its solids: versions that add those get the same sum.
Source: FEBio User Manual 4, "Uncoupled Viscoelastic Materials" and "Uncoupled Solid Mixture".
"""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

from gripscale import checks
from gripscale.errors import InputError
from gripscale.export.carried import coefficients, material_number, wlf
from gripscale.export.program_file import ProgramFile, Units, comment, heading, label
from gripscale.rubber import Rubber

TERMS = 6
"""Terms of one "uncoupled viscoelastic"."""


def febio_rubber(
    rubber: Rubber,
    *,
    name: str | None = None,
    material: int = 1,
    modulus_unit: str = "Pa",
) -> ProgramFile:
    """Return a rubber as the Material section of an FEBio file.

    Parameters
    ----------
    rubber : Rubber
        Neo-Hookean, Mooney-Rivlin with a share below one, or Yeoh. FEBio has no time-temperature
        shift: the file holds for the reference temperature of the rubber alone.
    name : str, optional
        Of the material; made of the rubber's by default.
    material : int
        Its id, 1 to 99999.
    modulus_unit : str
        Pa, kPa, MPa, N/mm^2 or GPa, of all stresses in the file.

    Returns
    -------
    ProgramFile
        A file of version 4.0 with the Material section alone, to be copied or included.

    Raises
    ------
    InputError
        If a unit, the name or the id cannot be used, or FEBio has no material with the strain
        energy.
    """
    checks.instance("rubber", rubber, Rubber)
    number = material_number(material)
    units = Units(modulus_unit)
    root = ET.Element("febio_spec", version="4.0")
    section = ET.SubElement(root, "Material")
    attributes = {"id": str(number), "name": label(rubber, name)}
    solids = 1 + -(-len(rubber.moduli) // TERMS)
    bulk = units.stress(rubber.bulk_modulus)
    if solids == 1:
        _permanent(ET.SubElement(section, "material", attributes), rubber, bulk, units)
    else:
        mixture = ET.SubElement(
            section, "material", attributes | {"type": "uncoupled solid mixture"}
        )
        _value(mixture, "k", bulk)
        _permanent(ET.SubElement(mixture, "solid"), rubber, bulk / solids, units)
        for first in range(0, len(rubber.moduli), TERMS):
            _temporary(mixture, rubber, slice(first, first + TERMS), bulk / solids, units)
    remarks = _remarks(rubber, units, solids)
    ET.indent(root)
    body = ET.tostring(root, encoding="unicode")
    # XML allows no two hyphens in a comment.
    said = [re.sub("-(?=-)", "- ", line) for line in comment(remarks, " ")]
    head = ['<?xml version="1.0" encoding="UTF-8"?>', "<!--", *said, "-->"]
    return ProgramFile("\n".join([*head, body]) + "\n", tuple(remarks))


def _remarks(rubber: Rubber, units: Units, solids: int) -> list[str]:
    remarks = [
        *heading(rubber, units, "FEBio"),
        "FEBio's volume energy is K/2 (ln J)^2, gripscale's K/2 (J-1)^2: equal at small changes of "
        "volume.",
    ]
    if solids == 1:
        return remarks
    law, said = wlf(rubber)
    return [
        *remarks,
        f"{solids - 1} solids of at most {TERMS} Maxwell elements and the permanent network: the "
        "whole series, not a fit of it.",
        "At finite strain FEBio relaxes the second Piola-Kirchhoff stress of each solid by a "
        "hereditary integral, gripscale has temporary networks that are born free of stress "
        "(Lubliner 1985): equal at small strain and relaxed, different in between.",
        said
        if law is None
        else "FEBio has no time-temperature shift: for another temperature, export the rubber "
        "there.",
    ]


def _permanent(into: ET.Element, rubber: Rubber, bulk: float, units: Units) -> None:
    """Fill a material with the strain energy of the permanent network."""
    found = coefficients(rubber)
    kind = rubber.strain_energy.kind
    if kind == "isihara" or found[1, 0] <= 0.0:
        raise InputError(
            "strain_energy must be neo_hookean, yeoh, or mooney_rivlin with a share below 1 for "
            f"FEBio; got {kind} with {rubber.strain_energy.parameters()}"
        )
    into.set("type", "Yeoh" if kind == "yeoh" else "Mooney-Rivlin")
    _value(into, "k", bulk)
    powers = [(1, 0), (2, 0), (3, 0)] if kind == "yeoh" else [(1, 0), (0, 1)]
    for place, at in enumerate(powers, start=1):
        _value(into, f"c{place}", units.stress(found.get(at, 0.0)))


def _temporary(into: ET.Element, rubber: Rubber, terms: slice, bulk: float, units: Units) -> None:
    """Add a solid of at most six Maxwell elements and no permanent part."""
    moduli, times = rubber.shear_moduli[terms], rubber.relaxation_times[terms]
    total = float(moduli.sum())
    solid = ET.SubElement(into, "solid", {"type": "uncoupled viscoelastic"})
    _value(solid, "g0", 0.0)
    for place, (modulus, time) in enumerate(zip(moduli, times, strict=True), start=1):
        _value(solid, f"g{place}", modulus / total)
        _value(solid, f"t{place}", time)
    elastic = ET.SubElement(solid, "elastic", {"type": "Mooney-Rivlin"})
    _value(elastic, "k", bulk)
    _value(elastic, "c1", units.stress(0.5 * total))
    _value(elastic, "c2", 0.0)


def _value(into: ET.Element, name: str, value: float) -> None:
    ET.SubElement(into, name).text = repr(float(value))
