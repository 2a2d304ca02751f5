"""The two surfaces and two compounds of the reproduction, and the chains on them.

Surfaces: a measured coarse road, and a synthetic dense asphalt of stated self-affine parameters.
Compounds: a filled tread rubber from its master curve, and an unfilled styrene-butadiene rubber
from published parameters. Loads as in Lind & Wangenheim 2014 (IMECE2014-37998): 3 bar, 300 and
3000 mm/s.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import gripscale
from gripscale.case import RubberSource, Surface
from gripscale.errors import FileError
from gripscale.rubber import MasterCurve, PronyFit, Rubber, styrene_butadiene
from gripscale.study import Task
from gripscale.study.inputs import Road
from gripscale.study.synthetic import synthetic_surface
from gripscale.surface import HeightDifference, SineStack, fit_sines

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
class Bench:
    """Surfaces and compounds by name, with the measurements behind the tread rubber."""

    roads: dict[str, Road]
    rubbers: dict[str, Rubber]
    master: MasterCurve
    prony: PronyFit

    def correlation(self, road: str) -> HeightDifference:
        """Return the height difference correlation of a surface."""
        found = self.roads[road].correlation
        assert found is not None
        return found

    def task(self, road: str, rubber: str, speed: float, sines: SineStack | None = None) -> Task:
        """Return the chain of a rubber on a surface; zero speed is static."""
        return Task(
            rubber=self.rubbers[rubber],
            sines=self.roads[road].sines if sines is None else sines,
            pressure=PRESSURE,
            speed=speed,
            footprint=FOOTPRINT,
        )

    def magnified(self, road: str) -> dict[str, SineStack]:
        """Return waves with the paper's three magnifications, all from one first wave.

        On the dense asphalt they are the paper's pairs as printed, from the first wave fitted to
        the first pair. The coarse road has another exponent, to which the paper's amplitudes do
        not belong: there they are fitted for each of the paper's magnifications of wavelength.
        """
        curve, first = self.correlation(road), self.roads[road].sines
        printed = road == DENSE
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


def default_data() -> Path:
    """Return where the example data are beside an installation from source."""
    return Path(gripscale.__file__).resolve().parents[2] / "examples" / "data"


def bench(data: Path | None = None) -> Bench:
    """Read and fit the inputs of the reproduction.

    Parameters
    ----------
    data
        Folder with `road` and `rubber`; by default the one beside an installation from source.

    Raises
    ------
    FileError
        If the data are not there.
    """
    from gripscale.cli.inputs import study_rubber, study_surface  # late: loads the command line

    folder = default_data() if data is None else data
    for name in (*ROAD_FILES, TREAD_FILE):
        if not (folder / name).is_file():
            raise FileError(
                f"example data {folder / name} does not exist; give the folder examples/data of "
                "gripscale's source with --data"
            )
    settings = Surface(
        files=[str(folder / name) for name in ROAD_FILES],
        crop=[0.12, 1.78],
        scales=8,
        smallest_wavelength=SMALLEST_WAVELENGTH,
    )
    road = study_surface(settings, Path)
    assert road.measured is not None
    source = RubberSource(
        file=str(folder / TREAD_FILE),
        reference_temperature=293.15,
        source=TREAD_SOURCE,
        bulk_modulus=2e9,
    )
    tread = study_rubber(source, Path)
    assert tread.master is not None
    assert tread.fit is not None
    dense, described, correlation = synthetic_surface("synthetic_dense_asphalt")
    return Bench(
        roads={
            ROAD: Road(road.sines, road.source, road.measured.correlation, settings),
            DENSE: Road(dense, described, correlation),
        },
        rubbers={TREAD: tread.rubber, SBR: styrene_butadiene()},
        master=tread.master,
        prony=tread.fit,
    )
