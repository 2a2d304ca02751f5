"""Two to six roads side by side under one rubber and load: what differs, by how much, and where."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
