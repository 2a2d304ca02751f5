"""Maps below their measurement: what is measured stays, and how well withheld octaves are found."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.core.errors import InputError
from gripscale.half_space import ContinuedContact, FinerMeasurement, HurstExponent, map_by_cut_off
from gripscale.half_space.map_below_measurement import GROWTH_OF_MAPS
from gripscale.model import Load
from gripscale.surface import HeightMap, Measured, Surface
from gripscale.theory import ContactPressures, diffusion
from tests.samples import KRAUS
from tests.verification.families import tread
from tests.verification.gaussian_maps import LENGTH, gaussian_map

POINTS, HURST = 256, 0.8
LAST = 4 * LENGTH / POINTS
RESOLVED = 4 * LAST
LOAD = {"pressure": 1e6, "speed": 0.3}


@cache
def surface() -> HeightMap:
    """A Gaussian map whose last two octaves the instrument does not resolve."""
    return replace(gaussian_map(POINTS, HURST, 5)[0], reliable=RESOLVED)


@cache
def curve(roughness=None):
    return map_by_cut_off(
        tread(), surface(), down_to=LAST, periodic=True, roughness=roughness, **LOAD
    )


@cache
def truth():
    return gs.solve_rough_contact(
        tread(), surface(), smallest_wavelength=LAST, periodic=True, tolerance=None, **LOAD
    )


def test_the_measured_part_is_the_direct_contact():
    direct = gs.solve_rough_contact(
        tread(), surface(), smallest_wavelength=RESOLVED, periodic=True, tolerance=None, **LOAD
    )
    data = curve().to_dataset()
    assert data.cut_off.values == pytest.approx(LAST * 2.0 ** np.arange(4, -1, -1))
    assert data.measured.values.tolist() == [True, True, True, False, False]
    assert float(data.contact_fraction[2]) == direct.contact_fraction
    # threads may add up in another order
    assert float(data.friction_from_dissipation[2]) == pytest.approx(
        direct.friction_from_dissipation, rel=1e-9
    )
    assert curve().converged


@pytest.mark.parametrize("roughness", [None, HurstExponent(HURST)])
def test_two_withheld_octaves_lie_in_the_band(roughness):
    data = curve(roughness).to_dataset().isel(cut_off=-1)
    for name in ("contact_fraction", "friction_from_dissipation"):
        true = getattr(truth(), name)
        assert float(data[f"{name}_lower"]) < true < float(data[f"{name}_upper"])
    # more sharply than the band: the continuation adds a half to the friction
    start = curve().values("friction_from_dissipation")[2]
    assert truth().friction_from_dissipation > 1.4 * start
    assert float(data.friction) == pytest.approx(truth().friction_from_dissipation, rel=0.15)


def test_slopes_below_are_those_of_the_power_law():
    data = curve(HurstExponent(HURST)).to_dataset()
    slopes = data.octave_slope.values
    assert slopes[-1] / slopes[-2] == pytest.approx(2.0 ** (1.0 - HURST))
    assert data.slope_in_contact[-1] ** 2 == pytest.approx(
        data.slope_in_contact[2] ** 2 + slopes[-1] ** 2 + slopes[-2] ** 2
    )
    # of a Gaussian map the last octaves are known: that of the map, within what its waves scatter
    _, law = gaussian_map(POINTS, HURST, 5)
    expected = np.sqrt(0.5 * (law.added(LENGTH / 2 / LAST) - law.added(LENGTH / 4 / LAST)))
    assert slopes[-1] == pytest.approx(expected, rel=0.15)


def test_tens_of_octaves_in_seconds():
    data = map_by_cut_off(tread(), surface(), down_to=1e-8, periodic=True, **LOAD).to_dataset()
    assert data.sizes["cut_off"] > 20
    assert np.all(np.diff(data.contact_fraction) < 0.0)
    assert np.all(np.isfinite(data.friction))


def test_the_model_answers_with_curve_and_band():
    answer = ContinuedContact(down_to=LAST, periodic=True).predict(
        tread(), Surface(None, "", measured=Measured.of(surface())), Load(1e6, 0.3, 0.1)
    )
    last = curve().steps[-1]
    assert answer.prediction_status.item() == "converged"
    for name in ("contact_fraction", "friction", "friction_from_dissipation"):
        assert float(answer[f"total_{name}"]) == last.mean(name)
        assert answer[name].values.tolist() == [last.mean(name)]
    assert np.allclose(answer.curve_friction, curve().values("friction"))
    exponent = np.log2(curve().values("friction")[-2:])
    assert float(answer.total_friction_cut_off_exponent) == pytest.approx(exponent[0] - exponent[1])
    assert float(answer.friction_error[0]) == pytest.approx(
        np.arcsinh(0.2 * 2.0**GROWTH_OF_MAPS) / 1.645 * last.mean("friction")
    )


def test_without_octaves_below_nothing_is_continued():
    measured = map_by_cut_off(tread(), surface(), down_to=RESOLVED, periodic=True, **LOAD)
    assert measured.to_dataset().measured.all()


def test_the_law_is_the_one_diffused():
    """The last numbers are those of `diffusion` from the pressures of the last contact."""
    found = curve(HurstExponent(HURST))
    contact = found.steps[2].contacts[0]
    slope = found.steps[-1].slope
    law = gaussian_map(POINTS, HURST, 5)[1]
    second = law.added(4.0) - law.added(2.0)
    start = ContactPressures(
        contact.pressure[contact.active],
        contact.contact_fraction,
        contact.friction_from_dissipation,
        RESOLVED,
    )
    law = replace(law, growth=2.0 * slope**2 / second * law.growth)
    expected = diffusion(tread(), start, law, smallest_wavelength=LAST, **LOAD)
    assert found.values("friction")[-1] == pytest.approx(expected.friction)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"roughness": FinerMeasurement(gs.Profile(np.arange(64.0), np.zeros(64)))},
            "roughness of a map",
        ),
        ({"down_to": -1.0}, "down_to must"),
        ({"conditions": Conditions(softening=KRAUS)}, "conditions of a map"),
        ({"surface": gs.Profile(np.arange(64.0), np.zeros(64))}, "surface must"),
        ({"surface": replace(gaussian_map(64, 0.8, 1)[0], reliable=0.04)}, "2 octaves"),
    ],
)
def test_what_cannot_be_continued_is_refused(change, message):
    options = {"surface": surface(), "down_to": LAST, "periodic": True, **LOAD, **change}
    with pytest.raises(InputError, match=message):
        map_by_cut_off(tread(), options.pop("surface"), **options)
