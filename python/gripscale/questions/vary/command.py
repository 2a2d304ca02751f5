"""`gripscale study CASE.toml`: the answer over one or two inputs of a case."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from gripscale import terminal
from gripscale.terminal import CasePath, Cluster, Modulus, OwnFolder, Workers, case_command, option


@case_command
def study_command(
    case: CasePath,
    vary: Annotated[
        list[str],
        typer.Option(
            help="What to vary, once or twice: speed=0.003:30:log9, pressure='1 bar,3 bar', "
            "temperature='0 C:60 C:lin7', effects=all,no_heat,none, smallest_wavelength, cut_off, "
            "thickness=1 mm:8 mm:log4, top_height_fraction, waves, pressure_classes, "
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
    modulus: Modulus = None,
    static: Annotated[
        bool | None,
        option("Also the rubber at rest; as the case says by default.", "--static/--no-static"),
    ] = None,
) -> None:
    """Vary one or two inputs of a case: table, figures, one result file; resumes where stopped."""
    from gripscale.case_file import folder
    from gripscale.case_file.named_inputs import read_named_inputs
    from gripscale.questions.vary.axis import parse_axes
    from gripscale.questions.vary.question import Variation
    from gripscale.questions.vary.study import Study

    axes = parse_axes(vary)
    work = terminal.CaseCommand(case)
    varied = read_named_inputs(axes, work.file, modulus)
    planned = Study(work.case, varied, static=static, model=model, tolerance=tolerance)
    work.open_results(output, "study")
    stored = planned.stored(work.target)
    opening = planned.description()
    if stored is not None:
        opening = json.loads(stored.attrs["description"])
    for line in opening:
        terminal.print_wrapped(work.console, line)
    folder.save_case(work.file, work.target)
    data = planned.run(client=cluster, **work.solving(workers))
    work.finish(
        Variation(data),
        "table and figures",
        opening=opening,
        keep_figures=stored is not None,
    )
