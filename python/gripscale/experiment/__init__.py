"""Studies: a case with its inputs varied, on all cores or a cluster, resumed where they stopped."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
