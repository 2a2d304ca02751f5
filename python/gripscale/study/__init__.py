"""Studies: a case with its inputs varied, on all cores or a cluster, resumed where they stopped."""

from gripscale.study.solving import Progress, solve_all
from gripscale.study.store import Store
from gripscale.study.study import Study
from gripscale.study.task import Task, solve_task

__all__ = ["Progress", "Store", "Study", "Task", "solve_all", "solve_task"]
