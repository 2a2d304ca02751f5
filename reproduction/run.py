"""Reproducing the paper's figures: predictions made once, pictures, data and judged statements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from gripscale.charts import save_figure
from gripscale.core import checks
from gripscale.experiment import Bench, Progress, Store, Task
from gripscale.io import netcdf
from reproduction.figures import TITLES, make
from reproduction.inputs import DATA, OwnInputs, read_inputs
from reproduction.panels import Panels, panels_of, results_of
from reproduction.statement import Statement, write_statements

FIGURES = tuple(TITLES)
"""Names of the figures, in order."""

NEEDED_TOO = {"fig5b": ("fig5a",)}
"""Figures whose predictions another one is compared with."""


def reproduce(
    figures: Sequence[str] = ("all",),
    output: str | Path = "results/reproduction",
    *,
    data: str | Path | None = None,
    own: OwnInputs | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: Callable[[Progress], None] | None = None,
) -> list[Statement]:
    """Make figures of Lind & Wangenheim 2014 with the inputs of `reproduction.inputs`.

    Parameters
    ----------
    figures
        Names of `FIGURES`, or "all".
    output
        Folder that gets `fig5a.png`, `fig5a.pdf` and `fig5a.nc` and so on, the judged statements
        as `statements.md` and `statements.json`, and `predictions`: what is there is not solved
        again.
    data
        Folder of the example data; by default the one beside this folder.
    own
        Surfaces, rubbers and factors in place of those of `reproduction.inputs`.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    list of Statement
        The statements of all figures asked for, in order.

    Raises
    ------
    InputError, FileError
        An unknown figure, inputs that cannot be read or used, a result that cannot be written.
    """
    names = chosen(figures)
    inputs = read_inputs(DATA if data is None else Path(data), own)
    wanted = {name: panels_of(name, inputs) for name in _with_needed(names)}
    store = Store(Path(output) / "predictions")
    solved = Bench(store, workers, client, on_task).solve(_labelled(wanted))
    results = {name: results_of(panels, solved) for name, panels in wanted.items()}
    statements: list[Statement] = []
    for name in names:
        rest = results.get("fig5a", {})
        made = make(name, inputs, results[name], rest)
        save_figure(made.figure, Path(output), name)
        netcdf.save(made.data, Path(output) / f"{name}.nc")
        statements.extend(made.statements)
    write_statements(statements, Path(output))
    return statements


def chosen(figures: Sequence[str]) -> list[str]:
    """Return the figures asked for, in order; raise `InputError` for an unknown name."""
    for name in figures:
        checks.one_of("figure", name, ("all", *FIGURES))
    return [name for name in FIGURES if "all" in figures or name in figures]


def _with_needed(names: Sequence[str]) -> list[str]:
    needed = {other for name in names for other in NEEDED_TOO.get(name, ())}
    return [name for name in FIGURES if name in names or name in needed]


def _labelled(wanted: dict[str, Panels]) -> dict[str, Task]:
    return {
        f"{name}, {panel}, {line}": task
        for name, panels in wanted.items()
        for panel, lines in panels.items()
        for line, task in lines.items()
    }
