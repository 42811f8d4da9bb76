"""Records evaluated into their own memory get the bits they get elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from engine_cases import random_case

import hyst
from hyst import InputError, Operator

N = 70_000  # more than a block
rng = np.random.default_rng(3)
t = np.arange(N)
RECORDS = {
    "smooth": np.sin(t * 2e-3 * np.pi),
    "slow": np.sin(t * 1e-4),
    "rough": rng.uniform(-1.0, 1.0, N),
    "plateaus": np.round(np.sin(t * 2e-3 * np.pi) * 10) / 10,
    "steps": np.repeat(np.round(rng.normal(size=N // 5000) * 4) / 4, 5000),
    "flat": np.full(N, 0.3),
    "ties": np.cumsum(rng.choice([-0.1, 0.0, 0.1], N)) * 0.1,
}
BANK = hyst.PrandtlIshlinskii(np.full(40, 0.1), np.arange(40) * 0.025, 0.3)
OPERATORS: dict[str, Operator] = {
    "bank": BANK,
    "inverse": BANK.inverse(),
    "chain": BANK @ hyst.DeadZone([1.0, 0.1], [0.0, 0.3]),
    "two banks": BANK @ BANK,
    "rate": hyst.RateDependentPrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1e-4, 1e-3, 0.4),
    "loop": hyst.LinearDynamics([[0.9]], [1.0], [0.1], 0.0, 1e-3) @ hyst.Affine(2.0, 0.1),
}


@pytest.mark.parametrize("engine", ["auto", "loop", "lanes", "memory-curve"])
@pytest.mark.parametrize("kind", OPERATORS)
def test_long_records(kind: str, engine: str) -> None:
    operator = OPERATORS[kind]
    for threads, record in zip([1, 2] * 4, RECORDS.values(), strict=False):
        expected, end = operator.run(record, engine=engine, threads=threads)  # type: ignore[arg-type]
        y = record.copy()
        _, state = operator.run(y, out=y, engine=engine, threads=threads)  # type: ignore[arg-type]
        assert y.tobytes() == expected.tobytes()
        assert state.tobytes() == end.tobytes()


@pytest.mark.parametrize(("rows", "samples"), [(1, 4096), (37, 300), (3, 5000), (200, 700), (5, 1)])
def test_batches(rows: int, samples: int) -> None:
    u = np.cumsum(rng.normal(size=(rows, samples)), axis=1) * 0.05
    for operator in OPERATORS.values():
        expected, end = operator.run(u, threads=2)
        y, apart = u.copy(), np.empty_like(u)
        _, state = operator.run(y, out=y, threads=2)
        assert y.tobytes() == expected.tobytes() == operator(u, out=apart).tobytes()
        assert state.tobytes() == end.tobytes()


def test_random_cases_on_every_instruction_set(instruction_set: str) -> None:
    cases = np.random.default_rng(8)
    for _ in range(300):
        case = random_case(cases)
        apart, y = np.empty((1, case.u.size)), case.u.reshape(1, -1).copy()
        states = case.state.reshape(1, -1).copy(), case.state.reshape(1, -1).copy()
        assert case.chain.run(states[0], case.u.reshape(1, -1), apart) == -1
        assert case.chain.run(states[1], y, y) == -1
        assert y.tobytes() == apart.tobytes()
        assert states[1].tobytes() == states[0].tobytes()


@pytest.mark.parametrize("engine", ["auto", "loop", "lanes", "memory-curve"])
@pytest.mark.parametrize("at", [0, 4095, 66_000, N - 1])
@pytest.mark.parametrize("bad", [np.nan, 6.2e307])
def test_the_sample_that_is_refused_is_named(at: int, engine: str, bad: float) -> None:
    operator = hyst.PrandtlIshlinskii([3.125, -5.4375], [1.2, 2.0], p0=0.3)
    for record in (RECORDS["smooth"], RECORDS["rough"]):
        u = record.copy()
        u[at] = bad
        expected = rf"u\[{at}\] (= 6\.2e\+307 the operator overflows|is nan)"
        with pytest.raises(InputError, match=expected):
            operator.run(u, out=np.empty_like(u), engine=engine)  # type: ignore[arg-type]
        with pytest.raises(InputError, match=expected):
            operator.run(u, out=u, engine=engine)  # type: ignore[arg-type]


def test_large_numbers_are_left_to_the_cores_order() -> None:
    model = hyst.PrandtlIshlinskii([0.5, -0.25, 0.125], [0.0, 1e307, 3e307], p0=0.25)
    u = rng.normal(size=N).clip(-2.0, 2.0) * 0.8e308
    expected = model.run(u, engine="memory-curve")[0]
    assert model.run(u, out=u, engine="memory-curve")[0].tobytes() == expected.tobytes()
