"""Headers of the core leave to one of them how their names look to C++."""

from __future__ import annotations

from pathlib import Path


def test_only_real_h_asks_for_cpp(repository: Path) -> None:
    # Compiled with tangents, functions of the same name exist once more; with names of C they would
    # be taken for those in double.
    headers = repository.joinpath("core", "include", "hyst").glob("*.h")
    assert {each.name for each in headers if "__cplusplus" in each.read_text()} == {"real.h"}
