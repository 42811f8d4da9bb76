"""What is shown on a terminal, where tables are ruled and progress is visible."""

from __future__ import annotations

import sys

import pytest

from hyst.cli.console import at_work, show_table
from hyst.report import Table

TABLE = Table("Of [bold]names[/bold]", ("name", "p[1] [um]"), (("[red]", "1"), ("second", "22")), 1)


def as_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "100")


def test_tables_on_a_terminal_keep_every_bracket(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    as_terminal(monkeypatch)
    show_table(TABLE)
    shown = capsys.readouterr().out
    for part in ("Of [bold]names[/bold]", "p[1] [um]", "[red]", "22"):
        assert part in shown


def test_tables_elsewhere_are_plain_and_aligned(capsys: pytest.CaptureFixture[str]) -> None:
    show_table(TABLE)
    lines = capsys.readouterr().out.splitlines()
    assert lines == [
        "",
        TABLE.title,
        "  name    p[1] [um]",
        "  [red]           1",
        "  second         22",
    ]


def test_progress_is_shown_on_a_terminal_only(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with at_work("counting") as say:
        say("one")
    assert capsys.readouterr() == ("", "")
    as_terminal(monkeypatch)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    with at_work("counting") as say:
        say("two")
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "counting: two" in shown.err
