"""The chain: waves solved one after the other, each with the pressure that leaves the one above."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
