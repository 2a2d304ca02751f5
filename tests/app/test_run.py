"""A run is a process: its lines are the progress, stopping it ends it; what the page shows."""

import os
import shutil
import socket
import sys
import time

import pytest
from typer.testing import CliRunner

from gripscale.app import serve_app
from gripscale.app.case import CaseState, VisitFolder
from gripscale.app.run_tabs import run_status
from gripscale.app.runs import COMMANDS, Runs
from gripscale.cli import app
from gripscale.core.errors import InputError
from gripscale.questions.inputs.charts_of_rubber import rubber_charts
from gripscale.questions.page_of_folder import read_result
from tests.run_case import run_case
from tests.samples import ROOT

from .conftest import CASE

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
def runs(tmp_path):
    state = CaseState(VisitFolder.new(tmp_path))
    state.set_text(SLOW)
    return Runs(state)


def there(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def ended(run):
    until = time.monotonic() + 60
    while run.running and time.monotonic() < until:
        time.sleep(0.1)
    return run


@pytest.mark.skipif(os.name != "posix", reason="asks for the process by a signal")
def test_stopping_ends_the_process_and_the_same_case_goes_on_in_its_folder(runs):
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


def test_a_failed_run_says_its_sentence(runs):
    state = runs._state
    state.set(("surface", "sines"), None)
    state.set(("surface", "files"), ["inputs/no.txt"])
    state.set(("surface", "scales"), 2)
    run = ended(runs.start())
    assert run.state == "failed"
    said = state.visit.short(run.failure())
    assert said.startswith("inputs/no.txt: cannot be read (no such file)")


def by_name(name):
    return next(command for command in COMMANDS if command.command == name)


@pytest.mark.parametrize(
    ("command", "case", "others", "words"),
    [
        ("sensitivity", "", 0, ["Answer: 1 % more E″", "the per cent of friction for a per cent"]),
        (
            "compare-surfaces", "", 1,
            ["<dt>μ of case-1</dt>", "over other ", "Answer: friction μ ranks case-1 0.",
             "table-texture"],
        ),
        pytest.param(  # stated waves have no profile for a direct contact: the chain predicts
            "calibrate", "examples/measured_friction/case.toml", 0,
            ["<dt>shear stress τ_0</dt>", "Answer: area term with shear stress τ_0 = 0.346 MPa"],
            marks=pytest.mark.verification,
        ),
    ],
)  # fmt: skip
def test_other_commands_than_run_are_run_once_and_shown(
    tmp_path, small, command, case, others, words
):
    state = CaseState(VisitFolder.new(tmp_path))
    (small / "alone.toml").write_text(CASE.replace("../elsewhere/", ""))
    state.set_text(state.text_of(ROOT / case if case else small / "alone.toml"))
    road = (small / "road.txt").read_bytes()
    files = [state.visit.store("other.txt", road)] if others else []
    runs = Runs(state)
    run = ended(runs.start(by_name(command), {}, files))
    assert run.state == "finished", run.log()
    assert "has finished" in run_status(run).text
    page = run.page().read_text(encoding="utf-8")
    assert all(each in page for each in words)
    assert runs.start(by_name(command), {}, files) is run, "what is finished is not repeated"


def test_each_command_is_one_that_gripscale_has_with_its_options():
    """Words of the command lines, from what the commands print of themselves."""
    for command in COMMANDS:
        words = [command.command, "--help"]
        help_text = CliRunner().invoke(app, words, env={"COLUMNS": "200"}).stdout
        assert help_text.startswith("Usage: "), command.command
        assert all(option.flag in help_text for option in command.fields), command.title
        for option in command.fields:
            assert not option.choices or option.value in dict(option.choices).values()
    speeds = by_name("study")
    assert speeds.arguments({"speeds": "1,2"}) == ["--vary", "speed=1,2"]
    assert speeds.arguments({"speeds": " "}) == []
    assert by_name("compare-rubbers").arguments({}, ["inputs/b.csv"]) == ["inputs/b.csv"]


@pytest.mark.parametrize("name", ["../x.csv", "/etc/passwd", "--output", "~/x.csv"])
def test_files_beside_the_case_are_those_of_the_visit(runs, name):
    with pytest.raises(InputError, match="lies outside the folder of this page"):
        runs.start(by_name("compare-rubbers"), others=[name])
    with pytest.raises(InputError, match="expected other compounds; got none"):
        runs.start(by_name("compare-rubbers"))
    assert runs.all == []


@pytest.fixture(scope="module")
def ran(small, tmp_path_factory):
    """Return the folder of a run."""
    place = tmp_path_factory.mktemp("ran")
    for name in ("road.txt", "dma.txt"):
        shutil.copy(small / name, place)
    (place / "case.toml").write_text(CASE.replace("../elsewhere/", ""))
    run_case(place / "case.toml", place / "out")
    return place / "out"


def test_a_fit_before_any_run_has_no_diamonds(ran):
    result = read_result(ran)
    for excited, drawn in ((None, False), (result.chain, True)):
        moduli, factor, *_ = rubber_charts(result.inputs, excited)
        assert ["Diamonds" in chart.caption for chart in (moduli, factor)] == [drawn, drawn]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--port", "70000"], "from 0 to 65535; got 70000"),
        (["--port", "TAKEN"], "port TAKEN of 127.0.0.1 cannot be used"),
        (["no.toml"], "does not exist"),
        (["--folder", "file"], "is not a folder"),
    ],
)
def test_what_cannot_be_served(tmp_path, monkeypatch, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        taken = str(other.getsockname()[1])
        words = ["app", "--no-browser", "--folder", "visits", *arguments]
        result = CliRunner().invoke(app, [word.replace("TAKEN", taken) for word in words])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert sentence.replace("TAKEN", taken) in result.stderr
    assert not list(tmp_path.glob("visits/*"))


def test_what_to_install_is_said(tmp_path, monkeypatch):
    monkeypatch.delitem(sys.modules, "gripscale.app.server", raising=False)
    monkeypatch.setitem(sys.modules, "panel", None)
    with pytest.raises(InputError, match=r"needs panel.*pip install 'gripscale\[app\]'"):
        serve_app(tmp_path)
