"""`gripscale fit-rubber FILE`: the rubber half of a run, from a measurement to a Prony series."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.terminal import command, say, screen
from gripscale.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from gripscale.case.prepare_rubber import PreparedRubber


def _option(text: str) -> Any:
    return typer.Option(help=text, show_default=False)


@command
def fit_rubber(
    file: Annotated[
        str, typer.Argument(help="A master curve, or sweeps to make one of.", show_default=False)
    ],
    terms: Annotated[int | None, _option("Relaxation times; chosen if not given.")] = None,
    frequency_unit: Annotated[str | None, _option("Where the header does not state it.")] = None,
    modulus_unit: Annotated[str | None, _option("Where the header does not state it.")] = None,
    modulus: Annotated[str | None, _option("E (Young) or G (shear).")] = None,
    bulk_modulus: Annotated[str | None, _option('Such as "2 GPa".')] = None,
    reference_temperature: Annotated[
        str | None, _option('Such as "20 C": where sweeps are shifted to.')
    ] = None,
    temperature_unit: Annotated[str | None, _option("K, C or F, if not stated.")] = None,
    columns: Annotated[
        str | None,
        _option(
            "Columns of frequency, storage and loss by name or number from 1, such as 1,3,4, or "
            "frequency=1,storage=3,loss_factor=5."
        ),
    ] = None,
    sheet: Annotated[
        str | None, _option("Excel sheet, by name or number from 1, if several hold numbers.")
    ] = None,
    header: Annotated[
        int | None, _option("Lines above the rows, if there are numbers among them.")
    ] = None,
    outlier_threshold: Annotated[
        float | None,
        _option("Times the typical scatter beyond which a row is left out; inf keeps all."),
    ] = None,
    shift: Annotated[str | None, _option("Table of shift factors to be taken; sweeps.")] = None,
    vertical: Annotated[
        bool, typer.Option("--vertical", help="Find vertical shifts as well; sweeps.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(help="Folder for figures and files.", metavar="DIR", readable=False),
    ] = None,
) -> None:
    """Fit a Prony series to a master curve, or to sweeps at several temperatures."""
    from gripscale.case import RubberSource, folder, prepare_rubber, validate
    from gripscale.report.inputs_text import band_table, prony_table, rubber_lines

    stated = {
        "file": file,
        "terms": terms,
        "frequency_unit": frequency_unit,
        "modulus_unit": modulus_unit,
        "modulus": modulus,
        "bulk_modulus": bulk_modulus,
        "reference_temperature": reference_temperature,
        "temperature_unit": temperature_unit,
        "columns": None if columns is None else _columns(columns),
        "sheet": None if sheet is None else _column(sheet),
        "header": header,
        "outlier_threshold": outlier_threshold,
        "shift": shift,
        "vertical": vertical or None,
    }
    values = {key: value for key, value in stated.items() if value is not None}
    source = validate(RubberSource, values, "options")
    if output is not None:
        folder.require_writable(output)
    console = screen()
    try:
        prepared = prepare_rubber(source)
    except InputError as error:
        raise InputError(_with_options(str(error))) from error
    rubber = prepared.rubber
    for line in (*rubber_lines(prepared), *band_table(rubber), *prony_table(rubber)):
        say(console, line)
    if output is not None:
        _write(console, prepared, output)


def _with_options(message: str) -> str:
    """Return a complaint that names a key of a case with the option of that name."""
    return re.sub(
        r"\b([a-z_]+)(?= must (be given|name|give|say)\b)",
        lambda key: f"--{key[1].replace('_', '-')}",
        message,
    )


def _column(text: str) -> str | int:
    """Return the number or the name of a column as it was typed."""
    text = text.strip()
    return int(text) if text.isdecimal() else text


def _columns(text: str) -> dict[str, str | int] | list[str | int]:
    """Return columns typed as 1,3,4 or as frequency=1,storage=3,loss_factor=4."""
    parts = text.split(",")
    if not all("=" in part for part in parts):
        return [_column(part) for part in parts]
    pairs = [part.split("=", 1) for part in parts]
    return {quantity.strip(): _column(column) for quantity, column in pairs}


def _write(console: Console, prepared: PreparedRubber, output: Path) -> None:
    """Write the figures, and of sweeps the shift table, the master curve and the rubber."""
    from gripscale.case import folder
    from gripscale.figures.case_all import rubber_figures

    folder.make(output)
    rubber_figures(prepared, (), output)
    master, sweeps = prepared.master, prepared.sweeps
    if master is None or sweeps is None:
        say(console, f"The figure is in {output}")
        return
    from gripscale.rubber import ShiftTable, write_master_curve, write_shift_table

    write_master_curve(output / "master_curve.csv", master)
    folder.write_text(output / "rubber.json", json.dumps(prepared.rubber.to_dict(), indent=1))
    if len(sweeps) > 1 and isinstance(master.shift, ShiftTable):
        write_shift_table(output / "shift_table.csv", master.shift)
    what = "Figures, shift table, master curve" if len(sweeps) > 1 else "The figure, master curve"
    say(console, f"{what} and rubber are in {output}")
