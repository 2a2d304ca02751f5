"""Rubber: master curves, Prony series and the material they make."""

from gripscale.rubber.columns import FileLayout
from gripscale.rubber.extrapolation import Extrapolation
from gripscale.rubber.finite_strain import (
    FiniteStrainFit,
    UniaxialTest,
    fit_finite_strain,
    read_uniaxial_test,
    rms_error,
    simple_shear_stress,
    uniaxial_stress,
    work_error,
)
from gripscale.rubber.master_curve import MasterCurve, read_master_curve, write_master_curve
from gripscale.rubber.material import AdmissibleSeries, Rubber, temperature_doubts
from gripscale.rubber.maxwell_fit import Candidate
from gripscale.rubber.named import springpot_modulus, styrene_butadiene
from gripscale.rubber.prony import fit_prony, fit_prony_report
from gripscale.rubber.prony_report import Misfit, PronyFit
from gripscale.rubber.shift import (
    SHIFTS,
    WLF,
    Arrhenius,
    Shift,
    ShiftTable,
    WLFArrhenius,
    shift_from_dict,
)
from gripscale.rubber.shift_fit import (
    ShiftFit,
    fit_arrhenius,
    fit_wlf,
    read_shift_table,
    write_shift_table,
)
from gripscale.rubber.strain_energy import (
    STRAIN_ENERGIES,
    Isihara,
    MooneyRivlin,
    NeoHookean,
    StrainEnergy,
    Yeoh,
    strain_energy,
)
from gripscale.rubber.strain_sweep import StrainSweep, read_strain_sweep
from gripscale.rubber.superposition import Overlap, Superposition, superpose, superpose_report
from gripscale.rubber.sweeps import Sweep, Sweeps, read_sweeps, sweeps_from_ramps

__all__ = [
    "SHIFTS",
    "STRAIN_ENERGIES",
    "WLF",
    "AdmissibleSeries",
    "Arrhenius",
    "Candidate",
    "Extrapolation",
    "FileLayout",
    "FiniteStrainFit",
    "Isihara",
    "MasterCurve",
    "Misfit",
    "MooneyRivlin",
    "NeoHookean",
    "Overlap",
    "PronyFit",
    "Rubber",
    "Shift",
    "ShiftFit",
    "ShiftTable",
    "StrainEnergy",
    "StrainSweep",
    "Superposition",
    "Sweep",
    "Sweeps",
    "UniaxialTest",
    "WLFArrhenius",
    "Yeoh",
    "fit_arrhenius",
    "fit_finite_strain",
    "fit_prony",
    "fit_prony_report",
    "fit_wlf",
    "read_master_curve",
    "read_shift_table",
    "read_strain_sweep",
    "read_sweeps",
    "read_uniaxial_test",
    "rms_error",
    "shift_from_dict",
    "simple_shear_stress",
    "springpot_modulus",
    "strain_energy",
    "styrene_butadiene",
    "superpose",
    "superpose_report",
    "sweeps_from_ramps",
    "temperature_doubts",
    "uniaxial_stress",
    "work_error",
    "write_master_curve",
    "write_shift_table",
]
