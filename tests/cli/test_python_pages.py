"""Pages whose Python runs block after block, and prints what the page says."""

from __future__ import annotations

from pathlib import Path

import pytest
from pages import named_blocks


@pytest.mark.parametrize("page", ["tutorials/first_loop_in_python.md", "coming_from.md"])
def test_a_page_prints_what_it_says(
    page: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names: dict[str, object] = {}
    checked = 0
    for language, text in named_blocks(page):
        if language == "python":
            capsys.readouterr()
            exec(compile(text, page, "exec"), names)
        elif language == "text":
            assert capsys.readouterr().out == text
            checked += 1
    assert checked >= 4
