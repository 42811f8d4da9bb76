"""Rejection with every plant within Wu, and designs beside one another."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from observer_cases import PLANT, PRINTED_GAIN, REPAIRED_C, WP, WU
from q_filter_cases import as_control, loop_by_control

import control
from hyst.control import (
    QFilterObserver,
    compare_designs,
    design_q_filter,
    evaluate_gain,
    observer_problem,
    robust_performance,
)
from hyst.control.q_filters import table_of
from hyst.errors import InputError

Array = np.ndarray[Any, np.dtype[Any]]


@pytest.fixture(scope="module")
def repaired() -> QFilterObserver:
    return design_q_filter(PLANT, REPAIRED_C, WU, WP)


def test_robust_performance_is_what_the_worst_plant_does(repaired: QFilterObserver) -> None:
    """Build the worst plant within Wu, wire its loop, and see what it leaves of a disturbance."""
    told = robust_performance(repaired)
    p = repaired.problem
    w = told.worst_frequency
    loop = loop_by_control(repaired, as_control(p.plant))
    T = -loop(1j * w)[0, 0]
    # Delta = -+ Wu (s - a)/(s + a), turned so that T Delta = -|T Wu| at w.
    wanted = -np.conj(T) / abs(T) * abs(as_control(p.Wu)(1j * w))
    turn = np.angle(wanted / as_control(p.Wu)(1j * w))
    sign = 1.0 if turn > 0.0 else -1.0
    # The phase of (s - a)/(s + a) at jw is pi - 2 atan(w/a), between 0 and pi.
    a = w / np.tan(0.5 * (np.pi - (turn if turn > 0.0 else turn + np.pi)))
    Delta = sign * control.tf([1.0, -a], [1.0, a]) * control.tf(*WU)
    P = control.tf(*PLANT) * (1 + Delta)
    assert Delta(1j * w) == pytest.approx(wanted, rel=1e-6)
    perturbed = loop_by_control(repaired, control.ss(P))
    S0 = 1.0 / (1.0 + control.tf(*PLANT)(1j * w) * control.tf(*REPAIRED_C)(1j * w))
    left = abs(perturbed(1j * w)[2, 0] / S0) * abs(control.tf(*WP)(1j * w))
    assert perturbed.poles().real.max() < 0.0
    assert left == pytest.approx(told.worst, rel=1e-5)
    assert told.worst > 1.0
    assert not told.holds


def test_robust_performance_below_one_holds_for_random_plants() -> None:
    Wu, Wp = ([1.0, 1.0], [1.0, 60.0]), ([0.3, 3.0], [1.0, 0.01])
    plant, C = ([10.0], [1.0, 10.0]), ([1.0], [1.0, 0.0])
    design = design_q_filter(plant, C, Wu, Wp)
    told = robust_performance(design)
    assert told.value < 1.0
    rng = np.random.default_rng(3)
    w = np.geomspace(1e-3, 1e4, 2000)
    S0 = 1.0 / (1.0 + control.tf(*plant)(1j * w) * control.tf(*C)(1j * w))
    allowed = np.abs(S0 / control.tf(*Wp)(1j * w))
    most = 0.0
    for _ in range(30):
        a, sign = 10.0 ** rng.uniform(-1, 3), rng.choice([-1.0, 1.0])
        Delta = sign * control.tf([1.0, -a], [1.0, a]) * control.tf(*Wu)
        loop = loop_by_control(design, control.ss(control.tf(*plant) * (1 + Delta)))
        most = max(most, float((np.abs(loop(1j * w)[2, 0]) / allowed).max()))
    assert most <= told.worst * (1.0 + 1e-6) < 1.0
    # At least half of what is possible is met, so that the bound is not empty.
    assert most > 0.5 * told.worst


@pytest.mark.parametrize("options", [{"order": 3}, {"order": 3, "family": "free"}])
def test_what_holds_for_every_plant_can_be_asked_for(options: dict[str, Any]) -> None:
    """Least |Wp (1 - Q)| + |Wu T|: no filter near the one found has less."""
    stacked = design_q_filter(PLANT, REPAIRED_C, WU, WP, **options)
    robust = design_q_filter(PLANT, REPAIRED_C, WU, WP, **options, objective="robust")
    told = robust.certificate
    assert told.robust_performance < 0.99 * stacked.certificate.robust_performance
    assert robust.gamma > stacked.gamma
    assert told.observer_noise_gain <= 1.5 * (1.0 + 1e-4)
    w = np.geomspace(1e-1, 1e5, 20_000)
    s = 1j * w
    S0 = 1.0 / (1.0 + np.polyval(PLANT[0], s) / np.polyval(PLANT[1], s) * (4.0 + 8.0 / s))
    Wu, Wp = (np.abs(np.polyval(each[0], s) / np.polyval(each[1], s)) for each in (WU, WP))

    def total(above: Array, below: Array) -> float:
        E = 1.0 - np.polyval(above, s) / np.polyval(below, s)
        return float((Wp * np.abs(E) + Wu * np.abs(1.0 - S0 * E)).max())

    above, below = robust.filter.numerator, robust.filter.denominator
    assert total(above, below) == pytest.approx(told.robust_performance, rel=1e-5)
    rng = np.random.default_rng(5)
    for _ in range(40):
        stretch = np.exp(rng.normal(0.0, 0.02))
        if options.get("family") == "free":
            poles = np.roots(below) * stretch * (1.0 + rng.normal(0.0, 0.02))
            other = np.real(np.poly(poles))
            top = np.append(above[:-1] * (1.0 + rng.normal(0.0, 0.02)), other[-1])
        else:
            other = below * stretch ** np.arange(below.size)
            top = above * stretch ** (below.size - 1)
        # Within the tie of 2e-4 and the spacing of w.
        assert total(top, other) >= told.robust_performance * (1.0 - 4e-4)


def test_robust_performance_of_the_papers_observer() -> None:
    design = evaluate_gain(observer_problem(PLANT, REPAIRED_C, WU, WP), PRINTED_GAIN)
    told = robust_performance(design)
    w = np.geomspace(1e-1, 1e6, 200_000)
    s = 1j * w
    A, B, C, out = design.problem.augmented()
    Q = control.ss(A - design.gain[:, None] @ C, -B, out, 0.0)(s)
    S0 = 1.0 / (1.0 + control.tf(*PLANT)(s) * control.tf(*REPAIRED_C)(s))
    E = 1.0 - Q
    Wp_E = np.abs(control.tf(*WP)(s) * E)
    Wu_T = np.abs(control.tf(*WU)(s) * (1.0 - S0 * E))
    # Spacing 8e-5, smooth peaks.
    assert told.value == pytest.approx((Wp_E + Wu_T).max(), rel=1e-6)
    assert told.worst == pytest.approx((Wp_E / (1.0 - Wu_T)).max(), rel=1e-6)
    assert design.gamma <= told.value <= math.sqrt(2.0) * design.gamma


def test_rows_beside_one_another(repaired: QFilterObserver) -> None:
    given = evaluate_gain(observer_problem(PLANT, REPAIRED_C, WU, WP), PRINTED_GAIN)
    rows = compare_designs(PLANT, REPAIRED_C, WU, WP, {"printed gain": given})
    assert [row.name for row in rows] == [
        "no observer",
        "1/(tau s + 1)^3",
        "1/(tau s + 1)^4",
        "printed gain",
    ]
    w = np.geomspace(1e-3, 1e6, 100_000)
    s = 1j * w
    Pn, C = control.tf(*PLANT)(s), control.tf(*REPAIRED_C)(s)
    T = Pn * C / (1.0 + Pn * C)
    alone = rows[0]
    # Wp = (0.5 s + 64 pi)/(s + 0.2) is largest at 0.
    assert alone.performance_norm == pytest.approx(64.0 * np.pi / 0.2, rel=1e-9)
    assert alone.uncertainty_norm == pytest.approx(np.abs(control.tf(*WU)(s) * T).max(), rel=1e-6)
    assert alone.noise_gain == pytest.approx(np.abs(T / Pn).max(), rel=1e-6)
    assert (alone.observer_noise_gain, alone.bandwidth, alone.order) == (0.0, 0.0, 0)
    assert rows[1].stacked_norm == repaired.gamma
    # The same norms from the loop with the observer's states.
    c = given.certificate
    assert rows[3].stacked_norm == pytest.approx(c.stacked_norm, rel=1e-6)
    assert rows[3].uncertainty_norm == pytest.approx(c.uncertainty_norm, rel=1e-6)
    assert rows[3].performance_norm == pytest.approx(c.performance_norm, rel=1e-6)
    told = table_of(rows)
    assert len(told.splitlines()) == 5
    assert "0.952" in told.splitlines()[2]
    assert rows[0].to_dict()["name"] == "no observer"


def test_only_designs_can_be_judged() -> None:
    with pytest.raises(InputError, match="the design is str; give what"):
        robust_performance("a filter")
