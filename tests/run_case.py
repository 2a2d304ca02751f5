"""The chain of a case file solved into a folder, as `gripscale run` solves it."""

from __future__ import annotations

from pathlib import Path

from gripscale.case_file import folder, read_case, read_case_file
from gripscale.case_file.read import CaseFile
from gripscale.questions.chain.run import ChainRun


def run_case(file: CaseFile | str | Path, *, output: Path | None = None) -> ChainRun:
    """Solve the chain of a case file; without a folder nothing is written."""
    file = file if isinstance(file, CaseFile) else read_case_file(file)
    run = ChainRun(read_case(file))
    if output is not None:
        folder.prepare(output, file)
    run.solve(output)
    return run
