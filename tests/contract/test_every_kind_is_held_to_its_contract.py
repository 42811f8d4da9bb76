"""No operator escapes the contracts: every registered kind has examples and a random source."""

from __future__ import annotations

import dataclasses

import pytest

import hyst.models  # noqa: F401  registers its kinds
from hyst.operators.registry import registered
from hyst.operators.traits import Traits
from reference.examples import EXAMPLES
from reference.random_operators import RANDOM


def test_every_kind_has_an_example() -> None:
    assert {each.kind for each in EXAMPLES.values()} == set(registered())


def test_every_kind_has_a_random_source() -> None:
    assert set(RANDOM) - {"inverse"} == set(registered())


@pytest.mark.parametrize("trait", [field.name for field in dataclasses.fields(Traits)])
def test_every_trait_is_declared_true_and_false(trait: str) -> None:
    declared = {getattr(each.traits(), trait) for each in EXAMPLES.values()}
    assert declared == {True, False}
