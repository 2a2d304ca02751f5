"""Every model tells in the same words what rests on the rubber beyond its measured band.

Two waves of small slope, pressed flat: each adds mu_i = k^2 A^2 Im(M) / (4 p), so the share of the
shorter, which alone is beyond the band, is known in closed form.
"""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain import Chain
from gripscale.core.errors import ExtrapolationError
from gripscale.half_space import BlockOnProfile
from gripscale.half_space.model import DirectContact
from gripscale.model import OUTSIDE_BAND, Load, extrapolation_of
from gripscale.surface import Measured, Profile, Surface
from gripscale.theory import HalfPlane, persson

LONG, SHORT = 4e-3, 1e-3
SINES = gs.SineStack([LONG, SHORT], [1e-5, 4e-6])
LOAD = Load(pressure=2e6, speed=0.1, footprint=0.1)
OMEGA = 2 * np.pi * LOAD.speed / np.array([LONG, SHORT])
RUBBER = gs.Rubber(6e6, [12e6, 8e6], [1e-2, 1e-3], valid_band=(1.0, OMEGA[1] / 2.0))


def surface(points=256):
    x = np.arange(points) * LONG / points
    z = SINES.amplitude @ np.cos(2 * np.pi * np.outer(1 / SINES.wavelength, x))
    return Surface(SINES, "", measured=Measured.of([Profile(x, z)]))


def closed_form():
    """Return the share of the shorter wave: mu_i is as k^2 A^2 Im(M)."""
    friction = RUBBER.plane_strain_modulus(OMEGA).imag * (SINES.amplitude / SINES.wavelength) ** 2
    return float(friction[1] / friction.sum())


@pytest.mark.parametrize(
    ("model", "tolerance"),
    [
        # small strain on a grid is exact; the block has 32 columns in the shorter wave
        (DirectContact(periodic=True), 1e-6),
        (Chain(HalfPlane()), 1e-6),
        (BlockOnProfile(periodic=True), 0.02),
    ],
)
def test_the_share_is_that_of_the_closed_form(model, tolerance):
    answer = model.predict(RUBBER, surface(), LOAD)
    assert answer.prediction_status == "converged"
    assert float(answer.total_contact_fraction) == pytest.approx(1.0)
    found = extrapolation_of(answer)
    assert 0.2 < closed_form() < 0.8
    assert found.share == pytest.approx(closed_form(), rel=tolerance)
    assert (found.below, found.above) == (0.0, pytest.approx(math.log10(2.0), abs=1e-6))


def test_a_theory_tells_the_same_words():
    q = np.geomspace(1e2, 1e5, 40)
    spectrum = gs.surface.ArealSpectrum(q, 1e-18 * (q / 1e3) ** -3.6)
    found = persson(RUBBER, spectrum, pressure=1e5, speed=LOAD.speed)
    share = found.to_dataset()
    inside = found.wavelength >= 2 * np.pi * LOAD.speed / RUBBER.valid_band[1]
    beyond = 1.0 - found.running_friction[inside][-1] / found.friction
    # told to an interval of the spectrum
    assert extrapolation_of(share).share == pytest.approx(beyond, abs=0.05)
    assert set(OUTSIDE_BAND) <= set(share.data_vars)


def test_refused_extrapolation_leaves_a_point_without_totals():
    answer = Chain(HalfPlane(), extrapolate="refuse").predict(RUBBER, surface(), LOAD)
    assert math.isnan(answer.total_friction)
    assert "wave 2 of 2 (wavelength 1 mm) excites the rubber" in str(
        answer.prediction_status.item()
    )
    with pytest.raises(ExtrapolationError, match="above the measured band"):
        gs.solve_chain(RUBBER, SINES, pressure=2e6, speed=0.1, footprint=0.1, extrapolate="refuse")
    slow = Chain(HalfPlane(), extrapolate="refuse").predict(RUBBER, surface(), Load(2e6, 0.02, 0.1))
    assert slow.prediction_status == "converged"


def test_nothing_is_excited_at_rest():
    rest = Load(LOAD.pressure, 0.0, LOAD.footprint)
    for model in (DirectContact(periodic=True), Chain(HalfPlane())):
        found = extrapolation_of(model.predict(RUBBER, surface(), rest))
        assert (found.share, found.below, found.above) == (0.0, 0.0, 0.0)
