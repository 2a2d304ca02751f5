"""The chain as a case asks for it: what solves a wave, and what goes on from wave to wave."""

from __future__ import annotations

from gripscale.case.prepare_conditions import prepare_conditions
from gripscale.case.read import CaseFile
from gripscale.chain.model import Chain
from gripscale.chain.solvers import wave_solver


def case_chain(file: CaseFile) -> Chain:
    """Return the chain of a case.

    Raises `FileError` and `InputError` for conditions that cannot be used.
    """
    case = file.case
    solver = wave_solver(case.solver.model, case.solver.options())
    return Chain(
        solver,
        pressure_classes=case.chain.pressure_classes,
        extrapolate=case.rubber.extrapolate,
        conditions=prepare_conditions(case.conditions, file.resolve),
    )
