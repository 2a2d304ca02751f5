"""Hook of the site: runs the notebooks of `examples/notebooks` and makes pages of them.

The cells are plain Python: no kernel is needed, and the site and the tests run the same function.
"""

from __future__ import annotations

import ast
import io
import json
import os
from base64 import b64encode
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

NOTEBOOKS = Path(__file__).resolve().parents[1] / "examples" / "notebooks"
TITLES = ("answer", "own_files", "compounds", "design", "wave_in_time")
"""Notebooks in the order of the gallery."""
RUN = "GRIPSCALE_NOTEBOOKS"
"""Environment variable that makes the site run them: `make docs` sets it."""


def on_files(files: Any, *, config: Any, **_: Any) -> None:
    """Add the notebooks to the pages of the site."""
    from mkdocs.structure.files import File

    for name in TITLES:
        files.append(File.generated(config, f"notebooks/{name}.md", content=page(name)))


def cells(name: str) -> Iterator[tuple[str, str]]:
    """Yield kind, "markdown" or "code", and text of the cells of a notebook."""
    notebook = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text(encoding="utf-8"))
    for cell in notebook["cells"]:
        yield cell["cell_type"], "".join(cell["source"])


def outputs(name: str) -> Iterator[tuple[str, str, str]]:
    """Run a notebook in an empty folder; yield kind and text of each cell, and its output."""
    names: dict[str, Any] = {"__name__": "__main__"}
    with TemporaryDirectory() as folder, chdir(folder):
        for number, (kind, text) in enumerate(cells(name)):
            place = f"{name}, cell {number}"
            yield kind, text, run_cell(text, names, place) if kind == "code" else ""


def run_cell(text: str, names: dict[str, Any], where: str) -> str:
    """Run a cell; return what it prints and the value of its last expression, as HTML."""
    tree = ast.parse(text, where)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with redirect_stdout(printed):
        exec(compile(tree, where, "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), where, "eval"), names)
    shown = f"<pre>{escape(printed.getvalue().rstrip())}</pre>" if printed.getvalue() else ""
    return shown + ("" if value is None else value_shown(value))


def value_shown(value: Any) -> str:
    """Return HTML of a value, as a notebook shows it."""
    html = getattr(value, "_repr_html_", lambda: None)()
    if html:
        return str(html)
    if hasattr(value, "savefig"):
        drawn = io.BytesIO()
        value.savefig(drawn, dpi=110)
        data = b64encode(drawn.getvalue()).decode()
        return f'<img alt="" src="data:image/png;base64,{data}">'
    return f"<pre>{escape(repr(value))}</pre>"


def page(name: str) -> str:
    """Return a notebook as Markdown; with its outputs where the site is asked to run it."""
    parts = []
    run = bool(os.environ.get(RUN))
    for kind, text, output in outputs(name) if run else ((*cell, "") for cell in cells(name)):
        parts.append(f"```python\n{text}\n```" if kind == "code" else text)
        if output:
            parts.append(f'<div class="output">\n{output}\n</div>')
    source = f"The notebook is `examples/notebooks/{name}.ipynb`."
    return "\n\n".join([*parts, source, ""])
