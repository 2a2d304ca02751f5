"""How much friction one compound or road has over another, and how sure their order is.

    G = ln(mu / mu_0),    P(mu > mu_0) = T_n(G / s)

with the standard error s of G, n degrees of freedom of s and T_n the distribution of Student's t.
Errors that both share cancel in G. Two compounds slide on the same pieces of the same profiles;
what is left are the sampling of the pieces, the grids, other series of each rubber, the step from
lines to a surface and the conditions (docs/side-by-side.md). Two roads share none of the errors of
their answers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import xarray as xr

from gripscale.conditions.conditions import TREADS
from gripscale.core import Array, ComplexArray, labelled
from gripscale.half_space.line_to_map import LOAD_SENSITIVITY
from gripscale.half_space.model import CONDITION_ERRORS, DirectContact
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sampling_error import (
    FEWEST_PIECES,
    PIECE,
    SERIES,
    error_of_residuals,
    friction_residuals,
    pieces_that_carry,
)
from gripscale.half_space.sensitivity import FrictionAdjoint, relative_change
from gripscale.model import Load, OnProgress
from gripscale.questions.answer.intervals import LogError, combined, half_width
from gripscale.questions.answer.variables import of_hysteresis
from gripscale.rubber import Rubber
from gripscale.surface import Surface

ERROR_RATIO = 0.4  # error after halving the spacing over the change by it, as in `grid_sequence`
EXTREME = 3.0  # standard deviations of an admissible series from the best one
# Numbers of each pair with their meanings.
RANKED = {
    "friction_ratio": "friction over that of `over`",
    "friction_ratio_low": "low end of its 90 % interval",
    "friction_ratio_high": "high end of its 90 % interval",
    "confidence": "probability that the friction is larger than that of `over`",
}


@dataclass(frozen=True)
class FrictionRatio:
    """Logarithm of the friction of one compound or road over that of another, and its error."""

    log_ratio: float  # G [-]
    sigma: float  # standard error of G [-]; NaN if it is not known
    freedom: float = math.inf  # degrees of freedom of the standard error

    @classmethod
    def of_sources(
        cls, log_ratio: float, sampling: tuple[float, float], *others: float
    ) -> FrictionRatio:
        """Return the ratio with a sampling error and its freedom, and other errors but for NaN."""
        pairs = [sampling, *((error, math.inf) for error in others if math.isfinite(error))]
        error = combined([LogError(*map(xr.DataArray, pair)) for pair in pairs])
        return cls(log_ratio, float(error.sigma), float(error.freedom))

    @property
    def interval(self) -> tuple[float, float]:
        """Ends of the interval of the ratio that holds it 9 times in 10; NaN if not known."""
        error = LogError(xr.DataArray(self.sigma), xr.DataArray(self.freedom))
        width = math.asinh(float(half_width(error)))
        return math.exp(self.log_ratio - width), math.exp(self.log_ratio + width)

    @property
    def confidence(self) -> float:
        """Probability that the ratio is above one [-]; NaN if the error is not known."""
        from scipy.special import stdtr

        if self.log_ratio == 0.0 or not self.sigma > 0.0:
            return 0.5 if self.log_ratio == 0.0 else math.nan
        return float(stdtr(self.freedom, self.log_ratio / self.sigma))


def grid_error(log_ratio: Callable[[str], float]) -> float:
    """Return the largest error of G from the grids.

    By G of "friction_from_dissipation", of "friction" from the traction, and of "coarse_friction"
    from dissipation on the grid before the last.
    """
    total = log_ratio("friction_from_dissipation")
    changes = ERROR_RATIO * (total - log_ratio("coarse_friction")), total - log_ratio("friction")
    return max(map(abs, changes))


def coarse_friction(contact: RoughContact) -> float:
    """Return the friction on the grid before the last of the same surface, or on the last [-]."""
    same = [grid for grid in contact.grids if grid.cut_off == contact.grids[-1].cut_off]
    return same[-2:][0].friction_from_dissipation


NODES_PER_DECADE = 100  # frequencies at which ratios of moduli are taken


def series_changes(contact: RoughContact, best: Rubber) -> Array:
    """Return what each admissible series of a rubber changes in ln mu, to first order, (series,).

    `best` is the rubber at the temperature of the contact; a design multiplies its modulus. Empty
    if the error of its measurement is not known.
    """
    if best.admissible is None:
        return np.zeros(0)
    adjoint, grid = FrictionAdjoint.of(contact), contact.grid
    modulus, relative = relative_change(contact)
    omega = np.broadcast_to(contact.speed * grid.along, grid.spectrum_shape)
    weight = adjoint.weight * relative * modulus
    weight = np.where(omega < 0.0, weight.conj(), weight)  # the moduli there are conjugate
    nodes, weights = _on_few_frequencies(np.abs(omega).reshape(-1), weight.reshape(-1))
    ratios = np.log(best.admissible.complex_moduli(nodes) / best.complex_modulus(nodes))
    return np.asarray((ratios @ weights).real / contact.friction_from_dissipation)


def _on_few_frequencies(omega: Array, weight: ComplexArray) -> tuple[Array, ComplexArray]:
    """Return frequencies, the first at rest, with the weights of linear interpolation in ln w.

    Ratios of moduli are smooth: `NODES_PER_DECADE` of them keep four digits.
    """
    moving = omega > 0.0
    low, high = np.log(omega[moving].min()), np.log(omega[moving].max())
    count = 2 + int(NODES_PER_DECADE * (high - low) / math.log(10.0))
    position = (np.log(omega[moving]) - low) / (high - low or 1.0) * (count - 1)
    lower = np.minimum(position.astype(int), count - 2)
    upper = position - lower
    weights = np.zeros(count + 1, dtype=complex)
    weights[0] = weight[~moving].sum()
    np.add.at(weights, lower + 1, weight[moving] * (1.0 - upper))
    np.add.at(weights, lower + 2, weight[moving] * upper)
    return np.concatenate([[0.0], np.exp(np.linspace(low, high, count))]), weights


def series_error(changes: Array) -> float:
    """Return the standard error of changes of ln mu by each series; NaN without a series."""
    return float(np.abs(changes).max()) / EXTREME if changes.size else math.nan


def answer_with_contacts(
    model: DirectContact, rubber: Rubber, surface: Surface, load: Load, on_progress: OnProgress
) -> tuple[xr.Dataset, list[RoughContact]]:
    """Return the answer of a direct contact with the contact of each profile."""
    contacts: list[RoughContact] = []

    def keep(contact: RoughContact) -> None:
        contacts.append(contact)
        if on_progress is not None:
            on_progress(contact)

    return DirectContact.predict(model, rubber, surface, load, on_progress=keep), contacts


# Names and meanings of what a `ComparedContact` answers with beside a direct contact.
RATIO_BASIS = {
    "friction_condition_error": CONDITION_ERRORS["friction_condition_error"],
    "profile_friction_from_dissipation": "friction coefficient of a profile from the energy lost",
    "profile_friction": "friction coefficient of a profile from the contact traction",
    "profile_coarse_friction": "friction coefficient of a profile on the grid before the last",
    "carrying_pieces": "pieces of a profile that carry its load",
    "piece_residual": "friction less load of a piece of a profile, as shares in the whole",
    "series_change": "change of ln μ by an admissible series of the rubber",
}


def ratio_basis(answer: xr.Dataset) -> xr.Dataset:
    """Return what an answer, or samples, hold of `RATIO_BASIS`."""
    return answer[[name for name in RATIO_BASIS if name in answer]]


class ComparedContact(DirectContact):
    """Direct contact of one profile or map whose answer holds what a ratio needs."""

    name: ClassVar[str] = DirectContact.name

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer with `RATIO_BASIS`, as far as there is friction."""
        answer, (contact,) = answer_with_contacts(self, rubber, surface, load, on_progress)
        if not contact.has_friction:
            return answer
        piece = PIECE * float(surface.sines.wavelength[0])
        before = rubber if self.conditions is None else self.conditions.before(rubber)
        for name, dim, value in (
            ("profile_friction_from_dissipation", (), contact.friction_from_dissipation),
            ("profile_friction", (), contact.friction),
            ("profile_coarse_friction", (), coarse_friction(contact)),
            ("carrying_pieces", (), pieces_that_carry(contact, piece)),
            ("piece_residual", "piece", friction_residuals(contact, piece)),
            ("series_change", "series", series_changes(contact, before)),
        ):
            answer[name] = labelled(dim, value, "1", RATIO_BASIS[name], self.name)
        return answer


def scatter_of_pieces(residuals: Sequence[Array], carrying: Sequence[float]) -> tuple[float, float]:
    """Return the standard error of G from the pieces of each profile, and its freedom.

    `residuals` are the differences of the weighted residuals of both compounds; profiles are
    independent. NaN if the road has too few pieces.
    """
    freedom = sum(count - 1.0 for count in carrying)
    if freedom < FEWEST_PIECES - 1:
        return math.nan, math.nan
    errors = [error_of_residuals(r, count) for r, count in zip(residuals, carrying, strict=True)]
    return math.hypot(*(error for error in errors if math.isfinite(error))), freedom


NORMAL = 1.645  # half width of a 90 % interval over a standard error


def answer_ratio(over: xr.Dataset, under: xr.Dataset, friction: str) -> FrictionRatio:
    """Return the friction, a variable of both, of one answer over that of another."""
    if "piece_residual" in over:  # of compounds on one surface
        return compound_ratio(over, under)
    widths = [float(each.get(f"{friction}_half_width", math.nan)) for each in (over, under)]
    sigma = math.hypot(*(math.asinh(width) / NORMAL for width in widths))
    return FrictionRatio(math.log(float(over[friction]) / float(under[friction])), sigma)


def compound_ratio(over: xr.Dataset, under: xr.Dataset) -> FrictionRatio:
    """Return the friction of one compound over that of another on the same surface.

    Of answers with `RATIO_BASIS` over `sample`; without an error if one has none.
    """
    pair = over, under

    def log_ratio(name: str) -> float:
        high, low = (float(each[name].sum()) for each in pair)
        return math.log(high / low)

    lost = [each["profile_friction_from_dissipation"] for each in pair]
    shares = [friction / friction.sum() for friction in lost]
    over_pieces, under_pieces = (
        (share * each["piece_residual"]).transpose("sample", "piece").values
        for share, each in zip(shares, pair, strict=True)
    )
    sampling = scatter_of_pieces(
        [row[np.isfinite(row)] for row in over_pieces - under_pieces],
        np.minimum(*(each["carrying_pieces"].values for each in pair)).tolist(),
    )
    changes = [
        (share * each["series_change"]).sum("sample", skipna=False).dropna("series").values
        for share, each in zip(shares, pair, strict=True)
        if "series_change" in each
    ]
    rubbers = [series_error(change) for change in changes if change.size]
    rubbers += ratio_changes(over, under)
    area = LOAD_SENSITIVITY * abs(log_ratio("answer_contact_fraction"))
    largest = grid_error(lambda name: log_ratio(f"profile_{name}")), area
    even = [error / math.sqrt(3.0) for error in largest]
    friction = f"answer_{of_hysteresis(over, 'friction')}"
    return FrictionRatio.of_sources(log_ratio(friction), sampling, *even, *rubbers)


def ratio_changes(over: xr.Dataset, under: xr.Dataset) -> list[float]:
    """Return what each condition that is not known changes in G, by one standard error."""
    none = xr.DataArray(
        np.zeros((1, 0)), {"condition": np.array([], "U1")}, ("sample", "condition")
    )
    pair = (each.get("friction_condition_error", none).mean("sample") for each in (over, under))
    high, low = xr.align(*(errors.fillna(0.0) for errors in pair), join="outer", fill_value=0.0)
    apart = high.condition.isin([TREADS, SERIES])
    return [*high[apart].values, *low[apart].values, *(high - low)[~apart].values]
