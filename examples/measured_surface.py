"""A measured road: read, clean, correlate, and stand sine waves in for it.

Run as `python examples/measured_surface.py [FOLDER [PROFILE]]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import gripscale as gs
from gripscale.charts import save_figure
from gripscale.questions import correlation_figure, profile_figure

ROAD = Path(__file__).parent / "data" / "road" / "20211011_aylesbury_dec_station_0.dat"
PLATES = (0.12, 1.78)  # [m], the road lies between the steel plates of the instrument


def main(folder: str = "results/examples", file: str = "") -> None:
    """Print what cleaning removed and both fits; draw the profile and its correlation."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    raw = gs.read_profile(file or ROAD)
    cleaned, report = gs.clean(raw, crop=None if file else PLATES)
    print(report)
    curve = gs.height_difference(cleaned)
    affine = gs.fit_self_affine(curve)
    print(
        f"Hurst exponent {affine.hurst:.3f}, cut-off {affine.xi_parallel * 1e3:.2f} mm, "
        f"plateau ({affine.xi_perpendicular * 1e3:.2f} mm)^2"
    )
    stacks = {f"{count} waves": gs.fit_sines(curve, scales=count) for count in (2, 4, 8)}
    for name, sines in stacks.items():
        print(
            f"{name}: s_wavelength {sines.s_wavelength:.2f}, s_amplitude {sines.s_amplitude:.2f}, "
            f"residual {sines.residual:.3f} decades"
        )
    save_figure(profile_figure([(raw, cleaned)]), target, "measured_surface_profile")
    figure = correlation_figure(curve, stacks, affine)
    print(save_figure(figure, target, "measured_surface")[0])


if __name__ == "__main__":
    main(*sys.argv[1:3])
