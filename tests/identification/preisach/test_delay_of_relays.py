"""The delay of switching materials is told by relays, not by loops of a general kind.

General loops bend from where they turn; those of a switching material rest there. So a delay that
makes general loops fit best narrows or widens a loop that they cannot bend, and means nothing.
"""

import itertools

import numpy as np
import pytest

import hyst

EDGES = np.linspace(-1.2, 1.2, 41)
NOISE = 0.002
"""Of the output's range."""


def material(coercive: float, width: float) -> hyst.Preisach:
    middle = (EDGES[1:] + EDGES[:-1]) / 2.0
    alpha, beta = np.meshgrid(middle, middle, indexing="ij")
    field, bias = (alpha - beta) / 2.0, (alpha + beta) / 2.0
    weights = np.exp(-0.5 * (((field - coercive) / width) ** 2 + (bias / 0.2) ** 2))
    return hyst.Preisach(np.where(alpha >= beta, weights, 0.0), EDGES)


def strokes(turns: list[float]) -> np.ndarray:
    parts = [np.array(turns[:1])]
    for a, b in itertools.pairwise(turns):
        parts.append(np.linspace(a, b, max(round(60 * abs(b - a)), 2) + 1)[1:])
    return np.concatenate(parts)


def identified(model: hyst.Preisach, u: np.ndarray, lag: int, sign: float = 1.0) -> hyst.Identified:
    y = sign * model(u)
    y = np.concatenate([np.full(lag, y[0]), y[: y.size - lag]])
    noise = NOISE * np.ptp(y) * np.random.default_rng(7).standard_normal(u.size)
    return hyst.identify(hyst.Record(u, y + noise, 0.01), family="preisach")


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("turns", [[0.0, 1.0, -1.0, 1.0, -1.0], [-1.0, 1.0, -1.0, 1.0, -1.0, 1.0]])
def test_a_major_loop_is_not_taken_to_be_ahead_of_its_input(turns, sign):
    u, model = strokes(turns), material(0.35, 0.12)
    found = identified(model, u, 0, sign)
    # General loops say 20 to 25 samples ahead, and relays leave twelve times the noise there.
    assert found.delay == 0
    assert found.metrics["training"].rms_percent < 1.5 * 100.0 * NOISE
    assert "ahead" not in " ".join(found.verdict.sentences)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_lag_is_found_where_minor_loops_tell_it_from_a_wider_loop(sign):
    u = strokes([-1.0, 1.0, *(each for b in np.linspace(-0.9, 0.9, 8) for each in (b, 1.0))])
    model = material(0.35, 0.12)
    found = identified(model, u, 5, sign)
    assert found.delay == 5
    low, high = found.delay_interval
    assert low <= 5 <= high
    after = int(u.argmax())
    error = (sign * found.model(u) - model(u))[after:]
    # 0.4 % is asked of curves held out; without its lag this one is off by 2.5 %.
    assert np.sqrt(np.mean(np.square(error))) < 0.004 * np.ptp(model(u))
