"""Memory elements: the examples of S3, table I and theorem 8."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import InputError, MemoryElement, RambergOsgood, load
from hyst.models import MemoryFunction

DT = 1e-4
T = np.arange(0.0, 1.0, DT)
W = 2.0 * np.pi


def test_memristor_of_example_2() -> None:
    """V = R(q) I with R = R0 + k q + q^2: a pinched loop."""
    current = 0.5 * np.sin(W * T)
    charge = 0.5 * (1.0 - np.cos(W * T)) / W
    memristor = MemoryElement(MemoryFunction.polynomial([2.0, 1.0, 1.0]), DT)
    expected = (2.0 + charge + charge**2) * current
    # The input held over a step: the charge is off by dt |I| / 2, V by R' |I| < 1 times that.
    assert np.abs(memristor(current) - expected).max() < 1.0 * 0.5 * DT
    assert memristor([0.0, 0.0]).tolist() == [0.0, 0.0]


def test_memcapacitor_and_meminductor_of_table_1() -> None:
    """Input the integral of current (or voltage), output voltage (or current)."""
    for k in (0.0, 4.0):
        through = np.sin(W * T) / W  # integral of cos(W t)
        twice = (1.0 - np.cos(W * T)) / W**2
        element = MemoryElement(MemoryFunction.power_law(5.0, k, 1.0), DT, momentum="signed")
        expected = (5.0 + k * twice) * through
        # The momentum is off by dt |input| / 2 and terms of dt^2, the output by k |input| times it.
        bound = 1.001 * k * DT / 2.0 / W**2 + 1e-13
        assert np.abs(element(through) - expected).max() < bound


def test_memdamper_of_example_3_from_a_table() -> None:
    """v = phi(P) F with P the integral of F, phi measured at a few points."""
    force = np.where(T < 0.5, 2.0, -2.0)
    momentum = np.minimum(2.0 * T, 2.0 - 2.0 * T)
    phi = MemoryFunction.table([0.0, 0.5, 1.0], [1.0, 2.0, 4.0])
    damper = MemoryElement(phi, DT)
    expected = np.interp(momentum, [0.0, 0.5, 1.0], [1.0, 2.0, 4.0]) * force
    # A force that is constant between samples is integrated exactly; momentum in float sums.
    np.testing.assert_allclose(damper(force), expected, atol=1e-9)


def test_linear_damper_of_example_9() -> None:
    """Feedforward of a linear damper is F = v_d / phi, viscous friction feedforward."""
    wanted = np.sin(W * T)
    damper = MemoryElement(MemoryFunction.polynomial([0.25]), DT)
    np.testing.assert_array_equal(damper.inverse()(wanted), wanted / 0.25)


FUNCTIONS = {
    "power law": MemoryFunction.power_law(0.5, 0.3, 1.3),
    "polynomial": MemoryFunction.polynomial([1.0, -0.5, 0.4]),
    "table": MemoryFunction.table([-0.1, 0.2, 0.5], [1.0, 3.0, 0.5]),
}


@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=list(FUNCTIONS))
@pytest.mark.parametrize("momentum", ["signed", "absolute"])
@pytest.mark.parametrize("reset", ["never", "sign-change"])
def test_theorem_8(function: MemoryFunction, momentum: str, reset: str) -> None:
    element = MemoryElement(function, 0.01, momentum, reset, start=0.1, reset_to=0.05)
    rng = np.random.default_rng(0)
    u = np.sin(np.linspace(0.0, 30.0, 800)) + 0.1 * rng.normal(size=800)
    inverse = element.inverse()
    assert np.abs(inverse(element(u)) - u).max() <= 1e-12 * np.ptp(u)
    assert np.abs(element(inverse(u)) - u).max() <= 1e-12 * np.ptp(u)
    assert inverse.inverse() == element
    p = [0.1]
    expected = []
    for value, before in zip(u, [0.0, *u[:-1]], strict=True):
        if reset == "sign-change" and value * before < 0.0:
            p[-1] = 0.05
        expected.append(float(function(p[-1])) * value)
        p.append(p[-1] + 0.01 * (abs(value) if momentum == "absolute" else value))
    np.testing.assert_allclose(element(u), expected, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=list(FUNCTIONS))
def test_jacobian_against_differences(function: MemoryFunction) -> None:
    u = np.sin(np.linspace(0.1, 9.0, 100))
    for element in (
        MemoryElement(function, 0.05, "absolute", "sign-change"),
        MemoryElement(function, 0.05, start=0.1).inverse(),
    ):
        theta = element.parameters().values
        jacobian = element.jacobian(u)
        for j in range(theta.size):
            step = np.zeros(theta.size)
            step[j] = 1e-7
            quotient = (
                element.with_parameters(theta + step)(u) - element.with_parameters(theta - step)(u)
            ) / 2e-7
            np.testing.assert_allclose(jacobian[:, j], quotient, rtol=1e-5, atol=1e-6)


def test_theorem_4_in_rates() -> None:
    """With |u| and resets, the element over rates is Ramberg-Osgood with its last reversal."""
    c = (0.5, 0.3, 1.3)
    u = np.sin(W * T) + 0.5 * np.sin(3.0 * W * T + 1.0) - 0.5 * np.sin(1.0)
    rate = np.diff(u) / DT
    element = MemoryElement(MemoryFunction.power_law(*c), DT, "absolute", "sign-change")
    y_by_rates = np.concatenate([[0.0], np.cumsum(element(rate) * DT)])
    # After the first reversal: before it the model is on its loading curve, the element is not.
    start = 1 + int(np.argmax(np.diff(np.sign(rate)) != 0))
    y = RambergOsgood(*c, memory="last-reversal")(u)
    # Euler's rule: M is off by M' |du| / 2 on each of the 5 branches.
    largest = 1.3 * 0.3 * 3.0**0.3 * np.abs(np.diff(u)).max() / 2.0 * np.abs(np.diff(u)).sum()
    assert np.abs((y_by_rates - y) - (y_by_rates - y)[start])[start:].max() < largest


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda: MemoryFunction.power_law(0.0, 1.0, 1.0), "c1 > 0"),
        (lambda: MemoryFunction.power_law(1.0, -1.0, 1.0), "c2 >= 0"),
        (lambda: MemoryFunction.power_law(1.0, 1.0, -0.5), "c3 > 0"),
        (lambda: MemoryFunction.polynomial([1.0, 1.0]), "0 at p = -1"),
        (lambda: MemoryFunction.polynomial([0.0, 1.0]), "positive a_0"),
        (lambda: MemoryFunction.polynomial([1.0, -2.0, 1.0]), "0 at p = 1"),
        (
            lambda: MemoryFunction.polynomial([1.0, 0.2, 1e-309]),
            r"\[2\] is 1e-309, too small",
        ),
        (lambda: MemoryFunction.table([0.0, 0.0], [1.0, 1.0]), "sort the points"),
        (lambda: MemoryFunction.table([0.0, 1.0], [1.0, 0.0]), r"values\[1\] is 0"),
        (lambda: MemoryFunction.table([0.0], [1.0, 2.0]), "as many"),
        (lambda: MemoryFunction("spline", [1.0]), "'spline'"),
        (lambda: MemoryFunction("polynomial", [1.0], [0.0]), "no knots"),
        (
            lambda: MemoryElement(FUNCTIONS["table"], 0.0),
            "sample_time is 0.0; give the time between samples",
        ),
        (lambda: MemoryElement(FUNCTIONS["table"], 1.0, momentum="odd"), "'odd'"),
        (lambda: MemoryElement(FUNCTIONS["table"], 1.0, reset="always"), "'always'"),
        (lambda: MemoryElement(FUNCTIONS["table"], 1.0, start=float("nan")), "start is nan"),
        (lambda: MemoryElement(2.0, 1.0), "MemoryFunction"),
    ],
)
def test_refusals(make, part: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert part.replace("\\", "") in str(caught.value)


def test_files(tmp_path) -> None:
    for function in FUNCTIONS.values():
        for element in (
            MemoryElement(function, 0.1, "absolute", "sign-change", 0.3, 0.2),
            MemoryElement(function, 0.1).inverse(),
        ):
            element.save(tmp_path / "model.json")
            assert load(tmp_path / "model.json") == element
            assert element.dt == 0.1
