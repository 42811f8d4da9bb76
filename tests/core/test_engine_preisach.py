"""Records piece by piece against samples one by one: the same bits, in output and memory."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import InputError, Operator, Preisach

RNG = np.random.default_rng(1)
EDGES = np.sort(RNG.uniform(-2.0, 2.0, 8))
MASSES = np.tril(RNG.uniform(0.1, 1.0, (7, 7)))
EVEN = Preisach(MASSES, np.linspace(-2.0, 2.0, 8), 0.3)
OPERATORS: dict[str, Operator] = {
    "even thresholds": EVEN,
    "uneven thresholds": Preisach(MASSES, EDGES, 0.3),
    "relays alone": Preisach(MASSES, EDGES),
    "on one side": Preisach(MASSES, EDGES + 2.1, 0.3),
    "full": Preisach(MASSES, EDGES, 0.3, depth=3),
    "from a start": Preisach(MASSES, EDGES, 0.3, u0=-1.1),
    "ridges": Preisach(MASSES, EDGES, 0.3, density="ridges"),
    "inverse": EVEN.inverse(),
    "inverse from a start": Preisach(MASSES, EDGES, 0.3, u0=1.1).inverse(),
    "inverse of ridges": Preisach(MASSES, EDGES, 0.3, density="ridges").inverse(),
}


def smooth(rng: np.random.Generator, samples: int) -> np.ndarray:
    t = np.linspace(0.0, 2.0 * np.pi, samples)
    return np.sum([rng.normal() / k * np.sin(k * t + rng.random()) for k in range(1, 40)], axis=0)


@pytest.mark.parametrize("operator", OPERATORS.values(), ids=list(OPERATORS))
@pytest.mark.parametrize("seed", range(4))
def test_pieces_are_samples(operator: Operator, seed: int) -> None:
    rng = np.random.default_rng(seed)
    u = np.concatenate(
        [
            smooth(rng, 2500),
            np.repeat(smooth(rng, 200), 3),
            rng.normal(size=150),
            rng.choice(np.concatenate([EDGES, -EDGES, np.linspace(-2.0, 2.0, 8)]), 300),
            smooth(rng, 1500).round(1),  # rests, both zeros, loops that close exactly
            np.linspace(0.0, 9.0, 2000),
            np.linspace(9.0, -9.0, 2000),
        ]
    )
    y, state = operator.run(u)
    step = operator.stepper()
    assert np.array([step(value) for value in u.tolist()]).tobytes() == y.tobytes()
    assert step.state.tobytes() == state.tobytes()


def test_what_overflows_is_refused_where_the_core_says() -> None:
    model = Preisach([[1.0]], [-1.0, 1.0], p0=10.0)
    u = np.append(np.linspace(0.0, 5.0, 50), [1e300, 1e308, 1.0])
    with pytest.raises(InputError, match=r"u\[51\] = .* overflows"):
        model.run(u)
    step = model.stepper()
    held = [step(value) for value in u.tolist()]
    assert held[51] == held[50]
    assert step.fault


def test_saturation_is_refused_where_the_core_says() -> None:
    inverse = Preisach(MASSES, EDGES).inverse()
    total = MASSES.sum()
    y = np.linspace(0.0, 1.01 * total, 400)
    first = int(np.argmax(y > total))
    with pytest.raises(InputError, match=rf"u\[{first}\] = "):
        inverse.run(y)
    assert np.isfinite(inverse(y[:first])).all()
