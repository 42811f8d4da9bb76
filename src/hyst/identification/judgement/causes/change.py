"""The actuator becomes another one half way: its gain or its loop changes at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import cycles_of
from hyst.identification.judgement.general_loops import play_outputs
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

PLACES_TRIED = 15
FEWEST_CYCLES = 3.0


def _columns(remainder: Remainder) -> Array:
    """Give gain, width and zero after the change, at the place where they explain most."""
    if len(remainder.parts) != 1 or cycles_of(remainder.parts[0]) < FEWEST_CYCLES:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        u, r = part.u[part.rows], np.array([0.2 * remainder.input_range])
        z = play_outputs(part.whole, r, part.places[part.rows])
        return np.column_stack([np.ones(u.size), u, u - z[:, 0]])

    columns = remainder.columns(of_part)
    after = remainder.rows >= _place(columns, remainder)
    return columns * after[:, None]


def _place(columns: Array, remainder: Remainder) -> int:
    """Give the first sample after the change."""
    error = remainder.error[remainder.rows]
    n = error.size
    places = np.linspace(0.1 * n, 0.9 * n, PLACES_TRIED).astype(np.intp)
    left = [_left(columns[:at], error[:at]) + _left(columns[at:], error[at:]) for at in places]
    return int(remainder.rows[places[int(np.argmin(left))]])


def _left(columns: Array, error: Array) -> float:
    products = columns.T @ columns
    moment = columns.T @ error
    solved = np.linalg.lstsq(products, moment, rcond=1e-10)[0]
    return float(error @ error - moment @ solved)


def _sentence(found: Contribution) -> str:
    return (
        "The actuator changes on the way: gain, zero or width of the loop are others in one part "
        f"of the record, which makes {found.size} rms of what is left."
    )


CHANGE = Cause(
    "change",
    _columns,
    _sentence,
    "Look for what was changed during the record (sensor, gain, load, another actuator) and "
    "identify from one part alone.",
    beyond_loops=True,
)
