"""Direct contact: a whole measured profile or map on a viscoelastic half-space, in one solve."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
