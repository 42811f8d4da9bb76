"""The scale and offset by which a model differs from another."""

from __future__ import annotations

from hyst.errors import InputError
from hyst.operators import Affine, Operator
from hyst.operators.composition import Chained
from hyst.operators.registry import compose


def affine_of(model: Operator, base: Operator) -> tuple[float, float]:
    """Give scale and offset of ``model = Affine(scale, offset) @ base``.

    Parameters
    ----------
    model, base
        Any operators.

    Returns
    -------
    scale, offset : float

    Raises
    ------
    InputError
        If it is another model, or its scale is 0.

    Examples
    --------
    >>> from hyst.operators import Play
    >>> affine_of(Affine(2.0, 1.0) @ Play(0.5), Play(0.5))
    (2.0, 1.0)
    """
    if model == base:
        return 1.0, 0.0
    parts = model.parts if isinstance(model, Chained) else ()
    if len(parts) > 1 and isinstance(parts[-1], Affine):
        inside = parts[0] if len(parts) == 2 else compose(parts[:-1])
        if inside == base or (isinstance(base, Chained) and inside == compose(base.parts)):
            if parts[-1].gain == 0.0:
                raise InputError("the scale to go on from is 0; give one that can be inverted")
            return parts[-1].gain, parts[-1].offset
    raise InputError(
        "the model is not the one at the start; give that with another scale and offset alone"
    )
