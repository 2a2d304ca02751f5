"""How far the conditions of an answer may be off, as factors of one with a standard error.

The contact is solved again on its first full grid with each of the conditions that may be true as
well (`gripscale.conditions.alternatives`); the change of friction and area is their error. How far
the rule of the strain may be off was measured once (`gripscale.conditions.strain_rule`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

from gripscale.case import Case
from gripscale.conditions.alternatives import alternatives
from gripscale.conditions.conditions import Conditions
from gripscale.conditions.dry_road import DRY_TREAD, STRESS_SCATTER
from gripscale.conditions.strain_rule import AREA_SCATTER, FRICTION_SCATTER
from gripscale.experiment.design import Design, Point, solve_design
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.half_space.model import DirectContact
from gripscale.model import Load
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.estimate import ESTIMATED, Factor, LogNormalValue
from gripscale.questions.answer.measurements import each_measured


@lru_cache(maxsize=16)
def condition_factors(case: Case, load: Load) -> Sequence[Factor]:
    """Return the factors of the conditions of a case under a load.

    They are solved on the first measurement alone: ratios hardly differ between profiles.
    """
    conditions = case.conditions
    if conditions is None:
        return []
    every = list(alternatives(conditions))
    factors = [_factor("strain rule", AREA_SCATTER, FRICTION_SCATTER)]
    factors = factors if conditions.softening is not None else []
    if not every:
        return factors
    _, surface = each_measured(case.surface)[0]
    models = [
        DirectContact(tolerance=None, conditions=effects)
        for effects in (conditions, *(each.conditions for each in every))
    ]
    points = [
        Point((at, 0), f"conditions {at}", Task(case.rubber, surface, load, model))
        for at, model in enumerate(models)
    ]
    design = Design({"conditions": len(points), "sample": 1}, points, {})
    solved = solve_design(design, Bench(None), reduce.sample_numbers)
    numbers = {name: reduce.usable(solved, ESTIMATED[name]).values[:, 0] for name in ESTIMATED}
    for at, each in enumerate(every, start=1):
        changes = {
            name: each.share * abs(math.log(values[at] / values[0])) if values[at] > 0.0 else 0.0
            for name, values in numbers.items()
        }
        factors.append(_factor(each.label, changes["contact_fraction"], changes["friction"]))
    return factors


def stress_error(conditions: Conditions | None) -> float:
    """Return the standard error of the logarithm of the shear stress of the area term [-].

    That between compounds for the typical stress of a dry road; a stated stress is taken as it is.
    """
    return STRESS_SCATTER if conditions and conditions.shear_stress == DRY_TREAD else 0.0


def _factor(label: str, area: float, friction: float) -> Factor:
    return Factor(label, label, LogNormalValue(1.0, area), LogNormalValue(1.0, friction))
