"""What every model of contact and friction looks like: a rubber, a surface and a load, answered.

All answer with the same names for the same things, so that whatever compares, varies, draws or
reports takes any of them.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol, runtime_checkable

from gripscale.core import Checked, InputError, Status, checked, checks, display_unit, labelled
from gripscale.core.finding import Finding, Topic, doubt, from_json, to_json
from gripscale.core.units import unit_of
from gripscale.cut_off_exponents import NOT_TOLD, CutOffExponents
from gripscale.rubber.extrapolation import UNKNOWN, Extrapolation

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.conditions import Conditions
    from gripscale.rubber import Rubber
    from gripscale.surface.surface import Surface, SurfacePart


# Attribute of an answer: findings that it may be of another road, rubber or load.
INPUT_DOUBTS = "input_doubts"
FOOTPRINT = 0.1  # length of the nominal contact where none is stated [m]
# Loads of rubber on rough surfaces, with room: [Pa], [m/s], [m]. Others suggest a wrong unit.
PLAUSIBLE = {"pressure": (100.0, 1e8), "speed": (1e-9, 100.0), "footprint": (1e-5, 10.0)}


class Doubtful(Protocol):
    """A surface or a rubber as prepared, with what is doubtful of it."""

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Why the answer may be that of another one."""
        ...


def input_doubts(
    inputs: Iterable[Doubtful],
    loads: Iterable[Load],
    units: Mapping[str, str],
    others: Iterable[Finding] = (),
) -> dict[str, str]:
    """Return the attribute `INPUT_DOUBTS` of an answer; nothing without a doubt.

    Of surfaces and a rubber, the `inputs`, of loads in stated `units`, and doubts of `others`.
    """
    of_inputs = [*(doubt for each in inputs for doubt in each.doubts), *others]
    doubts = dict.fromkeys([*of_inputs, *load_doubts(loads, units)])
    return {INPUT_DOUBTS: to_json(doubts)} if doubts else {}


def input_doubts_of(data: xr.Dataset) -> Sequence[Finding]:
    """Return the findings of the attribute `INPUT_DOUBTS` of an answer; none without it."""
    return from_json(str(data.attrs.get(INPUT_DOUBTS, "")))


def load_doubts(loads: Iterable[Load], units: Mapping[str, str]) -> list[Finding]:
    """Return which quantities of loads suggest a wrong unit, by the farthest, in stated `units`."""
    doubts, every = [], list(loads)
    for name, (least, most) in PLAUSIBLE.items():
        values = {float(getattr(load, name)) for load in every}
        far = [value for value in values if value != 0.0 and not least <= value <= most]
        if far:
            value = max(far, key=lambda value: max(least / value, value / most))
            value_text, *ends = (display_unit(name, units).text(v, 3) for v in (value, least, most))
            text = f"{name.capitalize()} = {value_text} is not between {' and '.join(ends)}"
            doubts.append(doubt(f"{text}: is its unit right?", topic=Topic.LOAD))
    return doubts


LoadTime = Literal["passage"] | float


LOAD_TIME = '"passage", "infinite" or a time such as "1 s"'


def checked_load_time(name: str, value: Any) -> LoadTime:
    """Return a load time [s], or "passage"; raise `InputError` for what is neither."""
    if isinstance(value, str) and value in ("passage", "infinite"):
        return "passage" if value == "passage" else math.inf
    if isinstance(value, str) and not unit_of(value, "time"):
        raise InputError(f"{name} must be {LOAD_TIME}; got {checks.short_repr(value)}")
    return checks.positive(name, value, unit="s", infinite=True)


class Load(Checked):
    """The load on the whole surface. Raises `InputError` if a value cannot be used."""

    pressure: float = checked(checks.positive, unit="Pa")
    """Nominal pressure [Pa], above zero."""
    speed: float = checked(checks.not_negative, unit="m/s")
    """Sliding speed [m/s]; zero is static contact of the relaxed rubber."""
    footprint: float = checked(checks.positive, unit="m")
    """Length of the nominal contact [m]."""
    load_time: LoadTime = checked(checked_load_time, default="passage")
    """How long a place is loaded: while the contact above it passes, or a time [s], or infinite."""
    thickness: float | None = checked(checks.positive, unit="m", default=None)
    """Thickness [m] of the rubber on a rigid base; without it the rubber has no end. Chain, direct
    contact and Persson's theory count it."""

    def time_under(self, contact_length: float) -> float:
        """Return for how long what slides under a contact so long [m] is loaded [s]."""
        if self.speed == 0.0:
            return math.inf
        if isinstance(self.load_time, str):
            return contact_length / self.speed
        return self.load_time

    def depth_of_block(self, depth: float, wavelength: float) -> float:
        """Return the depth of a block of this wavelength [m] in wavelengths: `depth` at most."""
        return depth if self.thickness is None else min(depth, self.thickness / wavelength)


# Called with what is known so far, where a model goes step by step.
OnProgress = Callable[[Any], None] | None


@runtime_checkable
class Model(Protocol):
    """Predicts contact and friction.

    A model is a frozen dataclass that derives from this class. Its fields and the inputs decide its
    answers: stored results are named by them.
    """

    @property
    def name(self) -> str:
        """Word for the model in results, tables and case files."""

    @property
    def method(self) -> tuple[str, ...]:
        """What a page says of it: texts, and names of equations in `gripscale.report.equations`."""
        return (inspect.getdoc(self) or "").partition("\n")[:1]

    @property
    def needs(self) -> frozenset[SurfacePart]:
        """Parts of a surface that the answer depends on; all of them by default."""
        return frozenset({"waves", "measurement", "cut_off"})

    @property
    def takes_conditions(self) -> bool:
        """Whether the model knows conditions; without them it takes the rubber as it is."""
        return False

    @property
    def conditions(self) -> Conditions | None:
        """What changes the rubber."""
        return None

    def with_conditions(self, conditions: Conditions | None) -> Model:
        """Return the model under other conditions; `InputError` if it takes none."""
        raise InputError(
            "temperature and effects belong to a model with conditions, such as chain and direct; "
            f"got the model {self.name}"
        )

    def parts(self, surface: Surface) -> int:
        """Return how many threads one prediction on `surface` keeps busy."""
        return 1

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer: a Dataset with `TOTALS` and its status, and what it rests on.

        A part that did not converge makes the totals NaN and is named in the status.
        """


METHOD = "method"  # attribute of a result: `Model.method` of its model
# Name of the sentence that says how an answer ended: `converged`, or why there are no totals.
STATUS = "prediction_status"
# Name of the word of its `Status`; empty where the sentence is a refusal, which has none.
STATUS_WORD = f"{STATUS}_word"


def word_of(status: str) -> str:
    """Return a status that is the word of a `Status` itself; empty of any other sentence."""
    return str(status) if status in set(Status) else ""


def status_words(data: xr.Dataset, sentences: str = STATUS) -> xr.DataArray:
    """Return the word beside each of the `sentences`, a variable's name; empty in an old file."""
    import xarray as xr

    name = f"{sentences}_word"
    return data[name] if name in data else xr.full_like(data[sentences], "", dtype=object)


# Names and meanings of the numbers every model answers with.
TOTALS = {
    "total_contact_fraction": "real contact area",
    "total_friction": "friction coefficient",
    "total_friction_from_dissipation": "friction coefficient from the energy lost in the rubber",
}

FRICTION_OUTSIDE_BAND = "total_friction_outside_band"
# Names of what every model tells of the rubber beyond its measured frequencies: attribute of
# `Extrapolation`, and meaning.
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


def extrapolation_of(data: xr.Dataset) -> Extrapolation:
    """Read how far an answer rests on the rubber beyond its measured frequencies, if it tells."""
    if not set(OUTSIDE_BAND) <= set(data.data_vars):
        return UNKNOWN
    return Extrapolation(**{part: float(data[name]) for name, (part, _) in OUTSIDE_BAND.items()})


# Names of what every model tells of the choice of the smallest wavelength: attribute of
# `CutOffExponents`, and meaning.
CUT_OFF_EXPONENTS = {
    "total_contact_fraction_cut_off_exponent": (
        "contact_fraction",
        "d ln(real contact area)/d ln(cut-off length), over the last octave",
    ),
    "total_friction_cut_off_exponent": (
        "friction",
        "d ln(friction coefficient)/d ln(cut-off length), over the last octave",
    ),
}

# Name of the text that says why one of them is not known; empty if both are.
WHY_NO_EXPONENT = "cut_off_exponent_missing"


def cut_off_exponents_of(data: xr.Dataset) -> CutOffExponents:
    """Return what an answer tells of its cut-off; not told in a file of an older version."""
    if not {*CUT_OFF_EXPONENTS, WHY_NO_EXPONENT} <= set(data.data_vars):
        return NOT_TOLD
    numbers = {part: float(data[name]) for name, (part, _) in CUT_OFF_EXPONENTS.items()}
    return CutOffExponents(**numbers, why_not=str(data[WHY_NO_EXPONENT].item()))


# Names of what an answer from a measured surface rests on, where a model tells it.
BASIS = {
    "total_contact_fraction_sampling_error": "relative standard error of the contact fraction",
    "total_friction_sampling_error": "relative standard error of the friction coefficient",
    "total_upper_height": "height that 1 % of the measured lines exceed, over the rms height",
    "total_tail": "height that 0.5 % of the lines exceed less that of 2 %, over the rms height",
    "total_relative_load": "pressure times largest wave, over modulus times rms height of lines",
    "total_softening": "ln of E' of the lines over that at twice their strain, smallest wave",
    "total_pressure_over_modulus": "nominal pressure over |E*| of a seventh of the largest wave",
    "total_freedom": "degrees of freedom of the sampling errors",
    "total_steep_share": "share of the friction from contact on slopes above 1",
    "total_missing_share": "share of the contact on heights that were missing and interpolated",
}
LINE_UNDER_LOAD = tuple(
    f"total_{n}" for n in ("upper_height", "tail", "relative_load", "softening")
)

# Name of the area term's friction, where one was asked for.
ADHESIVE_FRICTION = "total_adhesive_friction"


def with_adhesive(data: xr.Dataset) -> xr.DataArray | None:
    """Return hysteresis and area term together, or None where no area term was asked for."""
    return data["total_friction"] + data[ADHESIVE_FRICTION] if ADHESIVE_FRICTION in data else None


def with_area_term(data: xr.Dataset, adhesive_friction: float) -> xr.Dataset:
    """Return an answer with the friction of the area term [-] as a further number, if not NaN."""
    if math.isnan(adhesive_friction):
        return data
    text = "friction coefficient of the area term"
    return data.assign({ADHESIVE_FRICTION: labelled((), adhesive_friction, "1", text, "input")})


def predicted_answer(
    data: xr.Dataset,
    totals: dict[str, float],
    status: str,
    model: str,
    load: Load,
    extrapolation: Extrapolation = UNKNOWN,
    cut_off_exponents: CutOffExponents = NOT_TOLD,
    *,
    status_word: str = "",
) -> xr.Dataset:
    """Return `data` with the numbers every model answers with, and the load they are for.

    `status` is "converged", or a sentence that says why there are no totals; `status_word` is the
    word of its `Status`, which `status` itself may be. A model leaves out what it does not know.
    """

    def number(value: Any, unit: str, long_name: str) -> xr.Variable:
        return labelled((), value, unit, long_name, model)

    if set(totals) != set(TOTALS):
        raise ValueError(f"totals must be {', '.join(TOTALS)}; got {', '.join(totals)}")
    if load.speed == 0.0:  # no friction at rest, whatever rounding says
        totals |= {name: 0.0 * abs(totals[name]) for name in totals if "friction" in name}
    variables = {name: number(totals[name], "1", text) for name, text in TOTALS.items()}
    for name, (part, text) in OUTSIDE_BAND.items():
        variables[name] = number(getattr(extrapolation, part), "1", text)
    for name, (part, text) in CUT_OFF_EXPONENTS.items():
        variables[name] = number(getattr(cut_off_exponents, part), "1", text)
    variables[WHY_NO_EXPONENT] = number(
        cut_off_exponents.why_not, "1", "why an exponent of the cut-off is not known"
    )
    variables[STATUS] = number(str(status), "1", "converged, or why not")
    variables[STATUS_WORD] = number(
        status_word or word_of(status), "1", "word of the status, empty of a refusal"
    )
    variables["nominal_pressure"] = number(load.pressure, "Pa", "nominal pressure")
    variables["nominal_speed"] = number(load.speed, "m/s", "sliding speed")
    variables["footprint"] = number(load.footprint, "m", "length of the nominal contact")
    if load.thickness is not None:
        variables["thickness"] = number(load.thickness, "m", "thickness of the rubber")
    return data.assign(variables).assign_attrs(model=model, load_time=str(load.load_time))


MOST_CLASSES = 64  # classes beyond which a wave is not cut up
