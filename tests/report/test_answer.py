"""The first lines of a result: the answer, its interval, what it rests on, or why there is none."""

from __future__ import annotations

import json
import math

import numpy as np
import xarray as xr

from gripscale.analysis.best_estimate import IsotropicSurface
from gripscale.report.answer import answer_cards, answer_lines, basis_lines


def answered(**changed: float) -> xr.Dataset:
    """Return the variables of a best estimate: friction 0.2, contact fraction 0.03."""
    numbers = {
        "nominal_pressure": 3e5,
        "nominal_speed": 0.3,
        "cutoff_wavelength": 1e-4,
        "best_friction": 0.2,
        "best_friction_half_width": math.sinh(math.log(1.25)),
        "best_friction_sampling_error": 0.03,
        "best_contact_fraction": 0.03,
        "best_contact_fraction_half_width": math.sinh(math.log(1.2)),
        "best_contact_fraction_sampling_error": 0.02,
        "best_steep_share": 0.5,
        "best_missing_share": 0.001,
        "total_friction_outside_band": 0.25,
    } | changed
    columns = {
        "factor_label": ["finite strain, assumed", IsotropicSurface.label],
        "best_friction_factor": [1.0, 0.95],
        "best_contact_fraction_factor": [1.0, 0.68],
        "best_friction_factor_uncertainty": [0.05, 0.11],
        "best_contact_fraction_factor_uncertainty": [0.03, 0.11],
    }
    return xr.Dataset(
        numbers | {name: ("factor", np.array(values)) for name, values in columns.items()},
        attrs={"display_units": json.dumps({"pressure": "bar", "speed": "m/s"})},
    )


def test_the_number_comes_first_then_what_it_rests_on() -> None:
    first, *below = answer_lines(answered())
    assert first == (
        "Answer: μ = 0.200 (0.160 to 0.250), A_r/A_0 = 0.0300 (0.0250 to 0.0360) (90 % intervals)"
    )
    text = " ".join(below)
    assert "for 3 bar and 0.3 m/s, roughness down to 0.1 mm" in text
    assert "finite strain, assumed (± 5.0 %)" in text
    assert "isotropic surface over its lines (0.950, 0.680)" in text
    assert "25 % of the friction beyond the measured frequencies" in text
    assert "50 % of the friction on slopes above 1" in text
    assert "filled gaps" not in text, "a thousandth is not worth a word"
    assert "a road without direction is assumed" in text
    assert [line.strip() for line in below] == list(basis_lines(answered()))


def test_at_rest_there_is_an_area_only() -> None:
    first, *_ = answer_lines(answered(nominal_speed=0.0, best_friction=0.0))
    assert first.startswith("Answer: A_r/A_0 = 0.0300 (")
    assert [card.value for card in answer_cards(answered(nominal_speed=0.0))] == ["0.0300"]


def test_no_answer_says_why() -> None:
    assert "No surface was measured" in next(answer_lines(None))
    failed = answered(best_contact_fraction=math.nan).assign(prediction_status="tolerance not met")
    assert list(answer_lines(failed)) == [
        "Answer: none. The direct contact of the measured surface has no result: tolerance not met."
    ]
    assert not list(answer_cards(failed))
    wide = next(answer_lines(answered(best_friction_half_width=3.0)))
    assert wide.startswith("Answer: none to rely on. μ = 0.200 (")
    short = answered(best_friction_half_width=math.nan, best_contact_fraction_half_width=math.nan)
    assert "no interval: the surface is too short" in next(answer_lines(short))
