"""The two surfaces and two compounds of the reproduction, and the tasks made of them.

Surfaces: a measured coarse road, and a synthetic dense asphalt of stated self-affine parameters.
Compounds: a filled tread rubber from its master curve, and an unfilled styrene-butadiene rubber
from published parameters. Loads as in Lind & Wangenheim 2014 (IMECE2014-37998): 3 bar, 300 and
3000 mm/s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from gripscale.case_file import (
    RubberSource,
    SurfaceTable,
    prepare_rubber,
    prepare_surface,
    validate,
)
from gripscale.core.errors import FileError
from gripscale.experiment import Task
from gripscale.model import Load
from gripscale.rubber import MasterCurve, PronyFit, Rubber, styrene_butadiene
from gripscale.surface import HeightDifference, SineStack, Surface, fit_sines
from gripscale.surface.synthetic import synthetic_surface

DATA = Path(__file__).resolve().parents[1] / "examples" / "data"

PRESSURE = 3e5
SPEED, FAST = 0.3, 3.0
FASTEST = 30.0
SPEEDS = (0.003, 0.03, SPEED, FAST, FASTEST)
FOOTPRINT = 0.1
"""Pa, m/s and m."""

SMALLEST_WAVELENGTH = 0.1e-3
PAPER_FACTORS = ((3.5, 2.4), (3.0, 2.2), (6.0, 3.0))
"""Magnification factors of the paper, the best fit to its asphalt first."""

ROAD = "measured coarse road"
DENSE = "synthetic dense asphalt"
TREAD = "filled tread"
SBR = "unfilled SBR"

ROAD_FILES = (
    "road/20211011_aylesbury_dec_station_0.dat",
    "road/20211011_aylesbury_dec_station_1.dat",
)
TREAD_FILE = "rubber/measured_dma.txt"
TREAD_SOURCE = "filled tread-type rubber; compound and laboratory are not stated by its publisher"


@dataclass(frozen=True)
class Inputs:
    """Surfaces and compounds by name, with the measurements behind the tread rubber."""

    surfaces: dict[str, Surface]
    rubbers: dict[str, Rubber]
    master: MasterCurve
    prony: PronyFit

    def correlation(self, surface: str) -> HeightDifference:
        """Return the height difference correlation of a surface."""
        found = self.surfaces[surface].correlation
        assert found is not None
        return found

    def task(self, surface: str, rubber: str, speed: float, sines: SineStack | None = None) -> Task:
        """Return the chain of a rubber on a surface, or on other waves of it; zero is static."""
        whole = self.surfaces[surface]
        return Task(
            self.rubbers[rubber],
            whole if sines is None else replace(whole, waves=sines),
            Load(PRESSURE, speed, FOOTPRINT),
        )

    def magnified(self, surface: str) -> dict[str, SineStack]:
        """Return waves with the paper's three magnifications, all from one first wave.

        On the dense asphalt they are the paper's pairs as printed, from the first wave fitted to
        the first pair. The coarse road has another exponent, to which the paper's amplitudes do
        not belong: there they are fitted for each of the paper's magnifications of wavelength.
        """
        curve, first = self.correlation(surface), self.surfaces[surface].sines
        printed = surface == DENSE
        if printed:
            s_wavelength, s_amplitude = PAPER_FACTORS[0]
            first = fit_sines(
                curve,
                smallest_wavelength=SMALLEST_WAVELENGTH,
                s_wavelength=s_wavelength,
                s_amplitude=s_amplitude,
            )
        stacks = {}
        for s_wavelength, s_amplitude in PAPER_FACTORS:
            stack = fit_sines(
                curve,
                smallest_wavelength=SMALLEST_WAVELENGTH,
                s_wavelength=s_wavelength,
                s_amplitude=s_amplitude if printed else None,
                first_wavelength=float(first.wavelength[0]),
                first_amplitude=float(first.amplitude[0]),
            )
            stacks[f"{s_wavelength:g}/{stack.s_amplitude:.3g}"] = stack
        return stacks


def read_inputs(data: Path = DATA) -> Inputs:
    """Read and fit the inputs of the reproduction.

    Parameters
    ----------
    data
        Folder with `road` and `rubber`; by default the one beside this folder.

    Raises
    ------
    FileError
        If the data are not there.
    """
    for name in (*ROAD_FILES, TREAD_FILE):
        if not (data / name).is_file():
            raise FileError(
                f"example data {data / name} does not exist; give the folder examples/data of "
                "gripscale's source with --data"
            )
    road = SurfaceTable(
        files=[str(data / name) for name in ROAD_FILES],
        crop=[0.12, 1.78],
        scales=8,
        smallest_wavelength=SMALLEST_WAVELENGTH,
    )
    stated = {
        "file": str(data / TREAD_FILE),
        "reference_temperature": "20 C",
        "source": TREAD_SOURCE,
        "bulk_modulus": 2e9,
    }
    source = validate(RubberSource, stated, "tread")
    tread = prepare_rubber(source)
    assert tread.master is not None
    assert tread.fit is not None
    return Inputs(
        surfaces={
            ROAD: prepare_surface(road),
            DENSE: synthetic_surface("synthetic_dense_asphalt"),
        },
        rubbers={TREAD: tread.rubber, SBR: styrene_butadiene()},
        master=tread.master,
        prony=tread.fit,
    )
