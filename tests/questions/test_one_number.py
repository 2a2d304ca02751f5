"""Friction and area of a case are the same through Python, commands, pages, tables and files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import gripscale as gs
from gripscale.charts.draw import FigureFolder
from gripscale.cli import app
from gripscale.conditions import Conditions
from gripscale.conditions.area_term import ConstantStress
from gripscale.io.table import significant
from gripscale.questions import terminal
from gripscale.questions.answer.variables import HEADINGS, SYMBOLS, answer_number, believed
from gripscale.questions.page_of_folder import read_result
from gripscale.surface import self_affine_profile
from gripscale.theory import HalfPlane
from tests.half_space.rough_cases import isotropic_map
from tests.samples import GENTLE_SINES, SHIFTED_RUBBER

LOAD = {"pressure": 3e5, "speed": 0.3, "footprint": 0.05}
COLD = Conditions(heat="none")
SHEARED = replace(COLD, shear_stress=ConstantStress(5e5))
"""0.5 MPa on a few per cent of the area: an area term of about the friction of the hysteresis."""


def road(seed):
    length = {1: 0.12, 2: 0.09}[seed]
    line = self_affine_profile(0.8, 3e-3, 4e-4, length=length, step=2e-4, seed=seed)
    return replace(line, name=f"lane {seed}")


def case_of(surface, **options):
    """Return a case of rubber without filler, which does not warm, but for its options."""
    return gs.Case(
        surface, SHIFTED_RUBBER, **LOAD | {"filled": False, "conditions": COLD} | options
    )


def calibrated():
    """Return the conditions with a shear stress fitted to measured friction."""
    measured = gs.experiment.MeasuredFriction([0.1, 0.3, 1.0], [0.5, 0.6, 0.65])
    case = case_of(road(1), waves=3, smallest_wavelength=2e-3)
    return replace(COLD, shear_stress=gs.calibrate(case, measured, law="constant").law)


CASES = {
    "plain": lambda: (road(1), {}),
    "area_term": lambda: (road(1), {"conditions": SHEARED}),
    "calibrated": lambda: (road(1), {"conditions": calibrated()}),
    "several_profiles": lambda: ([road(1), road(2)], {}),
    "several_sheared": lambda: ([road(1), road(2)], {"conditions": SHEARED}),
    "map": lambda: (isotropic_map(64, shortest=1.6e-3), {}),
    "waves": lambda: (GENTLE_SINES, {}),
    "static": lambda: (road(1), {"speed": 0.0}),
    "thickness": lambda: (road(1), {"thickness": 8e-3}),
    "temperature": lambda: (road(1), {"conditions": Conditions(temperature=313.15)}),
    "not_known_filled": lambda: (road(1), {"filled": None}),
}
"""Surface and further arguments of each case."""
SLOW = {"plain", "calibrated", "several_sheared", "thickness", "temperature"}
"""What the others hold together."""
PARAMETERS = [
    pytest.param(name, marks=[pytest.mark.verification] if name in SLOW else []) for name in CASES
]


@dataclass(frozen=True)
class Asked:
    """A case with its answer, and the folder of its run."""

    case: gs.Case
    answer: gs.Answer
    folder: Path
    printed: str

    @property
    def names(self):
        """What it answers with."""
        return ["friction", "contact_fraction"] if self.case.load.speed else ["contact_fraction"]

    @property
    def expected(self):
        """The numbers of `gs.answer`, by its documented attributes."""
        return [getattr(self.answer, name) for name in self.names]

    @property
    def shown(self):
        """The expected numbers as texts print them."""
        return dict(zip(self.names, map(significant, self.expected), strict=True))

    @property
    def judge(self):
        """Model of a comparison that the answer is of."""
        return "direct" if self.case.surface.measured else "chain_half_plane"

    def of(self, data):
        """Return the numbers of another result."""
        return [answer_number(data, name).value for name in self.names]


@pytest.fixture(scope="module", params=PARAMETERS)
def asked(request, tmp_path_factory):
    """A case, answered in Python and by `gripscale run`."""
    surface, options = CASES[request.param]()
    arguments = {"waves": 3, "chain": gs.chain.Chain(HalfPlane(points=64))} | options
    if not isinstance(surface, gs.SineStack):
        arguments["smallest_wavelength"] = 2e-3
    case = case_of(surface, **arguments)
    folder = tmp_path_factory.mktemp(request.param)
    path = case.save(folder / "case.toml")
    printed = shell("run", path, "--output", folder / "results")
    return Asked(case, gs.answer(case), folder / "results", printed)


def shell(*words):
    """Return what a command prints, as one line; its figures are not drawn."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FigureFolder, "save", lambda *_: None)
        result = CliRunner().invoke(app, list(map(str, words)), env={"COLUMNS": "100"})
    assert result.exit_code == 0, result.output
    return " ".join(result.output.split())


def ways(asked):
    """Yield the numbers that each way to ask gives, but the slow ones."""
    yield "file of the run", asked.of(gs.load(asked.folder / "answer.nc").data)
    yield "saved", asked.of(gs.load(asked.answer.save(asked.folder / "saved.nc")).data)
    columns = [believed(asked.answer.data, name) for name in asked.names]
    table = {column.name: column for column in asked.answer.table().columns}
    if asked.case.load.speed:
        assert next(name for name in table if name.startswith("answer_")) == columns[0]
    yield "table", [float(table[column].values[0]) for column in columns]
    varied = gs.vary(asked.case, pressure=[asked.case.load.pressure]).data
    yield "vary", [float(varied[believed(varied, name)][0]) for name in asked.names]
    yield "compare", asked.of(gs.compare(asked.case, models=[asked.judge]).data)


def test_one_number_through_every_door(asked):
    for way, numbers in ways(asked):
        # a study weighs profiles by the length of their grids, an answer as they were measured
        assert numbers == pytest.approx(asked.expected, rel=1e-4), way


def test_run_prints_the_answer_once(asked):
    line = asked.answer.lines[0]
    assert all(f"{SYMBOLS[name]} = {value}" in line for name, value in asked.shown.items())
    assert asked.printed.count(line) == 1
    assert asked.printed.index(line) == asked.printed.index("Answer: ")


def test_pages_show_it(asked):
    for result in (asked.answer, read_result(asked.folder)):
        values = {card.label: card.value for card in result.page_content().cards}
        for name, value in asked.shown.items():
            assert values[f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"] == value


@pytest.mark.parametrize("asked", ["several_profiles", "waves"], indirect=True)
def test_commands_lead_with_it(asked):
    path, folder = asked.folder.parent / "case.toml", asked.folder.parent
    pressure = f"pressure={asked.case.load.pressure / 1e5:g} bar"
    commands = {
        "comparison": ("compare", path, "--models", asked.judge),
        "study": ("study", path, "--vary", pressure),
    }
    printed = {name: shell(*words, "--output", folder / name) for name, words in commands.items()}
    compared = gs.load(folder / "comparison" / "comparison.nc")
    assert asked.of(compared.data) == pytest.approx(asked.expected, rel=1e-4)
    assert printed["comparison"].count("Answer: ") == 1
    assert all(f"{SYMBOLS[n]} = {v}" in compared.lines[0] for n, v in asked.shown.items())
    assert compared.lines[0] in printed["comparison"]
    ends = {"A_r/A_0": "contact_fraction", "mu": "friction"}
    best = printed["comparison"].partition("Best estimate (90 %): ")[2]
    for symbol, name in ends.items():
        assert name not in asked.shown or f"{symbol} = {asked.shown[name]}" in best
    varied = gs.load(folder / "study" / "study.nc").data
    numbers = [varied[believed(varied, name)].item() for name in asked.names]
    assert numbers == pytest.approx(asked.expected, rel=1e-4)
    assert all(value in printed["study"] for value in asked.shown.values())


def test_large_strain_is_no_second_answer():
    surface, options = CASES["plain"]()
    case = case_of(surface, **options, waves=3, smallest_wavelength=4e-3)
    answer = gs.answer(case)
    compared = gs.compare(case, models=["direct", "windows"])
    for name in ("friction", "contact_fraction"):
        number, large = (answer_number(data, name) for data in (answer.data, compared.data))
        assert large.value == pytest.approx(number.value, rel=1e-12)
        factor = float(compared.data[f"{name}_factor"].sel(model="windows_finite_strain"))
        solved = float(compared.data[f"large_strain_{name}"])
        # the factor of the ladder is of the friction it shows, that of the answer of the losses
        assert solved == pytest.approx(number.value * factor, rel=0.01)
        assert significant(solved) in compared.lines[1]
    assert compared.lines[0] == answer.lines[0]
    assert compared.lines[1].startswith("  With large strain solved on windows: ")


@pytest.mark.verification
def test_uncertainty_has_it(asked):
    sampled = gs.uncertainty(asked.case, samples=10, without=["profile"])  # too short to cut up
    assert asked.of(sampled.data) == pytest.approx(asked.expected, rel=1e-12)


def test_a_number_and_its_per_cent_stay_on_one_line(capsys):
    for length in range(80, 100):
        terminal.print_wrapped(terminal.screen(), f"{'x' * length} large strain 5.0 %")
        assert "5.0 %" in capsys.readouterr().out
