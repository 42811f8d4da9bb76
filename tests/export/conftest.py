"""Objects of the core, compiled once for all tests of exports."""

from __future__ import annotations

import os

import pytest
from c_builds import Objects


@pytest.fixture(scope="session")
def objects(tmp_path_factory: pytest.TempPathFactory) -> Objects:
    base = tmp_path_factory.getbasetemp()
    # The processes of pytest-xdist have a folder each in one that is theirs together.
    home = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "objects"
    home.mkdir(exist_ok=True)
    return Objects(home)
