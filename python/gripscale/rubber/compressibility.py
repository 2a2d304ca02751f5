"""A bulk modulus too small for the modulus it goes with: Poisson's ratio below that of any rubber.

nu = (3K - 2|G|) / (2 (3K + |G|)),    K for nu: 2|G| (1 + nu) / (3 (1 - 2 nu))
"""

from __future__ import annotations

import warnings
from functools import lru_cache

from gripscale.errors import RubberWarning

LEAST_POISSON_RATIO = 0.3
"""Below this no rubber and hardly a glassy polymer is: the bulk modulus is too small."""


def too_compressible(bulk: float, modulus: float, where: str) -> str:
    """Return a sentence if Poisson's ratio is below `LEAST_POISSON_RATIO`, else nothing.

    Parameters
    ----------
    bulk, modulus : float
        Bulk modulus and |E*| [Pa].
    where : str
        The frequency in words.
    """
    shear = modulus / 3.0
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    if ratio >= LEAST_POISSON_RATIO:
        return ""
    least = 2.0 * shear * (1.0 + LEAST_POISSON_RATIO) / (3.0 - 6.0 * LEAST_POISSON_RATIO)
    return (
        f"the bulk modulus, {bulk / 1e6:.4g} MPa, gives Poisson's ratio {ratio:.2f} {where}; "
        f"{least / 1e6:.4g} MPa would give {LEAST_POISSON_RATIO:g}"
    )


@lru_cache(maxsize=1024)
def warn_once(sentence: str) -> None:
    """Warn of a rubber made by hand; a second time of the same numbers nothing is said."""
    warnings.warn(sentence, RubberWarning, stacklevel=4)
