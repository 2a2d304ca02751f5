"""Rubber: master curves, Prony series and the material they make."""

import lazy_loader

from gripscale.rubber.strain_energy import strain_energy as strain_energy  # not its module

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
