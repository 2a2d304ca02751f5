"""Statements about friction (Figs 8 and 9)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.core.units import in_mm
from reproduction.inputs import FAST, FASTEST, SPEED, Inputs
from reproduction.panels import Solved, pair_name
from reproduction.statement import Statement

Array = NDArray[np.float64]
Lines = Mapping[str, xr.Dataset]

ALIKE = 0.2
AGAIN = 0.5
LOSSIER = 0.1
SCATTER = 0.1
FULL = ": in full contact the loss no longer grows with pressure, and friction falls as one over it"


def judge_factors_friction(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the worst fit has its own friction at small waves only (Fig. 8a)."""
    return [_departure(road, predictions, inputs) for road, predictions in solved.items()]


def _departure(road: str, predictions: Lines, inputs: Inputs) -> Statement:
    worst = inputs.worst_fit(road)
    good = [prediction for name, prediction in predictions.items() if name != worst]
    own, friction = _kept(predictions[worst])
    shared = own >= max(_kept(prediction)[0][-1] for prediction in good) * (1.0 - 1e-9)
    x = own[shared]
    others = np.array([_friction_at(prediction, x) for prediction in good])
    away = friction[shared] / others.mean(axis=0) - 1.0
    apart = others.max(axis=0) / others.min(axis=0) - 1.0
    second = min(1, x.size - 1)
    departs = abs(away[-1]) > max(ALIKE, 2.0 * apart[-1])
    holds = bool(abs(away[second]) <= ALIKE and departs) if x.size > 1 else None
    residuals = {name: stack.residual or math.nan for name, stack in inputs.stacks[road].items()}
    why = "residuals of C_z are " + ", ".join(
        f"{name}: {value:.3f}" for name, value in residuals.items()
    )
    return Statement(
        "fig8a",
        "friction of each wave agrees for large waves; the worst fit of C_z departs at small ones",
        f"{road}, {inputs.rubber}, {SPEED * 1e3:g} mm/s",
        f"the worst fit within {ALIKE:.0%} of the mean of the others at its second wave, further "
        "away at the smallest it shares with them, and there more than twice as far as they are "
        "from each other",
        f"{worst}: {away[second]:+.0%} at {x[second] * 1e3:.2g} mm, {away[-1]:+.0%} at "
        f"{x[-1] * 1e3:.2g} mm, where the others are {apart[-1]:.0%} apart",
        holds,
        why,
    )


def judge_speed_friction(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether friction rises to a maximum, sooner the faster (Fig. 8b)."""
    return [
        statement
        for rubber, predictions in solved.items()
        for statement in (_rises(rubber, predictions, inputs), _sooner(rubber, predictions, inputs))
    ]


def _rises(rubber: str, predictions: Lines, inputs: Inputs) -> Statement:
    """Judge whether no wave from the first to the maximum has clearly less than the first."""
    lower, at_once = [], []
    for name, prediction in predictions.items():
        peak, friction = _peak(prediction), prediction.friction.values
        at_once += [name] if peak == 0 else []
        lower += [
            f"at {name} the wave of {prediction.wavelength.values[i] * 1e3:.3g} mm has "
            f"{friction[i] / friction[0]:.0%} of the friction of the first, with "
            f"{prediction.loss_factor.values[i] / prediction.loss_factor.values[0]:.2f} times the "
            f"loss factor, and touches {prediction.contact_fraction.values[i]:.0%} of its length"
            + (FULL if prediction.contact_fraction.values[i] > 1.0 - 1e-6 else "")
            for i in np.flatnonzero(friction[:peak] < (1.0 - SCATTER) * friction[0])
        ]
    why = [f"at {name} the first wave has the most" for name in at_once] + lower
    return Statement(
        "fig8b",
        "at each speed friction rises towards smaller waves",
        f"{inputs.surface}, {rubber}",
        f"up to the maximum every wave has more friction than the first (within {SCATTER:.0%}), "
        "and the maximum is not the first, at every speed",
        ", ".join(
            f"{name}: {float(p.friction[0]):.3f} to {float(p.friction.max()):.3f}"
            for name, p in predictions.items()
        ),
        not (lower or at_once),
        "; ".join(why),
    )


def _sooner(rubber: str, predictions: Lines, inputs: Inputs) -> Statement:
    peaks = {name: _peak(prediction) for name, prediction in predictions.items()}
    wavelengths = {name: float(p.wavelength[peaks[name]]) for name, p in predictions.items()}
    inside = {name for name, p in predictions.items() if peaks[name] < p.sizes["scale"] - 1}
    ordered = all(later >= sooner for sooner, later in pairwise(wavelengths.values()))
    holds: bool | None = ordered and len({wavelengths[name] for name in inside}) >= 2
    if sum(_reached(prediction) for prediction in predictions.values()) < 2:
        holds = None
    return Statement(
        "fig8b",
        "the higher the speed, the sooner friction reaches a maximum; then it falls",
        f"{inputs.surface}, {rubber}",
        "the wavelength of the maximum never falls with speed, and at two speeds or more lies at "
        "different waves with smaller ones after it; judged where the loss factor, which friction "
        "follows in partial contact, has its maximum before the smallest wave at two speeds",
        "maximum at "
        + ", ".join(
            f"{value * 1e3:.3g} mm ({name}{'' if name in inside else ', the smallest'})"
            for name, value in wavelengths.items()
        ),
        holds,
        _lossiest(rubber, FASTEST, predictions, inputs),
    )


def _lossiest(rubber: str, speed: float, predictions: Lines, inputs: Inputs) -> str:
    """Return which wave excites the largest loss factor of a rubber at a speed, in words."""
    omega = np.geomspace(1e-2, 1e12, 2000)
    highest = float(omega[int(inputs.compounds[rubber].rubber.loss_factor(omega).argmax())])
    smallest = min(float(prediction.wavelength[-1]) for prediction in predictions.values())
    return (
        f"the loss factor of {rubber} is largest at {highest:.2g} rad/s, which at {speed:g} m/s "
        f"waves of {in_mm(2.0 * math.pi * speed / highest, 2)} excite; the smallest wave here has "
        f"{in_mm(smallest, 3)}"
    )


def judge_compounds(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge the friction of the compounds along the waves (Fig. 9a)."""
    statements = []
    for pair in inputs.pairs:
        for speed in (SPEED, FAST):
            predictions = solved[pair_name(pair, speed)]
            where = f"{inputs.surface}, {speed * 1e3:g} mm/s, {pair[1]} against {pair[0]}"
            statements.append(_alike(where, pair, predictions))
            statements.append(_lossier(where, pair, predictions))
            statements.append(_again(where, pair, speed, predictions, inputs))
    return statements


def _lead(pair: tuple[str, str], predictions: Lines) -> Array:
    """Return by how much the second compound is ahead at each wave."""
    return np.asarray(predictions[pair[1]].friction - predictions[pair[0]].friction)


def _loss_ratio(pair: tuple[str, str], predictions: Lines) -> Array:
    return np.asarray(predictions[pair[1]].loss_factor / predictions[pair[0]].loss_factor)


def _alike(where: str, pair: tuple[str, str], predictions: Lines) -> Statement:
    lead = _lead(pair, predictions)
    widest = float(np.abs(lead).max())
    holds = bool(abs(lead[0]) <= ALIKE * widest)
    stiffer = float(predictions[pair[1]].modulus[0] / predictions[pair[0]].modulus[0])
    touched = [float(predictions[name].contact_fraction[0]) for name in pair]
    why = (
        f"at the largest wave {pair[1]} has "
        f"{_loss_ratio(pair, predictions)[0]:.2f} times the loss factor and {stiffer:.2f} times "
        f"the modulus of {pair[0]}, and touches {touched[1]:.3f} of it in place of "
        f"{touched[0]:.3f}"
    )
    return Statement(
        "fig9a",
        "compounds are alike at the largest wave",
        where,
        f"difference in friction there at most {ALIKE:.0%} of the largest difference",
        f"{lead[0]:+.3f} of {widest:.3f} ({abs(lead[0]) / widest:.1%})",
        holds,
        why,
    )


def _lossier(where: str, pair: tuple[str, str], predictions: Lines) -> Statement:
    lead, ratio = _lead(pair, predictions)[1:], _loss_ratio(pair, predictions)[1:]
    told = np.abs(np.log(ratio)) > math.log(1.0 + LOSSIER)
    ahead = np.sign(lead) == np.sign(np.log(ratio))
    holds = bool((ahead | ~told).all())
    length = predictions[pair[0]].wavelength.values[1:]
    why = "; ".join(
        f"at {length[i] * 1e3:.3g} mm the area outweighs {ratio[i]:.2f} times the loss factor"
        for i in np.flatnonzero(told & ~ahead)
    )
    return Statement(
        "fig9a",
        "the lossier compound is ahead up to the wavelength of maximum E''",
        where,
        "more friction for the larger loss factor at every further wave at which loss factors "
        f"differ by more than {LOSSIER:.0%} (by less, the contact area decides)",
        f"{int((ahead & told).sum())} of {int(told.sum())} waves; loss factor ratio "
        f"{ratio.min():.2f} to {ratio.max():.2f}, lead {lead.min():+.3f} to {lead.max():+.3f}",
        holds,
        why,
    )


def _again(
    where: str, pair: tuple[str, str], speed: float, predictions: Lines, inputs: Inputs
) -> Statement:
    lead, ratio = _lead(pair, predictions), _loss_ratio(pair, predictions)
    lossier = pair[1] if float(np.log(ratio).mean()) > 0.0 else pair[0]
    left = float(abs(lead[-1]) / np.abs(lead).max())
    length = predictions[pair[0]].wavelength.values[: lead.size] * 1e3
    crossed = np.flatnonzero(np.diff(np.sign(lead[1:]))) + 1
    holds: bool | None = left <= AGAIN
    if not _reached(predictions[lossier]):
        holds, why = None, _lossiest(lossier, speed, predictions, inputs)
    elif crossed.size:
        at = crossed[-1]
        why = (
            f"they meet between {length[at]:.2g} and {length[at + 1]:.2g} mm and "
            f"cross, at the last wave {pair[1]} has {ratio[-1]:.2f} times the loss factor of "
            f"{pair[0]}"
        )
    else:
        why = f"loss factors are {ratio[-1]:.2f} times apart at the last wave"
    return Statement(
        "fig9a",
        "beyond the wavelength of maximum E'' the compounds come together again",
        where,
        f"difference at the smallest wave at most {AGAIN:.0%} of the largest difference; judged "
        "where the loss factor of the lossier compound, which friction follows in partial contact, "
        "has its maximum before the smallest wave",
        f"{lead[-1]:+.3f} of {np.abs(lead).max():.3f} ({left:.0%}) at {length[-1]:.2g} mm",
        holds,
        why,
    )


def judge_surface_friction(solved: Solved, inputs: Inputs) -> list[Statement]:
    """Judge whether the steeper surface has more friction with less area (Fig. 9b)."""
    ((state, predictions),) = solved.items()
    stacks = {road: inputs.surfaces[road].sines for road in predictions}
    ratio = {road: float(np.mean(s.amplitude / s.wavelength)) for road, s in stacks.items()}
    flat, steep = sorted(ratio, key=lambda road: ratio[road])
    first, last = (
        choose(float(prediction.wavelength[at]) for prediction in predictions.values())
        for choose, at in ((min, 0), (max, -1))
    )
    x = np.geomspace(first, last, 40)
    lead = _friction_at(predictions[steep], x) / _friction_at(predictions[flat], x)
    whole = {road: float(p.running_friction[-1]) for road, p in predictions.items()}
    area = {road: float(p.running_contact_fraction[-1]) for road, p in predictions.items()}
    holds = whole[steep] > whole[flat] and area[steep] < area[flat] and bool((lead > 1.0).all())
    return [
        Statement(
            "fig9b",
            "the surface with the larger amplitude-to-wavelength ratio has more friction in "
            "spite of less area",
            f"{steep} and {flat}, {inputs.rubber}, {state}",
            "larger mean amplitude/wavelength goes with more friction at every wavelength both "
            "have, and in the sum, and with less area of all waves",
            f"friction of a wave {lead.min():.2f} to {lead.max():.2f} times as large; "
            + "; ".join(
                f"{r}: ratio {ratio[r]:.3f}, sum {whole[r]:.3f}, area {area[r]:.4f}"
                for r in (steep, flat)
            ),
            holds,
            f"mean amplitude/wavelength is {ratio[steep] / ratio[flat]:.2f} times as large",
        )
    ]


def _kept(prediction: xr.Dataset) -> tuple[Array, Array]:
    """Return wavelength [m] and friction of the waves."""
    return prediction.wavelength.values, prediction.friction.values


def _friction_at(prediction: xr.Dataset, wavelength: Array) -> Array:
    """Return the friction of a wave between waves, straight over the logarithm of wavelength."""
    own, friction = _kept(prediction)
    return np.asarray(np.interp(-np.log(wavelength), -np.log(own), friction))


def _peak(prediction: xr.Dataset) -> int:
    """Return the place of the largest friction among the waves."""
    return int(prediction.friction.values.argmax())


def _reached(prediction: xr.Dataset) -> bool:
    """Return whether the loss factor has its maximum before the smallest wave."""
    return int(prediction.loss_factor.values.argmax()) < prediction.sizes["scale"] - 1
