"""From the options of ``identify`` to a Hammerstein identification."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError
from hyst.identification.families.hammerstein.distortion_levels import average_periods
from hyst.identification.families.hammerstein.front import FRONTS, FrontOptions
from hyst.identification.families.hammerstein.identification import (
    HammersteinOptions,
    identify_hammerstein,
)
from hyst.identification.families.hammerstein.identified_hammerstein import IdentifiedHammerstein
from hyst.identification.options import whole_number
from hyst.signals import Record

HAMMERSTEIN = "hammerstein"
AUTOMATIC_PLAYS = 4
_MOST_PLAYS = 50
_OR_AUTO = ", or 'auto'"


def identify_with_dynamics(
    records: Record | Sequence[Record],
    *,
    hysteresis: str,
    orders: tuple[int | str, int | str],
    plays: int | str,
    radii: NDArray[np.float64] | None,
    knots: int | ArrayLike,
    weights: str,
    delay: int | str,
    start: int | Literal["auto"],
    period: int | None,
    validation: Record | Sequence[Record],
    limits: tuple[int, bool],
    say: Callable[[str], None],
) -> IdentifiedHammerstein:
    """Identify hysteresis and dynamics with the options of ``identify``, checked.

    Parameters
    ----------
    records, hysteresis, plays, radii, knots, weights, delay, start, validation
        As of ``identify``; ``knots`` may be the places of the knots of ``gpi``, too.
    orders
        ``fir_order`` and ``state_order``.
    period
        Samples of a period of the drive, to average the periods; or None.
    limits
        ``max_iterations`` and ``allow_unconverged``.
    say
        Told what is being done.

    Raises
    ------
    InputError, NotIdentifiableError, SolverError
        As ``identify_hammerstein``.
    """
    if period is not None:
        records, start = averaged(records, period, start)
    count = (
        AUTOMATIC_PLAYS
        if plays == "auto"
        else whole_number(plays, "plays", 1, _MOST_PLAYS, _OR_AUTO)
    )
    front = FrontOptions(
        family=hysteresis,
        plays=count if radii is None else int(radii.size),
        knots=_as_knots(knots),
        radii=radii,
        rule=weights,
    )
    options = HammersteinOptions(
        fir_order=orders[0],
        state_order=orders[1],
        delay=delay if delay == "auto" else whole_number(delay, "delay", 0, 10_000, _OR_AUTO),
        front=front,
        start=start,
        max_iterations=limits[0],
        allow_unconverged=limits[1],
    )
    judged = (validation,) if isinstance(validation, Record) else tuple(validation)
    return identify_hammerstein(records, options, judged, say)


def averaged(
    records: Record | Sequence[Record], period: int, start: int | Literal["auto"]
) -> tuple[tuple[Record, ...], int]:
    """Average the periods of records, and give the first sample to use then.

    Parameters
    ----------
    records
        Of periodic drives of one period.
    period
        Its samples.
    start
        As of ``identify``; only ``"auto"`` makes sense.

    Returns
    -------
    tuple of Record
        Two equal periods each.
    int
        Where the second begins: the first is its past, of hysteresis and dynamics.

    Raises
    ------
    InputError
        If a record is not periodic or has fewer than two periods, or a start is given.
    """
    if start != "auto":
        raise InputError(f"start is {start!r} and period {period!r}; leave out start, it is known")
    given = (records,) if isinstance(records, Record) else tuple(records)
    return tuple(average_periods(record, period) for record in given), int(period)


def require_usable(family: str, hysteresis: str, period: int | None) -> None:
    """Refuse options of this family that name nothing, or that another family does not take.

    Parameters
    ----------
    family, hysteresis, period
        As of ``identify``.

    Raises
    ------
    InputError
        If the hysteresis is not known, or there is a period for another family.
    """
    if period is not None and family != HAMMERSTEIN:
        raise InputError(
            f"period is {period}, but family {family!r} averages none; use hammerstein, or give "
            "average_periods(record, period) as the record"
        )
    if hysteresis not in FRONTS:
        raise InputError(f"hysteresis is {hysteresis!r}; choose one of {', '.join(FRONTS)}")


def _as_knots(knots: Any) -> int | NDArray[np.float64]:
    if isinstance(knots, int | np.integer):
        return whole_number(knots, "knots", 1, 50)
    places = np.asarray(knots, dtype=np.float64)
    if places.ndim != 1 or places.size == 0 or not np.isfinite(places).all():
        raise InputError("knots must be a number of knots or a list of finite places")
    return places
