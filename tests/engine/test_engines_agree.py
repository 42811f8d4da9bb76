"""All engines against the core's loop."""

from __future__ import annotations

import numpy as np
import pytest
from engine_cases import Case, bank, random_case, run, same_bits
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hyst import _engine
from hyst.operators.stage import Stage

EPSILON = np.finfo(np.float64).eps


def assert_agreement(case: Case, seed: object) -> None:
    y, state = run(case, "loop")
    for engine in ("lanes", "auto", "memory-curve"):
        y_found, state_found = run(case, engine)
        assert same_bits(state_found, state), (engine, seed)
        if engine == "lanes":
            assert same_bits(y_found, y), seed
    # The memory curve takes differences of prefix sums over at most 24 plays: each of some 50
    # roundings is at most half an epsilon of the sum of all terms' sizes; then the segments' sums
    # are added once more.
    assert np.abs(y_found - y).max() <= 100 * EPSILON * case.size, seed


def test_ten_thousand_random_cases(instruction_set: str) -> None:
    count = 10_000 // len(_engine.instruction_sets()) + 1
    for seed in range(count):
        rng = np.random.default_rng([seed, len(instruction_set)])
        assert_agreement(random_case(rng), seed)


# Few values, so that ties, plateaus and closed loops come by themselves.
quarters = st.integers(-8, 8).map(lambda k: k / 4.0)
values = quarters | st.floats(-1e3, 1e3) | st.sampled_from([0.0, -0.0, 5e-324, 1e308, -1e308])


@given(
    u=arrays(np.float64, st.integers(1, 200), elements=values, fill=quarters),
    r=st.lists(st.integers(0, 8).map(lambda k: k / 4.0) | st.floats(0.0, 1e3), max_size=8),
    data=st.data(),
)
def test_records_that_hypothesis_thinks_of(
    u: np.ndarray, r: list[float], data: st.DataObject
) -> None:
    r.sort()
    z = np.array(data.draw(st.lists(values, min_size=len(r), max_size=len(r))))
    p = data.draw(st.lists(st.floats(-2.0, 2.0), min_size=len(r), max_size=len(r)))
    chain = _engine.Chain([bank(0.5, p, r)])
    case = Case(chain, z, u, 0.0)
    out, memory = np.empty((1, u.size)), z.reshape(1, -1).copy()
    bad = chain.run(memory, u.reshape(1, -1), out, "loop", 1)
    if bad >= 0:  # sums of numbers as large as doubles become overflow
        for engine in ("lanes", "memory-curve"):
            assert chain.run(memory, u.reshape(1, -1), out, engine, 1) == bad
        return
    for engine in ("lanes", "memory-curve"):
        assert same_bits(run(case, engine)[1], memory[0])
    assert same_bits(run(case, "lanes")[0], out[0])


@pytest.mark.parametrize("samples", [1, 7, 63, 64, 65, 512, 4096, 4097, 40_000])
@pytest.mark.parametrize("engine", ["lanes", "memory-curve"])
def test_records_of_every_length(instruction_set: str, engine: str, samples: int) -> None:
    chain = _engine.Chain([bank(1.0, [0.5, -0.25, 0.125], [0.0, 0.5, 0.5])])
    u = np.round(np.random.default_rng(samples).normal(size=samples) * 8) / 8
    case = Case(chain, np.zeros(3), u, 0.0)
    # Eighths times eighths: every sum is exact, so even the memory curve has no rounding to do.
    y, state = run(case, "loop")
    y_found, state_found = run(case, engine)
    assert same_bits(state_found, state)
    np.testing.assert_array_equal(y_found, y)


@pytest.mark.parametrize("engine", ["auto", "lanes", "memory-curve"])
@pytest.mark.parametrize("threads", [2, 3, 7])
def test_threads_change_nothing(instruction_set: str, engine: str, threads: int) -> None:
    rng = np.random.default_rng(threads)
    chain = _engine.Chain(
        [
            Stage("affine", (2.0, 0.5)),
            bank(0.3, rng.normal(size=20).tolist(), np.linspace(0.0, 2.0, 20).tolist()),
            Stage("dead_zone", (0.5, 1.0, -0.25, 0.5)),
            Stage("stop", (0.25,)),
        ]
    )
    u = np.cumsum(rng.normal(size=150_001)) * 0.01
    case = Case(chain, np.zeros(21), u, 0.0)
    y, state = run(case, "loop")
    y_found, state_found = run(case, engine, threads)
    if engine == "lanes":
        assert same_bits(state_found, state)
        assert same_bits(y_found, y)
    else:
        # Rounding of the plays' output, at most 44 of a size of 60, passes the later stages.
        np.testing.assert_allclose(y_found, y, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("rows", [1, 3, 8, 9, 16, 21])
@pytest.mark.parametrize("samples", [5, 64, 100, 5000])
def test_batches_are_their_records(instruction_set: str, rows: int, samples: int) -> None:
    rng = np.random.default_rng([rows, samples])
    first = bank(0.3, [1.0, -0.5, 0.2], [0.1, 0.1, 0.7])
    for chain in (_engine.Chain([first]), _engine.Chain([first, Stage("play", (0.2,))])):
        u = rng.normal(size=(rows, samples))
        start = rng.normal(size=(rows, chain.state_length)) * 0.1
        state, y = start.copy(), np.empty_like(u)
        assert chain.run(state, u, y, "auto", 2) == -1
        for row in range(rows):
            y_row, state_row = run(Case(chain, start[row], u[row], 0.0), "loop")
            assert same_bits(y[row], y_row)
            assert same_bits(state[row], state_row)


def test_unsorted_and_negative_thresholds_fall_back_to_the_loop(instruction_set: str) -> None:
    u = np.random.default_rng(1).normal(size=5000)
    for r in ([0.5, 0.1], [-0.1, 0.2]):
        chain = _engine.Chain([bank(0.3, [1.0, 2.0], r)])
        case = Case(chain, np.zeros(2), u, 0.0)
        y, state = run(case, "loop")
        for engine in ("lanes", "memory-curve", "auto"):
            y_found, state_found = run(case, engine)
            assert same_bits(y_found, y)
            assert same_bits(state_found, state)


def test_what_overflows_is_found_where_the_loop_finds_it(instruction_set: str) -> None:
    steep = Stage("affine", (1e300, 0.0))
    chain = _engine.Chain([steep, steep, bank(1.0, [1.0], [0.5])])
    u = np.zeros((1, 2000))
    u[0, 1000:1003] = 1.0, -1.0, 2.0
    for engine in ("loop", "lanes", "memory-curve", "auto"):
        state = np.full((1, 1), 0.25)
        assert chain.run(state, u, np.empty_like(u), engine, 1) == 1000
        assert state.tolist() == [[0.25]]
