"""Reproducing the paper's figures: predictions made once, pictures, data and judged statements."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.charts.draw import FigureFolder
from gripscale.core import checks
from gripscale.core.provenance import software
from gripscale.experiment import Bench, Progress, Store
from gripscale.experiment.task import PREDICTIONS
from gripscale.io import netcdf
from gripscale.reproduction import judges
from gripscale.reproduction.figures import TITLES, Results, draw, drawn_data, tasks_of, title_of
from gripscale.reproduction.inputs import PaperInputs
from gripscale.reproduction.judges import Evidence
from gripscale.reproduction.statement import Statement, write_statements
from gripscale.wave.result import LW

_TABLE = files(__package__).joinpath("statements.csv").read_text(encoding="utf-8")
CLAIMS = list(csv.DictReader(_TABLE.splitlines()))  # what the paper states, and how it is judged
FEWEST_WAVES = 3  # converged ones that a prediction must have for its figure to be judged


def reproduce_paper(
    inputs: PaperInputs,
    output: str | Path,
    figures: Sequence[str] = (),
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: Callable[[Progress], None] | None = None,
) -> list[Statement]:
    """Make figures of Lind & Wangenheim 2014; return their statements, judged, in order.

    `figures` are names of `TITLES`, by default all. The folder `output` gets `fig5a.png`,
    `fig5a.pdf` and `fig5a.nc` and so on, the judged statements as `statements.md` and
    `statements.json`, and `predictions`: what is there is not solved again. `workers`, `client` and
    `on_task` are those of `gripscale.experiment.Bench`. Raises `InputError` for an unknown figure,
    `FileError` if a result cannot be written.
    """
    for name in figures:
        checks.one_of("figure", name, tuple(TITLES))
    names = [name for name in TITLES if not figures or name in figures]
    wanted = {name: tasks_of(name, inputs) for name in names}
    if "fig5b" in names:  # it compares with the area at rest
        wanted["fig5a"] = tasks_of("fig5a", inputs)
    labelled = {
        f"{name}, {panel}, {line}": task
        for name, panels in wanted.items()
        for panel, lines in panels.items()
        for line, task in lines.items()
    }
    solved = Bench(Store(Path(output) / PREDICTIONS), workers, client, on_task).solve(labelled)
    converged: dict[str, Any] = {
        key: data.isel(scale=np.flatnonzero(np.isfinite(data.running_contact_fraction)))
        for key, data in solved.items()
    }
    results: dict[str, Results] = {}
    for name, panels in wanted.items():
        results[name] = {
            panel: {line: converged[task.key] for line, task in lines.items()}
            for panel, lines in panels.items()
        }
    folder, statements = FigureFolder(Path(output), ("png", "pdf")), list[Statement]()
    for name in names:
        sheet = draw(name, inputs, results[name])
        folder.save(sheet, name)
        evidence = Evidence(inputs, results[name], results.get("fig5a", {}))
        statements += _unsolved(name, evidence) or judged(name, evidence)
        attrs = {"title": f"{name}: {title_of(name, inputs)}", "after": LW, "software": software()}
        for kind, named in (("surfaces", inputs.surfaces), ("rubbers", inputs.compounds)):
            attrs[kind] = "; ".join(f"{label}: {each.source}" for label, each in named.items())
        netcdf.save(drawn_data(sheet).assign_attrs(attrs), Path(output) / f"{name}.nc")
    write_statements(statements, Path(output))
    return statements


def _unsolved(name: str, evidence: Evidence) -> list[Statement]:
    """Return the one statement about a figure with a chain that ended too early."""
    for panel, lines in evidence.solved.items():
        for line, prediction in lines.items():
            if prediction.sizes["scale"] < FEWEST_WAVES:
                said = f"all statements about {title_of(name, evidence.inputs)}"
                criterion = f"at least {FEWEST_WAVES} waves of every chain converge"
                status = str(prediction.prediction_status.item())
                return [Statement(name, said, criterion, f"{panel}, {line}", status, None, "")]
    return []


def judged(name: str, evidence: Evidence) -> list[Statement]:
    """Return the statements about a figure."""
    statements = []
    for row in CLAIMS:
        if name in row["figures"].split():
            criterion = row["criterion"].format(**vars(judges))
            for where, number, holds, why in getattr(judges, row["judge"])(evidence):
                words = (name, row["said"], criterion, where, number)
                statements.append(Statement(*words, holds, "" if holds else why))
    return statements
