"""Every block of the tutorial runs, in order, and prints what the tutorial shows."""

import re
import shlex
from pathlib import Path

import pytest

from tests.samples import DOCS

TUTORIAL = DOCS / "tutorial.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
ITERATIONS = re.compile(r"\d+(?= converged)")
RELATIVE = 0.03
"""Numbers may differ by this: processors round differently."""


def alike(shown, printed):
    """Return whether two lines have the same words, and numbers within `RELATIVE`.

    Newton iterations of a table are work, not a result: they may differ.
    """
    shown, printed = (ITERATIONS.sub("", line).strip() for line in (shown, printed))
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", printed).split():
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(float(a) == pytest.approx(float(b), rel=RELATIVE, abs=1e-3) for a, b in pairs)


def assert_shown(shown, printed):
    """Assert that the lines shown are printed in this order, and nothing else where no `...` is."""
    rest, gap = [line for line in printed.splitlines() if line.strip()], False
    for line in filter(str.strip, shown.splitlines()):
        if line == "...":
            gap = True
            continue
        found = [i for i, other in enumerate(rest if gap else rest[:1]) if alike(line, other)]
        assert found, f"not printed: {line!r}; what was printed goes on with {rest[:4]}"
        rest, gap = rest[found[0] + 1 :], False
    assert gap or not rest, f"not shown: {rest}"


def run_console(shell, block):
    """Run the one command of a console block and compare what it prints."""
    command, _, shown = block.partition("\n")
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "gripscale"
    assert_shown(shown, shell(*arguments).output)


def test_the_tutorial_does_what_it_says(shell, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "tutorial"}
    printed, commands = "", 0
    heads = [Path("road.txt"), Path("dma.csv")]
    for language, block in BLOCK.findall(TUTORIAL.read_text(encoding="utf-8")):
        if language == "python":
            exec(compile(block, TUTORIAL.name, "exec"), names)
            printed = capsys.readouterr().out
        elif language == "console":
            run_console(shell, block)
            commands += 1
        elif language == "text" and heads:
            assert heads.pop(0).read_text(encoding="utf-8").startswith(block)
        elif language == "text":
            assert_shown(block, printed)
        else:
            pytest.fail(f"a block of {language} is not tested")
    assert commands == 6
    assert (tmp_path / "results" / "report.html").stat().st_size > 1e6


def test_a_wrong_number_or_a_line_too_many_is_noticed():
    assert_shown("a 1.00\n...\nb 2", "a 1.01\nx\nb 2")
    for wrong in ("a 1.10\nb 2", "a 1.00", "...\nc"):
        with pytest.raises(AssertionError):
            assert_shown(wrong, "a 1.01\nb 2")
