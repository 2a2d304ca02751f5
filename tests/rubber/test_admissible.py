"""The other series that fit: their envelope, their files, and what is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.rubber import AdmissibleSeries, Rubber, fit_prony, fit_prony_report
from gripscale.rubber.admissible import loss_shape, storage_shape
from gripscale.rubber.maxwell_fit import Curve, Prior, fit_spectrum, relaxation_times
from tests.rubber.truths import TRUTHS

SERIES = AdmissibleSeries([1e-3, 1.0], [1e6, 2e6, 1.5e6], [[1e6, 2e6], [0.0, 3e6], [4e6, 0.0]])
RUBBER = Rubber(1.2e6, [1e6, 2e6], [1e-3, 1.0], valid_band=(0.1, 1e4), admissible=SERIES)


def flank():
    truth = TRUTHS["fractional Zener"]
    return truth.measured(*truth.cut("flank"), 0.02, 0)


def test_the_band_is_the_envelope_of_the_series():
    omega = np.array([0.0, 1.0, 1e3, -1e3])
    every = [rubber.complex_modulus(omega) for rubber in (RUBBER, *RUBBER.admissible_rubbers())]
    low, high = RUBBER.complex_modulus_band(omega)
    assert low.real == pytest.approx(np.min([one.real for one in every], axis=0), rel=1e-12)
    assert high.imag == pytest.approx(np.max([one.imag for one in every], axis=0), rel=1e-12)
    assert RUBBER.complex_modulus_band(1.0)[0].shape == ()
    assert [len(one.moduli) for one in RUBBER.admissible_rubbers()] == [2, 1, 1]


def test_a_rubber_without_them_says_so():
    with pytest.raises(InputError, match=r"admissible must be the series that also fit.*my rubber"):
        Rubber(1e6, name="my rubber").complex_modulus_band(1.0)
    assert Rubber(1e6).admissible_rubbers() == []


def test_they_are_part_of_the_rubber_and_of_its_file():
    text = json.dumps(RUBBER.to_dict())
    assert Rubber.from_dict(json.loads(text)) == RUBBER
    assert hash(Rubber.from_dict(json.loads(text))) == hash(RUBBER)
    older = {key: value for key, value in RUBBER.to_dict().items() if key != "admissible"}
    assert Rubber.from_dict(older).admissible is None
    assert Rubber.from_dict(older) != RUBBER
    fitted = fit_prony(flank())
    assert Rubber.from_dict(json.loads(json.dumps(fitted.to_dict()))) == fitted


@pytest.mark.parametrize(
    "change",
    [{"moduli": [1e6, 3e6]}, {"relaxation_times": [1e-3, 2.0]}, {"equilibrium_modulus": 1.3e6}],
)
def test_they_belong_to_one_series(change):
    with pytest.raises(InputError, match=r"admissible must belong to this series; got"):
        replace(RUBBER, **change)
    assert replace(RUBBER, **change, admissible=None).admissible is None
    # what does not change the series keeps them, and series not yet given away fit any
    assert replace(RUBBER, name="x", bulk_modulus=1e9).admissible == RUBBER.admissible == SERIES
    assert replace(RUBBER, **change, admissible=SERIES).admissible == SERIES
    fitted = fit_prony(flank())
    with pytest.raises(InputError, match="leave it out"):
        replace(fitted, moduli=2.0 * fitted.moduli)
    read = Rubber.from_dict(json.loads(json.dumps(fitted.to_dict())))
    with pytest.raises(InputError, match="leave it out"):
        replace(read, moduli=2.0 * fitted.moduli)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (([1.0], [1e6], [[1e6, 1e6]]), "moduli must be 1 rows of 1 numbers"),
        (([1.0], [1e6], [[-1.0]]), r"moduli must not be negative \[Pa\]; got -1"),
        (([0.0], [1e6], [[1.0]]), "relaxation_times must be greater than zero"),
        (([1.0], [1e300], [[1.0]]), "equilibrium_moduli must be numbers of at most 1e.100"),
        (([1.0], [1e6], [["soft"]]), "moduli must be 1 rows of 1 numbers"),
    ],
)
def test_bad_series(values, message):
    with pytest.raises(InputError, match=message):
        AdmissibleSeries(*values)


@pytest.mark.parametrize("value", [{"moduli": []}, 3.0, {"a": 1}])
def test_bad_dictionaries(value):
    with pytest.raises(InputError, match="admissible must"):
        Rubber.from_dict({**RUBBER.to_dict(), "admissible": value})
    with pytest.raises(InputError, match="admissible must be an AdmissibleSeries"):
        Rubber(1e6, admissible=value)


def test_every_series_fits_as_well_as_promised():
    """None rises above the least sum of squares by more than nine, and some do reach it."""
    master = flank()
    rubber, report = fit_prony_report(master)
    scatter = [max(0.02, one) for one in (report.storage_scatter, report.loss_scatter)]
    scatter[0] = max(scatter[0], report.rms_storage)
    scatter[1] = max(scatter[1], report.rms_loss)
    modulus = rubber.admissible.complex_moduli(master.angular_frequency)
    squares = ((modulus.real / master.storage - 1.0) / scatter[0]) ** 2
    squares += ((modulus.imag / master.loss - 1.0) / scatter[1]) ** 2
    rise = squares.sum(axis=1) - squares.sum(axis=1)[0]
    # the smoothing may trade a little of its own share
    assert rise.max() < 9.5
    assert np.median(rise[1:]) > 7.0


def test_more_noise_leaves_more_open():
    truth = TRUTHS["filled"]
    low, high = truth.cut("no glass")
    widths = []
    for noise in (0.02, 0.06):
        band = fit_prony(truth.measured(low, high, noise, 1)).complex_modulus_band(
            np.array([low / 10.0, 1e3, 10.0 * high])
        )
        widths.append(band[1].real / band[0].real)
    assert (widths[1] > widths[0]).all()


def test_the_largest_modulus_is_kept_and_harmless_where_it_is_far():
    master = flank()
    curve = Curve(master.angular_frequency, master.storage, master.loss)
    times = relaxation_times(curve.omega, 10, 2.0)
    free, wide, narrow = (
        fit_spectrum(curve, times, Prior(0.1, 1.0, limit)) for limit in (1e12, 1e11, 1e8)
    )
    assert wide.moduli == pytest.approx(free.moduli, rel=1e-6)
    # of rows of weight one against 300: 1e-5 of the limit
    assert narrow.equilibrium + narrow.moduli.sum() < 1e8 * (1 + 1e-4)


@pytest.mark.parametrize("phase", [0.0, 1e-200, 1e-3, 1.0, 1e3, 1e154, 1e200])
def test_shapes_at_any_phase(phase):
    """E*/E_i = i x/(1 + i x), by complex division where that does not overflow."""
    found = complex(storage_shape(np.array(phase)), loss_shape(np.array(phase)))
    if phase <= 1e3:
        assert found == pytest.approx(1j * phase / (1 + 1j * phase), rel=1e-14, abs=1e-300)
    else:
        assert found == pytest.approx(complex(1.0, 1.0 / phase), rel=1e-6)
    assert loss_shape(np.array(-phase)) == -found.imag
