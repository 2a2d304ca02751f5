"""Reproducing the paper's figures: chains solved once, pictures, data and judged statements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from gripscale import checks, dataset
from gripscale.figures.style import save_figure
from gripscale.reproduce.bench import bench as read_bench
from gripscale.reproduce.chains import Panels, panels_of, results_of
from gripscale.reproduce.figures import TITLES, make
from gripscale.reproduce.statement import Statement, write_statements
from gripscale.study import Store, Task, solve_all
from gripscale.study.solving import OnCase

FIGURES = tuple(TITLES)
"""Names of the figures, in order."""

NEEDED_TOO = {"fig5b": ("fig5a",)}
"""Figures whose chains another one is compared with."""


def reproduce(
    figures: Sequence[str] = ("all",),
    output: str | Path = "reproduction",
    *,
    data: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_case: OnCase | None = None,
    on_statement: Callable[[Statement], None] | None = None,
) -> list[Statement]:
    """Make figures of Lind & Wangenheim 2014 with the inputs of `gripscale.reproduce.bench`.

    Parameters
    ----------
    figures
        Names of `FIGURES`, or "all".
    output
        Folder that gets `fig5a.png`, `fig5a.pdf` and `fig5a.nc` and so on, the judged statements
        as `statements.md` and `statements.json`, and the solved chains in `cases`: what is there
        is not solved again.
    data
        Folder of the example data; by default the one beside an installation from source.
    workers, client, on_case
        As for `gripscale.study.solve_all`.
    on_statement
        Called with each statement as it is judged.

    Returns
    -------
    list of Statement
        The statements of all figures asked for, in order.

    Raises
    ------
    InputError, FileError
        An unknown figure, data that are not there, a result that cannot be written.
    """
    names = chosen(figures)
    bench = read_bench(None if data is None else Path(data))
    wanted = {name: panels_of(name, bench) for name in _with_needed(names)}
    store = Store(Path(output) / "cases")
    solved = solve_all(_labelled(wanted), store, workers=workers, client=client, on_case=on_case)
    results = {name: results_of(panels, solved) for name, panels in wanted.items()}
    statements: list[Statement] = []
    for name in names:
        rest = results.get("fig5a", {})
        made = make(name, bench, results[name], rest)
        save_figure(made.figure, Path(output), name)
        dataset.save(made.data, Path(output) / f"{name}.nc")
        statements.extend(made.statements)
        for statement in made.statements:
            if on_statement is not None:
                on_statement(statement)
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
