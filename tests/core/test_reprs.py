"""What public objects show of themselves: few lines of text, and a figure in notebooks."""

import gc
import inspect
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import gripscale as gs
from gripscale import conditions, experiment, export, half_space, rubber, surface, theory, wave
from gripscale.core.described import Described
from tests.core.public_functions import public_functions
from tests.public_objects import public_objects

PACKAGES = (
    *(gs, gs.chain, conditions, gs.continuation, experiment, export, half_space, gs.questions),
    *(rubber, surface, theory, wave),
)
HTML = {
    *("Profile", "HeightMap", "MasterCurve", "Rubber", "RoughContact", "ScaleResult"),
    *("ChainResult", "Answer", "Variation"),
}
"""Classes that a notebook shows with a figure."""


@cache
def objects():
    """Return the named small objects, and what public functions make of them and of others."""
    made = public_objects()
    road, solid, case = made["road"], made["rubber"], made["case"]
    correlation = gs.height_difference(road)
    load = {"pressure": 3e5, "speed": 0.3}
    answers = [
        gs.answer(case),
        gs.vary(case, speed=[0.1, 0.3]),
        gs.fit_self_affine(correlation),
        surface.sine_ambiguity(correlation, gs.fit_sines(correlation, scales=3)),
        surface.find_cut_off(road, 1e-3),
        gs.clean(road),
        rubber.fit_prony_report(made["master"]),
        rubber.superpose_report(made["sweeps"], reference_temperature=293.15),
        theory.persson(solid, surface.profile_spectrum(road), **load),
        gs.solve_transient(solid, wavelength=2e-3, amplitude=1e-4, stages=[gs.Stage(1e-3, 1, 1e5)]),
        export.rubber_file(solid, to="abaqus"),
        gs.Layers([(solid, 4e-3), (solid, 4e-3)]),
    ]
    classes = [
        function.call(**function.good)
        for function in public_functions()
        if inspect.isclass(function.call)
    ]
    return made | {"answers": answers, "classes": classes}


def public_classes():
    """Return the classes of the names by their names, without errors and protocols."""
    names = [
        (package, name)
        for package in PACKAGES
        for name in getattr(package, "__all__", dir(package))
    ]
    items = [(getattr(package, name), name) for package, name in names]
    return {
        item: name
        for item, name in items
        if inspect.isclass(item) and not issubclass(item, Exception | type(None))
    }


def test_every_object_is_shown_in_few_lines():
    kept, wanted = objects(), public_classes()
    shown = {}
    for item in gc.get_objects():
        if type(item) in wanted and wanted[type(item)] not in shown:
            shown[wanted[type(item)]] = repr(item)
    assert kept
    assert len(shown) > 60
    for name, text in shown.items():
        lines = text.splitlines()
        assert len(lines) <= 15, (name, text)
        assert max(map(len, lines)) <= 100, (name, text)
        assert " object at 0x" not in text, (name, text)


def test_numbers_have_units_and_arrays_a_range():
    made = objects()
    assert repr(wave.Sine(8e-3, 5e-4)) == "Sine(wavelength=8 mm, amplitude=500 um)"
    assert "frequency    61 values from 0.01 Hz to 100 MHz, 10.0 decades" in repr(made["master"])
    assert "tan delta    61 values from 0.08557" in repr(made["master"])
    assert "temperature  20 °C" in repr(made["master"])
    assert "300 kPa, 0.3 m/s" in repr(made["contact"])
    assert "step 100 um, length 200 mm" in repr(made["road"])


def test_notebooks_show_a_figure_beside_the_text():
    made = objects()
    answers = {type(item).__name__: item for item in made["answers"]}
    wave_result = made["chain"].scales[0]
    items = [*made.values(), wave_result, answers["Answer"], answers["Variation"]]
    html = {
        type(item).__name__: item._repr_html_() for item in items if type(item).__name__ in HTML
    }
    assert set(html) == HTML
    for name, text in html.items():
        assert text.count("data:image/png;base64,") == 1, name
        assert text.count("<div") == text.count("</div>") == 2, name
        assert len(text) < 200_000, name


def test_an_object_without_a_figure_is_shown_as_text():
    empty = gs.Rubber(1e6)

    class Undrawn(type(empty)):
        def plot(self):
            raise gs.InputError("nothing to draw")

    html = Undrawn(1e6)._repr_html_()
    assert "<table>" in html
    assert "<img" not in html


def test_many_fields_are_cut():
    @dataclass(repr=False)
    class Many(Described):
        values: Any

        def shown_rows(self):
            yield from ((f"row {k}", "x" * 150) for k in range(20))

    lines = repr(Many(np.zeros(3))).splitlines()
    assert len(lines) == 15
    assert lines[-1] == "  ..."
    assert max(map(len, lines)) <= 100
