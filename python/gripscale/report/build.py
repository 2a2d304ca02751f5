"""From a result to the file: read, compose, render, write."""

from __future__ import annotations

import base64
import hashlib
import json
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from bokeh.core.types import ID
from bokeh.embed import json_item
from bokeh.resources import Resources
from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from gripscale.charts.page_elements import Page
from gripscale.core.errors import FileError
from gripscale.io.netcdf import write_whole
from gripscale.report.pages import comparison_page, roads_page, run_page, study_page, told_page
from gripscale.report.source import Run, Source, Study, SurfaceComparison, TextReport, read_result

REPORT = "report.html"


def build(result: Path, output: Path | None) -> Path:
    """Write the report of `result` to `output`, by default into the folder of the result."""
    source = read_result(result)
    if output is None:
        output = (result if result.is_dir() else result.parent) / REPORT
    if not output.parent.is_dir():
        raise FileError(f"{output} cannot be written: there is no folder {output.parent}")
    text = render(_page(source))

    def write(path: Path) -> None:
        path.write_text(text, encoding="utf-8")

    return write_whole(output, write)


def _page(source: Source) -> Page:
    if isinstance(source, Run):
        return run_page(source)
    if isinstance(source, TextReport):
        return told_page(source)
    if isinstance(source, SurfaceComparison):
        return roads_page(source.data)
    return study_page(source) if isinstance(source, Study) else comparison_page(source)


def render(page: Page) -> str:
    """Return `page` as HTML; all texts in it are escaped by the template."""
    library, script = _bokeh(), _own("page.js")
    style = "\n".join(_own(f"{name}.css") for name in ("page", "elements", "media"))
    return _template().render(
        page=page,
        figures=[_figure(chart.name, chart.model) for chart in page.charts],
        library=Markup(library),
        style=Markup(style),
        script=Markup(script),
        policy=_policy(library, script),
    )


def _figure(name: str, model: Any) -> dict[str, Any]:
    """Return a figure as plain data; the template turns it into JSON without any markup."""
    item = json_item(model, ID(f"plot-{name}"))
    plain: dict[str, Any] = json.loads(json.dumps(item, allow_nan=False))
    return plain


@lru_cache(maxsize=1)
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("gripscale.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # Bokeh's figures name an object where it first occurs: the order of keys matters.
    environment.policies["json.dumps_kwargs"] = {"sort_keys": False, "separators": (",", ":")}
    return environment.get_template("page.html")


@lru_cache(maxsize=1)
def _bokeh() -> str:
    """Return Bokeh's core script; widgets, tables and WebGL are not needed."""
    resources = Resources(mode="inline", minified=True, components=["bokeh"], log_level="error")
    return "\n".join(resources.js_raw)


def _own(name: str) -> str:
    return files("gripscale.report").joinpath("templates", name).read_text(encoding="utf-8")


def _policy(*scripts: str) -> str:
    """Return the content security policy: these scripts and nothing else, no network at all."""
    hashes = " ".join(f"'sha256-{_digest(script)}'" for script in scripts)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def _digest(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")
