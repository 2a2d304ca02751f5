"""From a page to its HTML."""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from importlib.resources import files
from typing import Any

from bokeh.resources import Resources
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from gripscale.charts.bokeh_parts import document
from gripscale.report.elements import Page, with_code


def render(page: Page) -> str:
    """Return `page` as HTML; all texts in it are escaped by the template."""
    # Bokeh's core script alone: widgets, tables and WebGL are not needed
    resources = Resources(mode="inline", minified=True, components=["bokeh"], log_level="error")
    library = "\n".join(resources.js_raw)
    package, styles = "gripscale.report", ("page.css", "elements.css", "media.css")
    script = "\n".join(template_text(package, name) for name in ("outlines.js", "page.js"))
    template = templates(package).get_template("page.html")
    return template.render(
        page=page,
        # the template turns plain data into JSON without any markup
        figures={chart.name: document(chart.figure) for chart in page.charts},
        library=Markup(library),
        style=Markup("\n".join(template_text(package, name) for name in styles)),
        script=Markup(script),
        policy=_policy(library, script),
    )


@cache
def templates(package: str) -> Environment:
    """Return the templates of a package."""
    options: Any = {"trim_blocks": True, "lstrip_blocks": True, "undefined": StrictUndefined}
    environment = Environment(loader=PackageLoader(package), autoescape=True, **options)
    environment.filters["with_code"] = with_code
    # Bokeh's figures name an object where it first occurs: the order of keys matters.
    settings = {"sort_keys": False, "separators": (",", ":"), "allow_nan": False}
    environment.policies["json.dumps_kwargs"] = settings
    return environment


def template_text(package: str, name: str) -> str:
    """Return a script or style of a package."""
    return files(package).joinpath("templates", name).read_text(encoding="utf-8")


def _policy(*scripts: str) -> str:
    """Return the content security policy: these scripts and nothing else, no network at all."""
    digests = (hashlib.sha256(script.encode("utf-8")).digest() for script in scripts)
    hashes = " ".join(f"'sha256-{base64.b64encode(d).decode('ascii')}'" for d in digests)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
