"""The case: one TOML file that says what is read, solved and written; and running it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
