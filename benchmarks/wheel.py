"""`make wheel`: the wheel alone in an empty environment, from `gripscale init` to a report.

python -m benchmarks.wheel WHEEL [--python PYTHON]

A command that fails, or a module that comes from elsewhere than the wheel, ends it.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

MOST_MEGABYTES = 6.0
MOST_SECONDS = 60.0
"""For init, run and report: of the clock on two idle cores, of processor time on any machine."""
START = (
    ("init", "road"),
    ("run", "road/case.toml"),
    ("report", "road/results"),
)
MORE = (
    ("run", "road/results/case.toml"),
    ("compare", "road/case.toml", "--models", "chain,measured"),
    ("init", "made_up", "--example", "synthetic"),
    ("run", "made_up/case.toml"),
    ("keys", "load"),
    ("docs", "limits"),
)
BARE = (
    ("init", "imitated", "--example", "sweeps"),
    ("run", "imitated/case.toml"),
    ("reproduce",),
)
"""What the wheel does without any of its extras."""
FIGURES = 13
"""Pictures of the paper's figures 2 to 9."""


def main() -> None:
    """Install the wheel, run what a new user runs, and print what it takes."""
    parser = argparse.ArgumentParser(description="Try a wheel in an empty environment.")
    parser.add_argument("wheel", type=Path, help="the wheel, or a folder with just one")
    parser.add_argument("--python", default=sys.executable, help="the Python to try it with")
    arguments = parser.parse_args()
    given = arguments.wheel.resolve()
    (wheel,) = given.glob("*.whl") if given.is_dir() else [given]
    megabytes = wheel.stat().st_size / 1e6
    print(f"{wheel.name}: {megabytes:.2f} MB, {_unpacked(wheel):.2f} MB unpacked")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tool = _installed(wheel, arguments.python, folder / "environment")
        for words in BARE:
            _run(tool, folder, *words)
        figures = sorted(folder.glob("results/reproduction/*.png"))
        if len(figures) != FIGURES:
            sys.exit(f"gripscale reproduce drew {len(figures)} figures, not {FIGURES}")
        _install(tool.parent, f"{wheel}[report]")
        taken = [_run(tool, folder, *words) for words in START]
        for words in MORE:
            _run(tool, folder, *words)
    wall, seconds = (sum(column) for column in zip(*taken, strict=True))
    print(
        f"init, run and report: {wall:.1f} s on {os.cpu_count()} cores, {seconds:.1f} s of "
        f"processor time, of {MOST_SECONDS:.0f} s"
    )
    if megabytes > MOST_MEGABYTES or seconds > MOST_SECONDS:
        sys.exit(f"the wheel is above {MOST_MEGABYTES:g} MB, or the start above {MOST_SECONDS:g} s")


def _unpacked(wheel: Path) -> float:
    with zipfile.ZipFile(wheel) as archive:
        return sum(entry.file_size for entry in archive.infolist()) / 1e6


def _installed(wheel: Path, python: str, place: Path) -> Path:
    """Return the command of an environment that holds the wheel and what it depends on."""
    subprocess.run([python, "-m", "venv", place], check=True)
    scripts = place / ("Scripts" if os.name == "nt" else "bin")
    _install(scripts, str(wheel))
    found = subprocess.run(
        [scripts / "python", "-c", "import gripscale; print(gripscale.__file__)"],
        env=_environment(),
        cwd=place,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    if not Path(found).is_relative_to(place):
        sys.exit(f"gripscale comes from {found}, not from the wheel")
    return scripts / "gripscale"


def _install(scripts: Path, what: str) -> None:
    pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([scripts / "python", *pip, what], check=True)


def _environment() -> dict[str, str]:
    """Return the environment without what points at other Python code."""
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}


def _run(tool: Path, folder: Path, *words: str) -> tuple[float, float]:
    """Run a command in `folder`, print what it takes; return seconds of clock and processor."""
    before, clock = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run([tool, *words], cwd=folder, env=_environment(), capture_output=True)
    after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - clock
    if done.returncode:
        sys.exit(f"gripscale {' '.join(words)} failed: {done.stderr.decode()}")
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"gripscale {' '.join(words)}: {wall:.1f} s, {spent:.1f} s of processor time", flush=True)
    return wall, spent


if __name__ == "__main__":
    main()
