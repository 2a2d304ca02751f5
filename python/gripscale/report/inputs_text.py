"""What a run says about its inputs: cleaning, correlation, sine waves, Prony series."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from gripscale.core.units import MEGA, MILLI, ZERO_CELSIUS, significant
from gripscale.rubber import ShiftTable
from gripscale.rubber.material import BEYOND, End, fast_end, slow_end

if TYPE_CHECKING:
    from gripscale.case.prepare import PreparedRubber
    from gripscale.conditions.conditions import Conditions
    from gripscale.rubber import Rubber
    from gripscale.surface import PreparedSurface, SineStack


def surface_lines(surface: PreparedSurface) -> Iterator[str]:
    """Yield what was read and removed, the fits, the sine waves and notes."""
    measured = surface.measured
    if measured is not None:
        for (raw, cleaned), report in zip(measured.profiles, measured.cleaning, strict=True):
            yield f"{raw.name or raw.source}: {len(cleaned)} points, step {raw.step / MILLI:.4g} mm"
            yield from (f"  {line}" for line in str(report).splitlines())
        share = surface.counted.get("upper_share", 1.0)
        if share < 1.0:
            yield f"correlation of the upper {100.0 * share:.3g} % of the heights only"
        if measured.self_affine is None:
            yield f"not self-affine: {measured.no_self_affine}"
        else:
            fit = measured.self_affine
            yield (
                f"self-affine from {fit.lag_min / MILLI:.3g} to {fit.lag_max / MILLI:.3g} mm: "
                f"H = {fit.hurst:.3f}, D = {fit.fractal_dimension:.3f}, "
                f"xi_parallel = {fit.xi_parallel / MILLI:.3g} mm, "
                f"xi_perpendicular = {fit.xi_perpendicular / MILLI:.3g} mm"
            )
    yield sines_line(surface.sines)
    if surface.cut_off is not None:
        yield f"cut-off: {surface.cut_off}"
    yield from (f"note: {note}" for note in surface.notes)


def sines_line(sines: SineStack) -> str:
    """Return the stack of sine waves in one sentence."""
    largest, smallest = sines.wavelength[0] / MILLI, sines.wavelength[-1] / MILLI
    text = f"{len(sines)} sine waves from {largest:.3g} to {smallest:.3g} mm"
    if sines.s_wavelength is not None and sines.s_amplitude is not None:
        text += f", s_wavelength = {sines.s_wavelength:.3f}, s_amplitude = {sines.s_amplitude:.3f}"
    if sines.cut_off is not None:
        text += f", for roughness down to {sines.cut_off / MILLI:.3g} mm"
    if sines.residual is not None:
        text += f", residual {sines.residual:.3f} decades of C_z"
    return text


def waves_table(sines: SineStack) -> Iterator[str]:
    """Yield the waves, one a line."""
    yield f"{'wave':>4} {'wavelength [mm]':>16} {'amplitude [mm]':>15} {'slope':>7}"
    for i, (wavelength, amplitude) in enumerate(
        zip(sines.wavelength, sines.amplitude, strict=True)
    ):
        yield (
            f"{i + 1:>4} {wavelength / MILLI:>16.4g} {amplitude / MILLI:>15.4g} "
            f"{sines.slope[i]:>7.3f}"
        )


def rubber_lines(prepared: PreparedRubber) -> Iterator[str]:
    """Yield what the rubber is and how well its Prony series fits."""
    rubber = prepared.rubber
    slow, fast = _end(slow_end(rubber), "relaxed"), _end(fast_end(rubber), "glassy")
    bulk = significant(rubber.bulk_modulus / MEGA)
    yield f"{rubber.name or 'rubber'}: E' from {slow} to {fast}, bulk modulus {bulk} MPa"
    if prepared.fit is not None:
        yield from prepared.fit.summary().splitlines()
    if prepared.source:
        yield f"source: {prepared.source}"
    yield from shift_lines(prepared)


def shift_lines(prepared: PreparedRubber) -> Iterator[str]:
    """Yield the sweeps a master curve was made of, how they meet, and the shift factors."""
    shift, reference = prepared.rubber.shift, prepared.rubber.reference_temperature
    if prepared.sweeps is not None and prepared.superposition is not None:
        yield prepared.sweeps.summary()
        yield from prepared.superposition.summary().splitlines()
    elif shift is not None and reference is not None:
        yield f"shift, as stated: {shift.kind}, from {reference - ZERO_CELSIUS:.4g} C"
    if isinstance(shift, ShiftTable) and prepared.sweeps is not None:
        yield f"{'temperature [C]':>16} {'log10 a_T':>10} {'+-':>7} {'b_T':>7}"
        for kelvin, log_a, error, log_b in zip(
            shift.temperature,
            shift.horizontal,
            shift.horizontal_error,
            shift.vertical,
            strict=True,
        ):
            celsius = kelvin - ZERO_CELSIUS
            yield f"{celsius:>16.1f} {log_a:>10.3f} {error:>7.3f} {10.0**log_b:>7.3f}"
    yield from (fit.summary() for fit in prepared.shift_fits())


def conditions_lines(conditions: Conditions, rubber: Rubber) -> Iterator[str]:
    """Yield the effects that are asked for, with their numbers."""
    kelvin = conditions.temperature_of(rubber)
    if kelvin is not None:
        stated = "" if conditions.temperature is not None else ", of the master curve"
        yield f"temperature before the contact {kelvin - ZERO_CELSIUS:.4g} C{stated}"
    for name, law in (("softening", conditions.softening), ("heat", conditions.heat)):
        if law is not None:
            yield f"{name}: {_numbers(law)}"
    if conditions.softening is not None:
        yield f"strain of a wave: {conditions.strain_norm}"
    if conditions.shear_stress is not None:
        yield f"area term, as stated: {_numbers(conditions.shear_stress)}"


def _numbers(law: Any) -> str:
    """Return kind and numbers of a law; of tables how many."""
    values = {f.name: getattr(law, f.name) for f in fields(law)}
    told = (
        f"{name} {len(value)} values"
        if isinstance(value, tuple)
        else f"{name} {value if isinstance(value, str) else format(value, 'g')}"
        for name, value in values.items()
        if value is not None
    )
    return ", ".join([*filter(None, [getattr(law, "kind", "")]), *told])


def _end(end: End, plateau: str) -> str:
    place = plateau if end.plateau else "end of the data"
    return f"{significant(end.modulus / MEGA)} MPa ({place})"


def band_table(rubber: Rubber) -> Iterator[str]:
    """Yield E' and E'' with what the data leave open, at and beyond the ends of the data."""
    if rubber.valid_band is None or rubber.admissible is None:
        return
    yield (
        f"{'frequency [rad/s]':>18} {'storage [MPa]':>14} {'admissible':>20} "
        f"{'loss [MPa]':>11} {'admissible':>20}"
    )
    slow, fast = rubber.valid_band
    for omega in (slow / BEYOND, slow, (slow * fast) ** 0.5, fast, fast * BEYOND):
        here = complex(rubber.complex_modulus(omega))
        low, high = (complex(one) for one in rubber.complex_modulus_band(omega))
        yield (
            f"{omega:>18.3g} {here.real / MEGA:>14.4g} {_span(low.real, high.real):>20} "
            f"{here.imag / MEGA:>11.4g} {_span(low.imag, high.imag):>20}"
        )


def _span(low: float, high: float) -> str:
    return f"{low / MEGA:.3g} to {high / MEGA:.3g}"


def prony_table(rubber: Rubber) -> Iterator[str]:
    """Yield the Maxwell elements, one a line."""
    yield f"{'term':>4} {'relaxation time [s]':>20} {'modulus [MPa]':>14}"
    pairs = zip(rubber.relaxation_times, rubber.moduli, strict=True)
    for i, (time, modulus) in enumerate(pairs):
        yield f"{i + 1:>4} {time:>20.4g} {modulus / MEGA:>14.5g}"
