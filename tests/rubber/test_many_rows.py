"""Files of moduli with very many rows: some of each decade are kept, and read alike."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.rubber import blocks
from gripscale.rubber.sweeps import MOST_ROWS, ROWS_PER_DECADE, thinned


def moduli(hertz):
    return 5e6 * hertz**0.1, 1e6 * hertz**0.12


def write(path, parts):
    text = []
    for above, hertz in parts:
        rows = zip(hertz, *moduli(hertz), strict=True)
        text += [*above, *("\t".join(f"{value:.7g}" for value in row) for row in rows)]
    path.write_text("\n".join([*text, ""]))
    return path


TITLES = "f [Hz]\tE' [Pa]\tE'' [Pa]"


def test_of_many_rows_some_of_each_decade_are_kept_as_measured(tmp_path):
    hertz = np.geomspace(1e-2, 1e2, 3 * MOST_ROWS)
    master = gs.read_master_curve(write(tmp_path / "log.txt", [([TITLES], hertz)]))
    assert len(master) == 4 * ROWS_PER_DECADE + 1
    assert master.storage == pytest.approx(moduli(master.frequency)[0], rel=1e-5)
    assert np.diff(np.log10(master.frequency)) == pytest.approx(0.01, abs=0.006)
    assert master.notes == (
        f"401 of {hertz.size} rows kept, at most 100 of a decade of frequency at one temperature",
    )


def test_few_rows_are_all_kept():
    rows = np.ones((4, MOST_ROWS))
    assert thinned(rows)[0] is rows


def test_temperatures_are_thinned_apart():
    hertz, kelvin = np.geomspace(1.0, 10.0, MOST_ROWS), np.repeat([280.0, 300.0], MOST_ROWS)
    rows = np.array([kelvin, np.tile(hertz, 2), *np.ones((2, 2 * MOST_ROWS))])
    (kept, *_), _ = thinned(rows)
    assert [np.sum(kept == each) for each in (280.0, 300.0)] == [101, 101]


@pytest.mark.parametrize("remark", ["", "-----", "measured by night"])
def test_the_rows_at_the_end_of_a_long_file_are_read_as_all_others(tmp_path, monkeypatch, remark):
    rows = np.geomspace(0.1, 50.0, 1000)
    parts = [([f"T = {degrees} C", TITLES, remark], rows) for degrees in (0, 20)]
    path = write(tmp_path / "sweeps.txt", parts)
    short = gs.read_sweeps(path)
    monkeypatch.setattr(blocks, "_ENOUGH", 10**9)
    assert short == gs.read_sweeps(path)
    assert (len(short), len(short.frequency)) == (2, 2000)
