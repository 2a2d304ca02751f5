"""A run is a process: its lines are the progress, stopping it ends it, the same case goes on."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from gripscale.app.case import CaseState, VisitFolder
from gripscale.app.runs import Runs
from gripscale.core.errors import InputError

SLOW = """\
[[surface.sines]]
wavelength = "10 mm"
amplitude = "1 mm"
[[surface.sines]]
wavelength = "1 mm"
amplitude = "0.2 mm"
[rubber]
name = "styrene_butadiene"
[load]
pressure = "3 bar"
speed = "1 m/s"
footprint = "100 mm"
[solver]
columns = 512
rows = 60
"""


@pytest.fixture
def runs(tmp_path: Path) -> Runs:
    state = CaseState(VisitFolder.new(tmp_path))
    state.set_text(SLOW)
    return Runs(state)


def there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.skipif(os.name != "posix", reason="asks for the process by a signal")
def test_stopping_ends_the_process_and_the_same_case_goes_on_in_its_folder(runs: Runs) -> None:
    run = runs.start()
    assert run.state == "running"
    assert there(run.pid)
    with pytest.raises(InputError, match="run-1 is still running"):
        runs.start()
    runs.stop()
    assert run.state == "stopped"
    assert not there(run.pid)
    again = runs.start()
    assert again is run
    assert run.state == "running"
    runs.stop()


def test_a_failed_run_says_its_sentence(runs: Runs) -> None:
    state = runs._state
    state.set(("surface", "sines"), None)
    state.set(("surface", "files"), ["inputs/no.txt"])
    state.set(("surface", "scales"), 2)
    run = runs.start()
    until = time.monotonic() + 60
    while run.running and time.monotonic() < until:
        time.sleep(0.1)
    assert run.state == "failed"
    assert (
        state.visit.short(run.failure())
        == "inputs/no.txt: cannot be read (no such file); see `gripscale keys surface`"
    )
