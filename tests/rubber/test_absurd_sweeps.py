"""Absurd arguments of sweeps, shifts and tables: used, or refused in one short sentence."""

from __future__ import annotations

import numpy as np
import pytest

import gripscale as gs
from gripscale import rubber as gr
from gripscale.core.errors import GripscaleError
from tests.samples import EXAMPLES

FILE = EXAMPLES / "data/rubber/multi_temperature_polymer/freq_user_raw.csv"
ABSURD = [10**400, 1e308, -1e308, 1e-320, float("nan"), float("inf"), None, "x", True, 1 + 2j]
ABSURD += [[], [[]], np.array(3.0), {}, b"x", 0, -1]
TABLE = gr.ShiftTable([280.0, 300.0, 320.0], [1.0, 0.0, -1.0], reference_temperature=300.0)
WLF = gr.WLF(8.0, 100.0, 293.0)
SWEEPS = gr.Sweeps([280, 280, 300, 300], [1, 10, 1, 10], [2e6, 3e6, 1e6, 2e6], [1e6] * 4)
WARM = gr.Rubber(1e6, [2e6], [1.0], reference_temperature=293.0, shift=WLF)
MADE = [1.0], [1.0], [1.0]


def superposed(**argument):
    return gs.superpose(SWEEPS, **{"reference_temperature": 290.0, **argument})


CALLS = {
    "WLF.c1": lambda v: gr.WLF(v, 50.0),
    "WLF.c2": lambda v: gr.WLF(5.0, v),
    "WLF.reference_temperature": lambda v: gr.WLF(5.0, 50.0, v),
    "WLF.valid_range": lambda v: gr.WLF(5.0, 50.0, 300.0, v),
    "WLF.log_a": lambda v: WLF.log_a(v, 293.0),
    "WLF.a of reference": lambda v: WLF.a(293.0, v),
    "Arrhenius": gr.Arrhenius,
    "Arrhenius.a": lambda v: gr.Arrhenius(1e5).a(v, 300.0),
    "WLFArrhenius.glass": lambda v: gr.WLFArrhenius(5.0, 50.0, 1e5, v),
    "ShiftTable.temperature": lambda v: gr.ShiftTable(v, [1.0]),
    "ShiftTable.horizontal": lambda v: gr.ShiftTable([1.0], v),
    "ShiftTable.errors": lambda v: gr.ShiftTable([300.0], [0.0], v),
    "ShiftTable.a": lambda v: TABLE.a(v, 300.0),
    "shift_from_dict": gr.shift_from_dict,
    "shift_from_dict kind": lambda v: gr.shift_from_dict({"kind": v}),
    "Sweeps.temperature": lambda v: gr.Sweeps(v, *MADE),
    "Sweeps.tolerance": lambda v: gr.Sweeps([300.0], *MADE, v),
    "sweeps_from_ramps": lambda v: gr.sweeps_from_ramps(
        [300.0, 310.0], [1.0] * 2, [1.0] * 2, [1.0] * 2, step=v
    ),
    "superpose": lambda v: gs.superpose(v, reference_temperature=290.0),
    "superpose.reference_temperature": lambda v: superposed(reference_temperature=v),
    "superpose.vertical": lambda v: superposed(vertical=v),
    "superpose.shift": lambda v: superposed(shift=v),
    "superpose.moduli": lambda v: superposed(moduli=v),
    "fit_wlf": gr.fit_wlf,
    "fit_wlf.lowest": lambda v: gr.fit_wlf(TABLE, lowest=v),
    "fit_arrhenius.reference": lambda v: gr.fit_arrhenius(TABLE, reference_temperature=v),
    "Rubber.at": WARM.at,
    "Rubber.shift": lambda v: gr.Rubber(1e6, reference_temperature=300.0, shift=v),
    "Rubber.reference_temperature": lambda v: gr.Rubber(1e6, reference_temperature=v),
    "read_sweeps": gs.read_sweeps,
    "read_sweeps.columns": lambda v: gs.read_sweeps(FILE, columns=v),
    "read_sweeps.storage": lambda v: gs.read_sweeps(FILE, columns={"storage": v}),
    "read_sweeps.temperature": lambda v: gs.read_sweeps(FILE, temperature=v),
    "read_sweeps.temperature_step": lambda v: gs.read_sweeps(FILE, temperature_step=v),
    "read_sweeps.sheet": lambda v: gs.read_sweeps(FILE, sheet=v),
    "read_strain_sweeps": gr.read_strain_sweeps,
    "StrainSweep.deformation": lambda v: gr.StrainSweep(*MADE, v),
    "read_shift_table": gr.read_shift_table,
    "write_shift_table": lambda v: gr.write_shift_table("nowhere/shift.csv", v),
    "write_master_curve": lambda v: gr.write_master_curve("nowhere/master.csv", v),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_one_short_sentence_and_no_warning(call):
    for value in ABSURD:
        refused = ""
        try:
            call(value)
        except GripscaleError as error:
            refused = str(error)
        assert len(refused) < 400
        assert "\n" not in refused
