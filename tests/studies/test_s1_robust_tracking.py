"""The study of S1 against the notes on the paper, which were computed independently."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.compensation import error_bound
from hyst.control import closed_loop_poles, compare_inverses
from hyst.operators import Affine
from hyst.report.table import Table
from hyst.studies import keys, study
from hyst.studies import s1_robust_tracking as s1


@pytest.fixture(scope="module")
def short() -> dict[str, float]:
    """Errors rms of the repaired loop by inverse and observer, from 1 s to 3 s as in the notes."""
    both = s1.designs(repaired=True)
    exact = s1.PLAYS.inverse()
    options = {"plant": s1.TRUE_PLANT, "controller": s1.CONTROLLER, "hysteresis": s1.PLAYS}
    found: dict[str, float] = {}
    for name, observer in (("best", both.best), ("printed", both.printed)):
        loops = compare_inverses(
            s1.reference(),
            s1.DT,
            {"exact": exact, "0.7": Affine(0.7) @ exact, "none": None},
            observer=observer,
            settle=s1.SETTLE,
            **options,
        )
        found |= {f"{each}, {name}": loop.rms_error for each, loop in loops.observed.items()}
        found |= {each: loop.rms_error for each, loop in loops.without.items()}
        found[f"recovered, {name}"] = loops.recovered("0.7")
    return found


def column(table: Table, index: int) -> dict[str, float]:
    return {row[0]: float(row[index]) for row in table.rows}


def test_it_is_one_of_the_studies() -> None:
    assert "s1" in keys()
    # Every key leads to a module that is a study, whatever else is named after a source.
    assert all(study(key).title for key in keys())


def test_inverse_constants() -> None:
    computed = column(s1.inverse_constants(), 2)
    # The notes: 0.4, 0.985, 1.846, ...; three decimals.
    s = [0.4, 0.985, 1.846, 3.118, 5.004, 7.807, 11.977, 18.186, 27.44, 41.094]
    g = [-3.160, -2.193, -1.503, -1.023, -0.693, -0.468, -0.315, -0.212, -0.139, -0.097]
    assert [computed[f"s{k + 1}"] for k in range(10)] == pytest.approx(s, abs=6e-4)
    assert [computed[f"g{k + 1}"] for k in range(10)] == pytest.approx(g, abs=6e-4)
    assert computed["g0"] == 10.0


def test_envelope_constants() -> None:
    computed = column(s1.envelope_constants(), 2)
    expected = {
        "epsilon0": 1.5385,
        "psi1": 4.914,
        "psi2": 8.688,
        "psi3": 15.2315,
        "epsilon1": -0.3620,
        "epsilon2": -0.3069,
        "epsilon3": -0.2244,
    }
    assert computed == pytest.approx(expected, abs=6e-5)


def test_q_filter_of_the_printed_gain() -> None:
    # The notes print four digits.
    found = s1.designs(repaired=True).printed.certificate.Q_denominator
    assert found == pytest.approx([1.0, 6.390e4, 1.978e7, 5.472e9], rel=1e-4)
    assert list(column(s1.filter_table(), 1).values()) == pytest.approx(found, rel=3e-3)


def test_the_printed_design_as_it_is() -> None:
    printed, repaired = s1.designs(repaired=False), s1.designs(repaired=True)
    assert printed.printed.gamma == pytest.approx(2.234, abs=5e-4)
    assert printed.best.gamma == pytest.approx(2.126, abs=2e-3)
    assert printed.printed.certificate.perturbed_stable is False
    assert repaired.printed.gamma == pytest.approx(1.180, abs=5e-4)
    assert repaired.best.gamma <= 0.93
    assert repaired.best.certificate.perturbed_stable is True
    loops = [row[-1] for row in s1.designs_table().rows]
    assert loops == ["UNSTABLE", "UNSTABLE", "stable", "stable"]


def test_tracking_errors_of_the_repaired_example(short: dict[str, float]) -> None:
    # A prototype with the printed gain: two decimals; how long it ran is not noted.
    assert short["exact"] == pytest.approx(4.64, abs=0.006)
    assert short["0.7"] == pytest.approx(11.64, abs=0.006)
    assert short["none"] == pytest.approx(6.01, abs=0.006)
    assert short["0.7, printed"] == pytest.approx(4.76, abs=0.006)
    assert short["recovered, printed"] > 0.95
    assert short["recovered, best"] > 0.95


def test_a_loop_that_is_not_proven_safe_says_so() -> None:
    # Without an inverse the largest slope is p0 + sum(p); with it the loop around the true plant is
    # unstable; its smaller errors are no recovery. Scaled inverses have slopes from 0 to 1.
    steepest = float(s1.PLAYS.p0 + s1.PLAYS.p.sum())
    unstable = closed_loop_poles(s1.TRUE_PLANT, ([4.0 * steepest, 8.0 * steepest], [1.0, 0.0]))
    assert unstable.real.max() > 0.0
    told = {row[0]: row[-1] for row in s1.tracking_table(generalized=False).rows}
    assert told.pop("none") == "NOT proven safe"
    assert set(told.values()) == {"proven stable"}


def test_bounds_of_scaled_inverses_by_hand() -> None:
    # (1 - factor) times the exact command of a load up to the reference's largest value.
    y_max = float(np.abs(s1.reference()).max())
    exact = s1.PLAYS.inverse()
    largest = exact.p0 * y_max + float(np.maximum(y_max - exact.r, 0.0) @ exact.p)
    for factor in s1.FACTORS:
        limit = error_bound(s1.PLAYS, Affine(factor) @ exact, y_max)
        assert limit.bound == pytest.approx((1.0 - factor) * largest, rel=1e-9)
    table = column(s1.bound_table(), 4)
    assert table["PI, 0.7"] == pytest.approx(0.3 * largest, abs=6e-4)
    reached = column(s1.bound_table(), 5)
    assert all(reached[name] <= bound + 1e-9 for name, bound in table.items())


def test_figures_are_drawn() -> None:
    exact = s1.PLAYS.inverse()
    factors = {f"{each:g}": Affine(each) @ exact for each in (*s1.FACTORS, *s1.FIG_12)}
    loop = compare_inverses(
        s1.reference(1e-3, 0.3),
        1e-3,
        {"exact": exact, "none": None, **factors},
        observer=None,
        plant=s1.PLANT,
        controller=1.0,
        hysteresis=s1.PLAYS,
    )
    drawn = s1.draw_all(
        s1.designs(repaired=True).best,
        s1.TRUE_PLANT,
        s1.reference(1e-3, 1.0),
        (s1.PLAYS, s1.GENERALIZED),
        (loop, loop),
    )
    assert set(drawn) == {f"s1-fig-{k}.png" for k in (5, 7, 8, 9, 10, 11, 12)}
    assert all(each.startswith(b"\x89PNG") for each in drawn.values())
