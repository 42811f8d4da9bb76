"""Inverses as they are exported, and what their signals mean."""

from __future__ import annotations

from dataclasses import replace

from hyst.errors import InputError
from hyst.export.c.block import Model
from hyst.models import RateDependentPrandtlIshlinskii, Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.operators.registry import compose


def explicit_inverse(model: Operator) -> Operator:
    """Give the inverse with the explicit inverses of rate-dependent plays in it: causal, not exact.

    Its description is that of the model, input and output exchanged.

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
    inverse = compose(
        tuple(
            leaf.explicit_inverse()
            if isinstance(leaf, RateDependentPrandtlIshlinskii)
            else leaf.inverse()
            for leaf in reversed(leaves)
        )
    )
    return inverse.with_description(model.description.of_inverse())


def inverse_of(
    model: Model, explicit: bool = False, preview: int | None = None
) -> Operator | ScheduledInverse:
    """Give the inverse that is exported.

    Parameters
    ----------
    model
        An operator or a scheduled model.
    explicit
        Whether the explicit inverse is wanted.
    preview
        Samples of the reference that the inverse may know, and by which its command is late; None
        for the exact inverse.

    Returns
    -------
    Operator or ScheduledInverse

    Raises
    ------
    InputError
        If it is no operator, has no explicit inverse, or this one is wanted with a preview.
    NotInvertibleError
        If it has no inverse.
    """
    if isinstance(model, Scheduled) and preview is not None:
        raise InputError(
            "a scheduled model has no inverse with a preview; export that of one value of the "
            "schedule"
        )
    if isinstance(model, Scheduled) and not explicit:
        return model.inverse()
    if not isinstance(model, Operator):
        raise InputError(f"a {type(model).__name__} has no inverse; export it as it is")
    if preview is None:
        return explicit_inverse(model) if explicit else model.inverse()
    if explicit:
        raise InputError("the explicit inverse needs no preview; ask for one of the two")
    inverse = model.inverse(preview=preview)
    about = inverse.description
    name = f"{about.output_name}, {preview} samples late"
    return inverse.with_description(replace(about, output_name=name))
