"""Step 2: from Markov parameters to a state space (eigensystem realization, Ho and Kalman)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.errors import InputError
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

LARGEST_AUTOMATIC_ORDER = 12


@dataclass(frozen=True, eq=False)
class Realization:
    """A state space and the singular values it was cut from.

    Parameters
    ----------
    dynamics
        Stable, its DC gain not yet normalised.
    singular_values
        Of the Hankel matrix, in descending order.
    noise_level
        Singular values below this are not told from errors of the Markov parameters.
    stabilized
        Whether poles had to be moved into the unit circle.
    """

    dynamics: LinearDynamics
    singular_values: Array
    noise_level: float
    stabilized: bool


def realize(
    markov: ArrayLike,
    dt: float,
    order: int | str = "auto",
    standard_error: float = 0.0,
    feedthrough: bool = True,
) -> Realization:
    """Realize ``H_0, H_1, ..`` as a balanced state space.

    The Hankel matrix of H_1, H_2, .. is ``U S V'``; then ``A = S^-1/2 U' H' V S^-1/2`` with H' the
    Hankel matrix one sample later, ``B = S^1/2 V' e_1``, ``C = e_1' U S^1/2``, ``D = H_0``.

    Parameters
    ----------
    markov
        Shape (mu + 1,), H_0 first.
    dt
        Sample time, s.
    order
        Number of states, or ``"auto"``: the singular values above the noise level.
    standard_error
        Of a Markov parameter; it sets the noise level.
    feedthrough
        False takes D as 0.

    Returns
    -------
    Realization

    Raises
    ------
    InputError
        If there are too few parameters for the order, one is not finite, or all after the first
        are 0.

    Notes
    -----
    Juang and Pappa, J. Guidance 8 (1985), 620-627; S0 refs. 25 and 26. An unstable result is
    replaced by the one of Maciejowski, Systems & Control Letters 24 (1995), 211-220, which is
    always stable.

    Examples
    --------
    >>> G = LinearDynamics.from_transfer_function([1.0, 0.4], [1.0, -1.2, 0.5], 0.1)
    >>> found = realize(G.impulse_response(40), 0.1).dynamics
    >>> found.order, bool(abs(found.dc_gain() - G.dc_gain()) < 1e-9)
    (2, True)
    """
    response = finite_vector(markov, "markov")
    half = (response.size - 1) // 2
    if half < 1:
        raise InputError(f"{response.size} Markov parameters are too few; raise fir_order")
    if not response[1:].any():
        raise InputError("the Markov parameters after the first are all 0; there is no state")
    rows = np.arange(half)
    hankel = response[1 + rows[:, None] + rows]
    later = response[np.minimum(2 + rows[:, None] + rows, response.size - 1)]
    left, values, right = np.linalg.svd(hankel)
    # The largest singular value of a half x half Hankel matrix of white errors.
    noise = standard_error * np.sqrt(2.0 * half * np.log(2.0 * half + 1.0))
    n = _order(order, values, noise, half)
    root = np.sqrt(values[:n])
    observability, controllability = left[:, :n] * root, root[:, None] * right[:n]
    A = (left[:, :n] / root).T @ later @ (right[:n] / root[:, None]).T
    stabilized = bool(np.abs(np.linalg.eigvals(A)).max(initial=0.0) >= 1.0)
    if stabilized:
        shifted = np.concatenate([observability[1:], np.zeros((1, n))])
        A = np.linalg.pinv(observability) @ shifted
    D = float(response[0]) if feedthrough else 0.0
    dynamics = LinearDynamics(A, controllability[:, 0], observability[0], D, dt)
    return Realization(dynamics, values, float(noise), stabilized)


def _order(order: int | str, values: Array, noise: float, half: int) -> int:
    if order == "auto":
        floor = max(noise, 1e-9 * values[0])
        return int(np.clip((values > floor).sum(), 1, min(half, LARGEST_AUTOMATIC_ORDER)))
    number = as_state_order(order)
    if number > half:
        raise InputError(
            f"state_order is {order}, but {2 * half} Markov parameters realize at most {half} "
            "states; raise fir_order"
        )
    return number


def as_state_order(order: int | str) -> int:
    """Give a number of states that was asked for.

    Parameters
    ----------
    order
        As of ``realize``, but not ``"auto"``.

    Raises
    ------
    InputError
        If it is no whole number from 1 on.
    """
    if isinstance(order, bool) or not isinstance(order, int | np.integer) or order < 1:
        raise InputError(f"state_order is {order!r}; give a number of states or 'auto'")
    return int(order)
