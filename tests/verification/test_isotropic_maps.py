"""Maps made from a measured road have lines that touch as the measured ones do."""

import pytest

import gripscale as gs
from gripscale.surface import clean, read_profile
from studies.isotropic_maps.map_factor import map_over_lines
from tests.surface.surface_cases import DATA, ROAD, ROAD_ONLY

pytestmark = pytest.mark.verification

AREA, FRICTION = "contact_fraction", "friction_from_dissipation"


def test_lines_of_maps_touch_as_the_measured_lines():
    """Two maps of each construction; about a minute of processor time."""
    rubber = gs.fit_prony(gs.read_master_curve(DATA / "rubber" / "measured_dma.txt"))
    road = clean(read_profile(ROAD[0]), crop=ROAD_ONLY)[0]
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 0.4e-3}
    found = map_over_lines(rubber, road, seeds=range(2), **load)
    random = map_over_lines(rubber, road, seeds=range(2), construction="spectrum", **load)
    # six maps: 0.93 +- 0.05 and 1.10 +- 0.10 (docs/isotropic-maps.md); two scatter more
    assert found.match(AREA) == pytest.approx(1.0, abs=0.2)
    assert found.match(FRICTION) == pytest.approx(1.0, abs=0.4)
    assert random.match(AREA) < 0.5
    assert random.match(FRICTION) > 2.0
    assert found.factor(AREA) == pytest.approx(0.69, abs=0.1)
    assert found.factor(FRICTION) == pytest.approx(0.94, abs=0.25)
