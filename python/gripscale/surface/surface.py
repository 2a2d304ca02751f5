"""A surface as models take it: sine waves, a measurement or both, and where its roughness ends."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from gripscale.core import CaseKey, Described, InputError, Words, about_file, in_mm
from gripscale.core.finding import Finding, Severity, Topic
from gripscale.surface import plausibility
from gripscale.surface.cleaning import CleaningReport, clean, subtract_long_waves
from gripscale.surface.cut_off import (
    CutOffRule,
    SlopeByWavelength,
    SurfaceCutOff,
    find_cut_off,
    slope_by_wavelength,
)
from gripscale.surface.direction import direction_of_map, direction_of_profiles
from gripscale.surface.height_difference import HeightDifference, SelfAffineFit
from gripscale.surface.low_pass import followed, followed_lines
from gripscale.surface.profile import HeightMap, Profile
from gripscale.surface.random_phases import Spectrum
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.sines import SineStack
from gripscale.surface.texture import Heights, texture_levels, textures

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, repr=False)
class Measured(Described):
    """Profiles as read and cleaned, the cleaning reports, and the fit to their correlation.

    For a map, `profiles` holds one line for figures; `map` and its lines are cleaned.
    """

    profiles: list[tuple[Profile, Profile]]
    cleaning: list[CleaningReport]
    self_affine: SelfAffineFit | None
    no_self_affine: str
    """Why there is no self-affine fit, or empty."""
    map: HeightMap | None = None
    """The map, x along the way of sliding, or None for profiles."""
    across: list[tuple[Profile, Profile]] = field(default_factory=list)
    """Profiles across the way of sliding as read and cleaned: they show ridges, and no more."""
    longest: float | None = None
    """Longest wavelength that was kept [m]; None for all."""

    @classmethod
    def of(cls, measured: Sequence[Profile] | HeightMap) -> Measured:
        """Return profiles or a map as they are, neither cleaned nor fitted."""
        if isinstance(measured, HeightMap):
            return cls([], [], None, "", measured)
        return cls.of_pairs([(line, line) for line in measured])

    @classmethod
    def of_pairs(
        cls, pairs: Sequence[tuple[Profile, Profile]], cleaning: Sequence[CleaningReport] = ()
    ) -> Measured:
        """Return profiles as read and cleaned.

        Raises `InputError` if all lie across sliding, or one is there twice: twice the same lines
        would halve the sampling error, and the same along and across show no ridges.
        """
        first: dict[bytes, int] = {}
        for number, (line, _) in enumerate(pairs, start=1):
            same = first.setdefault(line.z.tobytes(), number)
            if same != number:
                raise InputError(
                    f"profiles must be different measurements; got the heights of profile {same} "
                    f"again as profile {number} ({line.name or 'without a name'})"
                )
        along = [at for at, (line, _) in enumerate(pairs) if line.lay == "along"]
        if not along:
            raise InputError("surface must have a profile along sliding; got all of them across it")
        across = [pair for pair in pairs if pair[0].lay == "across"]
        reports = [cleaning[at] for at in along] if cleaning else []
        return cls([pairs[at] for at in along], reports, None, "", across=across)

    @classmethod
    def of_map(
        cls, raw: HeightMap, cleaned: HeightMap, cleaning: Sequence[CleaningReport] = ()
    ) -> Measured:
        """Return a map before and after cleaning; its fullest line near the middle is drawn."""
        away = np.abs(np.arange(cleaned.y.size) - cleaned.y.size // 2)
        fullest = np.lexsort((away, np.isnan(cleaned.z).sum(axis=0)))[0]
        before, after = (
            each.line(int(np.argmin(np.abs(each.y - cleaned.y[fullest]))))
            for each in (raw, cleaned)
        )
        after = replace(after, name=before.name, source=before.source)
        return cls([(before, after)], list(cleaning), None, "", cleaned)

    @classmethod
    def of_raw(cls, profiles: Sequence[Profile], cleaning: Mapping[str, Any]) -> Measured:
        """Return profiles cleaned by arguments of `gripscale.clean`, not fitted.

        Raises `InputError` if an argument is wrong, or a step leaves too few points or heights.
        """
        pairs, reports = [], []
        for line in profiles:
            with about_file(line.source, InputError) if line.source else nullcontext():
                cleaned, report = clean(line, **cleaning)
            pairs.append((line, cleaned))
            reports.append(report)
        measured = cls.of_pairs(pairs, reports)
        return replace(measured, longest=cleaning.get("longest_wavelength"))

    def without_long_waves(self, longest: float) -> Measured:
        """Return the profiles without waves beyond the cut-off `longest` [m]."""
        along, reports = [], []
        for at, (raw, cleaned) in enumerate(self.profiles):
            after, step = subtract_long_waves(cleaned, longest)
            along.append((raw, after))
            reports.append(CleaningReport((*(self.cleaning[at] if self.cleaning else ()), step)))
        across = [(raw, subtract_long_waves(line, longest)[0]) for raw, line in self.across]
        return replace(self, profiles=along, across=across, cleaning=reports, longest=longest)

    @property
    def cleaned(self) -> list[Profile]:
        """The profiles as cleaned, or all lines of the map along the way of sliding."""
        if self.map is not None:
            return self.map.lines()
        return [cleaned for _, cleaned in self.profiles]

    @property
    def heights(self) -> list[Profile] | HeightMap:
        """The profiles as cleaned, or the map."""
        return self.cleaned if self.map is None else self.map

    @cached_property
    def followed(self) -> list[Profile]:
        """The cleaned lines without the flanks that rubber cannot follow."""
        heights = self._followed_heights
        return heights.lines() if isinstance(heights, HeightMap) else heights

    @cached_property
    def _followed_heights(self) -> list[Profile] | HeightMap:
        heights = self.heights
        return followed(heights) if isinstance(heights, HeightMap) else followed_lines(heights)

    @property
    def surfaces(self) -> list[Profile] | list[HeightMap]:
        """Surfaces for the contact solver: the cleaned profiles, or the map."""
        return self.cleaned if self.map is None else [self.map]

    @cached_property
    def slopes(self) -> SlopeByWavelength:
        """Rms slope of the measurement down to each wavelength."""
        return slope_by_wavelength(self._followed_heights, steepest=math.inf)

    @cached_property
    def texture(self) -> xr.Dataset:
        """Texture of the map, or of each profile and of all together, over `texture_of`."""
        if self.map is not None:
            return textures({"map": self.map}, "texture_of")
        named: dict[str, Heights | None] = {
            f"profile {i + 1}": line for i, line in enumerate(self.cleaned)
        }
        if len(named) > 1:
            named["all profiles"] = self.cleaned
        return textures(named, "texture_of")

    @property
    def texture_levels(self) -> xr.Dataset | None:
        """Texture levels of all profiles together, or of the map; None if they are too short."""
        try:
            return texture_levels(self.heights)
        except InputError:
            return None

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """Changes made by reading, doubts, and implausible properties."""
        findings = []
        for raw, cleaned in (*self.profiles, *self.across):
            changes = [Finding(Severity.WARNING, f"{n}.", topic=Topic.SURFACE) for n in raw.notes]
            implausible = plausibility.profile_warnings(raw, cleaned)
            if self.map is not None:  # its lines are no profiles between plates
                implausible = tuple(replace(f, severity=Severity.WARNING) for f in implausible)
            of_line = (*changes, *raw.doubts, *implausible)
            findings += [finding.about(raw.name) for finding in of_line]
        if self.longest is not None and self.long_share:
            text = (
                f"Waves beyond {in_mm(self.longest, 4)} are left out: they hold "
                f"{100.0 * self.long_share:.2g} % of the mean square height, and a block of rubber "
                "rides over what is longer than its footprint ("
            )
            words = Words(text, CaseKey("longest_wavelength"), " states where).")
            findings.append(Finding(Severity.WARNING, words, topic=Topic.SURFACE))
        return tuple(findings)

    @property
    def long_share(self) -> float:
        """Share of the mean square height that was left out with the long waves [-]."""
        shares = [step.share for report in self.cleaning for step in report]
        return float(np.sum(shares)) / len(self.cleaning) if shares else 0.0

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Findings that make the answer unreliable: depths, sentinels, plates, units."""
        return tuple(f for f in self.findings if f.severity == Severity.DOUBT)


SurfaceKind = Literal["surface", "road", "floor", "counterface"]
SURFACE_KINDS = get_args(SurfaceKind)
SURFACE_KIND = "surface_kind"  # attribute of a result: what its surface is called
SurfacePart = Literal["waves", "measurement", "cut_off"]
"""A part of a surface that a model may need."""


@dataclass(frozen=True, repr=False)
class Surface(Described):
    """Sine waves, a measurement, or both."""

    waves: SineStack | None
    """None for a measurement without them."""
    source: str
    """Origin of the surface."""
    correlation: HeightDifference | None = None
    """Curve to which the waves were fitted, or None for waves stated by hand."""
    fit: Mapping[str, Any] = field(default_factory=dict)
    """Arguments of `fit_sines` for the waves."""
    measured: Measured | None = None
    """The measurement behind the correlation, or None for a synthetic surface."""
    counted: Mapping[str, Any] = field(default_factory=dict)
    """Arguments of `height_difference` for the correlation: heights and lags that count."""
    rule: CutOffRule | None = None
    """Rule for the end of the waves, or None for the last wave."""
    end: float | None = None
    """Shortest wavelength of the roughness [m]; None: where the waves end."""
    note: str = ""
    """Assumption made while reading the file, as a sentence; empty if none was made."""
    spectrum: Spectrum | None = None
    """All that is known of it, if it is known by its spectrum: `measured` are lines drawn of it."""

    @property
    def sines(self) -> SineStack:
        """The sine waves; `InputError` without them."""
        if self.waves is None:
            raise InputError("the model needs sine waves; got a surface with a measurement only")
        return self.waves

    @property
    def cutoff_wavelength(self) -> float:
        """Shortest wavelength of the roughness [m]; `InputError` if nothing says where it ends."""
        return self.sines.cutoff_wavelength if self.end is None else self.end

    @property
    def cut_off(self) -> SurfaceCutOff | None:
        """End of the roughness and its rule, or None without a measurement."""
        if self.measured is None:
            return None
        end = self.cutoff_wavelength
        if self.rule is None:
            return replace(find_cut_off(self.measured.slopes, end), rule="the last wave")
        cut_off = find_cut_off(self.measured.slopes, self.rule)
        if np.isclose(cut_off.wavelength, end, rtol=1e-6):
            return cut_off
        # with s_wavelength given, whole waves end above the cut-off that was asked for
        rule = f"whole waves down to {cut_off.rule}"
        return replace(find_cut_off(self.measured.slopes, end), rule=rule)

    def only(self, parts: Collection[SurfacePart]) -> Surface:
        """Return a surface with these parts only, without their origin."""
        waves = self.waves if "waves" in parts else None
        measured = self.measured and Measured.of(self.measured.heights)
        return Surface(
            waves and SineStack(waves.wavelength, waves.amplitude),
            source="",
            measured=measured if "measurement" in parts else None,
            end=self.cutoff_wavelength if "cut_off" in parts else None,
        )

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What may change the answer: of the measurement, and of the end of the waves."""
        of_measurement = () if self.measured is None else (*self.measured.findings, *self.noise)
        of_measurement = (self.spectrum.finding,) if self.spectrum else of_measurement
        if self.correlation is None:
            return of_measurement
        ridges = [f for f in self.direction if f.severity != Severity.GOOD]
        of_waves = plausibility.stack_notes(self.sines, self.correlation, self.fit)
        return (*of_measurement, *ridges, *of_waves, *self.extrapolated)

    @cached_property
    def direction(self) -> tuple[Finding, ...]:
        """What profiles across sliding, or a map, tell of ridges; nothing of other surfaces."""
        if self.measured is None or self.spectrum is not None:
            return ()
        if self.measured.map is not None:
            finding = direction_of_map(self.measured.map)
            return () if finding is None else (finding,)
        lags = 0.5 * self.cutoff_wavelength, 0.25 * float(self.sines.wavelength[0])
        across = [cleaned for _, cleaned in self.measured.across]
        return (direction_of_profiles(self.measured.cleaned, across, lags),)

    @cached_property
    def noise(self) -> tuple[Finding, ...]:
        """What white noise of the measured heights changes; nothing without a cut-off."""
        if self.measured is None or self.spectrum or (self.end is None and self.waves is None):
            return ()
        lines, whole = self.measured.cleaned, self.measured.map
        across = None if whole is None else whole.step[1]
        # thirty lines of a map show its noise
        finding = plausibility.noise_finding(
            lines[:: 1 + len(lines) // 30], self.cutoff_wavelength, across
        )
        return () if finding is None else (finding,)

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Findings that make the answer unreliable."""
        of_noise = (f for f in self.noise if f.severity == Severity.DOUBT)
        heights = None if self.spectrum else self.measured
        return () if heights is None else (*heights.doubts, *of_noise)

    @property
    def extrapolated(self) -> tuple[Finding, ...]:
        """Findings on waves and roughness beyond the resolution of the measurement."""
        if self.correlation is None:
            return ()
        return tuple(plausibility.extrapolation_notes(self.sines, self.correlation))

    def varied(
        self,
        *,
        waves: int | None = None,
        smallest_wavelength: float | None = None,
        cut_off: CutOffRule | None = None,
    ) -> Surface:
        """Return the surface with other waves; raise `InputError` if there are none such.

        The number of `waves` is fitted anew to a measured surface, and means the first ones of
        waves by hand. `smallest_wavelength` is the last wave [m], in place of a cut-off: fitted
        anew, or cut off. `cut_off` is where the roughness ends that they stand for, in its place: a
        length [m] or another rule of `find_cut_off`; of fitted waves only.
        """
        if waves is None and smallest_wavelength is None and cut_off is None:
            return self
        if smallest_wavelength is not None and cut_off is not None:
            raise InputError(
                "vary smallest_wavelength (the last wave) or cut_off (where the roughness ends), "
                "not both"
            )
        if self.correlation is None or not self.fit:
            if cut_off is not None:
                raise InputError(f"cut_off varies waves that were fitted; got {self.source}")
            return replace(self, waves=self._shortened(waves, smallest_wavelength), rule=None)
        options = dict(self.fit)
        fixed = options.get("s_wavelength") is not None
        if waves is not None:
            no_end = {"smallest_wavelength": None, "cut_off": None}
            options |= {"scales": waves} | (no_end if fixed else {})
        if smallest_wavelength is not None or cut_off is not None:
            end = None if cut_off is None else self._length_of(cut_off)
            options |= {"smallest_wavelength": smallest_wavelength, "cut_off": end}
            options |= {"scales": None} if fixed and waves is None else {}
        stack = fit_sines(self.correlation, **options)
        kept = self.rule if stack.cut_off is not None else None
        return replace(self, waves=stack, rule=kept if cut_off is None else cut_off)

    def _length_of(self, rule: CutOffRule) -> float:
        if isinstance(rule, int | float):
            return rule
        if self.measured is None:
            raise InputError(f"cut_off = {rule} needs a measured surface; got {self.source}")
        return find_cut_off(self.measured.slopes, rule).wavelength

    def _shortened(self, waves: int | None, smallest: float | None) -> SineStack:
        count = len(self.sines) if waves is None else waves
        if count > len(self.sines):
            raise InputError(
                f"waves must be at most {len(self.sines)}, as many as there are; got {count}"
            )
        keep = np.arange(len(self.sines)) < count
        if smallest is not None:
            keep &= self.sines.wavelength >= smallest
        if not keep.any():
            raise InputError(
                f"smallest_wavelength must not exceed the largest wave, "
                f"{self.sines.wavelength[0]:g} m; got {smallest:g} m"
            )
        return SineStack(self.sines.wavelength[keep], self.sines.amplitude[keep])


def with_single_measurement(surface: Surface, measured: Profile | HeightMap) -> Surface:
    """Return the waves of `surface` with one profile or map as the only measurement."""
    heights = measured if isinstance(measured, HeightMap) else [measured]
    return Surface(surface.sines, measured.name, measured=Measured.of(heights))


def each_measured(surface: Surface) -> list[tuple[str, Surface]]:
    """Return names of the profiles of `surface`, or of its map, each with a surface of it alone."""
    measured: Sequence[Profile | HeightMap] = surface.measured.surfaces if surface.measured else ()
    return [
        (part.name or f"profile {i}", with_single_measurement(surface, part))
        for i, part in enumerate(measured, 1)
    ]
