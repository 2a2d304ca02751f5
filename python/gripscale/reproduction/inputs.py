"""Surfaces and compounds of the reproduction, and the predictions made of them.

By default: a measured coarse road and a synthetic dense asphalt of stated self-affine parameters; a
filled tread from its master curve beside an unfilled styrene-butadiene rubber from published
parameters, and two resin treads at 0 C, whose loss factor has its maximum among the waves at the
speeds of the paper. Loads as in Lind & Wangenheim 2014 (IMECE2014-37998): 3 bar, 300 and 3000 mm/s.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from gripscale.case_file import prepare_rubber, prepare_surface, read_case_file, validate
from gripscale.case_file.named_inputs import names_of
from gripscale.case_file.prepare import case_surface
from gripscale.case_file.rubber_tables import NAMED_RUBBERS, RubberSource
from gripscale.case_file.tables import SurfaceTable
from gripscale.core import ZERO_CELSIUS, FileError, InputError
from gripscale.experiment import Task
from gripscale.model import FOOTPRINT, Load
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.surface import HeightDifference, SineStack, Surface, fit_sines
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, synthetic_surface

PACKAGE = Path(__file__).resolve().parents[1]
RUBBER_DATA, ROAD_DATA = PACKAGE / "reproduction" / "data", PACKAGE / "case_file" / "data" / "road"
ROAD_FILES = [str(ROAD_DATA / f"20211011_aylesbury_dec_station_{i}.dat") for i in (0, 1)]
ROAD_KEYS = {"crop": ["120 mm", "1780 mm"], "smallest_wavelength": "0.1 mm"}

NOMINAL_PRESSURE = 3e5  # [Pa]
SPEED, FAST, FASTEST = 0.3, 3.0, 30.0
SPEEDS = (0.003, 0.03, SPEED, FAST, FASTEST)  # [m/s]
# Magnification of wavelength and amplitude; an amplitude of None is fitted.
FactorPair = tuple[float, float | None]
# Those of the paper, the best fit to its asphalt first.
PAPER_FACTORS = ((3.5, 2.4), (3.0, 2.2), (6.0, 3.0))

COARSE, DENSE = "measured coarse road", "synthetic dense asphalt"
FILLED_TREAD, SBR = "filled tread", "unfilled SBR"
SBR_KEYS = {"name": "styrene_butadiene"}
R20, R60 = "R20, 0 °C", "R60, 0 °C"


@dataclass(frozen=True)
class PaperInputs:
    """Two surfaces, compounds and magnification factors; the first are those of most figures."""

    surfaces: dict[str, Surface]
    compounds: dict[str, MeasuredRubber]  # at the temperature of the contact
    pairs: tuple[tuple[str, str], ...]  # compounds that Fig. 9a compares
    factors: Mapping[str, Sequence[FactorPair]]  # by surface

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
        correlation = self.surfaces[surface].correlation
        assert correlation is not None
        return correlation

    def task(self, surface: str, rubber: str, speed: float, sines: SineStack | None = None) -> Task:
        """Return the chain of a rubber on a surface, or on other waves of it; zero is static."""
        road = self.surfaces[surface]
        road = road if sines is None else replace(road, waves=sines)
        return Task(self.compounds[rubber].rubber, road, Load(NOMINAL_PRESSURE, speed, FOOTPRINT))

    @cached_property
    def stacks(self) -> dict[str, dict[str, SineStack]]:
        """Waves with each pair of factors, by surface; all waves of a surface start from one.

        With an amplitude given, that one is the first wave fitted to the first pair of factors.
        """
        out = {}
        for surface, road in self.surfaces.items():
            pairs, first = self.factors[surface], road.sines
            smallest = float(first.wavelength[-1])
            fitted = partial(fit_sines, self.correlation(surface), smallest_wavelength=smallest)
            s, a = pairs[0]
            if a is not None:
                first = fitted(s_wavelength=s, s_amplitude=a)
            length, height = float(first.wavelength[0]), float(first.amplitude[0])
            fitted = partial(fitted, first_wavelength=length, first_amplitude=height)
            stacks = [fitted(s_wavelength=s, s_amplitude=a) for s, a in pairs]
            out[surface] = {f"{s.s_wavelength:g}/{s.s_amplitude:.3g}": s for s in stacks}
        return out

    def worst_fit(self, surface: str) -> str:
        """Return the pair of factors whose waves fit the correlation worst."""
        stacks = self.stacks[surface]
        return max(stacks, key=lambda name: stacks[name].residual or 0.0)


def read_inputs(
    surfaces: Sequence[str] = (),
    rubbers: Sequence[str] = (),
    factors: Sequence[FactorPair] = (),
    *,
    surface_keys: Mapping[str, Any] | None = None,
    rubber_keys: Mapping[str, Any] | None = None,
    temperature: float | None = None,
) -> PaperInputs:
    """Read and fit the inputs of the reproduction.

    `surfaces` and `rubbers`, two each, go in place of the default ones: files, cases or names that
    are known; `surface_keys` and `rubber_keys` of a case are for files of profiles and of moduli.
    `temperature` is that of these rubbers [K], by default that of the case or the file.
    Raises `FileError` if a file cannot be read, `InputError` if an input cannot be used.
    """
    if 0 < len(factors) < len(PAPER_FACTORS):
        words = "pairs or more, the worst fit of which is compared with the others; got"
        raise InputError(f"--factors must be {len(PAPER_FACTORS)} {words} {len(factors)}")
    roads = {
        name: _surface(file, surface_keys or {})
        for name, file in zip(names_of(surfaces), surfaces, strict=True)
    } or {
        COARSE: _profiles(COARSE, ROAD_FILES, ROAD_KEYS),
        DENSE: _surface("synthetic_dense_asphalt", {}),
    }
    compounds = {
        name: _compound(file, rubber_keys or {}, temperature)
        for name, file in zip(names_of(rubbers), rubbers, strict=True)
    }
    a, b = compounds or (FILLED_TREAD, SBR)
    fitted = [(s_wavelength, None) for s_wavelength, _ in PAPER_FACTORS]
    return PaperInputs(
        roads,
        compounds or _shipped_compounds(),
        pairs=((a, b),) if compounds else ((a, b), (R20, R60)),
        factors={name: factors or (PAPER_FACTORS if name == DENSE else fitted) for name in roads},
    )


def _profiles(name: str, files: Sequence[str], keys: Mapping[str, Any]) -> Surface:
    return prepare_surface(validate(SurfaceTable, {"files": files, "scales": 8, **keys}, name))


def _moduli(name: str, keys: Mapping[str, Any], *, titles_first: bool = False) -> MeasuredRubber:
    return prepare_rubber(validate(RubberSource, dict(keys), name), titles_first=titles_first)


def _shipped_compounds() -> dict[str, MeasuredRubber]:
    usual = {"reference_temperature": "20 C", "bulk_modulus": "2 GPa"}
    source = "filled tread-type rubber; compound and laboratory are not stated by its publisher"
    tread = {**usual, "file": str(RUBBER_DATA / "rubber" / "measured_dma.txt"), "source": source}
    compounds = {
        FILLED_TREAD: _moduli(FILLED_TREAD, tread),
        SBR: _compound("styrene_butadiene", {}, None),
    }
    usual["source"] = "tread compound of a series with resin, known by this letter only"
    for name in (R20, R60):
        start = str(RUBBER_DATA / "friction" / name.partition(",")[0])
        files = {"file": f"{start}_master_curve.csv", "shift": f"{start}_shift.csv"}
        compounds[name] = _at(_moduli(name, {**usual, **files}), ZERO_CELSIUS)
    return compounds


def _at(measured: MeasuredRubber, temperature: float | None) -> MeasuredRubber:
    """Return a rubber at a temperature [K]; None: that of its master curve."""
    rubber = measured.rubber if temperature is None else measured.rubber.at(temperature)
    return replace(measured, rubber=rubber)


def _surface(name: str, keys: Mapping[str, Any]) -> Surface:
    """Return a surface by its file, case or name."""
    if name in SYNTHETIC_SURFACES:
        return synthetic_surface(name)
    path = _file("--surface", name, SYNTHETIC_SURFACES)
    case = path.suffix == ".toml"
    surface = case_surface(read_case_file(path)) if case else _profiles(name, [str(path)], keys)
    if surface.correlation is None or surface.waves is None:
        raise InputError(f"--surface {name}: expected measured heights; got sine waves only")
    return surface


def _compound(name: str, keys: Mapping[str, Any], temperature: float | None) -> MeasuredRubber:
    """Return a rubber by its file, case or name, at a temperature [K] if one is stated."""
    if name in NAMED_RUBBERS:
        return _moduli(name, {"name": name})
    path = _file("--rubber", name, NAMED_RUBBERS)
    if path.suffix != ".toml":
        measured = _moduli(name, {"file": str(path), **keys}, titles_first=True)
        return _at(measured, temperature)
    case = read_case_file(path)
    measured = prepare_rubber(case.case.rubber, case.resolve)
    return _at(measured, temperature or case.case.conditions.temperature)


def _file(option: str, name: str, names: Collection[str]) -> Path:
    path = Path(name).expanduser()
    if not path.is_file():
        raise FileError(f"{option} {name} is neither a file nor one of {', '.join(names)}")
    return path
