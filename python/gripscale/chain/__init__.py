"""The chain: waves solved one after the other, each under the pressure of the larger one."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
