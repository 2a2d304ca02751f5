"""What a case file may say: its tables together; the large ones have files of their own."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field, model_validator

from gripscale import uncertainty_options as limits
from gripscale.case_file import schema
from gripscale.case_file.rubber_tables import ConditionsTable, RubberSource, StrainSweeps
from gripscale.conditions.conditions import OFF
from gripscale.core.units import in_mm, parse_quantity
from gripscale.model import LOAD_TIME, MOST_CLASSES, checked_load_time
from gripscale.rubber.strain_energy import NeoHookean
from gripscale.surface.surface import SurfaceKind
from gripscale.testers import TESTERS, TesterName
from gripscale.theory.klueppel_heinrich import KlueppelHeinrich

_CUT_OFF = 'a length, "instrument" or a table: { rms_slope = 1.3 }'


def _cut_off(value: Any) -> Any:
    """Accept a length, "instrument" or a table such as { rms_slope = 1.3, of = "surface" }."""
    from gripscale.surface.cut_off import cut_off_rule  # scipy with it: not for reading a case

    return None if value is None else cut_off_rule(value)


_STEP = 'a length such as "0.1 mm", or a list of 2, along x and y'


def _step(value: Any) -> Any:
    if value is None:
        return None
    lengths = value if isinstance(value, list | tuple) else [value]
    if len(lengths) > 2 or not lengths:
        raise ValueError(f"expected {_STEP}")
    numbers = [parse_quantity(length, "length") for length in lengths]
    if min(numbers) <= 0.0:
        raise ValueError("expected a value greater than zero")
    return numbers if isinstance(value, list | tuple) else numbers[0]


_CHANNEL = f"{schema.COLUMN}, or a list of these"


def _channel(value: Any) -> Any:
    if isinstance(value, list) and value:
        return [schema.column_key(item) for item in value]
    return None if value is None else schema.column_key(value)


class WaveTable(schema.CaseTable):
    """One sine wave stated by hand: wavelength and half peak-to-valley amplitude."""

    wavelength: schema.Length
    """Length of the wave."""
    amplitude: schema.Length
    """Half its peak-to-valley height."""


Interval = Annotated[list[schema.Position], Field(min_length=2, max_length=2)]


class SourceKeys(schema.CaseTable):
    """Where a surface comes from: profiles, a map, or waves by hand."""

    files: list[str] | None = Field(default=None, min_length=1)
    """Measured profiles of one surface; several are pooled."""
    lay: list[Literal["along", "across"]] | None = Field(default=None, min_length=1)
    """How each of files lies to the sliding direction; along by default. Profiles across it show
    whether the surface has ridges, and no more."""
    map: str | None = None
    """A measured map, in place of files."""
    spectrum: str | None = None
    """The power spectrum of a surface of which no heights are known, in place of files."""
    sines: list[WaveTable] | None = Field(default=None, min_length=1)
    """Waves stated by hand, in place of files; longest first."""
    kind: SurfaceKind = "surface"
    """What the surface is called in titles."""

    @property
    def measured_files(self) -> list[str]:
        """Names of the files it was measured in."""
        return [single] if (single := self.map or self.spectrum) else self.files or []


class SpectrumKeys(schema.CaseTable):
    """What a file of a spectrum does not state."""

    wavenumber_unit: str | None = None
    """Unit of its wavenumbers or wavelengths, such as 1/um, cycles/m or mm."""
    density_unit: str | None = None
    """Unit of its density: such as um^4 of a surface, um^3 of a line."""
    normalization: Literal["q", "1/wavelength", "contact.engineering"] | None = None
    """What its density is: over q, over 1/wavelength, or that of contact.engineering."""
    phases: Literal["real", "worn", "random"] = "real"
    """Phases of its waves: of any surface, of one with worn tops as most roads, or random."""


class UnitKeys(schema.CaseTable):
    """What a file of heights does not state."""

    x_unit: Annotated[str, schema.unit_of_file("length")] | None = None
    """Unit of distances where the file does not name it."""
    z_unit: Annotated[str, schema.unit_of_file("length")] | None = None
    """Unit of heights where the file does not name it."""
    direction: Literal["x", "y"] = "x"
    """The way of sliding in a map."""
    step: Annotated[Any, schema.Reading(_STEP, _step, quantity="length")] = None
    """Distance between points, or those of a map along x and y, where the file has none."""


class ReadingKeys(UnitKeys):
    """How the files of a surface are read."""

    z_axis: Literal["up", "down"] | None = None
    """Which way the numbers of heights count: down turns depths over; by default up."""
    reader: Literal["auto", "text", "instrument"] = "auto"
    """How to read the files; auto goes by the suffix."""
    channel: Annotated[Any, schema.Reading(_CHANNEL, _channel)] = None
    """Channel of an instrument's file, or column of a text, that has several of heights; of a list
    of columns each is a profile of the surface."""
    sheet: schema.ColumnKey | None = None
    """Sheet of an Excel file, where several hold numbers."""
    reliable: schema.Length | None = None
    """Shortest wavelength the instrument measures reliably, where the file does not tell."""
    assumed: list[str] | None = None
    """What `gripscale new` proposed because no file states it, each a doubt of the answer."""


class CleaningKeys(schema.CaseTable):
    """What is taken out of the heights of a surface."""

    clean: bool = True
    """Clean the heights; false takes them as they are."""
    crop: Interval | None = None
    """First and last distance to keep along x; all by default."""
    crop_across: Interval | None = None
    """The same along y, of a map."""
    valid_range: Interval | None = None
    """Lowest and highest height to believe; others become missing."""
    trim: float = Field(default=0.5, ge=0.0, le=1.0, allow_inf_nan=False)
    """Share of missing heights above which a border line of a map is cut off."""
    spikes: Annotated[
        Literal["isolated", "iso13473", "none"] | None,
        AfterValidator(lambda rule: None if rule == "none" else rule),
    ] = "isolated"
    """Rule by which spikes become missing: runs of up to three samples that go out and back, or
    every steep step of a profile (ISO 13473-1)."""
    spike_slope: float = Field(default=3.0, gt=0.0, allow_inf_nan=False)
    """Change of height per step at which a spike stands off, or a step is steep."""
    detrend: Literal["linear", "mean", "none"] = "linear"
    """Trend subtracted from a profile."""
    longest_wavelength: schema.Length | None = None
    """Longest wave kept in profiles. By default 1.5 footprints, where longer waves hold most of the
    mean square height, else all; a length beyond the profiles keeps all."""
    form: int = Field(default=1, ge=0, le=8)
    """Order of the polynomial subtracted from a map: 0 the mean, 1 a plane, 2 a paraboloid."""

    @model_validator(mode="after")
    def _possible_cleaning(self) -> CleaningKeys:
        for name in ("crop", "crop_across", "valid_range"):
            ends = getattr(self, name)
            if ends is not None and ends[0] >= ends[1]:
                raise ValueError(
                    f"{name} runs from {in_mm(ends[0])} to {in_mm(ends[1])}; "
                    "expected its start before its end"
                )
        steps = self.model_fields_set & CleaningKeys.model_fields.keys() - {"clean"}
        if steps and not self.clean:
            raise ValueError(f"{min(steps)} cleans the heights; expected clean = true with it")
        return self


class WaveKeys(schema.CaseTable):
    """How sine waves follow the correlation of a surface."""

    top_height_fraction: float = Field(default=1.0, gt=0.0, le=1.0, allow_inf_nan=False)
    """Share of the heights, from the highest down, that counts in the correlation."""
    max_lag: schema.Length | None = None
    """Largest lag of the correlation; a quarter of the shortest profile by default."""
    scales: int | None = Field(default=None, ge=1, le=24)
    """Number of waves."""
    smallest_wavelength: schema.Length | None = None
    """Wavelength of the last wave."""
    cut_off: Annotated[Any, schema.Reading(_CUT_OFF, _cut_off)] = None
    """Where the roughness ends, in place of smallest_wavelength."""
    s_wavelength: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    """Factor from one wavelength to the next, if given instead of fitted."""
    s_amplitude: float | None = Field(default=None, gt=1.0, allow_inf_nan=False)
    """Factor from one amplitude to the next, if given instead of fitted."""
    first_wavelength: schema.Length | None = None
    """The first wavelength, if given instead of fitted."""
    first_amplitude: schema.Length | None = None
    """The first amplitude, if given instead of fitted."""
    single_factor: bool = False
    """One factor for wavelength and amplitude, which Lind and Wangenheim show to fail."""
    smallest_lag: schema.Length | None = None
    """Smallest lag that counts in the fit."""
    largest_lag: schema.Length | None = None
    """Largest lag that counts in the fit."""

    @model_validator(mode="after")
    def _one_end(self) -> WaveKeys:
        if self.smallest_wavelength is not None and self.cut_off is not None:
            raise ValueError(
                "expected either smallest_wavelength (the last wave) or cut_off (where the "
                "roughness ends)"
            )
        return self


class SurfaceTable(WaveKeys, CleaningKeys, ReadingKeys, SpectrumKeys, SourceKeys):
    """Measured profiles or a map and how they become sine waves, or the waves themselves.

    Waves by hand may stand with keys of a measured surface: other surfaces are read with these.
    """

    @model_validator(mode="after")
    def _one_source(self) -> SurfaceTable:
        sources = (self.files, self.map, self.spectrum, self.sines)
        if sum(source is not None for source in sources) != 1:
            raise ValueError(
                "expected either files (measured profiles), map (a measured map), spectrum (of a "
                "surface without heights) or sines (waves by hand)"
            )
        of_heights = {*CleaningKeys.model_fields, *ReadingKeys.model_fields, "top_height_fraction"}
        of_heights = (of_heights | {"max_lag"}) - {"longest_wavelength"}
        keys = set(SpectrumKeys.model_fields) if self.spectrum is None else of_heights
        if self.sines is None and (others := self.model_fields_set & keys - {"assumed"}):
            source = "heights" if self.spectrum is not None else "spectrum"
            raise ValueError(f"{min(others)} belongs to a surface from {source}")
        if self.sines is not None:
            if self.cut_off is not None:
                raise ValueError("cut_off belongs to a measured surface, not to waves by hand")
            lengths = [wave.wavelength for wave in self.sines]
            if any(b >= a for a, b in pairwise(lengths)):
                raise ValueError("expected sines in order of falling wavelength")
        elif self.scales is None and self.smallest_wavelength is None and self.cut_off is None:
            raise ValueError(
                "expected scales (number of waves), smallest_wavelength or cut_off (where they "
                "end), or both"
            )
        if self.lay is not None and len(self.lay) != len(self.files or ()):
            raise ValueError(f"expected lay for each of files, {len(self.files or ())}")
        foreign, owner = (
            (("crop_across", "trim", "form"), "map")
            if self.map is None
            else (("detrend", "longest_wavelength", "sheet"), "files")
        )
        for name in foreign:
            if getattr(self, name) != type(self).model_fields[name].default:
                raise ValueError(f"{name} belongs to a surface from {owner}")
        if self.map is None and isinstance(self.step, list):
            raise ValueError("step of a profile is one length; two are those of a map")
        return self


class LoadTable(schema.CaseTable):
    """How hard, how fast and over what length the rubber is pressed and slid."""

    gone: ClassVar[Mapping[str, str]] = {"static": "speed = 0 solves the relaxed rubber at rest"}

    pressure: schema.Pressure
    """Nominal pressure."""
    speed: schema.Speed
    """Sliding speed; 0 is the relaxed rubber at rest."""
    footprint: schema.Length
    """Length of the nominal contact: how long the largest wave is loaded."""
    load_time: Annotated[
        Any, schema.Reading(LOAD_TIME, partial(checked_load_time, "load_time"))
    ] = "passage"
    """How long a wave is loaded: while the contact above it passes, for ever, or a time."""
    tester: TesterName | None = None
    """A tester, whose pressure, speed and footprint then need not be stated."""

    @model_validator(mode="before")
    @classmethod
    def _of_tester(cls, values: Any) -> Any:
        preset = TESTERS.get(str(values.get("tester"))) if isinstance(values, dict) else None
        keys = ("pressure", "speed", "footprint")
        return values if preset is None else {k: getattr(preset, k) for k in keys} | values


class SolverTable(schema.CaseTable):
    """The model of one wave and its mesh; what is not stated stays at the solver's default."""

    model: Literal["finite_strain", "half_plane"] = "finite_strain"
    """What solves a wave: the block at finite strain or the half-plane at small strain."""
    columns: int | None = Field(default=None, ge=4, le=4096, multiple_of=2)
    """Elements along the block, doubled where the two frictions differ."""
    rows: int | None = Field(default=None, ge=2, le=256)
    """Elements across the block."""
    depth: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    """Height of the block over the wavelength."""
    element_order: Literal[1, 2] | None = None
    """Order of the elements."""
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0, allow_inf_nan=False)
    """The mesh is refined until the estimated errors are below this."""
    time_limit: schema.Duration | None = None
    """A wave that takes longer is given up."""
    points: int | None = Field(default=None, ge=16, le=8192)
    """Points of the half-plane."""

    @model_validator(mode="after")
    def _options_of_the_model(self) -> SolverTable:
        mesh = ["columns", "rows", "depth", "element_order", "tolerance", "time_limit"]
        foreign = ["points"] if self.model == "finite_strain" else mesh
        for name in foreign:
            if getattr(self, name) is not None:
                raise ValueError(f'{name} is not an option of model = "{self.model}"')
        return self

    def options(self) -> dict[str, Any]:
        """Return the stated options as keyword arguments of the solver."""
        return self.model_dump(exclude={"model"}, exclude_none=True)


class ChainOptions(schema.CaseTable):
    """What goes on from wave to wave."""

    pressure_classes: int = Field(default=1, ge=1, le=MOST_CLASSES)
    """Classes of equal load in which the pressure is handed down; 1: its mean."""


# What may be taken to be uncertain.
SourceName = Literal[
    "height_noise",
    "cleaning",
    "profile",
    "grid",
    "modulus",
    "bulk_modulus",
    "equilibrium_modulus",
    "temperature",
    "pressure",
    "load_time",
    "cut_off",
    "waves",
]


def _rising(values: list[float]) -> list[float]:
    if any(b <= a for a, b in pairwise(values)):
        raise ValueError("expected rising values")
    return values


def _in_words(ends: dict[str, Any]) -> None:
    each = schema.expected(ends["items"])
    ends["expected"] = f"a list of two ends or of equally likely values, each {each}"


Ends = (Field(min_length=1, json_schema_extra=_in_words), AfterValidator(_rising))
Moduli = Annotated[list[schema.Pressure], *Ends]
Lengths = Annotated[list[schema.Length], *Ends]
Factors = Annotated[list[Annotated[float, Field(gt=0.0, allow_inf_nan=False)]], *Ends]


def _pressure_error(value: Any) -> Any:
    """Accept what `pressure_error` does, as it is written: the pressure is in another table."""
    limits.pressure_error(value, 1.0)
    return value


class RangesTable(schema.CaseTable):
    """What is known of a source: two ends, equally likely values, or a standard error."""

    height_noise: schema.Length | None = None
    """Standard error of each measured height, independent of its neighbours; none by default."""
    cleaning: Factors | None = None
    """Change of height per step that is a spike; by default half to 3.3 times that of the case."""
    bulk_modulus: Moduli | None = None
    """Bulk modulus of the rubber; by default 1.5 times less to 1.5 times more."""
    equilibrium_modulus: Moduli | None = None
    """Modulus of the rubber after infinite time; not sampled by default."""
    temperature: schema.TemperatureDifference | None = None
    """Standard error of the temperature before the contact; none by default."""
    pressure: Annotated[Any, schema.Reading(limits.PRESSURE_ERROR, _pressure_error)] = None
    """Standard error of the nominal pressure, a share of it or a pressure; none by default."""
    load_time: Factors | None = None
    """How long waves are loaded, over the time of the case; by default 0.5 to 2."""
    cut_off: Lengths | None = None
    """Where the roughness ends; by default an octave about that of the case."""
    waves: Annotated[list[int], Field(min_length=1)] | None = None
    """Numbers of sine waves, among those that follow the correlation; all of these by default."""


class UncertaintyTable(schema.CaseTable):
    """What `gripscale uncertainty` samples; its options go before what is stated here."""

    samples: int = Field(default=limits.SAMPLES, ge=limits.FEWEST_SAMPLES, le=limits.MOST_SAMPLES)
    """Samples of all that is not known at once."""
    seed: int = Field(default=0, ge=0, le=limits.MOST_SEED)
    """Seed of the random numbers."""
    model: Literal["chain", "direct", "both"] | None = None
    """What predicts each sample; direct where profiles were measured by default, else the chain."""
    without: list[SourceName] = Field(default=[])
    """Sources that are taken to be known."""
    ranges: RangesTable = RangesTable()
    """What is known of a source, in place of its default."""
    block_length: schema.Length | None = None
    """Length of the blocks of profiles that are drawn; four of the largest waves by default."""
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0)
    """Estimated relative error of each direct contact; that of its first full grid by default."""


FigureKind = Literal["png", "pdf", "svg"]


class OutputTable(schema.CaseTable):
    """Where the results go."""

    folder: str = "results"
    """Folder of the results, from the case file."""
    figures: list[FigureKind] | None = Field(default=None, min_length=1)
    """What each figure is written as: by default png, and no files of a run, whose page has all."""


class MeasuredTable(schema.CaseTable):
    """Friction measured elsewhere: a table of speed and friction, drawn over what is predicted."""

    friction: str | None = None
    """A table of speed and friction, drawn over what is predicted."""


class FinerTable(UnitKeys):
    """A finer measurement of a face of a stone: a line or a map, with its units."""

    file: str | None = None
    """A measured line."""
    map: str | None = None
    """A measured map, in place of file."""

    @model_validator(mode="after")
    def _one_source(self) -> FinerTable:
        if (self.file is None) == (self.map is None):
            raise ValueError("expected either file (a measured line) or map (a measured map)")
        return self


class BelowMeasurementTable(schema.CaseTable):
    """Roughness below the measured profiles; without down_to there is none."""

    down_to: schema.Length | None = None
    """Shortest wavelength to continue the roughness to."""
    hurst: float | None = Field(default=None, gt=0.0, le=1.0, allow_inf_nan=False)
    """Hurst exponent of the continued roughness; by default it is that of the faces that touch."""
    finer: FinerTable | None = None
    """A finer measurement of a face, in place of the faces of the profiles."""
    seed: int = Field(default=0, ge=0, le=limits.MOST_SEED)
    """Seed of the random waves."""

    @model_validator(mode="after")
    def _one_source(self) -> BelowMeasurementTable:
        if self.hurst is not None and self.finer is not None:
            raise ValueError("expected either hurst (a power law) or finer (a measurement)")
        return self


class CaseTables(schema.CaseTable):
    """A whole case file."""

    surface: SurfaceTable
    """What is slid on."""
    rubber: RubberSource
    """What slides."""
    load: LoadTable
    """How it is pressed and slid."""
    solver: SolverTable = SolverTable()
    """What solves one wave."""
    chain: ChainOptions = ChainOptions()
    """What goes on from wave to wave."""
    conditions: ConditionsTable = ConditionsTable()
    """Effects beside the rubber as measured."""
    below_measurement: BelowMeasurementTable = BelowMeasurementTable()
    """Roughness below the measurement."""
    measured: MeasuredTable = MeasuredTable()
    """Friction measured elsewhere."""
    output: OutputTable = OutputTable()
    """Where results go."""
    compare: Annotated[Any, schema.stated_law(KlueppelHeinrich)] = None
    """What `gripscale compare` puts beside the models: fits of Klueppel and Heinrich's theory."""
    uncertainty: UncertaintyTable = UncertaintyTable()
    """What is not known of all that."""

    @model_validator(mode="after")
    def _with_an_effect(self) -> CaseTables:
        if self.solver.model == "half_plane" and self.rubber.strain_energy != NeoHookean():
            raise ValueError(
                "strain_energy of [rubber] has no effect at small strain; expected "
                'model = "finite_strain" with it'
            )
        law = self.conditions.softening
        softens = self.rubber.filled if law is None else law != OFF
        if self.conditions.strain_norm is not None and not softens:
            raise ValueError("strain_norm belongs to softening, which is not asked for")
        return self

    def named_files(self) -> list[tuple[str, str]]:
        """Return role and name of every file it names."""
        finer, softening = self.below_measurement.finer, self.conditions.softening
        roles: dict[str, list[Any]] = {
            "surface": self.surface.measured_files,
            "below_measurement": [finer and finer.file, finer and finer.map],
            "rubber": [*self.rubber.measured_files, self.rubber.shift],
            "conditions": softening.files if isinstance(softening, StrainSweeps) else [],
            "measured": [self.measured.friction],
        }
        return [(role, f) for role, names in roles.items() for f in names if isinstance(f, str)]
