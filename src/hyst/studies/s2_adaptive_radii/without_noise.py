"""The example of sec. IV without noise, and what its loop width tells about the largest radius."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.models import PrandtlIshlinskii
from hyst.online import JointEstimator, RadiusEstimator
from hyst.report.table import Table, number
from hyst.signals import Record
from hyst.studies.s2_adaptive_radii.over_bound import joint, paper_law
from hyst.studies.s2_adaptive_radii.paper import DT, PLAYS, P, R, sine

Array = NDArray[np.float64]

# Radii 50 % and weights 30 % off in both directions: without search the estimator is stuck.
MIXED_START = PrandtlIshlinskii([0.39, 0.21, 0.35, 0.56, 0.26], [0.2, 1.0, 1.5, 2.25, 5.4])


def without_noise() -> Table:
    """Compute how fast estimates come to the true radii without noise."""
    u = sine(200.0)
    record = Record(u, PLAYS(u), DT)
    radii = paper_law().run(record, 20_000).values
    rows = [_row(f"the paper's law, {t} s", radii[t // 20 - 1]) for t in (20, 60, 200)]
    least_squares = RadiusEstimator(P, 1.5 * R, 100.0, DT, method="least-squares")
    least_squares.run(record.slice(0, 3000))
    rows.append(_row("least squares, 3 s", least_squares.radii))
    right = joint()
    right.run(record.slice(0, 3000))
    rows.append(_row("joint, 3 s", right.parameters[6:11]))
    for label, search in (("", True), (", without search", False)):
        mixed = JointEstimator(MIXED_START, dt=DT, search=search)
        mixed.run(record.slice(0, 3000))
        radii = mixed.parameters[6:11]
        rows.append(_row(f"joint, off in both directions{label}, 3 s", radii))
    header = ("", "r1", "r2", "r3", "r4", "r5", "worst [%]")
    return Table("Sine without noise (true radii 0.4, 1, 1.5, 2, 3.6)", header, tuple(rows))


def _row(label: str, radii: Array) -> tuple[str, ...]:
    worst = 100.0 * float(np.abs(radii / R - 1.0).max())
    return (label, *(f"{r:.4f}" for r in radii), number(worst, 2))


def widths() -> Table:
    """Compute the bounds of the largest radius from the width of the loop, eqs. 24 to 26."""
    width = 2.0 * float(P @ R) / float(P.sum())
    rows = (
        ("2 r_1", number(2.0 * R[0])),
        ("loop width", number(width)),
        ("2 r_n", number(2.0 * R[-1])),
        ("sum(p) / p_n width", number(float(P.sum() / P[-1]) * width)),
    )
    return Table("Lemma 2: each is at least the one above it", ("", "value"), rows)
