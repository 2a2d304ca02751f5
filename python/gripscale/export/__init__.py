"""Results in the formats of other programs: rubbers, tables, and the mesh of a wave."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
