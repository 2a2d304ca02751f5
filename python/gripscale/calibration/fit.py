"""Fitting the area term to measured friction; the hysteresis is never fitted.

mu_measured = mu_hysteresis(v, T, p) + tau_f(v, T; theta) A_r/(A_0 p)
"""

from __future__ import annotations

from collections.abc import Mapping

from gripscale import checks
from gripscale.calibration.held_out import groups_of, held_out
from gripscale.calibration.least_squares import Optimum, Problem, best
from gripscale.calibration.parameters import family_of
from gripscale.calibration.points import points_of
from gripscale.calibration.profile import Profile, settled, threshold_of
from gripscale.calibration.result import Calibration
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.predicted import Predicted


def calibrate(
    measured: MeasuredFriction,
    predicted: Predicted,
    *,
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
) -> Calibration:
    """Fit a law of the interfacial shear stress to measured friction.

    Weighted with the spread of the measurement; without any, all points weigh the same and the
    scatter of the residuals is taken for it.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : Predicted
        The hysteresis and the real contact area at its points, see `predictions_at`.
    law : str
        "constant", "gaussian" or "le_gal_klueppel", see `gripscale.interface`.
    fixed : mapping of str to float, optional
        Parameters of the law that are known [SI units, eV], by name.
    hold_out : str, optional
        "temperature" or "speed": predict each temperature, or each decade of speed, from the
        others.

    Raises
    ------
    InputError
        If a value cannot be used, points are too few for the law, or the hysteresis alone exceeds
        what was measured at more than half of the points.
    """
    checks.instance("measured", measured, MeasuredFriction)
    checks.instance("predicted", predicted, Predicted)
    known = {} if fixed is None else dict(checks.instance("fixed", fixed, Mapping))  # type: ignore[type-abstract]
    points = points_of(measured, predicted)
    problem = Problem(points, family_of(law, points, known))
    groups = None
    if hold_out is not None:
        groups = groups_of(hold_out, measured.speed, measured.temperature)[predicted.known]
    optimum, ends = settled(
        problem, best(problem), lambda found: _ends(problem, found, points.spread is not None)
    )
    out = () if groups is None else held_out(points, groups, law, known)
    return Calibration(measured, predicted, problem, optimum, tuple(ends), out, hold_out or "")


def _ends(problem: Problem, optimum: Optimum, known: bool) -> list[tuple[float, float]]:
    threshold = threshold_of(optimum, known=known)
    profiles = [Profile(problem, optimum, place) for place in range(len(problem.family.free))]
    return [(one.end(-1, threshold), one.end(1, threshold)) for one in profiles]
