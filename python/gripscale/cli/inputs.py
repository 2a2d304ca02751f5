"""Before a run: an example to start from, the keys of a case, and its two halves alone."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.keys import takes_keys
from gripscale.cli.new import naming_options
from gripscale.core.errors import about_keys
from gripscale.questions.terminal import (
    READING,
    argument,
    command,
    end_steps,
    option,
    print_parts,
    print_wrapped,
    screen,
    show_step,
    with_options,
)

if TYPE_CHECKING:
    from gripscale.io.table import Table
    from gripscale.rubber.measured_rubber import MeasuredRubber
    from gripscale.rubber.softening import SofteningTable
    from gripscale.surface import Surface


_FIGURES = ("png", "pdf")


@command
def init(
    folder: Annotated[Path, argument("Where to write; made if needed.", "FOLDER")],
    example: Annotated[
        str,
        typer.Option(
            help="road: a measured road and a measured tread rubber; synthetic: a made-up road "
            "and a named rubber; sweeps: the same road with a rubber in sweeps at 13 temperatures; "
            "map: a measured map, which needs gripscale[formats] to be read."
        ),
    ] = "road",
) -> None:
    """Write a commented case and example data to start from; nothing is overwritten."""
    from gripscale.case_file.examples import EXAMPLES, write_example

    written, needs = write_example(folder, example), EXAMPLES[example].needs
    files = [f"  {path.relative_to(folder)}" for path in written]
    lines = [f"{folder}: {EXAMPLES[example].about}", *files, "", "Next:"]
    lines += [f'  pip install "gripscale[{needs}]"'] if needs else []
    for words in (("run", written[0]), ("report", folder / "results"), ("compare", written[0])):
        lines.append(f"  {shlex.join(['gripscale', *map(str, words)])}")
    print_parts(screen(), lines)


@command
def keys(
    section: Annotated[
        str | None,
        argument(
            "A table of the case, such as rubber or conditions.heat; all by default.", "SECTION"
        ),
    ] = None,
    schema: Annotated[
        bool, typer.Option("--schema", help="Print the JSON Schema of a case instead, for editors.")
    ] = False,
) -> None:
    """List every key of a case file: what it takes, its default, its meaning."""
    from gripscale.case_file.keys import case_schema, sections
    from gripscale.core import checks
    from gripscale.io.table import Column, Table
    from gripscale.report.failures import chapter_words

    if schema:
        typer.echo(case_schema())
        return
    chosen = sections()
    if section is not None:
        checks.one_of("section", section, dict.fromkeys(part.name for part in chosen))
    console = screen()
    for part in chosen:
        if section in (None, part.name, part.name.partition(".")[0]):
            columns = {
                "key": [key.name for key in part.keys],
                "takes": [key.takes for key in part.keys],
                "default": [key.default for key in part.keys],
                "meaning": [key.meaning for key in part.keys],
            }
            table = Table(
                part.name,
                [Column(name, texts, words=True) for name, texts in columns.items()],
                f"{part.title}: {part.about}",
            )
            print_parts(console, ["", table])
            pages = dict.fromkeys(chapter_words(key.chapter) for key in part.keys)
            print_wrapped(console, f"More in {', '.join(pages)}.")


@command
@takes_keys(
    *("scales", "smallest_wavelength", "cut_off", "top_height_fraction", "s_wavelength"),
    *("s_amplitude", "single_factor", "crop", "x_unit", "z_unit", "z_axis", "channel", "step"),
    *("spikes", "detrend", "longest_wavelength"),
)
def fit_surface(
    context: typer.Context,
    files: Annotated[list[str], argument("Profiles, or a map.")],
    slopes: Annotated[bool, option("Print the rms slope down to each wavelength.")] = False,
    output: Annotated[Path | None, option("Folder for figures.", metavar="DIR")] = None,
    *,
    keys: dict[str, Any],
) -> None:
    """Clean profiles or a map, find their height difference correlation, fit sine waves to it."""
    from gripscale.case_file import SurfaceTable, prepare_surface, validate
    from gripscale.case_file.proposals import open_surface, reading_keys
    from gripscale.io.folders import make_folder, require_writable
    from gripscale.questions.inputs import page
    from gripscale.surface import HeightMap

    values = {"files": files, **keys}
    if not {"scales", "smallest_wavelength", "cut_off"} & keys.keys():
        values["scales"] = 8
    raw, console = None, screen()
    show_step(console, READING)
    if len(files) == 1:
        # whether two steps are right depends on what the file holds
        validate(SurfaceTable, values | {"step": None}, "options")
        read_by = reading_keys(values)
        with about_keys("surface"), naming_options():
            measured, _ = open_surface(Path(files[0]), values.get("step"), **read_by)
        raw = measured if isinstance(measured, HeightMap) else [measured]
    if isinstance(raw, HeightMap):
        values["map"] = values.pop("files")[0]
    surface = validate(SurfaceTable, values, "options")
    if output is not None:
        require_writable(output)
    prepared = prepare_surface(surface, raw=raw)
    end_steps()
    sines = prepared.sines
    parts: list[str | Table] = [
        *(f"doubt: {with_options(doubt.sentence, context.params)}" for doubt in prepared.doubts),
        *page.surface_lines(prepared),
        *(f"note: {finding}" for finding in prepared.findings if finding not in prepared.doubts),
        page.waves_table(sines.wavelength, sines.amplitude),
        *_ambiguity(prepared),
    ]
    if prepared.measured is not None:
        parts.append(page.texture_table(prepared.measured.texture))
        if (levels := prepared.measured.texture_levels) is not None:
            parts.append(page.texture_levels_table(levels))
        if slopes:
            parts.append(page.rms_slopes_table(prepared.measured.slopes))
    print_parts(console, parts)
    if output is not None:
        from gripscale.charts.draw import FigureFolder
        from gripscale.questions.inputs.charts_of_surface import surface_figures

        make_folder(output)
        surface_figures(prepared, FigureFolder(output, _FIGURES))
        print_parts(console, ["", f"Figures are in {output}"])


def _ambiguity(prepared: Surface) -> Iterator[str]:
    from gripscale.surface import sine_ambiguity

    if prepared.correlation is None or len(prepared.sines) < 2:
        return
    same = sine_ambiguity(prepared.correlation, prepared.sines)
    low, high = (length * 1e3 for length in same.first_wavelength)
    yield (
        f"C_z is known to {same.band:.2g} decades; {len(same.stacks)} of {same.tried} stacks "
        f"tried follow it as well: {same.waves.low:.0f} to {same.waves.high:.0f} waves, "
        f"s_wavelength {same.s_wavelength.low:.2g} to {same.s_wavelength.high:.2g}, "
        f"first wave {low:.3g} to {high:.3g} mm, "
        f"rms slope {same.rms_slope.low:.2f} to {same.rms_slope.high:.2f}."
    )


@command
@takes_keys(
    *("terms", "frequency_unit", "modulus_unit", "modulus", "frequency", "bulk_modulus"),
    *("reference_temperature", "temperature_unit", "columns", "sheet", "header"),
    *("outlier_threshold", "shift", "wlf", "vertical"),
    *("amplitude", "deformation", "measured_at", "strain_unit"),
)
def fit_rubber(
    file: Annotated[
        list[str],
        argument("A master curve, or sweeps to make one of, and strain sweeps; in several files."),
    ],
    output: Annotated[Path | None, option("Folder for figures and files.", metavar="DIR")] = None,
    *,
    keys: dict[str, Any],
) -> None:
    """Fit a Prony series to a master curve or to sweeps at several temperatures.

    Strain sweeps among the files are drawn: what they keep of the moduli.
    """
    from gripscale.case_file import RubberSource, prepare_rubber, validate
    from gripscale.case_file.rubber_tables import StrainSweeps
    from gripscale.io.folders import require_writable
    from gripscale.io.text_table import files_read_once
    from gripscale.questions.inputs import page
    from gripscale.rubber.strain_sweeps import holds_strain_sweeps

    console, law, prepared = screen(), None, None
    show_step(console, READING)
    layout = {key: keys[key] for key in ("columns", "sheet") if key in keys}
    of_strain = layout if "strain" in layout.get("columns", ()) else {}
    if output is not None:
        require_writable(output)
    with files_read_once(), naming_options():
        by_strain = [name for name in file if holds_strain_sweeps(name, **of_strain)]
        file = [name for name in file if name not in by_strain]
        if by_strain:
            values = {key: keys[key] for key in StrainSweeps.model_fields if key in keys}
            if file:
                values.pop("columns", None)  # they are those of the moduli
            values |= {"kind": "table", "files": by_strain}
            law = validate(StrainSweeps, values, "options").softening()
        if file:
            if "wlf" in keys:
                keys["shift"] = keys.pop("wlf")
            values = {key: keys[key] for key in RubberSource.model_fields if key in keys}
            values["file"] = file[0] if len(file) == 1 else file
            prepared = prepare_rubber(validate(RubberSource, values, "options"))
    end_steps()
    if prepared is not None:
        rubber = prepared.rubber
        terms_table = page.prony_table(rubber.relaxation_times, rubber.moduli)
        findings = () if prepared.fit is None else prepared.fit.findings
        tables = filter(None, [page.band_table(rubber), terms_table])
        print_parts(console, [*page.rubber_parts(prepared), *findings, *tables])
    if law is not None:
        print_parts(console, page.softening_parts(law))
    if output is not None:
        print_parts(console, ["", f"{_written(prepared, law, output)} in {output}"])


def _written(prepared: MeasuredRubber | None, law: SofteningTable | None, output: Path) -> str:
    """Write the figures, and of sweeps the shift table, the master curve and the rubber."""
    from gripscale.charts.draw import FigureFolder
    from gripscale.io.folders import make_folder, write_text
    from gripscale.questions.inputs.charts_of_rubber import rubber_figures, softening_sheet

    make_folder(output)
    figures = FigureFolder(output, _FIGURES)
    if law is not None:
        figures.save(softening_sheet(law), "softening")
    if prepared is None:
        return "The figure is"
    rubber_figures(prepared, (), figures)
    master, sweeps = prepared.master, prepared.sweeps
    if master is None or sweeps is None:
        return "The figure is"
    from gripscale.rubber import ShiftTable, write_master_curve, write_shift_table

    write_master_curve(output / "master_curve.csv", master)
    write_text(output / "rubber.json", json.dumps(prepared.rubber.to_dict(), indent=1))
    if len(sweeps) > 1 and isinstance(master.shift, ShiftTable):
        write_shift_table(output / "shift_table.csv", master.shift)
    what = "Figures, shift table, master curve" if len(sweeps) > 1 else "The figure, master curve"
    return f"{what} and rubber are"
