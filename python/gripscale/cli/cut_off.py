"""`gripscale cut-off CASE.toml`: contact and friction against the cut-off."""

from __future__ import annotations

from typing import Annotated

from gripscale.cli import terminal
from gripscale.cli.terminal import CasePath, OwnFolder, Workers, command, option
from gripscale.core.errors import InputError


@command
def cut_off(
    case: CasePath,
    down_to: Annotated[
        str | None,
        option(
            "Shortest wavelength, such as '10 um'; that of [below_measurement] by default.",
            metavar="LENGTH",
        ),
    ] = None,
    hurst: Annotated[
        float | None,
        option(
            "Hurst exponent of the roughness below the measurement, in place of that of the "
            "faces that touch.",
            metavar="NUMBER",
        ),
    ] = None,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Contact and friction against the cut-off, down below what the profiles resolve."""
    from gripscale.case_file import folder, read_case, read_case_file
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.core.units import parse_quantity
    from gripscale.questions.answer.findings import case_notices
    from gripscale.questions.cut_off.charts import cut_off_sheet
    from gripscale.questions.cut_off.cut_off_curve import FILE, case_cut_off
    from gripscale.questions.cut_off.page import answer_lines, cut_off_parts, failures
    from gripscale.questions.inputs.page_record import InputRecord

    file = read_case_file(case)
    try:
        end = None if down_to is None else parse_quantity(down_to, "length")
    except ValueError as error:
        raise InputError(f"--down-to = {down_to!r}: {error}") from error
    opening = f"Contact and friction of {file.path} against the cut-off"
    console, target = terminal.open_folder(file, output, "cut_off", opening)
    data = case_cut_off(
        read_case(file),
        folder=target,
        down_to=end,
        hurst=hurst,
        workers=workers,
        on_task=terminal.progress_printer(console),
    )
    failed = failures(data)

    def draw() -> None:
        if not failed:
            folder.make(target / "figures")
            figures = FigureFolder(target / "figures", file.case.output.figures)
            figures.save(cut_off_sheet(data), "cut_off")

    terminal.conclude(
        console,
        target,
        list(cut_off_parts(data)),
        results=[data],
        lead=list(answer_lines(data)),
        warnings=case_notices(None, InputRecord.of_file(target / FILE)),
        text="cut_off.txt",
        closing=f"Result ({FILE}), tables and figure are in",
        draw=draw,
        failure=terminal.first_of(failed, 1, "curves"),
    )
