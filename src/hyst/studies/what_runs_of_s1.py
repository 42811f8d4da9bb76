"""S1 beyond the paper: what its observer does as it runs, and what other observers do."""

from __future__ import annotations

from typing import Any

from hyst.control import (
    DisturbanceObserver,
    TrackingController,
    compare_designs,
    design_disturbance_observer,
    sampled_certificate,
)
from hyst.report.table import Table

_SAMPLE_TIMES = (1e-4, 8e-4)


def beyond_the_paper(best: DisturbanceObserver) -> tuple[Table, Table]:
    """Give the norms of the sampled block, and those of other observers for the same loop.

    Parameters
    ----------
    best
        The best gain of the repaired example.

    Returns
    -------
    tuple of Table
    """
    p = best.problem
    loop = p.plant, p.controller, p.Wu, p.Wp
    return _sampled(best, loop), _others(best, loop)


def _sampled(best: DisturbanceObserver, loop: tuple[Any, ...]) -> Table:
    rows = []
    for dt in _SAMPLE_TIMES:
        for name in ("continuous, sampled", "discrete"):
            design = best if name != "discrete" else design_disturbance_observer(*loop, dt=dt)
            block = TrackingController.from_continuous(loop[1], dt, observer=design)
            c = sampled_certificate(block, loop[0], *loop[2:])
            norms = (c.baseband_norm, c.uncertainty_norm, c.performance_norm, c.stacked_norm)
            rows.append((f"{1e3 * dt:g}", name, *(f"{each:.4f}" for each in norms)))
    return Table(
        "The repaired example as it runs: eqs. 26, 27 and 36 of the sampled block",
        ("dt [ms]", "design", "Wu T", "with aliases", "Wp E", "stacked"),
        tuple(rows),
    )


def _others(best: DisturbanceObserver, loop: tuple[Any, ...]) -> Table:
    p = best.problem
    more = design_disturbance_observer(*loop, order=p.order + 1)
    designs = {"observer of the paper": best, "one stable eigenvalue more": more}
    return Table(
        "Observers for the repaired example; true rejection for every plant within Wu asks for a "
        "robust performance below 1",
        ("observer", "norm", "Wu T", "Wp (1 - Q)", "robust performance", "|Q / Pn|"),
        tuple(
            (
                row.name,
                f"{row.stacked_norm:.4f}",
                f"{row.uncertainty_norm:.4f}",
                f"{row.performance_norm:.4f}",
                f"{row.robust_performance:.4f}",
                f"{row.observer_noise_gain:.3f}",
            )
            for row in compare_designs(p.plant, p.controller, p.Wu, p.Wp, designs)
        ),
    )
