"""The questions about the shipped case as a user asks them: first number and end, in seconds.

Accuracy stands beside time: the number that each question states first, with its interval.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

from rich.console import Console

from benchmarks.case import CASE
from benchmarks.table import show

QUESTIONS = {
    "compare": ["compare", str(CASE)],
    "run": ["run", str(CASE)],
    "study, 5 speeds": ["study", str(CASE), "--vary", "speed=0.003:30:log5"],
    "sensitivity": ["sensitivity", str(CASE)],
    "cut-off": ["cut-off", str(CASE)],
    "design, 7 points": ["design", str(CASE)],
    "uncertainty, 20 samples": ["uncertainty", str(CASE), "--samples", "20"],
    "compare-rubbers": ["compare-rubbers", str(CASE), "styrene_butadiene"],
    "compare-surfaces": ["compare-surfaces", str(CASE), "synthetic_dense_asphalt"],
}
"""Names and command lines."""
FIRST_SECONDS, MOST_SECONDS = 5.0, 20.0
_NUMBER = re.compile(r"(friction|μ|more E″)\D*\d")
_START = "from gripscale.cli import main; main()"


@dataclass(frozen=True)
class Asked:
    """One question, asked in a process of its own."""

    first: float
    """Until a number is printed [s]."""
    total: float
    """[s]"""
    processor: float
    """Processor time of all threads [s]."""
    answer: str


def run(console: Console) -> None:
    """Print the times of all questions with what they answer."""
    rows = []
    for name, command in QUESTIONS.items():
        asked = ask(command)
        times = [f"{seconds:.1f}" for seconds in (asked.first, asked.total, asked.processor)]
        rows.append([name, *times, asked.answer[:70]])
    show(
        console,
        "Questions about the shipped case [s]",
        [
            "",
            f"first number, < {FIRST_SECONDS:g}",
            f"all, < {MOST_SECONDS:g}",
            "processor",
            "answer",
        ],
        rows,
        "Processes of their own, with imports, figures and files.",
    )


def ask(command: list[str]) -> Asked:
    """Run a command in an empty folder."""
    before, start = os.times(), time.perf_counter()
    first, answer = float("nan"), ""
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-u", "-c", _START, *command, "--output", f"{folder}/results"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if first != first and _NUMBER.search(line):
                    first = time.perf_counter() - start
                if line.startswith("Answer"):
                    answer = answer or line.removeprefix("Answer: ").strip()
    after = os.times()
    processor = after.children_user - before.children_user
    processor += after.children_system - before.children_system
    return Asked(first, time.perf_counter() - start, processor, answer)
