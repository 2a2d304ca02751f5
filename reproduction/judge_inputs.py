"""Statements about the inputs: master curves, correlations, magnification factors (Figs 2 to 4)."""

from __future__ import annotations

import math

import numpy as np

from gripscale.core.errors import InputError
from gripscale.rubber import springpot_modulus
from gripscale.surface import SineStack, fit_self_affine, fit_sines
from reproduction.inputs import DENSE, PAPER_FACTORS, ROAD, SBR, TREAD, Inputs
from reproduction.statement import Statement

MODULUS_ERROR = 0.10
POWER_LAW_DECADES, POWER_LAW_RESIDUAL = 1.0, 0.02
TWO_FACTORS_RESIDUAL, ONE_FACTOR_RATIO = 0.1, 1.5


def judge_master_curves(inputs: Inputs) -> list[Statement]:
    """Judge whether a generalized Maxwell solid has the moduli of each compound (Fig. 2)."""
    sbr = inputs.rubbers[SBR]
    low, high = sbr.valid_band or (1e-2, 1e10)
    omega = np.geomspace(low, high, 200)
    ratio = sbr.complex_modulus(omega)
    wanted = springpot_modulus(omega)
    errors = {
        TREAD: (inputs.prony.rms_storage, inputs.prony.rms_loss),
        SBR: (_rms(ratio.real / wanted.real), _rms(ratio.imag / wanted.imag)),
    }
    return [
        Statement(
            "fig2",
            "a generalized Maxwell (Prony) solid reproduces the master curve",
            name,
            f"rms error of E' and E'' at most {MODULUS_ERROR:.0%}: friction is proportional to "
            "E'' at full contact, so it is off by no more",
            f"E' {storage:.1%}, E'' {loss:.1%}",
            max(storage, loss) <= MODULUS_ERROR,
        )
        for name, (storage, loss) in errors.items()
    ]


def judge_correlation(inputs: Inputs) -> list[Statement]:
    """Judge whether C_z is a power law below a cut-off and constant above it (Fig. 3b)."""
    return [_self_affine(inputs, road) for road in (ROAD, DENSE)]


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
    return Statement("fig3b", said, road, criterion, number, holds)


def single_factor(inputs: Inputs, road: str) -> tuple[SineStack, SineStack]:
    """Return waves fitted with two factors and with one, same number and smallest wavelength."""
    stack = next(iter(inputs.magnified(road).values()))
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
    for road in (DENSE, ROAD):
        two, one = (float(stack.residual or math.nan) for stack in single_factor(inputs, road))
        statements.append(_one_or_two(inputs, road, two, one))
    residuals = {name: s.residual or math.nan for name, s in inputs.magnified(DENSE).items()}
    worst = max(residuals, key=lambda name: residuals[name])
    last = "/".join(f"{part:g}" for part in PAPER_FACTORS[-1])
    statements.append(
        Statement(
            "fig4",
            "of (3.5, 2.4), (3, 2.2) and (6, 3) the last fits C_z worst",
            f"{DENSE}, the paper's factors",
            "largest rms residual of the three",
            ", ".join(f"{name}: {value:.3f} decades" for name, value in residuals.items()),
            worst == last,
        )
    )
    return statements


def _one_or_two(inputs: Inputs, road: str, two: float, one: float) -> Statement:
    stack = inputs.surfaces[road].sines
    exponent = math.log(stack.s_amplitude or 1.0) / math.log(stack.s_wavelength or math.e)
    holds = two <= TWO_FACTORS_RESIDUAL and one >= ONE_FACTOR_RATIO * two
    paper = math.log(PAPER_FACTORS[0][1]) / math.log(PAPER_FACTORS[0][0])
    why = (
        f"different inputs: amplitudes fall as wavelength^{exponent:.2f} on this road, so one "
        f"factor (exponent 1) is nearly right; on the paper's asphalt the exponent is {paper:.2f}"
    )
    return Statement(
        "fig4",
        "two magnification factors fit C_z, one for both lengths does not",
        road,
        f"rms residual with two at most {TWO_FACTORS_RESIDUAL:g} decades (25 % of C_z, 12 % of "
        f"height), with one at least {ONE_FACTOR_RATIO:g} times as much",
        f"two: {two:.3f}, one: {one:.3f} decades ({one / two:.2f} times)",
        holds,
        "" if holds else why,
    )


def _rms(ratio: np.ndarray) -> float:
    return float(np.sqrt(np.mean((ratio - 1.0) ** 2)))
