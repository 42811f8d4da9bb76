"""The examples in the docstrings run and show what they say."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest


def test_examples_run(
    source_file: Path, module_name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if ">>>" not in source_file.read_text(encoding="utf-8"):
        return  # doctest takes its time to find none
    monkeypatch.chdir(tmp_path)  # an example may write a file
    monkeypatch.setenv("MPLBACKEND", "Agg")
    module = importlib.import_module(module_name)
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    results = doctest.testmod(module, optionflags=flags)
    assert results.failed == 0, "the output above says which example failed"
