"""The law from lines to their surface: its statistic, its limits, and one map it never saw."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions.conditions import Conditions, RubberByScale
from gripscale.core.errors import InputError
from gripscale.half_space import DirectContact, line_to_map
from gripscale.half_space.line_to_map import finite_over_small, pressure_over_modulus
from gripscale.half_space.response import HalfSpace
from gripscale.model import Load
from gripscale.rubber.softening import softening_of_sweeps
from gripscale.rubber.strain_sweeps import StrainSweep
from gripscale.surface import SineStack, Surface
from gripscale.surface.surface import with_single_measurement
from tests.verification.families import tread

WAVE = 0.01
RUBBER = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)


def under_load(profile):
    """The line with waves of 10 mm at most under a load."""
    load = {"largest_wavelength": WAVE, "pressure": 1e5, "speed": 0.3}
    return line_to_map.line_under_load(profile, RUBBER, **load)


def upper_height(profile):
    return float(under_load(profile).upper_height)


def test_upper_height_of_known_distributions():
    random = np.random.default_rng(0)
    x = 1e-4 * np.arange(200_000)
    for heights, known in (
        (random.standard_normal(x.size), 2.326),  # normal quantile of 0.99
        (random.random(x.size), 0.49 * math.sqrt(12.0)),
        (-random.exponential(size=x.size), 1.0 + math.log(0.99)),
    ):
        # the 99 % quantile of 1,600 values a piece scatters by 4 %; of 125 pieces by 0.4 %
        assert upper_height(gs.Profile(x, heights)) == pytest.approx(known, abs=0.03)


def test_tail_of_known_distributions():
    random = np.random.default_rng(2)
    x = 1e-4 * np.arange(200_000)
    for heights, tail in (
        (random.random(x.size), 0.015 * math.sqrt(12.0)),
        (random.standard_normal(x.size), 2.576 - 2.054),  # normal quantiles
        (random.exponential(size=x.size), math.log(4.0)),
    ):
        # 125 pieces of 1,600 values: the ends of the tail scatter by 8 % of it a piece
        assert under_load(gs.Profile(x, heights)).tail == pytest.approx(tail, rel=0.05)


def test_trends_gaps_and_offsets_do_not_count():
    random = np.random.default_rng(1)
    x = 1e-4 * np.arange(64_000)
    z = 1e-3 * random.standard_normal(x.size)
    plain = upper_height(gs.Profile(x, z))
    long_wave = 0.05 * np.sin(2.0 * np.pi * x / x[-1])
    steps = np.where(np.arange(x.size) < 32_000, 0.0, 1.0)
    assert upper_height(gs.Profile(x, z + steps)) == pytest.approx(plain)
    assert upper_height(gs.Profile(x, z + 0.02 * long_wave)) == pytest.approx(plain, rel=0.02)
    z[::7] = np.nan
    assert upper_height(gs.Profile(x, z)) == pytest.approx(plain, rel=0.02)
    with pytest.raises(InputError, match="two different heights"):
        upper_height(gs.Profile(x, np.zeros(x.size)))


def test_reach_is_one_at_the_end_of_the_fit():
    most_t, most_tail = line_to_map.FITTED_TO
    inside = line_to_map.LineUnderLoad(0.5 * most_t, 0.5, 0.27)
    assert float(inside.reach) == pytest.approx(0.5)
    assert float(inside._replace(upper_height=most_t).reach) == pytest.approx(1.0)
    few = inside._replace(relative_load=0.5 / (2.0 * most_tail) ** 3)
    assert float(few.reach) == pytest.approx(2.0)


def test_limits():
    for line in ((1.0, 0.1, 0.3, 0.0), (2.3, 0.5, 0.01, 0.3), (4.0, 1.5, 1.0, 0.0)):
        reach = line_to_map.LineUnderLoad(*line)
        area = line_to_map.contact_fraction_ratio(reach, [1e-6, 1.0])
        assert area.ratio == pytest.approx(
            [float(line_to_map.CONTACT_FRACTION_LAW.at(reach)), 1.0], rel=1e-5
        )
        assert area.uncertainty == pytest.approx(
            [float(line_to_map.CONTACT_FRACTION_LAW.uncertainty(reach)), 0.0], abs=1e-5
        )
        friction = line_to_map.friction_ratio(reach, [1e-6, 1.0])
        assert friction.ratio == pytest.approx(
            [float(line_to_map.FRICTION_LAW.at(reach)), line_to_map.FULL_CONTACT_FRICTION]
        )
        between = line_to_map.contact_fraction_ratio(reach, np.linspace(0.01, 0.99, 50))
        on_the_surface = between.ratio * np.linspace(0.01, 0.99, 50)
        assert (np.diff(on_the_surface) > 0.0).all()


def test_relative_load_is_dimensionless():
    """Heights, waves and moduli in other units, and a load that is stated by hand."""
    x = 1e-4 * np.arange(6400)
    z = 1e-3 * np.sin(2.0 * np.pi * x / WAVE)
    load = line_to_map.line_under_load(
        gs.Profile(x, z), RUBBER, largest_wavelength=WAVE, pressure=3e5, speed=0.0
    ).relative_load
    modulus = abs(complex(RUBBER.plane_strain_modulus(0.0)))
    assert load == pytest.approx(3e5 * WAVE / (modulus * 1e-3 / math.sqrt(2.0)), rel=1e-3)


def test_softened_rubber_is_pressed_harder():
    """The modulus that counts is that of the largest wave as it slides, and what a map adds."""
    x = 1e-4 * np.arange(1024)
    line = gs.Profile(x, 3e-4 * np.sin(2.0 * np.pi * x / WAVE))
    sweep = StrainSweep([1e-3, 1e-2, 1e-1, 1.0], [2e6, 1.6e6, 1.2e6, 0.8e6], [2e5] * 4)
    softening = softening_of_sweeps([sweep], measured_at=1e-3)
    load = {"pressure": 3e5, "speed": 0.3}
    contact = gs.solve_rough_contact(
        RUBBER, line, **load, smallest_wavelength=1e-3, conditions=Conditions(softening=softening)
    )
    load["largest_wavelength"] = WAVE
    before = line_to_map.line_under_load(line, RUBBER, **load)
    softened = line_to_map.line_under_load(line, RUBBER, contact=contact, **load)
    number = 2.0 * math.pi / WAVE
    slid = contact.by_scale.complex_modulus(0.3 * number, number)
    kept = abs(complex(slid)) / abs(complex(RUBBER.complex_modulus(0.3 * number)))
    assert kept < 0.9
    # the bulk modulus, which does not soften, is in the plane-strain modulus by 1 in 1,000
    assert softened.relative_load == pytest.approx(before.relative_load / kept, rel=1e-2)
    assert softened[:2] == before[:2]
    number = 2.0 * math.pi / 1e-3
    strain = np.interp(math.log(number), np.log(contact.scales.wavenumber), contact.scales.strain)
    less, more = softening.factors(np.array([strain, 2.0 * strain])).storage
    assert (before.softening, softened.softening) == (0.0, pytest.approx(math.log(less / more)))
    assert softened.softening > 0.02


@pytest.mark.parametrize("pressure", [2e4, 3e5])
def test_a_gaussian_map_is_within_the_scatter(pressure):
    """A family that the law was not fitted to, small enough for a test."""
    shape, step, longest = (512, 128), 2e-4, 6.4e-3
    k = np.hypot(np.fft.fftfreq(shape[0], step)[:, None], np.fft.rfftfreq(shape[1], step))
    inside = (k > 0.9 / longest) & (k < 1.0 / 8e-4)
    noise = np.fft.rfft2(np.random.default_rng(5).standard_normal(shape))
    z = np.fft.irfft2(noise * np.where(inside, np.maximum(k, 1.0) ** -1.8, 0.0), shape)
    x, y = (step * np.arange(points) for points in shape)
    z *= 4e-4 / z.std()
    rubber, load = tread(), {"pressure": pressure, "speed": 0.3}
    solver = {"smallest_wavelength": 8e-4, "periodic": True, "tolerance": None}
    whole = gs.solve_rough_contact(rubber, gs.HeightMap(x, y, z), **load, **solver)
    profiles = [gs.Profile(x, z[:, at]) for at in range(0, shape[1], 4)]
    lines = [gs.solve_rough_contact(rubber, profile, **load, **solver) for profile in profiles]
    area = np.mean([line.contact_fraction for line in lines])
    friction = np.mean([line.friction_from_dissipation for line in lines])
    reach = line_to_map.line_under_load(profiles, rubber, largest_wavelength=longest, **load)
    for measured, law in (
        (whole.contact_fraction / area, line_to_map.contact_fraction_ratio(reach, area)),
        (whole.friction_from_dissipation / friction, line_to_map.friction_ratio(reach, area)),
    ):
        assert abs(math.log(measured / float(law.ratio))) < 2.0 * float(law.uncertainty)
        assert abs(math.log(measured)) > 0.02


# The law of large strain: its limits, its modulus, and what the direct contact says of it.

QUANTITIES = ("contact_fraction", "friction")
LONGEST = 28e-3


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_small_strain_has_no_factor_and_no_error(quantity):
    ratio, error = finite_over_small(quantity, 1e-9, 0.1)
    assert ratio == pytest.approx(1.0, abs=1e-7)
    assert error == pytest.approx(0.0, abs=1e-7)


def test_full_contact_keeps_its_area_and_loses_friction():
    areas = np.array([0.5, 0.99, 0.9999, 1.0])
    ratio, error = finite_over_small("contact_fraction", 2.0, areas)
    assert (areas * ratio <= 1.0).all()
    assert error[-1] == 0.0
    assert finite_over_small("friction", 1.0, 1.0)[0] < 0.9


def test_harder_pressed_rubber_has_more_area_less_friction_and_a_wider_error():
    pressed = np.array([0.01, 0.1, 0.5])
    for quantity, sign in zip(QUANTITIES, (1.0, -1.0), strict=True):
        ratio, error = finite_over_small(quantity, pressed, 0.2)
        assert (sign * np.diff(ratio) > 0.0).all()
        assert (np.diff(error) > 0.0).all()


def test_modulus_is_of_a_seventh_of_the_largest_wave_and_softened():
    speed, pressure = 0.3, 3e5
    omega = 2.0 * math.pi * speed / 4e-3
    as_measured = pressure_over_modulus(HalfSpace(RUBBER, speed), pressure, LONGEST)
    assert as_measured == pytest.approx(pressure / abs(complex(RUBBER.complex_modulus(omega))))
    number, even = 2.0 * math.pi / np.array([LONGEST, 1e-4]), np.ones(2)
    third = RubberByScale(RUBBER, number, even, even, even / 3.0, even / 3.0)
    softened = HalfSpace(RUBBER, speed, by_scale=third)
    assert pressure_over_modulus(softened, pressure, LONGEST) == pytest.approx(3.0 * as_measured)
    at_rest = pressure_over_modulus(HalfSpace(RUBBER, 0.0), pressure, LONGEST)
    assert at_rest == pytest.approx(pressure / 3e6)


def test_direct_contact_says_how_hard_its_rubber_is_pressed():
    x = 2e-4 * np.arange(1024)
    line = gs.Profile(x, 1e-3 * np.cos(2.0 * np.pi * x / 16e-3))
    sines = SineStack([LONGEST, 4e-3], [1e-3, 1e-4], cut_off=2e-3)
    surface = with_single_measurement(Surface(sines, "waves"), line)
    answer = DirectContact(tolerance=None).predict(RUBBER, surface, Load(3e5, 0.3, 0.1))
    expected = pressure_over_modulus(HalfSpace(RUBBER, 0.3), 3e5, LONGEST)
    assert float(answer.total_pressure_over_modulus) == pytest.approx(expected)
