"""The area term fitted to measured friction, and how well the data determine it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
