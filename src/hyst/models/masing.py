"""Hysteresis with memory of reversals from any loading curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number, whole_number
from hyst.errors import InputError
from hyst.models.loading_curve import (
    InverseCurve,
    LoadingCurve,
    ReversalMemory,
    curve_from_dict,
)
from hyst.operators.base import Operator
from hyst.operators.parameters import Parameters
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Asked, Degree, Traits

Array = NDArray[np.float64]
Memory = Literal["masing", "last-reversal"]

DEPTH = 64
"""Reversals remembered unless asked otherwise: loops inside loops, 32 deep."""

_OVERFLOW = 3
"""Place in the state; see core/include/hyst/masing.h."""


def as_mode(memory: str) -> Memory:
    """Check the name of a memory.

    Parameters
    ----------
    memory
        ``"masing"`` or ``"last-reversal"``.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If it is neither.
    """
    if memory == "masing":
        return "masing"
    if memory == "last-reversal":
        return "last-reversal"
    raise InputError(f"memory is {memory!r}; choose 'masing' or 'last-reversal'")


def as_memory(memory: str, depth: int, dead_band: float) -> ReversalMemory:
    """Check how reversals are to be remembered.

    Parameters
    ----------
    memory
        ``"masing"`` or ``"last-reversal"``.
    depth
        Reversals there is room for with ``"masing"``, 1 to 100000.
    dead_band
        Input units, >= 0; 0 with ``"masing"``.

    Returns
    -------
    ReversalMemory

    Raises
    ------
    InputError
        If one of them is not allowed.
    """
    as_mode(memory)
    room = whole_number(depth, "depth", 1, 100_000, " reversals")
    band = as_number(dead_band, "dead_band")
    if band < 0.0 or (band > 0.0 and memory == "masing"):
        raise InputError(
            f"dead_band is {band:.6g}; give 0 or more, and 0 with nested memory, whose small loops "
            "close by themselves"
        )
    last = memory == "last-reversal"
    return ReversalMemory(last, 1 if last else room, band)


def reversal_traits(memory: ReversalMemory, invertible: Asked) -> Traits:
    """Give the traits of a rising loading curve with memory of reversals.

    Parameters
    ----------
    memory
        How reversals are remembered.
    invertible
        Whether the curve is nowhere flat.

    Returns
    -------
    Traits
    """
    return Traits(
        memoryless=False,
        rate_independent=Degree.EXACTLY,
        return_point_memory=not memory.last_reversal,
        # A loop within the dead band is traced along whatever branch it is on.
        congruent_loops=memory.dead_band == 0.0,
        monotone=True,
        invertible=invertible,
    )


@register
@final
@dataclass(frozen=True, eq=False)
class MasingOperator(Operator):
    """Hysteresis from a loading curve f and the memory of reversals.

    First ``y = f(u)``, f odd; from a reversal (u_i, y_i) on
    ``y = y_i + 2 sign(u - u_i) f(|u - u_i| / 2)`` (S3 eqs. 2-3).

    Parameters
    ----------
    curve
        The initial loading curve: ``PowerLaw``, ``PiecewiseLinear``, ``PolynomialCurve``,
        ``ExponentialCurve``, ``IwanCurve`` or the ``InverseCurve`` of one.
    memory
        ``"masing"``: reversals are nested, and every loop closes. A piecewise linear curve then
        makes the Prandtl-Ishlinskii operator. ``"last-reversal"``: everything before the last
        reversal is forgotten, as S3 has it; the output drifts after minor loops.
    depth
        Reversals there is room for with ``"masing"``. When they are used up, loops nested deeper
        are traced without area and still close; ``overflowed`` tells it.
    dead_band
        With ``"last-reversal"``: by how much the input must go back before that counts as a
        reversal, input units. It keeps noise from resetting the memory. In the inverse of an
        operator it still counts in input units of that operator.

    Raises
    ------
    InputError
        If ``curve`` is no loading curve or another argument is not allowed.

    Examples
    --------
    >>> from hyst.models import PiecewiseLinear, PrandtlIshlinskii
    >>> u = [0.0, 3.0, -1.0, 2.0]
    >>> MasingOperator(PiecewiseLinear([0.5], [1.0], p0=1.0))(u)
    array([ 0. ,  4. , -1. ,  2.5])
    >>> PrandtlIshlinskii([0.5], [1.0], p0=1.0)(u)
    array([ 0. ,  4. , -1. ,  2.5])
    """

    curve: LoadingCurve
    memory: Memory = "masing"
    depth: int = DEPTH
    dead_band: float = 0.0

    kind = "masing"

    def __post_init__(self) -> None:
        if not isinstance(self.curve, LoadingCurve):
            raise InputError(
                f"curve is of type {type(self.curve).__name__}; give a loading curve, as PowerLaw"
            )
        checked = as_memory(self.memory, self.depth, self.dead_band)
        object.__setattr__(self, "depth", int(self.depth))
        object.__setattr__(self, "dead_band", checked.dead_band)

    def traits(self) -> Traits:
        """Give the traits; with the last reversal alone, loops do not close after minor loops."""
        return reversal_traits(self._memory(), self.is_invertible)

    def initial_state(self) -> Array:
        """Give the state without memory: last input and output, counts, and room for reversals."""
        return np.zeros(self._chain.state_length)

    def overflowed(self, state: ArrayLike) -> bool:
        """Tell whether a reversal has found no room and its loop was traced without area.

        Parameters
        ----------
        state
            As ``run`` gave it.

        Returns
        -------
        bool
        """
        return bool(np.asarray(state)[..., _OVERFLOW].any())

    def exact_inverse(self) -> MasingOperator:
        """Give the exact inverse: the operator of the inverse loading curve.

        Raises
        ------
        NotInvertibleError
            If the curve is flat somewhere.
        """
        inverse = self.curve.inverse()
        if self.dead_band > 0.0 and not isinstance(self.curve, InverseCurve):
            # Its dead band counts in the units of what it inverts, which a formula does not know.
            inverse = InverseCurve(self.curve)
        return MasingOperator(inverse, self.memory, self.depth, self.dead_band)

    def parameters(self) -> Parameters:
        """Give the constants of the curve."""
        return self.curve.parameters()

    def with_parameters(self, theta: Sequence[float] | Array) -> MasingOperator:
        """Give the operator of another curve of the same kind."""
        curve = self.curve.with_parameters(theta)
        return MasingOperator(curve, self.memory, self.depth, self.dead_band)

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the nearest constants of the curve."""
        return self.curve.nearest_parameters(theta)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants of the curve."""
        return self.curve.parameter_scales(input_scale, output_scale)

    def in_units(self, input_scale: float, output_scale: float) -> MasingOperator:
        """Give the operator in other units, its dead band too."""
        scales = self.parameter_scales(input_scale, output_scale)
        curve = self.curve.with_parameters(scales * self.parameters().values)
        own = output_scale if isinstance(self.curve, InverseCurve) else input_scale
        return MasingOperator(curve, self.memory, self.depth, self.dead_band * own)

    def portrait(self) -> Portrait:
        """Show the loading curve."""
        return Portrait(("curve",), self.curve)

    def lipschitz_constant(self) -> float:
        """Give the curve's bound; infinity where only the last reversal is remembered."""
        return self.curve.lipschitz_constant() if self.memory == "masing" else float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, curve and memory."""
        return {"kind": self.kind, "curve": self.curve.to_dict(), **memory_entries(self)}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> MasingOperator:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, ("curve", "memory"), ("depth", "dead_band"))
        return cls(curve=curve_from_dict(given.pop("curve")), **given)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (self.curve.stage(self._memory(), inverse=False),)

    def _memory(self) -> ReversalMemory:
        return as_memory(self.memory, self.depth, self.dead_band)


def memory_entries(model: Any) -> dict[str, Any]:
    """Give the entries of a dictionary that say how a model remembers reversals.

    Parameters
    ----------
    model
        With ``memory``, ``depth`` and ``dead_band``.

    Returns
    -------
    dict
        Without what has its usual value.
    """
    given: dict[str, Any] = {"memory": model.memory}
    if model.depth != DEPTH:
        given["depth"] = model.depth
    if model.dead_band != 0.0:
        given["dead_band"] = model.dead_band
    return given
