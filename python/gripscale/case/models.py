"""What a case file may say: its tables, their keys, defaults and limits.

Lengths in m, pressures in Pa, speeds in m/s and times in s once read.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    InstanceOf,
    model_validator,
)

from gripscale.case.conditions_table import ConditionsTable
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
from gripscale.chain.pressure import MOST_CLASSES
from gripscale.rubber.strain_energy import NeoHookean, StrainEnergy, strain_energy_from_dict
from gripscale.surface.cut_off import CutOffRule, cut_off_rule
from gripscale.units import listed, parse_quantity, spelled

NAMED_RUBBERS = ("styrene_butadiene",)


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


def _unit(kind: str) -> AfterValidator:
    """Return a validator that accepts only a unit of `kind`."""

    def check(value: str) -> str:
        if spelled(value, kind) is None:
            raise ValueError(f"expected one of {listed(kind)}")
        return value

    return AfterValidator(check)


def _column(value: Any) -> str | int:
    """Accept the name or the position of a column."""
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise ValueError("expected the name of a column or its number from 0")
    return value


def _strain_energy(value: Any) -> StrainEnergy:
    """Accept a table such as { kind = "yeoh", second = -0.1, third = 0.02 }."""
    if isinstance(value, StrainEnergy):
        return value
    if not isinstance(value, dict):
        raise ValueError('expected a table such as { kind = "mooney_rivlin", share = 0.2 }')
    return strain_energy_from_dict(value)


def _cut_off(value: Any) -> CutOffRule | None:
    """Accept a length, "instrument" or a table such as { rms_slope = 1.3, of = "surface" }."""
    return None if value is None else cut_off_rule(value)


Column = Annotated[str | int, BeforeValidator(_column)]


class Wave(Table):
    """One sine wave stated by hand: wavelength and half peak-to-valley amplitude."""

    wavelength: Length = Field(description='a length such as "20 mm"')
    amplitude: Length = Field(description='a length such as "1 mm", half peak-to-valley')


MAP_KEYS = ("step", "crop_across", "trim", "form")
PROFILE_KEYS = ("across_gaps", "detrend")
"""Keys of [surface] that only a map, or only profiles have."""


class Surface(Table):
    """Measured profiles or a map and how they become sine waves, or the waves themselves."""

    files: list[str] | None = Field(default=None, min_length=1)
    map: str | None = None
    sines: list[Wave] | None = Field(default=None, min_length=1)
    x_unit: Annotated[str, _unit("length")] | None = None
    z_unit: Annotated[str, _unit("length")] | None = None
    direction: Literal["x", "y"] = "x"
    reader: Literal["auto", "text", "instrument"] = "auto"
    channel: Column | None = None
    step: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None
    crop: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    crop_across: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    valid_range: Annotated[list[Position], Field(min_length=2, max_length=2)] | None = None
    trim: float = Field(default=0.5, ge=0.0, le=1.0, allow_inf_nan=False)
    remove_spikes: bool = True
    spike_slope: float = Field(default=3.0, gt=0.0, allow_inf_nan=False)
    across_gaps: bool = False
    detrend: Literal["linear", "mean", "none"] = "linear"
    form: int = Field(default=1, ge=0, le=8)
    upper_share: float = Field(default=1.0, gt=0.0, le=1.0, allow_inf_nan=False)
    max_lag: Length | None = None
    scales: int | None = Field(default=None, ge=1, le=24)
    smallest_wavelength: Length | None = None
    cut_off: Annotated[Any, BeforeValidator(_cut_off)] = None
    s_wavelength: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    s_amplitude: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    first_wavelength: Length | None = None
    first_amplitude: Length | None = None
    single_factor: bool = False
    smallest_lag: Length | None = None
    largest_lag: Length | None = None

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
                    f"{name} runs from {limits[0]:g} m to {limits[1]:g} m; "
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
    name: Literal["styrene_butadiene"] | None = None
    frequency_unit: Annotated[str, _unit("frequency")] | None = None
    modulus_unit: Annotated[str, _unit("modulus")] | None = None
    modulus: Literal["E", "G"] | None = None
    columns: Annotated[list[Column], Field(min_length=3, max_length=3)] | None = None
    temperature_unit: Annotated[str, _unit("temperature")] | None = None
    temperature_step: TemperatureDifference | None = None
    reference_temperature: Temperature | None = None
    shift: ShiftSource | None = None
    vertical: bool = False
    source: str = ""
    terms: int | None = Field(default=None, ge=1, le=200)
    outlier_threshold: float | None = Field(default=None, gt=0.0)
    bulk_modulus: Pressure | None = None
    extrapolate: Literal["say", "refuse"] = "say"
    strain_energy: Annotated[InstanceOf[StrainEnergy], BeforeValidator(_strain_energy)] = (
        NeoHookean()
    )

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

    pressure: Pressure = Field(description='a pressure such as "3 bar"')
    speed: Speed = Field(description='a speed such as "0.3 m/s"')
    footprint: Length = Field(description='a length such as "100 mm"')
    static: bool = True
    load_time: Annotated[Any, BeforeValidator(_load_time)] = "passage"


class Solver(Table):
    """The model of one wave and its mesh; what is not stated stays at the solver's default."""

    model: Literal["finite_strain", "half_plane"] = "finite_strain"
    columns: int | None = Field(default=None, ge=4, le=1024, multiple_of=2)
    rows: int | None = Field(default=None, ge=2, le=256)
    depth: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    element_order: Literal[1, 2] | None = None
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0, allow_inf_nan=False)
    time_limit: Duration | None = None
    points: int | None = Field(default=None, ge=16, le=8192)

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


class Output(Table):
    """Where the results go."""

    folder: str = "results"


class MeasuredTable(Table):
    """Friction measured elsewhere: a table of speed and friction, drawn over what is predicted."""

    friction: str | None = None


class Compare(Table):
    """What `gripscale compare` puts beside the models: fits of a theory."""

    layer_ratio: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    penetration_depth: Length | None = None

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
    rubber: RubberSource
    load: Load
    solver: Solver = Solver()
    chain: ChainOptions = ChainOptions()
    conditions: ConditionsTable = ConditionsTable()
    measured: MeasuredTable = MeasuredTable()
    output: Output = Output()
    compare: Compare = Compare()

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
