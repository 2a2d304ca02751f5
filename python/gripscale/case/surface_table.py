"""[surface] of a case: measured profiles or a map, or waves stated by hand.

Lengths in m once read.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from gripscale.case.columns import Column
from gripscale.case.expected import Words
from gripscale.case.quantity import Length, Position, unit_of_file
from gripscale.case.table import Table
from gripscale.units import in_mm

CUT_OFF_WORDS = Words('a length, "instrument" or a table such as { rms_slope = 1.3 }')


def _cut_off(value: Any) -> Any:
    """Accept a length, "instrument" or a table such as { rms_slope = 1.3, of = "surface" }."""
    from gripscale.surface.cut_off import cut_off_rule  # scipy with it: not for reading a case

    return None if value is None else cut_off_rule(value)


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
    x_unit: Annotated[str, unit_of_file("length")] | None = None
    """Unit of distances where the file does not name it."""
    z_unit: Annotated[str, unit_of_file("length")] | None = None
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
