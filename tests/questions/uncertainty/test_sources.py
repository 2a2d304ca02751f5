"""Each source alone: what it draws, from where to where, and what it changes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gripscale import Case, Rubber
from gripscale.chain.chain import Chain
from gripscale.core.errors import InputError
from gripscale.half_space.model import DirectContact
from gripscale.model import Load
from gripscale.questions import Range, Uncertainty
from gripscale.questions.uncertainty.sampled_inputs import Inputs, LongerLoad
from gripscale.questions.uncertainty.sampling import draws
from gripscale.questions.uncertainty.sources import SOURCES, STATED
from gripscale.rubber import WLF
from gripscale.surface import (
    HeightMap,
    Measured,
    Profile,
    SineStack,
    Surface,
    clean,
    height_difference,
)
from gripscale.theory.half_plane import HalfPlane

from .sampled import changed

SAMPLES = 40
HALF_PLANES = Chain(HalfPlane(points=64))


def alone(name, known, **given):
    """Return the draws of one source, the others left out."""
    others = [one for one in SOURCES if one != name]
    chosen = Uncertainty(without=others, ranges=given).of(known, ["chain", "direct"])
    return list(draws(Inputs.of(known), chosen.sources, SAMPLES, 0))


def told(drawn, name):
    return np.array([one.coordinates[name] for one in drawn])


@pytest.mark.parametrize(
    ("name", "coordinate", "low", "high"),
    [
        ("bulk_modulus", "bulk_modulus", 2e9 / 1.5, 2e9 * 1.5),
        ("load_time", "load_time_factor", 0.5, 2.0),
        ("cut_off", "cut_off", 1e-3 / math.sqrt(2), 1e-3 * math.sqrt(2)),
    ],
)
def test_a_range_is_spread_evenly_in_its_logarithm(known, name, coordinate, low, high):
    """One sample lies in each fortieth."""
    values = np.log(told(alone(name, known), coordinate))
    places = (values - math.log(low)) / math.log(high / low) * SAMPLES
    assert sorted(np.floor(places)) == list(range(SAMPLES))


def test_the_cut_off_ends_the_waves_and_the_roughness(known):
    for one in alone("cut_off", known)[:4]:
        surface, _ = one.inputs.for_model(HALF_PLANES)
        assert surface.sines.wavelength[-1] == pytest.approx(one.coordinates["cut_off"])
        measured, _ = one.inputs.for_model(DirectContact())
        assert measured.cutoff_wavelength == pytest.approx(one.coordinates["cut_off"])


def test_the_bulk_modulus_is_that_of_the_rubber(known):
    for one in alone("bulk_modulus", known)[:4]:
        assert one.inputs.rubber.bulk_modulus == one.coordinates["bulk_modulus"]
        assert one.inputs.rubber.equilibrium_modulus == known.rubber.equilibrium_modulus


def test_the_equilibrium_modulus_has_no_default_and_is_taken_as_given(known):
    with pytest.raises(InputError, match="no source of uncertainty is left"):
        alone("equilibrium_modulus", known)
    drawn = alone("equilibrium_modulus", known, equilibrium_modulus="4 MPa:8 MPa")
    moduli = [one.inputs.rubber.equilibrium_modulus for one in drawn]
    assert min(moduli) > 4e6
    assert max(moduli) < 8e6
    assert np.median(moduli) == pytest.approx(math.sqrt(32.0) * 1e6, rel=0.02)


def test_moduli_vary_the_rubber_about_the_fitted_one(known):
    drawn = alone("modulus", known)
    logs = told(drawn, "modulus_largest_wave")
    assert 0.001 < logs.std() < 0.05
    assert abs(logs.mean()) < 0.03
    assert len({one.inputs.rubber.equilibrium_modulus for one in drawn}) == SAMPLES


def test_profiles_vary_the_correlation_and_the_lines(known):
    one = alone("profile", known)[0]
    assert one.inputs.correlation is not known.surface.correlation
    measured, _ = one.inputs.for_model(DirectContact())
    assert not np.array_equal(measured.measured.cleaned[0].z, known.surface.measured.followed[0].z)


def test_temperature_and_pressure_are_normal_about_the_case(known):
    rubber = replace(known.rubber, reference_temperature=293.15, shift=WLF(8.0, 120.0))
    shifted = changed(known, measured_rubber=replace(known.measured_rubber, rubber=rubber))
    drawn = alone("temperature", shifted, temperature="2 K")
    conditions = [one.inputs.for_model(DirectContact())[1].conditions for one in drawn]
    # the ends of forty draws scatter
    assert np.std([each.temperature for each in conditions]) == pytest.approx(2.0, rel=0.15)
    assert np.mean([each.temperature for each in conditions]) == pytest.approx(293.15, abs=0.1)
    drawn = alone("pressure", known, pressure="3 %")
    same = told(alone("pressure", known, pressure="0.09 bar"), "log_pressure")
    assert same == pytest.approx(told(drawn, "log_pressure"))
    for model in (HALF_PLANES, DirectContact()):
        loads = [one.inputs.tasks(model, [Load(3e5, 0.3, 0.1)])[0].load for one in drawn]
        logs = np.log([load.pressure / 3e5 for load in loads])
        assert np.std(logs) == pytest.approx(0.03, rel=0.15)


def test_noise_is_added_to_the_profiles_before_they_are_cleaned(spiky):
    size = 2e-5
    one = alone("height_noise", spiky, height_noise=size)[0]
    for (raw, cleaned), noisy, clean_line in zip(
        spiky.surface.measured.profiles, one.inputs.raw(), one.inputs.cleaned.profiles, strict=True
    ):
        change = noisy.z - raw.z
        assert np.nanstd(change) == pytest.approx(size, rel=0.1)
        assert abs(np.corrcoef(change[:-1], change[1:])[0, 1]) < 0.1  # of 2000 heights
        # spikes are found anew, near those of the measurement
        assert np.isnan(clean_line.z).sum() == pytest.approx(np.isnan(cleaned.z).sum(), rel=0.3)
    chosen = Uncertainty(ranges={"height_noise": size}).of(spiky, ["direct"]).sources
    before_cleaning = [each for each in chosen if each.name in ("height_noise", "cleaning")]
    lines = [
        next(draws(Inputs.of(spiky), drawn, 1, 0)).inputs.cleaned.profiles[0]
        for drawn in (before_cleaning, before_cleaning[1:])
    ]
    # at the same limit of spikes
    assert np.nanstd(lines[0].z - lines[1].z) == pytest.approx(size, rel=0.1)


def test_standard_errors_have_no_default(known):
    left_out = Uncertainty().of(known, ["direct"]).left_out
    for name in STATED:
        assert f"{SOURCES[name].label}: standard error not stated" in left_out
    with pytest.raises(InputError, match="nothing to draw: the rubber has no temperature shift"):
        alone("temperature", known, temperature="2 K")
    for name in ("height_noise", "pressure"):
        with pytest.raises(InputError, match=f"{name}: '1:2'"):
            alone(name, known, **{name: "1:2"})


def test_waves_are_stacks_as_good(known):
    drawn = alone("waves", known)
    assert len(set(told(drawn, "waves"))) > 2
    for one in drawn[:4]:
        surface, _ = one.inputs.for_model(HALF_PLANES)
        assert len(surface.sines) == one.coordinates["waves"]
        assert surface.sines.wavelength[0] == pytest.approx(one.coordinates["first_wavelength"])
        assert surface.sines.wavelength[-1] == pytest.approx(1e-3)
    assert set(told(alone("waves", known, waves="5,6"), "waves")) == {5.0, 6.0}
    with pytest.raises(InputError, match="must be among the numbers that follow C_z"):
        alone("waves", known, waves=24)


@pytest.mark.parametrize("load_time", ["passage", 0.4])
def test_longer_loads_reach_the_solver(known, load_time):
    """Whatever load time the case states; not the direct contact, which has none."""
    load = Load(3e5, 0.3, 0.1, load_time)
    inputs = replace(Inputs.of(known), load_time_factor=1.5)
    tasks = [inputs.tasks(model, [load])[0] for model in (HALF_PLANES, DirectContact())]
    assert isinstance(tasks[0].load, LongerLoad)
    assert tasks[1].load == load
    longer, usual = (
        HALF_PLANES.solve(known.rubber, known.surface.sines, each).scales[0].load_time
        for each in (tasks[0].load, load)
    )
    assert longer == pytest.approx(1.5 * usual)


STEPS = {100: 2.0, 400: 2.0, 700: 5.0, 1000: 9.5}
"""Jumps between neighbours of `spiky`, in steps, by the number of the first."""


@pytest.fixture(scope="module")
def spiky(known):
    """Return what is known of the road with jumps, cleaned as in a case with the usual limit."""
    line = known.surface.measured.followed[0]
    z = line.z.copy()
    for at, slope in STEPS.items():
        # between its neighbours, but for the jump
        z[at + 1 :] += slope * line.step - (z[at + 1] - z[at])
    raw = replace(line, z=z)
    options = {"spikes": "iso13473", "spike_slope": 3.0, "detrend": "none"}
    measured = Measured([(raw, clean(raw, **options)[0])], [], None, "")
    correlation = height_difference(measured.cleaned)
    surface = replace(known.surface, measured=measured, correlation=correlation)
    return changed(known, surface=surface, cleaning=options)


def test_cleaning_marks_other_spikes_and_fills_gaps_in_both_ways(spiky):
    drawn = alone("cleaning", spiky)
    slopes = 3.0 * np.exp(told(drawn, "spike_slope"))
    assert 1.5 < slopes.min() < 2.0
    assert 9.5 > slopes.max() > 8.0
    assert len(set(slopes.round(9))) == 8, "the profiles are cleaned once for each limit"
    assert set(told(drawn, "smooth_gaps")) == {0.0, 1.0}
    gaps = spiky.surface.measured.cleaned[0].z
    assert set(np.flatnonzero(np.isnan(gaps))) == {700, 701, 1000, 1001}
    for one, slope in zip(drawn, slopes, strict=True):
        marked = {at for at, jump in STEPS.items() if jump >= slope}
        line = one.inputs.cleaned.profiles[0]
        assert marked <= set(np.flatnonzero(np.isnan(line.z)))
        assert np.isfinite(line.z[list(STEPS.keys() - marked)]).all()
        (solved,) = one.inputs.measured.cleaned
        smooth = bool(one.coordinates["smooth_gaps"])
        assert np.isnan(solved.z).any() != smooth
        kept = np.isfinite(line.z)
        np.testing.assert_array_equal(solved.z[kept], line.z[kept])


def test_cleaning_reaches_correlation_blocks_and_contact(spiky):
    """With a limit of 1.8 the jump of two steps is gone from the blocks, with 9 it is not."""
    both = Uncertainty(without=["waves"], ranges={"cleaning": "1.8,9"}).of(spiky, ["direct"])
    sources = [source for source in both.sources if source.name in ("cleaning", "profile")]
    drawn = list(draws(Inputs.of(spiky), sources, 12, 0))
    for one in drawn:
        strict = one.coordinates["spike_slope"] < 0.0
        steepest = max(
            np.nanmax(np.abs(np.diff(line.z))) / line.step
            for line in one.inputs.blocks[0].lines(one.inputs.blocks[1])
        )
        assert steepest < 1.8 if strict else steepest < 9.0
    strict, loose = (
        next(one for one in drawn if (one.coordinates["spike_slope"] < 0.0) == wanted)
        for wanted in (True, False)
    )
    shortest = [one.inputs.cleaned.correlation.value[0] for one in (strict, loose)]
    assert shortest[0] < shortest[1]
    # the same blocks of the road as the case cleans it have another correlation
    as_cleaned = draws(Inputs.of(spiky), sources[1:], 12, 0)
    pairs = zip(drawn, as_cleaned, strict=True)
    assert any(a.inputs.correlation.value[0] != b.inputs.correlation.value[0] for a, b in pairs)


def test_cleaning_has_nothing_to_draw_where_nothing_is_cleaned(spiky, known):
    left = changed(spiky, cleaning={**spiky.cleaning, "spikes": None})
    with pytest.raises(InputError, match="no source of uncertainty is left"):
        alone("cleaning", left)
    assert alone("cleaning", left, cleaning="2:4"), "a stated range asks for it"
    with pytest.raises(InputError, match="no source of uncertainty is left"):
        alone("cleaning", changed(known, cleaning={}))


def test_leaving_out_a_source_changes_no_draw_of_the_others(known):
    without = alone("cut_off", known)
    chosen = Uncertainty(without=["waves"]).of(known, ["chain"])
    both = list(draws(Inputs.of(known), chosen.sources, SAMPLES, 0))
    np.testing.assert_array_equal(told(without, "cut_off"), told(both, "cut_off"))


def test_waves_by_hand_and_a_named_rubber_leave_what_they_leave():
    stack = SineStack(np.array([0.01, 0.002]), np.array([5e-4, 1e-4]))
    known = Case(Surface(stack, "by hand"), Rubber(6e6), pressure=3e5, speed=0.3)
    chosen = Uncertainty().of(known, ["chain"])
    assert [source.name for source in chosen.sources] == ["bulk_modulus", "load_time"]
    assert len(chosen.left_out) == len(SOURCES) - 2


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"without": ["cutoff"]}, "did you mean cut_off"),
        ({"ranges": {"profile": 3}}, "drawn from what was measured"),
        ({"ranges": {"grid": 3}}, "drawn from its estimate"),
        ({"ranges": {"waves": 3}, "without": ["waves"]}, "got both"),
        ({"block_length": 0.0}, "block_length"),
    ],
)
def test_choices_that_cannot_be(wrong, said):
    with pytest.raises(InputError, match=said):
        Uncertainty(**wrong)


@pytest.mark.parametrize(
    "given", ["1 mm:2 mm", "1 GPa:2 GPa:3 GPa", "3 GPa:1 GPa", "much", [1e9, -1.0], ""]
)
def test_ranges_that_cannot_be(known, given):
    with pytest.raises(InputError, match="bulk_modulus"):
        alone("bulk_modulus", known, bulk_modulus=given)


def test_values_of_a_list_are_equally_likely():
    found = [Range((1.0, 2.0, 4.0), between=False).at(place) for place in (0.1, 0.5, 0.9)]
    assert found == [1.0, 2.0, 4.0]


def test_the_direct_contact_of_a_map_is_refused_at_the_start_where_blocks_are_drawn(known):
    """One sentence before anything is solved; the chain draws blocks of its lines."""
    line = known.surface.measured.followed[0]
    across = np.arange(16) * line.step
    heights = HeightMap(line.x, across, np.repeat(line.z[:, None], across.size, axis=1))
    on_map = changed(known, surface=replace(known.surface, measured=Measured.of(heights)))
    said = "the direct contact of a map has no blocks of profiles to draw; leave out the source"
    for models in (["direct"], ["chain", "direct"]):
        with pytest.raises(InputError, match=said):
            Uncertainty().of(on_map, models)
        kept = Uncertainty(without=["profile"]).of(on_map, models)
        assert "profile" not in {source.name for source in kept.sources}
    assert "profile" in {source.name for source in Uncertainty().of(on_map, ["chain"]).sources}


def test_profiles_without_a_block_each_are_refused_at_the_start(known):
    """Twelve profiles of a largest wave each hold fewer blocks of two waves than profiles."""
    wave = float(known.surface.sines.wavelength[0])
    line = known.surface.measured.followed[0]
    points = int(wave / line.step)
    short = [Profile(line.x[:points], line.z[k : k + points]) for k in range(12)]
    cut = changed(known, surface=replace(known.surface, measured=Measured.of(short)))
    choice = Uncertainty(block_length=2.0 * wave)
    with pytest.raises(InputError, match="12 profiles must hold a block each"):
        choice.of(cut, ["direct"])
    assert choice.of(cut, ["chain"]).sources
