"""What changes the rubber on the way: temperature, softening by strain, its own heat."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
