"""Closed forms and the small-strain model, to check the solver against and to learn from.

Modules: `elastic` (full contact of a sine), `half_plane` (small-strain model of one sliding wave),
`layers` (rubber of finite thickness), `persson` and
`klueppel_heinrich` (rough surfaces). The material point under any history, `uniaxial_stress` and
`simple_shear_stress`, is in `gripscale.rubber.finite_strain`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
