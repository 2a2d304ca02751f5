"""Bad input: one sentence on stderr, exit code 2, nothing written."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from gripscale.theory import HalfPlane
from tests.samples import Shell


def refused(result: Result, *words: str) -> None:
    assert result.exit_code == 2, result.output
    assert len(result.stderr.splitlines()) == 1
    assert result.stderr.startswith("error: ")
    for part in words:
        assert part in result.stderr
    assert "Traceback" not in result.output


@pytest.fixture(autouse=True)
def never_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing in this file may get as far as a solver."""

    def solve(*_: object) -> None:
        raise AssertionError("solved with bad input")

    monkeypatch.setattr(HalfPlane, "solve", solve)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("pressure =", "presure =", "unknown key [load] presure; did you mean pressure?"),
        ("[load]", "[load", "is not valid TOML"),
        ('"dma.txt"', '"dna.txt"', "dna.txt"),
        ('"390 mm"', '"10.1 mm"', "road.txt: crop must leave at least"),
    ],
)
def test_bad_case_is_refused(
    shell: Shell, changed: Callable[..., Path], old: str, new: str, words: str
) -> None:
    case = changed(old, new)
    refused(shell("run", case), words)
    assert sorted(p.name for p in case.parent.iterdir()) == ["case.toml", "dma.txt", "road.txt"]


@pytest.mark.parametrize(
    ("old", "new", "table", "key"),
    [
        ("pressure =", "presure =", "load", "pressure"),
        ("[load]", "[lood]", "", "pressure"),
        ("[load]", "[conditions]\nheat = { density = -1 }\n[load]", "conditions.heat", "density"),
        ('"road.txt"', '"rod.txt"', "surface", "files"),
        ('"dma.txt"', '"dna.txt"', "rubber", "frequency_unit"),
        ("[load]", '[conditions]\ntemperature = "60 C"\n[load]', "rubber.shift", "kind"),
        ("[load]", '[measured]\nfriction = "no.csv"\n[load]', "measured", "friction"),
    ],
)
def test_a_refusal_ends_with_the_command_that_lists_the_keys(
    shell: Shell, changed: Callable[..., Path], old: str, new: str, table: str, key: str
) -> None:
    words = ["keys", *filter(None, [table])]
    refused(shell("run", changed(old, new)), f"ee `{' '.join(['gripscale', *words])}`\n")
    assert key in shell(*words).stdout.split()


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("road.txt", ""),
        ("road.txt", "x [mm]\tz [mm]\n" + "".join(f"{i}\tnan\n" for i in range(50))),
        ("dma.txt", "# Frequency (Hz) E' (MPa) E'' (MPa)\n1 2 x\n2 3 4\n"),
    ],
)
def test_bad_measurement_is_refused(
    shell: Shell, changed: Callable[..., Path], name: str, text: str
) -> None:
    case = changed()
    (case.parent / name).write_text(text)
    refused(shell("run", case), name)
    assert not (case.parent / "results").exists()


def test_missing_case_is_refused(shell: Shell, tmp_path: Path) -> None:
    refused(shell("run", tmp_path / "nowhere.toml"), "nowhere.toml does not exist")


def test_file_in_place_of_the_output_folder(shell: Shell, changed: Callable[..., Path]) -> None:
    case = changed()
    blocked = case.parent / "results"
    blocked.write_text("in the way")
    refused(shell("run", case), "results cannot be made", "is not a folder")
    refused(shell("run", case, "--output", blocked / "deeper"), "deeper cannot be made")
    assert blocked.read_text() == "in the way"


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write anywhere")
def test_output_folder_without_permission(shell: Shell, changed: Callable[..., Path]) -> None:
    case = changed()
    closed = case.parent / "closed"
    closed.mkdir(mode=0o500)
    refused(shell("run", case, "--output", closed / "results"), "no permission")


def test_output_folder_without_permission_is_found_before_reading(
    shell: Shell, changed: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    case = changed()
    monkeypatch.setattr(os, "access", lambda *_: False)
    (case.parent / "road.txt").unlink()
    refused(shell("run", case), "no permission for")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--scales", "0"], "options: scales = 0: expected a whole number, at least 1"),
        (["--crop", "1 mm", "1 ell"], "options: crop[1] = '1 ell': unknown unit"),
    ],
)
def test_bad_surface_options(shell: Shell, inputs: Path, options: list[str], words: str) -> None:
    refused(shell("fit-surface", inputs / "road.txt", *options), words)


def test_bad_rubber_options(shell: Shell, inputs: Path) -> None:
    dma = inputs / "dma.txt"
    refused(
        shell("fit-rubber", dma, "--terms", "0"),
        "options: terms = 0: expected a whole",
    )
    refused(shell("fit-rubber", dma, "--bulk-modulus", "soft"), "options: bulk_modulus = 'soft'")
    refused(shell("fit-rubber", dma, "--bulk-modulus", "1 Pa"), "bulk_modulus")
    refused(shell("fit-rubber", inputs / "none.txt"), "none.txt")


def test_a_shell_sees_the_sentence_and_the_code(changed: Callable[..., Path]) -> None:
    case = changed("scales = 3", "scale = 3")
    program = "from gripscale.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", program, "run", str(case)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        check=False,
    )
    see = " See `gripscale keys surface`\n"
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == f"error: {case}: unknown key [surface] scale; did you mean scales?" + see
