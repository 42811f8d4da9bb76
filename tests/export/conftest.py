"""Objects of the core, compiled once for all tests of exports."""

from __future__ import annotations

import pytest
from c_builds import Objects


@pytest.fixture(scope="session")
def objects(tmp_path_factory: pytest.TempPathFactory) -> Objects:
    return Objects(tmp_path_factory.mktemp("objects"))
