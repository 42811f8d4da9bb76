"""Play outputs and Gram matrices of the engine against plain Python and NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from equations import play

from hyst import _engine

R = [0.0, 0.2, 1.0, 3.5, 3.5]


@pytest.fixture
def outputs(noise: np.ndarray) -> np.ndarray:
    plays = [play(r) for r in R]
    return np.array([[memory(u) for memory in plays] for u in noise.tolist()])


def test_play_outputs(noise: np.ndarray, outputs: np.ndarray) -> None:
    z = np.zeros(len(R))
    result = np.empty_like(outputs)
    _engine.play_outputs(R, z, noise, result)
    assert result.tobytes() == outputs.tobytes()
    assert z.tobytes() == outputs[-1].tobytes()


@pytest.mark.parametrize("edges", [[0, 3000], [0, 1, 1, 1500, 3000], [700, 2000, 2100]])
def test_gram_of_each_block(noise: np.ndarray, outputs: np.ndarray, edges: list[int]) -> None:
    y = np.cos(noise)
    columns = np.column_stack([noise, outputs, np.ones_like(noise), y])
    result = np.zeros((len(edges) - 1, len(R) + 3, len(R) + 3))
    _engine.play_gram(R, np.zeros(len(R)), noise, y, edges, result)
    for block, first, last in zip(result, edges[:-1], edges[1:], strict=True):
        part = columns[first:last]
        # At most 3000 products of up to 16^2, summed in another order: 3000 roundings of the sum.
        bound = 3000 * np.finfo(float).eps * np.abs(part).T @ np.abs(part)
        assert np.all(np.abs(block - part.T @ part) <= bound)
        assert np.array_equal(block, block.T)


@pytest.mark.parametrize(
    "edges", [[], [0, 3001], [0, 2000, 1000, 3000]], ids=["none", "beyond", "falling"]
)
def test_edges_outside_the_record_are_refused(noise: np.ndarray, edges: list[int]) -> None:
    result = np.zeros((max(len(edges) - 1, 0), len(R) + 3, len(R) + 3))
    with pytest.raises(ValueError, match=r"edge|fall"):
        _engine.play_gram(R, np.zeros(len(R)), noise, noise, edges, result)
