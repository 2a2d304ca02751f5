"""The same study in processes of this machine, one of which may die."""

import os
from dataclasses import dataclass

import pytest

from gripscale import Rubber
from gripscale.case_file import read_case
from gripscale.core.errors import ConvergenceError
from gripscale.experiment.solve import PROCESSES, Bench
from gripscale.experiment.task import Store, Task
from gripscale.model import Load, Model
from gripscale.questions import Study
from gripscale.surface import Surface
from tests.samples import THREE_SINES


def test_processes_change_nothing(case, tmp_path, same_bytes):
    study = Study(read_case(case), {"speed": [0.01, 0.1, 1.0]})
    result = study.run(tmp_path / "processes", client=PROCESSES, workers=2)
    same_bytes(result, study.run(tmp_path / "threads", workers=3))
    same_bytes(result, study.run(tmp_path / "one", workers=1))


@dataclass(frozen=True)
class Dying(Model):
    """Ends its process."""

    name = "dying"

    def predict(self, *_, **__):
        """Return nothing."""
        os._exit(1)


def test_a_process_that_dies_is_one_sentence(tmp_path):
    task = Task(Rubber(6e6), Surface(THREE_SINES, ""), Load(3e5, 0.3, 0.1), Dying())
    with pytest.raises(ConvergenceError, match="short of memory"):
        Bench(Store(tmp_path), 1, PROCESSES).solve({"dying": task})
