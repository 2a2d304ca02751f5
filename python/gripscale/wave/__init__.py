"""One wave: a rubber block pressed on one rigid profile and slid over it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
