"""Braking force over slip: `python -m examples.slip_curve CASE.toml --temperature "0 C,20 C"`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import gripscale as gs
from examples.slip_curve.question import STIFFNESS, slip_curve


def main(
    case: Path,
    speed: Annotated[str, typer.Option(help="Speeds of the road.")] = "80 km/h",
    temperature: Annotated[
        str | None, typer.Option(help="Of the rubber before the patch, such as '0 C,20 C'.")
    ] = None,
    braking: Annotated[
        tuple[str, str], typer.Option(help="Speeds from which and to which the wheels brake.")
    ] = ("80 km/h", "20 km/h"),
    stiffness: Annotated[float, typer.Option(help="Of a bristle [Pa/m].")] = STIFFNESS,
    output: Path = Path("results/slip"),
) -> None:
    """Braking force over slip of a tread as a brush, and braking distances; no tyre prediction."""
    result = slip_curve(
        gs.read_case(case),
        speed=speed,
        temperature=temperature,
        braking=braking,
        stiffness=stiffness,
        folder=output,
    )
    print(result)
    result.save(output / result.file)
    result.plot().savefig(output / "slip.png")
    print("Page:", result.page(output / "report.html"))


if __name__ == "__main__":
    typer.run(main)
