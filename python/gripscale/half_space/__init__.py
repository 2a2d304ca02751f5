"""Direct contact: a whole measured profile or map on a viscoelastic half-space, in one solve."""

from importlib import import_module

import lazy_loader

_attribute, _, __all__ = lazy_loader.attach_stub(__name__, __file__)

# Names that `gripscale.continuation` holds; scripts may still import them from here.
_CONTINUATION = {
    *("ContactByCutOff", "ContinuedContact", "contact_by_cut_off"),
    *("FinerMeasurement", "HurstExponent", "OwnFaces"),
}
__all__ = sorted([*__all__, *_CONTINUATION])


def __getattr__(name: str) -> object:
    if name in _CONTINUATION:
        return getattr(import_module("gripscale.continuation"), name)
    return _attribute(name)


def __dir__() -> list[str]:
    return list(__all__)
