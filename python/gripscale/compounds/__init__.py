"""Two to six compounds side by side on one road: what differs, by how much, and why."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
