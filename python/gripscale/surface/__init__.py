"""The surface: measured profile, its height difference correlation, and the sines that match it."""

from gripscale.surface.cleaning import CleaningReport, StepReport, clean, clean_map
from gripscale.surface.cut_off import (
    ContactSlope,
    CutOffRule,
    PowerLaw,
    RmsSlope,
    SlopeByWavelength,
    SurfaceCutOff,
    find_cut_off,
    slope_by_wavelength,
)
from gripscale.surface.height_difference import (
    HeightDifference,
    SelfAffineFit,
    fit_self_affine,
    height_difference,
)
from gripscale.surface.plausibility import profile_warnings
from gripscale.surface.profile import HeightMap, Profile
from gripscale.surface.read import read_map, read_profile, read_profiles
from gripscale.surface.resampling import resample
from gripscale.surface.sine_fit import SineAmbiguity, fit_sines, sine_ambiguity
from gripscale.surface.sines import SineStack
from gripscale.surface.spectrum import (
    ArealSpectrum,
    ProfileSpectrum,
    areal_spectrum,
    map_spectrum,
    profile_spectrum,
)
from gripscale.surface.surface import Measured, Surface, SurfacePart
from gripscale.surface.synthetic import self_affine_profile, sine_profile
from gripscale.surface.texture import texture

__all__ = [
    "ArealSpectrum",
    "CleaningReport",
    "ContactSlope",
    "CutOffRule",
    "HeightDifference",
    "HeightMap",
    "Measured",
    "PowerLaw",
    "Profile",
    "ProfileSpectrum",
    "RmsSlope",
    "SelfAffineFit",
    "SineAmbiguity",
    "SineStack",
    "SlopeByWavelength",
    "StepReport",
    "Surface",
    "SurfaceCutOff",
    "SurfacePart",
    "areal_spectrum",
    "clean",
    "clean_map",
    "find_cut_off",
    "fit_self_affine",
    "fit_sines",
    "height_difference",
    "map_spectrum",
    "profile_spectrum",
    "profile_warnings",
    "read_map",
    "read_profile",
    "read_profiles",
    "resample",
    "self_affine_profile",
    "sine_ambiguity",
    "sine_profile",
    "slope_by_wavelength",
    "texture",
]
