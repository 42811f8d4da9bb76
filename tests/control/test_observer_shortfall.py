"""Weights that cannot be met: which row fails, at which frequency, and what to change."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from observer_cases import PLANT, PRINTED_C, REPAIRED_C, WP, WU

from hyst.control import DisturbanceObserver, design_disturbance_observer, observer_problem
from hyst.errors import InputError


def designed(**changed: Any) -> DisturbanceObserver:
    given = {"plant": PLANT, "controller": REPAIRED_C, "Wu": WU, "Wp": WP} | changed
    return design_disturbance_observer(**given, method="descent", starts=1)


def number_after(text: str, message: str) -> float:
    found = re.search(rf"{text} ([0-9.e+-]+[0-9])", message)
    assert found is not None, message
    return float(found.group(1))


def test_a_weight_that_asks_at_high_frequencies() -> None:
    """Q falls off, so 1 - Q is 1 there."""
    found = designed(Wp=([1.4, 20.0], [1.0, 0.2]))
    assert not found.feasible
    assert "Wp is 1.4 at high frequencies, where 1 - Q is 1 for every observer" in found.message
    assert "Wp (1 - Q) is 1." in found.message
    assert found.lower_bound >= 1.4


def test_a_plant_that_is_not_known_at_zero() -> None:
    found = designed(Wu=([2.0, 1300.0], [1.0, 1000.0]))
    assert not found.feasible
    assert "Wu is 1.3 at 0 rad/s, where the internal model makes T = 1" in found.message


def test_weights_that_exclude_each_other() -> None:
    """What the message says of one frequency is tried with every 1 - Q on a fine grid."""
    Wu, Wp = ([3.0, 30.0], [1.0, 100.0]), ([0.5, 450.0], [1.0, 0.2])
    found = designed(Wu=Wu, Wp=Wp)
    assert not found.feasible
    assert "exclude each other for every observer" in found.message
    w = number_after("at", found.shortfall.split(": ", 1)[1])
    p = found.problem
    P, C, U, W = (
        each.response(np.array([1j * w]))[0, 0, 0] for each in (p.plant, p.controller, p.Wu, p.Wp)
    )
    S0 = 1.0 / (1.0 + P * C)
    real, imaginary = np.meshgrid(np.linspace(-3.0, 3.0, 1201), np.linspace(-3.0, 3.0, 1201))
    E = real + 1j * imaginary

    def least(U: float, W: float) -> float:
        return float(np.sqrt(np.abs(U * (1.0 - S0 * E)) ** 2 + np.abs(W * E) ** 2).min())

    # A step of 0.005 in E moves a gain by less than 2 %, and the least gain is flat in Wp.
    assert least(abs(U), abs(W)) > 1.0
    assert least(abs(U), 0.9 * number_after("Wp below", found.shortfall)) < 1.0
    assert least(abs(U), 1.1 * number_after("Wp below", found.shortfall)) > 1.0
    if "Wu below" in found.shortfall:
        assert least(0.9 * number_after("Wu below", found.shortfall), abs(W)) < 1.0


def test_a_controller_that_already_fails() -> None:
    """With the printed controller T = 1.37 near the second mode, before any observer."""
    found = designed(controller=PRINTED_C)
    w = number_after("at", found.shortfall.split("already", 1)[0].split("without", 1)[1])
    p = found.problem
    P, C, U = (each.response(np.array([1j * w]))[0, 0, 0] for each in (p.plant, p.controller, p.Wu))
    alone = abs(U * P * C / (1.0 + P * C))
    assert alone > 1.0
    assert f"without an observer Wu T is {alone:.3g}" in found.message
    assert "Wu T is 2.0" in found.message


def test_weights_that_this_order_does_not_meet() -> None:
    """1.15 times the weights that order 3 meets by 0.924: 1.06, and 0.97 with one more."""
    more = 1.15
    Wu, Wp = ([more * each for each in WU[0]], WU[1]), ([more * each for each in WP[0]], WP[1])
    found = designed(Wu=Wu, Wp=Wp)
    assert not found.feasible
    assert "Wu and Wp both lowered 1.06 times are met by this gain" in found.message
    assert "order='auto'" in found.message
    assert "whatever its noise gain" in found.message
    assert designed(Wu=Wu, Wp=Wp, order="auto").feasible


def test_nothing_is_said_of_what_is_met() -> None:
    found = designed()
    assert found.feasible
    assert found.shortfall == ""


@pytest.mark.parametrize(
    ("plant", "message"),
    [
        (([900.0], [1.0, 0.0, 900.0]), r"pole at 0 [+-] 30j 1/s, on the border of stability; give"),
        (([900.0], [1.0, -1e-13, 900.0]), r"on the border of stability; give the damping"),
        (([900.0], [1.0, -0.1, 900.0]), r"pole at 0.05 [+-] 30j 1/s; stabilize it first"),
        (
            ([1.0, 0.0, 900.0], [1.0, 60.0, 1200.0, 8000.0]),
            r"zero at 0 [+-] 30j 1/s, on the border of stability; the inverse in the observer",
        ),
        (([1.0, -0.1, 900.0], [1.0, 60.0, 1200.0, 8000.0]), r"zero at 0.05 .*; its inverse"),
    ],
)
def test_plants_at_the_border(plant: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        observer_problem(plant, ([0.0], [1.0]), WU, WP)
