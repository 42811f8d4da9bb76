"""hyst studio on the command line: refusals before anything is served."""

import importlib.util
import socket
from pathlib import Path

import pytest

import hyst.studio
from hyst.cli import main


def test_without_nicegui_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "nicegui" else found(name)
    )
    assert main(["studio", str(tmp_path)]) == 1
    assert capsys.readouterr().err == (
        "error: the studio needs NiceGUI; pip install 'hyst[studio]'\n"
    )


def test_a_folder_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("nicegui")
    assert main(["studio", str(tmp_path / "none")]) == 2
    assert "none is no folder" in capsys.readouterr().err


def test_a_port_that_is_taken_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("nicegui")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert main(["studio", str(tmp_path), "--port", str(port)]) == 2
    assert f"port {port} cannot be had" in capsys.readouterr().err


def test_the_studio_offers_what_its_stub_lists() -> None:
    assert set(hyst.studio.__all__) == {"serve", "studio_at"}
