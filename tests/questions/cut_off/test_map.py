"""A map is not continued below its measurement."""

import numpy as np
import pytest

from gripscale.case_file import read_case, read_case_file
from gripscale.core.errors import InputError
from gripscale.questions.cut_off.question import cut_off
from tests.half_space.rough_cases import isotropic_heights
from tests.samples import HALF_PLANE, case_text

SURFACE = (
    'map = "map.txt"\nstep = ["0.2 mm", "0.2 mm"]\nz_unit = "mm"\nscales = 3\ncut_off = "1 mm"'
)


def test_a_map_is_refused(tmp_path):
    np.savetxt(tmp_path / "map.txt", 1e3 * isotropic_heights(128, length=0.0256, rms=2e-4).T)
    text = case_text(SURFACE, 'name = "styrene_butadiene"', HALF_PLANE)
    path = tmp_path / "case.toml"
    path.write_text(text)
    with pytest.raises(InputError, match="from measured profiles; got a map"):
        cut_off(read_case(read_case_file(path)), folder=tmp_path / "result", down_to=1e-6)
    path.write_text(text + '\n[below_measurement]\ndown_to = "0.15 mm"\n')
    with pytest.raises(
        InputError, match=r"\[below_measurement\] needs measured profiles; got a map"
    ):
        read_case(read_case_file(path))
