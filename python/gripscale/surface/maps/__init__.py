"""Synthetic isotropic maps that share statistics with measured profiles."""

from gripscale.surface.maps.isotropic import CONSTRUCTIONS, isotropic_maps

__all__ = ["CONSTRUCTIONS", "isotropic_maps"]
