"""Public functions with arguments they take: each argument is then made absurd, one at a time."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import gripscale as gs
from gripscale import conditions as interface
from gripscale import half_space as rough
from gripscale import questions as measured
from gripscale import rubber, surface, theory, wave
from gripscale.conditions import Conditions, area_term
from gripscale.experiment import MeasuredFriction
from gripscale.model import Load
from gripscale.questions import fit_area_term
from gripscale.rubber import softening
from tests.samples import EXAMPLES

SOLID = gs.Rubber(1e6, [4e6], [1e-2], name="solid")
FREQUENCY = np.geomspace(1e-2, 1e6, 30)
MASTER = gs.MasterCurve(
    FREQUENCY, SOLID.complex_modulus(FREQUENCY).real, SOLID.complex_modulus(FREQUENCY).imag
)
PLACE = np.arange(64) * 4e-4
HEIGHT = 1e-4 * np.cos(2.0 * np.pi * np.arange(64) / 64.0) + 2e-5 * np.cos(0.9 * np.arange(64))
LINE = gs.Profile(PLACE, HEIGHT)
MAP = gs.HeightMap(PLACE[:32], PLACE[:32], HEIGHT[:32, None] + HEIGHT[None, :32])
LONG = surface.self_affine_profile(0.8, 4e-3, 1e-4, length=0.2, step=2e-4, seed=1)
CORRELATION = gs.height_difference(LONG)
SINES = surface.SineStack([8e-3, 2e-3], [5e-4, 1e-4])
SPECTRUM = surface.profile_spectrum(LONG)
SLOPES = surface.slope_by_wavelength(LONG)
FIT = gs.fit_self_affine(CORRELATION)
WAVE = {"wavelength": 1e-3, "amplitude": 1e-4}
PRESSED = {"pressure": 1e5, "speed": 0.1}
MESH = {"columns": 8, "rows": 4, "depth": 1.5, "element_order": 1}
PLANE = {"points": 64, "most_iterations": 20}


@dataclass(frozen=True)
class PublicFunction:
    """A public function and arguments it takes."""

    call: Callable[..., Any]
    good: dict[str, Any]
    slow: bool = False
    """Whether an answer takes seconds, so that only what must be refused is tried."""

    @property
    def name(self) -> str:
        return self.call.__qualname__


def quick(call: Callable[..., Any], **good: Any) -> PublicFunction:
    """Return a function whose answers take no time."""
    return PublicFunction(call, good)


def slow(call: Callable[..., Any], **good: Any) -> PublicFunction:
    """Return a function whose answers take seconds."""
    return PublicFunction(call, good, slow=True)


def public_functions() -> list[PublicFunction]:
    """Return every one."""
    parts = (THEORY, RUBBER, SWEEPS, SURFACE, WAVES, ROUGH_CONTACT, CONDITIONS, CALIBRATION, CHAIN)
    return [function for part in parts for function in part]


LAYER = {"layer_ratio": 1.0, "penetration_depth": 1e-3, "smallest_wavelength": 1e-3}
PERSSON = {"smallest_wavelength": 1e-3, "gamma": 0.5}
FULL = {"plane_strain_modulus": 1e6 + 1e5j, **WAVE}
THEORY = [
    quick(theory.full_contact_pressure, **FULL),
    quick(theory.full_contact_friction, **FULL, pressure=1e6),
    quick(theory.plane_strain_modulus, youngs_modulus=1e6, poisson_ratio=0.5),
    quick(theory.solve_half_plane, rubber=SOLID, **WAVE, **PRESSED, load_time=np.inf, **PLANE),
    quick(theory.HalfPlane, **PLANE),
    slow(theory.persson, rubber=SOLID, spectrum=SPECTRUM, **PRESSED, **PERSSON),
    quick(theory.Persson, **PERSSON),
    quick(theory.KlueppelHeinrich, **LAYER),
    quick(theory.klueppel_heinrich, rubber=SOLID, surface=FIT, **PRESSED, **LAYER),
]
FITTED = {"terms": 3, "bulk_modulus": 2e9, "outlier_threshold": 8.0, "extrapolate_decades": 1.0}
NAMED = {"name": "", "source": ""}
RUBBER = [
    quick(
        gs.Rubber, equilibrium_modulus=1e6, moduli=[1e6], relaxation_times=[1.0], bulk_modulus=2e9,
        valid_band=(1.0, 2.0), strain_energy=rubber.NeoHookean(), **NAMED,
    ),
    quick(SOLID.complex_modulus, omega=[1.0, 2.0]),
    quick(SOLID.loss_factor, omega=1.0),
    quick(SOLID.relaxation_modulus, time=1.0),
    quick(SOLID.poisson_ratio, omega=1.0),
    quick(SOLID.plane_strain_modulus, omega=1.0),
    quick(SOLID.outside_band, omega=1.0),
    quick(
        gs.MasterCurve, frequency=[1.0, 2.0], storage=[1e6, 2e6], loss=[1e5, 1e5],
        reference_temperature=293.0, **NAMED,
    ),
    slow(gs.fit_prony, master=MASTER, **FITTED, smoothing=0.1),
    quick(
        rubber.AdmissibleSeries, relaxation_times=[1.0], equilibrium_moduli=[1e6], moduli=[[1e6]]
    ),
    quick(rubber.MooneyRivlin, share=0.2),
    quick(rubber.Yeoh, second=-0.1, third=0.02),
    quick(rubber.Isihara, share=0.2, second=0.1),
    quick(rubber.KrausEnergy, ratio=0.2, critical=0.1, measured_at=1e-3),
    quick(rubber.strain_energy, kind="yeoh", second=-0.1, third=0.02),
    quick(rubber.simple_shear_stress, rubber=SOLID, time=[0.0, 1.0], shear=[0.0, 0.1]),
    quick(rubber.uniaxial_stress, rubber=SOLID, time=[0.0, 1.0], stretch=[1.0, 1.1]),
    quick(rubber.springpot_modulus, omega=[1.0, 2.0]),
    quick(rubber.styrene_butadiene, bulk_modulus=2e9),
]  # fmt: skip
SPAN = {"reference_temperature": 293.0, "valid_range": (250.0, 350.0)}
GLASS = {"activation_energy": 2e5, "glass_temperature": 240.0}
SHIFTED = replace(SOLID, reference_temperature=293.0, shift=rubber.WLF(8.0, 120.0))
KRAUS = {"storage_ratio": 0.3, "loss_ratio": 0.2, "critical_strain": 0.02, "measured_at": 1e-3}
SWEEP = {"strain": [1e-3, 1e-2], "storage": [2e6, 1e6], "loss": [2e5, 1e5]}
THERMAL = {"conductivity": 0.25, "density": 1150.0, "specific_heat": 1500.0}
BELL = interface.GaussianStress(1e6, 0.1, 6e-3, 0.9, 293.0)
CONDITIONS = [
    quick(rubber.WLF, c1=8.0, c2=120.0, **SPAN),
    quick(rubber.Arrhenius, activation_energy=8e4, valid_range=(250.0, 350.0)),
    quick(rubber.WLFArrhenius, c1=8.0, c2=120.0, **GLASS, **SPAN),
    quick(rubber.ShiftTable, temperature=[280.0, 300.0], horizontal=[1.0, -1.0]),
    quick(SHIFTED.at, temperature=300.0),
    quick(softening.Kraus, **KRAUS, deformation="shear", exponent=0.5),
    quick(
        softening.SofteningTable, **{name: [values] for name, values in SWEEP.items()},
        measured_at=2e-3, deformation="tension", temperature=[293.0],
    ),
    quick(softening.TypicalTread, deviation=0.5, deformation="shear"),
    quick(
        rubber.StrainSweep, **SWEEP, deformation="shear", temperature=293.0, frequency=10.0, **NAMED
    ),
    quick(
        softening.softening_of_sweeps, sweeps=[rubber.StrainSweep(**SWEEP, deformation="shear")],
        measured_at=2e-3,
    ),
    quick(interface.ThermalProperties, **THERMAL),
    quick(interface.ConstantStress, stress_0=1e6),
    quick(
        interface.GaussianStress, stress_0=1e6, width=0.1, speed_0=6e-3, activation_energy=0.9,
        reference_temperature=293.0,
    ),
    quick(BELL.stress, speed=0.1, temperature=300.0),
    quick(area_term.DryTread, deviation=0.5),
    quick(area_term.DryTread().stress, speed=0.1),
    quick(
        interface.LeGalKlueppelStress, stress_0=1e6, ratio=10.0, critical_speed=0.1, exponent=0.5
    ),
    quick(interface.TableStress, speed=[0.1, 1.0], stress_at=[1e6, 2e6]),
    quick(interface.adhesive_friction, shear_stress=1e6, contact_fraction=0.1, pressure=1e5),
    quick(
        Conditions, temperature=293.0, softening=softening.Kraus(**KRAUS, deformation="shear"),
        strain_norm="slope", heat=interface.ThermalProperties(**THERMAL),
        shear_stress=interface.ConstantStress(1e6), off=(),
    ),
]  # fmt: skip
KELVIN = [280.0, 290.0, 300.0, 310.0, 320.0]
COLUMNS = {
    "speed": [0.01, 0.1, 1.0, 10.0, 100.0], "friction": [0.5, 0.6, 0.7, 0.6, 0.5],
    "spread": [0.1] * 5,
}  # fmt: skip
ANSWER = {"friction": [0.2] * 5, "contact_fraction": [0.03] * 5, "pressure": [3e5] * 5}
MEASURED = MeasuredFriction(**COLUMNS)
PREDICTED = measured.Predicted(**ANSWER, temperature=KELVIN)
CALIBRATION = [
    quick(MeasuredFriction, **COLUMNS, temperature=KELVIN, pressure=[3e5] * 5),
    quick(
        measured.Predicted, **ANSWER, temperature=KELVIN, outside_band=[0.0] * 5,
        status=["converged"] * 5,
    ),
    quick(
        fit_area_term, measured=MEASURED, predicted=PREDICTED, law="gaussian",
        fixed={"width": 0.1}, hold_out="speed",
    ),
    quick(
        measured.residuals, measured=MEASURED, predicted={"chain": PREDICTED},
        shear_stress=interface.ConstantStress(1e6),
    ),
    quick(measured.averaged, parts=[PREDICTED]),
]  # fmt: skip
ROWS = {
    "temperature": [280.0, 280.0, 300.0, 300.0], "frequency": [1.0, 10.0] * 2,
    "storage": [2e6, 3e6, 1e6, 2e6], "loss": [1e6] * 4,
}  # fmt: skip
TABLE = rubber.ShiftTable([280.0, 300.0, 320.0], [1.8, 0.0, -1.2], reference_temperature=300.0)
WLF_FIT = {"table": TABLE, "reference_temperature": 300.0, "lowest": 270.0}
FILE = str(EXAMPLES / "data/rubber/multi_temperature_polymer/freq_user_raw.csv")
SWEEPS = [
    quick(rubber.Sweeps, **ROWS, tolerance=1.0, **NAMED),
    quick(rubber.sweeps_from_ramps, **ROWS, step=10.0),
    slow(
        gs.superpose, sweeps=rubber.Sweeps(**ROWS), reference_temperature=290.0, vertical=False,
        shift=None, moduli="both",
    ),
    quick(rubber.fit_wlf, **WLF_FIT),
    quick(rubber.fit_arrhenius, **WLF_FIT, highest=330.0),
    slow(gs.read_sweeps, path=FILE, temperature=None, sheet=None),
]  # fmt: skip
LAW = {
    "hurst": 0.8, "xi_parallel": 1e-2, "xi_perpendicular": 1e-3, "lag_min": 1e-3, "lag_max": 1e-2,
    "residual": 0.0,
}  # fmt: skip
RANGE = {"valid_range": (-1.0, 1.0), "spikes": "isolated", "spike_slope": 3.0}
DENSITY = {"wavenumber": [1e3, 2e3], "density": [1e-12, 1e-13], "interpolated": 0.0}
SURFACE = [
    quick(gs.Profile, x=PLACE, z=HEIGHT, **NAMED, reliable=1e-3, notes=("one",)),
    quick(gs.HeightMap, x=MAP.x, y=MAP.y, z=MAP.z, **NAMED, reliable=1e-3),
    quick(MAP.line, number=1, direction="x"),
    quick(MAP.lines, direction="x"),
    quick(gs.clean, profile=LINE, crop=(0.0, 1.0), **RANGE, detrend="linear"),
    quick(gs.clean_map, surface=MAP, crop=None, trim=0.5, **RANGE, form=1),
    quick(gs.height_difference, profile=LINE, top_height_fraction=1.0, max_lag=None),
    quick(gs.fit_self_affine, hdc=CORRELATION),
    quick(surface.SelfAffineFit, **LAW),
    quick(
        gs.fit_sines, hdc=CORRELATION, scales=2, smallest_wavelength=None, cut_off=None,
        s_wavelength=3.0, s_amplitude=2.0, first_wavelength=1e-2, first_amplitude=1e-3,
        single_factor=False, smallest_lag=None, largest_lag=None,
    ),
    quick(gs.SineStack, wavelength=[2e-3, 1e-3], amplitude=[2e-4, 1e-4]),
    quick(surface.profile_spectrum, profile=LINE, window=None, taper="hann"),
    quick(surface.map_spectrum, z=MAP.z, x_step=4e-4, y_step=4e-4, taper="hann", per_decade=10),
    quick(surface.areal_spectrum, spectrum=SPECTRUM),
    quick(surface.slope_by_wavelength, surface=LONG),
    quick(SLOPES.down_to, wavelength=1e-3, of="surface"),
    quick(SLOPES.reaches, slope=0.1, of="surface"),
    quick(SLOPES.power_law, of="surface"),
    quick(surface.RmsSlope, rms_slope=1.3, of="surface", extrapolate=False),
    quick(surface.find_cut_off, surface=LONG, rule=1e-3),
    quick(surface.profile_warnings, profile=LINE, cleaned=None),
    quick(surface.resample, x=PLACE, z=HEIGHT, step=5e-4, bridge=None, **NAMED),
    quick(
        surface.self_affine_profile, hurst=0.8, xi_parallel=1e-2, xi_perpendicular=1e-3,
        length=1e-2, step=2e-4, seed=1,
    ),
    quick(surface.ArealSpectrum, **DENSITY),
    quick(gs.Spectrum, **DENSITY, phases="worn", **NAMED),
    quick(surface.ProfileSpectrum, **DENSITY),
    quick(gs.HeightDifference, lag=[1e-3, 2e-3], value=[1e-8, 2e-8], resolution_limit=None),
    quick(gs.read_map, path="none.txt", x_unit=None, step=1.0, reader="auto"),
    quick(
        gs.read_master_curve, path="none.txt", frequency_unit="Hz", modulus_unit="Pa", modulus="E",
        columns=[0, 1, 2],
    ),
]  # fmt: skip
LIMITS = {"tolerance": None, "time_limit": 0.2}
ITERATION = {"max_iterations": 20, "residual_tolerance": 1e-8, "start": None, "load_time": 1.0}
WAVES = [
    quick(wave.Sine, **WAVE),
    quick(wave.SampledProfile, wavelength=1e-3, heights=HEIGHT),
    quick(wave.WaveLoad, **PRESSED, load_time=1.0),
    quick(wave.Mesh, **MESH),
    slow(gs.solve_scale, rubber=SOLID, **WAVE, **PRESSED, **MESH, **LIMITS, **ITERATION),
    slow(
        gs.solve_profile, rubber=SOLID, profile=LINE, **PRESSED, **LIMITS, **ITERATION,
        smallest_wavelength=8e-3, periodic=False, **MESH | {"columns": 64},
    ),
    quick(
        gs.solve_transient, rubber=SOLID, **WAVE, stages=[gs.Stage(duration=1e-4, **PRESSED)],
        **MESH, start=None,
    ),
    quick(gs.Stage, duration=1e-3, **PRESSED),
    quick(wave.FiniteStrainBlock, mesh=wave.Mesh(**MESH), **LIMITS, settings={}),
]  # fmt: skip
ROUGH_CONTACT = [
    quick(rough.BlockOnProfile, smallest_wavelength=None, periodic=False, tolerance=0.1),
    quick(
        gs.solve_rough_contact, rubber=SOLID, surface=LINE, **PRESSED, smallest_wavelength=3.2e-3,
        tolerance=None, periodic=False, most_points=4096,
    ),
    quick(
        rough.DirectContact, smallest_wavelength=None, tolerance=0.02, most_points=64,
        periodic=False,
    ),
    quick(rough.one_period, line=LINE, smallest_wavelength=4e-3),
    quick(rough.surface_of_sines, stack=SINES, length=8e-3, seed=1),
    quick(rough.windows, surface=LINE, length=1e-2),
    quick(rough.spread_windows, profiles=[LINE], length=1e-2, most=2),
]  # fmt: skip
CHAIN = [
    quick(
        gs.solve_chain, rubber=SOLID, sines=SINES, **PRESSED, solver="half_plane", footprint=0.1,
        points=64, pressure_classes=1, smallest_wavelength=None, load_time="passage",
    ),
    quick(Load, **PRESSED, footprint=0.1, load_time="passage"),
]  # fmt: skip
