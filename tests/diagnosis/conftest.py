"""Where the described cases are."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def cases(measured_data: Path) -> Path:
    """Folder of the cases, each with the right answer in its README."""
    folder = measured_data.parent / "cases"
    if not folder.is_dir():
        pytest.skip(f"cases are not at {folder}")
    return folder
