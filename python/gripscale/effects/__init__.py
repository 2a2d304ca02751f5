"""What each effect of the conditions is worth: the answer with it and without it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
