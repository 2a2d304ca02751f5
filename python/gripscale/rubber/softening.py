"""Strain softening of filled rubber (the Payne effect): how E' and E'' fall with the strain.

    E'(w) -> f(e) E'(w),      E''(w) -> g(e) E''(w)

with e the amplitude of a uniaxial strain. A shear strain of amplitude s stores as much energy in an
incompressible solid as e = s / sqrt(3): G s^2 = E e^2. Kraus' law:

    G'(s)  = G'_inf + (G'_0 - G'_inf) / (1 + (s/s_c)^(2m))
    G''(s) = G''_inf + 2 (G''_m - G''_inf) (s/s_c)^m / (1 + (s/s_c)^(2m))

Source: G. Kraus, J. Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984) 75. The exponent m is about
0.5 for carbon black.

The finite-strain block needs E_inf and E_i, and with f and g apart no series has f E' and g E'' at
all frequencies. One that has them where a wave excites the rubber does: multipliers x_i >= 0 of all
moduli minimise

    sum_w w_1/w ((E'_x/(f E') - 1)^2 + (E''_x/(g E'') - 1)^2)
        + smoothing^2 sum_i (x_i+1 - x_i)^2 + keeping^2 sum_i (x_i - f)^2

over the frequencies w of the wave, w_1 its lowest. Slow terms, which carry E' and lose nothing
there, follow f; E_inf keeps at least a third of f of it. The misfit of the series is stated.

It is taken from strain sweeps, of which instruments print the single amplitude or the peak-to-peak
(double) one: a factor of two that no curve shows, so that it has to be stated.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, Mask, Quantity, Vector, checked, checks
from gripscale.core.errors import FileError, InputError, unstated
from gripscale.io.text_table import TextTable, file_path
from gripscale.rubber.blocks import read_blocks
from gripscale.rubber.columns import MODULI, RATIOS, FileLayout, young_moduli
from gripscale.rubber.material import Rubber, loss_shape, storage_shape
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, row_temperatures

Deformation = Literal["tension", "shear"]
DEFORMATIONS = ("tension", "shear")
UNIAXIAL_OF_SHEAR = 1.0 / np.sqrt(3.0)

_SMOOTHING, KEEPING = 0.03, 0.02
_LEAST = 1.0 / 3.0  # smallest multiplier of E_inf over f


@dataclass(frozen=True)
class SofteningFactors:
    """Factors of both moduli at some strains, arrays of one shape."""

    storage: Array  # f(e), of E' [-]
    loss: Array  # g(e), of E'' [-]
    # Where the strain (or the temperature) lies beyond what was measured, the ends held.
    outside: Mask


@runtime_checkable
class SofteningLaw(Protocol):
    """Factors of both moduli against the strain; a frozen dataclass of plain numbers."""

    @property
    def kind(self) -> str:
        """Word for it in case files and results."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        One at and below the strain at which the rubber's moduli were measured.
        """

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters as plain values."""


@dataclass(frozen=True)
class SoftenedSeries:
    """A rubber with both moduli softened where it is excited."""

    rubber: Rubber
    # Largest relative difference from f E' and g E'' at the lowest frequency asked for [-].
    misfit: float


def softened(rubber: Rubber, storage: float, loss: float, omega: ArrayLike) -> SoftenedSeries:
    """Return `rubber` with E' times `storage` and E'' times `loss` [-] at `omega` [rad/s].

    The factors f and g hold at these frequencies, shape (frequencies,); without any all moduli are
    multiplied by f (relaxed rubber). Raises `InputError` if a factor or a frequency is not above
    zero.
    """
    f, g = checks.positive("storage", storage), checks.positive("loss", loss)
    at = checks.positive_vector("omega", omega, unit="rad/s") if np.size(omega) else np.empty(0)
    if f == g or at.size == 0 or rubber.moduli.size == 0:
        return SoftenedSeries(_multiplied(rubber, np.full(rubber.moduli.size + 1, f)), 0.0)
    from scipy.optimize import nnls  # half a second, which reading a case does not pay

    at = np.sort(at)
    slowest_first = np.argsort(rubber.relaxation_times)[::-1]
    moduli = rubber.moduli[slowest_first]
    phase = np.outer(at, rubber.relaxation_times[slowest_first])
    whole = rubber.complex_modulus(at)
    nothing = np.zeros(at.size)
    # The share that each modulus, E_inf and then the slowest first, has in f E' and in g E''.
    real = np.column_stack([nothing + rubber.equilibrium_modulus, storage_shape(phase) * moduli])
    imaginary = np.column_stack([nothing, loss_shape(phase) * moduli])
    rows = np.vstack([real / (f * whole.real)[:, None], imaginary / (g * whole.imag)[:, None]])
    count = rows.shape[1]
    weight = np.tile(np.sqrt(at[0] / at), 2)
    steps = _SMOOTHING * np.diff(np.eye(count), axis=0)
    system = np.vstack([weight[:, None] * rows, steps, KEEPING * np.eye(count)])
    right = np.concatenate([weight, np.zeros(count - 1), np.full(count, KEEPING * f)])
    least = np.zeros(count)
    least[0] = _LEAST * f
    multiplier = nnls(system, right - system @ least)[0] + least
    misfit = np.abs(rows @ multiplier - 1.0).reshape(2, -1)[:, 0]
    in_order = np.empty(count)
    in_order[0], in_order[1 + slowest_first] = multiplier[0], multiplier[1:]
    return SoftenedSeries(_multiplied(rubber, in_order), float(misfit.max()))


def _multiplied(rubber: Rubber, multiplier: Array) -> Rubber:
    kept = multiplier[1:] > 0.0
    return replace(
        rubber,
        equilibrium_modulus=rubber.equilibrium_modulus * float(multiplier[0]),
        moduli=(rubber.moduli * multiplier[1:])[kept],
        relaxation_times=rubber.relaxation_times[kept],
        admissible=None,
    )


class Kraus(Checked):
    """Kraus' law of the Payne effect, in the strain of the sweep it was fitted to.

    Raises `InputError` if a value is out of its range.
    """

    kind: ClassVar[str] = "kraus"

    storage_ratio: float = checked(checks.fraction)
    """Storage modulus at large strain over that at small, G'_inf / G'_0 [-]."""
    loss_ratio: float = checked(checks.fraction)
    """Loss modulus at large strain over its maximum, G''_inf / G''_m [-]."""
    critical_strain: float = checked(checks.positive, quantity="strain")
    """Strain s_c at which half of the storage modulus that breaks is broken [-]."""
    measured_at: float = checked(checks.positive, quantity="strain")
    """Strain of the DMA measurement, where nothing is softened [-]."""
    deformation: Deformation = checked(checks.one_of, choices=DEFORMATIONS)
    """Kind of both strains."""
    exponent: float = checked(checks.positive, default=0.5)
    """Exponent m of the law [-]."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-], at any temperature."""
        amplitude = in_deformation(strain, self.deformation)
        softer = self._moduli(np.maximum(amplitude, self.measured_at))
        measured = self._moduli(np.full(amplitude.shape, self.measured_at))
        storage, loss = (soft / hard for soft, hard in zip(softer, measured, strict=True))
        return SofteningFactors(storage, loss, np.zeros(amplitude.shape, dtype=bool))

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **self.__dict__}

    def _moduli(self, strain: Array) -> tuple[Array, Array]:
        """Return G'/G'_0 and G''/G''_m [-]."""
        power = (strain / self.critical_strain) ** self.exponent
        intact = 1.0 / (1.0 + (strain / self.critical_strain) ** (2.0 * self.exponent))
        peak = 2.0 * power / (1.0 + power**2)
        storage = self.storage_ratio + (1.0 - self.storage_ratio) * intact
        loss = self.loss_ratio + (1.0 - self.loss_ratio) * peak
        return np.asarray(storage), np.asarray(loss)


def in_deformation(strain: ArrayLike, deformation: Deformation) -> Array:
    """Return uniaxial strain amplitudes as those of a deformation with the same energy [-]."""
    uniaxial = np.asarray(strain, dtype=float)
    return uniaxial / UNIAXIAL_OF_SHEAR if deformation == "shear" else uniaxial


def rows_of_sweeps(name: str, values: Any) -> tuple[tuple[float, ...], ...]:
    """Return values above zero of each sweep; raise `InputError` if there is no sweep."""
    try:
        rows = list(values)
    except TypeError:
        rows = []
    if not rows:
        raise InputError(f"{name} must hold at least one sweep; got {checks.short_repr(values)}")
    return tuple(tuple(checks.positive_vector(name, row).tolist()) for row in rows)


class SofteningTable(Checked):
    """Moduli of strain sweeps, interpolated in the logarithms of strain and modulus.

    Beyond the largest strain the last moduli are held and flagged; between two temperatures the
    factors are interpolated linearly, beyond them those of the nearest are held and flagged. Raises
    `InputError` if a value cannot be used, lengths differ, or `measured_at` lies outside a sweep.
    """

    kind: ClassVar[str] = "table"

    strain: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    """Amplitudes of each sweep [-], rising."""
    storage: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    loss: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    """Moduli of each sweep, in any unit: only ratios count."""
    measured_at: float = checked(checks.positive)
    """Strain amplitude at which the master curve was measured [-]: both factors are one there."""
    deformation: Deformation = checked(checks.one_of, choices=DEFORMATIONS)
    """Kind of the strains."""
    temperature: Sequence[float] | None = checked(checks.positive_vector, unit="K", default=None)
    """Of each sweep [K], rising; needed if there are several."""

    def __post_init__(self) -> None:
        super().__post_init__()
        lengths = [list(map(len, sweeps)) for sweeps in (self.strain, self.storage, self.loss)]
        if lengths[0] != lengths[1] or lengths[0] != lengths[2]:
            raise InputError(
                "strain, storage and loss must have equally many values in every sweep; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        for strains in self.strain:
            if len(strains) < 2 or not (np.diff(strains) > 0.0).all():
                raise InputError(
                    "strain must rise over at least 2 values; "
                    f"got {checks.short_repr(list(strains))}"
                )
            if not strains[0] <= self.measured_at <= strains[-1]:
                raise InputError(
                    f"measured_at must lie within the strains of every sweep, {strains[0]:g} to "
                    f"{strains[-1]:g}; got {self.measured_at:g}"
                )
        count = len(self.strain)
        if self.temperature is not None:
            self._set(temperature=tuple(map(float, self.temperature)))
        kelvin = self.temperature
        if kelvin is None and count == 1:
            return
        if kelvin is None or len(kelvin) != count or not (np.diff(kelvin) > 0.0).all():
            raise InputError(
                f"temperature must be one for each of the {count} sweeps, rising; "
                f"got {checks.short_repr(kelvin)}"
            )

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Raises `InputError` if sweeps at several temperatures are asked without one.
        """
        amplitude = in_deformation(strain, self.deformation)
        weights, beyond = np.ones(1), False  # of the sweeps
        if self.temperature is not None and temperature is not None:
            kelvin = np.array(self.temperature)
            weights = np.array([np.interp(temperature, kelvin, row) for row in np.eye(kelvin.size)])
            beyond = not kelvin[0] <= temperature <= kelvin[-1]
        elif len(self.strain) > 1:
            raise InputError(
                "temperature must be given for softening measured at several temperatures"
            )
        at = np.log(np.maximum(amplitude, self.measured_at))
        factors, largest = np.zeros((2, *amplitude.shape)), 0.0
        for sweep in np.flatnonzero(weights).tolist():
            strains, largest = self.strain[sweep], max(largest, self.strain[sweep][-1])
            for which, modulus in enumerate((self.storage, self.loss)):
                logs = np.log(strains), np.log(modulus[sweep])
                measured = np.interp(np.log(self.measured_at), *logs)
                factors[which] += weights[sweep] * np.exp(np.interp(at, *logs) - measured)
        outside = (amplitude > largest) | beyond
        return SofteningFactors(factors[0, ...], factors[1, ...], outside)

    def to_dict(self) -> dict[str, Any]:
        """Return kind and numbers."""
        return {"kind": self.kind, **self.__dict__}


AMPLITUDES = {"single": 1.0, "peak-to-peak": 0.5}
_DOUBLE = re.compile(
    r"peak[\s-]*(to[\s-]*)?peak|p\s?-\s?p\b|pk-pk|double|dsa\b|doppel|spitze", re.I
)
_SINGLE = re.compile(r"single|ssa\b|0\s?-\s?p|zero[\s-]*to[\s-]*peak|einfach", re.I)
_ONE_FREQUENCY = 0.02  # share by which frequencies of one sweep may differ


class StrainSweep(Checked, eq=False):
    """Storage and loss modulus against strain, in order of rising strain.

    Raises `InputError` if a value is not finite, not positive or beyond 1e-100 to 1e100, or the
    lengths differ.
    """

    strain: Vector = checked(checks.positive_vector, repr=False)
    """Single amplitude of strain [-], shape (rows,), above zero."""
    storage: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    loss: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    """E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], shape (rows,)."""
    deformation: str = checked(checks.one_of, choices=("uniaxial", "shear"))
    """What the strain is: of length (uniaxial), or shear."""
    temperature: float | None = checked(checks.positive, unit="K", default=None)
    frequency: float | None = checked(checks.positive, unit="Hz", default=None)
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What was measured, and where the numbers come from."""

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = {"strain": self.strain, "storage": self.storage, "loss": self.loss}
        checks.same_length(1, **columns)
        order = np.argsort(self.strain, kind="stable")
        self._set(**{name: column[order] for name, column in columns.items()})

    def __len__(self) -> int:
        return len(self.strain)

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage


def read_strain_sweep(
    path: str | Path,
    *,
    modulus: str | None = None,
    amplitude: str | None = None,
    temperature: Quantity | None = None,
    frequency: float | None = None,
    name: str | None = None,
    source: str = "",
    **options: Any,
) -> StrainSweep:
    """Read one strain sweep from a text, CSV or Excel file.

    Temperature and frequency are None if neither stated nor given. Titles are those `read_sweeps`
    knows; what the file states need not be given. Raises `FileError` if the file cannot be read or
    holds more than one temperature or frequency. Raises `InputError` if a unit, the kind of modulus
    or of amplitude, or a column is neither stated nor given.

    Parameters
    ----------
    path, name, source, **options
        As in `read_master_curve`; the options have `strain_unit`, too.
    modulus : {"E", "G"}, optional
        Whether the file holds Young's moduli, which come with strain of length, or shear moduli,
        with shear strain; needed unless its titles say so.
    amplitude : {"single", "peak-to-peak"}, optional
        What the strain column holds, unless its title says so (peak-to-peak, double, DSA; single,
        SSA). The peak-to-peak amplitude is halved.
    temperature, frequency : float, optional
        Temperature [K] and frequency [Hz], if no column states them.
    """
    file, layout = file_path(path), FileLayout(modulus=modulus, **options)
    blocks = read_blocks(file, layout, temperature_unit=layout.temperature_unit)
    if len(blocks) > 1:
        raise FileError(f"{file}: expected one strain sweep; got {len(blocks)} tables")
    table = blocks[0].table
    strain = _single_amplitude(table, layout, amplitude)
    storage, loss = young_moduli(table, layout)
    complete = np.isfinite([strain, storage, loss]).all(axis=0)
    strain, storage, loss = (values[complete] for values in (strain, storage, loss))
    moduli = [layout.column(table, name) for name in MODULI if name not in RATIOS]
    kind = layout.modulus_of(table, [column for column in moduli if column is not None])
    if temperature is None and blocks[0].states_temperature(layout):
        kelvin = row_temperatures(blocks[0], layout, None)
        kelvin = kelvin[np.isfinite(kelvin)]
        if kelvin.size and np.ptp(kelvin) > 2.0 * TEMPERATURE_TOLERANCE:
            raise FileError(
                f"{file}: expected one temperature; got {kelvin.min():.2f} to {kelvin.max():.2f} K"
            )
        temperature = float(kelvin.mean()) if kelvin.size else None
    column = layout.column(table, "frequency")
    if frequency is None and column is not None:
        hertz = layout.read(table, "frequency")
        hertz = hertz[np.isfinite(hertz)]
        if hertz.size and hertz.max() > (1.0 + _ONE_FREQUENCY) * hertz.min():
            raise FileError(
                f"{file}: expected one frequency; got {hertz.min():g} to {hertz.max():g} Hz"
            )
        frequency = float(hertz.mean()) if hertz.size else None
    deformation = "shear" if kind == "G" else "uniaxial"
    name = file.stem if name is None else name
    return StrainSweep(strain, storage, loss, deformation, temperature, frequency, name, source)


def _single_amplitude(table: TextTable, layout: FileLayout, amplitude: str | None) -> Array:
    title = table.columns[layout.needed_column(table, "strain")].name
    if amplitude is None:
        patterns = {"peak-to-peak": _DOUBLE, "single": _SINGLE}
        meanings = [word for word, pattern in patterns.items() if pattern.search(title)]
        if len(meanings) != 1:
            why = f"because the title {title or 'of the strain'} does not tell"
            words = f" must be given (single or peak-to-peak), {why}"
            raise unstated(f"{table.path}: ", "amplitude", words)
        amplitude = meanings[0]
    size = AMPLITUDES[checks.one_of("amplitude", amplitude, AMPLITUDES)]
    return size * layout.read(table, "strain")


def softening_of_sweeps(sweeps: Sequence[StrainSweep], *, measured_at: float) -> SofteningTable:
    """Return the softening of strain sweeps; `measured_at` is that of the master curve [-]."""
    sweeps = checks.instances("sweeps", sweeps, StrainSweep)
    kinds = sorted({sweep.deformation for sweep in sweeps})
    if len(kinds) != 1:
        raise InputError(f"sweeps must be all uniaxial or all shear; got {' and '.join(kinds)}")
    kelvins = [sweep.temperature for sweep in sweeps]
    if len(sweeps) > 1 and (None in kelvins or len(set(kelvins)) < len(kelvins)):
        raise InputError(
            "several strain sweeps must each be at a temperature of its own; got "
            + ", ".join("none" if kelvin is None else f"{kelvin:g} K" for kelvin in kelvins)
        )
    ordered = sorted(sweeps, key=lambda sweep: sweep.temperature or 0.0)
    strain, storage, loss = (
        [getattr(s, name).tolist() for s in ordered] for name in ("strain", "storage", "loss")
    )
    temperatures = sorted(kelvin for kelvin in kelvins if kelvin is not None) or None
    deformation: Deformation = "shear" if kinds[0] == "shear" else "tension"
    return SofteningTable(strain, storage, loss, measured_at, deformation, temperatures)
