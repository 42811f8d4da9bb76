"""The repetitions of a motion as a table: how far each missed the reference."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hyst.compensation import LearningCompensator
from hyst.report.table import Table, number, with_unit


def learning_table(
    learner: LearningCompensator, unit: str = "", sources: Sequence[str] = ()
) -> Table:
    """List the repetitions measured so far; the best is marked.

    Parameters
    ----------
    learner
        The compensator.
    unit
        Of the output.
    sources
        Where each repetition was measured, if it is to be told.

    Returns
    -------
    Table
    """
    extent = float(np.ptp(learner.y_ref))
    history = learner.history
    header = (
        "repetition",
        *(("measured in",) if sources else ()),
        with_unit("rms error", f"[{unit}]" if unit else ""),
        with_unit("largest", f"[{unit}]" if unit else ""),
        "rms [% of range]",
        "over the noise",
    )
    rows = []
    for k, each in enumerate(history):
        share = 100.0 * each.error_rms / extent if extent > 0.0 else math.nan
        rows.append(
            (
                str(k + 1),
                *((sources[k],) if sources else ()),
                number(each.error_rms),
                number(each.error_largest),
                number(share, 3),
                _times_the_noise(each.error_rms, each.noise),
            )
        )
    marked = best_index(learner) if history else None
    return Table("Repetitions", header, tuple(rows), marked)


def learning_notes(learner: LearningCompensator) -> tuple[str, ...]:
    """Say what was seen in the repetitions and done after them, a sentence or two each.

    Parameters
    ----------
    learner
        The compensator.

    Returns
    -------
    tuple of str
        Of those repetitions of which there is something to say.
    """
    numbered = enumerate(learner.history, 1)
    return tuple(f"repetition {k}: {each.note}" for k, each in numbered if each.note)


def best_index(learner: LearningCompensator) -> int:
    """Give the index of the best repetition, since the actuator last changed, in the history.

    Parameters
    ----------
    learner
        The compensator.

    Returns
    -------
    int
    """
    best = learner.best
    return 0 if best is None else best.number - 1


def noise_of(learner: LearningCompensator) -> float | None:
    """Give the noise as it is known after the last repetition; None if it is not.

    Parameters
    ----------
    learner
        The compensator.

    Returns
    -------
    float or None
        Standard deviation, output units.
    """
    return learner.noise if learner.noise else None


def _times_the_noise(rms: float, noise: float) -> str:
    """Write how many times the noise an error is; a dash if no noise is known."""
    return number(rms / noise, 3) if noise > 0.0 else "-"
