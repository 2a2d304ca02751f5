"""Statements about friction (Figs 8 and 9)."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reproduction.inputs import DENSE, FAST, FASTEST, ROAD, SBR, SPEED, TREAD, Inputs
from reproduction.panels import Solved, speed_name
from reproduction.statement import Statement

Array = NDArray[np.float64]

ALIKE = 0.2
AGAIN = 0.5
LOSSIER = 0.1
SCATTER = 0.1


def judge_factors_friction(solved: Solved) -> list[Statement]:
    """Judge whether the worst fit has its own friction at small waves only (Fig. 8a)."""
    return [_departure(road, predictions) for road, predictions in solved.items()]


def _departure(road: str, predictions: dict[str, xr.Dataset]) -> Statement:
    *good, worst = predictions.values()
    own, friction = _kept(worst)
    shared = own >= max(_kept(prediction)[0][-1] for prediction in good) * (1.0 - 1e-9)
    x = own[shared]
    others = np.array([_friction_at(prediction, x) for prediction in good])
    away = friction[shared] / others.mean(axis=0) - 1.0
    apart = others.max(axis=0) / others.min(axis=0) - 1.0
    departs = abs(away[-1]) > max(ALIKE, 2.0 * apart[-1])
    holds = bool(abs(away[1]) <= ALIKE and departs)
    return Statement(
        "fig8a",
        "friction of each wave agrees for large waves; the worst fit (6, 3) departs at small ones",
        f"{road}, {TREAD}, {SPEED * 1e3:g} mm/s",
        f"the worst fit within {ALIKE:.0%} of the mean of the other two at its second wave, "
        "further away at the smallest it shares with them, and there more than twice as far as "
        "they are from each other",
        f"{away[1]:+.0%} at {x[1] * 1e3:.2g} mm, {away[-1]:+.0%} at {x[-1] * 1e3:.2g} mm, where "
        f"the others are {apart[-1]:.0%} apart",
        holds,
    )


def judge_speed_friction(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether friction rises to a maximum, sooner the faster (Fig. 8b)."""
    statements = []
    for rubber, predictions in solved.items():
        peaks = {name: _peak(prediction) for name, prediction in predictions.items()}
        rises = all(_rises(prediction, peaks[name][0]) for name, prediction in predictions.items())
        statements.append(
            Statement(
                "fig8b",
                "at each speed friction rises towards smaller waves",
                f"{ROAD}, {rubber}",
                "up to the maximum every wave has more friction than the first (within "
                f"{SCATTER:.0%}), and the maximum is not the first, at every speed",
                ", ".join(
                    f"{name}: {float(prediction.friction[0]):.3f} to {_highest(prediction):.3f}"
                    for name, prediction in predictions.items()
                ),
                rises,
            )
        )
        statements.append(_sooner(rubber, peaks, inputs))
    return statements


def _sooner(rubber: str, peaks: dict[str, tuple[int, float, bool]], inputs: Inputs) -> Statement:
    wavelengths = [peak[1] for peak in peaks.values()]
    inside = {name: peak[1] for name, peak in peaks.items() if peak[2]}
    ordered = all(later >= sooner for sooner, later in pairwise(wavelengths))
    holds = ordered and len(inside) >= 2 and len(set(inside.values())) >= 2
    omega = np.geomspace(1e-2, 1e12, 2000)
    loss = inputs.rubbers[rubber].loss_factor(omega)
    place = 2.0 * math.pi * FASTEST / omega[int(loss.argmax())]
    why = (
        "different inputs: the loss factor of this compound has its maximum at "
        f"{omega[int(loss.argmax())]:.2g} rad/s, reached at {FASTEST:g} m/s by waves of "
        f"{place * 1e6:.2g} um, far below the smallest one here (100 um); the model does show the "
        f"maximum with the {SBR}"
    )
    return Statement(
        "fig8b",
        "the higher the speed, the sooner friction reaches a maximum; then it falls",
        f"{ROAD}, {rubber}",
        "the wavelength of the maximum never falls with speed, and at two speeds or more lies at "
        "different waves with smaller ones after it",
        "maximum at "
        + ", ".join(
            f"{peak[1] * 1e3:.3g} mm ({name}{'' if peak[2] else ', the smallest'})"
            for name, peak in peaks.items()
        ),
        holds,
        "" if holds else why,
    )


def judge_compounds(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge the friction of the compounds along the waves (Fig. 9a).

    The fastest speed is beyond the paper's: there the waves reach what they do not at its speeds.
    """
    statements = []
    for speed in (SPEED, FAST):
        predictions = solved[speed_name(speed)]
        where = f"{ROAD}, {speed * 1e3:g} mm/s, {SBR} against {TREAD}"
        statements.append(_alike(where, _lead(predictions)))
        statements.append(_lossier(where, predictions))
    for speed in (SPEED, FAST, FASTEST):
        statements.append(_again(speed, solved, inputs))
    return statements


def _lead(predictions: dict[str, xr.Dataset]) -> Array:
    """Return by how much the SBR is ahead at each wave."""
    return np.asarray(predictions[SBR].friction - predictions[TREAD].friction)


def _alike(where: str, lead: Array) -> Statement:
    widest = float(np.abs(lead).max())
    return Statement(
        "fig9a",
        "compounds are alike at the largest wave",
        where,
        f"difference in friction there at most {ALIKE:.0%} of the largest difference",
        f"{lead[0]:+.3f} of {widest:.3f} ({lead[0] / widest:+.0%})",
        bool(abs(lead[0]) <= ALIKE * widest),
    )


def _lossier(where: str, predictions: dict[str, xr.Dataset]) -> Statement:
    lead = _lead(predictions)[1:]
    ratio = np.asarray(predictions[SBR].loss_factor / predictions[TREAD].loss_factor)[1:]
    told = np.abs(np.log(ratio)) > math.log(1.0 + LOSSIER)
    ahead = np.sign(lead) == np.sign(np.log(ratio))
    return Statement(
        "fig9a",
        "the lossier compound is ahead up to the wavelength of maximum E''",
        where,
        "more friction for the larger loss factor at every further wave at which loss factors "
        f"differ by more than {LOSSIER:.0%} (by less, the contact area decides)",
        f"{int((ahead & told).sum())} of {int(told.sum())} waves; loss factor ratio "
        f"{ratio.min():.2f} to {ratio.max():.2f}, lead {lead.min():+.3f} to {lead.max():+.3f}",
        bool((ahead | ~told).all()),
    )


def _again(speed: float, solved: Solved, inputs: Inputs) -> Statement:
    predictions, fastest = solved[speed_name(speed)], _lead(solved[speed_name(FASTEST)])
    lead = _lead(predictions)
    omega = np.geomspace(1e-2, 1e12, 2000)
    modulus = inputs.rubbers[SBR].complex_modulus(omega)
    highest = float(omega[int(modulus.imag.argmax())])
    lossiest = float(omega[int((modulus.imag / modulus.real).argmax())])
    ratio = float(abs(lead[-1]) / np.abs(lead).max())
    smallest = float(predictions[TREAD].wavelength[lead.size - 1])
    why = (
        f"different inputs: E'' of the {SBR} has its maximum at {highest:.1e} rad/s, its loss "
        f"factor at {lossiest:.1e} rad/s; at this speed waves of "
        f"{2e6 * math.pi * speed / highest:.2g} um and {2e6 * math.pi * speed / lossiest:.2g} um "
        f"excite them, and the waves end at {smallest * 1e6:.3g} um. At {FASTEST:g} m/s they reach "
        f"the second, and the lead falls from {np.abs(fastest).max():.3f} to {fastest[-1]:.3f}"
    )
    return Statement(
        "fig9a",
        "beyond the wavelength of maximum E'' the compounds come together again",
        f"{ROAD}, {speed * 1e3:g} mm/s, {SBR} against {TREAD}"
        + (" (beyond the paper's speeds)" if speed == FASTEST else ""),
        f"difference at the smallest wave at most {AGAIN:.0%} of the largest difference",
        f"{lead[-1]:+.3f} of {np.abs(lead).max():.3f} ({ratio:.0%}) at {smallest * 1e3:.2g} mm",
        ratio <= AGAIN,
        "" if ratio <= AGAIN else why,
    )


def judge_surface_friction(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the steeper surface has more friction with less area (Fig. 9b)."""
    (state, predictions), *_ = solved.items()
    steep = {
        r: float(np.mean(s.sines.amplitude / s.sines.wavelength))
        for r, s in inputs.surfaces.items()
    }
    friction = {r: float(prediction.running_friction[-1]) for r, prediction in predictions.items()}
    area = {
        r: float(prediction.running_contact_fraction[-1]) for r, prediction in predictions.items()
    }
    holds = steep[ROAD] > steep[DENSE] and (
        friction[ROAD] > friction[DENSE] and area[ROAD] < area[DENSE]
    )
    return [
        Statement(
            "fig9b",
            "the surface with the larger amplitude-to-wavelength ratio has more friction in "
            "spite of less area",
            f"{ROAD} and {DENSE}, {TREAD}, {state}",
            "larger mean amplitude/wavelength goes with more friction and less area, all waves",
            "; ".join(
                f"{r}: ratio {steep[r]:.3f}, friction {friction[r]:.3f}, area {area[r]:.4f}"
                for r in (ROAD, DENSE)
            ),
            holds,
        )
    ]


def _kept(prediction: xr.Dataset) -> tuple[Array, Array]:
    """Return wavelength [m] and friction of the waves."""
    return prediction.wavelength.values, prediction.friction.values


def _friction_at(prediction: xr.Dataset, wavelength: Array) -> Array:
    """Return the friction of a wave between waves, straight over the logarithm of wavelength."""
    own, friction = _kept(prediction)
    return np.asarray(np.interp(-np.log(wavelength), -np.log(own), friction))


def _peak(prediction: xr.Dataset) -> tuple[int, float, bool]:
    """Return place and wavelength [m] of the largest friction, and if smaller waves follow."""
    own, friction = _kept(prediction)
    at = int(friction.argmax())
    return at, float(own[at]), at < own.size - 1


def _rises(prediction: xr.Dataset, peak: int) -> bool:
    """Return whether no wave from the first to the peak has clearly less than the first."""
    friction = prediction.friction.values[: peak + 1]
    return peak > 0 and bool((friction >= (1.0 - SCATTER) * friction[0]).all())


def _highest(prediction: xr.Dataset) -> float:
    return float(_kept(prediction)[1].max())
