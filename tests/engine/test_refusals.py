"""What the compiled engine refuses, and that it changes nothing when it does."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.errors import InputError
from hyst.operators.stage import Stage


def bank() -> _engine.Chain:
    return _engine.Chain([Stage("pi", (0.3, 1.0, 2.0, 0.1, 0.2))])


u = np.linspace(0.0, 1.0, 100).reshape(1, -1)
z, y = np.zeros((1, 2)), np.zeros((1, 100))
read_only = np.zeros((1, 100))
read_only.flags.writeable = False


@pytest.mark.parametrize(
    "arguments",
    [
        (z.astype(np.float32), u, y),
        (z.astype(np.int64), u, y),
        (np.zeros((1, 4))[:, ::2], u, y),
        (z, u.astype(np.float32), y),
        (z, np.repeat(u, 2, axis=1)[:, ::2], y),
        (z, u[0], y),
        (z, u, y.astype(np.float32)),
        (z, u, read_only),
        (z.tolist(), u, y),
    ],
    ids=[
        "float32 state",
        "integer state",
        "strided state",
        "float32 u",
        "strided u",
        "flat u",
        "float32 y",
        "read-only y",
        "list as state",
    ],
)
def test_arrays_are_never_converted(arguments: tuple[np.ndarray, ...]) -> None:
    with pytest.raises(TypeError):
        bank().run(*arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        (z[:, :1].copy(), u, y),
        (z, u, y[:, :5].copy()),
        (z, u[:, 1:], u[:, :-1]),
        (np.zeros((2, 2)), u, y),
    ],
    ids=["short state", "short y", "y overlaps u", "state of two records"],
)
def test_shapes_must_fit(arguments: tuple[np.ndarray, ...]) -> None:
    with pytest.raises(ValueError, match=r"must|shape"):
        bank().run(*arguments)


def test_empty_records_leave_the_state_alone() -> None:
    state = np.ones((1, 2))
    assert bank().run(state, np.empty((1, 0)), np.empty((1, 0))) == -1
    assert bank().run(np.empty((0, 2)), np.empty((0, 7)), np.empty((0, 7))) == -1
    np.testing.assert_array_equal(state, np.ones((1, 2)))


@pytest.mark.parametrize("engine", ["loop", "lanes", "memory-curve", "auto"])
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_the_first_bad_sample_is_found(
    instruction_set: str, engine: str, threads: int, bad: float
) -> None:
    for samples in (1, 50, 40_000):
        for index in {0, samples // 3, samples - 1}:
            record = np.sin(np.arange(samples) * 0.01).reshape(1, -1)
            record[0, index] = bad
            record[0, -1] = bad
            state = np.full((1, 2), 0.05)
            found = bank().run(state, record, np.empty_like(record), engine, threads)
            assert found == index
            np.testing.assert_array_equal(state, np.full((1, 2), 0.05))


def test_operators_name_the_bad_sample() -> None:
    model = hyst.PrandtlIshlinskii(p=[1.0], r=[0.1])
    record = np.zeros((3, 1000))
    record[2, 7] = np.inf
    with pytest.raises(InputError, match=r"u\[\(2, 7\)\] is inf"):
        model(record)


@pytest.mark.parametrize("threads", [0, -1, 1.0, True, 2000, "2"])
def test_threads_are_a_positive_integer(threads: object) -> None:
    with pytest.raises(InputError, match="threads"):
        hyst.PrandtlIshlinskii(p=[1.0], r=[0.1]).run([0.0], threads=threads)  # type: ignore[arg-type]


def test_engines_have_names() -> None:
    with pytest.raises(InputError, match="memory-curve"):
        hyst.PrandtlIshlinskii(p=[1.0], r=[0.1]).run([0.0], engine="fast")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="memory-curve"):
        bank().run(z.copy(), u, y, "fast")
    with pytest.raises(ValueError, match="not available"):
        _engine.use_instruction_set("mmx")
