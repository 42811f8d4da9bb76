"""Which engine is taken, that it is told, and that it can be forced."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.operators.batches import evaluate_batch
from hyst.operators.evaluation import explain


def bank(n: int) -> hyst.PrandtlIshlinskii:
    return hyst.PrandtlIshlinskii(np.full(n, 1.0 / n), np.arange(1, n + 1) / (n + 1), 0.3)


smooth = np.sin(np.arange(400_000) * 2e-3 * np.pi)
rough = np.random.default_rng(0).uniform(-1.0, 1.0, 400_000)


@pytest.mark.parametrize(
    ("plays", "record", "engine"),
    [
        (10, rough[:20], "loop"),
        (10, rough, "lanes"),
        (100, rough, "lanes"),
        (2000, rough[:100_000], "memory-curve"),
        (10, smooth, "memory-curve"),
        (100, smooth, "memory-curve"),
        (10, smooth[:2000], "lanes"),
    ],
)
def test_the_cheapest_engine_is_taken(plays: int, record: np.ndarray, engine: str) -> None:
    told = explain(bank(plays), record)
    assert [stage.engine for stage in told] == [engine]
    assert told[0].reason
    assert set(told[0].expected_ns) == {"loop", "lanes", "memory-curve"}


def test_every_stage_is_told() -> None:
    model = hyst.DeadZone([1.0], [0.1]) @ bank(50) @ hyst.Affine(2.0, 0.0)
    told = explain(model, smooth)
    assert [(stage.stage, stage.engine) for stage in told] == [
        (0, "loop"),
        (1, "memory-curve"),
        (2, "loop"),
    ]
    assert told[0].expected_ns == {}


@pytest.mark.parametrize("engine", ["loop", "lanes", "memory-curve"])
def test_the_choice_can_be_forced(engine: str) -> None:
    record = rough[:500]
    told = explain(bank(3), record, engine=engine)
    assert (told[0].engine, told[0].reason) == (engine, "asked for")
    y, state = bank(3).run(record, engine=engine)
    y_expected, state_expected = bank(3).run(record, engine="loop")
    np.testing.assert_array_equal(state, state_expected)
    # Terms of size 1: a few epsilons.
    np.testing.assert_allclose(y, y_expected, rtol=0.0, atol=1e-14)


def test_a_memory_that_no_input_leaves_is_no_curve() -> None:
    model = hyst.PrandtlIshlinskii([1.0, 1.0], [0.1, 0.2], z0=[0.0, 5.0])
    told = explain(model, smooth, engine="memory-curve")
    assert told[0].engine == "lanes"
    assert "memory-curve" not in told[0].expected_ns


def test_reversals_are_estimated() -> None:
    # Two turning points in 1000 samples; of three white numbers the middle one is an extreme in
    # four of six orders.
    assert explain(bank(3), smooth)[0].reversals == pytest.approx(0.002, abs=0.004)
    assert explain(bank(3), rough)[0].reversals == pytest.approx(2.0 / 3.0, abs=0.06)


@pytest.mark.parametrize("threads", [1, 2])
def test_parameter_sets_are_their_models(threads: int) -> None:
    rng = np.random.default_rng(5)
    p0, p, r = rng.normal(size=11), rng.normal(size=(11, 4)), np.sort(rng.random((11, 4)), axis=1)
    u = rng.normal(size=3000)
    model = hyst.PrandtlIshlinskii(p[0], r[0])
    y = evaluate_batch(model, u, np.column_stack([p0, p, r]), threads=threads)
    for s in range(11):
        np.testing.assert_array_equal(y[s], hyst.PrandtlIshlinskii(p[s], r[s], p0[s])(u))
