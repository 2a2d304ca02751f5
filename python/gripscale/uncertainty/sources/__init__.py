"""What is not known of a case: each source in a file of its own, all of them in `SOURCES`."""

from __future__ import annotations

from typing import Any

from gripscale.uncertainty.sources.bulk_modulus import BulkModulusSource
from gripscale.uncertainty.sources.cut_off import CutOffSource
from gripscale.uncertainty.sources.equilibrium_modulus import EquilibriumModulusSource
from gripscale.uncertainty.sources.load_time import LoadTimeSource
from gripscale.uncertainty.sources.modulus import ModulusSource
from gripscale.uncertainty.sources.profile import ProfileSource
from gripscale.uncertainty.sources.waves import WavesSource

SOURCES: dict[str, Any] = {
    source.name: source
    for source in (
        ProfileSource,
        ModulusSource,
        BulkModulusSource,
        EquilibriumModulusSource,
        LoadTimeSource,
        CutOffSource,
        WavesSource,
    )
}
"""In the order in which they are drawn: the waves are fitted last. A new one is added here."""

LABELS = {name: source.label for name, source in SOURCES.items()}
"""Names of the sources in words."""
