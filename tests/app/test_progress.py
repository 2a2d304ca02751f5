"""How far a run is, by its events: never back, and unknown where it is not known."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import pytest
from typer.testing import CliRunner

from gripscale.app.runs import RunProgress
from gripscale.cli import app
from gripscale.questions.chain.events import (
    AnswerSolved,
    Event,
    FileWritten,
    PredictionFinished,
    RunFailed,
    RunFinished,
    RunStarted,
    WaveSolved,
    event_from_json,
    event_to_json,
)
from gripscale.questions.terminal import PROGRESS_LINES


def waves(last: int, name: str = "dynamic", *, of: int = 3, pass_number: int = 1) -> list[Event]:
    return [
        WaveSolved(
            name, pass_number, n, of, 1e-3, 0.3, 0.5, 0.1, "converged", "converged", 1, False
        )
        for n in range(1, last + 1)
    ]


def end(name: str, passes: int | None = None) -> Event:
    return PredictionFinished(name, True, "converged", passes, 0.1, 0.2)


BOTH = ("dynamic", "static")


def test_two_predictions_share_the_bar() -> None:
    events = [
        RunStarted(BOTH, 3, False),
        *waves(3), end("dynamic"), *waves(3, "static"), end("static"),
    ]  # fmt: skip
    steps = [RunProgress.of(events[:count]) for count in range(len(events) + 1)]
    shares = [step.share for step in steps[1:-1]]
    assert [round(6 * share) for share in shares if share is not None] == [
        0, 1, 2, 3, 3, 4, 5, 6]  # fmt: skip
    assert None not in shares
    assert steps[0].share is steps[-1].share is None
    assert steps[0].sentence == steps[1].sentence == "reading and fitting"
    assert steps[3].sentence == "prediction 1 of 2, wave 2 of 3"
    assert steps[-1].sentence == "all waves are solved; direct contact and figures follow"
    later = [*events, AnswerSolved(True, 0.1, 0.2)]
    words = "the direct contact is solved; the figures follow"
    assert RunProgress.of(later).sentence == words


def test_a_prediction_that_ends_early_counts_as_one() -> None:
    failed = PredictionFinished("dynamic", False, "wave 2 of 3 did not converge", None, 0.1, 0.2)
    after = RunProgress.of([RunStarted(BOTH, 3, False), *waves(2), failed])
    assert after.share == 0.5
    assert RunProgress.of([RunStarted(BOTH, 3, False), *waves(2), failed, end("static")]).solved


def test_passes_are_counted_and_nobody_knows_how_many_come() -> None:
    events = [RunStarted(BOTH, 3, True), *waves(3), *waves(2, pass_number=2)]
    progress = RunProgress.of(events)
    assert progress.share is None
    words = "until rubber and contact agree"
    assert progress.sentence == f"prediction 1 of 2, pass 2 {words}, wave 2 of 3"
    events += [*waves(3, pass_number=2)[2:], end("dynamic", 2), *waves(1, "static")]
    assert not RunProgress.of(events).solved
    assert RunProgress.of(events).sentence == f"prediction 2 of 2, pass 1 {words}, wave 1 of 3"
    assert RunProgress.of([*events, end("static", 1)]).solved


@pytest.mark.parametrize(
    "event",
    [RunStarted(BOTH, 3, True), *waves(1), end("static"), end("dynamic", 3), RunFinished(),
     AnswerSolved(True, 0.1, 0.2), FileWritten("out/dynamic.nc"),
     RunFailed("wave 1 of 3 …", 3)],
    ids=lambda event: type(event).__name__,
)  # fmt: skip
def test_an_event_is_read_back_from_its_line(event: Event) -> None:
    line = event_to_json(event)
    assert "\n" not in line
    assert event_from_json(line) == event
    assert event_from_json(line[:-1]) is None, "a line that is still being written"


def test_a_line_that_is_no_event_is_ignored_and_a_new_field_too() -> None:
    for line in ("", "Traceback", "[]", "3", '{"event": "Tomorrow"}', '{"event": "RunStarted"}'):
        assert event_from_json(line) is None
    assert event_from_json('{"event": "RunFinished", "exit_code": 0, "new": 1}') == RunFinished()


def test_an_infinite_number_is_null() -> None:
    line = event_to_json(
        end("static").__class__("static", True, "", None, float("nan"), float("inf"))
    )
    assert json.loads(line)["friction"] is json.loads(line)["contact_fraction"] is None
    assert str(event_from_json(line)).count("nan") == 2


def run_json(case: Path, output: Path) -> tuple[list[Event], str, int]:
    """Return the events of `gripscale run`, its text and its exit code."""
    options = ["--output", str(output), "--progress", "json"]
    result = CliRunner().invoke(app, ["run", str(case), *options])
    events = [event_from_json(line) for line in result.stdout.splitlines()]
    assert None not in events, "every line of standard output is an event"
    return [event for event in events if event is not None], result.stderr, result.exit_code


@pytest.fixture
def case(small: Path, tmp_path: Path) -> Path:
    text = (small / "case.toml").read_text(encoding="utf-8").replace("../elsewhere/", "")
    for name in ("road.txt", "dma.txt"):
        (tmp_path / name).write_bytes((small / name).read_bytes())
    path = tmp_path / "case.toml"
    path.write_text(text.replace('footprint = "100 mm"', 'footprint = "100 mm"\nstatic = true'))
    return path


def test_a_run_reports_each_step_as_an_event(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(PROGRESS_LINES, "1")
    events, text, exit_code = run_json(case, tmp_path / "out")
    assert exit_code == 0
    assert events[0] == RunStarted(BOTH, 3, False)
    assert events[-1] == RunFinished(0)
    solved = [event for event in events if isinstance(event, WaveSolved)]
    assert [(event.prediction, event.number, event.count) for event in solved] == [
        (name, number, 3) for name in BOTH for number in (1, 2, 3)
    ]
    assert all(event.status == "converged" and not event.stored for event in solved)
    files = {Path(event.path) for event in events if isinstance(event, FileWritten)}
    names = ("dynamic.nc", "static.nc", "answer.nc", "report.txt", "summary.xlsx")
    assert files == {tmp_path / "out" / name for name in names}
    assert all(path.is_file() for path in files)
    assert any(isinstance(event, AnswerSolved) for event in events)
    assert "wave 3 of 3" in text
    again, _, _ = run_json(case, tmp_path / "out")
    assert all(event.stored for event in again if isinstance(event, WaveSolved))


def test_a_run_that_fails_says_why_in_its_last_event(case: Path, tmp_path: Path) -> None:
    (tmp_path / "dma.txt").unlink()
    events, text, exit_code = run_json(case, tmp_path / "out")
    assert exit_code == 2
    assert len(events) == 1
    assert isinstance(events[0], RunFailed)
    assert events[0].exit_code == 2
    assert "dma.txt: cannot be read" in events[0].message
    assert f"error: {events[0].message}\n" in text


def test_another_wording_does_not_change_the_progress(
    case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Print other sentences for the same steps; the bar must read the same."""

    def shares() -> list[float | None]:
        events, _, _ = run_json(case, tmp_path / f"out{len(list(tmp_path.iterdir()))}")
        return [RunProgress.of(events[:count]).share for count in range(len(events))]

    before = shares()
    command = import_module("gripscale.questions.terminal")
    print_wrapped: Callable[..., None] = command.print_wrapped

    def reworded(console: object, message: str) -> None:
        print_wrapped(console, re.sub(r"[A-Za-z]", "x", message))

    monkeypatch.setattr(command, "print_wrapped", reworded)
    assert shares() == before
