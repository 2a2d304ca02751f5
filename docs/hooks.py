"""Hook of the site: a link to a file of the source tree becomes its name, as the site has no such.

The pages are read in the source tree, too, where such links lead somewhere.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parent.resolve()
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(((?:\.\./)+[^)#\s]+)(?:#[^)]*)?\)")


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Return the page with links that leave the folder of the docs turned into text."""
    folder = Path(page.file.abs_src_path).parent

    def replaced(link: re.Match[str]) -> str:
        target = (folder / link[2]).resolve()
        outside = target.exists() and not target.is_relative_to(DOCS)
        return f"{link[1]} (`{target.relative_to(DOCS.parent)}`)" if outside else link[0]

    return LINK.sub(replaced, markdown)
