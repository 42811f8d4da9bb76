"""Records in stretches against samples one by one: the same bits, in output and memory."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import InputError, MasingOperator, Operator, RambergOsgood, _engine
from hyst.models import ExponentialCurve, Iwan, PiecewiseLinear, PolynomialCurve, PowerLaw

LAW = (0.5, 0.3, 1.3)
OPERATORS: dict[str, Operator] = {
    "nested": RambergOsgood(*LAW),
    "full": RambergOsgood(*LAW, depth=4),
    "last reversal": RambergOsgood(0.5, 0.3, 0.4, memory="last-reversal"),
    "dead band": RambergOsgood(*LAW, memory="last-reversal", dead_band=0.1),
    "plays": MasingOperator(PiecewiseLinear([0.5, 0.2], [0.3, 0.7], p0=0.1)),
    "polynomial": MasingOperator(PolynomialCurve([1.0, 0.2])),
    "exponential": MasingOperator(ExponentialCurve(1.0, 0.7, 0.8)),
    "saturating": MasingOperator(ExponentialCurve(0.0, -1.0, 0.5)),
    "flat in macro-slip": Iwan(1.0, 2.0, -0.3, 0.5),
    "inverse": RambergOsgood(*LAW).inverse(),
    "inverse, last reversal": RambergOsgood(0.5, 0.3, 0.4, memory="last-reversal").inverse(),
    "inverse of an exponential": MasingOperator(ExponentialCurve(1.0, 0.7, 0.8)).inverse(),
}


def smooth(rng: np.random.Generator, samples: int) -> np.ndarray:
    t = np.linspace(0.0, 2.0 * np.pi, samples)
    return np.sum([rng.normal() / k * np.sin(k * t + rng.random()) for k in range(1, 40)], axis=0)


@pytest.mark.parametrize("operator", OPERATORS.values(), ids=list(OPERATORS))
@pytest.mark.parametrize("seed", range(4))
def test_stretches_are_samples(operator: Operator, seed: int) -> None:
    rng = np.random.default_rng(seed)
    u = np.concatenate(
        [
            smooth(rng, 2500),
            np.repeat(smooth(rng, 200), 3),
            rng.normal(size=150),
            smooth(rng, 1500).round(1),  # rests, both zeros, loops that close exactly
            np.linspace(0.0, 9.0, 5000),  # longer than a block
        ]
    )
    y, state = operator.run(u)
    step = operator.stepper()
    assert np.array([step(value) for value in u.tolist()]).tobytes() == y.tobytes()
    assert step.state.tobytes() == state.tobytes()


@pytest.mark.parametrize("c3", [-0.7, -0.05, 0.001, 0.5, 1.3, 6.0, 90.0])
@pytest.mark.parametrize("c1", [0.0, 1e-9, 1e-3, 1.0, 1e3])
def test_an_equation_takes_as_many_steps_in_a_pack_as_alone(c1: float, c3: float) -> None:
    """Samples of all sizes side by side, which take from one to six powers, and 0 among them."""
    inverse = MasingOperator(PowerLaw(c1, 1.0, c3)).inverse()
    up = np.sort(np.concatenate([np.geomspace(1e-9, 1e3, 211), np.linspace(0.0, 40.0, 90)]))
    y = np.concatenate([up, up[::-1][1:], -up, [0.0, 0.0], 0.5 * up])
    step = inverse.stepper()
    alone = np.array([step(value) for value in y.tolist()]).tobytes()
    before = _engine.instruction_set()
    try:
        for name in _engine.instruction_sets():
            _engine.use_instruction_set(name)
            u, state = inverse.run(y)
            assert u.tobytes() == alone
            assert state.tobytes() == step.state.tobytes()
    finally:
        _engine.use_instruction_set(before)


def test_what_overflows_is_refused_where_the_core_says() -> None:
    model = RambergOsgood(1.0, 1.0, 4.0)
    u = np.geomspace(1.0, 1e100, 300)
    step = model.stepper()
    held = []
    for value in u.tolist():
        held.append(step(value))
        if step.fault:
            break
    first = len(held) - 1
    assert 0 < first < 299
    with pytest.raises(InputError, match=rf"u\[{first}\] = .* overflows"):
        model.run(u)
    y, state = model.run(u[:first])
    assert y.tolist() == held[:first]
    assert step.state.tobytes() == state.tobytes()


def test_every_instruction_set_gives_the_same_bits() -> None:
    u = 3.0 * smooth(np.random.default_rng(9), 3001)
    before = _engine.instruction_set()
    outputs = set()
    try:
        for name in _engine.instruction_sets():
            _engine.use_instruction_set(name)
            outputs.add(RambergOsgood(*LAW)(u).tobytes())
    finally:
        _engine.use_instruction_set(before)
    assert len(outputs) == 1
