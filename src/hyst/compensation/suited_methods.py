"""Which methods can turn a wanted output into a command of a model."""

from __future__ import annotations

from collections.abc import Callable

from hyst.compensation.invert import METHODS
from hyst.compensation.nearest_input import turns
from hyst.compensation.noncausal import split_at_dynamics
from hyst.compensation.rate_dependent.task import stages_around_plays
from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics, StableInverse
from hyst.operators import Operator


def methods_for(model: Operator) -> tuple[str, ...]:
    """Name the methods of ``invert_trajectory`` that a model has, in the order of ``METHODS``.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    tuple of str
        None, if there is no way to a command.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii, RateDependentPrandtlIshlinskii
    >>> methods_for(PrandtlIshlinskii([0.5], [1.0], p0=1.0))
    ('exact',)
    >>> methods_for(RateDependentPrandtlIshlinskii([0.5], [1.0], 0.1, dt=1e-3, p0=1.0))
    ('explicit', 'sample-exact', 'preview', 'trajectory')
    >>> methods_for(PrandtlIshlinskii([0.5], [1.0], p0=0.0))
    ()
    """
    return tuple(name for name in METHODS if _has(model, name))


def _has(model: Operator, method: str) -> bool:
    try:
        _NEEDS.get(method, _require_plays_with_inverse)(model)
    except (InputError, NotInvertibleError):
        return False
    return True


def _require_dynamics_with_inverse(model: Operator) -> None:
    for each in split_at_dynamics(model):
        if isinstance(each, LinearDynamics):
            StableInverse.of(each)
        else:
            _require_inverses(each)


def _require_plays_with_inverse(model: Operator) -> None:
    before, _, after = stages_around_plays(model)
    _require_inverses(before, after)


def _require_inverses(*stages: Operator | None) -> None:
    for each in stages:
        if each is not None:
            each.inverse()


def _require_a_trajectory(model: Operator) -> None:
    if not turns(model):
        _require_plays_with_inverse(model)


_NEEDS: dict[str, Callable[[Operator], None]] = {
    "exact": _require_inverses,
    "noncausal": _require_dynamics_with_inverse,
    "trajectory": _require_a_trajectory,
}
