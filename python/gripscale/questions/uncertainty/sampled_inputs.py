"""What one sample is made of: the inputs of a case, as each source of uncertainty changes them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions
from gripscale.core import Checked, InputError, checked, checks
from gripscale.core.units import si_value
from gripscale.experiment.task import Task
from gripscale.model import Load, Model
from gripscale.questions.uncertainty.profile_blocks import Indices, ProfileBlocks
from gripscale.questions.vary.axis import plain_number
from gripscale.rubber import Rubber
from gripscale.surface import Profile, fit_sines
from gripscale.surface.height_difference import HeightDifference, height_difference
from gripscale.surface.resampling import fill_gaps_smoothly
from gripscale.surface.sine_fit import MOST_SINE_WAVES
from gripscale.surface.surface import Measured, Surface


class LongerLoad(Load):
    """A load under which each wave is loaded `factor` [-] times as long: t_i = factor A_(i-1) / v.

    The load time is that of a mean contact; contacts are shorter and longer than their mean, and
    the modulus of the mean state goes with it.
    """

    factor: float = checked(checks.positive, default=1.0)

    def time_under(self, contact_length: float) -> float:
        """Return for how long what slides under a contact so long [m] is loaded [s]."""
        return self.factor * super().time_under(contact_length)


# Arguments of `fit_sines` that say where the waves end.
END_KEYS = ("cut_off", "smallest_wavelength")


@dataclass(frozen=True, eq=False)
class CleanedProfiles:
    """The profiles of a case, cleaned in another way."""

    profiles: Sequence[Profile]
    counted: Mapping[str, Any]  # arguments of `height_difference`

    @cached_property
    def correlation(self) -> HeightDifference:
        """C_z of the profiles."""
        return height_difference(list(self.profiles), **self.counted)


@dataclass(frozen=True, eq=False)
class Inputs:
    """The inputs of one sample: as prepared, or as drawn."""

    surface: Surface
    rubber: Rubber
    fit: Mapping[str, Any] = field(default_factory=dict)  # arguments of `fit_sines`
    # Gives profiles before cleaning, where their heights are not those measured.
    raw: Callable[[], Sequence[Profile]] | None = None
    # The profiles, where they are not cleaned as in the case.
    cleaned: CleanedProfiles | None = None
    blocks: tuple[ProfileBlocks, Indices] | None = None  # of the profiles, and which are drawn
    # Whether gaps of the profiles are filled by cubics without a kink, not by straight lines.
    smooth_gaps: bool = False
    load_time_factor: float = 1.0  # how much longer each wave is loaded than the model says [-]
    warming: float = 0.0  # above the temperature before the contact [K]
    log_pressure: float = 0.0  # logarithm of the nominal pressure over that of the load [-]

    @classmethod
    def of(cls, case: Case) -> Inputs:
        """Return the inputs of the case itself."""
        return cls(case.surface, case.rubber, case.surface.fit)

    @property
    def correlation(self) -> HeightDifference | None:
        """What the waves are fitted to; None for waves stated by hand."""
        if self.blocks is not None:
            return self.blocks[0].correlation(self.blocks[1])
        return self.surface.correlation if self.cleaned is None else self.cleaned.correlation

    @property
    def measured(self) -> Measured | None:
        """What the direct contact is solved on."""
        lines: Sequence[Profile]
        if self.blocks is not None:
            lines = self.blocks[0].lines(self.blocks[1])
        elif self.cleaned is not None:
            lines = self.cleaned.profiles
        else:
            return self.surface.measured
        if self.smooth_gaps:
            lines = [replace(line, z=fill_gaps_smoothly(line.z)) for line in lines]
        return Measured.of(lines)

    @property
    def end(self) -> float:
        """Where the waves end [m]: the cut-off or, without one, the last wave."""
        ends = (self.fit.get(name) for name in END_KEYS)
        return next((float(end) for end in ends if end), self.surface.cutoff_wavelength)

    def ended_at(self, wavelength: float) -> Inputs:
        """Return the inputs with a cut-off [m], or a last wave where the case states none."""
        name = "cut_off" if self.fit.get("cut_off") is not None else "smallest_wavelength"
        fit = {**self.fit, **dict.fromkeys(END_KEYS), name: wavelength}
        if fit.get("s_wavelength") is not None:
            fit["scales"] = None  # the factor and the end say how many
        return replace(self, fit=fit)

    def for_model(self, model: Model) -> tuple[Surface, Model]:
        """Return surface and model as `model` takes this sample.

        Without waves only where they end is kept of them. Raises `InputError` if no waves fit.
        """
        surface = self.surface
        if self.warming:
            conditions = model.conditions or Conditions()
            kelvin = conditions.temperature_of(self.rubber)
            assert kelvin is not None  # the source has asked for it
            warmed = replace(conditions, temperature=kelvin + self.warming)
            model = model.with_conditions(warmed)
        if "waves" not in model.needs:
            return Surface(None, surface.source, measured=self.measured, end=self.end), model
        correlation = self.correlation
        prepared = correlation is surface.correlation and dict(self.fit) == dict(surface.fit)
        if correlation is None or prepared:
            return surface, model
        return replace(surface, waves=fit_sines(correlation, **self.fit)), model

    def tasks(self, model: Model, loads: Sequence[Load]) -> list[Task]:
        """Return what has to be solved under each load; raise `InputError` for inputs of no use."""
        surface, changed = self.for_model(model)
        if changed.conditions is not None:  # refuses a temperature without a shift
            changed.conditions.before(self.rubber)
        relevant = surface.only(changed.needs)
        factor = math.exp(self.log_pressure)
        loads = [replace(load, pressure=load.pressure * factor) for load in loads]
        if isinstance(model, Chain) and self.load_time_factor != 1.0:
            loads = [LongerLoad(**vars(load), factor=self.load_time_factor) for load in loads]
        return [Task(self.rubber, relevant, load, changed) for load in loads]


class Range(Checked):
    """Values a number may have: anywhere between two ends, one of a few, or one.

    Between two ends it is spread evenly in its logarithm, as befits a factor that may be too large
    or too small by as much: its reciprocal is then spread evenly, too.

    Raises `InputError` if there are no values, one is not above zero, they do not rise, or there
    are other than two ends.

    Parameters
    ----------
    values : tuple of float
        Above zero, rising.
    between : bool
        Whether the two values are ends, with anything between them; otherwise each of the values
        is as likely as the others.
    """

    values: tuple[float, ...]
    between: bool = True

    def __post_init__(self) -> None:
        values = tuple(checks.positive("each value of a range", value) for value in self.values)
        if not values or any(b <= a for a, b in pairwise(values)):
            raise InputError(f"a range must be rising values; got {checks.short_repr(self.values)}")
        if self.between and len(values) != 2:
            raise InputError(f"a range must have two ends; got {checks.short_repr(self.values)}")
        self._set(values=values)

    @classmethod
    def about(cls, value: float, factor: float) -> Range:
        """Return the range from `value` / `factor` to `value` x `factor`."""
        return cls((value / factor, value * factor))

    @classmethod
    def read(cls, name: str, text: Any, quantity: Callable[[Any], float]) -> Range:
        """Return the range of a text such as `1 GPa:3 GPa` or `1 GPa,2 GPa`, a number or several.

        Two numbers in a tuple or a list are ends. `quantity` turns an entry into SI units.
        """
        if isinstance(text, Range):
            return text
        entries: list[Any] = [text]
        between = isinstance(text, str) and ":" in text
        if isinstance(text, str):
            entries = text.split(":" if between else ",")
        elif isinstance(text, Iterable):
            entries = list(text)
            between = len(entries) == 2
        try:
            return cls(tuple(quantity(entry) for entry in entries), between)
        except InputError as error:
            raise InputError(f"{name}: {error}") from error

    def __contains__(self, value: float) -> bool:
        if self.between:
            return self.values[0] <= value <= self.values[1]
        return value in self.values

    def at(self, quantile: float) -> float:
        """Return the value below which a share `quantile` [0 to 1] of all lie."""
        if not self.between:
            return self.values[min(int(quantile * len(self.values)), len(self.values) - 1)]
        low, high = np.log(self.values)
        return float(np.exp(low + quantile * (high - low)))

    def levels(self, count: int) -> Range:
        """Return `count` equally likely values in place of all between two ends."""
        if not self.between:
            return self
        return Range(tuple(self.at((k + 0.5) / count) for k in range(count)), between=False)


def factor(text: Any) -> float:
    """Return a factor [-]; raise `InputError` for what is none."""
    return checks.positive("a factor", plain_number(text))


def count(text: Any) -> float:
    """Return a number of waves; raise `InputError` for what is none."""
    return float(checks.whole("waves", plain_number(text), least=2, most=MOST_SINE_WAVES))


def _quantity(text: Any, kind: str, unit: str) -> float:
    value = si_value(f"a {kind}", plain_number(text), unit, kind)
    return checks.positive(f"a {kind}", value, unit=unit)


modulus = partial(_quantity, kind="pressure", unit="Pa")
length = partial(_quantity, kind="length", unit="m")
kelvins = partial(_quantity, kind="temperature difference", unit="K")
