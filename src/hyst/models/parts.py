"""Checks of the two parts of a mapped Prandtl-Ishlinskii model."""

from __future__ import annotations

from hyst.errors import InputError
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.rate_dependent import RateDependentPrandtlIshlinskii
from hyst.operators.base import Operator


def as_map(operator: Operator, name: str) -> Operator:
    """Check that an operator can stand before or after the plays as a map.

    Parameters
    ----------
    operator
        Any operator.
    name
        What messages call it.

    Returns
    -------
    Operator
        ``operator`` itself.

    Raises
    ------
    InputError
        If it is no operator or has memory.
    """
    if not isinstance(operator, Operator) or not operator.traits().memoryless:
        what = operator.kind if isinstance(operator, Operator) else type(operator).__name__
        raise InputError(f"{name} is a {what}; give an operator without memory, as DeadZone")
    return operator


def as_plays(operator: Operator) -> PrandtlIshlinskii | RateDependentPrandtlIshlinskii:
    """Check that an operator is a Prandtl-Ishlinskii model, rate-dependent or not.

    Parameters
    ----------
    operator
        Any operator.

    Returns
    -------
    PrandtlIshlinskii or RateDependentPrandtlIshlinskii
        ``operator`` itself.

    Raises
    ------
    InputError
        If it is something else.
    """
    if not isinstance(operator, PrandtlIshlinskii | RateDependentPrandtlIshlinskii):
        what = operator.kind if isinstance(operator, Operator) else type(operator).__name__
        raise InputError(f"pi is a {what}; give a PrandtlIshlinskii")
    return operator
