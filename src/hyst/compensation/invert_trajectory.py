"""Choose a method of inversion by name."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from hyst.compensation.compensation import Compensation
from hyst.compensation.exact import invert_exactly
from hyst.errors import InputError
from hyst.operators import Operator

_METHODS = {"exact": invert_exactly}


def invert_trajectory(
    model: Operator,
    y_ref: ArrayLike,
    method: str = "exact",
    *,
    input_range: tuple[float, float] | None = None,
    outside: Literal["refuse", "clip"] = "refuse",
    history: ArrayLike | None = None,
) -> Compensation:
    """Find the input that makes a model follow a wanted output.

    ``exact``: ``u = model.inverse()(y_ref)``, with the memory of both starting in the same state.

    Parameters
    ----------
    model
        An operator with an exact inverse.
    y_ref
        Wanted output, shape (N,), finite, output units.
    method
        ``"exact"``, the only one so far.
    input_range
        Lowest and highest input allowed, input units; no limits if left out.
    outside
        What to do about a reference that would take the input out of its range: ``"refuse"``, or
        ``"clip"``: hold the input at the end of the range and let the memory of the inverse follow
        the output really reached, so that tracking is exact again as soon as the reference is back
        in reach.
    history
        Inputs the actuator has passed just before the first sample, shape (M,), input units; they
        set its memory. Left out, the model starts from its own initial state.

    Returns
    -------
    Compensation
        The command ``u``, ``y_predicted``, ``predicted_error`` and what follows from it.

    Raises
    ------
    InputError
        If a signal is empty or not finite (the first bad index is named), the method or
        ``outside`` is unknown, the range is not two finite ascending numbers, or, with
        ``"refuse"``, the reference is out of reach.
    NotInvertibleError
        If the model has no exact inverse.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    >>> done = invert_trajectory(model, [0.0, 4.0, 9.0, 5.5], input_range=(0, 5), outside="clip")
    >>> done.u
    array([0. , 3. , 5. , 3.5])
    >>> done.predicted_error
    array([ 0.,  0., -2.,  0.])
    """
    if method not in _METHODS:
        known = ", ".join(_METHODS)
        raise InputError(f"unknown method {method!r}; the methods there are: {known}")
    if outside not in ("refuse", "clip"):
        raise InputError(f"outside is {outside!r}; choose 'refuse' or 'clip'")
    return _METHODS[method](model, y_ref, input_range, outside == "clip", history)
