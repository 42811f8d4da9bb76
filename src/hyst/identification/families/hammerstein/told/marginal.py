"""Dynamics that settle more slowly than the records are long: integrating, unstable, or a drift."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hyst.models import LinearDynamics
from hyst.operators import Verdict
from hyst.signals import Record

_SEEN_TO_SETTLE = 1.0  # time constants of a pole within the longest record, at least


def without_marginal(
    verdict: Verdict, dynamics: LinearDynamics, records: Sequence[Record]
) -> Verdict:
    """Call a model unfit that holds a pole which the records do not see settle.

    Parameters
    ----------
    verdict
        On the fit.
    dynamics
        As identified.
    records
        That they were identified from.
    """
    poles = dynamics.poles()
    slowest = float(np.abs(poles).max(initial=0.0))
    longest = max(record.duration for record in records)
    if slowest <= 0.0:
        return verdict
    time_constant = -dynamics.dt / np.log(min(slowest, 1.0 - 1e-15))
    if longest >= _SEEN_TO_SETTLE * time_constant:
        return verdict
    pole = poles[int(np.abs(poles).argmax())]
    told = (
        f"A pole of G at {pole:.6g} settles in {time_constant:.3g} s, and no record is longer than "
        f"{longest:.3g} s: dynamics that integrate or are unstable, or a drift, look like this and "
        "are not identified; take out the drift, close a loop around the actuator, or record for "
        "longer."
    )
    return Verdict("unfit", (told, *verdict.sentences))
