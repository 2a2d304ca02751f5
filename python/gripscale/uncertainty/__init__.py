"""Uncertainty: what is not known of a case, sampled, and what it does to friction and area."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
