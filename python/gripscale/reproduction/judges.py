"""The paper's statements, judged by number; `statements.csv` says what each needs to hold.

Judges yield where a statement was looked for, its number, whether it holds, and why it does not:
what shows in the inputs or the predictions. Where the inputs cannot judge it, such as waves that
end before a maximum, it holds neither way: None.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.core import Array, InputError, in_mm
from gripscale.reproduction import figures
from gripscale.reproduction.inputs import FAST, FASTEST, PAPER_FACTORS, SPEED, PaperInputs
from gripscale.rubber import springpot_modulus, styrene_butadiene

Verdict = tuple[str, str, bool | None, str]

_MODULUS_ERROR = 0.10
_POWER_LAW_DECADES, _POWER_LAW_RESIDUAL = 1.0, 0.02
_TWO_FACTORS_RESIDUAL, _ONE_FACTOR_RATIO = 0.1, 1.5
_MICRO = 0.5e-3  # macrotexture ends here [m]
_SAME_AREA, _LESS = 0.25, 0.05
_ALIKE, _AGAIN, _LOSSIER, _SCATTER = 0.2, 0.5, 0.1, 0.1
_FULL = "in full contact the loss no longer grows with pressure, and friction falls as one over it"


class Evidence(NamedTuple):
    """What a statement about a figure is judged by."""

    inputs: PaperInputs
    solved: figures.Results  # the predictions of the figure
    rest: figures.Results  # those of Fig. 5a, which 5b compares with


def _maxwell_solid(evidence: Evidence) -> Iterator[Verdict]:
    for name, compound in evidence.inputs.compounds.items():
        fit, rubber = compound.fit, compound.rubber
        why = "the rows scatter about the best series"
        if fit is not None:
            storage, loss = fit.rms_storage, fit.rms_loss
            if fit.inconsistencies:
                why = (
                    "no linear solid has the measured E' and E'' of "
                    f"{len(fit.inconsistencies)} stretches of frequency (Kramers-Kronig)"
                )
        elif rubber == styrene_butadiene():
            omega = np.geomspace(*(rubber.valid_band or (1e-2, 1e10)), 200)
            fitted, wanted = rubber.complex_modulus(omega), springpot_modulus(omega)
            ratios = fitted.real / wanted.real, fitted.imag / wanted.imag
            storage, loss = (float(np.sqrt(np.mean((ratio - 1.0) ** 2))) for ratio in ratios)
        else:  # a series that came without its moduli
            continue
        number = f"E' {storage:.1%}, E'' {loss:.1%}"
        yield name, number, max(storage, loss) <= _MODULUS_ERROR, why


def _power_law(evidence: Evidence) -> Iterator[Verdict]:
    for road in evidence.inputs.surfaces:
        fit = figures.self_affine(evidence.inputs, road)
        if isinstance(fit, InputError):
            yield road, "no fit", False, str(fit)
            continue
        decades = math.log10(fit.lag_max / fit.lag_min)
        number = (
            f"{decades:.2f} decades within {fit.residual:.3f}; H = {fit.hurst:.2f}, "
            f"xi_parallel = {fit.xi_parallel * 1e3:.2f} mm, "
            f"xi_perpendicular = {fit.xi_perpendicular * 1e3:.2f} mm"
        )
        holds = decades >= _POWER_LAW_DECADES and fit.residual <= _POWER_LAW_RESIDUAL
        yield road, number, holds, "the surface is not self-affine over that much"


def _two_factors(evidence: Evidence) -> Iterator[Verdict]:
    paper = math.log(PAPER_FACTORS[0][1]) / math.log(PAPER_FACTORS[0][0])
    for road, surface in evidence.inputs.surfaces.items():
        two, single = (s.residual or math.nan for s in figures.single_factor(evidence.inputs, road))
        stack = surface.sines
        exponent = math.log(stack.s_amplitude or 1.0) / math.log(stack.s_wavelength or math.e)
        why = (
            f"amplitudes fall as wavelength^{exponent:.2f} on this road, so one factor "
            f"(exponent 1) is nearly right; on the paper's asphalt the exponent is {paper:.2f}"
        )
        if two > _TWO_FACTORS_RESIDUAL:
            why = "waves of constant factors do not follow C_z of this surface"
        number = f"two: {two:.3f}, one: {single:.3f} decades ({single / two:.2f} times)"
        yield road, number, two <= _TWO_FACTORS_RESIDUAL and single >= _ONE_FACTOR_RATIO * two, why


def _order_of_pairs(evidence: Evidence) -> Iterator[Verdict]:
    for road, stacks in evidence.inputs.stacks.items():
        worst, *_, last = evidence.inputs.worst_fit(road), *stacks
        residuals = ", ".join(f"{name}: {s.residual:.3f}" for name, s in stacks.items())
        yield road, f"{residuals} decades", worst == last, f"{worst} fits worst"


# Contact area, Figs 5 to 7.


def _at(evidence: Evidence, road: str) -> str:
    """Return where a chain for pairs of factors was solved: at rest, or sliding as in Fig. 5b."""
    first, *_ = evidence.solved[road].values()
    return f"{road}, {evidence.inputs.rubber}, {figures.speed_name(float(first.nominal_speed))}"


def _same_way(evidence: Evidence) -> Iterator[Verdict]:
    for road, predictions in evidence.solved.items():
        worst = evidence.inputs.worst_fit(road)
        first, last = (max(float(p.wavelength[i]) for p in predictions.values()) for i in (0, -1))
        x = np.geomspace(first, last, 40)
        curves = {
            name: np.exp(_between(p, np.log(p.running_contact_fraction), x))
            for name, p in predictions.items()
        }
        others = _spread([curve for name, curve in curves.items() if name != worst])
        steepest = {name: float(p.slope.max()) for name, p in predictions.items()}
        why = (
            f"without {worst}, which fits C_z worst, the others are {others:.0%} apart; its waves "
            f"reach a slope of {steepest.pop(worst):.1f}, theirs of {max(steepest.values()):.1f}"
        )
        spread = _spread(list(curves.values()))
        number = f"at most {spread:.0%} apart down to {x[-1] * 1e3:.2g} mm"
        yield _at(evidence, road), number, spread <= _SAME_AREA, why


def _between(prediction: xr.Dataset, values: xr.DataArray, wavelength: Array) -> Array:
    """Return values between the waves, straight over the logarithm of the wavelength."""
    return np.interp(-np.log(wavelength), -np.log(prediction.wavelength), values)


def _spread(curves: Sequence[Array]) -> float:
    """Return how far curves are apart where they are furthest, relative to the lowest."""
    return float((np.max(curves, axis=0) / np.min(curves, axis=0)).max() - 1.0)


def _settles(evidence: Evidence) -> Iterator[Verdict]:
    for road, predictions in evidence.solved.items():
        rates, unsettled = [], []
        for name, prediction in predictions.items():
            slope, decades, more = _level(prediction)
            end = f"level {more:.1f} decades on" if more < math.inf else "never level"
            rates.append(f"{name}: {slope[0]:.2f} to {slope[-1]:.2f}, {end}")
            if more > decades:
                stack = evidence.inputs.stacks[road][name]
                rise = (stack.s_wavelength or math.nan) / (stack.s_amplitude or math.nan)
                unsettled.append(f"{rise:.2f} times in {name}, of {decades:.1f} decades")
        why = f"amplitude/wavelength rises from each wave to the next, {'; '.join(unsettled)}"
        yield _at(evidence, road), "; ".join(rates), not unsettled, why


def _level(prediction: xr.Dataset) -> tuple[Array, float, float]:
    """Return slopes, decades of wavelength, and decades after which the slope is zero.

    The slope goes on as straight over ln(wavelength) as from the first to the last, each of which
    belongs to the middle between two waves.
    """
    x = np.log10(prediction.wavelength.values)
    slope = np.diff(np.log10(prediction.running_contact_fraction.values)) / np.diff(x)
    middle = 0.5 * (x[1:] + x[:-1])
    fall = float(slope[0] - slope[-1]) / float(middle[0] - middle[-1])
    more = float(slope[-1]) / fall - float(middle[-1] - x[-1]) if fall > 0.0 else math.inf
    return slope, float(x[0] - x[-1]), more


def _less_in_motion(evidence: Evidence) -> Iterator[Verdict]:
    for road, lines in evidence.solved.items():
        rest = evidence.rest[road]
        ratios = [_ratio(rest[name], moving) for name, moving in lines.items()]
        stiffer = [(moving.modulus / rest[name].modulus).values for name, moving in lines.items()]
        largest = max(float(each.max()) for each in ratios)
        steps = ", ".join(f"{each[0]:.2f} to {each[-1]:.2f}" for each in ratios)
        why = (
            f"|E*| in motion is {min(each[0] for each in stiffer):.2f} times "
            f"that at rest at the first wave, {min(each[-1] for each in stiffer):.2f} at the last"
        )
        holds = largest < 1.0 and all(each[-1] < each[0] for each in ratios)
        number = f"at most {largest:.2f}; first to last: {steps}"
        yield _at(evidence, road), number, holds, why


def _ratio(rest: xr.Dataset, moving: xr.Dataset) -> Array:
    """Return running area in motion over that at rest, for the waves both have."""
    return np.asarray(moving.running_contact_fraction / rest.running_contact_fraction)


def _falls_with_speed(evidence: Evidence) -> Iterator[Verdict]:
    rubber = evidence.inputs.rubber
    predictions = [p for name, p in evidence.solved[rubber].items() if name != figures.STATIC]
    ratios = [_ratio(slow, fast) for slow, fast in pairwise(predictions)]
    grows = [f"{float(ratio.max()):.2f}" for ratio in ratios if (ratio >= 1.0).any()]
    rest = _ratio(predictions[0], predictions[-1])
    why = "the modulus of this rubber rises as much between the speeds at large waves"
    if grows:
        why = (
            f"from a speed to the next the area is up to {', '.join(grows)} times as large: the "
            "modulus of this rubber does not rise with frequency there"
        )
    length = predictions[0].wavelength.values
    where = f"{evidence.inputs.surface}, {rubber}, {len(predictions)} speeds over four decades"
    ends = [f"{rest[i]:.2f} at {length[: rest.size][i] * 1e3:.3g} mm" for i in (0, -1)]
    yield where, f"left: {', '.join(ends)}", not grows and bool(rest[-1] < rest[0]), why


def _less_if_stiffer(evidence: Evidence) -> Iterator[Verdict]:
    ((panel, lines),) = evidence.solved.items()
    (a, stiff), (b, soft) = lines.items()
    if float(np.log(stiff.modulus / soft.modulus).mean()) < 0.0:
        (a, stiff), (b, soft) = (b, soft), (a, stiff)
    modulus = (stiff.modulus / soft.modulus).values
    area = _ratio(soft, stiff)
    holds = bool((area < 1.0).all()) if (modulus > 1.0).all() else None
    why = "neither compound is the stiffer one at every wave"
    if holds is False:
        why = (
            f"|E*| differs by {modulus.min():.2f} times only, loss factors "
            f"are up to {float((soft.loss_factor / stiff.loss_factor).max()):.2f} times as large"
        )
    where = f"{evidence.inputs.surface}, {a} over {b}, {panel.rsplit(', ', 1)[-1]}"
    number = f"|E*| ratio {modulus.min():.1f} to {modulus.max():.1f}, "
    yield where, f"{number}area ratio {area.min():.2f} to {area.max():.2f}", holds, why


def _alike_with_micro(evidence: Evidence) -> Iterator[Verdict]:
    ((state, predictions),) = evidence.solved.items()
    a, b = predictions
    macro, whole = (
        abs(math.log(_down_to(predictions[b], end) / _down_to(predictions[a], end)))
        for end in (_MICRO, 0.0)
    )
    waves = [evidence.inputs.surfaces[road].sines for road in (a, b)]
    finest = max(float(each.wavelength[-1]) for each in waves)
    holds = whole < (1.0 - _LESS) * macro if finest < _MICRO else None
    why = f"the waves end at {finest * 1e3:.2g} mm: no micro scale"
    if holds is False:
        ends = " and ".join(f"{each.amplitude[-1] / each.wavelength[-1]:.3f}" for each in waves)
        why = (
            f"areas at macro scale differ by {math.expm1(macro):.0%}, and "
            f"amplitude/wavelength of the smallest waves is {ends}"
        )
    number = f"{macro:.2f} at macro scale, {whole:.2f} of all waves"
    yield f"{a} and {b}, {evidence.inputs.rubber}, {state}", number, holds, why


def _down_to(prediction: xr.Dataset, smallest: float) -> float:
    """Return the running area of the waves longer than `smallest` [m]."""
    kept = prediction.wavelength.values >= smallest * (1.0 - 1e-9)
    return float(prediction.running_contact_fraction.values[kept][-1])


# Friction, Figs 8 and 9.


def _worst_fit_departs(evidence: Evidence) -> Iterator[Verdict]:
    for road, predictions in evidence.solved.items():
        name = evidence.inputs.worst_fit(road)
        worst, good = predictions[name], [p for n, p in predictions.items() if n != name]
        ends = max(float(prediction.wavelength[-1]) for prediction in good)
        x = worst.wavelength.values[worst.wavelength >= ends * (1.0 - 1e-9)]
        others = np.array([_between(prediction, prediction.friction, x) for prediction in good])
        away = worst.friction.values[: x.size] / others.mean(axis=0) - 1.0
        apart = others.max(axis=0) / others.min(axis=0) - 1.0
        second = min(1, x.size - 1)
        departs = abs(away[-1]) > max(_ALIKE, 2.0 * apart[-1])
        stacks = evidence.inputs.stacks[road].items()
        yield (
            _at(evidence, road),
            f"{name}: {away[second]:+.0%} at {x[second] * 1e3:.2g} mm, {away[-1]:+.0%} at "
            f"{x[-1] * 1e3:.2g} mm, where the others are {apart[-1]:.0%} apart",
            bool(abs(away[second]) <= _ALIKE and departs) if x.size > 1 else None,
            "residuals of C_z are " + ", ".join(f"{n}: {s.residual:.3f}" for n, s in stacks),
        )


def _rises(evidence: Evidence) -> Iterator[Verdict]:
    for rubber, predictions in evidence.solved.items():
        lower, at_once = [], []
        for name, p in predictions.items():
            friction, fraction = p.friction.values, p.contact_fraction.values
            peak = int(friction.argmax())
            at_once += [f"at {name} the first wave has the most"] if peak == 0 else []
            lower += [
                f"at {name} the wave of {float(p.wavelength[i]) * 1e3:.3g} mm has "
                f"{friction[i] / friction[0]:.0%} of the friction of the first, with "
                f"{float(p.loss_factor[i] / p.loss_factor[0]):.2f} times the "
                f"loss factor, and touches {fraction[i]:.0%} of its length"
                + (f": {_FULL}" if fraction[i] > 1.0 - 1e-6 else "")
                for i in np.flatnonzero(friction[:peak] < (1.0 - _SCATTER) * friction[0])
            ]
        number = ", ".join(
            f"{name}: {float(p.friction[0]):.3f} to {float(p.friction.max()):.3f}"
            for name, p in predictions.items()
        )
        why = "; ".join(at_once + lower)
        yield f"{evidence.inputs.surface}, {rubber}", number, not why, why


def _sooner(evidence: Evidence) -> Iterator[Verdict]:
    for rubber, predictions in evidence.solved.items():
        peaks = {name: int(p.friction.values.argmax()) for name, p in predictions.items()}
        wavelengths = {name: float(p.wavelength[peaks[name]]) for name, p in predictions.items()}
        inside = {name for name, p in predictions.items() if peaks[name] < p.sizes["scale"] - 1}
        ordered = all(later >= earlier for earlier, later in pairwise(wavelengths.values()))
        several = len({wavelengths[name] for name in inside}) >= 2
        judgeable = sum(map(_reached, predictions.values())) >= 2
        holds = ordered and several if judgeable else None
        number = "maximum at " + ", ".join(
            f"{value * 1e3:.3g} mm ({name}{'' if name in inside else ', the smallest'})"
            for name, value in wavelengths.items()
        )
        why = _lossiest(rubber, FASTEST, predictions, evidence.inputs)
        yield f"{evidence.inputs.surface}, {rubber}", number, holds, why


def _lossiest(rubber: str, speed: float, predictions: figures.Lines, inputs: PaperInputs) -> str:
    """Return which wave excites the largest loss factor of a rubber at a speed, in words."""
    omega = np.geomspace(1e-2, 1e12, 2000)
    highest = float(omega[int(inputs.compounds[rubber].rubber.loss_factor(omega).argmax())])
    smallest = min(float(prediction.wavelength[-1]) for prediction in predictions.values())
    return (
        f"the loss factor of {rubber} is largest at {highest:.2g} rad/s, which at {speed:g} m/s "
        f"waves of {in_mm(2.0 * math.pi * speed / highest, 2)} excite; the smallest wave here has "
        f"{in_mm(smallest, 3)}"
    )


class Pair(NamedTuple):
    """Two compounds at one speed, the second against the first, wave by wave."""

    names: tuple[str, str]
    lines: figures.Lines
    speed: float
    where: str
    lead: Array  # in friction
    loss_ratio: Array


def _pairs(evidence: Evidence) -> Iterator[Pair]:
    for names, speed in product(evidence.inputs.pairs, (SPEED, FAST)):
        lines = evidence.solved[figures.pair_name(names, speed)]
        first, second = (lines[name] for name in names)
        where = f"{figures.speed_name(speed)}, {names[1]} against {names[0]}"
        lead = (second.friction - first.friction).values
        ratio = (second.loss_factor / first.loss_factor).values
        yield Pair(names, lines, speed, f"{evidence.inputs.surface}, {where}", lead, ratio)


def _alike_at_large_waves(evidence: Evidence) -> Iterator[Verdict]:
    for pair in _pairs(evidence):
        lead, widest = abs(pair.lead[0]), float(np.abs(pair.lead).max())
        first, second = (pair.lines[name].isel(scale=0) for name in pair.names)
        why = (
            f"at the largest wave {pair.names[1]} has {pair.loss_ratio[0]:.2f} times the loss "
            f"factor and {float(second.modulus / first.modulus):.2f} times the modulus of "
            f"{pair.names[0]}, and touches {float(second.contact_fraction):.3f} of it in place of "
            f"{float(first.contact_fraction):.3f}"
        )
        number = f"{pair.lead[0]:+.3f} of {widest:.3f} ({lead / widest:.1%})"
        yield pair.where, number, bool(lead <= _ALIKE * widest), why


def _lossier_ahead(evidence: Evidence) -> Iterator[Verdict]:
    for pair in _pairs(evidence):
        lead, ratio = pair.lead[1:], pair.loss_ratio[1:]
        differs = np.abs(np.log(ratio)) > math.log(1.0 + _LOSSIER)
        ahead = np.sign(lead) == np.sign(np.log(ratio))
        length = pair.lines[pair.names[0]].wavelength.values[1:]
        why = "; ".join(
            f"at {length[i] * 1e3:.3g} mm the area outweighs {ratio[i]:.2f} times the loss factor"
            for i in np.flatnonzero(differs & ~ahead)
        )
        number = (
            f"{int((ahead & differs).sum())} of {int(differs.sum())} waves; loss factor ratio "
            f"{ratio.min():.2f} to {ratio.max():.2f}, lead {lead.min():+.3f} to {lead.max():+.3f}"
        )
        yield pair.where, number, not why, why


def _together_again(evidence: Evidence) -> Iterator[Verdict]:
    for pair in _pairs(evidence):
        lead, ratio, (first, second) = pair.lead, pair.loss_ratio, pair.names
        lossier = second if float(np.log(ratio).mean()) > 0.0 else first
        rest = float(abs(lead[-1]) / np.abs(lead).max())
        length = pair.lines[first].wavelength.values * 1e3
        crossed = np.flatnonzero(np.diff(np.sign(lead[1:]))) + 1
        holds: bool | None = rest <= _AGAIN
        why = f"loss factors are {ratio[-1]:.2f} times apart at the last wave"
        if not _reached(pair.lines[lossier]):
            holds, why = None, _lossiest(lossier, pair.speed, pair.lines, evidence.inputs)
        elif crossed.size:
            at = crossed[-1]
            why = (
                f"they meet between {length[at]:.2g} and {length[at + 1]:.2g} mm and cross, at the "
                f"last wave {second} has {ratio[-1]:.2f} times the loss factor of {first}"
            )
        number = f"{lead[-1]:+.3f} of {np.abs(lead).max():.3f} ({rest:.0%})"
        yield pair.where, f"{number} at {length[lead.size - 1]:.2g} mm", holds, why


def _more_if_steeper(evidence: Evidence) -> Iterator[Verdict]:
    ((state, predictions),) = evidence.solved.items()
    stacks = {road: evidence.inputs.surfaces[road].sines for road in predictions}
    ratio = {road: float(np.mean(s.amplitude / s.wavelength)) for road, s in stacks.items()}
    flat, steep = sorted(ratio, key=lambda road: ratio[road])
    first = min(float(prediction.wavelength[0]) for prediction in predictions.values())
    last = max(float(prediction.wavelength[-1]) for prediction in predictions.values())
    x = np.geomspace(first, last, 40)
    friction = {road: _between(p, p.friction, x) for road, p in predictions.items()}
    lead = friction[steep] / friction[flat]
    whole = {road: float(p.running_friction[-1]) for road, p in predictions.items()}
    area = {road: float(p.running_contact_fraction[-1]) for road, p in predictions.items()}
    sums = "; ".join(
        f"{r}: ratio {ratio[r]:.3f}, sum {whole[r]:.3f}, area {area[r]:.4f}" for r in (steep, flat)
    )
    holds = whole[steep] > whole[flat] and area[steep] < area[flat] and bool((lead > 1.0).all())
    number = f"friction of a wave {lead.min():.2f} to {lead.max():.2f} times as large; {sums}"
    why = f"mean amplitude/wavelength is {ratio[steep] / ratio[flat]:.2f} times as large"
    yield f"{steep} and {flat}, {evidence.inputs.rubber}, {state}", number, holds, why


def _reached(prediction: xr.Dataset) -> bool:
    """Return whether the loss factor has its maximum before the smallest wave."""
    return int(prediction.loss_factor.values.argmax()) < prediction.sizes["scale"] - 1
