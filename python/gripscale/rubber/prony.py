"""From a master curve to a Prony series, with a report of how well it does.

Relaxation times are log-spaced over the measured band; their moduli are the non-negative least
squares of `maxwell_fit`, their number comes from `term_choice`, rows that do not belong to the
curve are found by `outliers`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.maxwell_fit import Spectrum, fit_spectrum, relaxation_times
from gripscale.rubber.outliers import Screening, screen
from gripscale.rubber.term_choice import Candidate, choose_terms

Array = NDArray[np.float64]

_FEWEST_ROWS = 4
_SMOOTHING = 0.1


@dataclass(frozen=True)
class PronyFit:
    """How a Prony series came about and how well it fits the rows kept."""

    terms: int
    """Maxwell elements with a modulus above zero."""
    candidates: tuple[Candidate, ...] = field(repr=False)
    """Numbers of terms tried and their cross-validation error; empty if the number was given."""
    outlier_frequency: Array
    """Frequencies of the rows left out [Hz]."""
    outlier_storage_deviation: Array = field(repr=False)
    """Their log deviation in E' from the local trend [-]."""
    outlier_loss_deviation: Array = field(repr=False)
    """The same in E''."""
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

    @property
    def consistent(self) -> bool:
        """Whether the fit misses E' and E'' by no more than about twice their scatter.

        If not, no generalized Maxwell solid has both moduli (they break the Kramers-Kronig
        relation): vertical shifts left out, strain amplitudes that differ between sets, or a
        non-linear filler network are the usual causes.
        """
        return self.rms_storage <= 2.0 * max(self.storage_scatter, 0.02) and (
            self.rms_loss <= 2.0 * max(self.loss_scatter, 0.02)
        )

    def summary(self) -> str:
        """Return the report as a few lines of text."""
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
        if not self.consistent:
            lines.append(
                "no generalized Maxwell solid has both the measured E' and E'': within their "
                "scatter they are not Kramers-Kronig consistent"
            )
        return "\n".join(lines)


def fit_prony(
    master: MasterCurve,
    *,
    terms: int | None = None,
    bulk_modulus: float = 2e9,
    outlier_threshold: float = 8.0,
    extrapolate_decades: float = 0.0,
    smoothing: float = _SMOOTHING,
    loss_weight: float = 1.0,
) -> Rubber:
    """Return the Prony series of a master curve.

    Parameters
    ----------
    master : MasterCurve
        At least 4 rows.
    terms : int, optional
        Relaxation times, log-spaced over the band; chosen by cross-validation if not given.
        Elements whose modulus comes out as zero are dropped.
    bulk_modulus : float
        Bulk modulus of the rubber [Pa].
    outlier_threshold : float
        Rows further from their neighbours than this many times the typical scatter are left out;
        infinity keeps all.
    extrapolate_decades : float
        How far the relaxation times reach beyond the measured band at both ends [decades]. At
        zero the equilibrium modulus is the modulus at the slow end as nearly as the data allow.
    smoothing : float
        Weight of the second differences of the spectrum; zero gives the bare non-negative fit.
    loss_weight : float
        Weight of the relative errors of E'' against those of E'.

    Returns
    -------
    Rubber
        With `valid_band` set to the measured band [rad/s].

    Raises
    ------
    InputError
        If an argument is out of range or `bulk_modulus` is too small for the glassy modulus found.
    """
    rubber, _ = fit_prony_report(
        master,
        terms=terms,
        bulk_modulus=bulk_modulus,
        outlier_threshold=outlier_threshold,
        extrapolate_decades=extrapolate_decades,
        smoothing=smoothing,
        loss_weight=loss_weight,
    )
    return rubber


def fit_prony_report(
    master: MasterCurve,
    *,
    terms: int | None = None,
    bulk_modulus: float = 2e9,
    outlier_threshold: float = 8.0,
    extrapolate_decades: float = 0.0,
    smoothing: float = _SMOOTHING,
    loss_weight: float = 1.0,
) -> tuple[Rubber, PronyFit]:
    """Return the Prony series of a master curve and the report on it.

    Arguments and errors are those of `fit_prony`.
    """
    if len(master) < _FEWEST_ROWS or master.decades == 0.0:
        raise InputError(
            f"master must have at least {_FEWEST_ROWS} rows over more than one frequency; "
            f"got {len(master)} over {master.decades:g} decades"
        )
    if terms is not None:
        terms = checks.whole("terms", terms, least=1, most=200)
    checks.positive("outlier_threshold", outlier_threshold, infinite=True)
    beyond = checks.not_negative("extrapolate_decades", extrapolate_decades, unit="decades")
    fit = partial(
        _fit,
        master.angular_frequency,
        master.storage,
        master.loss,
        beyond,
        checks.not_negative("smoothing", smoothing),
        checks.positive("loss_weight", loss_weight),
    )
    screening = _screen(master, outlier_threshold)
    kept = screening.kept
    candidates: tuple[Candidate, ...] = ()
    if terms is None:
        terms, candidates = _choose(master, fit, kept)
    spectrum = fit(kept, terms)
    rubber = _rubber(master, kept, spectrum, bulk_modulus)
    return rubber, _report(master, screening, candidates, rubber)


def _fit(
    omega: Array,
    storage: Array,
    loss: Array,
    beyond: float,
    smoothing: float,
    loss_weight: float,
    rows: NDArray[np.bool_],
    terms: int,
) -> Spectrum:
    times = relaxation_times(omega, terms, beyond)
    return fit_spectrum(omega[rows], storage[rows], loss[rows], times, smoothing, loss_weight)


def _screen(master: MasterCurve, threshold: float) -> Screening:
    """Find outliers with one fixed fit, so that they do not depend on how the series is wanted."""
    curve = master.angular_frequency, master.storage, master.loss
    terms = max(4, min(round(2.0 * master.decades), 60))
    fit = partial(_fit, *curve, 0.0, _SMOOTHING, 1.0, terms=terms)
    return screen(*curve, fit, threshold)


def _choose(
    master: MasterCurve, fit: partial[Spectrum], kept: NDArray[np.bool_]
) -> tuple[int, tuple[Candidate, ...]]:
    places = np.flatnonzero(kept)

    def fit_among_kept(rows: NDArray[np.bool_], terms: int) -> Spectrum:
        chosen = np.zeros_like(kept)
        chosen[places[rows]] = True
        return fit(chosen, terms)

    return choose_terms(
        master.angular_frequency[kept], master.storage[kept], master.loss[kept], fit_among_kept
    )


def _rubber(
    master: MasterCurve, kept: NDArray[np.bool_], spectrum: Spectrum, bulk_modulus: float
) -> Rubber:
    present = spectrum.moduli > 1e-9 * spectrum.moduli.sum()
    omega = master.angular_frequency[kept]
    return Rubber(
        spectrum.equilibrium,
        spectrum.moduli[present],
        spectrum.times[present],
        bulk_modulus=bulk_modulus,
        name=master.name,
        source=master.source,
        valid_band=(float(omega[0]), float(omega[-1])),
    )


def _report(
    master: MasterCurve, screening: Screening, candidates: tuple[Candidate, ...], rubber: Rubber
) -> PronyFit:
    kept = screening.kept
    modulus = rubber.complex_modulus(master.angular_frequency[kept])
    loss_factor_error = modulus.imag / modulus.real / master.loss_factor[kept] - 1.0
    assert rubber.valid_band is not None
    return PronyFit(
        terms=len(rubber.moduli),
        candidates=candidates,
        outlier_frequency=master.frequency[~kept],
        outlier_storage_deviation=screening.storage_deviation[~kept],
        outlier_loss_deviation=screening.loss_deviation[~kept],
        rms_storage=_rms(modulus.real / master.storage[kept] - 1.0),
        rms_loss=_rms(modulus.imag / master.loss[kept] - 1.0),
        rms_loss_factor=_rms(loss_factor_error),
        mean_loss_factor_error=float(loss_factor_error.mean()),
        storage_scatter=screening.storage_scatter,
        loss_scatter=screening.loss_scatter,
        measured_band=rubber.valid_band,
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
