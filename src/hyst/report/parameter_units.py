"""Units of a model's constants, from how they scale with the units of its signals."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.composition import leaves_of

_OF_TIME = {
    "time_constant": "s",
    "time_constants": "s",
    "frequency": "Hz",
    "samples": "samples",
}
"""Constants that are times by their name."""


def units_of_parameters(model: Operator, input_unit: str, output_unit: str) -> tuple[str, ...]:
    """Give the unit of every constant of a model.

    A constant that is multiplied by ``a**m b**n`` where the numbers of the input are multiplied by
    ``a`` and those of the output by ``b`` has the unit ``[u]**m [y]**n``; ``parameter_scales``
    tells which power that is.

    Parameters
    ----------
    model
        Any operator.
    input_unit, output_unit
        Units of its signals; empty where not known.

    Returns
    -------
    tuple of str
        In the order of ``model.parameters()``. Empty for pure numbers, where the unit of a signal
        is not known, and for constants of parts that depend on time, unless their name says what
        they are.

    Examples
    --------
    >>> import hyst
    >>> model = hyst.PrandtlIshlinskii([0.3, 0.2], [0.5, 1.0], p0=0.5)
    >>> hyst.report.units_of_parameters(model, "V", "um")
    ('um/V', 'um/V', 'um/V', 'V', 'V')
    """
    names = model.parameters().names
    in_time = np.concatenate(
        [np.full(len(leaf.parameters()), leaf.dt is not None) for leaf in leaves_of(model)]
        or [np.empty(0, dtype=bool)]
    )
    powers = _powers(model)
    found = []
    for k, name in enumerate(names):
        base = re.sub(r"\[[^]]*\]$", "", name.rpartition(".")[2])
        if base in _OF_TIME:
            found.append(_OF_TIME[base])
        elif powers is None or in_time[k]:
            found.append("")
        else:
            found.append(_product({input_unit: powers[0][k]}, {output_unit: powers[1][k]}))
    return tuple(found)


def _powers(model: Operator) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Give the powers with which constants scale; None for a model that has no units of its own."""
    try:
        scales = model.parameter_scales(2.0, 1.0), model.parameter_scales(1.0, 2.0)
    except InputError:
        return None
    return np.log2(scales[0]), np.log2(scales[1])


def _product(*factors: dict[str, float]) -> str:
    """Write a product of powers of units, what divides behind a slash."""
    powers: dict[str, float] = {}
    for factor in factors:
        for unit, power in factor.items():
            powers[unit] = powers.get(unit, 0.0) + round(float(power), 6)
    powers = {unit: power for unit, power in powers.items() if power}
    if "" in powers:
        return ""
    if list(powers.values()) == [1.0]:
        return next(iter(powers))
    above = [_power(unit, power) for unit, power in powers.items() if power > 0.0]
    below = [_power(unit, -power) for unit, power in powers.items() if power < 0.0]
    text = " ".join(above) or ("1" if below else "")
    if len(below) > 1:
        return f"{text}/({' '.join(below)})"
    return "/".join([text, *below])


def _power(unit: str, power: float) -> str:
    if not unit.isalnum():
        unit = f"({unit})"
    return unit if power == 1.0 else f"{unit}^{power:.3g}"
