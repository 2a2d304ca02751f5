"""Real contact area and friction of rubber on rough surfaces.

From a surface profile and a DMA master curve, through superposed sine waves, to a finite-strain
viscoelastic contact solution of every wave (Lind & Wangenheim, ASME IMECE2014-37998).
"""

from importlib.metadata import version as _version

from gripscale import rubber, surface, theory
from gripscale.chain import Prediction, predict
from gripscale.errors import ConvergenceError, FileError, GripscaleError, InputError
from gripscale.rubber import MasterCurve, Rubber, fit_prony, read_master_curve
from gripscale.scale import ScaleResult, solve_scale
from gripscale.surface import (
    HeightDifference,
    Profile,
    SelfAffineFit,
    SineStack,
    clean,
    fit_self_affine,
    fit_sines,
    height_difference,
    read_profile,
)
from gripscale.transient import Stage, TransientResult, solve_transient

__version__ = _version("gripscale")

__all__ = [
    "ConvergenceError",
    "FileError",
    "GripscaleError",
    "HeightDifference",
    "InputError",
    "MasterCurve",
    "Prediction",
    "Profile",
    "Rubber",
    "ScaleResult",
    "SelfAffineFit",
    "SineStack",
    "Stage",
    "TransientResult",
    "clean",
    "fit_prony",
    "fit_self_affine",
    "fit_sines",
    "height_difference",
    "predict",
    "read_master_curve",
    "read_profile",
    "rubber",
    "solve_scale",
    "solve_transient",
    "surface",
    "theory",
]
