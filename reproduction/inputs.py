"""Surfaces and compounds of the reproduction, and the tasks made of them.

By default: a measured coarse road and a synthetic dense asphalt of stated self-affine parameters; a
filled tread from its master curve beside an unfilled styrene-butadiene rubber from published
parameters, and two resin treads at 0 C, whose loss factor has its maximum among the waves at the
speeds of the paper. Loads as in Lind & Wangenheim 2014 (IMECE2014-37998): 3 bar, 300 and 3000 mm/s.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from gripscale.case_file import (
    RubberSource,
    SurfaceTable,
    prepare_rubber,
    prepare_surface,
    read_case_file,
    validate,
)
from gripscale.case_file.named_inputs import names_of
from gripscale.case_file.prepare import case_surface
from gripscale.case_file.rubber_tables import NAMED_RUBBERS
from gripscale.core import ZERO_CELSIUS
from gripscale.core.errors import FileError, InputError
from gripscale.experiment import Task
from gripscale.model import Load
from gripscale.rubber import MasterCurve, PronyFit, Rubber
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.surface import HeightDifference, SineStack, Surface, fit_sines
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, synthetic_surface

DATA = Path(__file__).resolve().parents[1] / "examples" / "data"

PRESSURE = 3e5
SPEED, FAST = 0.3, 3.0
FASTEST = 30.0
SPEEDS = (0.003, 0.03, SPEED, FAST, FASTEST)
FOOTPRINT = 0.1
"""Pa, m/s and m."""

SCALES, SMALLEST_WAVELENGTH = 8, 0.1e-3
Factors = tuple[float, float | None]
"""Magnification of wavelength and amplitude; an amplitude of None is fitted."""
PAPER_FACTORS = ((3.5, 2.4), (3.0, 2.2), (6.0, 3.0))
"""Magnification factors of the paper, the best fit to its asphalt first."""
PAPER_WAVELENGTHS = tuple((s_wavelength, None) for s_wavelength, _ in PAPER_FACTORS)

ROAD = "measured coarse road"
DENSE = "synthetic dense asphalt"
TREAD = "filled tread"
SBR = "unfilled SBR"
R20, R60 = "R20, 0 °C", "R60, 0 °C"

ROAD_FILES = (
    "road/20211011_aylesbury_dec_station_0.dat",
    "road/20211011_aylesbury_dec_station_1.dat",
)
TREAD_FILE = "rubber/measured_dma.txt"
TREAD_SOURCE = "filled tread-type rubber; compound and laboratory are not stated by its publisher"
RESIN_SOURCE = "tread compound of a series with resin, known by this letter only"


@dataclass(frozen=True)
class Compound:
    """A rubber at the temperature of the contact, and the measurement it was fitted to."""

    rubber: Rubber
    master: MasterCurve | None = None
    """The measured rows, at the temperature of the rubber."""
    fit: PronyFit | None = None

    @classmethod
    def of(cls, measured: MeasuredRubber, temperature: float | None = None) -> Compound:
        """Return a measured rubber at a temperature [K]; None: that of its master curve."""
        rubber, master = measured.rubber, measured.master
        if temperature is None:
            return cls(rubber, master, measured.fit)
        shifted = rubber.at(temperature)
        if master is not None and rubber.shift is not None and rubber.reference_temperature:
            a = float(rubber.shift.a(temperature, rubber.reference_temperature))
            b = float(rubber.shift.b(temperature, rubber.reference_temperature))
            master = replace(
                master,
                frequency=master.frequency / a,
                storage=master.storage / b,
                loss=master.loss / b,
                reference_temperature=temperature,
                shift=None,
            )
        return cls(shifted, master, measured.fit)


@dataclass(frozen=True)
class Inputs:
    """Surfaces and compounds by name."""

    surfaces: dict[str, Surface]
    """Two; the first is that of all figures with a single surface."""
    compounds: dict[str, Compound]
    pairs: tuple[tuple[str, str], ...]
    """Compounds that Fig. 9a compares; the first of all is that of figures with a single one."""
    factors: Mapping[str, tuple[Factors, ...]]
    """Magnification factors by surface."""

    @property
    def rubbers(self) -> dict[str, Rubber]:
        """Compounds without what they were fitted to."""
        return {name: compound.rubber for name, compound in self.compounds.items()}

    @property
    def surface(self) -> str:
        """Name of the surface of figures with a single surface."""
        return next(iter(self.surfaces))

    @property
    def rubber(self) -> str:
        """Name of the compound of figures with a single compound."""
        return self.pairs[0][0]

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

    @cached_property
    def stacks(self) -> dict[str, dict[str, SineStack]]:
        """Waves with each pair of factors, by surface; all waves of a surface start from one.

        With an amplitude given, that one is the first wave fitted to the first pair of factors.
        """
        return {surface: self._magnified(surface) for surface in self.surfaces}

    def _magnified(self, surface: str) -> dict[str, SineStack]:
        curve, first = self.correlation(surface), self.surfaces[surface].sines
        smallest = float(first.wavelength[-1])
        (s_wavelength, s_amplitude), *_ = self.factors[surface]
        if s_amplitude is not None:
            first = fit_sines(
                curve,
                smallest_wavelength=smallest,
                s_wavelength=s_wavelength,
                s_amplitude=s_amplitude,
            )
        stacks = {}
        for s_wavelength, s_amplitude in self.factors[surface]:
            stack = fit_sines(
                curve,
                smallest_wavelength=smallest,
                s_wavelength=s_wavelength,
                s_amplitude=s_amplitude,
                first_wavelength=float(first.wavelength[0]),
                first_amplitude=float(first.amplitude[0]),
            )
            stacks[f"{s_wavelength:g}/{stack.s_amplitude:.3g}"] = stack
        return stacks

    def worst_fit(self, surface: str) -> str:
        """Return the pair of factors whose waves fit the correlation worst."""
        stacks = self.stacks[surface]
        return max(stacks, key=lambda name: stacks[name].residual or 0.0)


@dataclass(frozen=True)
class OwnInputs:
    """What is put in the place of the default inputs, as named on the command line."""

    surfaces: tuple[str, ...] = ()
    """Two profiles, cases or surfaces known by name."""
    rubbers: tuple[str, ...] = ()
    """Two files of moduli, cases or rubbers known by name."""
    factors: tuple[Factors, ...] = ()
    surface_keys: Mapping[str, Any] | None = None
    """Keys of [surface] of a case, for the files of profiles."""
    rubber_keys: Mapping[str, Any] | None = None
    temperature: float | None = None
    """Of the own rubbers [K]; None: that of the case or the file."""


def read_inputs(data: Path = DATA, own: OwnInputs | None = None) -> Inputs:
    """Read and fit the inputs of the reproduction.

    Parameters
    ----------
    data
        Folder with `road`, `rubber` and `friction`; by default the one beside this folder.
    own
        Surfaces, rubbers and factors in place of the defaults.

    Raises
    ------
    FileError
        If data are not there or cannot be read.
    InputError
        If a surface has no measured heights, or an input cannot be used.
    """
    own = own or OwnInputs()
    surfaces = {
        name: _own_surface(file, own.surface_keys or {})
        for name, file in zip(names_of(own.surfaces), own.surfaces, strict=True)
    } or {ROAD: _road(data), DENSE: synthetic_surface("synthetic_dense_asphalt")}
    compounds = {
        name: _own_compound(file, own)
        for name, file in zip(names_of(own.rubbers), own.rubbers, strict=True)
    }
    a, b = compounds or (TREAD, SBR)
    return Inputs(
        surfaces=surfaces,
        compounds=compounds or _compounds(data),
        pairs=((a, b),) if compounds else ((a, b), (R20, R60)),
        factors={
            name: own.factors or (PAPER_FACTORS if name == DENSE else PAPER_WAVELENGTHS)
            for name in surfaces
        },
    )


def _road(data: Path) -> Surface:
    files = [str(_data_file(data, name)) for name in ROAD_FILES]
    keys: dict[str, Any] = {"files": files, "crop": ["120 mm", "1780 mm"]}
    keys |= {"scales": SCALES, "smallest_wavelength": f"{SMALLEST_WAVELENGTH} m"}
    return prepare_surface(validate(SurfaceTable, keys, "road"))


def _compounds(data: Path) -> dict[str, Compound]:
    def read(name: str, **keys: Any) -> MeasuredRubber:
        file = str(_data_file(data, name))
        stated = {"file": file, "reference_temperature": "20 C", "bulk_modulus": "2 GPa", **keys}
        return prepare_rubber(validate(RubberSource, stated, name))

    def resin(letter: str) -> Compound:
        shift = str(_data_file(data, f"friction/{letter}_shift.csv"))
        measured = read(f"friction/{letter}_master_curve.csv", shift=shift, source=RESIN_SOURCE)
        return Compound.of(measured, ZERO_CELSIUS)

    return {
        TREAD: Compound.of(read(TREAD_FILE, source=TREAD_SOURCE)),
        SBR: _named("styrene_butadiene"),
        R20: resin("R20"),
        R60: resin("R60"),
    }


def _named(name: str) -> Compound:
    return Compound.of(prepare_rubber(validate(RubberSource, {"name": name}, name)))


def _data_file(data: Path, name: str) -> Path:
    if not (data / name).is_file():
        raise FileError(
            f"example data {data / name} does not exist; give the folder examples/data of "
            "gripscale's source with --data"
        )
    return data / name


def _own_surface(name: str, keys: Mapping[str, Any]) -> Surface:
    if name in SYNTHETIC_SURFACES:
        return synthetic_surface(name)
    path = _own_file("--surface", name, SYNTHETIC_SURFACES)
    if path.suffix == ".toml":
        surface = case_surface(read_case_file(path))
    else:
        stated = {"files": [str(path)], "scales": SCALES, **keys}
        surface = prepare_surface(validate(SurfaceTable, stated, name))
    if surface.correlation is None or surface.waves is None:
        raise InputError(f"--surface {name}: expected measured heights; got sine waves only")
    return surface


def _own_compound(name: str, own: OwnInputs) -> Compound:
    if name in NAMED_RUBBERS:
        return _named(name)
    path, temperature = _own_file("--rubber", name, NAMED_RUBBERS), own.temperature
    if path.suffix == ".toml":
        case = read_case_file(path)
        measured = prepare_rubber(case.case.rubber, case.resolve)
        temperature = temperature or case.case.conditions.temperature
    else:
        stated = {"file": str(path), **(own.rubber_keys or {})}
        measured = prepare_rubber(validate(RubberSource, stated, name), titles_first=True)
    return Compound.of(measured, temperature)


def _own_file(option: str, name: str, known: Any) -> Path:
    path = Path(name).expanduser()
    if not path.is_file():
        raise FileError(f"{option} {name} is neither a file nor one of {', '.join(known)}")
    return path
