"""The notebooks run as they stand, are pages of the site, and are stored without outputs."""

import json

import pytest
import yaml

from docs import notebooks
from tests.samples import ROOT

SHOWN = {
    "answer": "Answer: hysteresis friction μ = 0.211",
    "own_files": "no plateau at the fast end",
    "compounds": "friction coefficient μ",
    "design": "at the same rolling resistance",
    "wave_in_time": "TransientResult",
}
"""What an output of each says."""
QUICK = {"wave_in_time"}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name in QUICK else [pytest.mark.verification])
        for name in notebooks.TITLES
    ],
)
def test_a_notebook_runs(name):
    shown = [output for kind, _, output in notebooks.outputs(name) if kind == "code"]
    assert any(SHOWN[name] in output for output in shown)
    assert any("data:image/png;base64," in output for output in shown)


@pytest.mark.parametrize("name", notebooks.TITLES)
def test_a_notebook_is_stored_without_outputs(name):
    notebook = json.loads((notebooks.NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
    assert notebook["nbformat"] == 4
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(code) >= 4
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
    assert len({cell["id"] for cell in notebook["cells"]}) == len(notebook["cells"])


def test_all_notebooks_are_in_the_gallery():
    stored = {path.stem for path in notebooks.NOTEBOOKS.glob("*.ipynb")}
    assert stored == set(notebooks.TITLES)
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    pages = next(entry["Notebooks"] for entry in nav if "Notebooks" in entry)
    listed = [page for entry in pages for page in entry.values()]
    assert listed == [f"notebooks/{name}.md" for name in notebooks.TITLES]


def test_a_page_has_code_without_outputs_unless_it_is_asked_for(monkeypatch):
    monkeypatch.delenv(notebooks.RUN, raising=False)
    text = notebooks.page("wave_in_time")
    assert text.startswith("# One wave in time")
    assert "```python\nsteady = gs.solve_scale(" in text
    assert "<div" not in text
