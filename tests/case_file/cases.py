"""Case files that tests write, and what is said of wrong ones."""

import pytest

from gripscale.core.errors import GripscaleError


def written(folder, text):
    """Write a case; return its path."""
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def refusal(read, path, good, old, new):
    """Return the one sentence with which `read` refuses a good case with `old` made `new`."""
    assert old in good
    with pytest.raises(GripscaleError) as caught:
        read(written(path, good.replace(old, new, 1)))
    assert "\n" not in str(caught.value)
    return str(caught.value)
