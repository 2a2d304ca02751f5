"""What is not hysteresis: the heat of the friction, and the area term of dry contact."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
