"""The parts of a rubber that finite element programs take alike, and remarks on the others.

    W = sum C_ij (I1 - 3)^i (I2 - 3)^j + K/2 (J - 1)^2

with the invariants of the isochoric C, as in `gripscale.rubber.strain_energy`; its WLF law; and its
Prony series, or one of fewer terms for a band of frequencies: E_inf, E_i >= 0 that minimise

    sum_k (E'(w_k)/E'_k - 1)^2 + (E''(w_k)/E''_k - 1)^2.
"""

from __future__ import annotations

import math
import textwrap
import warnings
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import nnls

from gripscale.core import Array, Described, InputError, RubberWarning, checks
from gripscale.core.provenance import version_of
from gripscale.core.units import UNITS, ZERO_CELSIUS
from gripscale.rubber import WLF, Rubber, ShiftTable, WLFArrhenius, fit_wlf
from gripscale.rubber.strain_energy import Isihara, MooneyRivlin, NeoHookean, Yeoh

_WIDTH = 76  # characters in a line of comment: Abaqus reads 256, people read fewer


@dataclass(frozen=True, repr=False)
class ProgramFile(Described):
    """A text for a finite element program."""

    text: str = field(repr=False)
    """The whole file."""
    remarks: tuple[str, ...]
    """Comments of the file: units, limits of validity, properties that are not exported."""


@dataclass(frozen=True)
class Units:
    """Units of a file: of moduli and of temperatures; times are in s."""

    modulus: str = "Pa"
    temperature: str = "K"

    def __post_init__(self) -> None:
        checks.one_of("modulus_unit", self.modulus, UNITS["modulus"])
        checks.one_of("temperature_unit", self.temperature, ["K", "C"])

    def stress(self, pascal: float) -> float:
        """Return a stress or modulus [Pa] in the unit of the file."""
        return pascal / UNITS["modulus"][self.modulus]

    def temperature_of(self, kelvin: float) -> float:
        """Return a temperature [K] in the unit of the file."""
        return kelvin - ZERO_CELSIUS if self.temperature == "C" else kelvin


def heading(rubber: Rubber, units: Units, program: str) -> list[str]:
    """Return the remarks of a file on the rubber and its units."""
    named = "; ".join(text for text in (rubber.name, rubber.source) if text) or "a rubber"
    lines = [
        f"Written by gripscale {version_of('gripscale')} for {program}: {' '.join(named.split())}.",
        f"Units: stresses and moduli in {units.modulus}, times in s, temperatures in "
        f"{units.temperature}.",
        f"Young's modulus {units.stress(rubber.equilibrium_modulus):.6g} relaxed, "
        f"{units.stress(rubber.glassy_modulus):.6g} at once; {len(rubber.moduli)} Maxwell "
        f"elements; bulk modulus {units.stress(rubber.bulk_modulus):.6g}, which does not relax.",
    ]
    if rubber.valid_band is not None:
        low, high = rubber.valid_band
        lines.append(
            f"The series rests on a measurement from {low:.4g} to {high:.4g} rad/s; beyond, it is "
            "an extrapolation."
        )
    if rubber.reference_temperature is not None:
        kelvin = rubber.reference_temperature
        lines.append(
            f"Moduli and times are those at {units.temperature_of(kelvin):.6g} {units.temperature}."
        )
    return lines


def comment(remarks: list[str], mark: str) -> list[str]:
    """Return remarks as lines of comment after a `mark`; letters beyond ASCII become "?"."""
    return [
        f"{mark} {line}"
        for remark in remarks
        for line in textwrap.wrap(
            "".join(letter if " " <= letter <= "~" else "?" for letter in remark),
            _WIDTH,
            subsequent_indent="  ",
            break_on_hyphens=False,
        )
    ]


def label(rubber: Rubber, name: str | None) -> str:
    """Return a name that all programs accept; `InputError` for a stated one that they do not."""
    if name is None:
        plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in rubber.name).strip("_")
        return f"rubber_{plain}"[:38].strip("_")
    checks.text("name", name)
    letters = name.isascii() and name.replace("_", "").isalnum() and name[:1].isalpha()
    if not letters or len(name) > 38:
        raise InputError(
            "name must be at most 38 letters, digits and underscores, a letter first; "
            f"got {checks.short_repr(name)}"
        )
    return name


# Relaxed over instantaneous modulus below which 1 - sum g_i has lost its digits.
_LEAST_SHARE = 1e-7


def coefficients(rubber: Rubber) -> dict[tuple[int, int], float]:
    """Return C_ij [Pa] of the permanent network by (i, j); `InputError` for another energy."""
    half, energy = 0.5 * rubber.equilibrium_shear_modulus, rubber.strain_energy
    match energy:
        case NeoHookean():
            return {(1, 0): half}
        case MooneyRivlin(share=share):
            return {(1, 0): half * (1.0 - share), (0, 1): half * share}
        case Yeoh(second=second, third=third):
            return {(1, 0): half, (2, 0): half * second, (3, 0): half * third}
        case Isihara(share=share, second=second):
            return {(1, 0): half * (1.0 - share), (0, 1): half * share, (2, 0): half * second}
    raise InputError(
        "strain_energy must be neo_hookean, mooney_rivlin, yeoh or isihara to be exported; got "
        f"{energy.kind}"
    )


def prony_shares(rubber: Rubber) -> Array:
    """Return g_i = E_i / (E_inf + sum E_j) [-]; `InputError` if E_inf is lost in 1 - sum g_i."""
    if rubber.equilibrium_modulus < _LEAST_SHARE * rubber.glassy_modulus:
        raise InputError(
            f"equilibrium_modulus must be at least {_LEAST_SHARE:g} of E_inf + sum E_i where the "
            "program takes it as 1 - sum g_i; got "
            f"{rubber.equilibrium_modulus / rubber.glassy_modulus:.3g} of it"
        )
    return np.asarray(rubber.moduli / rubber.glassy_modulus)


def wlf(rubber: Rubber) -> tuple[WLF | None, str]:
    """Return the WLF law of a rubber at its reference temperature, or None, and a remark on it."""
    shift, reference = rubber.shift, rubber.reference_temperature
    if shift is None or reference is None:
        return None, "The rubber has no shift: its numbers hold for one temperature."
    match shift:
        case WLF():
            return shift.referred_to(reference), "WLF shift, log10 a_T = -c1 (T-T0)/(c2+T-T0)."
        case WLFArrhenius():
            upper = WLF(shift.c1, shift.c2, shift.reference_temperature).referred_to(reference)
            return upper, (
                f"WLF shift above the glass transition at {shift.glass_temperature:.2f} K; the "
                "Arrhenius law below it is not carried."
            )
        case ShiftTable():
            try:
                fit = fit_wlf(shift, reference_temperature=reference)
            except InputError as error:
                return None, (
                    f"The shift table is not carried ({error}): the numbers hold for "
                    f"{reference:.2f} K."
                )
            assert isinstance(fit.shift, WLF)
            low, high = shift.limits
            remark = (
                f"WLF fitted to the shift table from {low:.2f} to {high:.2f} K: misses it by "
                f"{fit.misfit:.2g} decades rms, {float(np.abs(fit.residual).max()):.2g} at most."
            )
            vertical = float(np.abs(shift.log_b(shift.temperature, reference)).max())
            if vertical > 0.0:
                remark += (
                    f" The vertical shift, up to a factor of {10.0**vertical:.3g}, is not carried."
                )
            return fit.shift, remark
    return None, (
        f"The shift ({shift.kind}) is not carried: the numbers hold for {reference:.2f} K; export "
        "the rubber at the temperature of the analysis."
    )


def with_one_series(
    rubber: Rubber, units: Units, program: str, elements: str, constants: str
) -> tuple[list[str], WLF | None]:
    """Return remarks and shift for a program that relaxes the whole energy by one Prony series."""
    remarks = heading(rubber, units, program)
    remarks.append(f"Use {elements}: the rubber is nearly incompressible.")
    if not len(rubber.moduli):
        return remarks, None
    law, shift_remark = wlf(rubber)
    form = (
        f"At finite strain {program} relaxes the whole stress by a hereditary integral, gripscale "
        "by temporary networks that are born free of stress (Lubliner 1985): equal at small "
        "strain and relaxed, different in between."
    )
    if not isinstance(rubber.strain_energy, NeoHookean):
        form += (
            f" Here the relaxing part has the {rubber.strain_energy.kind} energy as well; in "
            "gripscale it is neo-Hookean."
        )
    return [*remarks, constants, form, shift_remark], law


_MARGIN = 10.0**0.5  # how far the times reach beyond the band, as a ratio
_PER_DECADE = 20  # frequencies at which the moduli are compared
MOST_TERMS = 200


@dataclass(frozen=True)
class Reduction:
    """A rubber with another Prony series, and what this misses within a band."""

    rubber: Rubber  # the rubber; its `valid_band` is the band [rad/s]
    storage: float  # largest relative error of E' within the band
    loss: float  # largest relative error of E''
    loss_factor: float  # largest relative error of E''/E'

    def __str__(self) -> str:
        low, high = (end / (2.0 * math.pi) for end in self.rubber.valid_band or (0.0, math.inf))
        return (
            f"Reduced to {len(self.rubber.moduli)} Maxwell elements for {low:.4g} to {high:.4g} "
            f"Hz; largest errors there: E' {self.storage:.2%}, E'' {self.loss:.2%}, loss factor "
            f"{self.loss_factor:.2%}"
        )


def reduced(
    rubber: Rubber, *, band: tuple[float, float] | None = None, terms: int | None = None
) -> Reduction:
    """Return a rubber with fewer terms, for a band of frequencies.

    The `band` [Hz] is by default what the numbers rest on, or all terms; the number of Maxwell
    elements, `terms`, 1 to 200, is by default that of the rubber in the band. Raises `InputError`
    if an argument is out of range, or the rubber is elastic.
    """
    checks.instance("rubber", rubber, Rubber)
    if not len(rubber.moduli):
        raise InputError("rubber must have Maxwell elements to be reduced; got an elastic one")
    rates = 1.0 / np.asarray(rubber.relaxation_times)
    low, high = rubber.valid_band or (float(rates.min()), float(rates.max()))
    if band is not None:
        low, high = (2.0 * math.pi * end for end in checks.interval("band", band, unit="Hz"))
    inside = int(((rates >= low) & (rates <= high)).sum())
    count = max(inside, 1)
    if terms is not None:
        count = checks.whole("terms", terms, least=1, most=MOST_TERMS)
    ends = (1.0 / (_MARGIN * high), _MARGIN / low)
    times = np.geomspace(*ends, count) if count > 2 else np.geomspace(*ends, count + 2)[1:-1]
    omega = np.geomspace(low, high, max(2, round(_PER_DECADE * math.log10(high / low))))
    exact = rubber.complex_modulus(omega)
    phase = 1j * omega[:, None] * times
    columns = np.column_stack([np.ones_like(omega), phase / (1.0 + phase)])
    parts = [columns.real / exact.real[:, None], columns.imag / exact.imag[:, None]]
    solution, _ = nnls(np.concatenate(parts), np.ones(2 * omega.size))
    kept = solution[1:] > 0.0
    if not solution[0] > 0.0:
        raise InputError(
            f"terms must be enough for E' at the slow end of the band; {count} leave no "
            "equilibrium modulus"
        )
    with warnings.catch_warnings():  # of a bulk modulus that the rubber has already
        warnings.simplefilter("ignore", RubberWarning)
        fewer = replace(
            rubber,
            equilibrium_modulus=float(solution[0]),
            moduli=solution[1:][kept],
            relaxation_times=times[kept],
            valid_band=(low, high),
            admissible=None,
        )
        modulus = fewer.complex_modulus(omega)
        factor = (modulus.imag / modulus.real) / (exact.imag / exact.real)
        ratios = modulus.real / exact.real, modulus.imag / exact.imag, factor
        reduction = Reduction(fewer, *(float(np.abs(ratio - 1.0).max()) for ratio in ratios))
        source = f"{rubber.source}; {reduction}" if rubber.source else str(reduction)
        return replace(reduction, rubber=replace(fewer, source=source))
