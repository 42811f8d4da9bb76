"""The hysteresis of Coleman and Hodgdon, and its exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number, as_positive
from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_SMALLEST = float(np.nextafter(0.0, 1.0))


@dataclass(frozen=True, eq=False)
class _Relaxation(Operator):
    """What the model and its inverse have in common: all constants."""

    alpha: float
    a: ArrayLike
    b: ArrayLike
    u_s: ArrayLike = ()
    y0: float = 0.0
    u0: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "alpha", as_positive(self.alpha, "alpha"))
        for name in ("a", "b"):
            values = getattr(self, name)
            several = np.atleast_1d(values) if np.ndim(values) == 0 else values
            object.__setattr__(self, name, as_constants(several, name))
        object.__setattr__(self, "u_s", as_constants(self.u_s, "u_s"))
        for name in ("y0", "u0"):
            object.__setattr__(self, name, as_number(getattr(self, name), name))
        _require_admissible(self.slopes_of_f, self.slopes_of_g, self.knots)

    @property
    def slopes_of_f(self) -> Array:
        """The constants a, shape (n,)."""
        return np.asarray(self.a)

    @property
    def slopes_of_g(self) -> Array:
        """The constants b, shape (n,)."""
        return np.asarray(self.b)

    @property
    def knots(self) -> Array:
        """The constants u_s, shape (n - 1,)."""
        return np.asarray(self.u_s)

    def initial_state(self) -> Array:
        """Give input and output, before the first sample and at a turn, shape (4,)."""
        return np.array([self.u0, self.y0, self.u0, self.y0])

    def parameters(self) -> Parameters:
        """Give alpha, a, b and u_s."""
        n = self.slopes_of_f.size
        one = n == 1
        return Parameters(
            values=np.concatenate([[self.alpha], self.slopes_of_f, self.slopes_of_g, self.knots]),
            names=(
                "alpha",
                *(("a", "b") if one else numbered("a", n) + numbered("b", n)),
                *numbered("u_s", n - 1),
            ),
            lower=np.concatenate([[_SMALLEST], np.zeros(2 * n), np.full(n - 1, _SMALLEST)]),
            upper=np.full(3 * n, np.inf),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give the model of other constants with the same state before the first sample."""
        n = self.slopes_of_f.size
        alpha, a, b, u_s = np.split(as_parameter_vector(theta, 3 * n), [1, 1 + n, 1 + 2 * n])
        return type(self)(float(alpha[0]), a, b, u_s, self.y0, self.u0)

    def lipschitz_constant(self) -> float:
        """Give infinity: many small ways wear the loop down as one large way does."""
        return float("inf")

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where there is one, the state before the first sample."""
        state = {name: getattr(self, name) for name in ("y0", "u0") if getattr(self, name)}
        knots = {"u_s": self.knots.tolist()} if self.knots.size else {}
        constants = {"a": self.slopes_of_f.tolist(), "b": self.slopes_of_g.tolist()}
        return {"kind": self.kind, "alpha": self.alpha, **constants, **knots, **state}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("alpha", "a", "b"), ("u_s", "y0", "u0")))

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is y."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {"pieces": self.slopes_of_f.size, "inverse": int(self._is_inverse())}
        constants = tuple(self.parameters().values.tolist())
        return (Stage("coleman_hodgdon", constants, choices=choices),)


@register
@final
@dataclass(frozen=True, eq=False)
class ColemanHodgdon(_Relaxation):
    """Coleman and Hodgdon's hysteresis: ``dy/du = alpha s (f(u) - y) + g(u)``, s = sgn(du).

    f is odd with the slope a, g is even with the value b: with one a and one b the form that is
    usual for piezos, ``dy/du = alpha s (a u - y) + b``. With several, ``f' = a_j`` and ``g = b_j``
    where ``u_s[j-1] <= |u| < u_s[j]``, as for what saturates. Exact between samples: within a piece
    ``y - f`` relaxes to ``-s (a - b) / alpha`` as ``exp(-alpha |du|)``.

    Parameters
    ----------
    alpha
        > 0, how fast a branch forgets where it began, per input unit.
    a
        >= 0, slope of f, output units per input unit: a number, or shape (n,) from the middle
        outwards.
    b
        0 to a, slope where the branch crosses f; of the same shape.
    u_s
        Shape (n - 1,), > 0, ascending: where the slopes change, on both sides of 0, input units.
    y0, u0
        Output and input before the first sample.

    Raises
    ------
    InputError
        If a constant is not finite or out of its range; where b exceeds a, the loop would run as
        friction's does, which ``Dahl`` and a line describe.

    Notes
    -----
    B. D. Coleman and M. L. Hodgdon, A constitutive relation for rate-independent hysteresis in
    ferromagnetically soft materials, Int. J. Engng Sci. 24 (1986) 897-919. Their conditions are
    f odd and rising, g even, f' >= g; loops run counter-clockwise then. Minor loops drift until
    they close: the model has no return-point memory.

    Examples
    --------
    >>> piezo = ColemanHodgdon(alpha=1.0, a=2.0, b=1.5)
    >>> piezo([1.0, 0.5]).round(6)
    array([1.68394 , 1.005034])
    >>> piezo.inverse()(piezo([1.0, 0.5])).round(12)
    array([1. , 0.5])
    """

    kind = "coleman-hodgdon"

    def traits(self) -> Traits:
        """Give the traits: the output is that of the way since the last turn, to the bit."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=lambda: self._starts_within() and self.smallest_slope()[0] >= 0.0,
            invertible=self.is_invertible,
        )

    def smallest_slope(self) -> tuple[float, float]:
        """Give the smallest slope dy/du any drive from rest can bring about, and the input there.

        It is that right after a turn, on a branch that came from far away:
        ``g(u) - alpha D(u)`` with ``D(u) = int_u^inf (f' - g) exp(-alpha (v - u)) dv``
        (Coleman and Hodgdon's condition); for one piece ``2 b - a``, which all inputs share.

        Returns
        -------
        tuple of float
        """
        found, _ = self._distances()
        return found

    def exact_inverse(self) -> InverseColemanHodgdon:
        """Give the exact inverse, in each piece by Newton's method to rounding.

        Raises
        ------
        NotInvertibleError
            If some drive makes the output rest or move against the input; the smallest slope is
            named. Or if the output before the first sample is further from f than any drive leaves
            it.
        """
        self.require_inverse()
        return InverseColemanHodgdon(
            self.alpha, self.slopes_of_f, self.slopes_of_g, self.knots, self.y0, self.u0
        )

    def require_inverse(self) -> None:
        """Refuse constants that have no inverse.

        Raises
        ------
        NotInvertibleError
            As ``inverse``.
        """
        slope, place = self.smallest_slope()
        if slope <= 0.0:
            one = not self.knots.size
            condition = "2 b - a" if one else f"the slope after a turn at {place:.6g}"
            raise NotInvertibleError(
                f"{condition} is {slope:.6g}, not positive: right after some turns the output "
                "rests or moves against the input, and has several inputs; the inverse needs b "
                "above a / 2, or a smaller alpha where slopes change"
            )
        if not self._starts_within():
            raise NotInvertibleError(
                f"y0 is {self.y0:.6g} at u0 = {self.u0:.6g}, further from f than any drive leaves "
                "the output, so that it may first move against the input; give a y0 nearer to f"
            )

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of alpha, a, b and u_s."""
        n = self.slopes_of_f.size
        slopes = np.full(2 * n, output_scale / input_scale)
        return np.concatenate([[1.0 / input_scale], slopes, np.full(n - 1, input_scale)])

    def in_units(self, input_scale: float, output_scale: float) -> ColemanHodgdon:
        """Give the model in other units, what was before the first sample too."""
        scales = self.parameter_scales(input_scale, output_scale)
        made = self.with_parameters(scales * self.parameters().values)
        return ColemanHodgdon(
            made.alpha, made.a, made.b, made.u_s, self.y0 * output_scale, self.u0 * input_scale
        )

    def _is_inverse(self) -> bool:
        return False

    def _starts_within(self) -> bool:
        """Tell whether a drive could have left y0 at u0."""
        size = np.abs(self.u0)
        ends = np.concatenate([[0.0], self.knots, [np.inf]])
        reached = np.clip(size - ends[:-1], 0.0, np.diff(ends))
        f = float(np.sign(self.u0) * (self.slopes_of_f @ reached))
        beyond = self.y0 - f
        _, most = self._distances(self.u0 if beyond >= 0.0 else -self.u0)
        return abs(beyond) <= most * (1.0 + 1e-12)

    def _distances(self, at: float = 0.0) -> tuple[tuple[float, float], float]:
        """Smallest slope and where, and the largest y - f at an input.

        Walks the falling branch that came from far above, piece by piece downwards.
        """
        excess = self.slopes_of_f - self.slopes_of_g
        ends = np.concatenate([self.knots[::-1], -self.knots, [-np.inf]])
        count = self.knots.size
        pieces = [*range(count, 0, -1), *range(count + 1)]
        distance, upper, most = float(excess[-1]) / self.alpha, np.inf, 0.0
        slope, place = (
            float(self.slopes_of_g[-1]) - self.alpha * distance,
            float(self.knots[-1:].sum()),
        )
        for end, piece in zip(ends.tolist(), pieces, strict=True):
            rest = float(excess[piece]) / self.alpha
            if end <= at <= upper:
                way = 0.0 if upper == np.inf else self.alpha * (upper - at)
                most = rest + (distance - rest) * float(np.exp(-way))
            # Within a piece the distance moves one way, so its ends are enough.
            after = (
                distance
                if upper == np.inf
                else rest + (distance - rest) * float(np.exp(-self.alpha * (upper - end)))
            )
            for where, value in ((upper, distance), (end, after)):
                found = float(self.slopes_of_g[piece]) - self.alpha * value
                if found < slope:
                    slope, place = found, where
            distance, upper = after, end
        return (slope, place), most


@register
@final
@dataclass(frozen=True, eq=False)
class InverseColemanHodgdon(_Relaxation):
    """Inverse of Coleman and Hodgdon's hysteresis; ``ColemanHodgdon.inverse()`` makes it.

    Parameters
    ----------
    alpha, a, b, u_s, y0, u0
        As in ``ColemanHodgdon``.

    Raises
    ------
    InputError
        As ``ColemanHodgdon``, and if these constants have no inverse.

    Examples
    --------
    >>> ColemanHodgdon(alpha=1.0, a=2.0, b=1.5).inverse()([1.68394, 1.005034]).round(5)
    array([1. , 0.5])
    """

    kind = "inverse-coleman-hodgdon"

    def __post_init__(self) -> None:
        super().__post_init__()
        try:
            self.exact_inverse().require_inverse()
        except NotInvertibleError as refused:
            raise InputError(f"these constants have no inverse: {refused}") from None

    def traits(self) -> Traits:
        """Give the traits of an input that the output determines."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=False,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def exact_inverse(self) -> ColemanHodgdon:
        """Give the hysteresis."""
        return ColemanHodgdon(self.alpha, self.a, self.b, self.u_s, self.y0, self.u0)

    def _is_inverse(self) -> bool:
        return True


def _require_admissible(a: Array, b: Array, knots: Array) -> None:
    """Refuse what does not fit together, or is outside Coleman and Hodgdon's conditions."""
    if not a.size or b.size != a.size or knots.size != a.size - 1:
        raise InputError(
            f"there are {a.size} a, {b.size} b and {knots.size} u_s; give as many b as a, and one "
            "u_s less"
        )
    if a.min() < 0.0 or b.min() < 0.0:
        name, least = ("a", a.min()) if a.min() < 0.0 else ("b", b.min())
        raise InputError(f"{name} goes down to {least:.6g}; give 0 or more")
    if (b > a).any():
        worst = int(np.argmax(b - a))
        raise InputError(
            f"b is {b[worst]:.6g} above a = {a[worst]:.6g}: the loop would run clockwise, as that "
            "of friction; give b up to a, or use Dahl with a line beside it"
        )
    if knots.size and (knots.min() <= 0.0 or (np.diff(knots) <= 0.0).any()):
        raise InputError("u_s must be positive and ascending; sort them, without the mirrored ones")


__all__ = ["ColemanHodgdon", "InverseColemanHodgdon"]
