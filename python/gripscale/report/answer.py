"""The answer of a case: friction and contact area with their interval, and what they rest on."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.analysis.best_estimate import IsotropicSurface
from gripscale.analysis.intervals import LEVEL
from gripscale.analysis.sampled_answer import FRICTION_BELOW_MEASUREMENT
from gripscale.chain.chain import Chain
from gripscale.charts.view import HEADINGS, SYMBOLS
from gripscale.core.units import display_unit_of
from gripscale.io.table import significant
from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND, STATUS
from gripscale.report.elements import Card, percent
from gripscale.rubber.extrapolation import WORTH_SAYING

WORTH_NAMING = 0.005
"""Share of friction or contact below which it is as good as none."""


def has_answer(data: xr.Dataset) -> bool:
    """Return whether a result of one load holds a best estimate of the contact area."""
    area = data.get("best_contact_fraction")
    return area is not None and not area.ndim and math.isfinite(float(area))


def answer_lines(data: xr.Dataset | None) -> Iterator[str]:
    """Yield the answer of a result of one load, then what it rests on; or why there is none."""
    if data is None:
        yield (
            "Answer: none with an interval. No surface was measured, and the chain of sine waves "
            "alone has nothing to be judged by."
        )
        return
    if not has_answer(data):
        why = str(data[STATUS].item()) if STATUS in data else "no direct contact was solved"
        yield f"Answer: none. The direct contact of the measured surface has no result: {why}."
        return
    numbers = ", ".join(
        f"{SYMBOLS[name]} = {number_and_interval(data, name)}" for name in _of(data)
    )
    text = f"{numbers}{_level(data)}"
    if _too_wide(data):
        wide = f"more than a factor of two either way{_why_wide(data)}"
        yield f"Answer: none to rely on. {text}: {wide}"
    else:
        yield f"Answer: {text}"
    yield from (f"  {line}" for line in basis_lines(data))


def basis_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what a best estimate is for, what it is made of, and what it rests on."""
    if not has_answer(data):
        return
    names = _of(data)
    load = [
        display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"]))
        for name in ("pressure", "speed")
    ]
    cut_off = f"{1e3 * float(data.cutoff_wavelength):.3g} mm"
    yield f"for {' and '.join(load)}, roughness down to {cut_off}"
    yield f"from {' × '.join(_factors(data, names))}"
    rests = list(_rests_on(data, names[0]))
    if rests:
        yield "; ".join(rests)


def _of(data: xr.Dataset) -> tuple[str, ...]:
    """Return what is estimated: no friction at rest."""
    moving = float(data.nominal_speed) > 0.0
    return ("friction", "contact_fraction") if moving else ("contact_fraction",)


def answer_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield friction and contact area with their intervals."""
    if not has_answer(data):
        return
    for name in _of(data):
        title = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"
        ends = interval(data, name)
        detail = f"best estimate; {ends} ({100.0 * LEVEL:.0f} %)" if ends else "best estimate"
        yield Card(title, significant(float(data[f"best_{name}"])), detail)


def number_and_interval(data: xr.Dataset, name: str) -> str:
    """Return a best estimate and its interval, such as `0.19 (0.15 to 0.23)`."""
    ends = interval(data, name)
    return f"{significant(float(data[f'best_{name}']))}{f' ({ends})' if ends else ''}"


def interval(data: xr.Dataset, name: str) -> str:
    """Return the interval of a best estimate, such as `0.15 to 0.23`; empty if there is none."""
    low, high = interval_ends(data, name)
    return f"{significant(low)} to {significant(high)}" if math.isfinite(high) else ""


def interval_ends(data: xr.Dataset, name: str) -> tuple[float, float]:
    """Return the ends of the interval of a best estimate, NaN if there is none."""
    value, width = (float(data[f"best_{name}{end}"]) for end in ("", "_half_width"))
    return value * math.exp(-math.asinh(width)), value * math.exp(math.asinh(width))


def _too_wide(data: xr.Dataset) -> bool:
    """Return whether an interval is so wide that its middle says nothing."""
    widths = [float(data[f"best_{name}_half_width"]) for name in _of(data)]
    return any(math.asinh(width) > math.log(2.0) for width in widths if math.isfinite(width))


def _why_wide(data: xr.Dataset) -> str:
    """Return why an interval is too wide; not where its parts say it."""
    if "part_label" in data:
        return ""
    return ", because the measured surface is too short to stand for its road"


def _level(data: xr.Dataset) -> str:
    if math.isfinite(float(data.best_contact_fraction_half_width)):
        return f" ({100.0 * LEVEL:.0f} % intervals)"
    if not is_measured(data):
        return "; no interval: fewer than two samples have an answer"
    return "; no interval: the surface is too short to tell how well it represents the road"


def is_measured(data: xr.Dataset) -> bool:
    """Return whether an answer is of a measured surface: otherwise it is the chain's."""
    total = data.get("total_friction")
    return total is None or total.attrs.get("source") != Chain.name


def _factors(data: xr.Dataset, names: tuple[str, ...]) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first."""
    yield (
        "the direct contact of the measured surface" if is_measured(data) else "the chain of waves"
    )
    for at, label in enumerate(data.factor_label.values):
        values = [float(data[f"best_{name}_factor"][at]) for name in names]
        if not all(map(math.isfinite, values)):
            continue
        sigma = float(data[f"best_{names[0]}_factor_uncertainty"][at])
        assumed = np.allclose(values, 1.0)
        numbers = f"± {percent(sigma)}" if assumed else ", ".join(map(significant, values))
        yield f"{label} ({numbers})"


def _rests_on(data: xr.Dataset, name: str) -> Iterator[str]:
    """Yield the shares of the answer that rest on what was not measured well."""
    sampling = float(data[f"best_{name}_sampling_error"])
    if math.isfinite(sampling):
        yield f"sampling of the road ± {percent(sampling)} of it (standard error)"
    beyond = data.get(FRICTION_OUTSIDE_BAND)
    if beyond is not None and not beyond.ndim and float(beyond) > WORTH_SAYING:
        yield f"{percent(float(beyond))} of the friction beyond the measured frequencies"
    below = data.get(FRICTION_BELOW_MEASUREMENT)
    if below is not None and not below.ndim and float(below) > WORTH_NAMING:
        limit = f"{1e3 * float(data.resolution_limit):.3g} mm"
        yield (
            f"{percent(float(below))} of the friction in waves shorter than {limit}, which were "
            "not measured"
        )
    for share, words in (
        ("steep_share", "of the friction on slopes above 1"),
        ("missing_share", "of the contact on filled gaps"),
    ):
        value = float(data[f"best_{share}"])
        if value > WORTH_NAMING:
            yield f"{percent(value)} {words}"
    if IsotropicSurface.label in data.factor_label.values:
        yield "a road without direction is assumed: ridges 3:1 change the area by up to 1.7"
    if ADHESIVE_FRICTION in data and not data[ADHESIVE_FRICTION].ndim:
        yield f"an area term of {significant(float(data[ADHESIVE_FRICTION]))} comes on top"
