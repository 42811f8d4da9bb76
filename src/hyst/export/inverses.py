"""Inverses as they are exported, and what their signals mean."""

from __future__ import annotations

from dataclasses import replace

from hyst.errors import InputError
from hyst.export.c.block import Model
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import ModelDescription, Operator
from hyst.operators.composition import leaves_of
from hyst.operators.registry import compose


def explicit_inverse(model: Operator) -> Operator:
    """Give the inverse with the explicit inverses of rate-dependent plays in it: causal, not exact.

    Parameters
    ----------
    model
        Rate-dependent plays, or a composition with them.

    Returns
    -------
    Operator

    Raises
    ------
    InputError
        If there are no rate-dependent plays in it.
    NotInvertibleError
        If another stage has no inverse, or a cumulative weight is not positive.

    Notes
    -----
    S4 eqs. 12-16.
    """
    leaves = leaves_of(model)
    if not any(isinstance(leaf, RateDependentPrandtlIshlinskii) for leaf in leaves):
        raise InputError(
            f"{model.kind} has no rate-dependent plays; export its exact inverse with --inverse"
        )
    return compose(
        tuple(
            leaf.explicit_inverse()
            if isinstance(leaf, RateDependentPrandtlIshlinskii)
            else leaf.inverse()
            for leaf in reversed(leaves)
        )
    )


def inverse_of(model: Model, explicit: bool = False) -> Operator:
    """Give the inverse that is exported.

    Parameters
    ----------
    model
        An operator.
    explicit
        Whether the explicit inverse is wanted.

    Returns
    -------
    Operator

    Raises
    ------
    InputError
        If it is no operator, or has no explicit inverse.
    NotInvertibleError
        If it has no inverse.
    """
    if not isinstance(model, Operator):
        raise InputError(f"a {type(model).__name__} has no inverse; export it as it is")
    return explicit_inverse(model) if explicit else model.inverse()


def reversed_description(about: ModelDescription) -> ModelDescription:
    """Give the description of an inverse: input and output change places.

    Parameters
    ----------
    about
        That of the model.

    Returns
    -------
    ModelDescription
    """
    return replace(
        about,
        input_name=about.output_name,
        input_unit=about.output_unit,
        input_low=about.output_low,
        input_high=about.output_high,
        output_name=about.input_name,
        output_unit=about.input_unit,
        output_low=about.input_low,
        output_high=about.input_high,
    )
