"""A rubber as an Abaqus material: *HYPERELASTIC, *VISCOELASTIC, *TRS.

    U     = sum C_ij (I1 - 3)^i (I2 - 3)^j + (J - 1)^2 / D1,   K = 2/D1
    G(t)  = G_0 (1 - sum g_i (1 - exp(-t/tau_i))),   k_i = 0
    log10 A = -c1 (T - T_0) / (c2 + T - T_0),   time runs at 1/A

With MODULI=LONG TERM the C_ij are those of the relaxed rubber, C_ij(0) = C_ij / (1 - sum g_i).
Source: Abaqus Keywords Reference Guide (2016), *HYPERELASTIC, *VISCOELASTIC, *TRS; Analysis User's
Guide, sections 22.5.1 and 22.7.1.
"""

from __future__ import annotations

from collections.abc import Iterable

from gripscale import checks
from gripscale.export.carried import Coefficients, coefficients, shares, with_one_series
from gripscale.export.program_file import ProgramFile, Units, comment, label
from gripscale.rubber import Rubber

FORMS: dict[str, tuple[str, tuple[tuple[int, int], ...], int]] = {
    "neo_hookean": ("NEO HOOKE", ((1, 0),), 1),
    "mooney_rivlin": ("MOONEY-RIVLIN", ((1, 0), (0, 1)), 1),
    "yeoh": ("YEOH", ((1, 0), (2, 0), (3, 0)), 3),
    "isihara": ("POLYNOMIAL, N=2", ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)), 2),
}
"""Keyword, order of the C_ij and number of the D_k of each strain energy; D_2 and on are zero,
which leaves their terms out."""


def abaqus_rubber(
    rubber: Rubber,
    *,
    name: str | None = None,
    modulus_unit: str = "Pa",
    temperature_unit: str = "K",
) -> ProgramFile:
    """Return a rubber as an Abaqus material, to be included in an input file.

    Parameters
    ----------
    rubber : Rubber
        Any strain energy; Isihara's becomes a polynomial. Its times and moduli are those at its
        reference temperature; a shift becomes *TRS if it is, or can be fitted by, WLF.
    name : str, optional
        Of the material; made of the rubber's by default.
    modulus_unit : str
        Pa, kPa, MPa, N/mm^2 or GPa, of all stresses in the file.
    temperature_unit : str
        K or C, of the reference temperature of *TRS.

    Returns
    -------
    ProgramFile
        Numbers have 15 digits, what fits into the 20 characters Abaqus reads of each.

    Raises
    ------
    InputError
        If a unit or the name cannot be used, or E_inf is below 1e-7 of E_inf + sum E_i.
    """
    checks.instance("rubber", rubber, Rubber)
    units = Units(modulus_unit, temperature_unit)
    remarks, law = with_one_series(
        rubber,
        units,
        "Abaqus",
        "hybrid elements",
        "MODULI=LONG TERM: the constants of *HYPERELASTIC are those of the relaxed rubber.",
    )
    lines = [
        *comment(remarks, "**"),
        f"*MATERIAL, NAME={label(rubber, name)}",
        *_hyperelastic(rubber, coefficients(rubber), units),
    ]
    if len(rubber.moduli):
        lines.append("*VISCOELASTIC, TIME=PRONY")
        pairs = zip(shares(rubber), rubber.relaxation_times, strict=True)
        lines += [_row((share, 0.0, time)) for share, time in pairs]
        if law is not None and law.reference_temperature is not None:
            reference = units.temperature_of(law.reference_temperature)
            lines += ["*TRS, DEFINITION=WLF", _row((reference, law.c1, law.c2))]
    return ProgramFile("\n".join(lines) + "\n", tuple(remarks))


def _hyperelastic(rubber: Rubber, found: Coefficients, units: Units) -> list[str]:
    form, order, volumetric = FORMS[rubber.strain_energy.kind]
    constants = [units.stress(found.get(powers, 0.0)) for powers in order]
    compliances = [2.0 / units.stress(rubber.bulk_modulus), *[0.0] * (volumetric - 1)]
    moduli = ", MODULI=LONG TERM" if len(rubber.moduli) else ""
    return [f"*HYPERELASTIC, {form}{moduli}", _row([*constants, *compliances])]


def _row(numbers: Iterable[float]) -> str:
    return ", ".join(_number(float(number)) for number in numbers)


def _number(value: float) -> str:
    """Return a number in the 20 characters that Abaqus reads: 15 digits, fewer with more signs."""
    return next(text for digits in (14, 13, 12) if len(text := f"{value:.{digits}E}") <= 20)
