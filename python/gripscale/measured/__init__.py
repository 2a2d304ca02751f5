"""Friction measured elsewhere, what models predict at its points, and how far they are from it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
