"""How far a run is, told from what it prints: never back, and unknown where it is not known."""

from __future__ import annotations

from gripscale.app.runs import Progress, progress_of

HEAD = ["gripscale 0.1.0, case run-1.toml", "", "Surface", "  3 sine waves from 10 to 1 mm"]


def waves(last: int, of: int = 3) -> list[str]:
    return [
        f"  wave {n} of {of}: 1.2 mm, contact 0.5, converged, 1.0 s" for n in range(1, last + 1)
    ]


def after(lines: list[str], predictions: int = 1, *, passing: bool = False) -> Progress:
    return progress_of("\n".join([*HEAD, *lines]), predictions, passing=passing)


def test_two_predictions_share_the_bar() -> None:
    lines = ["Dynamic, 0.3 m/s", *waves(3), "", "Static", *waves(3)]
    told = [after(lines[:count], 2) for count in range(len(lines) + 1)]
    shares = [one.share for one in told[:-1]]
    assert [round(6 * share) for share in shares if share is not None] == [
        0, 0, 1, 2, 3, 3, 3, 4, 5]  # fmt: skip
    assert None not in shares
    assert told[-1].share is None
    assert told[0].words == "reading and fitting"
    assert told[3].words == "prediction 1 of 2, wave 2 of 3"
    assert told[-1].words == "all waves are solved; direct contact, effects and figures follow"


def test_passes_are_counted_and_nobody_knows_how_many_come() -> None:
    lines = ["Dynamic, 1 m/s", *waves(3), "  pass 2", *waves(2)]
    told = after(lines, passing=True)
    assert told.share is None
    assert told.words == "pass 2 until rubber and contact agree, wave 2 of 3"
    whole = [*lines, *waves(3)[2:]]
    assert not after(whole, passing=True).solved
    end = "  rubber and contact agree after 2 passes on these meshes"
    assert after([*whole, end], passing=True).solved
    other = after([*whole, end, "Static", *waves(1)], 2, passing=True)
    assert other.words == "prediction 2 of 2, pass 1 until rubber and contact agree, wave 1 of 3"


def test_a_prediction_of_one_wave_is_not_a_pass() -> None:
    assert after([*waves(1, 1), *waves(1, 1)], 2).prediction == 2
    assert after([*waves(1, 1), "  pass 2", *waves(1, 1)], 2, passing=True).prediction == 1
