"""The first lines of a result: the answer or why there is none, what it rests on, warnings."""

import json
import math

import numpy as np
import pytest
import xarray as xr

from gripscale.core.finding import Finding, Severity, Topic, doubt, ranked, to_json
from gripscale.questions.answer.estimate import LINES_TO_SURFACE
from gripscale.questions.answer.findings import answer_notices, case_notices, no_answer_notices
from gripscale.questions.answer.page import HYSTERESIS_ALONE, answer_cards, answer_lines
from gripscale.questions.answer.reliance import no_answer
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.result import warning_lines
from gripscale.report.elements import Page


def answered(**changed):
    """Return the variables of an answer: friction 0.2, contact fraction 0.03."""
    numbers = {
        "nominal_pressure": 3e5,
        "nominal_speed": 0.3,
        "cutoff_wavelength": 1e-4,
        "answer_friction": 0.2,
        "answer_friction_low": 0.16,
        "answer_friction_high": 0.25,
        "answer_friction_sampling_error": 0.03,
        "answer_contact_fraction": 0.03,
        "answer_contact_fraction_low": 0.025,
        "answer_contact_fraction_high": 0.036,
        "answer_contact_fraction_sampling_error": 0.02,
        "answer_steep_share": 0.5,
        "answer_missing_share": 0.06,
        "total_friction": 0.2,
        "total_friction_from_dissipation": 0.2,
        "total_friction_outside_band": 0.25,
        "total_decades_below_band": 0.0,
        "total_decades_above_band": 2.3,
    } | changed
    columns = {
        "factor_label": ["large strain", LINES_TO_SURFACE],
        "answer_friction_factor": [1.0, 0.95],
        "answer_contact_fraction_factor": [1.0, 0.68],
        "answer_friction_factor_uncertainty": [0.05, 0.11],
        "answer_contact_fraction_factor_uncertainty": [0.03, 0.11],
    }
    return xr.Dataset(
        numbers | {name: ("factor", np.array(values)) for name, values in columns.items()},
        attrs={"display_units": json.dumps({"pressure": "bar", "speed": "m/s"})},
    )


def test_at_rest_there_is_an_area_only():
    first, *below = answer_lines(answered(nominal_speed=0.0, answer_friction=0.0))
    assert first.startswith("Answer: no friction at rest; A_r/A_0 = 0.0300 (")
    assert not any("ysteresis" in line for line in below)
    assert [card.value for card in answer_cards(answered(nominal_speed=0.0))] == ["0.0300"]


def test_with_an_area_term_the_friction_is_the_sum_with_its_parts():
    total = {"": 0.9, "_low": 0.7, "_high": 1.2}
    data = answered(
        answer_hysteresis_friction=0.2,
        answer_interface_friction=0.7,
        **{f"answer_friction{end}": v for end, v in total.items()},
    )
    first, *below = answer_lines(data)
    assert HYSTERESIS_ALONE not in " ".join(below)
    parts = "0.200 of hysteresis and 0.700 of the area term"
    assert first == (
        f"Answer: μ = 0.900 (0.700 to 1.20): {parts}; A_r/A_0 = 0.0300 (0.0250 to 0.0360) "
        "(90 % intervals)"
    )
    friction, _ = answer_cards(data)
    assert (friction.value, friction.detail) == ("0.900", f"answer; {parts}")
    assert friction.interval == "0.700 to 1.20 (90 %)"


def test_no_answer_says_why():
    failed = answered(answer_contact_fraction=math.nan).assign(
        prediction_status="tolerance not met"
    )
    assert list(answer_lines(failed)) == [
        "Answer: none. The direct contact of the measured surface has no result: tolerance not met."
    ]
    assert not list(answer_cards(failed))
    assert not no_answer(answered())


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"answer_friction_high": 0.41}, "The ends of the interval are more than a factor"),
        (
            dict.fromkeys(("answer_friction_low", "answer_contact_fraction_low"), math.nan),
            "The measured surface is too small to tell whether it stands for the whole:",
        ),
        ({"answer_line_reach": 1.1}, "So few summits of the profiles carry that the step"),
        ({"answer_missing_share": 0.51}, "51 % of the contact lies on filled gaps"),
        (
            {"total_friction_outside_band": 0.89},
            "89 % of the friction lies up to 2.3 decades above the measured band.",
        ),
    ],
)
def test_a_guess_is_called_one_before_its_numbers(changed, why):
    data = answered(**changed)
    first = next(answer_lines(data))
    assert first.startswith(f"Answer: none to rely on. {why}")
    assert first.index(" It would be hysteresis friction μ = 0.200") > len(why)
    assert all(card.bad for card in answer_cards(data))
    (notice,) = no_answer_notices(data)
    assert (notice.severity, why in notice.sentence) == ("error", True)
    assert not any(why in other.sentence for other in answer_notices(data)), "it is said once"


def test_warnings_stand_by_what_they_change():
    """Half the cut-off: 0.2 becomes 2^0.5 times as much, the area 2^-0.25 times."""
    data = answered(
        total_friction_cut_off_exponent=-0.5, total_contact_fraction_cut_off_exponent=0.25
    ).assign(cut_off_exponent_missing="")
    warnings = ranked(answer_notices(data))
    assert [round(warning.effect, 3) for warning in warnings] == [0.5, 0.414, 0.25, 0.06]
    words = ("slopes above 1", "last octave", "measured band", "filled gaps")
    assert all(w in warning.sentence for w, warning in zip(words, warnings, strict=True))


def test_two_frictions_that_disagree_are_warned_of():
    numbers = {"total_friction": 0.24, "total_friction_from_dissipation": 0.2}
    worst = ranked(answer_notices(answered(**numbers, answer_steep_share=0.0)))[1]
    assert worst.friction == pytest.approx(0.2)
    assert "differ by 20 %" in worst.sentence


def test_those_without_a_number_stand_below_in_an_order():
    """An error, what may be another answer, numbers, then what was solved, rubber, surface."""
    several = [
        Finding(Severity.WARNING, "from where", topic=Topic.SOURCE),
        Finding(Severity.WARNING, "surface", topic=Topic.SURFACE),
        Finding(Severity.WARNING, "2 %", area=-0.02),
        Finding(Severity.WARNING, "solution", topic=Topic.SOLUTION),
        Finding(Severity.WARNING, "a third", friction=0.3, area=math.nan),
        Finding(Severity.WARNING, "another unit", math.inf),
        Finding(Severity.ERROR, "no numbers"),
        Finding(Severity.WARNING, "rubber", topic=Topic.RUBBER),
    ]
    order = ["no numbers", "another unit", "a third", "2 %"]
    order += ["solution", "rubber", "surface", "from where"]
    notices = ranked(several)
    assert [notice.sentence for notice in notices] == order
    page = Page("", "", notices, [])
    assert [notice.sentence for notice in page.errors] == order[:1]
    opened, folded = page.warnings
    assert [notice.sentence for notice in opened] == order[1:3]
    assert [notice.sentence for notice in folded] == order[3:]
    assert list(warning_lines(notices, "report.html")) == [
        "Warnings, by what they change:",
        *(f"  {text}" for text in order[:5]),
        "  ... and 3 more in report.html",
    ]
    assert not list(warning_lines([], "report.html"))


def test_those_within_the_half_width_are_counted_only():
    """Half widths of 20 % of friction and 1 % of area: 30 % and -2 % stand open, 10 % does not."""
    several = [
        Finding(Severity.WARNING, "a third", friction=0.3),
        Finding(Severity.WARNING, "a tenth", friction=0.1, area=0.005),
        Finding(Severity.WARNING, "2 %", area=-0.02),
        Finding(Severity.WARNING, "not known"),
    ]
    widths = {"friction": 0.2, "area": 0.01}
    assert list(warning_lines(several, widths=widths)) == [
        "Warnings, by what they change:",
        "  a third",
        "  2 %",
        "  ... and 2 more in `findings`",
    ]
    assert list(warning_lines(several[1:2], widths=widths)) == [
        "Warnings within the interval: 1 in `findings`"
    ]


def test_inputs_know_what_they_change():
    """Without roughness below 0.2 mm friction is 2^-0.5 times as much, at an exponent of -0.5."""
    attrs = {
        "sines_residual_decades": 0.2,
        "cut_off_beyond_measurement": 1,
        "cut_off_m": 1e-4,
        "cut_off_carried_m": 2e-4,
        "findings": to_json(
            [
                doubt("The footprint is short.", topic=Topic.LOAD),
                Finding(Severity.WARNING, "Surface: road: heights jump.", topic=Topic.SURFACE),
            ]
        ),
    }
    record = InputRecord(xr.Dataset({"master_loss": ("row", [2e6])}, attrs=attrs))
    data = answered(
        total_friction_cut_off_exponent=-0.5, total_contact_fraction_cut_off_exponent=math.nan
    ).assign(cut_off_exponent_missing="")
    footprint, steep, _, roughness, *_ = notices = case_notices(data, record)
    assert footprint.sentence == "The footprint is short."
    assert "slopes above 1" in steep.sentence
    assert "from 0.200 mm, where the measurement ends" in roughness.sentence
    assert "friction changes by -29 %" in roughness.sentence
    effects = {round(notice.effect, 3): notice.sentence for notice in notices}
    assert "26 % of their height" in effects[round(10**0.1 - 1, 3)]
    assert notices[-1].sentence == "Surface: road: heights jump."
