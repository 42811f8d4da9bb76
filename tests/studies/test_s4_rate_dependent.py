"""The study of S4: what it prints, against numbers that were computed elsewhere."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.studies import s4_rate_dependent


@pytest.fixture(scope="module")
def fast() -> s4_rate_dependent.Case:
    return s4_rate_dependent.solve("example", 60.0)


def test_methods_at_60_hz(fast: s4_rate_dependent.Case) -> None:
    # Three digits of an independent prototype for the first two; demanded of the others.
    assert fast.largest("rate-independent") == pytest.approx(16.3, rel=5e-3)
    assert fast.largest("explicit") == pytest.approx(13.6, rel=5e-3)
    assert fast.largest("sample-exact") < 1e-9 * np.ptp(fast.y_ref)
    assert fast.largest("trajectory") < 1.2
    # Measured: 1.5 to 1.7, where rounding decides which plan is taken; rms 0.25.
    assert fast.largest("preview") < 3.0
    assert float(np.sqrt(np.mean(fast.error("preview") ** 2))) < 0.4
    rows = {row[0]: row for row in s4_rate_dependent.methods_table(fast).rows}
    assert float(rows["explicit"][1]) == pytest.approx(13.6, rel=5e-3)
    assert float(rows["trajectory"][4]) <= 1.0


def test_printed_and_computed_constants() -> None:
    rows = {row[0]: row[1:] for row in s4_rate_dependent.inverse_constants().rows}
    # The paper's numbers do not follow from its weights; eqs. 14-15 by hand give these.
    assert float(rows["b0"][1]) == pytest.approx(1 / 0.7124, abs=1e-5)
    assert float(rows["b1"][1]) == pytest.approx(1 / 1.003 - 1 / 0.7124, abs=1e-5)
    assert float(rows["s1"][1]) == pytest.approx(0.7124 * 9.715, abs=1e-3)
    assert float(rows["rate factor"][1]) == pytest.approx(0.7124 * 8.572e-4, rel=1e-5)
    assert rows["b0"][0] == "1.3892"


def test_round_trip_with_the_same_thresholds() -> None:
    for row in s4_rate_dependent.round_trip().rows:
        assert float(row[3]) <= 1e-12


def test_slow_periods_get_a_longer_sample_time() -> None:
    slow = s4_rate_dependent.solve("actuator", 0.1, methods=("explicit",))
    assert slow.model.dt == pytest.approx(0.01)
    assert slow.y_ref.size == 3000
    # At low rates the model is the rate-independent one (eq. 26) and the inverse nearly exact.
    assert slow.largest("explicit") < 1e-4 * 40.0
    # Fig. 6: without an inverse 5.9 to 10.6 um were measured.
    assert slow.uncompensated() == pytest.approx(5.5, abs=0.5)


def test_the_whole_study(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(s4_rate_dependent, "FREQUENCIES", (10.0, 60.0, 100.0))
    solve = s4_rate_dependent.solve

    def quick(name: str, f: float) -> s4_rate_dependent.Case:
        case = solve(name, f, ("rate-independent", "explicit", "sample-exact"))
        # Slower methods are tested above; here it matters that all is put together.
        for method in ("preview", "trajectory"):
            case.found[method] = case.found["explicit"]
        return case

    monkeypatch.setattr(s4_rate_dependent, "solve", quick)
    s4_rate_dependent._cases.cache_clear()
    try:
        shown = [cell for table in s4_rate_dependent.tables() for row in table.rows for cell in row]
        assert any("13.6" in cell for cell in shown)
        drawn = s4_rate_dependent.figures()
        assert {
            "s4-example-10-hz.png",
            "s4-example-60-hz.png",
            "s4-actuator-100-hz.png",
            "s4-error-over-frequency.png",
        } == set(drawn)
        assert all(png.startswith(b"\x89PNG") for png in drawn.values())
    finally:
        s4_rate_dependent._cases.cache_clear()
