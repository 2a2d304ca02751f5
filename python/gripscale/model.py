"""What every model of contact and friction looks like: a rubber, a surface and a load, answered.

A model may be the chain over sine waves, the direct contact of a whole surface, or a theory. All
answer with the same names for the same things, so that whatever compares, varies, draws or reports
takes any of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol, runtime_checkable

import numpy as np

from gripscale import checks
from gripscale.cut_off_exponents import NOT_CONVERGED, NOT_TOLD, CutOffExponents, of_mean
from gripscale.rubber.extrapolation import UNKNOWN, Extrapolation, of_sum

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.rubber import Rubber
    from gripscale.surface.prepared import PreparedSurface

LoadTime = Literal["passage"] | float


@dataclass(frozen=True)
class NominalLoad:
    """The load on the whole surface.

    Parameters
    ----------
    pressure : float
        Nominal pressure [Pa], above zero.
    speed : float
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    footprint : float
        Length of the nominal contact [m].
    load_time : float or "passage"
        How long a place of the rubber is loaded: while the contact above it passes, or a time [s],
        which may be infinite.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    pressure: float
    speed: float
    footprint: float
    load_time: LoadTime = "passage"

    def __post_init__(self) -> None:
        checked: dict[str, Any] = {
            "pressure": checks.positive("pressure", self.pressure, unit="Pa"),
            "speed": checks.not_negative("speed", self.speed, unit="m/s"),
            "footprint": checks.positive("footprint", self.footprint, unit="m"),
        }
        if isinstance(self.load_time, str):
            checks.one_of("load_time", self.load_time, ["passage"])
        else:
            time = checks.positive("load_time", self.load_time, unit="s", infinite=True)
            checked["load_time"] = time
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def time_under(self, contact_length: float) -> float:
        """Return for how long what slides under a contact so long [m] is loaded [s]."""
        if self.speed == 0.0:
            return math.inf
        if isinstance(self.load_time, str):
            return contact_length / self.speed
        return self.load_time


@runtime_checkable
class Model(Protocol):
    """Predicts contact and friction.

    A frozen dataclass whose fields decide its answers together with the inputs: studies name their
    results by them.
    """

    @property
    def name(self) -> str:
        """Word for it in results, tables and case files."""

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return `surface` with nothing in it that the answer does not depend on."""

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer: a Dataset with `TOTALS` and `prediction_status`, and what it rests on.

        A part that did not converge makes the totals NaN and is named in the status.
        `on_progress` is called with what is known so far, where the model goes step by step.
        """


TOTALS = {
    "total_contact_fraction": "real over nominal contact area",
    "total_friction": "friction coefficient",
    "total_friction_from_dissipation": "friction coefficient from the energy lost in the rubber",
}
"""Names and meanings of the numbers every model answers with."""

FRICTION_OUTSIDE_BAND = "total_friction_outside_band"
OUTSIDE_BAND = {
    FRICTION_OUTSIDE_BAND: (
        "share",
        "share of the friction that rests on the rubber outside the measured frequencies",
    ),
    "total_decades_below_band": (
        "below",
        "decades by which excitation goes below the measured frequencies",
    ),
    "total_decades_above_band": (
        "above",
        "decades by which excitation goes above the measured frequencies",
    ),
}
"""Names of what every model tells of the rubber beyond its measured frequencies: attribute of
`Extrapolation`, and meaning."""


def extrapolation_of(data: xr.Dataset) -> Extrapolation:
    """Return what an answer tells of the rubber beyond its measured frequencies.

    Unknown of a file of an older version.
    """
    if not set(OUTSIDE_BAND) <= set(data.data_vars):
        return UNKNOWN
    return Extrapolation(**{part: float(data[name]) for name, (part, _) in OUTSIDE_BAND.items()})


FRICTION_CUT_OFF_EXPONENT = "total_friction_cut_off_exponent"
CUT_OFF_EXPONENTS = {
    "total_contact_fraction_cut_off_exponent": (
        "contact_fraction",
        "d ln(real contact area)/d ln(cut-off length), over the last octave",
    ),
    FRICTION_CUT_OFF_EXPONENT: (
        "friction",
        "d ln(friction coefficient)/d ln(cut-off length), over the last octave",
    ),
}
"""Names of what every model tells of the choice of the smallest wavelength: attribute of
`CutOffExponents`, and meaning."""

WHY_NO_EXPONENT = "cut_off_exponent_missing"
"""Name of the text that says why one of them is not known; empty if both are."""


_EXPONENTS_OF = ("contact_fraction", "friction_from_dissipation")


def cut_off_exponents_of(data: xr.Dataset) -> CutOffExponents:
    """Return what an answer tells of its cut-off; not told in a file of an older version."""
    if not {*CUT_OFF_EXPONENTS, WHY_NO_EXPONENT} <= set(data.data_vars):
        return NOT_TOLD
    numbers = {part: float(data[name]) for name, (part, _) in CUT_OFF_EXPONENTS.items()}
    return CutOffExponents(**numbers, why_not=str(data[WHY_NO_EXPONENT].item()))


ADHESIVE_FRICTION = "total_adhesive_friction"
"""Name of the area term's friction, where one was asked for."""


def with_adhesive(data: xr.Dataset) -> xr.DataArray | None:
    """Return hysteresis and area term together, or None where no area term was asked for."""
    return data["total_friction"] + data[ADHESIVE_FRICTION] if ADHESIVE_FRICTION in data else None


def with_area_term(data: xr.Dataset, adhesive_friction: float) -> xr.Dataset:
    """Return an answer with the friction of the area term [-], unchanged if that is NaN.

    `total_friction` stays that of the hysteresis.
    """
    import xarray as xr

    if math.isnan(adhesive_friction):
        return data
    attrs = {"units": "1", "long_name": "friction coefficient of the area term", "source": "input"}
    return data.assign({ADHESIVE_FRICTION: xr.Variable((), adhesive_friction, attrs)})


def answer_by_length(
    data: xr.Dataset,
    parts: Sequence[Any],
    why_not: Sequence[str],
    lengths: Sequence[float],
    model: str,
    load: NominalLoad,
    cut_off_exponents: Sequence[CutOffExponents] = (),
) -> xr.Dataset:
    """Return `data` over `profile` with the answers of the profiles averaged by length.

    Parameters
    ----------
    data
        What is known of each profile.
    parts
        Their results, with the attributes of `TOTALS` without `total_`, and `extrapolation`.
    why_not
        Why a profile does not count, empty where it does: then there are no totals.
    lengths
        Of the profiles [m].
    model, load
        As for `answer`.
    cut_off_exponents
        Of the profiles; none of a model that does not tell them.
    """
    weight = np.asarray(lengths) / np.sum(lengths)
    bad = [
        f"profile {number} of {len(parts)}: {why}"
        for number, why in enumerate(why_not, start=1)
        if why
    ]
    totals = {
        total: math.nan
        if bad
        else float(weight @ [getattr(part, total.removeprefix("total_")) for part in parts])
        for total in TOTALS
    }
    attrs = {"units": "1", "long_name": "share of the length"}
    weighted = data.assign(weight=("profile", weight, attrs))
    beyond = of_sum(
        [part.extrapolation for part in parts],
        weight * [part.friction_from_dissipation for part in parts],
    )
    exponents = NOT_CONVERGED
    if not bad:
        added = [weight * [getattr(part, name) for part in parts] for name in _EXPONENTS_OF]
        exponents = of_mean(cut_off_exponents, *added)
    status = "; ".join(bad) or "converged"
    return answer(weighted, totals, status, model, load, beyond, exponents)


def answer(
    data: xr.Dataset,
    totals: dict[str, float],
    status: str,
    model: str,
    load: NominalLoad,
    extrapolation: Extrapolation = UNKNOWN,
    cut_off_exponents: CutOffExponents = NOT_TOLD,
) -> xr.Dataset:
    """Return `data` with the numbers every model answers with, and the load they are for.

    `extrapolation` is what of the friction rests on the rubber beyond its measured frequencies,
    `cut_off_exponents` how it changes with the smallest wavelength; a model that does not know
    leaves them out.
    """
    import xarray as xr

    def number(value: Any, unit: str, long_name: str) -> xr.Variable:
        attrs = {"units": unit, "long_name": long_name, "source": model}
        return xr.Variable((), value, attrs)

    if set(totals) != set(TOTALS):
        raise ValueError(f"totals must be {', '.join(TOTALS)}; got {', '.join(totals)}")
    variables = {name: number(totals[name], "1", text) for name, text in TOTALS.items()}
    for name, (part, text) in OUTSIDE_BAND.items():
        variables[name] = number(getattr(extrapolation, part), "1", text)
    for name, (part, text) in CUT_OFF_EXPONENTS.items():
        variables[name] = number(getattr(cut_off_exponents, part), "1", text)
    variables[WHY_NO_EXPONENT] = number(
        cut_off_exponents.why_not, "1", "why an exponent of the cut-off is not known"
    )
    variables["prediction_status"] = number(status, "1", "converged, or why not")
    variables["nominal_pressure"] = number(load.pressure, "Pa", "nominal pressure")
    variables["nominal_speed"] = number(load.speed, "m/s", "sliding speed")
    variables["footprint"] = number(load.footprint, "m", "length of the nominal contact")
    return data.assign(variables).assign_attrs(model=model, load_time=str(load.load_time))
