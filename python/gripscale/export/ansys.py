"""A rubber as an Ansys MAPDL material: TB,HYPER, TB,PRONY, TB,SHIFT.

    W    = sum C_ij (I1 - 3)^i (I2 - 3)^j + (J - 1)^2 / d,   K = 2/d
    G(t) = G_0 (alpha_inf + sum alpha_i exp(-t/tau_i)),   alpha_inf = 1 - sum alpha_i
    log10 A = C1 (T - T_r) / (C2 + T - T_r),   tau_i(T) = tau_i(T_r) / A

The constants of TB,HYPER are those of the fast limit: C_ij of the relaxed rubber over alpha_inf.
Source: Ansys Mechanical APDL, Material Reference, "Hyperelasticity" and "Viscoelasticity".
"""

from __future__ import annotations

from collections.abc import Sequence

from gripscale import checks
from gripscale.export.carried import coefficients, material_number, shares, with_one_series
from gripscale.export.program_file import ProgramFile, Units, comment
from gripscale.rubber import Rubber

_ON_A_LINE = 6
"""Constants that TBDATA takes."""


def ansys_rubber(
    rubber: Rubber,
    *,
    material: int = 1,
    modulus_unit: str = "Pa",
    temperature_unit: str = "K",
) -> ProgramFile:
    """Return a rubber as commands for Ansys MAPDL, to be read with /INPUT in PREP7.

    Parameters
    ----------
    rubber : Rubber
        Any strain energy; Isihara's becomes a polynomial. Its times and moduli are those at its
        reference temperature; a shift becomes TB,SHIFT if it is, or can be fitted by, WLF.
    material : int
        Number of the material, 1 to 99999.
    modulus_unit : str
        Pa, kPa, MPa, N/mm^2 or GPa, of all stresses in the file.
    temperature_unit : str
        K or C, of the reference temperature of TB,SHIFT.

    Returns
    -------
    ProgramFile
        The commands.

    Raises
    ------
    InputError
        If a unit or the number cannot be used, or E_inf is below 1e-7 of E_inf + sum E_i.
    """
    checks.instance("rubber", rubber, Rubber)
    number = material_number(material)
    units = Units(modulus_unit, temperature_unit)
    remarks, law = with_one_series(
        rubber,
        units,
        "Ansys MAPDL",
        "elements with mixed u-P",
        "The constants of TB,HYPER are those of the fast limit, as TB,PRONY wants them.",
    )
    lines = [*comment(remarks, "!"), *_hyperelastic(rubber, number, units)]
    if len(rubber.moduli):
        pairs = [
            value
            for pair in zip(shares(rubber), rubber.relaxation_times, strict=True)
            for value in pair
        ]
        lines += [f"TB,PRONY,{number},1,{len(rubber.moduli)},SHEAR", *_data(pairs)]
        if law is not None and law.reference_temperature is not None:
            reference = units.temperature_of(law.reference_temperature)
            constants = [reference, law.c1, law.c2]
            lines += ["! T_r, C1, C2", f"TB,SHIFT,{number},1,3,WLF", *_data(constants)]
    return ProgramFile("\n".join(lines) + "\n", tuple(remarks))


def _hyperelastic(rubber: Rubber, number: int, units: Units) -> list[str]:
    """Return TB,HYPER with its data, at once after a step."""
    fast = rubber.glassy_modulus / rubber.equilibrium_modulus
    found = {at: units.stress(value) * fast for at, value in coefficients(rubber).items()}
    compliance = 2.0 / units.stress(rubber.bulk_modulus)

    def c(i: int, j: int) -> float:
        return found.get((i, j), 0.0)

    match rubber.strain_energy.kind:
        case "neo_hookean":
            option, count, data = "NEO", 2, [2.0 * c(1, 0), compliance]
        case "mooney_rivlin":
            option, count, data = "MOONEY", 2, [c(1, 0), c(0, 1), compliance]
        case "yeoh":
            parts = [c(1, 0), c(2, 0), c(3, 0)]
            option, count, data = "YEOH", 3, [*parts, compliance, 0.0, 0.0]
        case _:
            parts = [c(1, 0), c(0, 1), c(2, 0), c(1, 1), c(0, 2)]
            option, count, data = "POLY", 2, [*parts, compliance, 0.0]
    return [f"TB,HYPER,{number},1,{count},{option}", *_data(data)]


def _data(values: Sequence[float]) -> list[str]:
    starts = range(0, len(values), _ON_A_LINE)
    return [
        ",".join(["TBDATA", str(start + 1), *map(_number, values[start : start + _ON_A_LINE])])
        for start in starts
    ]


def _number(value: float) -> str:
    return repr(float(value))
