"""The answer with its interval in figures of models and samples, and marks on each other."""

import math

import numpy as np
import pytest
import xarray as xr

from gripscale.questions import contact_figure
from gripscale.questions.answer.variables import ANSWER, JUDGE
from gripscale.questions.cut_off.curve import AREA, FRICTION, SLOPE_IN_CONTACT
from gripscale.questions.cut_off.question import cut_off_sheet
from gripscale.questions.uncertainty.charts import distribution_figure
from tests.charts.test_figures import labels

BEST = {"friction": 0.461, "contact_fraction": 0.0047}


def with_answer(data, half_width=0.26):
    numbers = {f"answer_{name}": ((), value) for name, value in BEST.items()}
    for name, value in BEST.items():
        factor = math.exp(math.asinh(half_width))
        numbers |= {f"answer_{name}_low": ((), value / factor)}
        numbers |= {f"answer_{name}_high": ((), value * factor)}
    return data.assign(numbers)


@pytest.mark.parametrize("half_width", [0.26, math.nan])
def test_the_answer_stands_beside_the_chain(make_prediction, half_width):
    judge = with_answer(make_prediction().drop_dims("scale"), half_width)
    figure = contact_figure({"dynamic": make_prediction(), JUDGE: judge})
    label = ANSWER if math.isfinite(half_width) else "answer"
    assert labels(figure).count(label) == 1
    for axes, name in zip(figure.axes, ("contact_fraction", "friction"), strict=True):
        line = next(line for line in axes.lines if line.get_label() == label)
        assert list(line.get_ydata()) == [BEST[name]] * 2
        if math.isnan(half_width):
            assert not axes.collections
            continue
        (band,) = axes.collections
        heights = band.get_paths()[0].vertices[:, 1]
        ends = BEST[name] * np.exp(np.arcsinh(half_width) * np.array([-1.0, 1.0]))
        assert (heights.min(), heights.max()) == pytest.approx(tuple(ends))
        assert axes.get_ylim()[0] < ends[0]


def samples():
    """Return samples of two models, with an answer beside them."""
    rng = np.random.default_rng(1)
    data = xr.Dataset({"failed": ("model", [0, 0])}, {"model": ["chain", "direct"]})
    for name, value in BEST.items():
        values = 0.8 * value * np.exp(0.1 * rng.normal(size=(2, 60)))
        data[name] = (("model", "sample"), values)
        ends = np.quantile(values, [0.05, 0.25, 0.5, 0.75, 0.95], axis=1).T
        data[f"{name}_quantile"] = (("model", "quantile"), ends)
        data[f"{name}_case"] = ("model", [0.82 * value] * 2)
    return with_answer(data)


def test_distributions_show_the_answer_and_name_every_mark():
    figure = distribution_figure(samples())
    assert labels(figure) == [
        ANSWER, "median of the samples", "5 and 95 %", "model, inputs as stated",
    ]  # fmt: skip
    titles = [axes.get_title() for axes in figure.axes]
    assert titles == ["chain", "chain", "direct contact", "direct contact"]
    for at, axes in enumerate(figure.axes):
        best = list(BEST.values())[at % 2]
        star = next(line for line in axes.lines if line.get_marker() == "*")
        assert list(star.get_xdata()) == [best]
        left, right = axes.get_xlim()
        width = math.exp(math.asinh(0.26))
        assert left < best / width
        assert right > best * width


def test_rules_of_cut_off_on_each_other_are_one_line_with_both_names():
    lengths = np.geomspace(1e-2, 1e-5, 7)
    numbers = {name: ("cut_off", np.linspace(0.1, 1.0, 7)) for name in (
        FRICTION, AREA, SLOPE_IN_CONTACT, *(f"{name}_{end}" for name in (FRICTION, AREA)
                                            for end in ("lower", "upper")))}  # fmt: skip
    rules = {"shortest wavelength measured": 2e-4, "cut-off of the case": 2.001e-4, "slope": 3e-4}
    data = xr.Dataset(
        {
            **numbers,
            "curve_measured": ("cut_off", lengths > 1e-4),
            "rule_cut_off": ("rule", list(rules.values())),
        },
        {"cut_off": lengths, "rule": list(rules)},
    )
    figure = cut_off_sheet(data).on_paper()
    names = [name for name in labels(figure) if name.endswith("mm")]
    assert names == ["shortest wavelength measured, cut-off of the case: 0.2 mm", "slope: 0.3 mm"]
    for axes in figure.axes:
        upright = [line for line in axes.lines if len(set(line.get_xdata())) == 1]
        assert [line.get_xdata()[0] for line in upright] == pytest.approx([0.2, 0.3])
