"""Every wave of the shipped case against the same wave, under the same load, on a fine mesh."""

from dataclasses import replace

import pytest

from gripscale.case_file import read_case
from gripscale.wave import FiniteStrainBlock, Mesh, Sine, WaveLoad, WaveProblem
from tests.verification.families import ROOT

CASE = ROOT / "examples" / "road_and_tread" / "case.toml"
FINE = FiniteStrainBlock(Mesh(256, 30))


def again(scale):
    """Solve a wave of a prediction on the fine mesh."""
    sine = Sine(scale.wavelength, scale.amplitude)
    load = WaveLoad(scale.pressure_received, scale.speed, scale.load_time)
    return FINE.solve(WaveProblem(scale.rubber, sine, load))


@pytest.mark.verification
def test_every_wave_is_near_the_fine_mesh():
    """Friction within 0.7 %, contact fraction within 0.01, and both within their own estimates.

    The last wave at rest is about to close: there 0.01 of contact is 2 % of the pressure.
    """
    case = read_case(CASE)
    for speed in (case.load.speed, 0.0):
        load = replace(case.load, speed=speed)
        prediction = case.chain.solve(case.rubber, case.surface.sines, load)
        assert len(prediction.scales) == 8
        fine = [again(scale) for scale in prediction.scales]
        for one, finer in zip(prediction.scales, fine, strict=True):
            assert finer.converged
            area = abs(one.contact_fraction - finer.contact_fraction)
            assert area <= min(0.01, one.contact_fraction_error) + 1e-12  # rounding in full contact
            if speed > 0.0:
                friction = abs(one.friction - finer.friction)
                assert friction < min(0.007 * finer.friction, one.friction_error)
                assert one.friction_mismatch < 0.02
                # the longest wave's is 0.006, 0.001, 0.0004 with 128, 256, 384 columns
                assert finer.friction_mismatch < 0.002
        total = sum(finer.friction for finer in fine)
        assert prediction.friction == pytest.approx(total, rel=0.005, abs=1e-9)
