"""Records that no one model describes: another gain or another width of the loop."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.drive_cycles import frequency_of
from hyst.identification.judgement.general_loops import play_outputs
from hyst.identification.judgement.remainder import Part, Remainder

Array = NDArray[np.float64]

MOST_RECORDS = 20
OFTEN = 3.0
"""A record whose own part is so many times the median's is named."""

ANOTHER_RATE = 1.4


def _columns(remainder: Remainder) -> Array:
    count = len(remainder.parts)
    if not 1 < count <= MOST_RECORDS:
        return np.empty((remainder.rows.size, 0))

    def of_part(part: Part) -> Array:
        columns = np.zeros((part.rows.size, 2 * count))
        at = 2 * remainder.parts.index(part)
        r = np.array([0.2 * remainder.input_range])
        width = part.u - play_outputs(part.whole, r, part.places)[:, 0]
        columns[:, at] = (part.u - part.u.mean())[part.rows]
        columns[:, at + 1] = (width - width.mean())[part.rows]
        return columns

    return remainder.columns(of_part)


def _sentence(found: Contribution) -> str:
    parts = found.remainder.parts
    sizes = np.array([float(np.std(each.error)) for each in parts])
    worst = int(sizes.argmax())
    alone = sizes[worst] > OFTEN * float(np.median(sizes))
    speeds = np.array([frequency_of(each) for each in parts])
    if alone:
        which = f"record {parts[worst].number} is of another actuator, or of one in another state"
    elif speeds.max() > ANOTHER_RATE * speeds.min():
        which = (
            f"the actuator depends on the rate, for they were run at {speeds.min():.3g} to "
            f"{speeds.max():.3g} Hz, or they are of several actuators"
        )
    else:
        which = "their gains or the widths of their loops differ"
    return (
        f"The records do not agree with one model, which makes {found.size} rms of what is left: "
        f"{which}."
    )


RECORDS_DIFFER = Cause(
    "records differ",
    _columns,
    _sentence,
    "Identify each record alone and compare the errors; leave out those of another actuator.",
)
