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
    both_correlations_figure,
    correlations_figure,
    factors_figure,
    master_curves_figure,
    predictions_figure,
)
from reproduction.inputs import Inputs
from reproduction.panels import Solved
from reproduction.statement import Statement

TITLES = {
    "fig2": "Master curves of the compounds",
    "fig3b": "Height difference correlation and its power law",
    "fig4": "Sine waves with one and two magnification factors",
    "fig5a": "Contact area for pairs of magnification factors, static, 3 bar, {rubber}",
    "fig5b": "Contact area for pairs of magnification factors, 300 mm/s, 3 bar, {rubber}",
    "fig6a": "Contact area and sliding speed, 3 bar, {rubber}, {surface}",
    "fig6b": "Contact area of two compounds, 3000 mm/s, 3 bar, {surface}",
    "fig7a": "Height difference correlation of both surfaces",
    "fig7b": "Contact area on two surfaces, 300 mm/s, 3 bar, {rubber}",
    "fig8a": "Friction for pairs of magnification factors, 300 mm/s, 3 bar, {rubber}",
    "fig8b": "Friction and sliding speed, 3 bar, {surface}",
    "fig9a": "Friction of two compounds, 3 bar, {surface}",
    "fig9b": "Friction and contact area on two surfaces, 300 mm/s, 3 bar, {rubber}",
}
"""All figures, with what stands above them."""

FEWEST_WAVES = 3
"""Converged waves a prediction must have for its figure to be judged."""


@dataclass(frozen=True)
class Made:
    """A figure: its picture, its data, and the statements about it."""

    figure: Figure
    data: xr.Dataset
    statements: list[Statement]


def title_of(name: str, inputs: Inputs) -> str:
    """Return what stands above a figure."""
    return TITLES[name].format(rubber=inputs.rubber, surface=inputs.surface)


def make(name: str, inputs: Inputs, solved: Solved, rest: Solved) -> Made:
    """Return a figure from its predictions; `rest` are those of Fig. 5a, which 5b compares with."""
    of_inputs = {"fig2": _fig2, "fig3b": _fig3b, "fig4": _fig4, "fig7a": _fig7a}
    title = title_of(name, inputs)
    if name in of_inputs:
        made = of_inputs[name](inputs)
    else:
        figure = _picture(name, title, solved)
        made = Made(figure, _predictions_data(solved), _judge(name, inputs, solved, rest))
    attrs = {"title": f"{name}: {title}", "after": LW, "software": software()}
    surfaces = "; ".join(f"{name}: {each.source}" for name, each in inputs.surfaces.items())
    rubbers = "; ".join(f"{name}: {each.source}" for name, each in inputs.rubbers.items())
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


def _picture(name: str, title: str, solved: Solved) -> Figure:
    if name == "fig9b":
        ((state, predictions),) = solved.items()
        both = {f"friction, {state}": predictions, f"contact area, {state}": predictions}
        return predictions_figure(both, ("friction", "area"), title)
    quantity: Quantity = "friction" if name in ("fig8a", "fig8b", "fig9a") else "area"
    ordered = name in ("fig6a", "fig8b")
    return predictions_figure(solved, [quantity] * len(solved), title, ordered=ordered)


def _judge(name: str, inputs: Inputs, solved: Solved, rest: Solved) -> list[Statement]:
    judges: Mapping[str, Callable[[], list[Statement]]] = {
        "fig5a": lambda: judge_area.judge_progression(name, solved, inputs),
        "fig5b": lambda: [
            *judge_area.judge_progression(name, solved, inputs),
            *judge_area.judge_motion(rest, solved, inputs),
        ],
        "fig6a": lambda: judge_area.judge_speed(solved, inputs),
        "fig6b": lambda: judge_area.judge_stiffness(solved, inputs),
        "fig7b": lambda: judge_area.judge_surfaces(solved, inputs),
        "fig8a": lambda: judge_friction.judge_factors_friction(solved, inputs),
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
        said = f"all statements about {title_of(name, inputs)}"
        return [Statement(name, said, failed[0].split(":")[0], criterion, failed[0], None)]
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
    rubbers = inputs.rubbers
    measured = {n: c.master for n, c in inputs.compounds.items() if c.master is not None}
    modulus = np.array([rubber.complex_modulus(omega) for rubber in rubbers.values()])
    data = xr.Dataset(
        {
            "storage_modulus": (("rubber", "angular_frequency"), modulus.real, attrs),
            "loss_modulus": (("rubber", "angular_frequency"), modulus.imag, attrs),
        },
        coords={
            "rubber": np.array(list(rubbers), dtype=object),
            "angular_frequency": ("angular_frequency", omega, {"units": "rad/s"}),
        },
    )
    for i, (name, rows) in enumerate(measured.items(), start=1):
        dim, at = f"row_{i}", {"units": "Pa", "of": name}
        data[f"measured_storage_modulus_{i}"] = (dim, rows.storage, at)
        data[f"measured_loss_modulus_{i}"] = (dim, rows.loss, at)
        data[f"measured_frequency_{i}"] = (dim, rows.angular_frequency, {"units": "rad/s"})
    figure = master_curves_figure(rubbers, measured)
    return Made(figure, data, judge_inputs.judge_master_curves(inputs))


def _correlation_data(inputs: Inputs) -> dict[str, xr.DataArray]:
    return {
        f"C_z_{i}": _curve(curve.lag, curve.value, f"lag_{i}", road)
        for i, road in enumerate(inputs.surfaces, start=1)
        for curve in [inputs.correlation(road)]
    }


def _fig3b(inputs: Inputs) -> Made:
    curves = {road: inputs.correlation(road) for road in inputs.surfaces}
    fits, data = self_affine(inputs), _correlation_data(inputs)
    for i, (road, curve) in enumerate(curves.items(), start=1):
        if road in fits:
            data[f"eq_6_{i}"] = _curve(curve.lag, fits[road].evaluate(curve.lag), f"lag_{i}", road)
    figure = correlations_figure(curves, fits)
    return Made(figure, xr.Dataset(data), judge_inputs.judge_correlation(inputs))


def _fig4(inputs: Inputs) -> Made:
    curves = {road: inputs.correlation(road) for road in inputs.surfaces}
    stacks: dict[str, dict[str, SineStack]] = {}
    data = _correlation_data(inputs)
    for i, (road, curve) in enumerate(curves.items(), start=1):
        two, one = judge_inputs.single_factor(inputs, road)
        stacks[road] = {
            **inputs.stacks[road],
            f"{two.s_wavelength:.2f}/{two.s_amplitude:.2f}, all fitted": two,
            f"{one.s_wavelength:.2f}, one factor": one,
        }
        for j, (name, stack) in enumerate(stacks[road].items(), start=1):
            waves = stack.height_difference(curve.lag)
            data[f"C_z_{i}_waves_{j}"] = _curve(curve.lag, waves, f"lag_{i}", f"{road}, {name}")
    figure = factors_figure(curves, stacks)
    return Made(figure, xr.Dataset(data), judge_inputs.judge_factors(inputs))


def _fig7a(inputs: Inputs) -> Made:
    curves = {road: inputs.correlation(road) for road in inputs.surfaces}
    return Made(both_correlations_figure(curves), xr.Dataset(_correlation_data(inputs)), [])


def _curve(lag: np.ndarray, value: np.ndarray, dim: str, of: str) -> xr.DataArray:
    coordinate = xr.DataArray(lag, dims=dim, attrs={"units": "m", "long_name": "lag"})
    attrs = {"units": "m^2", "long_name": "height difference correlation", "of": of}
    return xr.DataArray(value, dims=dim, coords={dim: coordinate}, attrs=attrs)
