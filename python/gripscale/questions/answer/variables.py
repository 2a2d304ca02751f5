"""What the variables of results are: names, meanings, symbols and roles, each declared once.

Every variable of a result carries in its file, beside `units` and `long_name`,

    symbol     its letter, such as μ
    role       "answer" (what to believe), "number" (another result), "part" (what adds up to an
               answer), "evidence" (what an answer rests on), "status", or "record"
    interval   names of both ends of its 90 % interval, "low high"
    stacks     dimension along which it adds up

An answer has one `friction`, which every text, page and table states: that of the hysteresis, and
where the case has an interface the sum with its friction. The factors and errors of its parts
(`answer_friction_factor`, `_sampling_error`, ...) are of the hysteresis.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import xarray as xr

from gripscale import model
from gripscale.half_space.result import SHARES_BY_SLOPE
from gripscale.io.table import significant

HEADINGS = {"contact_fraction": "real contact area", "friction": "friction coefficient"}
SYMBOLS = {"contact_fraction": "A_r/A_0", "friction": "μ"}
# Headings and symbols at an axis, without the unit.
AXIS_TITLES = {
    "contact_fraction": f"{HEADINGS['contact_fraction']} $A_r/A_0$",
    "friction": f"{HEADINGS['friction']} $\\mu$",
}
JUDGE = "direct contact of the profiles"  # what a figure of a chain calls the model that judges it
# What texts call the chain where the answer is that of a measured surface.
OF_THE_PAPER = "the paper's chain of waves"
ANSWER = "answer (90 %)"  # what figures call the answer with its interval

# Name of the share of the friction in waves shorter than the `resolution_limit` [m].
FRICTION_BELOW_MEASUREMENT = "friction_below_measurement"
# Both parts of a friction with an interface.
HYSTERESIS, INTERFACE = "answer_hysteresis_friction", "answer_interface_friction"
# Lines of an answer relative to the end of what the step to their surface was fitted to.
REACH = "answer_line_reach"
# Share of the variance of an answer that is left beside a fit to measured friction.
ERROR_LEFT = "answer_error_left"
# Start of the names of numbers with the solved factor of finite strain in place of the law's.
LARGE_STRAIN = "large_strain_"
# Shares of the friction on steep flanks, and of the contact on filled gaps.
BASIS_SHARES = ("steep_share", "missing_share")

_INTERVAL = {
    "": "{}",
    "_low": "low end of the 90 % interval of the {}",
    "_high": "high end of the 90 % interval of the {}",
    "_half_width": "relative half width of the 90 % interval of the {}",
    "_uncertainty": "relative standard uncertainty of the {}",
}
_ENDS = ("", "_low", "_high")  # of the names of a number and both ends of its interval
_PARTS = {
    "_sampling_error": "relative standard error of the {} from the sampling of the surface",
    "_grid_error": "relative standard error of the {} from the grid of the direct contact",
    "_factor": "factor on the {} of the direct contact, NaN if not included",
    "_factor_uncertainty": "relative standard uncertainty of a factor on the {}",
}


def _number(
    start: str, words: str, role: str, symbol: str, units: str = "1"
) -> dict[str, dict[str, str]]:
    """Return the attributes of a number by its name, of its interval and its uncertainty."""
    about = {f"{start}{end}": {"long_name": text.format(words)} for end, text in _INTERVAL.items()}
    for name in about:
        about[name]["role"] = "evidence"
    about[start] |= {"role": role, "symbol": symbol, "interval": f"{start}_low {start}_high"}
    for end in _ENDS:
        about[f"{start}{end}"]["units"] = units
    return about


_HYSTERESIS = "friction coefficient of the hysteresis"
_SYMBOL_OF_AREA = SYMBOLS["contact_fraction"]
_AREA = f"{HEADINGS['contact_fraction']} {_SYMBOL_OF_AREA}"
_EVIDENCE = {
    **{f"answer_friction{end}": text.format(_HYSTERESIS) for end, text in _PARTS.items()},
    **{f"answer_contact_fraction{end}": text.format(_AREA) for end, text in _PARTS.items()},
    ERROR_LEFT: "share of the variance of the answer that a fit to measured friction leaves",
    REACH: "how few summits of the lines carry, over the fewest that the step to a surface knows",
    **{f"answer_{share}": model.BASIS[f"total_{share}"] for share in BASIS_SHARES},
    **{f"answer_{share}": text for share, text in SHARES_BY_SLOPE.items()},
}
# All variables of an answer with their attributes.
ANSWER_NUMBERS: dict[str, dict[str, str]] = {
    **_number("answer_friction", HEADINGS["friction"], "answer", SYMBOLS["friction"]),
    **_number("answer_contact_fraction", HEADINGS["contact_fraction"], "answer", _SYMBOL_OF_AREA),
    **_number(HYSTERESIS, _HYSTERESIS, "part", "hysteresis"),
    INTERFACE: {
        "long_name": "friction coefficient of the interface over the contact area of the answer",
        "role": "part",
        "symbol": "area term",
    },
    **{name: {"long_name": text, "role": "evidence"} for name, text in _EVIDENCE.items()},
}
# The numbers with the solved factor of finite strain, and their meaning.
LARGE_STRAIN_NUMBERS = {
    name.replace("answer_", LARGE_STRAIN): f"{about['long_name']}, with large strain solved"
    for name, about in ANSWER_NUMBERS.items()
    if name.endswith(tuple(_INTERVAL)[1:]) or "interval" in about
}
# Roles of what the models say, whose units and meanings stand where they are made.
_OF_MODELS: dict[str, dict[str, str]] = {
    "total_friction": {"role": "answer", "symbol": SYMBOLS["friction"]},
    "total_contact_fraction": {"role": "answer", "symbol": SYMBOLS["contact_fraction"]},
    "total_friction_from_dissipation": {"role": "number", "symbol": "μ, losses"},
    model.ADHESIVE_FRICTION: {"role": "part", "symbol": "area term"},
    model.FRICTION_OUTSIDE_BAND: {"role": "evidence", "symbol": "beyond band"},
    "octave_friction": {"role": "part", "stacks": "octave"},
    "friction_by_decade": {"role": "part", "stacks": "decade"},
    model.STATUS: {"role": "status"},
    "status": {"role": "status"},
    **{name: {"role": "record"} for name in (model.STATUS_WORD, "status_word")},
    **{name: {"role": "record"} for name in ("prediction_key", "seconds")},
}


def described(data: xr.Dataset) -> xr.Dataset:
    """Return a result whose variables say what they are; beside an answer, a total is a number."""
    data = data.copy()
    for name, about in (ANSWER_NUMBERS | _OF_MODELS).items():
        if name in data:
            defaults = {"units": "1", "long_name": model.TOTALS.get(name, name)}
            data[name].attrs = defaults | data[name].attrs | about
    for quantity in SYMBOLS:
        if is_estimated(data, quantity) and f"total_{quantity}" in data:
            data[f"total_{quantity}"].attrs["role"] = "number"
    return data


_OLD_NAMES = {"answer_friction": HYSTERESIS, "answer_total_friction": "answer_friction"}


def with_present_names(data: xr.Dataset) -> xr.Dataset:
    """Return a result of an earlier version, whose sum of both frictions was the total friction."""
    if "answer_total_friction" not in data:
        return data
    names = {f"{old}{e}": f"{new}{e}" for old, new in _OLD_NAMES.items() for e in _INTERVAL}
    names["answer_adhesive_friction"] = INTERFACE
    return data.rename({old: new for old, new in names.items() if old in data})


def is_beside_answer(data: xr.Dataset, name: str) -> bool:
    """Return whether a result has a number of an answer that tables show beside the answer."""
    return name in data and ANSWER_NUMBERS[name].get("role") in ("number", "part")


def is_estimated(data: xr.Dataset, name: str) -> bool:
    """Return whether a result has the answer of a number such as `friction`."""
    answer = f"answer_{name}"
    return answer in data and bool(data[answer].notnull().any())


def believed(data: xr.Dataset, name: str) -> str:
    """Return the name of the best there is in a result of a number such as `friction`."""
    return f"answer_{name}" if is_estimated(data, name) else f"total_{name}"


def of_hysteresis(data: xr.Dataset, name: str) -> str:
    """Return the number that factors and errors of an answer are of: of friction the hysteresis."""
    return "hysteresis_friction" if name == "friction" and HYSTERESIS in data else name


def has_answer(data: xr.Dataset) -> bool:
    """Return whether a result of one load holds an answer of the contact area."""
    area = data.get("answer_contact_fraction")
    return area is not None and not area.ndim and math.isfinite(float(area))


class AnswerNumber(NamedTuple):
    """A number of an answer [-] with both ends of its 90 % interval; NaN where not known."""

    value: float
    low: float
    high: float

    @property
    def interval(self) -> str:
        """Its interval, such as `0.15 to 0.23`; empty if there is none."""
        if not math.isfinite(self.low):
            return ""
        return f"{significant(self.low)} to {significant(self.high)}"

    def __str__(self) -> str:
        return f"{significant(self.value)}{f' ({self.interval})' if self.interval else ''}"


def answer_number(data: xr.Dataset, name: str) -> AnswerNumber:
    """Return a number of the answer of one load, such as `friction`; NaN without one."""
    if not has_answer(data):
        return AnswerNumber(math.nan, math.nan, math.nan)
    names = [f"answer_{name}{end}" for end in _ENDS]
    # `get` would look for names that are spelled like a missing one
    return AnswerNumber(*(float(data[n]) if n in data else math.nan for n in names))


# The answer of a case that does not state whether its rubber is filled has both numbers.
FILLERS = ("filled", "unfilled")


def with_filled(data: xr.Dataset, filled: xr.Dataset) -> xr.Dataset:
    """Return an answer for unfilled rubber with that of filled rubber, and intervals of both."""
    numbers = {}
    for name in (name for name, about in ANSWER_NUMBERS.items() if "interval" in about):
        names = [f"{name}{end}" for end in _ENDS]
        if not {*names} <= {*data.variables} & {*filled.variables}:
            continue
        for filler, of in zip(FILLERS, (filled, data), strict=True):
            for end in names:
                text = f"{of[end].attrs.get('long_name', name)}, {filler} rubber"
                numbers[f"{filler}_{end}"] = of[end].assign_attrs(long_name=text)
        for end, widest in zip(names[1:], (min, max), strict=True):
            numbers[end] = data[end].copy(data=widest(float(data[end]), float(filled[end])))
    return data.assign(numbers)


def both_answers(data: xr.Dataset) -> Iterator[tuple[str, dict[str, AnswerNumber]]]:
    """Yield "filled" and "unfilled" with friction and contact area; nothing of other answers."""
    for filler in FILLERS if "filled_answer_contact_fraction" in data else ():
        yield (
            filler,
            {
                name: AnswerNumber(*(float(data[f"{filler}_answer_{name}{end}"]) for end in _ENDS))
                for name in ("friction", "contact_fraction")
            },
        )
