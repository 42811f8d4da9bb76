"""What an estimator gives for a whole record: its estimates over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Estimates over time.

    Parameters
    ----------
    time
        Shape (K,), seconds since the first sample of the record.
    names
        Of the m parameters.
    values
        Shape (K, m).
    standard_errors
        Shape (K, m), NaN where the method gives none, 0 for what is held.
    error
        Shape (N,), measured less predicted output before each update; 0 where there was none.

    Examples
    --------
    >>> one = np.array([[2.0]])
    >>> Trajectory(np.array([1.0]), ("r[1]",), one, 0.1 * one, np.zeros(3)).of("r[1]")
    array([2.])
    """

    time: Array
    names: tuple[str, ...]
    values: Array
    standard_errors: Array
    error: Array

    def of(self, name: str) -> Array:
        """Give one parameter over time.

        Parameters
        ----------
        name
            One of ``names``.

        Returns
        -------
        numpy.ndarray
            Shape (K,).

        Raises
        ------
        InputError
            If there is no parameter of that name.
        """
        if name not in self.names:
            raise InputError(f"no parameter is called {name!r}; there are {', '.join(self.names)}")
        return np.asarray(self.values[:, self.names.index(name)])
