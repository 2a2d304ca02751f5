"""`gripscale study CASE.toml`: the answer over one or two inputs of a case."""

from __future__ import annotations

import json
from typing import Annotated, Any

import typer

from gripscale import terminal
from gripscale.core.errors import InputError
from gripscale.terminal import CasePath, Cluster, OwnFolder, Workers, command, option


@command
def study_command(
    case: CasePath,
    vary: Annotated[
        list[str],
        typer.Option(
            help="What to vary, once or twice: speed=0.003:30:log9, pressure='1 bar,3 bar', "
            "temperature='0 C:60 C:lin7', effects=all,no_heat,none, smallest_wavelength, cut_off, "
            "top_height_fraction, waves, pressure_classes, "
            "factors=3.5/2.4,3/2.2, rubber=case,dma.txt, surface.",
            metavar="NAME=VALUES",
        ),
    ],
    output: OwnFolder = None,
    model: Annotated[
        str | None,
        option(
            "What predicts: direct (the whole measured surface at once), the default where the "
            "surface was measured, or chain (of sine waves), the default elsewhere."
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    workers: Workers = None,
    cluster: Cluster = None,
    static: Annotated[
        bool | None,
        option("Also the rubber at rest; as the case says by default.", "--static/--no-static"),
    ] = None,
) -> None:
    """Vary one or two inputs of a case: table, figures, one result file; resumes where stopped."""
    from gripscale.case_file import folder, read_case, read_case_file
    from gripscale.case_file.named_inputs import read_named_inputs
    from gripscale.questions.vary import question
    from gripscale.questions.vary.axis import parse_vary
    from gripscale.questions.vary.study import Study

    pairs = [parse_vary(text) for text in vary]
    axes: dict[str, Any] = dict(pairs)
    if len(axes) < len(pairs):
        raise InputError(f"vary must name different inputs; got {', '.join(n for n, _ in pairs)}")
    file = read_case_file(case)
    axes = dict(read_named_inputs(axes, file))
    options: dict[str, Any] = {"static": static, "model": model, "tolerance": tolerance}
    read = read_case(file)
    planned = Study(read, axes, **options)
    console, target = terminal.open_folder(file, output, "study")
    stored = planned.stored(target)
    opening = planned.description()
    if stored is not None:
        opening = json.loads(stored.attrs["description"])
    for line in [*opening, ""]:
        terminal.print_wrapped(console, line)
    folder.save_case(file, target)
    result = question.vary(
        read,
        **options,
        **axes,
        folder=target,
        workers=workers,
        client=cluster,
        on_task=terminal.progress_printer(console),
    )
    terminal.finish(
        console, target, result, file, "study.txt", "table and figures", opening=opening
    )
