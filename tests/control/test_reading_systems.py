"""Systems of scipy.signal, python-control and hyst as plants; and what cannot be one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.signal
from identified_cases import PI, G

import hyst
from hyst.control import LinearSystem, as_linear_system, plant_and_delay, sampled_plant

control = pytest.importorskip("control")

NUM, DEN = [2.0, 3.0], [1.0, 0.4, 4.0]
W = np.geomspace(0.03, 30.0, 20)


def by_hand(s: np.ndarray) -> np.ndarray:
    return (2.0 * s + 3.0) / (s**2 + 0.4 * s + 4.0)


@pytest.mark.parametrize(
    "system",
    [
        scipy.signal.lti(NUM, DEN),
        scipy.signal.lti(NUM, DEN).to_ss(),
        scipy.signal.lti(NUM, DEN).to_zpk(),
        control.tf(NUM, DEN),
        control.tf2ss(control.tf(NUM, DEN)),
        (NUM, DEN),
    ],
    ids=lambda each: type(each).__name__,
)
def test_a_continuous_system_has_its_response(system: Any) -> None:
    read = as_linear_system(system)
    assert (read.order, read.dt) == (2, 0.0)
    # Rounding of a few operations on numbers of size one to ten.
    np.testing.assert_allclose(read.response(1j * W)[:, 0, 0], by_hand(1j * W), rtol=1e-12)


@pytest.mark.parametrize("form", ["to_tf", "to_ss", "to_zpk"])
def test_a_sampled_system_of_scipy_has_its_response_and_sample_time(form: str) -> None:
    given = scipy.signal.dlti([0.5, 0.2], [1.0, -0.8, 0.3], dt=0.01)
    read = as_linear_system(getattr(given, form)())
    z = np.exp(1j * np.linspace(0.1, 3.0, 9))
    by_hand = (0.5 * z + 0.2) / (z**2 - 0.8 * z + 0.3)
    assert read.dt == 0.01
    np.testing.assert_allclose(read.response(z)[:, 0, 0], by_hand, rtol=1e-12)


def test_several_outputs_of_a_state_space_of_scipy_are_read() -> None:
    both = scipy.signal.StateSpace([[-1.0]], [[1.0]], [[1.0], [2.0]], [[0.0], [0.5]])
    read = as_linear_system(both)
    assert (read.inputs, read.outputs) == (1, 2)
    np.testing.assert_allclose(read.response(np.array([0.0]))[0, :, 0], [1.0, 2.5])


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("num", [[0.5, 0.2], [0.3, 0.5, 0.2]], ids=["strictly proper", "direct"])
def test_the_whole_delay_of_linear_dynamics_becomes_states(num: list[float], delay: int) -> None:
    system = hyst.LinearDynamics.from_transfer_function(num, [1.0, -0.8, 0.3], 0.01, delay)
    read = as_linear_system(system)
    z = np.exp(1j * np.linspace(0.1, 3.0, 9))
    by_hand = np.polyval(num, z) / np.polyval([1.0, -0.8, 0.3], z) / z**delay
    assert (read.order, read.dt) == (2 + delay, 0.01)
    np.testing.assert_allclose(read.response(z)[:, 0, 0], by_hand, rtol=1e-12)


def test_what_carries_a_system_is_one() -> None:
    carried = sampled_plant((NUM, DEN), dt=0.01, delay=0.02)
    assert as_linear_system(carried) is carried.system


def test_a_continuous_plant_keeps_its_dead_time_beside_it() -> None:
    late = G.to_continuous()
    system, delay = plant_and_delay(late, 0.0005)
    s = 2j * np.pi * np.array([10.0, 100.0, 300.0])
    ours = system.response(s)[:, 0, 0] * np.exp(-s * delay)
    theirs = late.frequency_response([10.0, 100.0, 300.0]) * np.exp(-s * 0.0005)
    assert delay == pytest.approx(0.0015, rel=1e-12)  # two samples and the half millisecond
    np.testing.assert_allclose(ours, theirs, rtol=1e-9)


def test_further_delay_of_a_sampled_plant_is_whole_samples() -> None:
    system, delay = plant_and_delay(LinearSystem([[0.5]], [[1.0]], [[0.5]], [[0.0]], 0.01), 0.02)
    z = np.exp(1j * np.linspace(0.1, 3.0, 9))
    assert (system.order, delay) == (3, 0.0)
    np.testing.assert_allclose(system.response(z)[:, 0, 0], 0.5 / (z - 0.5) / z**2, rtol=1e-12)
    with pytest.raises(hyst.InputError, match=r"0\.015 s, 1\.5 samples"):
        plant_and_delay(system, 0.015)
    with pytest.raises(hyst.InputError, match="delay of the plant"):
        plant_and_delay(system, -0.01)


@pytest.mark.parametrize(
    ("system", "told"),
    [
        (control.frd([1.0, 0.5], [1.0, 2.0]), "is a frequency response.*no states"),
        (hyst.signals.MeasuredResponse([1.0], [1.0]), "is a frequency response.*no states"),
        (G @ PI, "is a Composition of hyst.*identified_plant"),
        (PI, "is a PrandtlIshlinskii of hyst"),
        (G.to_continuous(), r"dead time of 0\.001 s"),
        (scipy.signal.dlti([1.0], [1.0, -0.5]), "no sample time given"),
        (scipy.signal.ZerosPolesGain([1.0, 2.0], [-3.0], 1.0), "improper"),
        (scipy.signal.lti([[1.0], [2.0]], [1.0, 1.0]), "transfer function.*2 outputs"),
        ("P", "the plant is str"),
        (None, "the plant is NoneType"),
    ],
)
def test_what_is_no_linear_system_is_refused_by_name(system: Any, told: str) -> None:
    with pytest.raises(hyst.InputError, match=told):
        as_linear_system(system, "the plant")
