"""Rubber: master curves, Prony series and the material they make."""

from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.extrapolation import Extrapolation
from gripscale.rubber.finite_strain_fit import (
    FiniteStrainFit,
    fit_finite_strain,
    rms_error,
    work_error,
)
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.material_point import simple_shear_stress, uniaxial_stress
from gripscale.rubber.misfit import Misfit
from gripscale.rubber.named import springpot_modulus, styrene_butadiene
from gripscale.rubber.prony import fit_prony, fit_prony_report
from gripscale.rubber.prony_report import PronyFit
from gripscale.rubber.reader import read_master_curve
from gripscale.rubber.strain_energy import (
    STRAIN_ENERGIES,
    Isihara,
    MooneyRivlin,
    NeoHookean,
    StrainEnergy,
    Yeoh,
    strain_energy,
)
from gripscale.rubber.term_choice import Candidate
from gripscale.rubber.uniaxial_test import UniaxialTest, read_uniaxial_test

__all__ = [
    "STRAIN_ENERGIES",
    "AdmissibleSeries",
    "Candidate",
    "Extrapolation",
    "FiniteStrainFit",
    "Isihara",
    "MasterCurve",
    "Misfit",
    "MooneyRivlin",
    "NeoHookean",
    "PronyFit",
    "Rubber",
    "StrainEnergy",
    "UniaxialTest",
    "Yeoh",
    "fit_finite_strain",
    "fit_prony",
    "fit_prony_report",
    "read_master_curve",
    "read_uniaxial_test",
    "rms_error",
    "simple_shear_stress",
    "springpot_modulus",
    "strain_energy",
    "styrene_butadiene",
    "uniaxial_stress",
    "work_error",
]
