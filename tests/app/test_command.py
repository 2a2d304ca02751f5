"""`gripscale app` refuses what it cannot serve in one sentence, before it serves anything."""

import socket
import sys

import pytest
from typer.testing import CliRunner

from gripscale.app import serve_app
from gripscale.cli import app
from gripscale.core.errors import InputError


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--port", "70000"], "from 0 to 65535; got 70000"),
        (["--port", "TAKEN"], "port TAKEN of 127.0.0.1 cannot be used"),
        (["no.toml"], "does not exist"),
        (["--folder", "file"], "is not a folder"),
    ],
)
def test_what_cannot_be_served(tmp_path, monkeypatch, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        taken = str(other.getsockname()[1])
        words = ["app", "--no-browser", "--folder", "visits", *arguments]
        result = CliRunner().invoke(app, [word.replace("TAKEN", taken) for word in words])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert sentence.replace("TAKEN", taken) in result.stderr
    assert not list(tmp_path.glob("visits/*"))


def test_what_to_install_is_said(tmp_path, monkeypatch):
    monkeypatch.delitem(sys.modules, "gripscale.app.server", raising=False)
    monkeypatch.setitem(sys.modules, "panel", None)
    with pytest.raises(InputError, match=r"needs panel.*pip install 'gripscale\[app\]'"):
        serve_app(tmp_path)
