"""Solving the chains of a case, wave by wave, each wave on disk before the next one starts."""

from __future__ import annotations

import time
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from gripscale import dataset
from gripscale.case import Case, CaseFile
from gripscale.chain import ChainError, Prediction, Solver, predict
from gripscale.cli import record
from gripscale.cli.inputs import RubberStudy, SurfaceStudy
from gripscale.cli.terminal import say


@dataclass
class Chain:
    """One chain of a case, in motion or at rest, and what became of it."""

    name: str
    speed: float
    surface: SurfaceStudy
    rubber: RubberStudy
    result: Prediction | None = None
    failure: ChainError | None = None

    @property
    def title(self) -> str:
        """What tables and figures call it."""
        return "Static" if self.speed == 0.0 else f"Dynamic, {self.speed:g} m/s"

    @property
    def solved(self) -> Prediction:
        """The prediction, complete or not, once a wave has been solved."""
        assert self.result is not None
        return self.result


def chains_of(case: Case, surface: SurfaceStudy, rubber: RubberStudy) -> list[Chain]:
    """Return the chains `case` asks for: dynamic if it moves, static if wanted or at rest."""
    chains = []
    if case.load.speed > 0.0:
        chains.append(Chain("dynamic", case.load.speed, surface, rubber))
    if case.load.static or not chains:
        chains.append(Chain("static", 0.0, surface, rubber))
    return chains


def solve(chain: Chain, file: CaseFile, console: Console, path: Path) -> None:
    """Run `chain`, print a line per wave and save to `path` after each; inputs follow at the end.

    A wave that does not converge ends the chain and is kept as `chain.failure`.
    """
    load, sines = file.case.load, chain.surface.sines
    console.print()
    say(console, chain.title)
    inputs = record.inputs_group(file, chain.surface, chain.rubber)
    clock = time.perf_counter()

    def save(complete: bool) -> None:
        if chain.result is not None:
            saved = chain.result.to_dataset().assign_attrs(_provenance(chain, file))
            groups = {"inputs": inputs, "solver": record.solver_group(chain.result)}
            dataset.save(saved, path, groups if complete else None)

    def keep(so_far: Prediction) -> None:
        nonlocal clock
        chain.result = so_far
        save(complete=False)
        seconds, clock = time.perf_counter() - clock, time.perf_counter()
        say(console, f"  {_progress(so_far, len(sines))}, {seconds:.1f} s")

    with _spinner(console, chain.title):
        try:
            predict(
                chain.rubber.rubber,
                sines,
                pressure=load.pressure,
                speed=chain.speed,
                footprint=load.footprint,
                load_time=load.load_time,
                solver=solver_of(file.case),
                on_scale=keep,
                **file.case.solver.options(),
            )
        except ChainError as failure:
            chain.failure = failure
        finally:
            save(complete=True)


def solver_of(case: Case) -> Solver | None:
    """Return the solver the case names; None is the default of `predict`."""
    if case.solver.model == "finite_strain":
        return None
    from gripscale.theory import solve_half_plane

    return solve_half_plane


def _spinner(console: Console, title: str) -> AbstractContextManager[Any]:
    """Return a spinner where somebody may be watching, else nothing."""
    return console.status(f"solving: {title}") if console.is_terminal else nullcontext()


def _progress(so_far: Prediction, total: int) -> str:
    """Return one line on the wave just solved."""
    scale = so_far.scales[-1]
    text = (
        f"wave {len(so_far.scales)} of {total}: {scale.wavelength * 1e3:.3g} mm, "
        f"contact {scale.contact_fraction:.3f}"
    )
    if so_far.speed > 0.0:
        text += f", friction {scale.friction:.3f}"
    return f"{text}, {scale.status}"


def _provenance(chain: Chain, file: CaseFile) -> dict[str, str]:
    """Return where the inputs come from, for the attributes of the result file."""
    return {
        "case": file.text,
        "case_file": str(file.path),
        "surface_source": chain.surface.source,
        "rubber_source": chain.rubber.source,
    }
