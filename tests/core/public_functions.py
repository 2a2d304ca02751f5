"""Public functions with arguments they take: each argument is then made absurd, one at a time."""

from collections.abc import Callable, Iterator
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
ROUGH = {"smallest_wavelength": 3.2e-3, "tolerance": None}
LAYER = {"layer_ratio": 1.0, "penetration_depth": 1e-3}


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


def public_functions() -> Iterator[PublicFunction]:
    """Yield every one."""
    yield from _theory()
    yield from _rubber()
    yield from _sweeps()
    yield from _surface()
    yield from _wave()
    yield from _rough()
    yield from _conditions()
    yield from _calibration()
    chain = {"solver": "half_plane", "footprint": 0.1, "points": 64, "pressure_classes": 1}
    more = {"smallest_wavelength": None, "load_time": "passage"}
    yield PublicFunction(
        gs.solve_chain, {"rubber": SOLID, "sines": SINES, **PRESSED, **chain, **more}
    )
    load = {**PRESSED, "footprint": 0.1, "load_time": "passage"}
    yield PublicFunction(Load, load)


def _theory() -> Iterator[PublicFunction]:
    full = {"plane_strain_modulus": 1e6 + 1e5j, **WAVE}
    yield PublicFunction(theory.full_contact_pressure, full)
    yield PublicFunction(theory.full_contact_friction, {**full, "pressure": 1e6})
    yield PublicFunction(theory.plane_strain_modulus, {"youngs_modulus": 1e6, "poisson_ratio": 0.5})
    small = {"load_time": np.inf, "points": 64, "most_iterations": 20}
    yield PublicFunction(theory.solve_half_plane, {"rubber": SOLID, **WAVE, **PRESSED, **small})
    yield PublicFunction(theory.HalfPlane, {"points": 64, "most_iterations": 20})
    limits = {"smallest_wavelength": 1e-3, "gamma": 0.5}
    persson = {"rubber": SOLID, "spectrum": SPECTRUM, **PRESSED, **limits}
    yield PublicFunction(theory.persson, persson, slow=True)
    yield PublicFunction(theory.Persson, limits)
    yield PublicFunction(theory.KlueppelHeinrich, {**LAYER, "smallest_wavelength": 1e-3})
    layer = {**LAYER, "smallest_wavelength": 1e-3}
    yield PublicFunction(
        theory.klueppel_heinrich, {"rubber": SOLID, "surface": FIT, **PRESSED, **layer}
    )


def _rubber() -> Iterator[PublicFunction]:
    series = {"equilibrium_modulus": 1e6, "moduli": [1e6], "relaxation_times": [1.0]}
    more = {"bulk_modulus": 2e9, "valid_band": (1.0, 2.0), "strain_energy": rubber.NeoHookean()}
    yield PublicFunction(gs.Rubber, {**series, **more, "name": "", "source": ""})
    yield PublicFunction(SOLID.complex_modulus, {"omega": [1.0, 2.0]})
    yield PublicFunction(SOLID.loss_factor, {"omega": 1.0})
    yield PublicFunction(SOLID.relaxation_modulus, {"time": 1.0})
    yield PublicFunction(SOLID.poisson_ratio, {"omega": 1.0})
    yield PublicFunction(SOLID.plane_strain_modulus, {"omega": 1.0})
    yield PublicFunction(SOLID.outside_band, {"omega": 1.0})
    curve = {"frequency": [1.0, 2.0], "storage": [1e6, 2e6], "loss": [1e5, 1e5]}
    words = {"reference_temperature": 293.0, "name": "", "source": ""}
    yield PublicFunction(gs.MasterCurve, {**curve, **words})
    fit = {"terms": 3, "bulk_modulus": 2e9, "outlier_threshold": 8.0, "extrapolate_decades": 1.0}
    yield PublicFunction(gs.fit_prony, {"master": MASTER, **fit, "smoothing": 0.1}, slow=True)
    one, several = {"equilibrium_moduli": [1e6], "moduli": [[1e6]]}, {"relaxation_times": [1.0]}
    yield PublicFunction(rubber.AdmissibleSeries, several | one)
    yield PublicFunction(rubber.MooneyRivlin, {"share": 0.2})
    yield PublicFunction(rubber.Yeoh, {"second": -0.1, "third": 0.02})
    yield PublicFunction(rubber.Isihara, {"share": 0.2, "second": 0.1})
    yield PublicFunction(rubber.KrausEnergy, {"ratio": 0.2, "critical": 0.1, "measured_at": 1e-3})
    yield PublicFunction(rubber.strain_energy, {"kind": "yeoh", "second": -0.1, "third": 0.02})
    shear = {"rubber": SOLID, "time": [0.0, 1.0], "shear": [0.0, 0.1]}
    yield PublicFunction(rubber.simple_shear_stress, shear)
    bar = {"rubber": SOLID, "time": [0.0, 1.0], "stretch": [1.0, 1.1]}
    yield PublicFunction(rubber.uniaxial_stress, bar)
    yield PublicFunction(rubber.springpot_modulus, {"omega": [1.0, 2.0]})
    yield PublicFunction(rubber.styrene_butadiene, {"bulk_modulus": 2e9})


def _conditions() -> Iterator[PublicFunction]:
    yield from _shifts()
    kraus = {"storage_ratio": 0.3, "loss_ratio": 0.2, "critical_strain": 0.02, "measured_at": 1e-3}
    yield PublicFunction(softening.Kraus, {**kraus, "deformation": "shear", "exponent": 0.5})
    sweep = {"strain": [1e-3, 1e-2], "storage": [2e6, 1e6], "loss": [2e5, 1e5]}
    table = {name: [values] for name, values in sweep.items()}
    known = {"measured_at": 2e-3, "deformation": "tension", "temperature": [293.0]}
    yield PublicFunction(softening.SofteningTable, {**table, **known})
    yield PublicFunction(softening.TypicalTread, {"deviation": 0.5, "deformation": "shear"})
    words = {"temperature": 293.0, "frequency": 10.0, "name": "", "source": ""}
    yield PublicFunction(rubber.StrainSweep, {**sweep, "deformation": "shear", **words})
    one = rubber.StrainSweep(**sweep, deformation="shear")
    yield PublicFunction(softening.softening_of_sweeps, {"sweeps": [one], "measured_at": 2e-3})
    thermal = {"conductivity": 0.25, "density": 1150.0, "specific_heat": 1500.0}
    yield PublicFunction(interface.ThermalProperties, thermal)
    yield PublicFunction(interface.ConstantStress, {"stress_0": 1e6})
    bell = {"stress_0": 1e6, "width": 0.1, "speed_0": 6e-3}
    warm = {"activation_energy": 0.9, "reference_temperature": 293.0}
    yield PublicFunction(interface.GaussianStress, {**bell, **warm})
    yield PublicFunction(
        interface.GaussianStress(**bell, **warm).stress, {"speed": 0.1, "temperature": 300.0}
    )
    yield PublicFunction(area_term.DryTread, {"deviation": 0.5})
    yield PublicFunction(area_term.DryTread().stress, {"speed": 0.1})
    step = {"stress_0": 1e6, "ratio": 10.0, "critical_speed": 0.1, "exponent": 0.5}
    yield PublicFunction(interface.LeGalKlueppelStress, step)
    yield PublicFunction(interface.TableStress, {"speed": [0.1, 1.0], "stress_at": [1e6, 2e6]})
    term = {"shear_stress": 1e6, "contact_fraction": 0.1, "pressure": 1e5}
    yield PublicFunction(interface.adhesive_friction, term)
    heat, shear = interface.ThermalProperties(**thermal), interface.ConstantStress(1e6)
    law = softening.Kraus(**kraus, deformation="shear")
    asked = {"temperature": 293.0, "softening": law, "strain_norm": "slope"}
    yield PublicFunction(Conditions, {**asked, "heat": heat, "shear_stress": shear, "off": ()})


def _calibration() -> Iterator[PublicFunction]:
    speed, kelvin = [0.01, 0.1, 1.0, 10.0, 100.0], [280.0, 290.0, 300.0, 310.0, 320.0]
    columns = {"speed": speed, "friction": [0.5, 0.6, 0.7, 0.6, 0.5], "spread": [0.1] * 5}
    yield PublicFunction(
        MeasuredFriction, {**columns, "temperature": kelvin, "pressure": [3e5] * 5}
    )
    answer = {"friction": [0.2] * 5, "contact_fraction": [0.03] * 5, "pressure": [3e5] * 5}
    band = {"outside_band": [0.0] * 5, "status": ["converged"] * 5}
    yield PublicFunction(measured.Predicted, {**answer, "temperature": kelvin, **band})
    pair = {
        "measured": MeasuredFriction(**columns),
        "predicted": measured.Predicted(**answer, temperature=kelvin),
    }
    choice = {"law": "gaussian", "fixed": {"width": 0.1}, "hold_out": "speed"}
    yield PublicFunction(fit_area_term, {**pair, **choice})
    beside = {"measured": pair["measured"], "predicted": {"chain": pair["predicted"]}}
    yield PublicFunction(
        measured.residuals, {**beside, "shear_stress": interface.ConstantStress(1e6)}
    )
    yield PublicFunction(measured.averaged, {"parts": [pair["predicted"]]})


def _shifts() -> Iterator[PublicFunction]:
    span = {"reference_temperature": 293.0, "valid_range": (250.0, 350.0)}
    yield PublicFunction(rubber.WLF, {"c1": 8.0, "c2": 120.0, **span})
    yield PublicFunction(
        rubber.Arrhenius, {"activation_energy": 8e4, "valid_range": (250.0, 350.0)}
    )
    glass = {"activation_energy": 2e5, "glass_temperature": 240.0}
    yield PublicFunction(rubber.WLFArrhenius, {"c1": 8.0, "c2": 120.0, **glass, **span})
    table = {"temperature": [280.0, 300.0], "horizontal": [1.0, -1.0]}
    yield PublicFunction(rubber.ShiftTable, table)
    moved = replace(SOLID, reference_temperature=293.0, shift=rubber.WLF(8.0, 120.0))
    yield PublicFunction(moved.at, {"temperature": 300.0})


def _sweeps() -> Iterator[PublicFunction]:
    rows = {"temperature": [280.0, 280.0, 300.0, 300.0], "frequency": [1.0, 10.0] * 2}
    rows |= {"storage": [2e6, 3e6, 1e6, 2e6], "loss": [1e6] * 4}
    yield PublicFunction(rubber.Sweeps, {**rows, "tolerance": 1.0, "name": "", "source": ""})
    yield PublicFunction(rubber.sweeps_from_ramps, {**rows, "step": 10.0})
    choice = {"vertical": False, "shift": None, "moduli": "both"}
    sweeps = {"sweeps": rubber.Sweeps(**rows), "reference_temperature": 290.0}
    yield PublicFunction(gs.superpose, {**sweeps, **choice}, slow=True)
    table = rubber.ShiftTable([280.0, 300.0, 320.0], [1.8, 0.0, -1.2], reference_temperature=300.0)
    span = {"table": table, "reference_temperature": 300.0, "lowest": 270.0}
    yield PublicFunction(rubber.fit_wlf, span)
    yield PublicFunction(rubber.fit_arrhenius, {**span, "highest": 330.0})
    file = str(EXAMPLES / "data/rubber/multi_temperature_polymer/freq_user_raw.csv")
    layout = {"temperature": None, "sheet": None}
    yield PublicFunction(gs.read_sweeps, {"path": file, **layout}, slow=True)


def _surface() -> Iterator[PublicFunction]:
    words = {"name": "", "source": "", "reliable": 1e-3}
    yield PublicFunction(gs.Profile, {"x": PLACE, "z": HEIGHT, **words, "notes": ("one",)})
    yield PublicFunction(gs.HeightMap, {"x": MAP.x, "y": MAP.y, "z": MAP.z, **words})
    yield PublicFunction(MAP.line, {"number": 1, "direction": "x"})
    yield PublicFunction(MAP.lines, {"direction": "x"})
    cleaning = {"crop": (0.0, 1.0), "valid_range": (-1.0, 1.0), "spikes": "isolated"}
    more = {"spike_slope": 3.0, "detrend": "linear"}
    yield PublicFunction(gs.clean, {"profile": LINE, **cleaning, **more})
    across = {"crop": None, "valid_range": (-1.0, 1.0), "trim": 0.5, "spikes": "isolated"}
    yield PublicFunction(gs.clean_map, {"surface": MAP, **across, "spike_slope": 3.0, "form": 1})
    lags = {"top_height_fraction": 1.0, "max_lag": None}
    yield PublicFunction(gs.height_difference, {"profile": LINE, **lags})
    yield PublicFunction(gs.fit_self_affine, {"hdc": CORRELATION})
    law = (0.8, 1e-2, 1e-3, 1e-3, 1e-2, 0.0)
    yield PublicFunction(surface.SelfAffineFit, dict(zip(FITTED, law, strict=True)))
    waves = {"scales": 2, "smallest_wavelength": None, "cut_off": None, "s_wavelength": 3.0}
    first = {"s_amplitude": 2.0, "first_wavelength": 1e-2, "first_amplitude": 1e-3}
    ends = {"single_factor": False, "smallest_lag": None, "largest_lag": None}
    yield PublicFunction(gs.fit_sines, {"hdc": CORRELATION, **waves, **first, **ends})
    stack = {"wavelength": [2e-3, 1e-3], "amplitude": [2e-4, 1e-4]}
    yield PublicFunction(gs.SineStack, stack)
    yield PublicFunction(
        surface.profile_spectrum, {"profile": LINE, "window": None, "taper": "hann"}
    )
    grid = {"z": MAP.z, "x_step": 4e-4, "y_step": 4e-4, "taper": "hann", "per_decade": 10}
    yield PublicFunction(surface.map_spectrum, grid)
    yield PublicFunction(surface.areal_spectrum, {"spectrum": SPECTRUM})
    yield PublicFunction(surface.slope_by_wavelength, {"surface": LONG})
    yield PublicFunction(SLOPES.down_to, {"wavelength": 1e-3, "of": "surface"})
    yield PublicFunction(SLOPES.reaches, {"slope": 0.1, "of": "surface"})
    yield PublicFunction(SLOPES.power_law, {"of": "surface"})
    yield PublicFunction(
        surface.RmsSlope, {"rms_slope": 1.3, "of": "surface", "extrapolate": False}
    )
    yield PublicFunction(surface.find_cut_off, {"surface": LONG, "rule": 1e-3})
    yield PublicFunction(surface.profile_warnings, {"profile": LINE, "cleaned": None})
    places = {"x": PLACE, "z": HEIGHT, "step": 5e-4, "bridge": None, "name": "", "source": ""}
    yield PublicFunction(surface.resample, places)
    road = {"hurst": 0.8, "xi_parallel": 1e-2, "xi_perpendicular": 1e-3}
    size = {"length": 1e-2, "step": 2e-4, "seed": 1}
    yield PublicFunction(surface.self_affine_profile, {**road, **size})
    density = {"wavenumber": [1e3, 2e3], "density": [1e-12, 1e-13], "interpolated": 0.0}
    yield PublicFunction(surface.ArealSpectrum, density)
    yield PublicFunction(gs.Spectrum, {**density, "phases": "worn", "name": "", "source": ""})
    yield PublicFunction(surface.ProfileSpectrum, density)
    lag = {"lag": [1e-3, 2e-3], "value": [1e-8, 2e-8], "resolution_limit": None}
    yield PublicFunction(gs.HeightDifference, lag)
    yield PublicFunction(
        gs.read_map, {"path": "none.txt", "x_unit": None, "step": 1.0, "reader": "auto"}
    )
    units = {"frequency_unit": "Hz", "modulus_unit": "Pa", "modulus": "E", "columns": [0, 1, 2]}
    yield PublicFunction(gs.read_master_curve, {"path": "none.txt", **units})


FITTED = ("hurst", "xi_parallel", "xi_perpendicular", "lag_min", "lag_max", "residual")


def _wave() -> Iterator[PublicFunction]:
    yield PublicFunction(wave.Sine, WAVE)
    yield PublicFunction(wave.SampledProfile, {"wavelength": 1e-3, "heights": HEIGHT})
    yield PublicFunction(wave.WaveLoad, {**PRESSED, "load_time": 1.0})
    yield PublicFunction(wave.Mesh, MESH)
    limits = {"tolerance": None, "time_limit": 0.2}
    small = {"max_iterations": 20, "residual_tolerance": 1e-8, "start": None}
    steady = {"rubber": SOLID, **WAVE, **PRESSED, "load_time": 1.0, **MESH, **limits, **small}
    yield PublicFunction(gs.solve_scale, steady, slow=True)
    line = {"rubber": SOLID, "profile": LINE, **PRESSED, "load_time": 1.0, **limits, **small}
    cut = {"smallest_wavelength": 8e-3, "periodic": False, "columns": 64, "rows": 4}
    yield PublicFunction(
        gs.solve_profile, {**line, **cut, "depth": 1.5, "element_order": 1}, slow=True
    )
    stages = {"stages": [gs.Stage(duration=1e-4, **PRESSED)], **MESH, "start": None}
    yield PublicFunction(gs.solve_transient, {"rubber": SOLID, **WAVE, **stages})
    yield PublicFunction(gs.Stage, {"duration": 1e-3, **PRESSED})
    yield PublicFunction(
        wave.FiniteStrainBlock, {"mesh": wave.Mesh(**MESH), **limits, "settings": {}}
    )
    profile = {"smallest_wavelength": None, "periodic": False, "tolerance": 0.1}
    yield PublicFunction(rough.BlockOnProfile, profile)


def _rough() -> Iterator[PublicFunction]:
    line = {"rubber": SOLID, "surface": LINE, **PRESSED, **ROUGH}
    most = {"periodic": False, "most_points": 4096}
    yield PublicFunction(gs.solve_rough_contact, {**line, **most})
    direct = {"smallest_wavelength": None, "tolerance": 0.02, "most_points": 64}
    yield PublicFunction(rough.DirectContact, {**direct, "periodic": False})
    yield PublicFunction(rough.one_period, {"line": LINE, "smallest_wavelength": 4e-3})
    yield PublicFunction(rough.surface_of_sines, {"stack": SINES, "length": 8e-3, "seed": 1})
    yield PublicFunction(rough.windows, {"surface": LINE, "length": 1e-2})
    spread = {"length": 1e-2, "most": 2}
    yield PublicFunction(rough.spread_windows, {"profiles": [LINE], **spread})
