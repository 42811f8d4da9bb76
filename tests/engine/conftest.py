"""Every test of the engines runs on every instruction set of this processor."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from hyst import _engine


@pytest.fixture(params=_engine.instruction_sets())
def instruction_set(request: pytest.FixtureRequest) -> Iterator[str]:
    before = _engine.instruction_set()
    _engine.use_instruction_set(request.param)
    yield request.param
    _engine.use_instruction_set(before)
