"""Which cells of a grid a record crosses, and how much of a density the prior made."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.families.preisach.cells import Cells

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

CROSSED = 0.01
"""Share of a cell's relays that turn while the record runs; of less, nothing is seen."""

FEWEST_CROSSED = 0.5
"""Of the area of the grid: a record that crosses less is refused."""

MASSLESS = 1e-6
"""Of the largest weight: no mass."""

ADVICE = (
    "drive the actuator over the whole range and back, and then along first-order reversal curves "
    "(hyst.signals.forc, or hyst excite --kind forc)"
)


def crossed(columns: Array, lengths: Sequence[int]) -> Rows:
    """Tell which cells have relays that turn within a record.

    Parameters
    ----------
    columns
        Shape (N, cells): what the output gains by the weight of each cell, -1 to 1.
    lengths
        Samples of each record, in order.
    """
    parts = np.split(columns, np.cumsum(lengths)[:-1])
    moved = [np.ptp(each, axis=0) for each in parts if len(each)]
    return np.asarray(np.max(moved, axis=0) > 2.0 * CROSSED)


def require_crossed(cells: Cells, turned: Rows) -> None:
    """Refuse records that cross less than half of the grid.

    Parameters
    ----------
    cells
        The grid.
    turned
        Shape (cells,), of ``crossed``.

    Raises
    ------
    NotIdentifiableError
        If they do.
    """
    share = float(cells.areas()[turned].sum() / cells.areas().sum())
    if share < FEWEST_CROSSED:
        raise NotIdentifiableError(
            f"the records cross {int(turned.sum())} of {cells.count} cells of the grid, "
            f"{100.0 * share:.0f} % of its area; the rest would be the prior's guess alone, so "
            f"{ADVICE}"
        )


def about_coverage(
    weights: Array, turned: Rows, effective: int, *, one_size: bool
) -> tuple[str, ...]:
    """Say what the record leaves to the prior.

    Parameters
    ----------
    weights
        Shape (cells,).
    turned
        Shape (cells,), of ``crossed``.
    effective
        How many combinations of the weights the records determine.
    one_size
        Whether the records show no minor loops.
    """
    said, total = [], float(weights.sum())
    if not turned.all():
        share = float(weights[~turned].sum()) / total if total > 0.0 else 0.0
        said.append(
            f"{int((~turned).sum())} of {turned.size} cells of the grid were never crossed; the "
            f"prior of smoothness filled them, with {100.0 * share:.1f} % of the mass"
        )
    if one_size:
        loaded = int((weights > MASSLESS * weights.max(initial=0.0)).sum())
        said.append(
            f"the records show no minor loops: they determine about {effective} combinations of "
            f"the weights of {loaded} cells, and the prior of smoothness decides the rest, so "
            f"minor loops are an extrapolation; {ADVICE}"
        )
    return tuple(said)
