"""The sources of uncertainty: each draws a value and applies it to the inputs of a sample."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, partial
from statistics import NormalDist
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.questions.uncertainty import sampled_inputs as quantities
from gripscale.questions.uncertainty.options import pressure_error
from gripscale.questions.uncertainty.profile_blocks import ProfileBlocks
from gripscale.questions.uncertainty.sampled_inputs import (
    CleanedProfiles,
    Inputs,
    Measurement,
    Range,
)
from gripscale.questions.uncertainty.series_scatter import SeriesScatter, with_series
from gripscale.rubber import Rubber
from gripscale.surface import Profile, SineStack, clean, sine_ambiguity
from gripscale.surface.sines import FACTOR_RANGE


class Coordinate(NamedTuple):
    """A number that says what a source drew: its unit and meaning.

    A factor is told by its logarithm, and is `logarithm` then, as is a number of either sign; of
    any other, above zero, the logarithm is taken where the effect of a source is estimated.
    """

    unit: str
    long_name: str
    logarithm: bool = False


@dataclass(frozen=True)
class SourceOptions:
    """What the user says: the values of one source, the length of a block, what predicts."""

    values: Any = None
    block_length: float | None = None
    models: Sequence[str] = ()


class SourceNotApplicable(InputError):
    """A source has nothing to draw in a case; the message says why."""


Drawn = tuple[Inputs, Sequence[float]]
"""The inputs with one draw, and the coordinates of the draw."""

Draw = Callable[[float, np.random.Generator, Inputs], Drawn]
"""Draws from a quantile, above 0 and below 1 and spread evenly over all samples, the random numbers
of one sample and its inputs."""


@dataclass(frozen=True)
class Source:
    """Something that is not known, and draws of it.

    Whatever it draws is a function of quantile and random numbers alone, so that the sources are
    independent of each other; and of the inputs it changes what is its own.
    """

    name: str
    label: str
    """In words, for tables and figures."""
    models: tuple[str, ...]
    """Names of the models it has an effect on."""
    coordinates: Mapping[str, Coordinate]
    prepare: Callable[[Measurement, SourceOptions], Draw]
    """Makes what draws for a case; raises `SourceNotApplicable` if there is nothing to draw."""
    draw: Draw | None = None
    """None before the source is that of a case."""

    @property
    def freedom(self) -> float | None:
        """Degrees of freedom of what it draws from; None where nothing limits them."""
        return self.draw.freedom if isinstance(self.draw, BlockDraw) else None

    def of(self, measurement: Measurement, options: SourceOptions) -> Source:
        """Return the source of a case.

        Raises `SourceNotApplicable` if it has nothing to draw, `InputError` if the options cannot
        be used.
        """
        return replace(self, draw=self.prepare(measurement, options))


@dataclass(frozen=True, eq=False)
class BlockDraw:
    """Draws another stretch of the same road, see `ProfileBlocks`; blocks have no order."""

    blocks: ProfileBlocks
    _recut: MutableMapping[CleanedProfiles, ProfileBlocks] = field(
        default_factory=WeakKeyDictionary
    )
    """Of profiles that many samples share."""

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the scatter of the draws: they are of so many blocks."""
        return len(self.blocks) - 1.0

    def __call__(self, _: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        """Draw blocks of the profiles as they are cleaned in the sample."""
        drawn, blocks = self.blocks.draw(random), self.blocks
        if inputs.cleaned is not None:
            if inputs.cleaned not in self._recut:
                self._recut[inputs.cleaned] = replace(blocks, profiles=inputs.cleaned.profiles)
            blocks = self._recut[inputs.cleaned]
        changed = replace(
            inputs,
            recorrelated=partial(blocks.correlation, drawn),
            redrawn=partial(blocks.lines, drawn),
        )
        return changed, self.blocks.log_ratios(drawn).tolist()


def _profile(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw another stretch of the same road."""
    if not measurement.fitted or not measurement.profiles:
        raise SourceNotApplicable("no profile was measured")
    if "direct" in options.models and measurement.is_map:
        raise InputError(
            "the direct contact of a map has no blocks of profiles to draw; leave out the "
            "source profile (without), or ask for the chain only"
        )
    surface = measurement.surface
    largest = float(surface.sines.wavelength[0])
    blocks = ProfileBlocks(measurement.profiles, largest, options.block_length, surface.counted)
    if "direct" in options.models:
        blocks.require_lines()
    return BlockDraw(blocks)


USUAL_SPIKE = 3.0
SPIKE_RANGE = (1.5, 10.0)
"""Change of height per step at which neighbours are a spike: ISO 13473-1 says 3; half of it marks
many true flanks, three times of it leaves most spikes of a laser standing."""
SPIKE_LEVELS = 8
"""Limits a range is drawn at: the profiles are cleaned once for each."""


def _cleaned(lines: Sequence[Profile], measurement: Measurement, **changed: Any) -> CleanedProfiles:
    """Return profiles cleaned as in the case but for what is changed."""
    options = {**measurement.cleaning, **changed}
    after = tuple(clean(line, **options)[0] for line in lines)
    return CleanedProfiles(after, measurement.surface.counted)


def _cleaning(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the limit of spikes, and how the gaps they leave are filled.

    Whether the limit holds across gaps is not drawn: that wears away true flanks, a third of the
    points of a coarse road at low limits, and is a choice of the case.
    """
    usual, measured = measurement.cleaning, measurement.surface.measured
    if measured is None or not usual:
        raise SourceNotApplicable("no profile was measured")
    if measurement.is_map:
        raise SourceNotApplicable("a map is cleaned as the case states")
    scale = usual["spike_slope"] / USUAL_SPIKE
    values = Range((scale * SPIKE_RANGE[0], scale * SPIKE_RANGE[1]))
    raw = [line for line, _ in measured.profiles]
    if options.values is not None:
        values = Range.read("cleaning", options.values, quantities.factor)
    elif not usual["remove_spikes"]:
        raise SourceNotApplicable("the case leaves spikes in")
    levels = values.levels(SPIKE_LEVELS)

    def cleaned(lines: Sequence[Profile], slope: float) -> CleanedProfiles:
        changed = {"remove_spikes": True, "spike_slope": slope}
        return _cleaned(lines, measurement, **changed)

    as_measured = cache(partial(cleaned, raw))

    def draw(quantile: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        slope, smooth = levels.at(quantile), bool(random.integers(2))
        lines = as_measured(slope) if inputs.raw is None else cleaned(inputs.raw(), slope)
        changed = replace(inputs, cleaned=lines, smooth_gaps=smooth)
        return changed, [math.log(slope / usual["spike_slope"]), float(smooth)]

    return draw


def _grid(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw where within the estimated error of its grid the answer of a sample lies."""
    if measurement.surface.measured is None:
        raise SourceNotApplicable("no profile was measured")

    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        return inputs, [2.0 * quantile - 1.0]

    return draw


def _modulus(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw a series the measured moduli leave open, see `SeriesScatter`; series have no order."""
    master, fit, speed = measurement.master, measurement.fit, measurement.speed
    if master is None or fit is None:
        raise SourceNotApplicable("no moduli were measured")
    series = SeriesScatter.of(master, fit, measurement.rubber.bulk_modulus)
    excited = 2.0 * np.pi * speed / measurement.surface.sines.wavelength[[0, -1]]
    omega = excited if speed > 0.0 else np.array(fit.measured_band)

    def draw(_: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        drawn = with_series(inputs.rubber, series.draw(random))
        ratios = _log_ratios(drawn, omega) - _log_ratios(inputs.rubber, omega)
        return replace(inputs, rubber=drawn), ratios.ravel().tolist()

    return draw


def _log_ratios(rubber: Rubber, omega: Array) -> Array:
    """Return ln |E*| and ln E''/E' at each frequency, shape (frequencies, 2)."""
    modulus = rubber.complex_modulus(omega)
    parts = np.stack([np.abs(modulus), modulus.imag / modulus.real], axis=-1)
    return np.asarray(np.log(parts))


STATED = ("height_noise", "temperature", "pressure")
"""Sources whose standard error a case must state: nothing in it says how large it is."""
NOT_STATED = "standard error not stated"


def _standard_error(name: str, value: Any, quantity: Callable[[Any], float]) -> float:
    """Return the standard error of a source [SI]; raise `InputError` for what is none."""
    try:
        return quantity(value)
    except ValueError as wrong:
        raise InputError(f"{name}: {checks.short_repr(value)}: {wrong}") from wrong


def _height_noise(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the noise of the instrument once more, before the profiles are cleaned.

    The measured heights hold one draw of it already, which is not known. A second one of the same
    size moves the results about as far as the first did.
    """
    measured = measurement.surface.measured
    if measured is None or not measurement.cleaning:
        raise SourceNotApplicable("no profile was measured")
    if measurement.is_map:
        raise SourceNotApplicable("a map is taken as measured")
    if options.values is None:
        raise SourceNotApplicable(NOT_STATED)
    size = _standard_error("height_noise", options.values, quantities.length)
    usual = _rms_step(measurement.profiles)

    def noisy(seed: int) -> list[Profile]:
        random = np.random.default_rng(seed)
        return [
            replace(line, z=line.z + size * random.standard_normal(len(line)))
            for line, _ in measured.profiles
        ]

    def draw(_: float, random: np.random.Generator, inputs: Inputs) -> Drawn:
        raw = partial(noisy, int(random.integers(2**62)))
        cleaned = _cleaned(raw(), measurement)
        ratio = math.log(_rms_step(cleaned.profiles) / usual)
        return replace(inputs, raw=raw, cleaned=cleaned), [ratio]

    return draw


def _rms_step(lines: Sequence[Profile]) -> float:
    """Return the rms difference of neighbouring heights [m]."""
    return math.sqrt(float(np.nanmean(np.concatenate([np.diff(line.z) ** 2 for line in lines]))))


def _temperature(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the temperature before the contact, normally about that of the case."""
    if options.values is None:
        raise SourceNotApplicable(NOT_STATED)
    if measurement.rubber.shift is None or measurement.temperature is None:
        raise SourceNotApplicable("the rubber has no temperature shift")
    error = _standard_error("temperature", options.values, quantities.kelvins)

    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        warming = error * NormalDist().inv_cdf(quantile)
        return replace(inputs, warming=warming), [warming]

    return draw


def _pressure(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the nominal pressure, normally in its logarithm about that of the case."""
    if options.values is None:
        raise SourceNotApplicable(NOT_STATED)
    of_load = partial(pressure_error, pressure=measurement.pressure)
    error = _standard_error("pressure", options.values, of_load)

    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        change = error * NormalDist().inv_cdf(quantile)
        return replace(inputs, log_pressure=change), [change]

    return draw


def _in_range(range: Range, applied: Callable[[Inputs, float], Inputs]) -> Draw:
    """Draw a number anywhere in a range and apply it."""

    def draw(quantile: float, _: np.random.Generator, inputs: Inputs) -> Drawn:
        value = range.at(quantile)
        return applied(inputs, value), [value]

    return draw


BULK_MODULUS_FACTOR = 1.5
"""Of rubbers it lies between 1 and 3 GPa (A. N. Gent, Engineering with Rubber, 3rd ed. (2012), ch.
1); 1.5 times more or less than the usual 2 GPa covers that range."""


def _bulk_modulus(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the bulk modulus, hardly ever measured together with a master curve."""
    values = Range.about(measurement.rubber.bulk_modulus, BULK_MODULUS_FACTOR)
    if options.values is not None:
        values = Range.read("bulk_modulus", options.values, quantities.modulus)
    return _in_range(
        values,
        lambda inputs, value: replace(inputs, rubber=replace(inputs.rubber, bulk_modulus=value)),
    )


def _equilibrium_modulus(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw the equilibrium modulus where somebody states it; it has no default.

    A DMA measurement does not reach it, and the source `modulus` varies it as far as the slow end
    of the data leaves it open.
    """
    if options.values is None:
        raise SourceNotApplicable(
            "no range is given; modulus varies it as far as the data leave it open"
        )

    def applied(inputs: Inputs, value: float) -> Inputs:
        rubber = replace(inputs.rubber, equilibrium_modulus=value, admissible=None)
        return replace(inputs, rubber=rubber)

    return _in_range(Range.read("equilibrium_modulus", options.values, quantities.modulus), applied)


LOAD_TIME_FACTOR = 2.0
"""The passage of the contact above, t_i = A_(i-1)/v, is the order of a time, not its value:
contacts are shorter and longer than their mean."""


def _load_time(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw how long the mean state of a wave has had to relax, over the passage."""
    if measurement.speed == 0.0:
        raise SourceNotApplicable("at rest it is infinite")
    values = Range.about(1.0, LOAD_TIME_FACTOR)
    if options.values is not None:
        values = Range.read("load_time", options.values, quantities.factor)
    elif measurement.load_time != "passage":
        raise SourceNotApplicable("the case states it")
    return _in_range(values, lambda inputs, value: replace(inputs, load_time_factor=value))


def _cut_off(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw where the roughness ends, by default in an octave about the end of the case.

    Nobody knows it better; evenly in its logarithm, as d ln mu / d ln(cut-off) is nearly constant.
    """
    if not measurement.fitted:
        raise SourceNotApplicable("the waves are stated by hand")
    values = Range.about(measurement.surface.cutoff_wavelength, math.sqrt(2.0))
    if options.values is not None:
        values = Range.read("cut_off", options.values, quantities.length)
    return _in_range(values, Inputs.ended_at)


CHOSEN = ("s_wavelength", "s_amplitude", "first_wavelength", "first_amplitude")
"""Arguments of a fit that leave no choice of waves."""


def _waves(measurement: Measurement, options: SourceOptions) -> Draw:
    """Draw one of the stacks that follow C_z as well as it is known, see `sine_ambiguity`.

    All of them count alike; they are ordered by their rms slope, so that the quantile spreads them
    evenly. The cut-off of the sample may leave no room for as many waves: there are fewer where
    factors get too small.
    """
    surface = measurement.surface
    if surface.correlation is None or not surface.fit:
        raise SourceNotApplicable("the waves are stated by hand")
    fixed = [key for key in CHOSEN if surface.fit.get(key) is not None]
    if fixed or surface.fit.get("single_factor") or len(surface.sines) < 2:
        raise SourceNotApplicable(
            f"the case states {fixed[0] if fixed else 'one factor or one wave'}"
        )
    stacks = sine_ambiguity(surface.correlation, surface.sines).stacks
    good: Sequence[SineStack] = stacks
    if options.values is not None:
        values = Range.read("waves", options.values, quantities.count)
        wanted: Sequence[int] = [int(value) for value in values.values]
        wanted = range(wanted[0], wanted[-1] + 1) if values.between else wanted
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


_BOTH = ("chain", "direct")

_BLOCKS = {
    f"correlation_{lags}": Coordinate("1", f"ln of C_z over the measured one, {lags} lags", True)
    for lags in ("short", "middle", "long")
}
_SERIES = {
    f"{name}_{wave}_wave": Coordinate(
        "1", f"ln of {text} over the fitted one, at the {wave} wave", True
    )
    for wave in ("largest", "smallest")
    for name, text in (("modulus", "|E*|"), ("loss", "E''/E'"))
}
_NOISE = {"rms_step": Coordinate("1", "ln of the rms step over that of the profiles", True)}
_CLEANING = {
    "spike_slope": Coordinate("1", "ln of the limit of spikes over that of the case", True),
    "smooth_gaps": Coordinate("1", "1 where cubics fill the gaps, 0 for straight lines", True),
}
GRID_PLACE = "grid_place"
_GRID = {
    GRID_PLACE: Coordinate("1", "error of the grid over its estimate, from -1 to 1", True),
}
_BULK = {"bulk_modulus": Coordinate("Pa", "bulk modulus")}
_EQUILIBRIUM = {"equilibrium_modulus": Coordinate("Pa", "equilibrium modulus")}
_WARMING = {"warming": Coordinate("K", "above the temperature of the case", True)}
_PRESSURE = {"log_pressure": Coordinate("1", "ln of the pressure over that of the case", True)}
_FACTOR = {"load_time_factor": Coordinate("1", "load time over that of the case")}
_END = {"cut_off": Coordinate("m", "cut-off, or last wave, of the roughness")}
_STACK = {
    "waves": Coordinate("1", "number of sine waves"),
    "first_wavelength": Coordinate("m", "wavelength of the largest wave"),
}

SOURCES = {
    source.name: source
    for source in (
        Source("height_noise", "noise of the heights", _BOTH, _NOISE, _height_noise),
        Source("cleaning", "cleaning of the profiles", _BOTH, _CLEANING, _cleaning),
        Source("profile", "stretch of road measured", _BOTH, _BLOCKS, _profile),
        Source("grid", "grid of the direct contact", ("direct",), _GRID, _grid),
        Source("modulus", "scatter and ends of the moduli", _BOTH, _SERIES, _modulus),
        Source("bulk_modulus", "bulk modulus", _BOTH, _BULK, _bulk_modulus),
        Source(
            "equilibrium_modulus", "equilibrium modulus", _BOTH, _EQUILIBRIUM, _equilibrium_modulus
        ),
        Source("temperature", "temperature", _BOTH, _WARMING, _temperature),
        Source("pressure", "nominal pressure", _BOTH, _PRESSURE, _pressure),
        Source("load_time", "load time of a wave", ("chain",), _FACTOR, _load_time),
        Source("cut_off", "cut-off of the roughness", _BOTH, _END, _cut_off),
        Source("waves", "choice of sine waves", ("chain",), _STACK, _waves),
    )
}
"""In the order in which they are drawn: noisy profiles are cleaned and cut into blocks, the waves
are fitted last. A new one is added here."""

SOURCE_LABELS = {name: source.label for name, source in SOURCES.items()}
"""Names of the sources in words."""
