"""What is shown: a record, a result, a comparison and a model."""

from __future__ import annotations

from typing import Any

import pytest
from shown_things import RECORD

import hyst


@pytest.fixture(scope="session")
def shown() -> dict[str, Any]:
    found = hyst.identify(RECORD, family="pi", plays=2, delay=0)
    line = hyst.identify(RECORD, family="linear", delay=0)
    comparison = hyst.compare({"plays": found, "line $": line}, RECORD)
    return {"record": RECORD, "found": found, "comparison": comparison, "model": found.model}
