"""Initial loading curves: what an operator with memory of reversals does on its way out from 0."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.parameters import Parameters
from hyst.operators.stage import Stage

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ReversalMemory:
    """How reversals are remembered.

    Parameters
    ----------
    last_reversal
        Whether only the last one is kept.
    depth
        How many there is room for, >= 1.
    dead_band
        By how much the input must go back before that is a reversal, >= 0, input units.
    """

    last_reversal: bool
    depth: int
    dead_band: float

    def stage(
        self, form: str, constants: tuple[float, ...], inverse: bool, least_slope: float = 0.0
    ) -> Stage:
        """Give the stage of a curve of ``form`` and ``constants``, or of its ``inverse``.

        ``least_slope`` bounds the slope of a polynomial from below.
        """
        return Stage(
            "masing",
            constants,
            fixed={"least_slope": (least_slope,), "dead_band": (self.dead_band,)},
            choices={
                "inverse": int(inverse),
                "last_reversal": int(self.last_reversal),
                "depth": self.depth,
            },
            form=form,
        )


class LoadingCurve(ABC):
    """A function f on x >= 0 with f(0) = 0 that never falls; odd beyond.

    An operator made of it goes along f first, and along ``2 f(x / 2)`` from every reversal.
    """

    kind: ClassVar[str]

    @abstractmethod
    def __call__(self, x: ArrayLike) -> Array:
        """Give f(x), in the shape of x, for x of either sign."""

    @abstractmethod
    def inverse(self) -> LoadingCurve:
        """Give the curve of the inverse function.

        Raises
        ------
        NotInvertibleError
            If f is flat somewhere.
        """

    @abstractmethod
    def extreme_slopes(self) -> Array:
        """Give f' at 0, at its extremes in order, and far out; infinite where it is."""

    @final
    def lipschitz_constant(self) -> float:
        """Give ``f'(0)`` plus the total variation of f', a bound of the operator's."""
        slopes = self.extreme_slopes()
        if not np.isfinite(slopes).all():
            return float("inf")
        return float(slopes[0] + np.abs(np.diff(slopes)).sum())

    @property
    @abstractmethod
    def is_straight(self) -> bool:
        """Whether f is a straight line, so that there is no hysteresis."""

    @abstractmethod
    def parameters(self) -> Parameters:
        """Give the constants."""

    @abstractmethod
    def with_parameters(self, theta: Sequence[float] | Array) -> LoadingCurve:
        """Give the same kind of curve with other constants."""

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the nearest constants that keep an order the constructor demands.

        Parameters
        ----------
        theta
            Shape (m,), within the bounds of ``parameters()``.

        Returns
        -------
        numpy.ndarray
            ``theta`` itself where there is none.
        """
        return theta

    @abstractmethod
    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants in units in which signals have larger numbers.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of x and f grow.

        Returns
        -------
        numpy.ndarray
            Shape (m,).
        """

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text."""

    @classmethod
    @abstractmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """

    @abstractmethod
    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage of this curve with a memory of reversals, or of its ``inverse``."""


_CLASSES: dict[str, type[LoadingCurve]] = {}


def register_curve(curve_class: type[LoadingCurve]) -> None:
    """Make a class of curves known under its ``kind``.

    Parameters
    ----------
    curve_class
        A final subclass of ``LoadingCurve``.
    """
    _CLASSES[curve_class.kind] = curve_class


def curve_from_dict(data: Any) -> LoadingCurve:
    """Rebuild any loading curve from its dictionary.

    Parameters
    ----------
    data
        What ``LoadingCurve.to_dict()`` gave.

    Returns
    -------
    LoadingCurve

    Raises
    ------
    InputError
        If the kind is unknown, or an entry is missing, unknown or not allowed.
    """
    if not isinstance(data, dict) or not isinstance(data.get("kind"), str):
        raise InputError("a loading curve is an object with an entry 'kind'; this one has none")
    if data["kind"] not in _CLASSES:
        known = ", ".join(sorted(_CLASSES))
        raise InputError(
            f"unknown kind of loading curve {data['kind']!r}; this version knows {known}"
        )
    return _CLASSES[data["kind"]].from_dict(data)


@final
@dataclass(frozen=True)
class InverseCurve(LoadingCurve):
    """The inverse function of a curve that has no formula for it; solved point by point.

    Parameters
    ----------
    curve
        A curve that is nowhere flat.

    Raises
    ------
    InputError
        If ``curve`` is no loading curve.

    Notes
    -----
    A power law takes at most 6 power evaluations a point (7 for c3 < 0), a polynomial at most 100
    evaluations; both counts hold for all constants. See core/include/hyst/loading_curve.h.

    Examples
    --------
    >>> from hyst.models import PowerLaw
    >>> curve = PowerLaw(1.0, 1.0, 1.0)
    >>> float(curve(2.0)), float(curve.inverse()(6.0))
    (6.0, 2.0)
    """

    curve: LoadingCurve

    kind = "inverse"

    def __post_init__(self) -> None:
        if not isinstance(self.curve, LoadingCurve):
            raise InputError(
                f"curve is of type {type(self.curve).__name__}; give a loading curve, as PowerLaw"
            )

    def __call__(self, x: ArrayLike) -> Array:
        """Give the inverse function, in the shape of x."""
        values = np.asarray(x, dtype=np.float64)
        chain = _engine.Chain((self.stage(ReversalMemory(False, 1, 0.0), False),))
        result = np.empty((values.size, 1))
        # Each value on its own, from the state without memory: that is the loading curve.
        chain.run(np.zeros((values.size, chain.state_length)), values.reshape(-1, 1).copy(), result)
        return result.reshape(values.shape)

    def inverse(self) -> LoadingCurve:
        """Give the curve itself back."""
        return self.curve

    def extreme_slopes(self) -> Array:
        """Give 1 / f' of the curve, which has its extremes where f' has."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / self.curve.extreme_slopes())

    @property
    def is_straight(self) -> bool:
        """Whether the curve is a straight line."""
        return self.curve.is_straight

    def parameters(self) -> Parameters:
        """Give the constants of the curve whose inverse this is."""
        return self.curve.parameters()

    def with_parameters(self, theta: Sequence[float] | Array) -> InverseCurve:
        """Give the inverse of a curve with other constants."""
        return InverseCurve(self.curve.with_parameters(theta))

    def nearest_parameters(self, theta: Array) -> Array:
        """Give those of the curve whose inverse this is."""
        return self.curve.nearest_parameters(theta)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants of the curve, whose input is this one's output."""
        return self.curve.parameter_scales(output_scale, input_scale)

    def to_dict(self) -> dict[str, Any]:
        """Give kind and curve."""
        return {"kind": self.kind, "curve": self.curve.to_dict()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> InverseCurve:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if set(data) != {"kind", "curve"}:
            raise InputError("an inverse curve has the entries 'kind' and 'curve'")
        return cls(curve_from_dict(data["curve"]))

    def stage(self, memory: ReversalMemory, inverse: bool) -> Stage:
        """Give the stage with a ``memory``; ``inverse`` asks for the inverse's inverse."""
        return self.curve.stage(memory, not inverse)


register_curve(InverseCurve)


def refuse_flat(flat_from: float | None) -> None:
    """Refuse the inverse of a curve that is flat.

    Parameters
    ----------
    flat_from
        Where it starts to be, or None if it is nowhere.

    Raises
    ------
    NotInvertibleError
        If it is flat somewhere.
    """
    if flat_from is not None:
        raise NotInvertibleError(
            f"the loading curve is flat from {flat_from:.6g} on: the output would rest while the "
            "input moves; give it a positive slope everywhere"
        )
