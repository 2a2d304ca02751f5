"""What every source of uncertainty looks like."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np

from gripscale.analysis.profile_blocks import ProfileBlocks
from gripscale.analysis.sampled_inputs import (
    Inputs,
    Measurement,
    Range,
    count,
    factor,
    length,
    modulus,
)
from gripscale.analysis.series import Array, SeriesScatter, with_series
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.surface import SineStack, sine_ambiguity
from gripscale.surface.sine_fit import FACTOR_RANGE


class Coordinate(NamedTuple):
    """A number that says what a source drew: its unit and meaning.

    A factor is told by its logarithm, and is `logarithm` then; any other number is above zero and
    its logarithm is taken where the effect of a source is estimated.
    """

    unit: str
    long_name: str
    logarithm: bool = False


class Source(Protocol):
    """Something that is not known, and draws of it.

    Whatever it draws is a function of `quantile` and `random` alone, so that the sources are
    independent of each other; and of the inputs it changes what is its own.
    """

    name: ClassVar[str]
    label: ClassVar[str]
    """In words, for tables and figures."""
    models: ClassVar[tuple[str, ...]]
    """Names of the models it has an effect on."""
    coordinates: ClassVar[Mapping[str, Coordinate]]

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with one draw, and the coordinates of the draw.

        `quantile`, above 0 and below 1, is spread evenly over all samples; `random` belongs to
        this sample.
        """


@dataclass(frozen=True)
class SourceOptions:
    """What the user says: the values of one source, the length of a block, what predicts."""

    values: Any = None
    block_length: float | None = None
    models: Sequence[str] = ()


class SourceNotApplicable(InputError):
    """A source has nothing to draw in a case; the message says why."""


# The source `profile`: another stretch of the same road might have been measured.


@dataclass(frozen=True, eq=False)
class ProfileSource:
    """Blocks of the profiles are drawn with replacement, see `ProfileBlocks`."""

    name: ClassVar[str] = "profile"
    label: ClassVar[str] = "stretch of road measured"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        f"correlation_{lags}": Coordinate(
            "1", f"ln of C_z over the measured one, {lags} lags", True
        )
        for lags in ("short", "middle", "long")
    }

    blocks: ProfileBlocks

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> ProfileSource:
        """Return the source of a case.

        Raises `SourceNotApplicable` without a measured profile, `InputError` if its profiles
        are too short, or if the direct contact of a map is asked for.
        """
        if not measurement.fitted or not measurement.profiles:
            raise SourceNotApplicable("no profile was measured")
        if "direct" in options.models and measurement.is_map:
            raise InputError(
                "the direct contact of a map has no blocks of profiles to draw; leave out the "
                "source profile (without), or ask for the chain only"
            )
        blocks = ProfileBlocks(
            measurement.profiles,
            float(measurement.surface.sines.wavelength[0]),
            options.block_length,
            measurement.surface.counted,
        )
        if "direct" in options.models:
            blocks.require_lines()
        return cls(blocks)

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs on drawn blocks; blocks have no order that `quantile` could follow."""
        drawn = self.blocks.draw(random)
        changed = replace(
            inputs,
            correlation=self.blocks.correlation(drawn),
            redrawn=partial(self.blocks.lines, drawn),
        )
        ratios = self.blocks.log_ratios(drawn)
        return changed, dict(zip(self.coordinates, map(float, ratios), strict=True))


# The source `modulus`: what the measured moduli leave open, see `gripscale.analysis.series`.


@dataclass(frozen=True, eq=False)
class ModulusSource:
    """The Prony series is drawn among those the measurement leaves open."""

    name: ClassVar[str] = "modulus"
    label: ClassVar[str] = "scatter and ends of the moduli"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        f"{name}_{wave}_wave": Coordinate(
            "1", f"ln of {text} over the fitted one, at the {wave} wave", True
        )
        for wave in ("largest", "smallest")
        for name, text in (("modulus", "|E*|"), ("loss", "E''/E'"))
    }

    series: SeriesScatter
    omega: Array
    """Where the draws are told apart [rad/s]: excitation by the largest and the smallest wave."""

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> ModulusSource:
        """Return the source; raise `SourceNotApplicable` without a measured master curve."""
        if measurement.master is None or measurement.fit is None:
            raise SourceNotApplicable("no moduli were measured")
        sines, band = measurement.surface.sines, measurement.fit.measured_band
        excited = 2.0 * np.pi * measurement.speed / sines.wavelength[[0, -1]]
        return cls(
            SeriesScatter.of(measurement.master, measurement.fit, measurement.rubber.bulk_modulus),
            excited if measurement.speed > 0.0 else np.array(band),
        )

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with a series; series have no order that `quantile` could follow."""
        drawn = with_series(inputs.rubber, self.series.draw(random))
        ratios = (_log_ratios(drawn, self.omega) - _log_ratios(inputs.rubber, self.omega)).ravel()
        return replace(inputs, rubber=drawn), dict(
            zip(self.coordinates, map(float, ratios), strict=True)
        )


def _log_ratios(rubber: Rubber, omega: Array) -> Array:
    """Return ln |E*| and ln E''/E' at each frequency, shape (frequencies, 2)."""
    modulus = rubber.complex_modulus(omega)
    parts = np.stack([np.abs(modulus), modulus.imag / modulus.real], axis=-1)
    return np.asarray(np.log(parts))


# The source `bulk_modulus`: hardly ever measured together with a master curve.
#
# Of rubbers it lies between 1 and 3 GPa (A. N. Gent, Engineering with Rubber, 3rd ed. (2012), ch.
# 1); 1.5 times more or less than the usual 2 GPa covers that range.

BULK_MODULUS_FACTOR = 1.5


@dataclass(frozen=True)
class BulkModulusSource:
    """The bulk modulus, by default 1.5 times more or less than that of the case."""

    name: ClassVar[str] = "bulk_modulus"
    label: ClassVar[str] = "bulk modulus"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "bulk_modulus": Coordinate("Pa", "bulk modulus")
    }

    range: Range

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> BulkModulusSource:
        """Return the source of a case."""
        if options.values is None:
            return cls(Range.about(measurement.rubber.bulk_modulus, BULK_MODULUS_FACTOR))
        return cls(Range.read(cls.name, options.values, modulus))

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the bulk modulus at `quantile` of its range."""
        value = self.range.at(quantile)
        rubber = replace(inputs.rubber, bulk_modulus=value)
        return replace(inputs, rubber=rubber), {self.name: value}


# The source `equilibrium_modulus`: what is left of the modulus after infinite time.
#
# A DMA measurement does not reach it, and the source `modulus` varies it as far as the slow end of
# the data leaves it open. Somebody who knows it better, or less, states it: it has no default.


@dataclass(frozen=True)
class EquilibriumModulusSource:
    """The equilibrium modulus, where somebody states it."""

    name: ClassVar[str] = "equilibrium_modulus"
    label: ClassVar[str] = "equilibrium modulus"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "equilibrium_modulus": Coordinate("Pa", "equilibrium modulus")
    }

    range: Range

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> EquilibriumModulusSource:
        """Return the source of a case; raise `SourceNotApplicable` where nobody states it."""
        if options.values is None:
            raise SourceNotApplicable(
                "no range is given; modulus varies it as far as the data leave it open"
            )
        return cls(Range.read(cls.name, options.values, modulus))

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the equilibrium modulus at `quantile` of its range."""
        value = self.range.at(quantile)
        rubber = replace(inputs.rubber, equilibrium_modulus=value, admissible=None)
        return replace(inputs, rubber=rubber), {self.name: value}


# The source `load_time`: how long the mean state of a wave has had to relax.
#
# That is the passage of the contact above, t_i = A_(i-1)/v: the order of a time, not its value.
# Contacts are shorter and longer than their mean; a factor of two each way stands for that.

LOAD_TIME_FACTOR = 2.0


@dataclass(frozen=True)
class LoadTimeSource:
    """The load time of every wave of a chain over its passage, by default 1/2 to 2."""

    name: ClassVar[str] = "load_time"
    label: ClassVar[str] = "load time of a wave"
    models: ClassVar[tuple[str, ...]] = ("chain",)
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "load_time_factor": Coordinate("1", "load time over that of the case")
    }

    range: Range

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> LoadTimeSource:
        """Return the source; raise `SourceNotApplicable` at rest or with a stated load time."""
        if measurement.speed == 0.0:
            raise SourceNotApplicable("at rest it is infinite")
        if options.values is not None:
            return cls(Range.read(cls.name, options.values, factor))
        if measurement.load_time != "passage":
            raise SourceNotApplicable("the case states it")
        return cls(Range.about(1.0, LOAD_TIME_FACTOR))

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the factor at `quantile` of its range."""
        value = self.range.at(quantile)
        return replace(inputs, load_time_factor=value), {"load_time_factor": value}


# The source `cut_off`: where the roughness ends that the rubber feels.
#
# Nobody knows it better than to an octave: by default it is spread over one about that of the case,
# evenly in its logarithm, as d ln mu / d ln(cut-off) is nearly constant.


@dataclass(frozen=True)
class CutOffSource:
    """The cut-off of the case, or its last wave where it states none: an octave about it."""

    name: ClassVar[str] = "cut_off"
    label: ClassVar[str] = "cut-off"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "cut_off": Coordinate("m", "cut-off, or last wave, of the roughness")
    }

    range: Range

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> CutOffSource:
        """Return the source; raise `SourceNotApplicable` if the waves are stated by hand."""
        if not measurement.fitted:
            raise SourceNotApplicable("the waves are stated by hand")
        if options.values is not None:
            return cls(Range.read(cls.name, options.values, length))
        return cls(Range.about(measurement.surface.cutoff_wavelength, math.sqrt(2.0)))

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the end of the roughness at `quantile` of its range."""
        value = self.range.at(quantile)
        return inputs.ended_at(value), {self.name: value}


# The source `waves`: which of the stacks that follow C_z as well as it is known.
#
# `gripscale.surface.sine_ambiguity` finds their numbers of waves and first wavelengths. All of them
# count alike; they are drawn by their rms slope, so that `quantile` spreads them evenly.

CHOSEN = ("s_wavelength", "s_amplitude", "first_wavelength", "first_amplitude")
"""Arguments of a fit that leave no choice of waves."""


@dataclass(frozen=True)
class WavesSource:
    """Number and first wavelength [m] of stacks as good, by rising slope."""

    name: ClassVar[str] = "waves"
    label: ClassVar[str] = "choice of sine waves"
    models: ClassVar[tuple[str, ...]] = ("chain",)
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "waves": Coordinate("1", "number of sine waves"),
        "first_wavelength": Coordinate("m", "wavelength of the largest wave"),
    }

    choices: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, measurement: Measurement, options: SourceOptions) -> WavesSource:
        """Return the source of a case.

        Raises `SourceNotApplicable` if the case leaves no choice, `InputError` if none of the
        stated numbers of waves follows C_z.
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
        wanted = _numbers(options)
        good = [stack for stack in stacks if wanted is None or len(stack) in wanted]
        if not good:
            numbers = sorted({len(stack) for stack in stacks})
            raise InputError(
                f"waves must be among the numbers that follow C_z as well as it is known, "
                f"{numbers[0]} to {numbers[-1]}; got {options.values}"
            )
        return cls(_choices(good))

    def draw(
        self, quantile: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the stack at `quantile`; fewer waves where factors get too small.

        The cut-off of the sample may leave no room for as many waves.
        """
        number, first = self.choices[min(int(quantile * len(self.choices)), len(self.choices) - 1)]
        ended = inputs.ended_at(inputs.end)
        half = 0.5 if ended.fit["cut_off"] is not None else 0.0
        most = 1.0 - half + math.log(first / ended.end) / math.log(FACTOR_RANGE[0])
        fit = {**ended.fit, "scales": min(number, int(most)), "first_wavelength": first}
        coordinates = {"waves": float(number), "first_wavelength": first}
        return replace(inputs, fit=fit), coordinates


def _numbers(options: SourceOptions) -> Sequence[int] | None:
    if options.values is None:
        return None
    values = Range.read(WavesSource.name, options.values, count)
    low, high = int(values.values[0]), int(values.values[-1])
    return range(low, high + 1) if values.between else [int(value) for value in values.values]


def _choices(stacks: Sequence[SineStack]) -> tuple[tuple[int, float], ...]:
    ordered = sorted(stacks, key=lambda stack: float(stack.rms_slope))
    return tuple((len(stack), float(stack.wavelength[0])) for stack in ordered)


# What is not known of a case: each source in a file of its own, all of them in `SOURCES`.

SOURCES: dict[str, Any] = {
    source.name: source
    for source in (
        ProfileSource,
        ModulusSource,
        BulkModulusSource,
        EquilibriumModulusSource,
        LoadTimeSource,
        CutOffSource,
        WavesSource,
    )
}
"""In the order in which they are drawn: the waves are fitted last. A new one is added here."""

LABELS = {name: source.label for name, source in SOURCES.items()}
"""Names of the sources in words."""
