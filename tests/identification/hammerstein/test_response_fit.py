"""Dynamics fitted to a frequency response are those it was made of."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein.known.response_fit import fitted_response
from hyst.models import LinearDynamics
from hyst.signals import MeasuredResponse

DT = 1e-4


def mode(frequency: float, damping: float, dt: float = DT, delay: int = 0) -> LinearDynamics:
    w = 2.0 * np.pi * frequency
    return LinearDynamics.from_continuous([w * w], [1.0, 2.0 * damping * w, w * w], dt, delay)


def noisy(values: np.ndarray, noise: float, seed: int = 0) -> np.ndarray:
    random = np.random.default_rng(seed)
    scatter = random.normal(size=values.size) + 1j * random.normal(size=values.size)
    return np.asarray(values + noise * np.abs(values).max() * scatter / np.sqrt(2.0))


def resonances(G: LinearDynamics) -> np.ndarray:
    """Frequency, Hz, and damping of each pair, from ``p = exp(s dt)``."""
    s = np.log(G.poles()[G.poles().imag > 0.0]) / G.dt
    found = np.array([np.abs(s) / (2.0 * np.pi), -s.real / np.abs(s)]).T
    return found[np.argsort(found[:, 0])]


@pytest.mark.parametrize("points", [60, 400])
@pytest.mark.parametrize(
    "modes",
    [
        ((200.0, 0.03),),
        ((200.0, 0.03), (520.0, 0.02)),
        ((60.0, 0.02), (150.0, 0.02), (320.0, 0.02)),
    ],
    ids=["one", "two", "three"],
)
def test_exact_responses_come_back(modes: tuple[tuple[float, float], ...], points: int) -> None:
    f = np.geomspace(1.0, 1000.0, points)
    values = np.prod([mode(*each, delay=2).frequency_response(f) for each in modes], axis=0)
    found = fitted_response(MeasuredResponse(f, values), DT)
    assert found.dynamics.order == 2 * len(modes)
    assert resonances(found.dynamics) == pytest.approx(np.array(modes), rel=1e-6)
    assert found.error < 1e-9
    assert found.dynamics.is_stable()


def test_noise_moves_a_resonance_by_little() -> None:
    f = np.linspace(1.0, 1000.0, 400)
    found = [
        fitted_response(
            MeasuredResponse(f, noisy(mode(200.0, 0.03, delay=3).frequency_response(f), 1e-3, s)),
            DT,
        )
        for s in range(5)
    ]
    assert {each.dynamics.order for each in found} == {2}
    for each in found:
        (frequency, damping), *_ = resonances(each.dynamics)
        # Five points lie in the peak, of 6 Hz half-width, but relative errors weigh it least of
        # all: a tenth of that width times the 0.7 % of error that is left.
        assert frequency == pytest.approx(200.0, abs=0.05)
        assert damping == pytest.approx(0.03, rel=0.005)
        assert each.dynamics.dc_gain() == pytest.approx(1.0, abs=5e-3)


@pytest.mark.parametrize("late", [0.0, 2.4, 30.4, 200.0])
def test_parts_of_a_sample_of_delay_are_in_the_numerator(late: float) -> None:
    f = np.linspace(1.0, 1000.0, 300)
    s = 2j * np.pi * f
    w = 2.0 * np.pi * 200.0
    values = w * w / (s * s + 0.06 * w * s + w * w) * np.exp(-s * late * DT)
    found = fitted_response(MeasuredResponse(f, values), DT)
    assert found.error < 1e-4
    assert np.abs(resonances(found.dynamics)[0] - [200.0, 0.03]).max() < 1e-2
    phase = np.angle(found.dynamics.frequency_response(f) / values)
    assert np.abs(phase).max() < 1e-4


def test_what_was_not_measured_is_no_resonance() -> None:
    """Between the last frequency and half the sample rate the response stays below its largest."""
    f = np.linspace(1.0, 500.0, 200)
    values = noisy(mode(200.0, 0.03).frequency_response(f), 3e-3)
    found = fitted_response(MeasuredResponse(f, values), DT)
    beyond = np.linspace(500.0, 5000.0, 500)
    assert np.abs(found.dynamics.frequency_response(beyond)).max() < np.abs(values).max()


def test_what_is_no_response_of_linear_dynamics_is_refused() -> None:
    f = np.linspace(1.0, 1000.0, 200)
    random = np.random.default_rng(0).normal(size=(2, 200))
    with pytest.raises(NotIdentifiableError, match="no order up to 12 leaves 10 %"):
        fitted_response(MeasuredResponse(f, random[0] + 1j * random[1]), DT)
    with pytest.raises(NotIdentifiableError, match="4 points below half the sample rate, 20 Hz"):
        fitted_response(MeasuredResponse(f[:40], np.ones(40)), 0.025 - 1e-9)


@pytest.mark.parametrize(
    ("frequency", "response", "says"),
    [
        ([1.0, 2.0], [1.0], "2 frequencies and 1 values"),
        ([], [], "0 frequencies"),
        ([1.0, np.nan], [1.0, 1.0], "frequency 1 is not finite"),
        ([1.0, 2.0], [1.0, np.inf], "response 1 is not finite"),
        ([-1.0, 2.0], [1.0, 1.0], "a frequency is -1 Hz"),
        ([2.0, 2.0], [1.0, 1.0], "2 Hz is given twice"),
        ([1.0, 2.0], [0.0, 0.0], "all values of the response are 0"),
        (["a"], [1.0], "no list of numbers"),
    ],
)
def test_a_faulty_response_is_refused(frequency: list, response: list, says: str) -> None:  # type: ignore[type-arg]
    with pytest.raises(InputError, match=says):
        MeasuredResponse(frequency, response)
