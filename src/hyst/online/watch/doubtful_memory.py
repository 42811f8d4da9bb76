"""What a gap in the input leaves unknown of the memory, and when that is wiped out again."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from hyst.operators import Operator

Array = NDArray[np.float64]

_STEPS = 32
_LONGEST_WAY = 500


class DoubtfulMemory:
    """Memories as far apart as the input may have brought them, until they are one again.

    Nobody knows where the input went in a gap. So the models follow it several times: as if it had
    gone to the lowest value it can have reached, as if to the highest, and where nothing at all is
    known, as if it had never moved. All then pass the inputs that were measured. A turn that is
    large enough wipes out every past; the memory is known again once all predict the same on a
    sweep through the whole range, upwards first and downwards first. That holds for any kind of
    memory: plays, relays, creep.

    Parameters
    ----------
    models
        Each with the state it had before the gap.
    before, after
        The inputs on either side of it; ``before`` is None where nothing was known.
    low, high
        Values between which the input stayed.
    samples
        Length of the gap.

    Raises
    ------
    InputError
        If a model overflows on the way.
    """

    def __init__(
        self,
        models: Iterable[tuple[Operator, Array]],
        before: float | None,
        after: float,
        low: float,
        high: float,
        samples: int,
    ) -> None:
        if before is None:
            turns = [[high, low], [low, high], [after, after]]
        else:
            turns = [[before, low], [before, high]]
        ways = _ways(turns, after, samples)
        self._models = [
            (model, [model.run(way, state)[1] for way in ways]) for model, state in models
        ]

    def cross_gap(self, before: float, after: float, low: float, high: float, samples: int) -> None:
        """Pass another gap, the lower memory to the lowest value and the upper to the highest.

        Parameters
        ----------
        before, after, low, high, samples
            As of the gap that began the doubt.
        """
        ways = _ways([[before, low], [before, high], [before, after]], after, samples)
        self._models = [
            (model, [model.run(way, state)[1] for way, state in zip(ways, states, strict=False)])
            for model, states in self._models
        ]

    def follow(self, u: Array) -> None:
        """Let all memories of every model pass inputs, shape (N,)."""
        if u.size:
            self._models = [
                (model, [model.run(u, state)[1] for state in states])
                for model, states in self._models
            ]

    def is_wiped_out(self, u: float, low: float, high: float, tolerance: float) -> bool:
        """Tell whether all memories predict the same.

        Parameters
        ----------
        u
            The present input.
        low, high
            The range to sweep.
        tolerance
            Largest difference that does not matter, output units; at least a thousandth of what the
            sweep gives is taken.
        """
        for first, last in ((low, high), (high, low)):
            way = np.concatenate([np.linspace(u, first, _STEPS), np.linspace(first, last, _STEPS)])
            for model, states in self._models:
                outputs = np.array([model.run(way, state)[0] for state in states])
                allowed = max(tolerance, 1e-3 * float(np.ptp(outputs[0])))
                if np.ptp(outputs, axis=0).max() > allowed:
                    return False
        return True


def _ways(turns: list[list[float]], after: float, samples: int) -> list[Array]:
    """Give ways over turning points to the input after a gap, in as many samples as it has."""
    steps = min(max(samples // 2, 2), _LONGEST_WAY)
    return [
        np.concatenate([np.linspace(first, last, steps), np.linspace(last, after, steps)])
        for first, last in turns
    ]
