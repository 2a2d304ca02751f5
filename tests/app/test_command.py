"""`gripscale app` refuses what it cannot serve in one sentence, before it serves anything."""

from __future__ import annotations

import socket
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from gripscale.app import serve_app
from gripscale.cli import app
from gripscale.core.errors import InputError


def refused(tmp_path: Path, *arguments: str) -> str:
    """Return what the command says on stderr when it refuses."""
    folder = ["--folder", str(tmp_path / "visits"), "--no-browser"]
    result = CliRunner().invoke(app, ["app", *arguments, *folder])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    return result.stderr


def test_a_port_that_is_none(tmp_path: Path) -> None:
    assert "from 0 to 65535; got 70000" in refused(tmp_path, "--port", "70000")


def test_a_port_that_is_taken(tmp_path: Path) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        assert f"port {port} of 127.0.0.1 cannot be used" in refused(tmp_path, "--port", str(port))


def test_a_case_that_is_not_there(tmp_path: Path) -> None:
    assert "does not exist" in refused(tmp_path, str(tmp_path / "no.toml"))
    assert not (tmp_path / "visits").exists()


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "visits").write_text("")
    assert "is not a folder" in refused(tmp_path)


def test_what_to_install_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "gripscale.app.server", raising=False)
    monkeypatch.setitem(sys.modules, "panel", None)
    with pytest.raises(InputError, match=r"needs panel.*pip install 'gripscale\[app\]'"):
        serve_app(tmp_path)
