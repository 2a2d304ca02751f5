"""How well a Prony series fits its master curve, and what is doubtful about it.

Local misfits are means over nine neighbouring rows. Where even the best non-negative series misses
them, the measured E' and E'' are not those of one linear solid (Kramers-Kronig); swapped ones are
fitted better the other way round: docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from gripscale.core import Array, CaseKey, ComplexArray, Described, Finding, Topic, doubt
from gripscale.core.units import UNITS
from gripscale.rubber import maxwell_fit
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import BEYOND, Rubber, fast_end, slow_end, too_compressible
from gripscale.rubber.maxwell_fit import Candidate, Curve, FitProblem, Prior, Screening

_WINDOW = 9
_ALLOWED = 1.5  # local mean over scatter that is believed: four and a half times its own scatter
END_ROWS = 5


@dataclass(frozen=True, repr=False)
class Misfit(Described):
    """A range of frequencies, and the largest local mean of fit over data less one in it."""

    low: float
    """Lowest angular frequency [rad/s]."""
    high: float
    """Highest angular frequency [rad/s]."""
    storage: float
    """Of E' [-], negative where the fit is below the data."""
    loss: float
    """Of E'' [-]."""

    def __str__(self) -> str:
        return (
            f"{self.low:.3g} to {self.high:.3g} rad/s "
            f"(E' {self.storage:+.0%}, E'' {self.loss:+.0%})"
        )


def local_misfits(
    curve: Curve, errors: tuple[Array, Array], scatter: tuple[float, float]
) -> tuple[Misfit, ...]:
    """Return where the local mean of the `errors` of E' and E'' [-] exceeds their scatter [-]."""
    size = min(_WINDOW, len(curve.omega))
    # The mean of each row and its neighbours, of as many near the ends.
    start = np.arange(len(curve.omega)) - size // 2
    inside = np.clip(start, 0, len(curve.omega) - size)
    window = np.full(size, 1.0 / size)
    local = [np.convolve(error, window, mode="valid")[inside] for error in errors]
    beyond = [np.abs(mean) > _ALLOWED * width for mean, width in zip(local, scatter, strict=True)]
    rows = np.flatnonzero(beyond[0] | beyond[1])
    misfits = []
    # Runs with at most two rows between count as one.
    for run in np.split(rows, np.flatnonzero(np.diff(rows) > 3) + 1) if rows.size else []:
        first, last = int(run[0]), int(run[-1])
        parts = (mean[first : last + 1] for mean in local)
        largest = (float(part[np.argmax(np.abs(part))]) for part in parts)
        misfits.append(Misfit(float(curve.omega[first]), float(curve.omega[last]), *largest))
    return tuple(misfits)


_CERTAIN, _CERTAIN_RATIO = 0.5, 3.0
# Misfit as the curves are, and its ratio to that of the swapped ones. Measured and synthetic
# rubbers with ten per cent of noise and loss factors up to 2.7 have at most 0.16; swapped, they
# have 0.37 to 2.6, those with a loss factor of one all over less.
_LIKELY, _LIKELY_RATIO = 0.25, 2.0
_WORST = 3.0  # log error of a row that counts, at most: a modulus of zero has no logarithm
_TIMES_PER_DECADE, _MOST_TIMES = 2.0, 60
_BEYOND = 2.0  # decades of relaxation times beyond both ends: all that a band can tell of
_OVER_MEASURED = 100.0  # limit of the sum of all moduli over the largest measured: none in practice


def misfit(curve: Curve) -> float:
    """Return the root mean square log misfit [-] of the best linear solid to E' and E''."""
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    terms = min(max(4, round(_TIMES_PER_DECADE * decades) + 1), _MOST_TIMES)
    limit = _OVER_MEASURED * float(max(curve.storage.max(), curve.loss.max()))
    times = maxwell_fit.relaxation_times(curve.omega, terms, _BEYOND)
    spectrum = maxwell_fit.fit_spectrum(curve, times, Prior(0.0, 0.0, limit))
    with np.errstate(divide="ignore"):
        return root_mean_square(np.clip(np.log(spectrum.ratios(curve)), -_WORST, _WORST))


# Root mean square log misfit [-] above which a curve is in doubt; the most that rubbers have.
_NO_SOLID, _SOLID = 0.35, 0.16
# Misfit of a reading over that of exchanged moduli, below which it is the likelier cause.
_BETTER = 0.5
_SCATTER = 0.3  # relative scatter of E' about its neighbours that no measurement of one rubber has
# Between these lies the largest E' of a rubber [Pa]: glassy polymers have up to 10 GPa.
_SOFTEST, _STIFFEST = 1e4, 2e10
_GLASS = 1e9  # smallest E' [Pa] of a curve that never leaves the glass: 1 to 3 GPa of polymers


class SwappedModuli:
    """Whether E' and E'' of a master curve are those of a linear solid, exchanged, or read wrongly.

    Root mean square log misfits [-] are those of the best series.
    """

    def __init__(self, master: MasterCurve) -> None:
        self.master, omega = master, master.angular_frequency
        self.as_given = misfit(Curve(omega, master.storage, master.loss))
        self.swapped = misfit(Curve(omega, master.loss, master.storage))

    @property
    def certain(self) -> bool:
        """Whether the two are swapped for sure."""
        return self.as_given > max(_CERTAIN, _CERTAIN_RATIO * self.swapped)

    @property
    def likely(self) -> bool:
        """Whether it looks as if they were."""
        return self.as_given > max(_LIKELY, _LIKELY_RATIO * self.swapped)

    @cached_property
    def reading(self) -> str:
        """What E'' looks like, if a linear solid has it so; empty if it looks exchanged."""
        omega, storage, loss = self.master.angular_frequency, self.master.storage, self.master.loss
        readings = [("like one of a loss factor in %", 0.01 * loss)]
        units = sorted(set(UNITS["modulus"].values()))
        for unit in [*units, *(3.0 * unit for unit in units)]:  # shear moduli were taken 3 times
            readings.append(("like the loss factor (tan delta)", storage * loss / unit))
        degrees = self.master.loss_factor
        if degrees.max() < 90.0:
            words = "like one of a phase angle in degrees, taken for the loss factor"
            readings.append((words, storage * np.tan(np.radians(degrees))))
        for ratio in (1e3, 1e6, 1e9):
            readings.append((f"{ratio:g} times too large", loss / ratio))
            readings.append((f"{ratio:g} times too small", loss * ratio))
        best, words = min((misfit(Curve(omega, storage, read)), words) for words, read in readings)
        return words if best < min(_SOLID, _BETTER * self.swapped) else ""

    def __str__(self) -> str:
        return (
            "storage and loss modulus look exchanged: the nearest linear solid misses them by a "
            f"factor of {math.exp(self.as_given):.2f} in this order, and by "
            f"{math.exp(self.swapped):.2f} in the other; look at the titles of the file, or name "
            "its columns (columns)"
        )

    def doubts(self, scatter: float) -> Iterator[Finding]:
        """Yield why moduli may be those of no rubber; E' has a `scatter` about its neighbours."""
        softest, stiffest = float(self.master.storage.min()), float(self.master.storage.max())
        if softest > _GLASS or not _SOFTEST <= stiffest <= _STIFFEST:
            end, value = ("smallest", softest) if softest > _GLASS else ("largest", stiffest)
            yield doubt(
                f"The {end} E', {value / 1e6:.3g} MPa, is that of no rubber: is the unit of the "
                "moduli right (",
                CaseKey("modulus_unit"),
                ")?",
                topic=Topic.RUBBER,
            )
        if self.as_given <= _NO_SOLID:
            return
        cause = "E'' may be another quantity, or in another unit"
        if scatter > _SCATTER:
            cause = (
                f"rows of nearly one frequency differ by {scatter:.0%}, as of sweeps at several "
                "temperatures in one table"
            )
        elif self.reading:
            cause = f"E'' looks {self.reading}"
        elif self.likely:
            cause = "storage and loss modulus look exchanged"
        elif np.mean(self.master.loss > self.master.storage) > 0.5:
            cause = "E'' is larger than E' in most rows"
        yield doubt(
            "E' and E'' do not belong to one rubber: the nearest linear solid misses them by a "
            f"factor of {math.exp(self.as_given):.2g}; {cause}; look at the titles and units of "
            "the file, or name its columns (",
            CaseKey("columns"),
            ").",
            topic=Topic.RUBBER,
        )


def fit_warnings(
    rubber: Rubber, inconsistencies: Sequence[Misfit], ends: Sequence[Misfit | None]
) -> Iterator[str]:
    """Yield what a reader must know before the rubber is used, a sentence each."""
    if inconsistencies:
        yield (
            "E' and E'' do not belong to one linear solid (Kramers-Kronig) where the best series "
            "misses them by more than their scatter, at most by: "
            + "; ".join(map(str, inconsistencies))
        )
    for name, misfit in zip(("slowest", "fastest"), ends, strict=True):
        if misfit is not None:
            yield (
                f"the mean misfit of the {END_ROWS} {name} rows exceeds the measurement scatter: "
                f"{misfit}"
            )
    assert rubber.valid_band is not None
    low, high = rubber.valid_band
    slow, fast = slow_end(rubber), fast_end(rubber)
    # In a melt E' falls with the square of the frequency, at a plateau not at all.
    here, twice = (complex(rubber.complex_modulus(factor * low)) for factor in (1.0, 2.0))
    if here.imag > here.real and twice.real > 2.0 * here.real:
        yield (
            f"no equilibrium modulus: E' is {slow.modulus / 1e6:.4g} MPa at the slow end and "
            f"still falls, to {rubber.equilibrium_modulus / 1e6:.4g} MPa; the data are those of a "
            "melt, which carries no load at rest"
        )
    elif not slow.plateau:
        yield (
            "no plateau at the slow end: the equilibrium modulus, "
            f"{rubber.equilibrium_modulus / 1e6:.4g} MPa, is an extrapolation; two decades slower "
            f"E' may be {_span(rubber, low / BEYOND)} MPa"
        )
    if not fast.plateau:
        yield (
            f"no plateau at the fast end: E' is still {fast.modulus / 1e6:.4g} MPa there; two "
            f"decades faster it may be {_span(rubber, high * BEYOND)} MPa"
        )
    modulus = abs(complex(rubber.complex_modulus(high)))
    warning = too_compressible(rubber.bulk_modulus, modulus, f"at {high:.3g} rad/s")
    if warning:
        yield warning


def _span(rubber: Rubber, omega: float) -> str:
    low, high = rubber.complex_modulus_band(omega)
    return f"{low.real / 1e6:.4g} to {high.real / 1e6:.4g}"


@dataclass(frozen=True, repr=False)
class PronyFit(Described):
    """How a Prony series came about and how well it fits the rows kept."""

    terms: int
    """Maxwell elements with a modulus above zero."""
    candidates: tuple[Candidate, ...] = field(repr=False)
    """Numbers of terms tried and their cross-validation error; empty if the number was given."""
    outlier_frequency: Array
    """Frequencies of the rows left out [Hz]."""
    rms_storage: float
    """Root mean square of E'_fit/E' - 1 [-]."""
    rms_loss: float
    """Root mean square of E''_fit/E'' - 1 [-]."""
    rms_loss_factor: float
    """Root mean square relative error of E''/E' [-]."""
    mean_loss_factor_error: float
    """Mean relative error of E''/E', negative where the fit is less lossy than measured [-]."""
    storage_scatter: float
    """Robust relative scatter of the measured E' about its local trend [-]."""
    loss_scatter: float
    """The same of E''."""
    measured_band: tuple[float, float]
    """Lowest and highest measured angular frequency among the rows kept [rad/s]."""
    inconsistencies: tuple[Misfit, ...] = ()
    """Where E' and E'' do not belong to one linear solid: even the best series misses them."""
    slow_end: Misfit | None = None
    """How the series misses the five slowest rows; None within their scatter."""
    fast_end: Misfit | None = None
    """The same of the five fastest."""
    problem: FitProblem | None = field(default=None, repr=False)
    """The rows and what else the series was fitted to."""
    doubts: tuple[Finding, ...] = ()
    """Why the moduli may be those of no rubber."""
    findings: tuple[str, ...] = ()
    """What is doubtful, a sentence each."""

    @property
    def consistent(self) -> bool:
        """Whether one linear solid has both E' and E'' within about their scatter, everywhere."""
        return not self.inconsistencies

    def summary(self, *, findings: bool = True) -> str:
        """Return the report as a few lines of text, with or without what is found besides."""
        low, high = self.measured_band
        lines = [
            f"{self.terms} Maxwell elements for {low:.3g} to {high:.3g} rad/s",
            f"rms relative error: E' {self.rms_storage:.1%}, E'' {self.rms_loss:.1%}, "
            f"loss factor {self.rms_loss_factor:.1%} (mean {self.mean_loss_factor_error:+.1%})",
            f"scatter of the data: E' {self.storage_scatter:.1%}, E'' {self.loss_scatter:.1%}",
        ]
        if self.outlier_frequency.size:
            left_out = ", ".join(f"{frequency:.3g}" for frequency in self.outlier_frequency)
            lines.append(f"left out as outliers [Hz]: {left_out}")
        return "\n".join([*lines, *map(str, self.doubts), *(self.findings if findings else ())])


def report_prony(
    master: MasterCurve,
    problem: FitProblem,
    screening: Screening,
    candidates: tuple[Candidate, ...],
    rubber: Rubber,
) -> PronyFit:
    """Return the report on `rubber`, fitted to the rows of `master` that the screening kept."""
    assert rubber.admissible is not None
    rows, scatter = problem.rows, screening.believed_scatter
    modulus = rubber.complex_modulus(rows.omega)
    errors, of_best = (
        (each.real / rows.storage - 1.0, each.imag / rows.loss - 1.0)
        for each in (modulus, rubber.admissible.complex_moduli(rows.omega)[0])
    )
    # of few sharp relaxations the series itself is the best one
    size = np.array(scatter)[:, None]
    best = min(of_best, errors, key=lambda pair: float(np.square(pair / size).sum()))
    inconsistencies = local_misfits(rows, best, scatter)
    ends: list[Misfit | None] = []  # of the first and the last rows, None within the scatter
    for part in (slice(None, END_ROWS), slice(-END_ROWS, None)):
        omega = rows.omega[part]
        storage, loss = (float(error[part].mean()) for error in errors)
        missed = abs(storage) > scatter[0] or abs(loss) > scatter[1]
        misfit = Misfit(float(omega[0]), float(omega[-1]), storage, loss)
        ends.append(misfit if missed else None)
    return PronyFit(
        terms=len(rubber.moduli),
        candidates=candidates,
        outlier_frequency=master.frequency[~screening.kept],
        **sizes_of_errors(modulus, rows),
        storage_scatter=screening.storage_scatter,
        loss_scatter=screening.loss_scatter,
        measured_band=(float(rows.omega[0]), float(rows.omega[-1])),
        inconsistencies=inconsistencies,
        slow_end=ends[0],
        fast_end=ends[1],
        problem=problem,
        findings=tuple(fit_warnings(rubber, inconsistencies, ends)),
    )


def sizes_of_errors(modulus: ComplexArray, rows: Curve) -> dict[str, Any]:
    """Return how large the relative errors of a fitted E* are, as a report names them."""
    storage, loss = modulus.real / rows.storage - 1.0, modulus.imag / rows.loss - 1.0
    loss_factor = modulus.imag / modulus.real / (rows.loss / rows.storage) - 1.0
    return {
        "rms_storage": root_mean_square(storage),
        "rms_loss": root_mean_square(loss),
        "rms_loss_factor": root_mean_square(loss_factor),
        "mean_loss_factor_error": float(loss_factor.mean()),
    }


def root_mean_square(values: Array) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(values**2)))
