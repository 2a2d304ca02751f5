"""`gripscale fit-rubber FILE`: the rubber half of a run, from a measurement to a Prony series."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.terminal import command, say, screen

if TYPE_CHECKING:
    from rich.console import Console

    from gripscale.case.models import RubberSource
    from gripscale.case.prepare import PreparedRubber
    from gripscale.rubber import ShiftFit, Superposition, Sweeps


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
    temperature_unit: Annotated[str | None, _option("K, C or F, if not stated; sweeps.")] = None,
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
    from gripscale.errors import InputError
    from gripscale.report.inputs_text import band_table, prony_table, rubber_lines
    from gripscale.rubber.sweeps_found import holds_sweeps

    stated = {
        "file": file,
        "terms": terms,
        "frequency_unit": frequency_unit,
        "modulus_unit": modulus_unit,
        "modulus": modulus,
        "bulk_modulus": bulk_modulus,
        "reference_temperature": reference_temperature,
    }
    values = {key: value for key, value in stated.items() if value is not None}
    source = validate(RubberSource, values, "options")
    if output is not None:
        folder.require_writable(output)
    console = screen()
    superposed: _Superposed | None = None
    if holds_sweeps(Path(file)):
        superposed = _Superposed(source, temperature_unit, shift, vertical)
        for line in superposed.lines():
            say(console, line)
        prepared = superposed.prepared
    elif temperature_unit or shift or vertical:
        raise InputError(
            f"{file}: temperature_unit, shift and vertical are for sweeps at several temperatures; "
            "got a master curve"
        )
    else:
        prepared = prepare_rubber(source)
    rubber = prepared.rubber
    for line in (*rubber_lines(prepared), *band_table(rubber), *prony_table(rubber)):
        say(console, line)
    if output is not None:
        _write(console, prepared, superposed, output)


class _Superposed:
    """Sweeps, their master curve and the rubber made of it."""

    sweeps: Sweeps
    report: Superposition
    prepared: PreparedRubber

    def __init__(
        self, source: RubberSource, temperature_unit: str | None, shift: str | None, vertical: bool
    ) -> None:
        from gripscale.case.prepare import PreparedRubber
        from gripscale.rubber import fit_prony_report, read_sweeps, superpose_report

        assert source.file is not None
        self.sweeps = read_sweeps(
            source.file,
            temperature_unit=temperature_unit,
            frequency_unit=source.frequency_unit,
            modulus_unit=source.modulus_unit,
            modulus=source.modulus,
            source=source.source or source.file,
        )
        master, self.report = superpose_report(
            self.sweeps,
            reference_temperature=self._reference(source.reference_temperature),
            vertical=vertical,
            shift=_given_shift(shift),
        )
        bulk = {} if source.bulk_modulus is None else {"bulk_modulus": source.bulk_modulus}
        rubber, fit = fit_prony_report(master, terms=source.terms, **bulk)
        self.prepared = PreparedRubber(rubber, master.source, master, fit)

    def _reference(self, stated: float | None) -> float:
        from gripscale.errors import InputError

        if stated is None and len(self.sweeps) > 1:
            raise InputError(
                'reference-temperature must be given, such as "20 C", for sweeps at '
                f"{len(self.sweeps)} temperatures to be shifted to"
            )
        return float(self.sweeps.temperatures[0]) if stated is None else stated

    def fits(self) -> list[ShiftFit]:
        """Return the WLF law of the shift, where it follows one."""
        from gripscale.errors import InputError
        from gripscale.rubber import ShiftTable, fit_wlf

        master = self.prepared.master
        if master is None or not isinstance(master.shift, ShiftTable):
            return []
        try:
            fit = fit_wlf(master.shift, reference_temperature=master.reference_temperature)
        except InputError:
            return []
        return [fit]

    def lines(self) -> Iterator[str]:
        """Yield the sweeps, how they meet, and the shift factors."""
        from gripscale.rubber import ShiftTable

        yield self.sweeps.summary()
        yield from self.report.summary().splitlines()
        master = self.prepared.master
        assert master is not None
        if isinstance(master.shift, ShiftTable):
            yield f"{'temperature [C]':>16} {'log10 a_T':>10} {'+-':>7} {'b_T':>7}"
            for kelvin, log_a, error, log_b in zip(
                master.shift.temperature,
                master.shift.horizontal,
                master.shift.horizontal_error,
                master.shift.vertical,
                strict=True,
            ):
                yield f"{kelvin - 273.15:>16.1f} {log_a:>10.3f} {error:>7.3f} {10.0**log_b:>7.3f}"
        yield from (fit.summary() for fit in self.fits())


def _given_shift(path: str | None) -> Any:
    from gripscale.rubber import read_shift_table

    return None if path is None else read_shift_table(path)


def _write(
    console: Console, prepared: PreparedRubber, superposed: _Superposed | None, output: Path
) -> None:
    """Write the figures, and of sweeps the shift table, the master curve and the rubber."""
    from gripscale.case import folder
    from gripscale.figures.case_all import rubber_figure

    folder.make(output)
    rubber_figure(prepared, (), output)
    if superposed is None:
        say(console, f"The figure is in {output}")
        return
    from gripscale.figures import (
        save_figure,
        shift_figure,
        superposition_figure,
        superposition_tests_figure,
    )
    from gripscale.rubber import ShiftTable, write_master_curve, write_shift_table

    master, sweeps = prepared.master, superposed.sweeps
    assert master is not None
    write_master_curve(output / "master_curve.csv", master)
    folder.write_text(output / "rubber.json", json.dumps(prepared.rubber.to_dict(), indent=1))
    if len(sweeps) > 1:
        save_figure(superposition_figure(sweeps, master), output, "superposition")
        tests = superposition_tests_figure(sweeps, superposed.report)
        save_figure(tests, output, "superposition_tests")
    if len(sweeps) > 1 and isinstance(master.shift, ShiftTable):
        write_shift_table(output / "shift_table.csv", master.shift)
        save_figure(shift_figure(master.shift, superposed.fits()), output, "shift")
    what = "Figures, shift table, master curve" if len(sweeps) > 1 else "The figure, master curve"
    say(console, f"{what} and rubber are in {output}")
