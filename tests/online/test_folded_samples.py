"""Samples folded into rows, and what a model says of them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.online import JointEstimator
from hyst.online.joint.bands.prediction import predicted
from hyst.online.joint.bands.samples import FoldedSamples, folded_samples
from hyst.online.joint.parts import take_apart

PI = hyst.PrandtlIshlinskii([0.5, 0.3, 0.4], [0.3, 0.9, 1.7], 1.0)
BEND = hyst.DeadZone([1.0, -0.3, 0.4], [0.0, 1.0, -1.5])


def folded(model: hyst.operators.Operator, u: np.ndarray, y: np.ndarray) -> FoldedSamples:
    estimator = JointEstimator(model)
    estimator.run(hyst.Record(u, y, 1.0), every=u.size)
    return folded_samples(estimator.core.folded(2))


def loops(seed: int, samples: int = 900) -> np.ndarray:
    """Large and small loops that never repeat, and some rest."""
    t, rng = np.arange(samples) / 20.0, np.random.default_rng(seed)
    u = 3.0 * np.sin(t) * (1.0 + 0.3 * np.sin(0.31 * t)) + 0.8 * np.sin(3.3 * t + seed)
    return np.repeat(u, rng.integers(1, 3, samples))[:samples]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("place", ["none", "front", "back"])
def test_a_row_remembers_what_plays_remember(seed: int, place: str) -> None:
    model = {"none": PI, "front": PI @ BEND, "back": BEND @ PI}[place]
    u = loops(seed)
    rows = folded(model, u, model(u))
    parts = take_apart(model)
    said, _ = predicted(parts, parts.theta(), rows.way)
    # Every row is of equal inputs with equal memory, so it has the output of each of its samples.
    assert said == pytest.approx(rows.y, abs=1e-9)
    assert rows.y.size > 300


def test_derivatives_are_those_of_the_model() -> None:
    model = BEND @ PI @ hyst.DeadZone([1.0, 0.2, -0.3], [0.0, 0.7, -1.1])
    u = loops(1)
    rows = folded(model, u, model(u))
    parts = take_apart(model)
    theta = parts.theta()
    y, jacobian = predicted(parts, theta, rows.way)
    for j in range(theta.size):
        step = np.zeros(theta.size)
        step[j] = 1e-7
        ahead, _ = predicted(parts, theta + step, rows.way)
        slope = (ahead - y) / 1e-7
        # But at samples that lie on a corner; the difference is exact to rounding otherwise.
        assert np.median(np.abs(slope - jacobian[j])) < 1e-6
        assert np.mean(np.abs(slope - jacobian[j]) > 1e-5) < 0.02


def test_what_repeats_is_one_row() -> None:
    u = np.tile(2.0 * np.sin(2.0 * np.pi * np.arange(50) / 50.0), 40)
    y = PI(u) + 0.1 * np.random.default_rng(0).standard_normal(u.size)
    rows = folded(PI, u, y)
    # 50 samples a period, two pairs of which rest at the ends, and those before the loop is closed.
    assert 48 <= rows.y.size <= 100
    assert rows.count.sum() > 1900
    # Degrees of freedom of some 1900 samples: 5 %, four times.
    assert rows.noise == pytest.approx(0.01, rel=0.15)


def test_memory_is_bounded() -> None:
    u = np.cumsum(np.random.default_rng(0).normal(0.0, 0.3, 40_000))
    u = 4.0 * np.sin(u)
    estimator = JointEstimator(PI)
    estimator.run(hyst.Record(u, PI(u), 1.0), every=u.size)
    assert len(estimator.core.folded(0)) <= 2048
    assert len(estimator.core.folded(1)) <= 2048
    assert max(len(each) for each in estimator.core.folded(0)) <= 13


def test_saved_and_resumed_it_knows_the_same(tmp_path: Path) -> None:
    u = loops(2, 3000)
    y = PI(u) + 0.05 * np.random.default_rng(1).standard_normal(u.size)
    whole, first = JointEstimator(PI, memory=1000.0), JointEstimator(PI, memory=1000.0)
    for k in range(u.size):
        whole.update(u[k], y[k])
        first.update(u[k], y[k])
        if k == 1700:
            first.save(tmp_path / "estimator.json")
            first = hyst.load(tmp_path / "estimator.json")
    assert first.core.folding() == whole.core.folding()
    assert np.array_equal(first.knowledge.low, whole.knowledge.low)
    assert np.array_equal(first.knowledge.high, whole.knowledge.high)


def test_files_of_earlier_versions_are_read_and_broken_ones_refused() -> None:
    estimator = JointEstimator(PI)
    u = loops(3)
    estimator.run(hyst.Record(u, PI(u), 1.0), every=u.size)
    settings, state = estimator.saved()
    older = {name: each for name, each in settings.items() if name != "folded"}
    restored = JointEstimator.restore(older, state)
    assert np.array_equal(restored.parameters, estimator.parameters)
    assert not restored.knowledge.known
    for wrong in (
        {"place": [0.0], "rows": [], "before": []},
        {**settings["folded"], "rows": [[1.0, 2.0]]},
        {**settings["folded"], "rows": [[math.nan] * 7]},
        {**settings["folded"], "rows": [[0.0] * 7]},
        {"rows": []},
        5,
    ):
        with pytest.raises(hyst.InputError, match="no rows of counts"):
            JointEstimator.restore({**settings, "folded": wrong}, state)


def test_restart_forgets_the_samples_and_keeps_the_turns() -> None:
    u = loops(0)
    estimator = JointEstimator(PI)
    estimator.run(hyst.Record(u, PI(u), 1.0), every=u.size)
    turns = estimator.core.folding()[6:]
    estimator.restart()
    assert estimator.core.folded(2) == []
    assert estimator.core.folding()[6:] == turns
