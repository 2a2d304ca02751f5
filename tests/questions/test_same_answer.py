"""A question asked of a case made in Python, of its file and as a command has one answer."""

import pytest

import gripscale as gs
from tests.questions.answer.test_answer_object import CASE, made

FRICTION = "friction.csv"
QUESTIONS = {
    "comparison": (
        lambda case, **options: gs.compare(case, models=["direct"], seeds=1, **options),
        ["compare", "--models", "direct", "--seeds", "1"],
        "comparison.nc",
    ),
    "study": (
        lambda case, **options: gs.vary(case, speed=[0.1, 0.3], **options),
        ["study", "--vary", "speed=0.1,0.3"],
        "study.nc",
    ),
    "sensitivity": (gs.sensitivity, ["sensitivity"], "sensitivity.nc"),
    "cut_off": (
        lambda case, **options: gs.cut_off(case, down_to=1e-3, **options),
        ["cut-off", "--down-to", "1 mm"],
        "cut_off.nc",
    ),
    "calibration": (
        lambda case, folder: gs.calibrate(
            case, folder.parent / FRICTION, law="constant", folder=folder
        ),
        ["calibrate", "--law", "constant", "--measured", FRICTION],
        "calibration.nc",
    ),
    "uncertainty": (
        lambda case, **options: gs.uncertainty(case, samples=10, **options),
        ["uncertainty", "--samples", "10"],
        "uncertainty.nc",
    ),
}
"""By kind: the function, the words of its command, and the file that the command leaves."""
SLOW = {"sensitivity", "uncertainty"}
"""Of the same parts as the others."""
CLOCKS = ("seconds", "prediction_key")
"""Ends of names of what differs between runs, or between Python and a command."""


def numbers(data):
    """Return the variables of a result by name, without times and keys."""
    names = sorted(str(name) for name in data.variables if not str(name).endswith(CLOCKS))
    return {name: data[name].values.tolist() for name in names}


@pytest.mark.parametrize(
    "kind",
    [
        pytest.param(kind, marks=[pytest.mark.verification] if kind in SLOW else [])
        for kind in QUESTIONS
    ],
)
def test_python_file_and_command_have_one_answer(kind, tmp_path, shell, monkeypatch):
    ask, words, name = QUESTIONS[kind]
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    rows = ("speed [m/s],friction", "0.03,0.5", "0.1,0.6", "0.3,0.65", "1,0.7")
    (tmp_path / FRICTION).write_text("\n".join(rows), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    result = ask(made(), folder=tmp_path / "python")
    assert result.kind == kind
    assert result.lines[0].startswith(("Answer: ", "interval: "))
    shell(words[0], path, *words[1:], "--output", tmp_path / "command")
    loaded = gs.load(tmp_path / "command" / name)
    assert type(loaded) is type(result)
    assert str(numbers(loaded.data)) == str(numbers(result.data))
