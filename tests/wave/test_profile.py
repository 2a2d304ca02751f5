"""The finite-strain block on one period of sampled heights: known sines and the half-plane."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave import SampledProfile, WaveLoad, WaveProblem
from tests.samples import FAST_RUBBER as RUBBER
from tests.verification.families import tread

WAVE = {"wavelength": 1e-3, "amplitude": 1.5e-4}
MESH = {"columns": 64, "rows": 14}
PERIOD = 38.4e-3


def sine(points=48, shift=0.0):
    """Samples of the wave, moved by `shift` wavelengths."""
    x = WAVE["wavelength"] * np.arange(points) / points
    phase = 2.0 * np.pi * (x / WAVE["wavelength"] - shift)
    return gs.Profile(x, WAVE["amplitude"] * np.cos(phase))


def sum_of_sines(waves, points=512):
    """Profile of (number, amplitude [m], phase [rad]) over one period of 38.4 mm."""
    angle = 2.0 * np.pi * np.arange(points) / points
    z = sum(a * np.cos(n * angle + phase) for n, a, phase in waves)
    return gs.Profile(PERIOD * angle / (2.0 * np.pi), z)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_a_sampled_sine_is_the_sine(order, speed):
    """To round-off: the residual, where Newton stops, is the same in both."""
    load = {"pressure": 1e6, "speed": speed, "element_order": order, **MESH}
    one = gs.solve_scale(RUBBER, **WAVE, **load)
    sampled = gs.solve_profile(RUBBER, sine(), periodic=True, **load)
    assert one.converged
    assert sampled.converged
    assert sampled.contact_fraction == pytest.approx(one.contact_fraction, abs=1e-9)
    assert sampled.friction == pytest.approx(one.friction, abs=1e-9)
    assert sampled.wavelength == pytest.approx(one.wavelength, rel=1e-12)
    assert sampled.amplitude == pytest.approx(one.amplitude, rel=1e-12)
    assert sampled.model == one.model
    assert sampled.details["smallest_wavelength"] == pytest.approx(1e-3)
    np.testing.assert_allclose(sampled.pressure, one.pressure, atol=1.0)


def test_where_the_profile_starts_does_not_matter():
    """By whole columns to round-off; between them by what the mesh leaves open.

    Both edges of a contact together are known to 0.15 of the node spacing: 0.0023 at 64 columns.
    """
    load = {"pressure": 1e6, "speed": 1.0, "periodic": True, **MESH}
    first = gs.solve_profile(RUBBER, sine(), **load)
    on_nodes = gs.solve_profile(RUBBER, sine(shift=5 / 64), **load)
    assert on_nodes.contact_fraction == pytest.approx(first.contact_fraction, abs=1e-6)
    assert on_nodes.friction == pytest.approx(first.friction, abs=1e-6)
    between = gs.solve_profile(RUBBER, sine(shift=5.4 / 64), **load)
    assert between.contact_fraction == pytest.approx(first.contact_fraction, abs=0.0023)
    assert between.friction == pytest.approx(first.friction, rel=0.005)
    (start, end), (later, later_end) = (r.details["contact_edges"][0] for r in (first, on_nodes))
    assert later_end - later == pytest.approx(end - start, rel=1e-6)
    assert (later - start) % 1e-3 == pytest.approx(5e-3 / 64, rel=1e-6)


CASES = [
    ([(1, 2.4e-3, 0.0), (2, 1.2e-3, 2.1)], 192),
    ([(1, 2.4e-3, 0.0), (4, 6e-4, 1.0)], 256),
    ([(1, 2.4e-3, 0.0), (2, 1.0e-3, 4.0), (5, 4.0e-4, 1.0)], 256),
]


@pytest.mark.parametrize(("waves", "columns"), CASES)
def test_several_waves_at_once_are_near_the_half_plane(waves, columns):
    """Slopes to 0.8 with a tenth of the period in contact: finite strain is worth 2 % at most."""
    load = {"pressure": 3e5, "speed": 0.3}
    profile = sum_of_sines(waves)
    block = gs.solve_profile(tread(), profile, periodic=True, columns=columns, **load)
    plane = gs.solve_rough_contact(tread(), profile, periodic=True, tolerance=2e-3, **load)
    assert block.converged
    assert block.contact_fraction == pytest.approx(plane.contact_fraction, rel=0.03)
    assert block.friction == pytest.approx(plane.friction, rel=0.03)


@pytest.mark.parametrize("seed", range(6))
def test_the_work_of_friction_is_the_energy_lost(seed):
    """Random sums of 2 to 4 sines, slopes near 0.2 each: within 3 % at 20 columns a wave."""
    random = np.random.default_rng(seed)
    numbers = [1, 2, 5, 9][: 2 + seed % 3]
    waves = [(n, 1.2e-3 / n, random.uniform(0.0, 2.0 * np.pi)) for n in numbers]
    one = gs.solve_profile(
        tread(), sum_of_sines(waves), periodic=True, columns=192, pressure=3e5, speed=0.3
    )
    assert one.converged
    assert one.friction > 0.03
    assert one.friction_mismatch < 0.03


def test_gaps_tilt_and_short_waves_are_taken_out():
    """A tilted cosine of 4 waves with a short ripple and a hole where it is straight.

    A cut-off of 0.4 mm leaves 2^-0.16 of the cosine and 2^-16 of the ripple.
    """
    x = np.linspace(0.0, 4e-3, 4 * 96, endpoint=False)
    z = 1e-4 * np.cos(2.0 * np.pi * x / 1e-3)
    dirty = z + 0.005 * x + 2e-6 * np.cos(2.0 * np.pi * x / 1e-4)
    dirty[[23, 25]] = np.nan
    load = {"pressure": 1e6, "speed": 1.0, "columns": 128, "rows": 10}
    left = gs.Profile(x, 2.0**-0.16 * z)
    clean = gs.solve_profile(RUBBER, left, periodic=True, **load)
    taken = gs.solve_profile(RUBBER, gs.Profile(x, dirty), smallest_wavelength=4e-4, **load)
    assert taken.wavelength == pytest.approx(4e-3)
    assert taken.details["missing_share"] == pytest.approx(2 / 384)
    assert taken.details["smallest_wavelength"] == pytest.approx(4e-4)
    # The bridged holes are 1e-6 m wrong at most on 1 % of the points; the ripple moves the line
    # through the end points by 4e-7 m from one end to the other.
    assert taken.amplitude == pytest.approx(clean.amplitude, rel=3e-3)
    assert taken.contact_fraction == pytest.approx(clean.contact_fraction, abs=2e-3)
    assert len(taken.details["contact_edges"]) == 4


def test_columns_follow_the_smallest_wave():
    rough = sum_of_sines([(1, 1e-3, 0.0), (10, 1e-5, 0.0)])
    one = gs.solve_profile(RUBBER, rough, periodic=True, pressure=3e5, speed=0.0)
    assert (one.details["columns"], one.details["rows"]) == (128, 20)


NOISY = gs.Profile(1e-5 * np.arange(2000), 1e-6 * np.random.default_rng(0).normal(size=2000))
RIPPLE = gs.Profile(1e-5 * np.arange(400), 1e-5 * np.sin(0.2 * np.pi * np.arange(400)))
REFUSED = [
    ({"profile": np.zeros(20)}, "profile must be a gripscale.Profile; got ndarray"),
    ({"smallest_wavelength": 0.05}, "smallest_wavelength must be at most the period 0.0384 m"),
    ({"smallest_wavelength": -1.0}, "smallest_wavelength must be greater than zero"),
    ({"columns": 16}, "columns must be at least 30 to follow the smallest wave of the heights"),
    ({"columns": 5000}, "columns must be a whole number from 4 to 4096; got 5000"),
    ({"pressure": 0.0}, "pressure must be greater than zero"),
    ({"profile": NOISY}, r"at least 2\.93e-05 m, 6 of 4096 columns; got waves down to 2e-05 m"),
    (
        {"profile": RIPPLE, "smallest_wavelength": 1e-3},
        "profile must have waves left without its tilt",
    ),
]


@pytest.mark.parametrize(("change", "sentence"), REFUSED)
def test_bad_input_is_named(change, sentence):
    good = {"profile": sum_of_sines(CASES[2][0]), "pressure": 3e5, "speed": 0.3, "periodic": True}
    with pytest.raises(gs.InputError, match=sentence):
        gs.solve_profile(RUBBER, **(good | change))


@pytest.mark.parametrize(
    ("wavelength", "heights", "sentence"),
    [
        (1e-3, np.zeros(7), "heights must be at least 8; got 7"),
        (1e-3, np.full(9, 0.5), "heights must differ; got 9 times 0.5 m"),
        (1e-3, np.full(9, np.nan), "heights must be a list of finite numbers"),
        (0.0, np.arange(9.0), "wavelength must be greater than zero"),
    ],
)
def test_heights_that_are_no_profile_are_refused(wavelength, heights, sentence):
    with pytest.raises(gs.InputError, match=sentence):
        SampledProfile(wavelength, heights)


def test_the_half_plane_model_refuses_sampled_heights():
    problem = WaveProblem(RUBBER, SampledProfile(1e-3, sine().z), WaveLoad(1e5, 1.0))
    with pytest.raises(gs.InputError, match=r"profile must be a Sine .* got a SampledProfile"):
        HalfPlane().solve(problem)


def self_affine(waves, slope):
    """Waves of the same slope each, at random phases."""
    random = np.random.default_rng(7)
    numbers = np.arange(1, waves + 1)
    amplitudes = slope * PERIOD / (2.0 * np.pi * numbers)
    return sum_of_sines(zip(numbers, amplitudes, random.uniform(0.0, 6.28, waves), strict=True))


def test_rows_that_grow_gently_are_enough():
    """Below 0.1 % in friction and 0.3 % in area, where twice the columns change 1 % and more."""
    load = {"pressure": 3e5, "speed": 0.3, "periodic": True, "columns": 512}
    one = gs.solve_profile(tread(), self_affine(32, 0.06), **load)
    more = gs.solve_profile(tread(), self_affine(32, 0.06), rows=80, **load)
    assert (one.details["rows"], more.details["rows"]) == (40, 80)
    assert one.friction == pytest.approx(more.friction, rel=1e-3)
    assert one.contact_fraction == pytest.approx(more.contact_fraction, rel=3e-3)


@pytest.mark.verification
def test_a_profile_too_rough_for_its_columns_says_what_it_carried():
    load = {"pressure": 1e6, "speed": 0.3, "periodic": True, "columns": 128}
    one = gs.solve_profile(tread(), self_affine(20, 2.0), **load)
    assert one.status == "profile too rough"
    carried = one.details["smallest_wave_carried"]
    assert PERIOD / 20 < carried < PERIOD
    assert one.why == (
        f"profile too rough for 128 columns: solved with waves down to {carried:.2g} m only; "
        "leave out shorter waves, or take more columns"
    )
    smooth = gs.solve_profile(tread(), self_affine(20, 2.0), smallest_wavelength=carried, **load)
    assert smooth.details["load_reached"] == 1.0
