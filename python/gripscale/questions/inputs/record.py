"""The record of the inputs of a case beside its results, and as pages read it.

Its variables are listed in docs/reference/result-files.md: a report needs only the result file.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gripscale.case import Case, excitation
from gripscale.core.arrays import Array, ComplexArray
from gripscale.core.finding import Finding, Severity, Topic, from_json, ranked, to_json
from gripscale.core.units import MILLI
from gripscale.io.table import significant
from gripscale.model import Load
from gripscale.report.elements import number_text, percent_text
from gripscale.rubber import MasterCurve, PronyFit, Rubber
from gripscale.rubber.material import fast_end, slow_end
from gripscale.surface import HeightDifference, Measured, Profile, SineStack, Surface
from gripscale.surface.cut_off import DEFINITIONS
from gripscale.surface.sine_fit import as_fitted

BINS = 1200  # pieces a profile is cut into; each keeps its lowest and its highest height


def envelope(x: ArrayLike, z: ArrayLike, bins: int = BINS) -> Array:
    """Return middle, lowest and highest height of each piece of a profile, shape (3, bins).

    A piece without heights has NaN; of fewer points than `bins`, the rest is NaN.
    """
    abscissa, height = np.asarray(x, dtype=float), np.asarray(z, dtype=float)
    count = min(bins, abscissa.size)
    first = np.linspace(0, abscissa.size, count, endpoint=False).astype(int)
    out = np.full((3, bins), math.nan)
    sizes = np.diff(np.append(first, abscissa.size))
    out[0, :count] = np.add.reduceat(abscissa, first) / sizes
    out[1, :count] = np.fmin.reduceat(height, first)
    out[2, :count] = np.fmax.reduceat(height, first)
    return out


def close_up(profile: Profile) -> Array:
    """Return abscissa and height [m] of 30 mm from the middle of a profile, shape (2, points)."""
    start = 0.5 * (profile.x[0] + profile.x[-1])
    inside = (profile.x >= start) & (profile.x <= start + 30e-3)
    return np.array([profile.x[inside], profile.z[inside]])


def sine_curves(sines: SineStack, lag: ArrayLike) -> tuple[Array, Array]:
    """Return C_z [m^2] of the waves as `fit_sines` uses it and of the pure sines.

    As fitted, the first wave counts by its mean over phases beyond a quarter of its length, and
    shorter waves than those of the stack count where it has a cut-off. Beyond the whole length of
    the first wave both are NaN.
    """
    lags, longest = np.asarray(lag, dtype=float), float(sines.wavelength[0])
    inside = np.minimum(lags, longest)
    first = SineStack(sines.wavelength[:1], sines.amplitude[:1])
    held = first.height_difference(np.minimum(lags, 0.25 * longest))
    rest = as_fitted(sines).height_difference(inside) - first.height_difference(inside)
    curves = rest + held, sines.height_difference(inside)
    fitted, pure = (np.where(lags <= longest, curve, math.nan) for curve in curves)
    return fitted, pure


def excited(case: Case) -> Array:
    """Return the frequencies of waves [rad/s] at the temperature of the moduli; none at rest."""
    omega = excitation(case.rubber, case.surface, case.load, case.conditions)
    return omega[omega > 0.0]


def band(rubber: Rubber, master: MasterCurve | None, excitation: ArrayLike, points: int) -> Array:
    """Return angular frequencies [rad/s] over everything measured and excited, or all terms.

    A decade more on both sides where the uncertainty beyond the data is known, else half of one.
    """
    ends = [*np.asarray(excitation, dtype=float), *(rubber.valid_band or ())]
    if master is not None:
        ends += [*master.angular_frequency[[0, -1]]]
    ends = ends or [*(1.0 / rubber.relaxation_times)] or [1.0]
    margin = 3.0 if rubber.admissible is None else 10.0
    return np.geomspace(min(ends) / margin, max(ends) * margin, points)


Variables = dict[str, Any]
_Part = tuple[Variables, Variables]  # variables and attributes of the record
_POINTS = 600  # points of a curve that is drawn


def inputs(
    case: Case,
    surfaces: Iterable[Surface] | None = None,
    loads: Iterable[Load] | None = None,
    further: Iterable[Finding] = (),
) -> xr.Dataset:
    """Return everything a report says about the inputs of a case: the group `inputs` of a result.

    Its findings are those of `surfaces` and `loads` where the answer is not of those of the case,
    and `further` ones, of measured friction and of rubbers beside that of the case.
    """
    surface, rubber, omega = case.surface, case.measured_rubber, excited(case)
    # what the measurement does not carry stands in `cut_off_beyond_measurement`
    findings = [*further, *case.findings(surfaces, loads, extrapolated=False)]
    series, about_series = rubber_variables(rubber.rubber, rubber.master, rubber.fit, omega)
    data: Variables = {}
    if files := case.origin.files:
        for part in ("role", "name", "sha256"):
            data[f"file_{part}"] = ("file", _texts([getattr(file, part) for file in files]))
        data["file_bytes"] = ("file", np.array([file.size for file in files]))
    data |= series
    sines = surface.sines
    low, high = sines.lag_range or (None, None)
    attrs: Variables = {
        "sines_s_wavelength": sines.s_wavelength,
        "sines_s_amplitude": sines.s_amplitude,
        "sines_residual_decades": sines.residual,
        "sines_lag_min_m": low,
        "sines_lag_max_m": high,
        "sines_cut_off_m": sines.cut_off,
        "correlation_top_height_fraction": surface.counted.get("top_height_fraction"),
        **about_series,
        "findings": to_json(findings) if findings else None,
    }
    if omega.size:
        attrs["excited_low_rad_per_s"] = float(omega.min())
        attrs["excited_high_rad_per_s"] = float(omega.max())
    measured = surface.measured
    if measured is not None and surface.correlation is not None:
        data |= _profiles(measured) | {str(k): v for k, v in measured.texture.variables.items()}
        if measured.longest is not None:
            attrs["long_waves_beyond_m"] = measured.longest
            attrs["long_waves_share"] = measured.long_share
        parts = _cut_off(surface, measured), _correlation(surface.correlation, measured, sines)
        for variables, about in parts:
            data |= variables
            attrs |= about
    return xr.Dataset(data, attrs={k: value for k, value in attrs.items() if value is not None})


def _cut_off(surface: Surface, measured: Measured) -> _Part:
    """Return where the roughness ends and why, and the rms slope down to each wavelength."""
    cut_off, slopes = surface.cut_off, measured.slopes
    assert cut_off is not None
    lengths = slopes.wavelength
    data: Variables = {"slope_wavelength": ("slope_wavelength", lengths, {"units": "m"})}
    for of in DEFINITIONS:
        values = np.array([slopes.down_to(float(length), of) for length in lengths])
        data[f"rms_slope_of_{of}"] = ("slope_wavelength", values, {"units": "1"})
    return data, {
        "cut_off_m": cut_off.wavelength,
        "cut_off_rule": cut_off.rule,
        "cut_off_surface_slope": cut_off.surface_slope,
        "cut_off_profile_slope": cut_off.profile_slope,
        "cut_off_carried_m": cut_off.resolution_limit,
        "cut_off_beyond_measurement": int(cut_off.beyond_measurement),
    }


def drawn_profiles(pairs: Sequence[tuple[Profile, Profile]]) -> Variables:
    """Return pairs of profiles, as read and cleaned, as they are drawn."""
    raw, cleaned = (list(column) for column in zip(*pairs, strict=True))
    data: Variables = {
        "profile_name": ("profile", _texts([p.name or Path(p.source).name for p in raw]))
    }
    for name, profiles in (("read", raw), ("cleaned", cleaned)):
        drawn = np.array([envelope(profile.x, profile.z) for profile in profiles])
        for i, part in enumerate(("x", "lowest", "highest")):
            data[f"{name}_{part}"] = (("profile", "bin"), drawn[:, i], {"units": "m"})
    pieces = [close_up(profile) for profile in cleaned]
    longest = min(piece.shape[1] for piece in pieces)
    for i, part in enumerate("xz"):
        values = np.array([piece[i, :longest] for piece in pieces])
        data[f"close_up_{part}"] = (("profile", "close_up_point"), values, {"units": "m"})
    return data


def _profiles(measured: Measured) -> Variables:
    """Return the profiles as drawn, and what each step of their cleaning did."""
    raw = [profile for profile, _ in measured.profiles]
    data = drawn_profiles(measured.profiles) | {
        "profile_step": ("profile", np.array([p.step for p in raw]), {"units": "m"}),
        "profile_length": ("profile", np.array([p.length for p in raw]), {"units": "m"}),
        "profile_points": ("profile", np.array([len(p) for p in raw])),
    }
    if measured.cleaning:  # profiles may be given as they are
        steps = [step.step for step in measured.cleaning[0].steps]
        data["cleaning_step_name"] = ("cleaning_step", _texts(steps))
        for field in ("points", "removed", "made_missing", "missing"):
            counts = [[getattr(step, field) for step in report] for report in measured.cleaning]
            data[f"cleaning_{field}"] = (("profile", "cleaning_step"), np.array(counts))
        notes = [[step.note for step in report] for report in measured.cleaning]
        data["cleaning_note"] = (("profile", "cleaning_step"), _texts(notes))
    return data


def _correlation(hdc: HeightDifference, measured: Measured, sines: SineStack) -> _Part:
    """Return C_z as measured and as fitted, the waves also at lags between the measured ones."""
    fit = measured.self_affine
    lag = np.asarray(hdc.lag)
    fine = np.geomspace(lag[0], min(float(sines.wavelength[0]), lag[-1]), _POINTS)
    curves: dict[str, Any] = {
        f"correlation_{end}": getattr(hdc, end) for end in ("value", "lower", "upper")
    }
    curves["correlation_sines"] = sine_curves(sines, lag)[0]
    if fit is not None:
        curves["correlation_self_affine"] = fit.evaluate(lag)
    fitted, pure = sine_curves(sines, fine)
    data: Variables = {
        "lag": ("lag", lag, {"units": "m"}),
        **{name: ("lag", np.asarray(curve), {"units": "m^2"}) for name, curve in curves.items()},
        "correlation_pairs": ("lag", np.asarray(hdc.pairs)),
        "fine_lag": ("fine_lag", fine, {"units": "m"}),
        "fine_sines": ("fine_lag", fitted, {"units": "m^2"}),
        "fine_pure_sines": ("fine_lag", pure, {"units": "m^2"}),
    }
    if fit is None:
        return data, {"no_self_affine": measured.no_self_affine}
    lengths = ("xi_parallel", "xi_perpendicular", "lag_min", "lag_max")
    return data, {
        "self_affine_hurst": fit.hurst,
        **{f"self_affine_{name}_m": getattr(fit, name) for name in lengths},
        "self_affine_residual_decades": fit.residual,
    }


def rubber_variables(
    rubber: Rubber, master: MasterCurve | None, fit: PronyFit | None, excitation: Array
) -> _Part:
    """Return variables and attributes of a Prony series and the master curve it was fitted to."""
    low, high = rubber.valid_band or (None, None)
    attrs: Variables = {
        "rubber_name": rubber.name,
        "strain_energy": str(rubber.strain_energy),
        "equilibrium_modulus_Pa": rubber.equilibrium_modulus,
        "bulk_modulus_Pa": rubber.bulk_modulus,
        "band_low_rad_per_s": low,
        "band_high_rad_per_s": high,
    }
    for name, end in (("slow_end", slow_end(rubber)), ("fast_end", fast_end(rubber))):
        attrs |= {f"{name}_modulus_Pa": end.modulus, f"{name}_plateau": int(end.plateau)}
    omega = band(rubber, master, excitation, _POINTS)
    data: Variables = {"series_omega": ("series_omega", omega, {"units": "rad/s"})}
    data |= _moduli("series", "series_omega", rubber.complex_modulus(omega))
    if rubber.admissible is not None:
        for side, modulus in zip(("low", "high"), rubber.complex_modulus_band(omega), strict=True):
            data |= _moduli(f"series_{side}", "series_omega", modulus)
    if len(rubber.moduli):
        times = np.asarray(rubber.relaxation_times)
        data["term_relaxation_time"] = ("maxwell_element", times, {"units": "s"})
        data["term_modulus"] = ("maxwell_element", np.asarray(rubber.moduli), {"units": "Pa"})
    if master is not None:
        attrs["reference_temperature_K"] = master.reference_temperature
        data["master_frequency"] = ("row", master.frequency, {"units": "Hz"})
        data |= _moduli("master", "row", master.storage + 1j * master.loss)
        fitted = rubber.complex_modulus(master.angular_frequency)
        data |= _moduli("master_series", "row", fitted)
    if master is not None and fit is not None:
        out = np.isin(master.frequency, fit.outlier_frequency)
        data["master_left_out"] = ("row", out.astype(np.int8))
        errors = ("rms_storage", "rms_loss", "rms_loss_factor", "mean_loss_factor_error")
        for name in (*errors, "storage_scatter", "loss_scatter"):
            attrs[f"prony_{name}"] = getattr(fit, name)
        attrs["prony_consistent"] = int(fit.consistent)
        attrs["prony_findings"] = "\n".join(fit.findings)
    return data, attrs


def _moduli(name: str, along: str, modulus: ComplexArray) -> Variables:
    return {
        f"{name}_storage": (along, modulus.real, {"units": "Pa"}),
        f"{name}_loss": (along, modulus.imag, {"units": "Pa"}),
    }


def _texts(values: Sequence[Any]) -> NDArray[np.object_]:
    return np.array(values, dtype=object)


@dataclass(frozen=True)
class InputRecord:
    """The record that a run keeps of its inputs, as `record` writes it."""

    data: xr.Dataset

    def has(self, name: str) -> bool:
        """Return whether a variable or an attribute is there."""
        return name in self.data or name in self.data.attrs

    def number(self, name: str) -> float:
        """Return an attribute, NaN where it is missing."""
        value = self.data.attrs.get(name)
        return math.nan if value is None else float(value)

    def text(self, name: str) -> str:
        """Return an attribute, empty where it is missing."""
        return str(self.data.attrs.get(name, ""))

    def quantity(
        self,
        name: str,
        unit: str = "",
        size: float = 1.0,
        format: Callable[[float], str] = significant,
    ) -> str:
        """Return an attribute as a page shows it, with its unit."""
        return f"{number_text(self.number(name), size, format)} {unit}".rstrip()

    @property
    def is_empty(self) -> bool:
        """Whether nothing was recorded: not the result of `gripscale run`."""
        return not self.data.data_vars

    @property
    def of_map(self) -> bool:
        """Whether a map was measured."""
        return "texture_of" in self.data and "map" in self.data["texture_of"].values

    @property
    def findings(self) -> list[str]:
        """What the fit of the Prony series found."""
        return self.text("prony_findings").splitlines()

    def warnings(self) -> Iterator[Finding]:
        """Yield what is doubtful about load, conditions, rubber and surface."""
        yield from from_json(self.text("findings"))
        if self.is_empty:
            text = (
                "The result holds no record of its inputs (a script or an older version wrote it): "
                "profiles, fits, master curve and doubts about the inputs are missing here."
            )
            yield Finding(Severity.WARNING, text, topic=Topic.SOURCE)


def input_findings(record: InputRecord) -> list[Finding]:
    """Return what is doubtful about the inputs of a result, ranked."""
    return ranked([*extrapolated(record), *misfits(record), *record.warnings()])


def extrapolated(record: InputRecord) -> Iterator[Finding]:
    """Yield from where the roughness of a case is extrapolated, if it is."""
    if record.number("cut_off_beyond_measurement") > 0.0:
        ends = record.number("cut_off_carried_m"), record.number("cut_off_m")
        yield extrapolated_roughness(*ends, {})


def extrapolated_roughness(limit: float, end: float, changed: Mapping[str, float]) -> Finding:
    """Return what roughness from `limit` to `end` [m] adds, both shorter than was measured.

    `changed` are the relative changes of an answer without it, as far as they are known.
    """
    lengths = (f"{number_text(length, MILLI)} mm" for length in (limit, end))
    text = "Roughness from {}, where the measurement ends, to {} is extrapolated".format(*lengths)
    return Finding(
        Severity.WARNING,
        f"{text}: without it {in_words(changed)}." if changed else f"{text}.",
        changed.get("friction", math.nan),
        changed.get("contact_fraction", math.nan),
        Topic.SURFACE,
    )


def in_words(changed: Mapping[str, float]) -> str:
    """Return relative changes in words, such as `the friction changes by +38 %`."""
    words = {"friction": "the friction", "contact_fraction": "the contact area"}
    first, *others = [
        (words[name], f"by {signed_percent(change)}") for name, change in changed.items()
    ]
    return " and ".join([" changes ".join(first), *map(" ".join, others)])


def signed_percent(change: float) -> str:
    """Return a relative change in per cent with its sign, such as `-3.2 %`."""
    return f"{'+-'[change < 0.0]}{percent_text(abs(change))}"


def misfits(record: InputRecord) -> Iterator[Finding]:
    """Yield by how much the sine waves miss their heights."""
    residual = record.number("sines_residual_decades")
    height = 10.0 ** (0.5 * residual) - 1.0  # C_z goes with the square of the height
    if height > 0.1:
        yield Finding(
            Severity.WARNING,
            f"The sine waves miss the measured correlation by {significant(residual, 2)} decades: "
            f"{percent_text(height)} of their height. The friction of the chain has a similar "
            "error.",
            height,
            topic=Topic.SURFACE,
        )
