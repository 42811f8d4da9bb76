"""The paper's law and the joint estimator over the Cramer-Rao bound, sine and staircase."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hyst.studies import s2_adaptive_radii as s2


@pytest.mark.parametrize("name", ["sine", "staircase"])
def test_errors_are_told_over_the_bound_for_both_inputs(name: str) -> None:
    rows = {row[0]: [float(each) for each in row[1:]] for row in s2._over_bound(name).rows}
    for decibels in ("10 dB", "20 dB"):
        # What is asked of the joint estimator after 100 s; the law is reported, whatever it gives.
        assert rows[f"joint, {decibels}"][-1] < 1.5
        # Its error does not fall as the bound does, so it gets farther from it.
        law = rows[f"paper, {decibels}"]
        assert law == sorted(law)
        assert law[-1] > 3.0
    # Ten decibels are a factor of sqrt(10) in the noise, and so in the bound; 3 digits are told.
    bounds = np.array([rows[f"largest bound, {each} dB"] for each in (10, 20)])
    assert bounds[0] / bounds[1] == pytest.approx(np.full(4, np.sqrt(10.0)), rel=0.01)
    # As many samples of each kind in each period: the bound falls with the root of time, from 20 s
    # on, where the first stroke, which differs, is 1 of 20 strokes or less.
    assert bounds[0, 1] / bounds[0, 3] == pytest.approx(np.sqrt(5.0), rel=0.05)


def test_figures_for_the_page_are_drawn_and_small() -> None:
    drawn = s2.figures()
    for name in ("s2_trajectories.png", "s2_over_bound.png"):
        assert drawn[name].startswith(b"\x89PNG")
        assert len(drawn[name]) < 120_000
        # The page shows what the command draws.
        page = Path(__file__).resolve().parents[2] / "docs"
        assert (page / "figures" / name.replace("_", "-")).exists()
        assert name.replace("_", "-") in (page / "online.md").read_text(encoding="utf-8")
