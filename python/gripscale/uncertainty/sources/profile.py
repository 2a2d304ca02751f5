"""The source `profile`: another stretch of the same road might have been measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from gripscale.errors import InputError
from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.profile_blocks import ProfileBlocks
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated


@dataclass(frozen=True, eq=False)
class ProfileSource:
    """Blocks of the profiles are drawn with replacement, see `ProfileBlocks`."""

    name: ClassVar[str] = "profile"
    label: ClassVar[str] = "stretch of road measured"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        f"correlation_{lags}": Coordinate(
            "1", f"ln of C_z over the measured one, {lags} lags", True
        )
        for lags in ("short", "middle", "long")
    }

    blocks: ProfileBlocks

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> ProfileSource:
        """Return the source of a case.

        Raises `NotHere` without a measured profile, `InputError` if its profiles are too short, or
        the direct contact of a map is asked for.
        """
        if not known.fitted or not known.profiles:
            raise NotHere("no profile was measured")
        if "direct" in stated.models and known.is_map:
            raise InputError(
                "the direct contact of a map has no blocks of profiles to draw; leave out the "
                "source profile (without), or ask for the chain only"
            )
        blocks = ProfileBlocks(
            known.profiles,
            float(known.surface.sines.wavelength[0]),
            stated.block_length,
            known.surface.counted,
        )
        if "direct" in stated.models:
            blocks.require_lines()
        return cls(blocks)

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs on drawn blocks; blocks have no order that `place` could follow."""
        drawn = self.blocks.draw(random)
        changed = replace(
            inputs,
            correlation=self.blocks.correlation(drawn),
            redrawn=partial(self.blocks.lines, drawn),
        )
        ratios = self.blocks.log_ratios(drawn)
        return changed, dict(zip(self.coordinates, map(float, ratios), strict=True))
