"""Fluid between rubber and surface: flow through the gap, squeeze-out, mixed lubrication."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
