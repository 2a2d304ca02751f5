"""From a master curve to a Prony series, with what the data leave open and a report on both.

Relaxation times are log-spaced over the measured band and two decades beyond its ends. Moduli are
the non-negative least squares of `maxwell_fit`. The other series that fit are extremes: the z >= 0
with the largest (or least) E' or E'' at a frequency for which

    |A z - b|^2 <= min |A z - b|^2 + 9,

A z = b being the fit in units of the scatter (profile likelihood; D. J. Venzon & S. H. Moolgavkar,
Appl. Stat. 37 (1988) 87, doi:10.2307/2347496): docs/derivations.md. In a table of relaxation times
and moduli, the modulus at inf is the equilibrium modulus, and shear moduli are taken three times.
"""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.core import Array, Quantity, checks, quantity_in_si, spelled
from gripscale.core.errors import FileError, GripscaleError, InputError, RubberWarning
from gripscale.io.text_table import TextTable, is_excel, read_bytes, read_table
from gripscale.rubber import maxwell_fit
from gripscale.rubber import prony_report as report
from gripscale.rubber.admissible import AdmissibleSeries, loss_shape, storage_shape
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import BULK_MODULUS, Rubber
from gripscale.rubber.maxwell_fit import Curve, MaxwellSpectrum, Prior
from gripscale.rubber.prony_report import PronyFit, SwappedModuli, root_mean_square

_RISE = 9.0  # allowed rise of the sum of squares in units of the scatter
EXTREME_SMOOTHING = 1.0
_PER_DECADE = 2.0  # relaxation times per decade: E'' of equal elements then ripples by 0.04 %
_MOST_TERMS = 80
_INSIDE = 2.0  # decades between the frequencies within the band at which extremes are sought
_HEAVY = 1e3
_FIRST_STEP, _LARGEST_STEP, _HALVINGS = 0.02, 12.0, 6
_LEAST_SHARE = 1e-4  # share of the smallest measured E'' below which a modulus counts as nothing
_DIGITS = 6


def extremes(
    curve: Curve, scatter: tuple[float, float], beyond: float, largest_modulus: float
) -> AdmissibleSeries:
    """Return the extreme series for a scatter [-] of E' and E''; `beyond` is in decades."""
    problem = open_equations(curve, scatter, beyond, largest_modulus)
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    orthogonal, triangle = np.linalg.qr(problem.matrix)
    reduced = replace(problem, matrix=triangle, right=orthogonal.T @ problem.right)
    best = maxwell_fit.non_negative(reduced.matrix, reduced.right)
    solutions, least = [best], _LEAST_SHARE * float(curve.loss.min())
    # Sought in the band, and once and twice half-way beyond it.
    low, high = curve.omega[0], curve.omega[-1]
    inside = np.geomspace(low, high, max(1, round(decades / _INSIDE)) + 1)
    outside = 10.0 ** (beyond * np.array([0.5, 1.0])) if beyond > 0.0 else np.zeros(0)
    for omega in np.concatenate([low / outside, inside, high * outside]):
        phase = omega * problem.times
        shapes = storage_shape(phase), loss_shape(phase)
        storage = np.concatenate([[problem.unit], shapes[0] * problem.scale, [0.0]])
        loss = np.concatenate([[0.0], shapes[1] * problem.scale, [0.0]])
        for row, offset in ((storage, problem.floor), (loss, 0.0)):
            solutions += [_furthest(reduced, best, row, offset, s, least) for s in (1.0, -1.0)]
    every = np.array(solutions)
    moduli = every[:, 1:-1] * problem.scale
    equilibrium = problem.floor + problem.unit * every[:, 0]
    # Elements of no weight count as zero.
    moduli[moduli <= 1e-9 * (moduli.sum(axis=1, keepdims=True) + equilibrium[:, None])] = 0.0
    series = problem.times, _rounded(equilibrium), _rounded(moduli)
    return AdmissibleSeries(*series, curve.omega, curve.storage, curve.loss)


def open_equations(
    curve: Curve, scatter: tuple[float, float], beyond: float, largest_modulus: float
) -> maxwell_fit.Equations:
    """Return the equations in units of the scatter, smoothed so little that the data decide."""
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    terms = min(max(2, round(_PER_DECADE * decades) + 1), _MOST_TERMS)
    times = maxwell_fit.relaxation_times(curve.omega, terms, beyond)
    weights = largest_modulus, 1.0 / scatter[0], 1.0 / scatter[1]
    prior = Prior(EXTREME_SMOOTHING, EXTREME_SMOOTHING, *weights)
    return maxwell_fit.fit_equations(curve, times, prior)


def _furthest(
    problem: maxwell_fit.Equations,
    best: Array,
    row: Array,
    offset: float,
    direction: float,
    least: float,
) -> Array:
    """Return the allowed solution with the largest (1) or least (-1) `row`, down to `least`."""
    start = max(float(row @ best) + offset, least)
    inside, outside, lowest = 0.0, _FIRST_STEP, problem.squares(best)
    matrix = np.vstack([problem.matrix, _HEAVY * (row / start)])

    def at(step: Quantity) -> tuple[Array, bool]:
        value = max(start * math.exp(direction * step) - offset, 0.0)
        right = np.append(problem.right, _HEAVY * (value / start))
        solution = maxwell_fit.non_negative(matrix, right)
        return solution, problem.squares(solution) - lowest <= _RISE

    solution, allowed = at(outside)
    while allowed and outside < _LARGEST_STEP:
        inside, best, outside = outside, solution, 2.0 * outside
        solution, allowed = at(outside)
    for _ in range(_HALVINGS):
        middle = 0.5 * (inside + outside)
        solution, allowed = at(middle)
        if allowed:
            inside, best = middle, solution
        else:
            outside = middle
    return best


def _rounded(values: Array) -> Array:
    with np.errstate(divide="ignore"):
        digit = 10.0 ** (np.floor(np.log10(np.where(values > 0.0, values, 1.0))) - _DIGITS + 1)
    return np.asarray(np.round(values / digit) * digit)


_FEWEST_ROWS = 4
_SMOOTHING = 0.1
_SHRINKAGE = 10.0  # weight of slow relaxations beyond the data over that of the smoothing
DECADES_BEYOND, _MOST_DECADES = 2.0, 20.0
_MOST_WEIGHT = 1e6
# Largest modulus of the series over the bulk modulus: Poisson's ratio 0.3, as glasses have it.
_GLASS = 1.38
_OVER_MEASURED = 1.5  # the same over the largest measured E', where that is more
_STIFFEST = 4.4  # the same of any series: Poisson's ratio is zero at 9/2


def fit_prony(master: MasterCurve, **options: Any) -> Rubber:
    """Return the Prony series of a master curve; options and errors as of `fit_prony_report`.

    Warns (`RubberWarning`) of what the report says against the moduli or the fit, and of moduli
    without a temperature.

        >>> f"{gs.fit_prony(master).glassy_modulus:.1e}"
        '5.8e+08'
    """
    rubber, fit = fit_prony_report(master, **options)
    sentences = [*map(str, fit.doubts), *fit.findings]
    if rubber.reference_temperature is None:
        sentences.append("the temperature of the moduli is not known; give reference_temperature")
    for sentence in sentences:
        warnings.warn(f"Prony fit of {rubber.name}: {sentence}", RubberWarning, stacklevel=2)
    return rubber


def fit_prony_report(
    master: MasterCurve,
    *,
    terms: int | None = None,
    bulk_modulus: Quantity = BULK_MODULUS,
    outlier_threshold: float = 8.0,
    extrapolate_decades: float = DECADES_BEYOND,
    smoothing: float = _SMOOTHING,
) -> tuple[Rubber, PronyFit]:
    """Return the Prony series of a master curve and the report on it.

    The rubber has the measured band [rad/s] as `valid_band`, the other series that fit in
    `admissible`, and the reference temperature and the shift of the curve. Raises `InputError` if
    an argument is out of range, `bulk_modulus` is too small for the moduli measured, or storage and
    loss modulus are exchanged (see `gripscale.rubber.prony_report`).

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
        Weight of the second differences of the spectrum; zero gives the bare non-negative fit. With
        16 relaxation times a decade, for few sharp relaxations, a hundredth of it counts.
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
    bulk = checks.positive("bulk_modulus", bulk_modulus, unit="Pa")
    swapped = SwappedModuli(master)
    if swapped.certain and not swapped.reading:
        raise InputError(str(swapped))
    curve = Curve(master.angular_frequency, master.storage, master.loss)
    # Outliers are found with one fixed fit, so that they do not depend on the series wanted.
    plain = Prior(_SMOOTHING, 0.0, 2.0 * float(master.storage.max()))
    coarse = max(4, min(round(2.0 * master.decades), 60))
    times = maxwell_fit.relaxation_times(curve.omega, coarse, 0.0)
    screening = maxwell_fit.screen_outliers(curve, times, plain, outlier_threshold)
    rows = curve.rows(screening.kept)
    limit = largest_modulus(float(rows.storage.max()), bulk)
    prior = Prior(smoothing, _SHRINKAGE * smoothing, limit)

    def fit(part: Curve, terms: int) -> MaxwellSpectrum:
        times = maxwell_fit.relaxation_times(curve.omega, terms, beyond)
        return maxwell_fit.fit_spectrum(part, times, maxwell_fit.prior_for(terms, rows, prior))

    candidates: tuple[maxwell_fit.Candidate, ...] = ()
    if terms is None:
        terms, candidates = maxwell_fit.choose_terms(rows, fit)
    spectrum = fit(rows, terms)
    # The scatter about the fit: what any series has to live with.
    storage_scatter, loss_scatter = (
        max(least, root_mean_square(ratio - 1.0))
        for least, ratio in zip(screening.believed_scatter, spectrum.ratios(rows), strict=True)
    )
    rubber = Rubber(
        spectrum.equilibrium,
        bulk_modulus=bulk,
        name=master.name,
        source=master.source,
        valid_band=(float(rows.omega[0]), float(rows.omega[-1])),
        admissible=extremes(rows, (storage_scatter, loss_scatter), beyond, _STIFFEST * bulk),
        reference_temperature=master.reference_temperature,
        shift=master.shift,
    )
    used = maxwell_fit.prior_for(terms, rows, prior)
    problem = maxwell_fit.FitProblem(rows, spectrum.times, used)
    rubber = problem.applied_to(rubber)
    fit_report = report.report_prony(master, problem, screening, candidates, rubber)
    doubts = tuple(swapped.doubts(screening.storage_scatter))
    exchanged = (str(swapped),) if swapped.likely and not swapped.reading else ()
    findings = (*exchanged, *fit_report.findings)
    return rubber, replace(fit_report, findings=findings, doubts=doubts)


def _option(name: str, value: float, most: float) -> float:
    number = checks.not_negative(name, value)
    if number > most:
        raise InputError(f"{name} must be at most {most:g}; got {number:g}")
    return number


def largest_modulus(measured: float, bulk: float) -> float:
    """Return the limit of E_inf + sum E_i [Pa]; `InputError` if `bulk` is too small for E'."""
    if _STIFFEST * bulk <= measured:
        raise InputError(
            f"bulk_modulus [Pa] must exceed 2/9 of the largest measured E', {measured:g}, "
            f"to keep Poisson's ratio positive; got {bulk:g} "
            "(or is the unit of the moduli another?)"
        )
    return min(_STIFFEST * bulk, max(_GLASS * bulk, _OVER_MEASURED * measured))


_TIME = re.compile(r"\W*(tau|τ|relax\w*[ _-]?(time|zeit)|temps de relax)", re.IGNORECASE)
_MODULUS = re.compile(r"\W*([EG]_?[ijkn\d]?$|(young|shear|relax\w*)?[ _-]?modul)", re.IGNORECASE)
_MOST_BYTES = 100_000  # of a table with a row for each term


def _table(path: Path) -> tuple[TextTable, int, int] | None:
    if is_excel(path) or len(read_bytes(path)) > _MOST_BYTES:
        return None
    try:
        table = read_table(
            path,
            "rows of relaxation time and modulus",
            kinds=("time", "modulus"),
            named=lambda name: bool(_TIME.match(name)),
        )
    except GripscaleError:
        return None
    times, moduli = (
        [at for at, name in enumerate(table.names) if p.match(name)] for p in (_TIME, _MODULUS)
    )
    return (table, times[0], moduli[0]) if len(times) == len(moduli) == 1 else None


def holds_prony_table(path: Path) -> bool:
    """Return whether a file is a table of relaxation times and moduli, by its titles."""
    return path.is_file() and _table(path) is not None


def read_prony_table(
    path: Path, *, modulus: str | None = None, modulus_unit: str | None = None
) -> dict[str, object]:
    """Return what `Rubber.from_dict` needs: moduli [Pa], relaxation times [s], equilibrium modulus.

    `modulus` is E or G and `modulus_unit` a unit, where the titles do not say. Raises `FileError`
    and `InputError` for a table that lacks one of these.
    """
    columns = _table(path)
    if columns is None:
        raise FileError(f"{path}: expected columns of relaxation time and modulus")
    table, time, column = columns
    layout = FileLayout(modulus=modulus, modulus_unit=modulus_unit)
    unit, kind = layout.unit(table, column, "modulus"), layout.modulus_of(table, [column])
    times = table.numbers(time, "a relaxation time", missing=True)
    times *= quantity_in_si(1.0, spelled(table.columns[time].unit, "time") or "s", "time")
    values = quantity_in_si(table.numbers(column, "a modulus"), unit, "modulus")
    values = values * (3.0 if kind == "G" else 1.0)
    endless = np.isnan(times)
    if endless.sum() != 1:
        raise FileError(
            f"{path}: expected one row with inf as relaxation time, the equilibrium modulus; got "
            f"{int(endless.sum())} among {len(times)} rows"
        )
    return {
        "equilibrium_modulus": float(values[endless][0]),
        "moduli": values[~endless].tolist(),
        "relaxation_times": times[~endless].tolist(),
    }
