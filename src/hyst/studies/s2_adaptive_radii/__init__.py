"""S2: Al Janaideh, Xu and Tan, adaptive estimation of play radii.

The paper's law and what goes beyond it on the paper's five plays: how fast without noise, how far
from the Cramer-Rao bound with noise, and where the law as printed fails. The printed constants of
its experiment, checked, and the experiment's story, fixed against estimated radii, on a simulated
actuator that is made of no plays, or on a record of one's own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.online import Trajectory
from hyst.report.bound_figure import draw_over_bound
from hyst.report.estimation_figure import draw_estimates
from hyst.report.table import Table
from hyst.signals import Record
from hyst.studies.s2_adaptive_radii.against_fixed import on_record, simulated
from hyst.studies.s2_adaptive_radii.errata import errata
from hyst.studies.s2_adaptive_radii.measured_piezo import constants, refits
from hyst.studies.s2_adaptive_radii.over_bound import (
    FILTER,
    TIMES,
    errors_over_bound,
    joint,
    noisy,
    paper_law,
    ratios,
)
from hyst.studies.s2_adaptive_radii.paper import DT, INPUTS, PLAYS, P, R, sine
from hyst.studies.s2_adaptive_radii.printed_law import remark_3, trajectories
from hyst.studies.s2_adaptive_radii.without_noise import widths, without_noise

__all__ = ["TITLE", "figures", "on_record", "tables"]

TITLE = "Al Janaideh, Xu and Tan: adaptive estimation of play radii"


def tables() -> tuple[Table, ...]:
    """Compute the tables.

    Returns
    -------
    tuple of Table
    """
    bounds = tuple(errors_over_bound(name) for name in INPUTS)
    first = (without_noise(), *bounds, remark_3(), widths(), constants(), refits())
    return (*first, simulated(), errata())


def figures() -> dict[str, bytes]:
    """Draw radii and weights over time, and the radii's errors over the bound.

    Returns
    -------
    dict
        PNG by file name.
    """
    truth = {f"p[{i}]": float(P[i - 1]) for i in range(1, 6)}
    truth |= {f"r[{i}]": float(R[i - 1]) for i in range(1, 6)}
    clean = Record(sine(200.0), PLAYS(sine(200.0)), DT)
    drawn = {
        "s2_without_noise.png": draw_estimates(
            {"the paper's law": paper_law().run(clean, 100)},
            truth,
            "Five plays, sine, without noise",
        ),
        "s2_remark_3.png": draw_estimates(
            trajectories(), truth, "Five plays, 30 sin x + 6 sin 9x, without noise"
        ),
    }
    for name in INPUTS:
        for decibels in (10, 20):
            u, y, sigma = noisy(name, float(decibels))
            record = Record(u, y + sigma * np.random.default_rng(0).standard_normal(u.size), DT)
            both = {
                "the paper's law": paper_law(FILTER).run(record, 100),
                "joint": joint().run(record, 100),
            }
            heading = f"Five plays, {name}, {decibels} dB"
            drawn[f"s2_{name}_{decibels}_db.png"] = draw_estimates(both, truth, heading)
            if (name, decibels) == ("sine", 20):
                radii = {label: _radii_of(each) for label, each in both.items()}
                drawn["s2_trajectories.png"] = draw_estimates(radii, truth, heading)
    drawn["s2_over_bound.png"] = draw_over_bound(TIMES, {n: ratios(n) for n in INPUTS})
    return drawn


def _radii_of(trajectory: Trajectory) -> Trajectory:
    """Keep the radii alone, once a second: a figure small enough for a page."""
    places = np.flatnonzero([name.startswith("r[") for name in trajectory.names])
    once = np.ix_(np.arange(9, trajectory.time.size, 10), places)
    return replace(
        trajectory,
        time=trajectory.time[9::10],
        names=tuple(trajectory.names[k] for k in places),
        values=trajectory.values[once],
        standard_errors=trajectory.standard_errors[once],
    )


def __dir__() -> list[str]:
    return __all__
