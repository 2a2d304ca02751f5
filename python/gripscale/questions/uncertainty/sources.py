"""The sources of uncertainty: each draws a value and applies it to the inputs of a sample."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np

from gripscale.case import Case
from gripscale.conditions import Conditions
from gripscale.core import Array, InputError, checks
from gripscale.questions.uncertainty import sampled_inputs as quantities
from gripscale.questions.uncertainty.profile_blocks import ProfileBlocks
from gripscale.questions.uncertainty.sampled_inputs import CleanedProfiles, Inputs, Range
from gripscale.questions.uncertainty.series_scatter import SeriesScatter
from gripscale.rubber import Rubber
from gripscale.rubber.maxwell_fit import with_series
from gripscale.surface import Profile, SineStack, Surface, clean, sine_ambiguity
from gripscale.surface.low_pass import followed
from gripscale.surface.sines import FACTOR_RANGE
from gripscale.uncertainty_options import pressure_error

# Sources whose standard error a case must state: nothing in it says how large it is.
STATED = ("height_noise", "temperature", "pressure")
NOT_MEASURED, BY_HAND = "no profile was measured", "the waves are stated by hand"


class Coordinate(NamedTuple):
    """A number that says what a source drew: its unit and meaning.

    A factor is given by its logarithm and is `logarithm`, and so is a number of either sign. Of
    other numbers, above zero, the logarithm is taken where the effect of a source is estimated.
    """

    long_name: str
    unit: str = "1"
    logarithm: bool = True


@dataclass(frozen=True)
class SourceOptions:
    """What the user says: the values of one source, the length of a block, what predicts."""

    name: str
    values: Any = None
    block_length: float | None = None
    models: Sequence[str] = ()

    def range_of(self, quantity: Callable[[Any], float], usual: Range | None = None) -> Range:
        """Return the values the user states, else the usual range."""
        if usual is not None and self.values is None:
            return usual
        return Range.read(self.name, self.values, quantity)

    def standard_error(self, quantity: Callable[[Any], float]) -> float:
        """Return the standard error the user states [SI]; raise `InputError` for what is none."""
        if self.values is None:
            raise SourceNotApplicable("standard error not stated")
        try:
            return quantity(self.values)
        except ValueError as wrong:
            short = checks.short_repr(self.values)
            raise InputError(f"{self.name}: {short}: {wrong}") from wrong


class SourceNotApplicable(InputError):
    """A source has nothing to draw in a case; the message says why."""


Drawn = tuple[Inputs, Sequence[float]]  # the inputs with one draw, and the coordinates of the draw
# Draws from a quantile, above 0 and below 1 and spread evenly over all samples, the random numbers
# of one sample and its inputs.
Draw = Callable[[float, np.random.Generator, Inputs], Drawn]
Prepare = Callable[[Case, SourceOptions], Draw]


@dataclass(frozen=True)
class Source:
    """Something that is not known, and draws of it.

    Whatever it draws is a function of quantile and random numbers alone, so that the sources are
    independent of each other; and of the inputs it changes what is its own.
    """

    name: str
    label: str  # in words, for tables and figures
    models: tuple[str, ...]  # names of the models it has an effect on
    coordinates: Mapping[str, Coordinate]
    # Makes what draws; raises `SourceNotApplicable`, or `InputError` for options of no use.
    prepare: Prepare
    draw: Draw | None = None  # none before the source is that of a case


class BlockDraw:
    """Draws another stretch of the same road, see `ProfileBlocks`; blocks have no order."""

    def __init__(self, blocks: ProfileBlocks) -> None:
        self.blocks = blocks
        self.freedom = len(blocks) - 1.0  # of the scatter of the draws: they are of so many blocks
        # of profiles cleaned otherwise, which many samples share
        self.of_cleaned = cache(lambda cleaned: replace(blocks, profiles=cleaned.profiles))

    def __call__(self, _: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        """Draw blocks of the profiles as they are cleaned in the sample."""
        drawn, cleaned = self.blocks.draw(random), inputs.cleaned
        blocks = self.blocks if cleaned is None else self.of_cleaned(cleaned)
        return replace(inputs, blocks=(blocks, drawn)), self.blocks.log_ratios(drawn).tolist()


# Models by the word of a case for one or both of them.
BOTH = {"chain": ("chain",), "direct": ("direct",), "both": ("chain", "direct")}
# In the order of the functions below, in which they are drawn: noisy profiles are cleaned and cut
# into blocks, the waves are fitted last.
SOURCES: dict[str, Source] = {}


def _source(
    label: str, models: str = "both", /, **coordinates: Coordinate
) -> Callable[[Prepare], Prepare]:
    """Enter what prepares a source in `SOURCES`, by its name without the underscore."""

    def entered(prepare: Prepare) -> Prepare:
        name = prepare.__name__.removeprefix("_")
        SOURCES[name] = Source(name, label, BOTH[models], coordinates, prepare)
        return prepare

    return entered


def _number(value_at: Callable[[float], float], applied: Callable[[Inputs, float], Inputs]) -> Draw:
    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        value = value_at(quantile)
        return applied(inputs, value), [value]

    return draw


def _cleaned(lines: Sequence[Profile], case: Case, **changed: Any) -> CleanedProfiles:
    after = tuple(followed(clean(line, **{**case.cleaning, **changed})[0]) for line in lines)
    return CleanedProfiles(after, case.surface.counted)


def _raw(case: Case, on_map: str) -> list[Profile]:
    measured = case.surface.measured
    if measured is None or not case.cleaning:
        raise SourceNotApplicable(NOT_MEASURED)
    if measured.map is not None:
        raise SourceNotApplicable(on_map)
    return [line for line, _ in measured.profiles]


def _rms_step(lines: Sequence[Profile]) -> float:
    return math.sqrt(float(np.nanmean(np.concatenate([np.diff(line.z) ** 2 for line in lines]))))


@_source(
    "noise of the heights", rms_step=Coordinate("ln of the rms step over that of the profiles")
)
def _height_noise(case: Case, options: SourceOptions) -> Draw:
    """Draw the noise of the instrument once more, before the profiles are cleaned."""
    lines = _raw(case, "a map is taken as measured")
    assert case.surface.measured is not None
    size = options.standard_error(quantities.length)
    usual = _rms_step(case.surface.measured.followed)

    def noisy(seed: int) -> list[Profile]:
        random = np.random.default_rng(seed)
        return [
            replace(line, z=line.z + size * random.standard_normal(len(line))) for line in lines
        ]

    def draw(_: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        raw = partial(noisy, int(random.integers(2**62)))
        cleaned = _cleaned(raw(), case)
        ratio = math.log(_rms_step(cleaned.profiles) / usual)
        return replace(inputs, raw=raw, cleaned=cleaned), [ratio]

    return draw


USUAL_SPIKE = 3.0
# Change of height per step at which a spike stands off: half of the usual marks narrow crests,
# three times of it leaves many spikes of a laser standing.
SPIKE_RANGE = (1.5, 10.0)
SPIKE_LEVELS = 8  # limits a range is drawn at: the profiles are cleaned once for each


@_source(
    "cleaning of the profiles",
    spike_slope=Coordinate("ln of the limit of spikes over that of the case"),
    smooth_gaps=Coordinate("1 where cubics fill the gaps, 0 for straight lines"),
)
def _cleaning(case: Case, options: SourceOptions) -> Draw:
    """Draw the limit of spikes, and how the gaps they leave are filled."""
    raw, usual = _raw(case, "a map is cleaned as the case states"), case.cleaning
    if options.values is None and usual["spikes"] is None:
        raise SourceNotApplicable("the case leaves spikes in")
    scale = usual["spike_slope"] / USUAL_SPIKE
    usual_range = Range((scale * SPIKE_RANGE[0], scale * SPIKE_RANGE[1]))
    levels = options.range_of(quantities.factor, usual_range).levels(SPIKE_LEVELS)

    def cleaned(lines: Sequence[Profile], slope: float) -> CleanedProfiles:
        return _cleaned(lines, case, spikes=usual["spikes"] or "isolated", spike_slope=slope)

    as_measured = cache(partial(cleaned, raw))

    def draw(quantile: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        slope, smooth = levels.at(quantile), bool(random.integers(2))
        lines = as_measured(slope) if inputs.raw is None else cleaned(inputs.raw(), slope)
        changed = replace(inputs, cleaned=lines, smooth_gaps=smooth)
        return changed, [math.log(slope / usual["spike_slope"]), float(smooth)]

    return draw


@_source(
    "stretch of surface measured",
    **{
        f"correlation_{lags}": Coordinate(f"ln of C_z over the measured one, {lags} lags")
        for lags in ("short", "middle", "long")
    },
)
def _profile(case: Case, options: SourceOptions) -> Draw:
    surface, measured = case.surface, case.surface.measured
    if not _fitted(surface) or measured is None:
        raise SourceNotApplicable(NOT_MEASURED)
    if "direct" in options.models and measured.map is not None:
        raise InputError(
            "the direct contact of a map has no blocks of profiles to draw; leave out the "
            "source profile (without), or ask for the chain only"
        )
    largest = float(surface.sines.wavelength[0])
    blocks = ProfileBlocks(measured.followed, largest, options.block_length, surface.counted)
    if "direct" in options.models:
        blocks.require_lines()
    return BlockDraw(blocks)


def _fitted(surface: Surface) -> bool:
    return surface.correlation is not None and bool(surface.fit)


GRID_PLACE = "grid_place"  # coordinate of the source `grid`


@_source(
    "grid of the direct contact",
    "direct",
    grid_place=Coordinate("error of the grid over its estimate, from -1 to 1"),
)
def _grid(case: Case, options: SourceOptions) -> Draw:
    if case.surface.measured is None:
        raise SourceNotApplicable(NOT_MEASURED)
    return _number(lambda quantile: 2.0 * quantile - 1.0, lambda inputs, _: inputs)


def _log_ratios(rubber: Rubber, omega: Array) -> Array:
    modulus = rubber.complex_modulus(omega)
    parts = np.stack([np.abs(modulus), modulus.imag / modulus.real], axis=-1)
    return np.asarray(np.log(parts))


@_source(
    "scatter and ends of the moduli",
    **{
        f"{name}_{wave}_wave": Coordinate(f"ln of {text} over the fitted one, at the {wave} wave")
        for wave in ("largest", "smallest")
        for name, text in (("modulus", "|E*|"), ("loss", "E''/E'"))
    },
)
def _modulus(case: Case, options: SourceOptions) -> Draw:
    """Draw a series the measured moduli leave open, see `SeriesScatter`; series have no order."""
    master, fit, speed = case.measured_rubber.master, case.measured_rubber.fit, case.load.speed
    if master is None or fit is None:
        raise SourceNotApplicable("no moduli were measured")
    series = SeriesScatter.of(master, fit, case.rubber.bulk_modulus)
    excited = 2.0 * np.pi * speed / case.surface.sines.wavelength[[0, -1]]
    omega = excited if speed > 0.0 else np.array(fit.measured_band)

    def draw(_: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        drawn = with_series(inputs.rubber, series.draw(random))
        ratios = _log_ratios(drawn, omega) - _log_ratios(inputs.rubber, omega)
        return replace(inputs, rubber=drawn), ratios.ravel().tolist()

    return draw


# Rubbers have 1 to 3 GPa (A. N. Gent, Engineering with Rubber, 3rd ed. (2012), ch. 1).
BULK_MODULUS_FACTOR = 1.5
_LEAST_OF_GLASSY = 0.23  # of the bulk modulus over the sum of all moduli: a little above 2/9


@_source("bulk modulus", bulk_modulus=Coordinate("bulk modulus", "Pa", False))
def _bulk_modulus(case: Case, options: SourceOptions) -> Draw:
    usual = Range.about(case.rubber.bulk_modulus, BULK_MODULUS_FACTOR)

    def applied(inputs: Inputs, value: float) -> Inputs:
        least = _LEAST_OF_GLASSY * inputs.rubber.glassy_modulus  # with a Poisson's ratio above zero
        bulk = max(value, least) if options.values is None else value
        return replace(inputs, rubber=replace(inputs.rubber, bulk_modulus=bulk))

    return _number(options.range_of(quantities.modulus, usual).at, applied)


@_source("equilibrium modulus", equilibrium_modulus=Coordinate("equilibrium modulus", "Pa", False))
def _equilibrium_modulus(case: Case, options: SourceOptions) -> Draw:
    """Draw the equilibrium modulus, which a DMA measurement does not reach, where it is stated."""
    if options.values is None:
        raise SourceNotApplicable(
            "no range is given; modulus varies it as far as the data leave it open"
        )

    def applied(inputs: Inputs, value: float) -> Inputs:
        rubber = replace(inputs.rubber, equilibrium_modulus=value, admissible=None)
        return replace(inputs, rubber=rubber)

    return _number(options.range_of(quantities.modulus).at, applied)


@_source("temperature", warming=Coordinate("above the temperature of the case", "K"))
def _temperature(case: Case, options: SourceOptions) -> Draw:
    normal = NormalDist(0.0, options.standard_error(quantities.kelvins))
    before = (case.conditions or Conditions()).temperature_of(case.rubber)
    if case.rubber.shift is None or before is None:
        raise SourceNotApplicable("the rubber has no temperature shift")
    return _number(normal.inv_cdf, lambda inputs, value: replace(inputs, warming=value))


@_source("nominal pressure", log_pressure=Coordinate("ln of the pressure over that of the case"))
def _pressure(case: Case, options: SourceOptions) -> Draw:
    of_load = partial(pressure_error, pressure=case.load.pressure)
    normal = NormalDist(0.0, options.standard_error(of_load))
    return _number(normal.inv_cdf, lambda inputs, value: replace(inputs, log_pressure=value))


# The passage of the contact above, t_i = A_(i-1)/v, is the order of a time, not its value: contacts
# are shorter and longer than their mean.
LOAD_TIME_FACTOR = 2.0


@_source(
    "load time of a wave",
    "chain",
    load_time_factor=Coordinate("load time over that of the case", "1", False),
)
def _load_time(case: Case, options: SourceOptions) -> Draw:
    """Draw how long the mean state of a wave has had to relax, over the passage."""
    if case.load.speed == 0.0:
        raise SourceNotApplicable("at rest it is infinite")
    if options.values is None and case.load.load_time != "passage":
        raise SourceNotApplicable("the case states it")
    values = options.range_of(quantities.factor, Range.about(1.0, LOAD_TIME_FACTOR))
    return _number(values.at, lambda inputs, value: replace(inputs, load_time_factor=value))


@_source(
    "cut-off of the roughness",
    cut_off=Coordinate("cut-off, or last wave, of the roughness", "m", False),
)
def _cut_off(case: Case, options: SourceOptions) -> Draw:
    """Draw where the roughness ends, evenly in its logarithm; by default within an octave."""
    if not _fitted(case.surface):
        raise SourceNotApplicable(BY_HAND)
    usual = Range.about(case.surface.cutoff_wavelength, math.sqrt(2.0))
    return _number(options.range_of(quantities.length, usual).at, Inputs.ended_at)


# Arguments of a fit that leave no choice of waves.
CHOSEN = ("s_wavelength", "s_amplitude", "first_wavelength", "first_amplitude")


@_source(
    "choice of sine waves",
    "chain",
    waves=Coordinate("number of sine waves", "1", False),
    first_wavelength=Coordinate("wavelength of the largest wave", "m", False),
)
def _waves(case: Case, options: SourceOptions) -> Draw:
    """Draw one of the stacks that follow C_z as well as it is known, see `sine_ambiguity`.

    They are ordered by their rms slope, so that the quantile spreads them evenly. The cut-off of
    the sample may leave room for fewer waves only.
    """
    surface = case.surface
    if surface.correlation is None or not surface.fit:
        raise SourceNotApplicable(BY_HAND)
    fixed = [key for key in CHOSEN if surface.fit.get(key) is not None]
    if fixed or surface.fit.get("single_factor") or len(surface.sines) < 2:
        raise SourceNotApplicable(
            f"the case states {fixed[0] if fixed else 'one factor or one wave'}"
        )
    stacks = sine_ambiguity(surface.correlation, surface.sines).stacks
    good: Sequence[SineStack] = stacks
    if options.values is not None:
        wanted = options.range_of(quantities.count)
        good = [stack for stack in stacks if len(stack) in wanted]
    if not good:
        numbers = sorted({len(stack) for stack in stacks})
        raise InputError(
            f"waves must be among the numbers that follow C_z as well as it is known, "
            f"{numbers[0]} to {numbers[-1]}; got {options.values}"
        )
    choices = sorted(good, key=lambda stack: float(stack.rms_slope))

    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        stack = choices[min(int(quantile * len(choices)), len(choices) - 1)]
        number, first = len(stack), float(stack.wavelength[0])
        ended = inputs.ended_at(inputs.end)
        half = 0.5 if ended.fit["cut_off"] is not None else 0.0
        most = 1.0 - half + math.log(first / ended.end) / math.log(FACTOR_RANGE[0])
        fit = {**ended.fit, "scales": min(number, int(most)), "first_wavelength": first}
        return replace(inputs, fit=fit), [float(number), first]

    return draw
