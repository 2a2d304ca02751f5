"""From a master curve to a Prony series, with what the data leave open and a report on both.

Relaxation times are log-spaced over the measured band and two decades beyond its ends. Moduli are
the non-negative least squares of `maxwell_fit`, their number comes from `term_choice`, rows that do
not belong to the curve are found by `outliers`, the other series that fit by `extremes`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber import material_checks
from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.exchanged import exchange
from gripscale.rubber.extremes import extremes
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.maxwell_fit import Curve, Prior, Spectrum, fit_spectrum, relaxation_times
from gripscale.rubber.outliers import Screening, screen
from gripscale.rubber.prony_report import PronyFit, report
from gripscale.rubber.term_choice import Candidate, choose_terms

Array = NDArray[np.float64]

_FEWEST_ROWS = 4
_SMOOTHING = 0.1
_SHRINKAGE = 10.0
"""Weight of slow relaxations beyond the data over that of the smoothing."""
BEYOND, _MOST_DECADES = 2.0, 20.0
_MOST_WEIGHT = 1e6
_GLASS = 1.38
"""Largest modulus of the series over the bulk modulus: Poisson's ratio 0.3, as glasses have it."""
_OVER_MEASURED = 1.5
"""The same over the largest measured E', where that is more."""
_STIFFEST = 4.4
"""The same of any series: Poisson's ratio is zero at 9/2."""


def fit_prony(
    master: MasterCurve,
    *,
    terms: int | None = None,
    bulk_modulus: float = 2e9,
    outlier_threshold: float = 8.0,
    extrapolate_decades: float = BEYOND,
    smoothing: float = _SMOOTHING,
    loss_weight: float = 1.0,
) -> Rubber:
    """Return the Prony series of a master curve.

    Parameters
    ----------
    master : MasterCurve
        At least 4 rows.
    terms : int, optional
        Relaxation times, log-spaced over the measured band; chosen by cross-validation if not
        given. Beyond its ends come more; elements whose modulus comes out as zero are dropped.
    bulk_modulus : float
        Bulk modulus of the rubber [Pa].
    outlier_threshold : float
        Rows further from their neighbours than this many times the typical scatter are left out;
        infinity keeps all.
    extrapolate_decades : float
        How far the relaxation times reach beyond the measured band at both ends [decades]. A
        flank at an end is continued as a power law, a plateau as a plateau. At zero the series is
        bent at the ends: nothing relaxes beyond them.
    smoothing : float
        Weight of the second differences of the spectrum; zero gives the bare non-negative fit.
    loss_weight : float
        Weight of the relative errors of E'' against those of E'.

    Returns
    -------
    Rubber
        With `valid_band` set to the measured band [rad/s], the other series that fit in
        `admissible`, and the reference temperature and the shift of the curve.

    Raises
    ------
    InputError
        If an argument is out of range, `bulk_modulus` is too small for the moduli measured, or
        storage and loss modulus are exchanged (see `gripscale.rubber.exchanged`).
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
    extrapolate_decades: float = BEYOND,
    smoothing: float = _SMOOTHING,
    loss_weight: float = 1.0,
) -> tuple[Rubber, PronyFit]:
    """Return the Prony series of a master curve and the report on it.

    Arguments and errors are those of `fit_prony`.
    """
    checks.instance("master", master, MasterCurve)
    if len(master) < _FEWEST_ROWS or master.decades == 0.0:
        raise InputError(
            f"master must have at least {_FEWEST_ROWS} rows over more than one frequency; "
            f"got {len(master)} over {master.decades:g} decades"
        )
    if terms is not None:
        terms = checks.whole("terms", terms, least=1, most=200)
    checks.positive("outlier_threshold", outlier_threshold, infinite=True)
    beyond = _option("extrapolate_decades", extrapolate_decades, _MOST_DECADES)
    smoothing = _option("smoothing", smoothing, _MOST_WEIGHT)
    loss_weight = checks.positive("loss_weight", _option("loss_weight", loss_weight, _MOST_WEIGHT))
    bulk = material_checks.modulus("bulk_modulus", bulk_modulus)
    exchanged = exchange(master)
    if exchanged.certain:
        raise InputError(str(exchanged))
    curve = Curve(master.angular_frequency, master.storage, master.loss)
    screening = _screen(master, curve, outlier_threshold)
    kept = screening.kept
    rows = curve.rows(kept)
    limit = largest_modulus(float(rows.storage.max()), bulk)
    prior = Prior(smoothing, _SHRINKAGE * smoothing, limit, loss_weight=loss_weight)
    fit = partial(_fit, curve, beyond, prior)
    candidates: tuple[Candidate, ...] = ()
    if terms is None:
        terms, candidates = _choose(curve, fit, kept)
    spectrum = fit(kept, terms)
    scatter = _scatter(rows, spectrum, screening)
    others = extremes(rows, scatter, beyond, _STIFFEST * bulk)
    rubber = _rubber(master, rows, spectrum, bulk, others)
    found = report(master, rows, screening, candidates, rubber)
    if exchanged.likely:
        found = replace(found, findings=(str(exchanged), *found.findings))
    return rubber, found


def _option(name: str, value: float, most: float) -> float:
    """Return an option from zero to `most`."""
    number = checks.not_negative(name, value)
    if number > most:
        raise InputError(f"{name} must be at most {most:g}; got {number:g}")
    return number


def largest_modulus(measured: float, bulk: float) -> float:
    """Return the limit of E_inf + sum E_i [Pa], from the largest measured E' and the bulk modulus.

    Raises `InputError` if the bulk modulus is too small for what was measured.
    """
    if _STIFFEST * bulk <= measured:
        raise InputError(
            f"bulk_modulus [Pa] must exceed 2/9 of the largest measured E', {measured:g}, "
            f"to keep Poisson's ratio positive; got {bulk:g} "
            "(or is the unit of the moduli another?)"
        )
    return min(_STIFFEST * bulk, max(_GLASS * bulk, _OVER_MEASURED * measured))


def _fit(
    curve: Curve, beyond: float, prior: Prior, rows: NDArray[np.bool_], terms: int
) -> Spectrum:
    times = relaxation_times(curve.omega, terms, beyond)
    return fit_spectrum(curve.rows(rows), times, prior)


def _screen(master: MasterCurve, curve: Curve, threshold: float) -> Screening:
    """Find outliers with one fixed fit, so that they do not depend on how the series is wanted."""
    terms = max(4, min(round(2.0 * master.decades), 60))
    prior = Prior(_SMOOTHING, 0.0, 2.0 * float(master.storage.max()))
    fit = partial(_fit, curve, 0.0, prior, terms=terms)
    return screen(curve.omega, curve.storage, curve.loss, fit, threshold)


def _choose(
    curve: Curve, fit: partial[Spectrum], kept: NDArray[np.bool_]
) -> tuple[int, tuple[Candidate, ...]]:
    places = np.flatnonzero(kept)

    def fit_among_kept(rows: NDArray[np.bool_], terms: int) -> Spectrum:
        chosen = np.zeros_like(kept)
        chosen[places[rows]] = True
        return fit(chosen, terms)

    rows = curve.rows(kept)
    return choose_terms(rows.omega, rows.storage, rows.loss, fit_among_kept)


def _scatter(rows: Curve, spectrum: Spectrum, screening: Screening) -> tuple[float, float]:
    """Return the relative scatter of E' and E'' about the fit: what any series has to live with."""
    storage = spectrum.storage(rows.omega) / rows.storage - 1.0
    loss = spectrum.loss(rows.omega) / rows.loss - 1.0
    own = screening.believed_scatter
    return (
        max(own[0], float(np.sqrt(np.mean(storage**2)))),
        max(own[1], float(np.sqrt(np.mean(loss**2)))),
    )


def _rubber(
    master: MasterCurve,
    rows: Curve,
    spectrum: Spectrum,
    bulk_modulus: float,
    admissible: AdmissibleSeries,
) -> Rubber:
    present = spectrum.moduli > 1e-9 * spectrum.moduli.sum()
    return Rubber(
        spectrum.equilibrium,
        spectrum.moduli[present],
        spectrum.times[present],
        bulk_modulus=bulk_modulus,
        name=master.name,
        source=master.source,
        valid_band=(float(rows.omega[0]), float(rows.omega[-1])),
        admissible=admissible,
        reference_temperature=master.reference_temperature,
        shift=master.shift,
    )
