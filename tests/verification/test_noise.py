"""White noise added to measured profiles: what it does to the contact, and what is stated."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core import Severity
from gripscale.surface import Profile
from gripscale.surface.plausibility import noise_finding, sensor_noise
from studies.shipped import road, tread
from tests.samples import ROOT

pytestmark = pytest.mark.verification

CUT_OFF = 1e-4
SURFACES = ROOT / "examples" / "data" / "surfaces"


def with_noise(line: Profile, rms: float) -> Profile:
    return replace(line, z=line.z + rms * np.random.default_rng(3).standard_normal(len(line)))


@pytest.mark.parametrize("station", [0, 1])
def test_what_noise_changes_is_stated(station: int) -> None:
    """Of the sign and at most the size of the change; a doubt where it is 5 % or more."""
    rubber, line = tread(), road(station)

    def contact(profile: Profile) -> np.ndarray:
        load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": CUT_OFF}
        solved = gs.solve_rough_contact(rubber, profile, tolerance=None, **load)
        return np.array([solved.contact_fraction, solved.friction_from_dissipation])

    clean = contact(line)
    for rms in (1e-5, 2e-5, 5e-5):
        noisy = with_noise(line, rms)
        area, friction = clean / contact(noisy) - 1.0  # without the noise
        finding = noise_finding([noisy], CUT_OFF)
        assert finding is not None
        estimated = 1e6 * sensor_noise([noisy])[0]
        print(f"{1e6 * rms:.0f} um: {estimated:.1f} um", area, friction, finding)
        assert 0.0 < finding.area <= area
        assert friction <= finding.friction < 0.0
        assert finding.severity == Severity.DOUBT


@pytest.mark.parametrize("rms", [1e-5, 2e-5, 5e-5])
def test_noise_above_all_roughness_is_a_doubt(rms: float) -> None:
    """A line of 4 um rms and a map of 8 um."""
    line = gs.read_profile(SURFACES / "mitutoyo_2_mock.xlsx")
    noisy = with_noise(line, rms)
    whole = gs.read_map(SURFACES / "al3d-1.al3d")
    random = np.random.default_rng(1).standard_normal(whole.z.shape)
    lines = replace(whole, z=whole.z + rms * random).lines()
    for surface, cut_off in (([noisy], 1e-5), (lines, 2e-6)):
        finding = noise_finding(surface, cut_off)
        assert finding is not None
        assert finding.severity == Severity.DOUBT
        assert sensor_noise(surface)[0] == pytest.approx(rms, rel=0.15)
