"""A rubber as the input of a finite element program, and what of it the program cannot carry."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, field
from pathlib import Path

from gripscale import checks
from gripscale.errors import InputError
from gripscale.netcdf import write_whole
from gripscale.rubber import Rubber
from gripscale.textfile import file_path
from gripscale.units import UNITS, ZERO_CELSIUS
from gripscale.versions import version_of

WIDTH = 76
"""Characters of a comment: Abaqus reads 256 a line, people read fewer."""


@dataclass(frozen=True)
class ProgramFile:
    """A text for a finite element program."""

    text: str = field(repr=False)
    """The whole file."""
    remarks: tuple[str, ...]
    """What it says of itself in comments: units, what holds where, what is not carried."""

    def write(self, path: str | Path) -> Path:
        """Write the file, completely or not at all; return its path.

        Raises `FileError` if it cannot be written.
        """
        return write_whole(file_path(path), self._write)

    def _write(self, part: Path) -> None:
        part.write_text(self.text, encoding="utf-8")


@dataclass(frozen=True)
class Units:
    """Units of a file: of moduli and of temperatures; times are in s.

    Raises `InputError` if a unit is unknown.
    """

    modulus: str = "Pa"
    temperature: str = "K"

    def __post_init__(self) -> None:
        checks.one_of("modulus_unit", self.modulus, UNITS["modulus"])
        checks.one_of("temperature_unit", self.temperature, ["K", "C"])

    def stress(self, pascal: float) -> float:
        """Return a stress or modulus [Pa] in the unit of the file."""
        return pascal / UNITS["modulus"][self.modulus]

    def temperature_of(self, kelvin: float) -> float:
        """Return a temperature [K] in the unit of the file."""
        return kelvin - ZERO_CELSIUS if self.temperature == "C" else kelvin


def heading(rubber: Rubber, units: Units, program: str) -> list[str]:
    """Return what a file says of the rubber before what it says of the program."""
    named = "; ".join(text for text in (rubber.name, rubber.source) if text) or "a rubber"
    lines = [
        f"Written by gripscale {version_of('gripscale')} for {program}: {' '.join(named.split())}.",
        f"Units: stresses and moduli in {units.modulus}, times in s, temperatures in "
        f"{units.temperature}.",
        f"Young's modulus {units.stress(rubber.equilibrium_modulus):.6g} relaxed, "
        f"{units.stress(rubber.glassy_modulus):.6g} at once; {len(rubber.moduli)} Maxwell "
        f"elements; bulk modulus {units.stress(rubber.bulk_modulus):.6g}, which does not relax.",
    ]
    if rubber.valid_band is not None:
        low, high = rubber.valid_band
        lines.append(
            f"The series rests on a measurement from {low:.4g} to {high:.4g} rad/s; beyond, it is "
            "an extrapolation."
        )
    if rubber.reference_temperature is not None:
        kelvin = rubber.reference_temperature
        lines.append(
            f"Moduli and times are those at {units.temperature_of(kelvin):.6g} {units.temperature}."
        )
    return lines


def comment(remarks: list[str], mark: str) -> list[str]:
    """Return remarks as lines of comment, each begun with `mark`; letters beyond ASCII are "?"."""
    return [
        f"{mark} {line}"
        for remark in remarks
        for line in textwrap.wrap(
            "".join(letter if " " <= letter <= "~" else "?" for letter in remark),
            WIDTH,
            subsequent_indent="  ",
            break_on_hyphens=False,
        )
    ]


def label(rubber: Rubber, name: str | None) -> str:
    """Return a name that all programs take: letters, digits, underscores; 38 at most.

    Raises `InputError` if it is stated and is none.
    """
    if name is None:
        plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in rubber.name).strip("_")
        return f"rubber_{plain}"[:38].strip("_")
    checks.text("name", name)
    letters = name.isascii() and name.replace("_", "").isalnum() and name[:1].isalpha()
    if not letters or len(name) > 38:
        raise InputError(
            "name must be at most 38 letters, digits and underscores, a letter first; "
            f"got {checks.shown(name)}"
        )
    return name
