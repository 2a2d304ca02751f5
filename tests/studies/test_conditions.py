"""The study of conditions: what it says of slow sliding, on a part of the road."""

import gripscale as gs
from studies.conditions import HEAT, LOAD, LOW, by_heat, line_of_road, shifted_tread


def test_heat_does_next_to_nothing_to_a_slow_direct_contact():
    """0.5 % of friction at 0.1 mm/s, and not nothing at all."""
    rubber, line = shifted_tread(), line_of_road(4096)

    def direct(speed, conditions):
        return gs.solve_rough_contact(rubber, line, speed=speed, conditions=conditions, **LOAD)

    cold, hot = by_heat(direct, LOW)
    assert hot.conditions == HEAT
    assert hot.surface_warming.max() > 0.01
    assert 1e-5 < abs(hot.friction / cold.friction - 1.0) < 5e-3
