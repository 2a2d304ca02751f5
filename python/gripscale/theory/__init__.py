"""Closed forms and the small-strain model, to check the solver against and to learn from.

Modules: `full_contact`, `westergaard`, `hertz`, `slab`, `uniaxial` (closed forms) and `half_plane`
(the small-strain model of one sliding wave, on `periodic_contact`). The material point under any
history, `uniaxial_stress` and `simple_shear_stress`, is in `gripscale.rubber.material_point`.
"""

from gripscale.rubber import simple_shear_stress, uniaxial_stress
from gripscale.theory.full_contact import (
    full_contact_friction,
    full_contact_pressure,
    plane_strain_modulus,
)
from gripscale.theory.half_plane import solve_half_plane
from gripscale.theory.hertz import contact_half_width, crest_radius, largest_pressure
from gripscale.theory.slab import slab_compliance
from gripscale.theory.uniaxial import step_relaxation_stress
from gripscale.theory.westergaard import contact_fraction, contact_pressure

__all__ = [
    "contact_fraction",
    "contact_half_width",
    "contact_pressure",
    "crest_radius",
    "full_contact_friction",
    "full_contact_pressure",
    "largest_pressure",
    "plane_strain_modulus",
    "simple_shear_stress",
    "slab_compliance",
    "solve_half_plane",
    "step_relaxation_stress",
    "uniaxial_stress",
]
