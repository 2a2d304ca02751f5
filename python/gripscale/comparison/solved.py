"""A rung with its answers: means, what they scatter by, and what is known of their errors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gripscale.comparison.rung import Rung
from gripscale.comparison.sample import CONVERGED, Sample
from gripscale.comparison.uncertain import Uncertain, of_mean, together
from gripscale.cut_off_exponents import CutOffExponents
from gripscale.cut_off_exponents import of_mean as exponents_of_mean
from gripscale.rubber.extrapolation import Extrapolation, of_sum


@dataclass(frozen=True, eq=False)
class SolvedRung:
    """What one model says, over its samples (profiles, seeds of random phases).

    Numbers are those of the samples that converged; `status` says of the others, if there are any.
    """

    rung: Rung
    samples: Sequence[Sample] = field(repr=False)

    @property
    def name(self) -> str:
        """Word for it in result files."""
        return self.rung.name

    @property
    def label(self) -> str:
        """In words."""
        return self.rung.label

    @property
    def converged(self) -> list[Sample]:
        """The samples that may be used."""
        return [sample for sample in self.samples if sample.converged]

    @property
    def status(self) -> str:
        """`converged`, or how many samples did not and what the first of them says."""
        bad = [sample.status for sample in self.samples if not sample.converged]
        if not bad:
            return CONVERGED
        count = len(self.samples)
        return bad[0] if count == 1 else f"{len(bad)} of {count} samples failed: {bad[0]}"

    @property
    def seconds(self) -> float:
        """Time its samples took to solve [s], added up."""
        return sum(sample.seconds for sample in self.samples)

    @property
    def extrapolation(self) -> Extrapolation:
        """What of the samples that may be used rests on the rubber beyond its measured band."""
        parts = [sample.extrapolation for sample in self.converged]
        return of_sum(parts, self.values("friction"))

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """How the means change with the smallest wavelength."""
        parts = [sample.cut_off_exponents for sample in self.converged]
        return exponents_of_mean(parts, self.values("contact_fraction"), self.values("friction"))

    def mean(self, name: str) -> float:
        """Return the mean of a number of the samples, such as `friction`; NaN if none converged."""
        return float(self.values(name).mean()) if self.converged else math.nan

    def spread(self, name: str) -> float:
        """Return the standard deviation over the samples; NaN for a single one."""
        values = self.values(name)
        return float(np.std(values, ddof=1)) if values.size > 1 else math.nan

    def values(self, name: str) -> NDArray[np.float64]:
        """Return a number of each sample that converged."""
        return np.array([getattr(sample, name) for sample in self.converged], dtype=float)

    def uncertain(self, name: str) -> Uncertain:
        """Return the mean with its uncertainty: scatter of the samples and estimated errors.

        Of several things sampled (profiles) the scatter is that of their means: what is drawn of
        one of them again and again tells nothing of the others.
        """
        scatter = of_mean(self._independent(name))
        return Uncertain(self.mean(name), together([scatter, self._error(name)]))

    def over(self, other: SolvedRung, name: str) -> Uncertain:
        """Return the factor from `other` to this rung.

        Where both have one sample each of the same things, only what those have in both counts and
        the uncertainty is from the scatter of their ratios; else from the scatter of both.
        """
        if not self.pairs_with(other):
            return self.uncertain(name).over(other.uncertain(name))
        both = [
            (getattr(own, name), getattr(its, name))
            for own, its in zip(self.samples, other.samples, strict=True)
            if own.converged and its.converged
        ]
        if not both:
            return Uncertain(math.nan)
        own, its = np.array(both).T
        ratio = own.mean() / its.mean() if its.mean() else math.nan
        scatter = of_mean(own / its) if (its > 0.0).all() else math.nan
        return Uncertain(ratio, together([scatter, self._error(name), other._error(name)]))

    def pairs_with(self, other: SolvedRung) -> bool:
        """Return whether both rungs have one sample each of the same two things or more."""
        own, its = ([sample.of for sample in one.samples] for one in (self, other))
        return len(own) > 1 and own == its and len(set(own)) == len(own)

    def _independent(self, name: str) -> NDArray[np.float64]:
        """Return the mean of each thing sampled, or the samples of a single one."""
        things = dict.fromkeys(sample.of for sample in self.converged)
        if len(things) < 2:
            return self.values(name)
        each = ([s for s in self.converged if s.of == thing] for thing in things)
        return np.array([np.mean([getattr(s, name) for s in group]) for group in each])

    def _error(self, name: str) -> float:
        """Return the mean error of the samples as their models estimate it, relative."""
        errors = self.values(f"{name.removesuffix('_from_dissipation')}_error")
        mean = self.mean(name)
        known = errors[np.isfinite(errors)]
        return float(known.mean() / abs(mean)) if known.size and mean else math.nan
