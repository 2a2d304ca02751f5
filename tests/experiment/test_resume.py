"""A study that was killed goes on where it was, and ends in the same bytes."""

import os
import signal
import subprocess
import sys
import threading

import pytest

from gripscale.case_file import read_case
from gripscale.core.parallel import Stopped
from gripscale.experiment import Store
from gripscale.questions import Study

VARY = {"speed": "0.01:1:log3", "pressure": "1 bar,3 bar"}
PROGRAM = """
import sys
from gripscale.case_file import read_case
from gripscale.questions import Study
vary = {"speed": "0.01:1:log3", "pressure": "1 bar,3 bar"}
Study(read_case(sys.argv[1]), vary).run(
    sys.argv[2], workers=2, on_task=lambda told: print(told.done, told.label, flush=True)
)
"""


def killed_after(count, case, folder):
    """Run the study in a process of its own and `kill -9` it after so many chains."""
    command = [sys.executable, "-c", PROGRAM, str(case), str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for _ in range(count):
            assert process.stdout.readline()
        os.kill(process.pid, signal.SIGKILL)
        process.communicate()
    assert process.returncode == -signal.SIGKILL


def test_killed_study_resumes_to_the_same_bytes(case, tmp_path, same_bytes):
    killed_after(2, case, tmp_path / "killed")
    cases = tmp_path / "killed" / "predictions"
    kept = {path.name: path.stat().st_mtime_ns for path in cases.glob("[!.]*.nc")}
    assert 2 <= len(kept) < 6
    assert not (tmp_path / "killed" / "study.nc").exists()

    told = []
    study = Study(read_case(case), VARY)
    resumed = study.run(tmp_path / "killed", on_task=told.append)
    assert sum(t.stored for t in told) == len(kept)
    assert sum(not t.stored for t in told) == 6 - len(kept)
    assert all((cases / name).stat().st_mtime_ns == when for name, when in kept.items())
    same_bytes(resumed, study.run(tmp_path / "whole", workers=1))

    told.clear()
    same_bytes(resumed, study.run(tmp_path / "killed", on_task=told.append))
    assert len(told) == 6
    assert all(task.stored for task in told), "a whole study is read"


def test_damaged_file_counts_as_not_there(case, tmp_path, same_bytes):
    study = Study(read_case(case), {"speed": [0.01, 1.0]})
    first = study.run(tmp_path)
    store = Store(tmp_path / "predictions")
    cut, foreign = (store.path(point.task.key) for point in study.points)
    foreign.write_bytes(cut.read_bytes())  # a whole file under the wrong name
    cut.write_bytes(cut.read_bytes()[:1000])
    (tmp_path / "study.nc").unlink()
    told = []
    same_bytes(first, study.run(tmp_path, on_task=told.append))
    assert [t.stored for t in told] == [False, False]


def test_study_stopped_by_the_caller_keeps_what_was_solved_and_solves_no_more(case, tmp_path):
    def stop(progress):
        raise KeyboardInterrupt

    study = Study(read_case(case), {"speed": "0.01:1:log8"})
    with pytest.raises(KeyboardInterrupt):
        study.run(tmp_path, workers=2, on_task=stop)
    assert not [t for t in threading.enumerate() if t.name.startswith("gripscale")]
    told = []
    study.run(tmp_path, on_task=told.append)
    assert sum(t.stored for t in told) == 1


def test_chain_is_given_up_between_two_waves(case):
    task = Study(read_case(case), {"speed": [0.1]}).points[0].task
    stop = threading.Event()
    assert task.solve(stop)[1].sizes["scale"] == 3
    stop.set()
    with pytest.raises(Stopped):
        task.solve(stop)
