"""`gripscale report`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from typer.testing import CliRunner

from gripscale.cli import app


def test_command_writes_the_page_and_says_where(study_file: Path, tmp_path: Path) -> None:
    target = tmp_path / "page.html"
    done = CliRunner().invoke(app, ["report", str(study_file), "--output", str(target)])
    assert done.exit_code == 0, done.output
    assert "page.html" in done.stdout
    assert target.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_place_that_cannot_be_written_is_one_sentence(study_file: Path, tmp_path: Path) -> None:
    target = tmp_path / "nowhere" / "page.html"
    done = CliRunner().invoke(app, ["report", str(study_file), "--output", str(target)])
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "cannot be written" in done.stderr


def test_page_imports_only_what_it_is_made_with(run_folder: Path, tmp_path: Path) -> None:
    code = (
        "import sys, gc, gripscale\n"
        "gripscale.questions.write_report(sys.argv[1], sys.argv[2])\n"
        "assert gc.isenabled()\n"
        "print(*sys.modules)"
    )
    command = [sys.executable, "-c", code, str(run_folder), str(tmp_path / "page.html")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    unneeded = {"bokeh.models", "fontTools.subset", "scipy.optimize", "rich", "typer"}
    assert unneeded & set(done.stdout.split()) == set()
