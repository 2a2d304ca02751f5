"""The chain as a case asks for it: what solves a wave, and what goes on from wave to wave."""

from __future__ import annotations

from gripscale.case.models import Case
from gripscale.chain.model import Chain
from gripscale.chain.solvers import wave_solver


def case_chain(case: Case) -> Chain:
    """Return the chain of `case`."""
    solver = wave_solver(case.solver.model, case.solver.options())
    return Chain(
        solver,
        pressure_classes=case.chain.pressure_classes,
        extrapolate=case.rubber.extrapolate,
    )
