"""The figures of the paper by name: what each shows, its picture, its data, its statements."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from gripscale.core.errors import InputError
from gripscale.core.provenance import software
from gripscale.surface import SelfAffineFit, SineStack, fit_self_affine
from gripscale.wave.result import LW
from reproduction import judge_area, judge_friction, judge_inputs
from reproduction.draw import (
    Quantity,
    correlations_figure,
    factors_figure,
    master_curves_figure,
    predictions_figure,
)
from reproduction.inputs import DENSE, ROAD, TREAD, Inputs
from reproduction.panels import Solved
from reproduction.statement import Statement

TITLES = {
    "fig2": "Master curves of the compounds",
    "fig3b": "Height difference correlation",
    "fig4": "Sine waves with one and two magnification factors",
    "fig5a": "Contact area for three pairs of factors, static, 3 bar, filled tread",
    "fig5b": "Contact area for three pairs of factors, 300 mm/s, 3 bar, filled tread",
    "fig6a": "Contact area and sliding speed, 3 bar, measured coarse road",
    "fig6b": "Contact area of two compounds, 300 mm/s, 3 bar, measured coarse road",
    "fig7a": "Contact area on two surfaces, 300 mm/s, 3 bar, filled tread",
    "fig7b": "Contact area on two surfaces, 3000 mm/s, 3 bar, filled tread",
    "fig8a": "Friction for three pairs of factors, 300 mm/s, 3 bar, filled tread",
    "fig8b": "Friction and sliding speed, 3 bar, measured coarse road",
    "fig9a": "Friction of two compounds, 3 bar, measured coarse road",
    "fig9b": "Friction and contact area on two surfaces, 300 mm/s, 3 bar, filled tread",
}
"""All figures, with what stands above them."""

FEWEST_WAVES = 3
"""Converged waves a prediction must have for its figure to be judged."""

INPUT_FIGURES = ("fig2", "fig3b", "fig4")


@dataclass(frozen=True)
class Made:
    """A figure: its picture, its data, and the statements about it."""

    figure: Figure
    data: xr.Dataset
    statements: list[Statement]


def make(name: str, inputs: Inputs, solved: Solved, rest: Solved) -> Made:
    """Return a figure from its predictions; `rest` are those of Fig. 5a, which 5b compares with."""
    if name in INPUT_FIGURES:
        made = {"fig2": _fig2, "fig3b": _fig3b, "fig4": _fig4}[name](inputs)
    else:
        figure = _picture(name, solved)
        made = Made(figure, _predictions_data(solved), _judge(name, inputs, solved, rest))
    attrs = {"title": f"{name}: {TITLES[name]}", "after": LW, "software": software()}
    surfaces = "; ".join(f"{name}: {each.source}" for name, each in inputs.surfaces.items())
    rubbers = "; ".join(f"{rubber}: {each.source}" for rubber, each in inputs.rubbers.items())
    said = json.dumps([[s.said, s.where, s.number, s.verdict] for s in made.statements])
    data = made.data.assign_attrs(attrs, surfaces=surfaces, rubbers=rubbers, statements=said)
    return Made(made.figure, data, made.statements)


def self_affine(inputs: Inputs) -> dict[str, SelfAffineFit]:
    """Return the power laws of the surfaces that have one."""
    fits = {}
    for road in inputs.surfaces:
        try:
            fits[road] = fit_self_affine(inputs.correlation(road))
        except InputError:
            continue
    return fits


def _picture(name: str, solved: Solved) -> Figure:
    if name == "fig9b":
        (state, predictions), *_ = solved.items()
        both = {f"friction, {state}": predictions, f"contact area, {state}": predictions}
        return predictions_figure(both, ("running_friction", "area"), TITLES[name])
    quantity: Quantity = "friction" if name in ("fig8a", "fig8b", "fig9a") else "area"
    ordered = name in ("fig6a", "fig8b")
    return predictions_figure(solved, [quantity] * len(solved), TITLES[name], ordered=ordered)


def _judge(name: str, inputs: Inputs, solved: Solved, rest: Solved) -> list[Statement]:
    judges: Mapping[str, Callable[[], list[Statement]]] = {
        "fig5a": lambda: judge_area.judge_progression(name, solved),
        "fig5b": lambda: [
            *judge_area.judge_progression(name, solved),
            *judge_area.judge_motion(rest, solved),
        ],
        "fig6a": lambda: judge_area.judge_speed(solved),
        "fig6b": lambda: judge_area.judge_stiffness(solved),
        "fig7a": lambda: judge_area.judge_surfaces(name, solved),
        "fig7b": lambda: judge_area.judge_surfaces(name, solved),
        "fig8a": lambda: judge_friction.judge_factors_friction(solved),
        "fig8b": lambda: judge_friction.judge_speed_friction(solved, inputs),
        "fig9a": lambda: judge_friction.judge_compounds(solved, inputs),
        "fig9b": lambda: judge_friction.judge_surface_friction(solved, inputs),
    }
    failed = [
        f"{panel}, {line}: {prediction.prediction_status.item()}"
        for panel, lines in solved.items()
        for line, prediction in lines.items()
        if prediction.sizes["scale"] < FEWEST_WAVES
    ]
    if failed:
        criterion = f"at least {FEWEST_WAVES} waves of every chain converge"
        return [Statement(name, TITLES[name], "not judged", criterion, failed[0], False, "solver")]
    return judges[name]()


def _predictions_data(solved: Solved) -> xr.Dataset:
    """Return the numbers per wave and the status of the predictions, by panel and line."""
    rows = []
    for panel, lines in solved.items():
        for line, found in lines.items():
            names = [
                name
                for name, values in found.data_vars.items()
                if values.dims == ("scale",) and np.issubdtype(values.dtype, np.number)
            ]
            row = found[[*names, "prediction_status"]].drop_attrs(deep=False).drop_encoding()
            labels = {"panel": panel, "line": line}
            rows.append(row.assign({k: ((), np.array(v, dtype=object)) for k, v in labels.items()}))
    return xr.concat(rows, dim="prediction", join="outer", coords="minimal", compat="override")


def _fig2(inputs: Inputs) -> Made:
    omega = np.geomspace(1e-2, 1e13, 451)
    attrs = {"units": "Pa", "long_name": "Young's modulus of the Prony series"}
    modulus = np.array([r.complex_modulus(omega) for r in inputs.rubbers.values()])
    data = xr.Dataset(
        {
            "storage_modulus": (("rubber", "angular_frequency"), modulus.real, attrs),
            "loss_modulus": (("rubber", "angular_frequency"), modulus.imag, attrs),
            "measured_storage_modulus": ("measured", inputs.master.storage, {"units": "Pa"}),
            "measured_loss_modulus": ("measured", inputs.master.loss, {"units": "Pa"}),
        },
        coords={
            "rubber": np.array(list(inputs.rubbers), dtype=object),
            "angular_frequency": ("angular_frequency", omega, {"units": "rad/s"}),
            "measured": ("measured", inputs.master.angular_frequency, {"units": "rad/s"}),
        },
    )
    figure = master_curves_figure(inputs.rubbers, {TREAD: inputs.master})
    return Made(figure, data, judge_inputs.judge_master_curves(inputs))


def _fig3b(inputs: Inputs) -> Made:
    curves = {road: inputs.correlation(road) for road in (ROAD, DENSE)}
    fits = self_affine(inputs)
    data: dict[str, xr.DataArray] = {}
    for i, (road, curve) in enumerate(curves.items(), start=1):
        data[f"C_z_{i}"] = _curve(curve.lag, curve.value, f"lag_{i}", road)
        if road in fits:
            data[f"eq_6_{i}"] = _curve(curve.lag, fits[road].evaluate(curve.lag), f"lag_{i}", road)
    figure = correlations_figure(curves, fits)
    return Made(figure, xr.Dataset(data), judge_inputs.judge_correlation(inputs))


def _fig4(inputs: Inputs) -> Made:
    curves = {road: inputs.correlation(road) for road in (DENSE, ROAD)}
    stacks: dict[str, dict[str, SineStack]] = {}
    data: dict[str, xr.DataArray] = {}
    for i, (road, curve) in enumerate(curves.items(), start=1):
        two, one = judge_inputs.single_factor(inputs, road)
        stacks[road] = {
            **inputs.magnified(road),
            f"{two.s_wavelength:.2f}/{two.s_amplitude:.2f}, all fitted": two,
            f"{one.s_wavelength:.2f}, one factor": one,
        }
        data[f"C_z_{i}"] = _curve(curve.lag, curve.value, f"lag_{i}", road)
        for j, (name, stack) in enumerate(stacks[road].items(), start=1):
            waves = stack.height_difference(curve.lag)
            data[f"C_z_{i}_waves_{j}"] = _curve(curve.lag, waves, f"lag_{i}", f"{road}, {name}")
    figure = factors_figure(curves, stacks)
    return Made(figure, xr.Dataset(data), judge_inputs.judge_factors(inputs))


def _curve(lag: np.ndarray, value: np.ndarray, dim: str, of: str) -> xr.DataArray:
    coordinate = xr.DataArray(lag, dims=dim, attrs={"units": "m", "long_name": "lag"})
    attrs = {"units": "m^2", "long_name": "height difference correlation", "of": of}
    return xr.DataArray(value, dims=dim, coords={dim: coordinate}, attrs=attrs)
