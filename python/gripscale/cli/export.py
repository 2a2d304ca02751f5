"""`gripscale export`: rubbers, tables and meshes for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gripscale.core.errors import InputError
from gripscale.questions.terminal import Modulus, argument, command, option, print_wrapped, screen

export = typer.Typer(
    help="Write rubbers, tables and meshes for other programs.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
_Result = Annotated[Path, argument("The .nc file of a result.", "RESULT.nc")]


@export.command("rubber")
@command
def rubber(
    context: typer.Context,
    source: Annotated[
        Path,
        argument(
            "A case file (TOML), a measured master curve, or a rubber.json of fit-rubber.", "FILE"
        ),
    ],
    to: Annotated[str, typer.Option(help="abaqus, ansys or febio.")],
    output: Annotated[Path, option("The file to write.", metavar="FILE")],
    temperature: Annotated[
        str | None, option('Such as "40 C": of moduli and times, where the rubber has a shift.')
    ] = None,
    band: Annotated[
        str | None, option("Frequencies that the series is reduced to, such as 1..1e6 Hz.")
    ] = None,
    terms: Annotated[
        int | None, option("Number of terms that the series is reduced to; its misfit is stated.")
    ] = None,
    name: Annotated[str | None, option("Of the material; not for ansys.")] = None,
    material: Annotated[int | None, option("Number of the material; not for abaqus.")] = None,
    modulus: Modulus = None,
    modulus_unit: Annotated[str | None, option("Pa (as by default), kPa, MPa or GPa.")] = None,
    temperature_unit: Annotated[
        str | None, option("K (as by default) or C, of the shift; not for febio.")
    ] = None,
) -> None:
    """Write a rubber as a material of a finite element program."""
    from gripscale.case_file import RubberSource, prepare_rubber, read_case_file, validate
    from gripscale.core.units import parse_quantity
    from gripscale.export import write_rubber
    from gripscale.export.rubber import reduced

    if source.suffix == ".toml":
        file = read_case_file(source)
        rubber = prepare_rubber(file.case.rubber, file.resolve).rubber
    else:
        keys = {"file": str(source)} | ({} if modulus is None else {"modulus": modulus})
        rubber = prepare_rubber(validate(RubberSource, keys, str(source))).rubber
    if temperature is not None:
        rubber = rubber.at(temperature)
    console, ends = screen(), None
    if band is not None:
        try:
            words = band.strip().removesuffix("Hz").strip().split("..")
            low, high = (parse_quantity(f"{end.strip()} Hz", "frequency") for end in words)
        except ValueError as error:
            raise InputError(
                f"band must be two frequencies such as 1..1e6 Hz; got {band!r}"
            ) from error
        ends = low, high
    if band is not None or terms is not None:
        reduction = reduced(rubber, band=ends, terms=terms)
        rubber = reduction.rubber
        print_wrapped(console, f"{reduction}.")
    names = ("name", "material", "modulus_unit", "temperature_unit")
    options = {key: context.params[key] for key in names if context.params[key] is not None}
    written = write_rubber(rubber, output, to=to, **options)
    for remark in written.remarks:
        print_wrapped(console, remark)
    print_wrapped(console, f"The material is {output}")


@export.command("tables")
@command
def tables(
    result: _Result,
    output: Annotated[Path, option("Folder for the tables.", metavar="DIR")],
) -> None:
    """Write a result as csv tables, one for each set of dimensions, with units in the headings."""
    from gripscale.export import write_tables

    written = write_tables(result, output)
    print_wrapped(screen(), f"{', '.join(path.name for path in written)}: in {output}")


@export.command("mesh")
@command
def mesh(
    result: _Result,
    wave: Annotated[int, typer.Option(help="Number of the wave, from 1.")],
    output: Annotated[Path, option("The file to write.", metavar="FILE.vtu")],
) -> None:
    """Write the deformed block of a wave, with pressure and stress, for ParaView and the like."""
    from gripscale.export import wave_of, write_mesh
    from gripscale.io import netcdf

    data = netcdf.load_dataset(result)
    if "mesh_x" not in data:
        files = sorted(result.parent.glob("[!.]*.nc"))
        names = [file.name for file in files if "mesh_x" in netcdf.load_dataset(file)]
        others = f"; {' and '.join(names)} beside it has" if names else ""
        raise InputError(
            f"{result} has no meshes, which the finite-strain block gives to each wave{others}"
        )
    chosen = wave_of(data, wave)
    write_mesh(chosen, output)
    print_wrapped(
        screen(), f"Wave {wave}, {chosen.wavelength:.4g} m long, {chosen.why}, is {output}"
    )
