"""The examples and what each consists of: a case, files of the package, a road made up on the spot.

The files are those of `examples/` in the source tree, linked into `data` and `cases`: a wheel
holds them, and there is one of each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

import numpy as np

from gripscale.case_file.keys import SCHEMA_LINE, write_schema
from gripscale.core import ZERO_CELSIUS, Described, FileError, checks
from gripscale.io.folders import make_folder, require_writable, write_bytes


def road_text() -> str:
    """Return distance and height [mm] of a self-affine profile, with their titles."""
    from gripscale.surface import self_affine_profile

    road = self_affine_profile(
        hurst=0.8, xi_parallel=3e-3, xi_perpendicular=0.8e-3, length=0.4, step=0.05e-3, seed=3
    )
    rows = (f"{x * 1e3:.2f}\t{z * 1e3:.4f}" for x, z in zip(road.x, road.z, strict=True))
    return "\n".join(["x [mm]\tz [mm]", *rows]) + "\n"


def sweeps_text() -> str:
    """Return sweeps [C, Hz, MPa] of an unfilled SBR at 13 temperatures, with 1 % of noise.

    The moduli at 20 C are those of `styrene_butadiene`. They are shifted by the universal constants
    of M. L. Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701, for a glass
    transition at -50 C: c1 = 17.44 and c2 = 51.6 K there are 7.4 and 121.6 K at 20 C.
    """
    from gripscale.rubber import WLF
    from gripscale.rubber.measured_rubber import springpot_modulus

    shift, noise = WLF(c1=7.4, c2=121.6), np.random.default_rng(11)
    frequency = np.geomspace(0.1, 50.0, 15)
    rows = ["temperature [C]\tfrequency [Hz]\tE' [MPa]\tE'' [MPa]"]
    for celsius in range(-40, 81, 10):
        factor = shift.a(celsius + ZERO_CELSIUS, 20.0 + ZERO_CELSIUS)
        for hertz, modulus in zip(
            frequency, springpot_modulus(2.0 * np.pi * frequency * factor), strict=True
        ):
            parts = 1e-6 * np.array([modulus.real, modulus.imag]) * noise.normal(1.0, 0.01, 2)
            rows.append(f"{celsius}\t{hertz:.4g}\t{parts[0]:.4g}\t{parts[1]:.4g}")
    return "\n".join(rows) + "\n"


_CASE, _PACKAGE = "case.toml", files("gripscale.case_file")


@dataclass(frozen=True, repr=False)
class Example(Described):
    """A case with the files it names."""

    about: str  # what slides on what
    folders: tuple[str, ...] = ()  # of the package, whose files it names, with origin and licence
    made: tuple[tuple[str, Callable[[], str]], ...] = ()  # texts computed instead, by their path
    needs: str = ""  # extra of the package without which its files cannot be read, or nothing


EXAMPLES: dict[str, Example] = {
    "road": Example(
        "a filled tread rubber on a coarse road, both measured", ("data/road", "data/friction")
    ),
    "synthetic": Example(
        "an unfilled rubber known by name on a made-up self-affine road",
        made=(("road.txt", road_text),),
    ),
    "sweeps": Example(
        "an unfilled rubber in sweeps at 13 temperatures on a made-up road, both imitated",
        made=(("road.txt", road_text), ("sweeps.csv", sweeps_text)),
    ),
    "map": Example(
        "an unfilled rubber known by name on a measured map of a ground surface",
        ("data/surfaces",),
        needs="formats",
    ),
}
"""By name, the first being the usual one."""


def write_example(folder: str | Path, name: str = "road") -> list[Path]:
    """Write an example into `folder`; return the paths written, the case first.

    Raises `InputError` for a name that is not in `EXAMPLES`; `FileError` if one of its files is
    there already, nothing being written then, or cannot be written.
    """
    example = EXAMPLES[checks.one_of("example", name, tuple(EXAMPLES))]
    target = Path(folder)
    # A case of the source tree seeks its data in the folder above.
    text = _PACKAGE.joinpath(f"cases/{name}.toml").read_text(encoding="utf-8")
    text = text.replace('"../data/', '"data/')
    contents = {_CASE: f"{SCHEMA_LINE}{text}".encode()}
    for data in example.folders:
        measured = sorted(_PACKAGE.joinpath(data).iterdir(), key=lambda file: file.name)
        contents |= {f"{data}/{file.name}": file.read_bytes() for file in measured}
    contents |= {path: make().encode("utf-8") for path, make in example.made}
    require_writable(target)
    taken = [path for path in contents if (target / path).exists()]
    if taken:
        raise FileError(
            f"{target / taken[0]} is there already and is not overwritten; "
            "expected a folder without it"
        )
    for path, content in contents.items():
        make_folder((target / path).parent)
        write_bytes(target / path, content)
    write_schema(SCHEMA_LINE, target)
    return [target / path for path in contents]
