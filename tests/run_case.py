"""The chain of a case file, and the result files of `gripscale run`."""

from __future__ import annotations

from pathlib import Path

import gripscale as gs
from gripscale.case_file import folder, read_case, read_case_file
from gripscale.experiment.solve import Bench
from gripscale.io import netcdf
from gripscale.questions.answer.answer import ANSWER_FILE, CHAIN_FILE, answer, solved_chain


def chain_of(path: Path) -> gs.ChainResult:
    """Solve the chain of a case file."""
    case = read_case(path)
    return case.chain.solve(case.rubber, case.surface.sines, case.load)


def run_case(path: Path, output: Path) -> gs.Answer:
    """Solve a case file into a folder."""
    case = read_case(path)
    result = answer(case)
    if result.chain is None:
        result.chain = solved_chain(case, Bench(None))
    folder.prepare(output, read_case_file(path))
    result.save(output / ANSWER_FILE)
    netcdf.save(result.chain, output / CHAIN_FILE)
    return result
