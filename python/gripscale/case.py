"""A case: a surface, a rubber, a load and conditions, about which every question is asked.

    case = gs.Case(profiles, rubber, pressure="3 bar", speed=0.3, smallest_wavelength="0.1 mm")
    gs.answer(case)

`gripscale.read_case` makes the same object from a case file.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.chain.chain import Chain
from gripscale.conditions.conditions import DRY, Conditions, Interface, with_defaults
from gripscale.continuation.curve import DOWN_TO, ContinuedContact
from gripscale.continuation.roughness import HurstExponent, OwnFaces, Roughness
from gripscale.core import CaseKey, Described, GripscaleError, InputError, Quantity, checks
from gripscale.core.arrays import Array
from gripscale.core.finding import FILLED, Finding, Severity, Topic, doubt
from gripscale.core.provenance import CASE_TITLE, COMMAND, version_attributes
from gripscale.core.units import (
    DISPLAY_UNITS,
    DisplayUnit,
    display_unit,
    in_mm,
    si_value,
    stated_units,
)
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.experiment.task import Task, content_hash
from gripscale.model import FOOTPRINT, Load, LoadTime, Model, load_doubts
from gripscale.rubber import MasterCurve, Rubber, fit_prony_report, temperature_doubts
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.surface.cleaning import clean
from gripscale.surface.cut_off import CutOffRule, find_cut_off
from gripscale.surface.height_difference import fit_self_affine, height_difference
from gripscale.surface.low_pass import longest_held
from gripscale.surface.profile import HeightMap, Profile
from gripscale.surface.random_phases import PHASES_OF, Spectrum
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.sines import SineStack
from gripscale.surface.surface import SURFACE_KIND, SURFACE_KINDS, Measured, Surface, SurfaceKind
from gripscale.testers import TESTER, TESTERS, tester_findings
from gripscale.theory.klueppel_heinrich import KlueppelHeinrich

SHEAR_STRESS = "shear_stress"  # attribute of a result: kind of the law of its area term
SurfaceLike = Surface | Profile | Sequence[Profile] | HeightMap | Spectrum | SineStack
# Arguments of `gripscale.clean` where a case states none.
_CLEANED_AS_USUAL: dict[str, Any] = clean.__kwdefaults__ or {}
_WAVES = 8  # sine waves of a surface: an octave each, from centimetres to a tenth of a millimetre
RubberLike = Rubber | MasterCurve | MeasuredRubber


@dataclass(frozen=True)
class NamedFile:
    """A file that a case names, with its checksum."""

    role: str  # table of the case that names it
    name: str
    size: int  # [bytes]
    sha256: str


@dataclass(frozen=True)
class Origin:
    """Where a case was read from; of a case made in Python everything is empty."""

    name: str = ""  # path of the case file, as it was given
    text: str = ""  # the case file, word for word
    # Units that the case states, by key, in which results are shown.
    units: Mapping[str, str] = field(default_factory=dict)
    files: Sequence[NamedFile] = ()
    assumed: Sequence[str] = ()  # what no file states and `gripscale new` proposed


@dataclass(frozen=True)
class BelowMeasurement:
    """Roughness below the measurement."""

    down_to: float | None = None
    """Shortest wavelength that the answer continues the roughness to [m]; without it the answer
    ends where the measurement or the cut-off does."""
    roughness: Roughness = field(default_factory=OwnFaces)
    """What the roughness continues as."""
    seed: int = 0
    """Seed of the random waves."""


class Case(Described):
    """A surface, a rubber, a load and conditions: all that a question needs.

    Raises `InputError` if a value cannot be used, no waves fit the surface, or the rubber has no
    shift to the temperature of the conditions.

        >>> gs.Case(road, rubber, pressure="3 bar", speed="3 km/h").load.pressure
        300000.0

    Parameters
    ----------
    surface : Profile, sequence of Profile, HeightMap, Spectrum, SineStack or Surface
        Measured heights, their spectrum, or sine waves. Heights are taken as they are, unless
        `cleaning` is given.
    rubber : Rubber, MasterCurve or MeasuredRubber
        A master curve is fitted by a Prony series, each row with its weight for friction and area
        of this case. A `Rubber` is taken as it is.
    pressure : float or str
        Nominal pressure [Pa], or a text with its unit such as "3 bar".
    speed : float or str
        Sliding speed [m/s]; zero is the relaxed rubber at rest.
    footprint : float or str, optional
        Length of the nominal contact [m]; 0.1 m by default.
    tester : str, optional
        A tester of skid resistance, one of `gripscale.testers.TESTERS`: its pressure, speed and
        footprint stand where none is given, and the answer has its number.
    thickness : float or str, optional
        Thickness of the rubber on a rigid base [m]; without it the rubber has no end.
    smallest_wavelength : float or str, optional
        Shortest wave of the roughness that counts [m]; by default the shortest one measured.
    longest_wavelength : float or str, optional
        Longest wave that presses into the block [m]; longer ones are taken out of the profiles. By
        default 1.5 footprints, where longer waves hold most of the mean square height; a length
        beyond the profiles keeps all.
    kind : str
        What the surface is called in titles, one of `SURFACE_KINDS`.
    waves : int
        Number of sine waves that are fitted to measured heights.
    conditions : Conditions, optional
        Temperature, softening, heat, area term and water. What they leave open has defaults: a
        rubber with a temperature shift warms by its friction, `Conditions(heat="none")` does not.
    filled : bool, optional
        Whether the rubber is filled (carbon black, silica), as every tread is. A filled rubber
        without softening of its own softens as a typical tread; `Conditions(softening="none")`
        asks for its moduli at small strain. None: not known, and an answer says both numbers.
    interface : "dry", optional
        A dry road: the real contact area is sheared at the stress of typical treads, unless the
        conditions state one. None: friction of the hysteresis alone.
    water : bool, float or str, optional
        Water of the conditions: True floods a map, a thickness [m] is a film. The direct contact
        then has trapped water (`gripscale.solve_rough_contact`).
    load_time : float or "passage"
        How long a wave is loaded [s]: while the contact above it passes, or a time.
    chain : Chain, optional
        Solver and pressure classes of the chain of waves; its conditions are those of the case.
    below_measurement : BelowMeasurement, optional
        Roughness below the measurement.
    klueppel_heinrich : KlueppelHeinrich, optional
        Fitted parameters of that theory, for comparisons.
    friction : MeasuredFriction, optional
        Friction measured elsewhere.
    cleaning : mapping, optional
        Arguments of `gripscale.clean`, by which profiles as measured are cleaned; an empty mapping
        cleans them as usual. What cleaning may change counts in `gripscale.uncertainty`.
    options : mapping, optional
        Options of questions that the case states, by question.
    origin : Origin, optional
        Where the case was read from.
    """

    def __init__(
        self,
        surface: SurfaceLike,
        rubber: RubberLike,
        *,
        pressure: Quantity | None = None,
        speed: Quantity | None = None,
        footprint: Quantity | None = None,
        tester: str | None = None,
        thickness: Quantity | None = None,
        smallest_wavelength: Quantity | None = None,
        longest_wavelength: Quantity | None = None,
        kind: SurfaceKind = "surface",
        waves: int = _WAVES,
        conditions: Conditions | None = None,
        filled: bool | None = None,
        interface: Interface | None = None,
        water: bool | Quantity | None = None,
        load_time: LoadTime = "passage",
        chain: Chain | None = None,
        below_measurement: BelowMeasurement | None = None,
        klueppel_heinrich: KlueppelHeinrich | None = None,
        friction: MeasuredFriction | None = None,
        cleaning: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        origin: Origin | None = None,
    ) -> None:
        arguments = {name: value for name, value in locals().items() if name != "self"}
        self.kind = checks.one_of("kind", kind, SURFACE_KINDS)
        self.tester = "" if tester is None else checks.one_of("tester", tester, TESTERS)
        preset = TESTERS.get(self.tester)
        if preset is None and (pressure is None or speed is None):
            missing = "pressure" if pressure is None else "speed"
            raise InputError(" must be given, or tester; got neither", key=missing)
        chosen = {"pressure": pressure, "speed": speed, "footprint": footprint}
        tables = {"load": chosen, "rubber": {"thickness": thickness}}
        tables["surface"] = {"smallest_wavelength": smallest_wavelength}
        self.origin = origin or Origin(units=stated_units(tables))
        values: dict[str, Any] = {
            name: getattr(preset, name, FOOTPRINT) if value is None else value
            for name, value in chosen.items()
        }
        self.load = Load(**values, load_time=load_time, thickness=thickness)
        if isinstance(rubber, Rubber):
            rubber = MeasuredRubber(rubber, rubber.source)
        elif not isinstance(rubber, MeasuredRubber):
            fitted, fit = fit_prony_report(rubber)
            rubber = MeasuredRubber(fitted, rubber.source, rubber, fit)
        self.measured_rubber = rubber
        if water is not None:
            conditions = replace(conditions or Conditions(), water=water)
        self.filled = filled if filled is None else checks.flag("filled", filled)
        """Whether the rubber is filled; None: not known."""
        self.stated_conditions = conditions
        """Conditions as they were stated, without what a case has by default."""
        if interface is not None:
            checks.one_of("interface", interface, DRY)
        self.interface = interface
        """"dry", or None: friction of the hysteresis alone."""
        conditions = with_defaults(
            conditions, rubber.rubber, filled=filled, interface=interface, kind=kind
        )
        self.conditions = conditions
        """What changes the rubber or the contact, with all defaults; None where nothing does."""
        self.chain = replace(chain or Chain(), conditions=conditions and conditions.dry)
        self._arguments = arguments
        end = si_value("smallest_wavelength", smallest_wavelength, "m")
        self.cleaning = {} if cleaning is None else _CLEANED_AS_USUAL | dict(cleaning)
        longest = si_value("longest_wavelength", longest_wavelength, "m")
        self.surface = _surface(surface, end, waves, self.cleaning, longest, self.load.footprint)
        measured = self.surface.measured
        if self.cleaning and measured is not None:
            self.cleaning["longest_wavelength"] = measured.longest
        self.below_measurement = below_measurement or BelowMeasurement()
        self.klueppel_heinrich = klueppel_heinrich
        self.friction = friction
        self.options = dict(options or {})
        if conditions is not None and conditions.water and (measured is None or not measured.map):
            raise InputError(
                "water needs a map: what closes a pool lies beside a line; got "
                f"{self.surface.source or 'a surface without one'}"
            )
        _ = self.rubber_before  # refuses a temperature without a shift
        self.measured_rubber = fitted_for_load(rubber, self.surface, self.load, conditions)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield surface, rubber, load and conditions."""
        yield self.kind, self.surface.source or "unnamed"
        yield "rubber", self.rubber.name or "unnamed"
        for key in ("pressure", "speed", "footprint", "thickness"):
            if getattr(self.load, key) is not None:
                yield key, self.display_unit(key).text(getattr(self.load, key), 4)
        waves = self.surface.sines.wavelength
        yield "waves", f"{waves.size} from {in_mm(waves[0], 4)} to {in_mm(waves[-1], 4)}"
        if self.conditions is not None:
            yield "conditions", ", ".join(f"{k}={v}" for k, v in self.conditions.shown_rows())

    def replace(self, **changes: Any) -> Case:
        """Return the case with other arguments; the surface is not described again.

            >>> case.replace(pressure="1 bar").load.pressure
            100000.0

        Raises `InputError` if a value cannot be used or no argument has its name.
        """
        checks.allowed_names("argument of a case", changes, self._arguments)
        kept: dict[str, Any] = {"rubber": self.measured_rubber, "chain": self.chain}
        described = {"smallest_wavelength", "longest_wavelength", "waves", "cleaning"}
        if "surface" not in changes:
            if not described & changes.keys():
                kept["surface"] = self.surface
            elif isinstance(self._arguments["surface"], Surface):
                kept["surface"] = self._described_again(changes)
        # the text of a file is that of another case
        kept["origin"] = Origin(self.origin.name, units=self.origin.units)
        return Case(**(self._arguments | kept | changes))

    def _described_again(self, changes: Mapping[str, Any]) -> Surface:
        """Return the surface of a case file, which holds its waves, with other ones."""
        surface, measured = self.surface, self.surface.measured
        if "cleaning" in changes:
            raise InputError("cleaning must be left out: the surface is clean already; got it")
        if "longest_wavelength" in changes:
            if measured is None or measured.map is not None:
                raise InputError(f"longest_wavelength needs profiles; got {surface.source}")
            longest = si_value("longest_wavelength", changes["longest_wavelength"], "m")
            lines = [raw for raw, _ in (*measured.profiles, *measured.across)]
            options = self.cleaning and self.cleaning | {"longest_wavelength": None}
            held = changes.get("footprint", self.load.footprint)
            surface = described_surface(
                _measured(lines, options, longest),
                counted=surface.counted,
                fit=surface.fit,
                cut_off=surface.rule,
                source=surface.source,
                footprint=si_value("footprint", held, "m") if longest is None else None,
            )
        end = si_value("smallest_wavelength", changes.get("smallest_wavelength"), "m")
        return surface.varied(waves=changes.get("waves"), smallest_wavelength=end)

    def task(self, model: Model | None = None) -> Task:
        """Return how the case is predicted: by a model as it stands, or by its chain of waves."""
        return Task(self.rubber, self.surface, self.load, self.chain if model is None else model)

    @property
    def softening_doubts(self) -> Sequence[Finding]:
        """That it is not known whether the rubber softens: nothing states that it is filled."""
        effects = self.stated_conditions or Conditions()
        answered = effects.softening is not None or "softening" in effects.off or effects.water
        if self.filled is not None or answered:
            return ()
        text = (
            "Whether the rubber is filled (carbon black, silica) is not stated: filled rubber, as "
            "of every tread, softens under strain and has several times the contact area. State "
        )
        asked = doubt(text, CaseKey("filled"), " in [rubber].", topic=Topic.RUBBER)
        return (replace(asked, key=FILLED),)

    @property
    def rubber(self) -> Rubber:
        """The rubber at the temperature of its master curve."""
        return self.measured_rubber.rubber

    @property
    def rubber_before(self) -> Rubber:
        """The rubber at the temperature before the contact."""
        return self.rubber if self.conditions is None else self.conditions.before(self.rubber)

    @property
    def name(self) -> str:
        """Path of the case file, or what stands for it."""
        return self.origin.name or "a case made in Python"

    @property
    def title(self) -> str:
        """Rubber and surface in words, such as "tread on motorway"."""
        measured, count = self.surface.measured, len(self.surface.sines)
        surface = f"{count} sine {'wave' if count == 1 else 'waves'}"
        if measured is not None:
            lines = [raw.name for raw, _ in measured.profiles]
            surface = lines[0] if measured.map is None else measured.map.name
            surface += f" and {len(lines) - 1} more" if measured.map is None and lines[1:] else ""
        kind = "" if self.kind == "surface" else f"the {self.kind} "
        return f"{self.rubber.name or 'a rubber'} on {kind}{surface or 'a surface'}"

    @property
    def units(self) -> Mapping[str, str]:
        """Units that the case states, by key."""
        return self.origin.units

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of every result: the case file and its units, the command, versions."""
        law = None if self.conditions is None else self.conditions.shear_stress
        spectrum = self.surface.spectrum
        optional = {
            "command": COMMAND.get(),
            TESTER: self.tester,
            SHEAR_STRESS: "" if law is None else law.kind,
            PHASES_OF: "" if spectrum is None else spectrum.phases,
            SURFACE_KIND: self.kind if self.kind != "surface" else "",
        }
        text = {"case": self.origin.text, "case_file": self.origin.name, CASE_TITLE: self.title}
        text[DISPLAY_UNITS] = json.dumps(self.units)
        return text | {k: v for k, v in optional.items() if v} | version_attributes()

    @cached_property
    def key(self) -> str:
        """Hash of everything that an answer depends on, but for the software."""
        parts = [self.surface, self.measured_rubber, self.load, self.chain, self.filled]
        parts += [] if self.conditions is None else [self.conditions.water]
        return content_hash([*parts, self.below_measurement, self.klueppel_heinrich, self.cleaning])

    def save(self, path: str | Path) -> Path:
        """Write the case as a case file, its measurements in the folder `inputs`; return its path.

        The case that `gripscale.read_case` reads from it, there or wherever both go, has the same
        answers. A case that was read from a file keeps its text and gets copies of its files; any
        other is written in SI units, profiles, maps and moduli as text files. The `path` is such as
        "folder/case.toml"; an earlier file is replaced.

        Raises `InputError` for what a case file cannot state, such as a solver of your own. Raises
        `FileError` if a file cannot be written, or one of the case has changed since it was read.
        """
        from gripscale.case_file.save import write_case

        return write_case(self, Path(path))

    def display_unit(self, name: str) -> DisplayUnit:
        """Return how `pressure`, `speed` or `footprint` is shown: as the case gives it."""
        return display_unit(name, self.units)

    def continuation(
        self, *, down_to: float | None = None, hurst: float | None = None
    ) -> ContinuedContact:
        """Return the direct contact with the roughness below the measurement.

        `down_to` is the shortest wavelength [m], that of the case by default, else 10 um; `hurst`
        the exponent of the roughness [-], in place of what the case states.
        """
        below = self.below_measurement
        return ContinuedContact(
            conditions=self.conditions,
            down_to=down_to or below.down_to or DOWN_TO,
            roughness=below.roughness if hurst is None else HurstExponent(hurst),
            seed=below.seed,
        )

    def findings(
        self,
        surfaces: Iterable[Surface] | None = None,
        loads: Iterable[Load] | None = None,
        *,
        extrapolated: bool = True,
    ) -> list[Finding]:
        """Return what is doubtful about load, rubber, conditions and surface.

        Those of `surfaces` and `loads` count for an answer on others than those of the case;
        without `extrapolated` nothing of roughness that the measurement does not carry.
        """
        surface = self.surface
        others = surface.doubts if extrapolated else (*surface.doubts, *surface.extrapolated)
        findings = self.doubts(surfaces, loads)

        def warn(text: str, topic: Topic = Topic.RUBBER) -> None:
            findings.append(Finding(Severity.WARNING, text, topic=topic))

        if self.conditions is not None and self.conditions.temperature is not None:
            for text in temperature_doubts({self.rubber.name or "rubber": self.rubber_before}):
                warn(f"{text[0].upper()}{text[1:]}.")
        findings += tester_findings(self.tester, self.rubber.name)
        fit = self.measured_rubber.fit
        if fit is not None and fit.findings:
            opening, rest = fit.findings[:2], len(fit.findings) - 2
            more = [f"{rest} more (`gripscale fit-rubber` lists them)"] if rest > 0 else []
            warn(f"Rubber, doubts of its measurement and series: {'; '.join([*opening, *more])}.")
        findings += [f.about("Surface") for f in surface.findings if f not in others]
        if self.load.thickness is not None:
            warn(
                "The thickness of the rubber does not count in the theory of Klüppel and Heinrich, "
                "in heat and in softening, and the step from lines to a surface is that of rubber "
                "without end."
            )
        if surface.measured is not None and surface.measured.no_self_affine:
            why = surface.measured.no_self_affine
            warn(f"The surface was not described as self-affine: {why}", Topic.SURFACE)
        return findings

    def doubts(
        self, surfaces: Iterable[Surface] | None = None, loads: Iterable[Load] | None = None
    ) -> list[Finding]:
        """Return why the answer may be that of another road, rubber or load; as `findings`."""
        roads = [self.surface] if surfaces is None else surfaces
        doubts = [Finding(Severity.DOUBT, text) for text in self.origin.assumed]
        doubts += [*(d for road in roads for d in road.doubts), *self.measured_rubber.doubts]
        doubts += self.softening_doubts
        doubts += load_doubts([self.load] if loads is None else loads, self.units)
        doubts = list(dict.fromkeys(doubts))
        if self.rubber.reference_temperature is None:
            text = (
                "Neither the file of the rubber nor the case states the temperature of its moduli: "
                "state "
            )
            key = CaseKey("reference_temperature")
            doubts.append(doubt(text, key, " in [rubber].", topic=Topic.RUBBER))
        footprint, largest = self.load.footprint, float(self.surface.sines.wavelength[0])
        if footprint < largest:
            length_unit = self.display_unit("footprint")
            lengths = [length_unit.text(length, 3) for length in (footprint, largest)]
            text = (
                "The footprint, {}, is shorter than the largest wave, {}, which it cannot hold "
                "once: is its unit right? If so, leave such waves out."
            )
            doubts.append(doubt(text.format(*lengths), topic=Topic.LOAD))
        return doubts


def fitted_for_load(
    measured: MeasuredRubber, surface: Surface, load: Load, conditions: Conditions | None
) -> MeasuredRubber:
    """Return a rubber with its series, if it has one of a fit, fitted for waves under a load."""
    if measured.fit is None:  # the waves of a surface are fitted when they are first asked for
        return measured
    omega = excitation(measured.rubber, surface, load, conditions)
    return measured.fitted_for(omega, surface.sines.slope)


def excitation(
    rubber: Rubber, surface: Surface, load: Load, conditions: Conditions | None
) -> Array:
    """Return the angular frequencies of waves [rad/s], shifted to the temperature of a rubber."""
    shift, kelvin = 1.0, None if conditions is None else conditions.temperature
    if kelvin is not None and rubber.shift is not None and rubber.reference_temperature is not None:
        shift = float(rubber.shift.a(kelvin, rubber.reference_temperature))
    return np.asarray(2.0 * np.pi * shift * load.speed / surface.sines.wavelength)


def described_surface(
    measured: Measured | Spectrum,
    *,
    counted: Mapping[str, Any],
    fit: Mapping[str, Any],
    cut_off: CutOffRule | None,
    source: str,
    footprint: float | None = None,
) -> Surface:
    """Return a measured surface, or lines of its spectrum, with correlation and sine waves.

    `counted` and `fit` are arguments of `height_difference` and `fit_sines`, `cut_off` says where
    the roughness ends; None: where `fit` does. Profiles lose waves that a `footprint` [m] does not
    hold, if these are most of their heights. Raises `InputError` if the heights have no
    correlation, or no waves fit it.
    """
    spectrum, correlation = None, None
    if isinstance(measured, Spectrum):
        spectrum, end = measured, fit.get("smallest_wavelength") or cut_off
        end = end if isinstance(end, float) else None
        lines, correlation = spectrum.lines(footprint or math.inf, end)
        measured = Measured.of(lines)
    elif footprint is not None and measured.map is None and measured.longest is None:
        longest = longest_held(measured.cleaned, footprint)
        measured = measured if longest is None else measured.without_long_waves(longest)
    try:
        correlation = correlation or height_difference(measured.followed, **counted)
    except InputError as error:  # a wrong unit may leave no heights
        raise InputError(" ".join([*map(str, measured.doubts), str(error)])) from error
    try:
        measured = replace(measured, self_affine=fit_self_affine(correlation))
    except GripscaleError as error:  # the sine waves do not need a self-affine surface
        measured = replace(measured, no_self_affine=str(error))
    options = dict(fit)
    if not (cut_off is None or isinstance(cut_off, float)):
        options["cut_off"] = find_cut_off(measured.slopes, cut_off).wavelength
    sines = fit_sines(correlation, **options)
    fitted = Surface(sines, source, correlation, options, measured, counted, cut_off)
    return replace(fitted, spectrum=spectrum)


def _measured(
    lines: Sequence[Profile], cleaning: Mapping[str, Any], longest: float | None
) -> Measured:
    """Return profiles, cleaned if `cleaning` is not empty, up to the longest wavelength, if any."""
    measured = Measured.of_raw(lines, cleaning) if cleaning else Measured.of(lines)
    return measured if longest is None else measured.without_long_waves(longest)


def _surface(
    surface: SurfaceLike,
    end: float | None,
    waves: int,
    cleaning: Mapping[str, Any],
    longest: float | None,
    footprint: float,
) -> Surface:
    """Return a surface described; the `longest` wavelength [m] if it is stated."""
    if isinstance(surface, Surface):
        return surface
    if isinstance(surface, SineStack):
        return Surface(surface, "sine waves")
    measured: Measured | Spectrum
    if isinstance(surface, Spectrum):
        if cleaning:
            raise InputError("cleaning must be left out for a spectrum, which has no heights")
        measured = surface if longest is None else surface.without_long_waves(longest)
        sources = [surface.source]
    elif isinstance(surface, HeightMap):
        if cleaning or longest is not None:
            name = "cleaning" if cleaning else "longest_wavelength"
            raise InputError(f"{name} must be left out for a map: use gripscale.clean_map; got it")
        measured, sources = Measured.of_map(surface, surface), [surface.source]
    else:
        lines = [surface] if isinstance(surface, Profile) else list(surface)
        if len({line.name for line in lines}) < len(lines):  # results tell profiles by name
            lines = [
                replace(line, name=f"{line.name or 'profile'} {number}")
                for number, line in enumerate(lines, start=1)
            ]
        measured = _measured(lines, cleaning, longest)
        sources = [line.source for line in lines]
    rule: CutOffRule | None = "instrument" if end is None else None
    fit = {"scales": waves, "smallest_wavelength": end}
    source = ", ".join(filter(None, sources))
    return described_surface(
        measured, counted={}, fit=fit, cut_off=rule, source=source, footprint=footprint
    )
