"""The exact inverse along a whole trajectory, within the range of the input.

Invariant: before every sample the memory of the inverse is the one that belongs to the memory of
the model. Where the input saturates this is kept by giving the inverse the output that the model
really reaches instead of the one that was wanted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.result import Compensation
from hyst.errors import InputError
from hyst.operators import Operator

Array = NDArray[np.float64]

# The inverse is exact to rounding only: a reference that just touches the end of the range may
# come back this fraction of the range outside of it, and is held at the end without more ado.
_ROUNDING = 1e-12


def invert_exactly(
    model: Operator,
    y_ref: ArrayLike,
    input_range: tuple[float, float] | None,
    clip: bool,
    history: ArrayLike | None,
) -> Compensation:
    """Invert a trajectory sample by sample, exactly.

    Parameters
    ----------
    model, y_ref, input_range, history
        As in ``invert_trajectory``.
    clip
        Whether to clip a reference out of reach instead of refusing it.

    Returns
    -------
    Compensation

    Raises
    ------
    InputError
        As in ``invert_trajectory``.
    NotInvertibleError
        If the model has no exact inverse.

    Examples
    --------
    >>> from hyst.operators import Affine
    >>> invert_exactly(Affine(2.0), [1.0, 3.0], None, False, None).u
    array([0.5, 1.5])
    """
    reference = finite_vector(y_ref, "y_ref")
    inverse = model.inverse()
    state, inverse_state = _memory_after(model, inverse, history)
    u, _ = inverse.run(reference, inverse_state)
    clipped = 0
    if input_range is not None:
        low, high = range_of_input(input_range)
        slack = _ROUNDING * (high - low)
        outside = (u < low - slack) | (u > high + slack)
        if outside.any() and not clip:
            raise InputError(_out_of_reach(model, state, reference, u, outside, (low, high)))
        if outside.any():
            u, clipped = _saturated(model, inverse, state, inverse_state, reference, (low, high))
        u = np.clip(u, low, high)
    y_predicted, _ = model.run(u, state)
    return Compensation(u, reference, y_predicted, "exact", clipped)


def _memory_after(
    model: Operator, inverse: Operator, history: ArrayLike | None
) -> tuple[Array, Array]:
    """Memory of the model after its history, and the memory of the inverse that belongs to it."""
    if history is None:
        return model.initial_state(), inverse.initial_state()
    y, state = model.run(finite_vector(history, "history"))
    return state, inverse.run(y)[1]


def range_of_input(input_range: tuple[float, float]) -> tuple[float, float]:
    """Check the range of the input.

    Parameters
    ----------
    input_range
        Lowest and highest input.

    Returns
    -------
    tuple of float

    Raises
    ------
    InputError
        If it is not two finite ascending numbers.
    """
    ends = finite_vector(input_range, "input_range")
    if ends.size != 2 or not ends[0] < ends[1]:
        raise InputError(
            f"input_range is {tuple(ends.tolist())}; give the lowest and the highest input allowed"
        )
    return float(ends[0]), float(ends[1])


def _saturated(
    model: Operator,
    inverse: Operator,
    state: Array,
    inverse_state: Array,
    y_ref: Array,
    input_range: tuple[float, float],
) -> tuple[Array, int]:
    """Command held within the range, and the number of samples it had to be held at."""
    low, high = input_range
    slack = _ROUNDING * (high - low)
    forward, backward = model.stepper(state), inverse.stepper(inverse_state)
    u = np.empty(y_ref.size)
    clipped = 0
    for k, wanted in enumerate(y_ref.tolist()):
        before = backward.state.copy()
        command = backward(wanted)
        held = min(max(command, low), high)
        y = forward(held)
        if held != command:
            clipped += abs(held - command) > slack
            backward.state[:] = before
            backward(y)
        u[k] = held
    return u, clipped


def _out_of_reach(
    model: Operator,
    state: Array,
    y_ref: Array,
    u: Array,
    outside: NDArray[np.bool_],
    input_range: tuple[float, float],
) -> str:
    low, high = input_range
    k = int(np.argmax(outside))
    # The extreme outputs of a bank of plays lie at the ends of the input range, reached either
    # directly or by way of the other end.
    ends = [model.run(path, state)[0][-1] for path in ([low], [high], [low, high], [high, low])]
    return (
        f"y_ref[{k}] = {y_ref[k]:.6g} needs the input {u[k]:.6g}, outside its range {low:.6g} to "
        f"{high:.6g} (the whole command would go from {u.min():.6g} to {u.max():.6g}); the outputs "
        f"in reach are {min(ends):.6g} to {max(ends):.6g}, so keep the reference within them or "
        "choose to clip it"
    )
