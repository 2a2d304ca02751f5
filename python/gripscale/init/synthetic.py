"""A made-up road as the text file a profilometer would write."""

from __future__ import annotations


def road_text() -> str:
    """Return distance and height [mm] of a self-affine profile, with their titles."""
    from gripscale.surface import self_affine_profile

    road = self_affine_profile(
        hurst=0.8, xi_parallel=3e-3, xi_perpendicular=0.8e-3, length=0.4, step=0.05e-3, seed=3
    )
    rows = (f"{x * 1e3:.2f}\t{z * 1e3:.4f}" for x, z in zip(road.x, road.z, strict=True))
    return "\n".join(["x [mm]\tz [mm]", *rows]) + "\n"
