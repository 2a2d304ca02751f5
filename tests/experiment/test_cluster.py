"""The same study on a cluster of processes, one of which is killed on the way."""

import logging
import os
import signal

import pytest

from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.experiment import solve
from gripscale.questions import Study

distributed = pytest.importorskip("distributed")

pytestmark = pytest.mark.filterwarnings("default")


@pytest.fixture
def workers():
    """A real local cluster: a scheduler, two worker processes, and what restarts them."""
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        silence_logs=logging.CRITICAL,
    ) as made:
        yield made


def test_worker_killed_on_the_way_changes_nothing(workers, case, tmp_path, same_bytes):
    study = Study(read_case(case), {"speed": "0.003:3:log6"})
    told = []
    with distributed.Client(workers) as client:
        before = set(client.run(os.getpid).values())
        victim = min(before)

        def kill_one(progress):
            told.append(progress)
            if len(told) == 1:
                os.kill(victim, signal.SIGKILL)

        result = study.run(tmp_path / "cluster", client=client, on_task=kill_one)
    assert len(before) == 2
    with pytest.raises(ProcessLookupError):
        os.kill(victim, 0)
    assert [t.done for t in told] == [1, 2, 3, 4, 5, 6]
    same_bytes(result, study.run(tmp_path / "threads"))


def test_scheduler_is_reached_by_its_address(workers, case, tmp_path, same_bytes, monkeypatch):
    study = Study(read_case(case), {"speed": [0.01, 1.0]})
    result = study.run(tmp_path / "cluster", client=workers.scheduler_address)
    same_bytes(result, study.run(tmp_path / "threads"))
    monkeypatch.setattr(solve, "software", lambda: "gripscale 0.1.0 other")
    with pytest.raises(InputError, match=r"has gripscale .*, this machine gripscale 0.1.0 other"):
        study.run(tmp_path / "other", client=workers.scheduler_address)


def test_no_scheduler_is_one_sentence_and_leaves_nothing_behind(case, tmp_path, monkeypatch):
    monkeypatch.setattr(solve, "CONNECT_SECONDS", 0.2)
    study = Study(read_case(case), {"speed": [1.0]})
    for address in ("tcp://127.0.0.1:9", "nonsense"):
        with pytest.raises(InputError, match=f"that answers, such as .* got '{address}'"):
            study.run(tmp_path, client=address)
    assert study.run(tmp_path).sizes["scale"] == 3


def test_dask_missing_is_one_sentence(case, tmp_path, monkeypatch):
    def missing(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr(solve.importlib, "import_module", missing)
    with pytest.raises(InputError, match=r"pip install gripscale\[cluster\]"):
        Study(read_case(case), {"speed": [1.0]}).run(tmp_path, client="local")
