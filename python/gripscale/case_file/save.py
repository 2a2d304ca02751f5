"""Saving a case as a case file, with its measurements as text files beside it.

A case from a file keeps its text, with copies of its files. One made in Python is written in SI
units with all digits, so that the case that is read again has the same answers to the last digit:
heights and moduli as tables with a title and a unit for each column, a Prony series as the JSON
file that `gripscale fit-rubber` writes, too.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gripscale.case import Case
from gripscale.case_file.folder import SavedCase, free_target, saved_case, saved_inputs, write_saved
from gripscale.case_file.keys import SCHEMA_LINE
from gripscale.case_file.prepare import named_files
from gripscale.case_file.read import CaseFile, validate
from gripscale.case_file.rubber_tables import ConditionsTable
from gripscale.case_file.schema import case_value, law_keys, table_schema, toml_text
from gripscale.case_file.tables import CaseTables, SolverTable, SurfaceTable
from gripscale.chain.chain import WAVE_SOLVERS, Chain, wave_solver
from gripscale.conditions.conditions import OFF, Conditions
from gripscale.continuation.roughness import FinerMeasurement, HurstExponent
from gripscale.core import Array, FileError, InputError, quantity_in_si
from gripscale.core.provenance import version_of
from gripscale.experiment.measured_friction import MEASURED
from gripscale.rubber import ShiftTable, fit_prony_report
from gripscale.rubber.columns import THREE
from gripscale.rubber.master_curve import MODULI_TITLES
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.rubber.softening import SofteningTable
from gripscale.rubber.strain_energy import NeoHookean
from gripscale.surface import HeightMap, Profile, fit_sines
from gripscale.surface.cut_off import RmsSlope
from gripscale.wave.problem import Mesh


def write_case(case: Case, path: Path) -> Path:
    """Write a case to `path`, its measurements to the folder `inputs` beside it; return `path`."""
    if case.origin.text:
        origin = case.origin
        read = validate(CaseTables, tomllib.loads(origin.text), origin.name)
        file = CaseFile(read, Path(origin.name), origin.text, origin.units)
        for before, now in zip(origin.files, named_files(file), strict=True):
            if before != now:
                raise FileError(f"{file.resolve(now.name)} has changed since the case was read")
        write_saved(saved_case(file, path.parent, path.name), path.parent, path.name)
        return path
    inputs = _Inputs(path.parent, saved_inputs(path.parent, path.name))
    tables = _tables(case, inputs)
    validate(CaseTables, tables, str(path))  # refuses laws that no case file knows
    lines = [
        SCHEMA_LINE.rstrip(),
        f"# Written by gripscale {version_of('gripscale')}. Plain numbers are in SI units; names "
        "of files start at this file.",
    ]
    for name, keys in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {toml_text(keys[key])}" for key in keys)]
    saved = SavedCase("\n".join([*lines, ""]), inputs.contents)
    write_saved(saved, path.parent, path.name)
    return path


@dataclass
class _Inputs:
    """Files to be written into a folder, in which an `earlier` case has some."""

    folder: Path
    earlier: set[str]
    contents: dict[str, bytes] = field(default_factory=dict)

    def add(self, name: str, suffix: str, text: str) -> str:
        """Keep a text; return the name by which the case finds its file."""
        stem = re.sub(r"[^\w-]+", "_", name).strip("_")[:60]
        file, content = Path(f"{stem}{suffix}"), text.encode("utf-8")
        target = free_target(file, content, set(self.contents), self.folder, self.earlier)
        self.contents[target] = content
        return target

    def add_table(self, name: str, columns: Mapping[str, ArrayLike], head: str = "") -> str:
        """Keep columns by their titles, below a comment; return the name of their file."""
        numbers = [np.asarray(values, dtype=float).tolist() for values in columns.values()]
        rows = [",".join(map(repr, row)) for row in zip(*numbers, strict=True)]
        return self.add(name, ".csv", "\n".join([head, ",".join(columns), *rows, ""]).lstrip())

    def add_heights(self, name: str, heights: Profile | HeightMap) -> str:
        """Keep a profile or the points of a map; return the name of the file."""
        # such a title keeps the doubt that the heights may be depths
        title = "depth [m]" if heights.doubts else "z [m]"
        if isinstance(heights, HeightMap):
            along, across = heights.z.shape
            x, y = np.repeat(heights.x, across), np.tile(heights.y, along)
            return self.add_table(name, {"x [m]": x, "y [m]": y, title: heights.z.ravel()})
        unit, x = _even_distances(heights.x)
        return self.add_table(name, {f"x [{unit}]": x, title: heights.z})


def _even_distances(x: Array) -> tuple[str, Array]:
    """Return a unit and the even grid that is `x` [m] to the last bit once a file is read.

    Without one, `x` itself: readers return even grids only, which differ in the last digits.
    """
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)):
        for digits in (17, 12):  # of a number as computed, and as instruments print it
            first, last = (float(f"{end / size:.{digits}g}") for end in (x[0], x[-1]))
            grid = np.linspace(first, last, x.size)
            if np.array_equal(quantity_in_si(grid, unit, "length"), x):
                return unit, grid
    return "m", x


def _tables(case: Case, inputs: _Inputs) -> dict[str, dict[str, Any]]:
    """Return the tables of a case by name, each with the keys that have a value."""
    load, continued = case.load, case.below_measurement
    below: dict[str, Any] = {"down_to": continued.down_to, "seed": continued.seed}
    match continued.roughness:
        case HurstExponent(hurst=hurst):
            below["hurst"] = hurst
        case FinerMeasurement(surface=face):
            kind = "map" if isinstance(face, HeightMap) else "file"
            below["finer"] = {kind: inputs.add_heights(face.name or "finer", face)}
    measured = {}
    if case.friction is not None:
        columns = {
            name if unit == "1" else f"{name} [{unit}]": getattr(case.friction, name)
            for name, (unit, _) in MEASURED.items()
        }
        measured["friction"] = inputs.add_table("friction", columns)
    tables: dict[str, dict[str, Any]] = {
        "surface": _surface_keys(case, inputs)
        | {"kind": None if case.kind == "surface" else case.kind},
        "rubber": _rubber_keys(case.measured_rubber, inputs)
        | {"thickness": load.thickness, "extrapolate": case.chain.extrapolate}
        | {"filled": case.filled},
        "load": vars(load) | {"thickness": None, "tester": case.tester or None},
        "solver": _solver_keys(case.chain),
        "chain": {"pressure_classes": case.chain.pressure_classes},
        "conditions": _conditions_keys(case.stated_conditions, inputs)
        | {"interface": case.interface},
        "below_measurement": below,
        "measured": measured,
        "compare": {} if case.klueppel_heinrich is None else law_keys(case.klueppel_heinrich),
        "uncertainty": case.options.get("uncertainty", {}),
    }
    schemas = table_schema(CaseTables)["properties"]
    for name, keys in tables.items():
        tables[name] = {
            key: case_value(value, schemas[name]["properties"][key])
            for key, value in keys.items()
            if value not in (None, (), [], {})
        }
    return {name: keys for name, keys in tables.items() if keys}


def _surface_keys(case: Case, inputs: _Inputs) -> dict[str, Any]:
    surface, measured = case.surface, case.surface.measured
    if measured is None:
        if surface.sines.cut_off is not None or surface.end is not None:
            raise InputError("a case file cannot state waves that end beyond the last one")
        pairs = zip(surface.sines.wavelength, surface.sines.amplitude, strict=True)
        return {"sines": [{"wavelength": float(w), "amplitude": float(a)} for w, a in pairs]}
    fitted = surface.correlation and fit_sines(surface.correlation, **surface.fit)
    if not fitted or not all(
        np.array_equal(getattr(fitted, part), getattr(surface.sines, part))
        for part in ("wavelength", "amplitude")
    ):
        raise InputError("a case file cannot state waves that are not fitted to the heights")
    keys: dict[str, Any] = {}
    reliable: set[float | None] = {None}
    if (spectrum := surface.spectrum) is not None:
        columns = {"q [1/m]": spectrum.wavenumber, "C(q) [m^4]": spectrum.density}
        keys["phases"] = spectrum.phases
        keys["spectrum"] = inputs.add_table(spectrum.name or "spectrum", columns)
    elif measured.map is not None:
        reliable = {measured.map.reliable}
        keys["map"] = inputs.add_heights(measured.map.name or "map", measured.map)
    else:
        # heights that a question may clean otherwise are kept as they were before
        read = [*measured.profiles, *measured.across]
        lines = [raw if case.cleaning else cleaned for raw, cleaned in read]
        keys["lay"] = [line.lay for line in lines] if measured.across else None
        reliable = {line.reliable for line in lines}
        keys["files"] = [inputs.add_heights(line.name or "profile", line) for line in lines]
    if len(reliable) > 1:
        raise InputError("a case file cannot state profiles of unlike reliable wavelengths")
    keys |= {"reliable": reliable.pop(), "clean": bool(case.cleaning)} if not spectrum else {}
    numbers = {**case.cleaning, **surface.counted, **surface.fit}
    rule = surface.rule
    numbers["cut_off"] = asdict(rule) if isinstance(rule, RmsSlope) else rule
    for name, value in numbers.items():
        if name not in SurfaceTable.model_fields:
            raise InputError(f"a case file cannot state {name} of the surface")
        if value != SurfaceTable.model_fields[name].default:
            keys[name] = list(value) if isinstance(value, tuple) else value
    if "spikes" in keys:
        keys["spikes"] = keys["spikes"] or "none"
    return keys


def _rubber_keys(measured: MeasuredRubber, inputs: _Inputs) -> dict[str, Any]:
    rubber, master = measured.rubber, measured.master
    name = rubber.name or "rubber"
    if master is None:
        return {"file": inputs.add(name, ".json", json.dumps(rubber.to_dict(), indent=1))}
    usual, _ = fit_prony_report(master, bulk_modulus=rubber.bulk_modulus)
    even = measured.fitted_for(np.zeros(1), np.ones(1)).rubber  # before its fit for this case
    series = ("equilibrium_modulus", "moduli", "relaxation_times")
    if not all(np.array_equal(getattr(usual, key), getattr(even, key)) for key in series):
        raise InputError(
            "a case file cannot state how this series was fitted to its master curve; a case with "
            "its Rubber alone can be saved"
        )
    columns = dict(zip(MODULI_TITLES, (getattr(master, name) for name in THREE), strict=True))
    keys: dict[str, Any] = {"file": inputs.add_table(name, columns), "source": rubber.source}
    keys["bulk_modulus"] = rubber.bulk_modulus
    if rubber.strain_energy != NeoHookean():
        keys["strain_energy"] = rubber.strain_energy
    keys["reference_temperature"] = rubber.reference_temperature
    match rubber.shift:
        case ShiftTable() as table:
            factors = {
                "temperature [K]": table.temperature,
                "log10 a_T": table.horizontal,
                "error of log10 a_T": table.horizontal_error,
                "log10 b_T": table.vertical,
                "error of log10 b_T": table.vertical_error,
            }
            kelvin = table.reference_temperature
            head = "" if kelvin is None else f"# reference temperature (K): {kelvin!r}"
            keys["shift"] = inputs.add_table(f"{name}_shift", factors, head)
        case law:
            keys["shift"] = law
    return keys


def _solver_keys(chain: Chain) -> dict[str, Any]:
    solver = chain.solver
    if solver.name not in WAVE_SOLVERS:
        raise InputError(f"a case file cannot state the solver {solver.name} of the chain")
    mesh = getattr(solver, "mesh", Mesh())
    stating = vars(solver) | (vars(mesh) if mesh != Mesh() else {})
    options = {key: stating[key] for key in SolverTable.model_fields if key in stating}
    if wave_solver(solver.name, options) != solver:
        raise InputError(f"a case file cannot state all options of the solver {solver.name}")
    if chain.rubber_at is not None:
        raise InputError("a case file cannot state the rubber of each wave (rubber_at)")
    return {"model": solver.name, **options}


def _conditions_keys(conditions: Conditions | None, inputs: _Inputs) -> dict[str, Any]:
    if conditions is None:
        return {}
    names = ConditionsTable.model_fields.keys() - {"interface"}
    keys = {name: getattr(conditions, name) for name in names} | dict.fromkeys(conditions.off, OFF)
    keys["water"] = conditions.to_dict()["water"]
    law = conditions.softening
    if law is None:
        keys["strain_norm"] = None
    if isinstance(law, SofteningTable):  # shear moduli are read as thirds of Young's
        letter, divisor = ("G", 3.0) if law.deformation == "shear" else ("E", 1.0)
        files = []
        for at, strain in enumerate(law.strain):
            columns: dict[str, ArrayLike] = {
                "strain amplitude [1]": strain,
                f"{letter}' [Pa]": np.array(law.storage[at]) / divisor,
                f"{letter}'' [Pa]": np.array(law.loss[at]) / divisor,
            }
            if law.temperature is not None:
                columns["temperature [K]"] = np.full(len(strain), law.temperature[at])
            files.append(inputs.add_table("strain_sweep", columns))
        sweeps: dict[str, Any] = {"measured_at": law.measured_at, "deformation": law.deformation}
        sweeps["amplitude"] = None if law.amplitude_assumed else "single"
        stating = {key: value for key, value in sweeps.items() if value is not None}
        keys["softening"] = {"kind": "table", "files": files, **stating}
    return {name: keys[name] for name in ConditionsTable.model_fields if name in keys}
