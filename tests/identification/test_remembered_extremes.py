"""Extremes that later ones have not wiped out: one pass back over the record."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.identification.record_use.thinning import _extremes_left


def one_by_one(u: np.ndarray) -> list[int]:
    """Look through the whole rest for each extreme, as the definition says."""
    highest, lowest = int(u.argmax()), int(u.argmin())
    kept = sorted({highest, lowest})
    rises = kept[-1] == lowest
    while kept[-1] < u.size - 1:
        after = kept[-1] + 1
        rest = u[after:]
        kept.append(after + int(rest.argmax() if rises else rest.argmin()))
        rises = not rises
    return kept


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("levels", [2, 5, 0])
def test_they_are_those_of_the_definition(seed: int, levels: int) -> None:
    rng = np.random.default_rng(seed)
    for size in (1, 2, 3, 10, 300):
        u = rng.standard_normal(size) * np.linspace(1.0, 0.1, size)
        if levels:
            u = np.round(u * levels) / levels
        assert _extremes_left(u).tolist() == one_by_one(u)


def test_a_shrinking_oscillation_keeps_every_turn() -> None:
    u = np.array([1.0, -0.9, 0.8, -0.7, 0.6])
    assert _extremes_left(u).tolist() == [0, 1, 2, 3, 4]


def test_a_constant_has_one() -> None:
    assert _extremes_left(np.zeros(1)).tolist() == [0]
