"""Rubber: master curves, Prony series and the material they make."""

from gripscale.rubber.finite_strain_fit import (
    FiniteStrainFit,
    UniaxialTest,
    fit_finite_strain,
    read_uniaxial_test,
    rms_error,
    work_error,
)
from gripscale.rubber.header import FREQUENCY_UNITS, MODULUS_UNITS
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import Rubber
from gripscale.rubber.material_point import simple_shear_stress, uniaxial_stress
from gripscale.rubber.named import springpot_modulus, styrene_butadiene
from gripscale.rubber.prony import PronyFit, fit_prony, fit_prony_report
from gripscale.rubber.reader import read_master_curve
from gripscale.rubber.strain_energy import MooneyRivlin, NeoHookean, StrainEnergy, Yeoh
from gripscale.rubber.term_choice import Candidate

__all__ = [
    "FREQUENCY_UNITS",
    "MODULUS_UNITS",
    "Candidate",
    "FiniteStrainFit",
    "MasterCurve",
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
    "styrene_butadiene",
    "uniaxial_stress",
    "work_error",
]
