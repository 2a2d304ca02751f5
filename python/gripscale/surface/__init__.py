"""The surface: measured profile, its height difference correlation, and the sines that match it."""

from gripscale.surface.cleaning import CleaningReport, StepReport, clean
from gripscale.surface.cut_off import CutOff, CutOffRule, RmsSlope, find_cut_off
from gripscale.surface.doubts import profile_doubts
from gripscale.surface.height_difference import HeightDifference, height_difference
from gripscale.surface.height_map import HeightMap
from gripscale.surface.isotropy import areal_spectrum
from gripscale.surface.map_cleaning import clean_map
from gripscale.surface.map_file import read_map
from gripscale.surface.maps.isotropic import isotropic_maps
from gripscale.surface.periodogram import map_spectrum, profile_spectrum
from gripscale.surface.prepared import Measured, PreparedSurface
from gripscale.surface.profile import Profile
from gripscale.surface.read import read_profile, read_profiles
from gripscale.surface.resampling import resample
from gripscale.surface.self_affine import SelfAffineFit, fit_self_affine
from gripscale.surface.sine_ambiguity import SineAmbiguity, sine_ambiguity
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.sines import SineStack
from gripscale.surface.slope import PowerLaw, SlopeByWavelength, slope_by_wavelength
from gripscale.surface.spectrum import ArealSpectrum, ProfileSpectrum
from gripscale.surface.synthetic import self_affine_profile, sine_profile

__all__ = [
    "ArealSpectrum",
    "CleaningReport",
    "CutOff",
    "CutOffRule",
    "HeightDifference",
    "HeightMap",
    "Measured",
    "PowerLaw",
    "PreparedSurface",
    "Profile",
    "ProfileSpectrum",
    "RmsSlope",
    "SelfAffineFit",
    "SineAmbiguity",
    "SineStack",
    "SlopeByWavelength",
    "StepReport",
    "areal_spectrum",
    "clean",
    "clean_map",
    "find_cut_off",
    "fit_self_affine",
    "fit_sines",
    "height_difference",
    "isotropic_maps",
    "map_spectrum",
    "profile_doubts",
    "profile_spectrum",
    "read_map",
    "read_profile",
    "read_profiles",
    "resample",
    "self_affine_profile",
    "sine_ambiguity",
    "sine_profile",
    "slope_by_wavelength",
]
