"""Statements about the inputs: master curves, correlations, magnification factors (Figs 2 to 4)."""

from __future__ import annotations

import math

import numpy as np

from gripscale.core.errors import InputError
from gripscale.rubber import springpot_modulus, styrene_butadiene
from gripscale.surface import SineStack, fit_self_affine, fit_sines
from reproduction.inputs import PAPER_FACTORS, Compound, Inputs
from reproduction.statement import Statement

MODULUS_ERROR = 0.10
POWER_LAW_DECADES, POWER_LAW_RESIDUAL = 1.0, 0.02
TWO_FACTORS_RESIDUAL, ONE_FACTOR_RATIO = 0.1, 1.5


def judge_master_curves(inputs: Inputs) -> list[Statement]:
    """Judge whether a generalized Maxwell solid has the moduli of each compound (Fig. 2)."""
    return [
        _maxwell(name, compound, errors)
        for name, compound in inputs.compounds.items()
        if (errors := _modulus_errors(compound)) is not None
    ]


def _modulus_errors(compound: Compound) -> tuple[float, float] | None:
    """Return the rms errors of E' and E''; None of a series that came without its moduli."""
    if compound.fit is not None:
        return compound.fit.rms_storage, compound.fit.rms_loss
    if compound.rubber != styrene_butadiene():
        return None
    omega = np.geomspace(*(compound.rubber.valid_band or (1e-2, 1e10)), 200)
    found, wanted = compound.rubber.complex_modulus(omega), springpot_modulus(omega)
    return _rms(found.real / wanted.real), _rms(found.imag / wanted.imag)


def _maxwell(name: str, compound: Compound, errors: tuple[float, float]) -> Statement:
    storage, loss = errors
    holds = max(errors) <= MODULUS_ERROR
    why = "the rows scatter about the best series"
    if compound.fit is not None and compound.fit.inconsistencies:
        why = (
            "no linear solid has the measured E' and E'' of "
            f"{len(compound.fit.inconsistencies)} stretches of frequency (Kramers-Kronig)"
        )
    return Statement(
        "fig2",
        "a generalized Maxwell (Prony) solid reproduces the master curve",
        name,
        f"rms error of E' and E'' at most {MODULUS_ERROR:.0%}: friction is proportional to "
        "E'' at full contact, so it is off by no more",
        f"E' {storage:.1%}, E'' {loss:.1%}",
        holds,
        why,
    )


def judge_correlation(inputs: Inputs) -> list[Statement]:
    """Judge whether C_z is a power law below a cut-off and constant above it (Fig. 3b)."""
    return [_self_affine(inputs, road) for road in inputs.surfaces]


def _self_affine(inputs: Inputs, road: str) -> Statement:
    said = "C_z is a power law below a cut-off and constant above it (eq. 6)"
    criterion = (
        f"straight within {POWER_LAW_RESIDUAL:g} decades rms (5 %) over at least "
        f"{POWER_LAW_DECADES:g} decade of lag, and a plateau"
    )
    try:
        fit = fit_self_affine(inputs.correlation(road))
    except InputError as error:
        return Statement("fig3b", said, road, criterion, "no fit", False, str(error))
    decades = math.log10(fit.lag_max / fit.lag_min)
    holds = decades >= POWER_LAW_DECADES and fit.residual <= POWER_LAW_RESIDUAL
    number = (
        f"{decades:.2f} decades within {fit.residual:.3f}; H = {fit.hurst:.2f}, "
        f"xi_parallel = {fit.xi_parallel * 1e3:.2f} mm, "
        f"xi_perpendicular = {fit.xi_perpendicular * 1e3:.2f} mm"
    )
    why = "the surface is not self-affine over that much"
    return Statement("fig3b", said, road, criterion, number, holds, why)


def single_factor(inputs: Inputs, road: str) -> tuple[SineStack, SineStack]:
    """Return waves fitted with two factors and with one, same number and smallest wavelength."""
    stack = next(iter(inputs.stacks[road].values()))
    both = [
        fit_sines(
            inputs.correlation(road),
            scales=len(stack),
            smallest_wavelength=float(stack.wavelength[-1]),
            single_factor=single,
        )
        for single in (False, True)
    ]
    return both[0], both[1]


def judge_factors(inputs: Inputs) -> list[Statement]:
    """Judge whether two factors fit C_z and one does not, and the order of the pairs (Fig. 4)."""
    statements = []
    for road in inputs.surfaces:
        two, one = (float(stack.residual or math.nan) for stack in single_factor(inputs, road))
        statements.append(_one_or_two(inputs, road, two, one))
    for road, stacks in inputs.stacks.items():
        *_, last = stacks
        holds = inputs.worst_fit(road) == last
        residuals = ", ".join(f"{name}: {s.residual:.3f}" for name, s in stacks.items())
        statements.append(
            Statement(
                "fig4",
                "of the pairs of factors, (3.5, 2.4), (3, 2.2) and (6, 3) in the paper, the last "
                "fits C_z worst",
                road,
                "largest rms residual of all",
                f"{residuals} decades",
                holds,
                f"{inputs.worst_fit(road)} fits worst",
            )
        )
    return statements


def _one_or_two(inputs: Inputs, road: str, two: float, one: float) -> Statement:
    stack = inputs.surfaces[road].sines
    exponent = math.log(stack.s_amplitude or 1.0) / math.log(stack.s_wavelength or math.e)
    holds = two <= TWO_FACTORS_RESIDUAL and one >= ONE_FACTOR_RATIO * two
    paper = math.log(PAPER_FACTORS[0][1]) / math.log(PAPER_FACTORS[0][0])
    why = (
        f"amplitudes fall as wavelength^{exponent:.2f} on this road, so one "
        f"factor (exponent 1) is nearly right; on the paper's asphalt the exponent is {paper:.2f}"
    )
    if two > TWO_FACTORS_RESIDUAL:
        why = "waves of constant factors do not follow C_z of this surface"
    return Statement(
        "fig4",
        "two magnification factors fit C_z, one for both lengths does not",
        road,
        f"rms residual with two at most {TWO_FACTORS_RESIDUAL:g} decades (25 % of C_z, 12 % of "
        f"height), with one at least {ONE_FACTOR_RATIO:g} times as much",
        f"two: {two:.3f}, one: {one:.3f} decades ({one / two:.2f} times)",
        holds,
        why,
    )


def _rms(ratio: np.ndarray) -> float:
    return float(np.sqrt(np.mean((ratio - 1.0) ** 2)))
