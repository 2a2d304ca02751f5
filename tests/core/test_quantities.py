"""Public functions take texts with units wherever they take numbers with a unit."""

from dataclasses import fields, is_dataclass

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.core.units import readable, si_value
from tests.core.public_functions import public_functions

UNITS = {
    "Pa": "pressure full_contact_pressure nominal_pressure stress_0 stress_at shear_stress storage "
    "loss equilibrium_modulus moduli equilibrium_moduli bulk_modulus youngs_modulus",
    "m": "wavelength amplitude radius depth smallest_wavelength penetration_depth xi_parallel "
    "xi_perpendicular length step x_step y_step footprint lag reliable lag_min lag_max rule "
    "first_wavelength first_amplitude",
    "m/s": "speed speed_0 critical_speed",
    "s": "load_time relaxation_times duration time_limit",
    "K": "temperature reference_temperature glass_temperature",
    "Hz": "frequency",
    "rad/s": "omega",
    "J/mol": "",
    "W/(m K)": "conductivity",
    "kg/m^3": "density",
    "J/(kg K)": "specific_heat",
}
"""Arguments by the SI unit of their numbers."""
UNIT_OF = {name: unit for unit, names in UNITS.items() for name in names.split()}
OTHERS = {
    ("AdmissibleSeries", "moduli"),
    ("SofteningTable", "storage"),
    ("SofteningTable", "loss"),
    ("Mesh", "depth"),
    ("solve_scale", "depth"),
    ("solve_profile", "depth"),
    ("solve_transient", "depth"),
    ("ArealSpectrum", "density"),
    ("Spectrum", "density"),
    ("ProfileSpectrum", "density"),
    ("relaxation_modulus", "time"),
    ("read_map", "step"),
    ("sweeps_from_ramps", "step"),
}
"""Tables of numbers, depths in wavelengths, and numbers of a file that is not there."""


def pairs():
    """Return public functions with each argument that has a unit."""
    return [
        (function, name)
        for function in public_functions()
        for name, value in function.good.items()
        if name in UNIT_OF and (function.name, name) not in OTHERS
        if np.asarray(value).dtype.kind == "f" and np.isfinite(value).all()
    ]


def numbers(result):
    """Return the numbers of a result, comparable."""
    if isinstance(result, xr.Dataset):
        return {name: result[name].values.tolist() for name in result.data_vars}
    if is_dataclass(result):
        values = {item.name: getattr(result, item.name) for item in fields(result)}
        return {
            name: np.asarray(value).tolist()
            for name, value in values.items()
            if isinstance(value, float | np.ndarray)
        }
    return np.asarray(result).tolist() if isinstance(result, float | np.ndarray) else repr(result)


@pytest.mark.parametrize(
    ("function", "name"), [pytest.param(*pair, id=f"{pair[0].name}-{pair[1]}") for pair in pairs()]
)
def test_a_text_with_a_unit_is_its_number(function, name):
    # an hour: on a busy machine a tenth of a second may end before the first result
    good = {key: 3600.0 if key == "time_limit" else each for key, each in function.good.items()}
    value, unit = good[name], UNIT_OF[name]
    text = (
        f"{value!r} {unit}"
        if np.ndim(value) == 0
        else [f"{float(entry)!r} {unit}" for entry in value]
    )
    expected, result = (function.call(**good | {name: each}) for each in (value, text))
    assert str(numbers(result)) == str(numbers(expected))


def test_units_are_converted():
    assert gs.wave.Sine("8 mm", "500 um") == gs.wave.Sine(8e-3, 5e-4)
    assert si_value("temperature", "20 C", "K") == 293.15
    assert gs.rubber.WLF(c1=8.0, c2="100 C").c2 == 100.0  # a difference has no zero
    assert si_value("omega", "1 Hz", "rad/s") == pytest.approx(2.0 * np.pi)
    assert gs.SineStack(["8 mm", 2e-3], ["0.5 mm", 1e-4]).wavelength.tolist() == [8e-3, 2e-3]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("3 kg", "pressure = '3 kg': unknown unit 'kg'; expected one of Pa, kPa"),
        ("3", "pressure = '3': the unit is missing; expected one of Pa, kPa"),
        ("much", r"pressure must be a finite number \[Pa\]; got 'much'"),
        ("inf bar", "pressure = 'inf bar': expected a finite pressure"),
    ],
)
def test_a_text_without_a_unit_of_the_kind_is_refused(text, message):
    with pytest.raises(gs.InputError, match=message):
        gs.wave.WaveLoad(text)


def test_a_readable_number_keeps_its_size():
    texts = [readable(value, "m") for value in (0.0, 1e-4, -2.5e-2, 3.0, 1e-12)]
    assert texts == ["0 m", "100 um", "-25 mm", "3 m", "1e-12 m"]
    assert readable(0.25, "") == "0.25"
    assert readable(2e13, "rad/s") == "2e+13 rad/s"
    assert readable(5e6, "Hz") == "5 MHz"
    assert readable(1e13, "Hz") == "1e+13 Hz"
    assert readable(3e5, "Pa") == "300 kPa"
