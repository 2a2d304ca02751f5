"""What a case file may say: its tables, their keys, defaults and limits.

Lengths in m, pressures in Pa, speeds in m/s and times in s once read.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Field,
    GetCoreSchemaHandler,
    InstanceOf,
    model_validator,
)
from pydantic_core import core_schema

from gripscale.case.conditions_table import ConditionsTable
from gripscale.case.expected import Words
from gripscale.case.quantity import (
    Duration,
    Length,
    Position,
    Pressure,
    Speed,
    Temperature,
    TemperatureDifference,
)
from gripscale.case.shift_table import ShiftSource
from gripscale.case.table import Table
from gripscale.case.uncertainty_table import UncertaintyTable
from gripscale.chain.pressure import MOST_CLASSES
from gripscale.rubber.stated import columns_of
from gripscale.rubber.strain_energy import NeoHookean, StrainEnergy, strain_energy_from_dict
from gripscale.textfile import MOST_LINES
from gripscale.units import in_mm, listed, parse_quantity, spelled

NAMED_RUBBERS = ("styrene_butadiene",)

COLUMN = "its name or its number from 1"
COLUMNS = (
    "three names or numbers from 1, of frequency, storage and loss modulus, or a table such as "
    "{ frequency = 1, storage = 2, loss_factor = 4 }"
)
LOAD_TIME = '"passage", "infinite" or a time such as "1 s"'
STRAIN_ENERGY = 'a table such as { kind = "mooney_rivlin", share = 0.2 }'


def _load_time(value: Any) -> float | str:
    """Accept "passage", "infinite" or a time."""
    if value == "passage":
        return "passage"
    if value in ("infinite", math.inf):
        return math.inf
    try:
        seconds = parse_quantity(value, "time")
    except ValueError as error:
        raise ValueError(f'{error}, or "passage", or "infinite"') from error
    if seconds <= 0.0:
        raise ValueError("expected a time greater than zero")
    return seconds


@dataclass(frozen=True)
class Unit(Words):
    """A unit of one kind of quantity."""

    kind: str

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Look at the text once pydantic knows that it is one."""
        return core_schema.no_info_after_validator_function(self._check, handler(source))

    def _check(self, value: str) -> str:
        if spelled(value, self.kind) is None:
            raise ValueError(f"expected {self.words}")
        return value


def _unit(kind: str) -> Unit:
    return Unit(f"one of {listed(kind)}", kind)


def _column(value: Any) -> str | int:
    """Accept the name or the number of a column, a channel or a sheet."""
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise ValueError(f"expected {COLUMN}")
    if isinstance(value, int) and value < 1:
        raise ValueError("columns, channels and sheets are counted from 1")
    return value


def _columns(value: Any) -> dict[str, str | int]:
    """Accept three columns, or a table of them by quantity."""
    if not isinstance(value, dict | list):
        raise ValueError(f"expected {COLUMNS}")
    return {name: _column(column) for name, column in columns_of(value).items()}


def _strain_energy(value: Any) -> StrainEnergy:
    """Accept a table such as { kind = "yeoh", second = -0.1, third = 0.02 }."""
    if isinstance(value, StrainEnergy):
        return value
    if not isinstance(value, dict):
        raise ValueError(f"expected {STRAIN_ENERGY}")
    return strain_energy_from_dict(value)


def _cut_off(value: Any) -> Any:
    """Accept a length, "instrument" or a table such as { rms_slope = 1.3, of = "surface" }."""
    from gripscale.surface.cut_off import cut_off_rule  # scipy with it: not for reading a case

    return None if value is None else cut_off_rule(value)


CUT_OFF_WORDS = Words('a length, "instrument" or a table such as { rms_slope = 1.3 }')

Column = Annotated[str | int, BeforeValidator(_column), Words(COLUMN)]
Columns = Annotated[dict[str, str | int], BeforeValidator(_columns), Words(COLUMNS)]


class Wave(Table):
    """One sine wave stated by hand: wavelength and half peak-to-valley amplitude."""

    wavelength: Length
    """Length of the wave."""
    amplitude: Length
    """Half its peak-to-valley height."""


MAP_KEYS = ("step", "crop_across", "trim", "form")
PROFILE_KEYS = ("across_gaps", "detrend", "sheet")
"""Keys of [surface] that only a map, or only profiles have."""


class Surface(Table):
    """Measured profiles or a map and how they become sine waves, or the waves themselves."""

    files: list[str] | None = Field(default=None, min_length=1)
    """Measured profiles of one road; several are pooled."""
    map: str | None = None
    """A measured map, in place of files."""
    sines: list[Wave] | None = Field(default=None, min_length=1)
    """Waves stated by hand, in place of files; longest first."""
    x_unit: Annotated[str, _unit("length")] | None = None
    """Unit of distances where the file does not name it."""
    z_unit: Annotated[str, _unit("length")] | None = None
    """Unit of heights where the file does not name it."""
    direction: Literal["x", "y"] = "x"
    """The way of sliding in a map."""
    reader: Literal["auto", "text", "instrument"] = "auto"
    """How to read the files; auto goes by the suffix."""
    channel: Column | None = None
    """Channel of an instrument's file that has several of heights."""
    sheet: Column | None = None
    """Sheet of an Excel file, where several hold numbers."""
    step: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None
    """Distances between the points of a map along x and y, where its file has none."""
    crop: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    """First and last distance to keep along x; all by default."""
    crop_across: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    """The same along y, of a map."""
    valid_range: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    """Lowest and highest height to believe; others become missing."""
    trim: float = Field(default=0.5, ge=0.0, le=1.0, allow_inf_nan=False)
    """Share of missing heights above which a border line of a map is cut off."""
    remove_spikes: bool = True
    """Spikes become missing heights."""
    spike_slope: float = Field(default=3.0, gt=0.0, allow_inf_nan=False)
    """Change of height per step at which neighbours are a spike (ISO 13473-1: 3)."""
    across_gaps: bool = False
    """Hold the points on both sides of a gap of a profile to that slope, too."""
    detrend: Literal["linear", "mean", "none"] = "linear"
    """Trend subtracted from a profile."""
    form: int = Field(default=1, ge=0, le=8)
    """Order of the polynomial subtracted from a map: 0 the mean, 1 a plane, 2 a paraboloid."""
    upper_share: float = Field(default=1.0, gt=0.0, le=1.0, allow_inf_nan=False)
    """Share of the heights, from the highest down, that counts in the correlation."""
    max_lag: Length | None = None
    """Largest lag of the correlation; a quarter of the shortest profile by default."""
    scales: int | None = Field(default=None, ge=1, le=24)
    """Number of waves."""
    smallest_wavelength: Length | None = None
    """Wavelength of the last wave."""
    cut_off: Annotated[Any, BeforeValidator(_cut_off), CUT_OFF_WORDS] = None
    """Where the roughness ends, in place of smallest_wavelength."""
    s_wavelength: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    """Factor from one wavelength to the next, if given instead of fitted."""
    s_amplitude: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    """Factor from one amplitude to the next, if given instead of fitted."""
    first_wavelength: Length | None = None
    """The first wavelength, if given instead of fitted."""
    first_amplitude: Length | None = None
    """The first amplitude, if given instead of fitted."""
    single_factor: bool = False
    """One factor for wavelength and amplitude, which Lind and Wangenheim show to fail."""
    smallest_lag: Length | None = None
    """Smallest lag that counts in the fit."""
    largest_lag: Length | None = None
    """Largest lag that counts in the fit."""

    @model_validator(mode="after")
    def _one_source(self) -> Surface:
        if sum(source is not None for source in (self.files, self.map, self.sines)) != 1:
            raise ValueError(
                "expected either files (measured profiles), map (a measured map) or "
                "sines (waves by hand)"
            )
        ends = [self.smallest_wavelength, self.cut_off]
        if self.sines is None and self.scales is None and ends == [None, None]:
            raise ValueError(
                "expected scales (number of waves), smallest_wavelength or cut_off (where they "
                "end), or both"
            )
        if None not in ends:
            raise ValueError(
                "expected either smallest_wavelength (the last wave) or cut_off (where the "
                "roughness ends)"
            )
        if self.sines is not None and self.cut_off is not None:
            raise ValueError("cut_off belongs to a measured surface, not to waves by hand")
        foreign, owner = (MAP_KEYS, "map") if self.map is None else (PROFILE_KEYS, "files")
        for name in foreign:
            if getattr(self, name) != type(self).model_fields[name].default:
                raise ValueError(f"{name} belongs to a surface from {owner}")
        for name in ("crop", "crop_across", "valid_range"):
            limits = getattr(self, name)
            if limits is not None and limits[0] >= limits[1]:
                raise ValueError(
                    f"{name} runs from {in_mm(limits[0])} to {in_mm(limits[1])}; "
                    "expected its start before its end"
                )
        if self.sines is not None:
            lengths = [wave.wavelength for wave in self.sines]
            if any(b >= a for a, b in pairwise(lengths)):
                raise ValueError("expected sines in order of falling wavelength")
        return self

    @property
    def measured_files(self) -> list[str]:
        """Names of the files it was measured in."""
        return [self.map] if self.map is not None else self.files or []


class RubberSource(Table):
    """Measured moduli, with what their file does not state, or a rubber known by name.

    The file is a master curve, or sweeps at several temperatures to make one of.
    """

    file: str | None = None
    """A measured master curve, or sweeps at several temperatures."""
    name: Literal["styrene_butadiene"] | None = None
    """A rubber known by name, in place of a file."""
    frequency_unit: Annotated[str, _unit("frequency")] | None = None
    """Unit of frequencies where the file does not name it."""
    modulus_unit: Annotated[str, _unit("modulus")] | None = None
    """Unit of moduli where the file does not name it."""
    modulus: Literal["E", "G"] | None = None
    """Young's or shear moduli, where the file does not say."""
    columns: Columns | None = None
    """Columns of frequency, storage and loss modulus, where their titles do not tell."""
    sheet: Column | None = None
    """Sheet of an Excel file, where several hold numbers."""
    header: int | None = Field(default=None, ge=0, le=MOST_LINES)
    """Number of lines above the rows, where there are numbers among them."""
    temperature_unit: Annotated[str, _unit("temperature")] | None = None
    """Unit of temperatures where the file does not name it."""
    temperature_step: TemperatureDifference | None = None
    """Of temperature ramps: moduli are interpolated at multiples of this."""
    reference_temperature: Temperature | None = None
    """Temperature the master curve holds for, or sweeps are shifted to."""
    shift: ShiftSource | None = None
    """Time-temperature shift, needed away from the reference temperature."""
    vertical: bool = False
    """Find a vertical shift of sweeps, too."""
    source: str = ""
    """Where the rubber comes from, carried into the results."""
    terms: int | None = Field(default=None, ge=1, le=200)
    """Number of Maxwell elements; chosen from the data by default."""
    outlier_threshold: float | None = Field(default=None, gt=0.0)
    """Times the typical scatter beyond which a measured row is left out of the fit."""
    bulk_modulus: Pressure | None = None
    """Bulk modulus, which a DMA measurement does not give."""
    extrapolate: Literal["say", "refuse"] = "say"
    """Waves beyond the measured frequencies: solved and said, or refused."""
    strain_energy: Annotated[
        InstanceOf[StrainEnergy], BeforeValidator(_strain_energy), Words(STRAIN_ENERGY)
    ] = NeoHookean()
    """Law of the permanent network at large strain."""

    @model_validator(mode="after")
    def _one_source(self) -> RubberSource:
        if (self.file is None) == (self.name is None):
            raise ValueError(
                f"expected either file (a master curve) or name ({', '.join(NAMED_RUBBERS)})"
            )
        foreign = self.model_fields_set - {
            "name",
            "bulk_modulus",
            "strain_energy",
            "extrapolate",
            "shift",
            "file",
        }
        if self.name is not None and foreign:
            raise ValueError(f"{min(foreign)} belongs to a measured file, not to a named rubber")
        if self.vertical and self.shift is not None:
            raise ValueError("expected either shift (given) or vertical (found from the sweeps)")
        return self

    @property
    def files(self) -> list[str]:
        """Names of the files it was measured in."""
        shift = [self.shift] if isinstance(self.shift, str) else []
        return [*filter(None, [self.file]), *shift]


class Load(Table):
    """How hard, how fast and over what length the rubber is pressed and slid."""

    pressure: Pressure
    """Nominal pressure."""
    speed: Speed
    """Sliding speed; 0 is the relaxed rubber at rest."""
    footprint: Length
    """Length of the nominal contact: how long the largest wave is loaded."""
    static: bool = False
    """The relaxed rubber at rest, too."""
    load_time: Annotated[Any, BeforeValidator(_load_time), Words(LOAD_TIME)] = "passage"
    """How long a wave is loaded: while the contact above it passes, for ever, or a time."""


class Solver(Table):
    """The model of one wave and its mesh; what is not stated stays at the solver's default."""

    model: Literal["finite_strain", "half_plane"] = "finite_strain"
    """What solves a wave: the block at finite strain or the half-plane at small strain."""
    columns: int | None = Field(default=None, ge=4, le=1024, multiple_of=2)
    """Elements along the block, doubled where the two frictions differ."""
    rows: int | None = Field(default=None, ge=2, le=256)
    """Elements across the block."""
    depth: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    """Height of the block over the wavelength."""
    element_order: Literal[1, 2] | None = None
    """Order of the elements."""
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0, allow_inf_nan=False)
    """The mesh is refined until the estimated errors are below this."""
    time_limit: Duration | None = None
    """A wave that takes longer is given up."""
    points: int | None = Field(default=None, ge=16, le=8192)
    """Points of the half-plane."""

    @model_validator(mode="after")
    def _options_of_the_model(self) -> Solver:
        mesh = ["columns", "rows", "depth", "element_order", "tolerance", "time_limit"]
        foreign = ["points"] if self.model == "finite_strain" else mesh
        for name in foreign:
            if getattr(self, name) is not None:
                raise ValueError(f'{name} is not an option of model = "{self.model}"')
        return self

    def options(self) -> dict[str, Any]:
        """Return the stated options as keyword arguments of the solver."""
        return self.model_dump(exclude={"model"}, exclude_none=True)


class ChainOptions(Table):
    """What goes on from wave to wave."""

    pressure_classes: int = Field(default=1, ge=1, le=MOST_CLASSES)
    """Classes of equal load in which the pressure is handed down; 1: its mean."""


class Output(Table):
    """Where the results go."""

    folder: str = "results"
    """Folder of the results, from the case file."""


class MeasuredTable(Table):
    """Friction measured elsewhere: a table of speed and friction, drawn over what is predicted."""

    friction: str | None = None
    """A table of speed and friction, drawn over what is predicted."""


class Compare(Table):
    """What `gripscale compare` puts beside the models: fits of a theory."""

    layer_ratio: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    """Thickness of the strained layer over penetration depth, in Klueppel and Heinrich's theory."""
    penetration_depth: Length | None = None
    """Mean penetration depth in that theory."""

    @model_validator(mode="after")
    def _both_or_none(self) -> Compare:
        if (self.layer_ratio is None) != (self.penetration_depth is None):
            raise ValueError(
                "expected layer_ratio and penetration_depth together: Klueppel and Heinrich's "
                "theory needs both"
            )
        return self


class Case(Table):
    """A whole case file."""

    surface: Surface
    """What is slid on."""
    rubber: RubberSource
    """What slides."""
    load: Load
    """How it is pressed and slid."""
    solver: Solver = Solver()
    """What solves one wave."""
    chain: ChainOptions = ChainOptions()
    """What goes on from wave to wave."""
    conditions: ConditionsTable = ConditionsTable()
    """Effects beside the rubber as measured."""
    measured: MeasuredTable = MeasuredTable()
    """Friction measured elsewhere."""
    output: Output = Output()
    """Where results go."""
    compare: Compare = Compare()
    """Further inputs of a comparison."""
    uncertainty: UncertaintyTable = UncertaintyTable()
    """What is not known of all that."""

    @model_validator(mode="after")
    def _energy_of_the_model(self) -> Case:
        if self.solver.model == "half_plane" and self.rubber.strain_energy != NeoHookean():
            raise ValueError(
                "strain_energy of [rubber] has no effect at small strain; expected "
                'model = "finite_strain" with it'
            )
        return self

    def named_files(self) -> list[tuple[str, str]]:
        """Return role and name of every file it names."""
        friction = [self.measured.friction] if self.measured.friction is not None else []
        roles = (
            ("surface", self.surface.measured_files),
            ("rubber", self.rubber.files),
            ("conditions", self.conditions.files),
            ("measured", friction),
        )
        return [(role, name) for role, names in roles for name in names]
