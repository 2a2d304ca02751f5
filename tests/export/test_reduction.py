"""A reduced Prony series follows the whole one within its band, and says how well."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from gripscale.cli import app
from gripscale.core.errors import InputError
from gripscale.export.rubber import reduced
from gripscale.rubber import Rubber, styrene_butadiene
from tests.samples import write_maxwell

SBR = styrene_butadiene()
BAND = (1.0, 1e5)


def errors(rubber: Rubber) -> list[float]:
    """Return the largest relative errors of E', E'' and E''/E' over the band, at 1000 points."""
    omega = 2.0 * np.pi * np.geomspace(*BAND, 1000)
    here, exact = rubber.complex_modulus(omega), SBR.complex_modulus(omega)
    parts = here.real / exact.real, here.imag / exact.imag
    return [float(np.abs(part - 1.0).max()) for part in (*parts, parts[1] / parts[0])]


def test_the_misfit_is_that_within_the_band() -> None:
    reduction = reduced(SBR, band=BAND, terms=10)
    stated = [reduction.storage, reduction.loss, reduction.loss_factor]
    # 20 points per decade miss the largest by less than a tenth of it
    assert stated == pytest.approx(errors(reduction.rubber), rel=0.1)
    # ten elements for five decades: two a decade, as the rubber itself has
    assert max(stated) < 0.08
    assert reduction.rubber.valid_band == pytest.approx([2.0 * np.pi * end for end in BAND])
    assert f"Reduced to {len(reduction.rubber.moduli)} Maxwell elements" in reduction.rubber.source
    assert f"E' {reduction.storage:.2%}" in str(reduction)
    for kept in ("bulk_modulus", "reference_temperature", "strain_energy"):
        assert getattr(reduction.rubber, kept) == getattr(SBR, kept)


def test_fewer_terms_miss_more_and_all_of_them_nothing() -> None:
    worst = [max(errors(reduced(SBR, band=BAND, terms=terms).rubber)) for terms in (2, 4, 8, 16)]
    assert worst == sorted(worst, reverse=True)
    single = Rubber(2e6, [5e6], [1e-3])
    again = reduced(single, band=(1.0, 1e5), terms=41)
    assert max(again.storage, again.loss) < 0.01


def test_what_cannot_be_reduced_is_refused() -> None:
    with pytest.raises(InputError, match="got an elastic one"):
        reduced(Rubber(2e6, [], []))
    with pytest.raises(InputError, match="terms must be a whole number from 1 to 200; got 0"):
        reduced(SBR, terms=0)
    with pytest.raises(InputError, match=r"band .* must be a lower and a higher value"):
        reduced(SBR, band=(1e3, 1.0))


def test_the_command_states_the_misfit(tmp_path: Path) -> None:
    write_maxwell(tmp_path / "dma.txt")
    target = tmp_path / "rubber.inp"
    arguments = ["export", "rubber", tmp_path / "dma.txt", "--to", "abaqus", "--output", target]
    options = ["--band", "1..1e3 Hz", "--terms", "3"]
    outcome = CliRunner().invoke(app, [*map(str, arguments), *options])
    assert outcome.exit_code == 0, outcome.output
    words = "Reduced to 3 Maxwell elements for 1 to 1000 Hz; largest errors there"
    assert words in " ".join(outcome.output.split())
    assert words in " ".join(target.read_text().replace("**", "").split())
