"""The same loop with several inverses, with and without a disturbance observer."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

from numpy.typing import ArrayLike

from hyst.control.closed_loop import ClosedLoop
from hyst.control.closed_loop_simulation import simulate_closed_loop
from hyst.errors import InputError
from hyst.operators import Operator

EXACT = "exact"


@final
@dataclass(frozen=True, eq=False)
class InverseComparison:
    """Loops by inverse, with and without the observer.

    Parameters
    ----------
    without
        Loops without the observer, by name of the inverse.
    observed
        Loops with it, by the same names.
    """

    without: Mapping[str, ClosedLoop]
    observed: Mapping[str, ClosedLoop]

    def added_error(self, name: str) -> float:
        """Give the rms error that an inverse adds to that of the exact one, without observer.

        Parameters
        ----------
        name
            Of the inverse.

        Returns
        -------
        float
            In units of the output; infinite if the loop diverges, NaN if there is no exact one.
        """
        return self.without[name].rms_error - self._exact()

    def recovered(self, name: str) -> float:
        """Give the share of that added error which the observer takes off again.

        Parameters
        ----------
        name
            Of the inverse.

        Returns
        -------
        float
            1 is all of it; NaN where an inverse adds nothing, or a loop diverges.
        """
        added = self.added_error(name)
        left = self.observed[name].rms_error - self._exact()
        if not (math.isfinite(added) and math.isfinite(left)) or added <= 1e-9 * self._exact():
            return math.nan
        return 1.0 - left / added

    def _exact(self) -> float:
        return self.without[EXACT].rms_error if EXACT in self.without else math.nan


def compare_inverses(
    reference: ArrayLike,
    dt: float,
    inverses: Mapping[str, Operator | None],
    *,
    observer: Any,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> InverseComparison:
    """Simulate one loop with each of several inverses, with and without the observer.

    Parameters
    ----------
    reference
        Wanted output, shape (N,).
    dt
        Sample time, s, > 0.
    inverses
        By name, None for no inverse; the one named ``exact`` is what the others are compared with.
    observer
        As in ``simulate_closed_loop``.
    progress
        Called with the share that is done.
    options
        What else ``simulate_closed_loop`` takes: plant, controller, hysteresis and so on.

    Returns
    -------
    InverseComparison

    Raises
    ------
    InputError
        If there is no inverse, or as ``simulate_closed_loop``.

    Examples
    --------
    >>> from hyst import Affine
    >>> blocks = {"plant": ([50.0], [1.0, 50.0]), "controller": ([5.0], [1.0, 0.0])}
    >>> found = compare_inverses(
    ...     [1.0] * 2000, 1e-3, {"exact": None, "half": Affine(0.5)}, observer=None, **blocks
    ... )
    >>> found.added_error("half") > 0.0, round(found.recovered("half"), 9) == 0.0
    (True, True)
    """
    if not inverses:
        raise InputError("there is no inverse to compare; give at least one by name")
    without: dict[str, ClosedLoop] = {}
    observed: dict[str, ClosedLoop] = {}
    for k, (name, inverse) in enumerate(inverses.items()):
        without[name] = simulate_closed_loop(reference, dt, inverse=inverse, **options)
        observed[name] = simulate_closed_loop(
            reference, dt, inverse=inverse, observer=observer, **options
        )
        if progress is not None:
            progress((k + 1) / len(inverses))
    return InverseComparison(without, observed)
