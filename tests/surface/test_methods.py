"""Profiles, maps and curves draw themselves."""

import gripscale as gs
from gripscale.surface import self_affine_profile

PROFILE = self_affine_profile(0.8, 2e-3, 1e-3, 0.1, 1e-4, seed=1)


def labels(figure):
    return {text for axes in figure.axes for text in axes.get_legend_handles_labels()[1]}


def test_fits_of_a_curve_are_in_its_figure():
    curve = gs.height_difference(PROFILE)
    fit, sines = gs.fit_self_affine(curve), gs.fit_sines(curve, scales=3)
    assert labels(curve.plot()) == {"95 % band", "measured"}
    drawn = labels(curve.plot({"3 waves": sines}, fit))
    assert {"3 waves", f"self-affine, $H$ = {fit.hurst:.2f}"} <= drawn
