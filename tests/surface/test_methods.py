"""The methods of profiles, maps and curves are the functions of the same name."""

import numpy as np

import gripscale as gs
from gripscale.surface import map_spectrum, profile_spectrum, self_affine_profile

PROFILE = self_affine_profile(0.8, 2e-3, 1e-3, 0.1, 1e-4, seed=1)
MAP = gs.HeightMap(
    1e-4 * np.arange(24),
    2e-4 * np.arange(20),
    1e-5 * np.random.default_rng(0).standard_normal((24, 20)),
)


def labels(figure):
    return {text for axes in figure.axes for text in axes.get_legend_handles_labels()[1]}


def test_a_profile_is_cleaned_and_drawn_beside_its_measurement():
    cleaned, report = PROFILE.clean(detrend="mean")
    expected, steps = gs.clean(PROFILE, detrend="mean")
    assert np.array_equal(cleaned.z, expected.z, equal_nan=True)
    assert str(report) == str(steps)
    for figure in (PROFILE.plot(), PROFILE.plot(cleaned)):
        assert [axes.get_xlabel() for axes in figure.axes][-1] == "distance $x$ [mm]"


def test_statistics_of_a_profile():
    curve, expected = (
        PROFILE.height_difference(max_lag=0.01),
        gs.height_difference(PROFILE, max_lag=0.01),
    )
    assert np.array_equal(curve.value, expected.value)
    spectrum = PROFILE.spectrum(taper="none")
    assert np.array_equal(spectrum.density, profile_spectrum(PROFILE, taper="none").density)


def test_a_map_is_cleaned_and_drawn():
    cleaned, expected_map = MAP.clean(form=2)[0], gs.clean_map(MAP, form=2)[0]
    assert np.array_equal(cleaned.z, expected_map.z, equal_nan=True)
    expected = map_spectrum(MAP.z, x_step=MAP.step[0], y_step=MAP.step[1], taper="none")
    assert np.array_equal(MAP.spectrum(taper="none").density, expected.density)
    assert MAP.plot().axes[0].get_ylabel() == "distance across $y$ [mm]"


def test_fits_of_a_curve_and_their_figure():
    curve = gs.height_difference(PROFILE)
    fit, sines = curve.fit_self_affine(), curve.fit_sines(scales=3)
    assert fit == gs.fit_self_affine(curve)
    assert np.array_equal(sines.wavelength, gs.fit_sines(curve, scales=3).wavelength)
    assert labels(curve.plot()) == {"95 % band", "measured"}
    drawn = labels(curve.plot({"3 waves": sines}, fit))
    assert {"3 waves", f"self-affine, $H$ = {fit.hurst:.2f}"} <= drawn
