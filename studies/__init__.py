"""Computations behind pages of the documentation that are neither tests nor benchmarks."""
