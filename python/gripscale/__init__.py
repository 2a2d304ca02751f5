"""Real contact area and friction of rubber on rough surfaces.

From a surface profile and a DMA master curve, through superposed sine waves, to a finite-strain
viscoelastic contact solution of every wave (Lind & Wangenheim, ASME IMECE2014-37998).
"""

from functools import cache
from types import FunctionType
from typing import Any

import lazy_loader

_lazy, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for."""
    if name == "__version__":
        from gripscale.core.provenance import version_of

        return version_of("gripscale")
    item = _lazy(name)
    for function in (item, getattr(item, "__init__", None)):
        if isinstance(function, FunctionType):
            _annotate_plainly(function)
    return item


@cache  # a name is looked up at every use
def _annotate_plainly(function: FunctionType) -> None:
    """Let `help` show the annotations of a function without quotation marks."""
    texts = function.__annotations__.items()
    function.__annotations__ |= {k: _Plain(text) for k, text in texts if isinstance(text, str)}


class _Plain(str):
    """The text of an annotation, which `help` shows without quotation marks."""

    def __repr__(self) -> str:
        return str(self)
