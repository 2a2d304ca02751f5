"""The README's Python example runs, prints what the README says, and its links lead somewhere."""

import re

import pytest

from tests.samples import ROOT

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?")


def blocks(language):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)


def test_python_examples_print_what_stands_below_them(monkeypatch, capsys):
    examples, outputs = blocks("python"), blocks("text")
    assert len(examples) == len(outputs) >= 1
    monkeypatch.chdir(ROOT)
    for example, output in zip(examples, outputs, strict=True):
        exec(compile(example, "README.md", "exec"), {"__name__": "readme"})
        printed = capsys.readouterr().out
        # The words exactly, the numbers to 1 %: processors round differently.
        assert NUMBER.sub("#", printed) == NUMBER.sub("#", output)
        for got, stated in zip(NUMBER.findall(printed), NUMBER.findall(output), strict=True):
            assert float(got) == pytest.approx(float(stated), rel=0.01)


def test_shell_output_states_the_same_totals_as_the_python_example():
    """The console example and the Python example are the same case."""
    console, printed = blocks("console")[0], blocks("text")[0]
    total = re.search(r"A_r/A_0 = ([\d.]+), friction mu = ([\d.]+)", console)
    area, friction = NUMBER.findall(printed)[:2]
    assert float(total[1]) == pytest.approx(float(area), rel=0.01)
    assert float(total[2]) == pytest.approx(float(friction), rel=0.01)
