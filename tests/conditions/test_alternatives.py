"""What may be true as well of conditions: one alternative for each thing that nothing states."""

from dataclasses import replace

import numpy as np
import pytest

from gripscale.conditions.conditions import (
    AMPLITUDE,
    MASTER_CURVE_STRAIN,
    TENSION_OR_SHEAR,
    Conditions,
    alternatives,
)
from gripscale.rubber.softening import SofteningTable

STRAIN = [5e-4, 1e-3, 1e-2, 1e-1]
STATED = SofteningTable(
    [STRAIN], [[10.0, 9.0, 6.0, 4.0]], [[1.0, 1.5, 2.0, 1.0]], measured_at=1e-3, deformation="shear"
)


def by_label(law):
    return {each.label: each for each in alternatives(Conditions(softening=law))}


def test_sweeps_that_state_all_have_no_alternative():
    assert not by_label(STATED)
    assert [*by_label(replace(STATED, deformation=None))] == [TENSION_OR_SHEAR]


def test_a_master_curve_of_unknown_strain_is_stiffer_if_it_was_measured_at_more():
    """At e times the usual strain: the factors, one there, are larger at every strain beyond."""
    law = replace(STATED, measured_at=None)
    other = by_label(law)[MASTER_CURVE_STRAIN].conditions.softening
    assert isinstance(other, SofteningTable)
    assert other.measured_at == pytest.approx(np.e * 1e-3)
    beyond = np.array([1e-2, 5e-2])
    ratio = other.factors(beyond).storage / law.factors(beyond).storage
    assert ratio == pytest.approx(9.0 / np.exp(np.interp(np.log(other.measured_at), *LOG)))


LOG = np.log(STRAIN), np.log([10.0, 9.0, 6.0, 4.0])


def test_strains_that_may_be_peak_to_peak_are_halved():
    """Also where the strain of the master curve is then beyond the sweep."""
    law = replace(STATED, measured_at=1e-1, amplitude_assumed=True)
    found = by_label(law)[AMPLITUDE]
    assert isinstance(found.conditions.softening, SofteningTable)
    assert list(found.conditions.softening.strain[0]) == pytest.approx([x / 2.0 for x in STRAIN])
    assert found.conditions.softening.measured_at == pytest.approx(5e-2)
    assert found.share == 0.5
