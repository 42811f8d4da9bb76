"""Plays between two envelopes, of rising and of falling input, and their exact inverse."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_number
from hyst.checks.thresholds import as_weights_and_thresholds
from hyst.errors import InputError, NotInvertibleError
from hyst.models.envelope_pair import EnvelopePair, as_envelope
from hyst.operators import DeadZone, Operator
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.registry import entries, operator_from_dict, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]

_ROUNDING = 1e-12
"""Of the terms of a gap: it closes, or opens, by less than that without anybody's intention."""


@dataclass(frozen=True, eq=False, init=False)
class _TwoEnvelope(Operator):
    """What the model and its inverse have in common: all constants."""

    p: Array
    r: Array
    rising: DeadZone
    falling: DeadZone
    p0: float

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        rising: DeadZone,
        falling: DeadZone,
        p0: float = 0.0,
    ) -> None:
        weights, thresholds = as_weights_and_thresholds(p, r)
        linear = as_number(p0, "p0")
        for name, value in (
            ("p0", linear),
            *zip(numbered("p", weights.size, 0), weights, strict=True),
        ):
            if value < 0.0:
                raise InputError(
                    f"{name} is {value:.6g}; between two envelopes weights are zero or positive, "
                    "or the output would fall while the input rises"
                )
        object.__setattr__(self, "p", weights)
        object.__setattr__(self, "r", thresholds)
        object.__setattr__(self, "rising", as_envelope(rising, "rising"))
        object.__setattr__(self, "falling", as_envelope(falling, "falling"))
        object.__setattr__(self, "p0", linear)
        if thresholds.size:
            self._require_room(float(thresholds[0]))

    @property
    def envelopes(self) -> EnvelopePair:
        """Both envelopes."""
        return EnvelopePair(self.rising, self.falling)

    def parameters(self) -> Parameters:
        """Give weights and thresholds of both envelopes, then p0, p and r."""
        n = self.p.size
        maps = [each.parameters() for each in (self.rising, self.falling)]
        zero, free = np.zeros(1 + 2 * n), np.full(1 + 2 * n, np.inf)
        return Parameters(
            values=np.concatenate([*(each.values for each in maps), [self.p0], self.p, self.r]),
            names=(
                *(f"rising.{name}" for name in maps[0].names),
                *(f"falling.{name}" for name in maps[1].names),
                "p0",
                *numbered("p", n),
                *numbered("r", n),
            ),
            lower=np.concatenate([*(each.lower for each in maps), zero]),
            upper=np.concatenate([*(each.upper for each in maps), free]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Self:
        """Give a model with other envelopes, weights and thresholds."""
        n = self.p.size
        sizes = [2 * self.rising.weights.size, 2 * self.falling.weights.size, 1, n, n]
        vector = as_parameter_vector(theta, sum(sizes))
        rising, falling, p0, p, r = np.split(vector, np.cumsum(sizes)[:-1])
        return type(self)(
            p,
            r,
            self.rising.with_parameters(rising),
            self.falling.with_parameters(falling),
            float(p0[0]),
        )

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with radii that do not fall, and wide enough for the envelopes."""
        n, up, down = self.p.size, 2 * self.rising.weights.size, 2 * self.falling.weights.size
        nearest = theta.copy()
        if n:
            pair = EnvelopePair(
                self.rising.with_parameters(theta[:up]),
                self.falling.with_parameters(theta[up : up + down]),
            )
            radii = np.maximum(theta[-n:], -0.5 * pair.narrowest()[1])
            nearest[-n:] = np.maximum.accumulate(radii)
        return nearest

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors: envelopes keep the unit of the input, weights of plays turn it."""
        n = self.p.size
        maps = [np.repeat([1.0, input_scale], m.weights.size) for m in (self.rising, self.falling)]
        plays = np.repeat([output_scale / input_scale, input_scale], [n + 1, n])
        return np.concatenate([*maps, plays])

    def to_dict(self) -> dict[str, Any]:
        """Give kind, weights, thresholds and both envelopes."""
        return {
            "kind": self.kind,
            "p0": self.p0,
            "p": self.p.tolist(),
            "r": self.r.tolist(),
            "rising": self.rising.to_dict(),
            "falling": self.falling.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, required=("p", "r", "rising", "falling", "p0"))
        maps = [operator_from_dict(given.pop(name)) for name in ("rising", "falling")]
        rising, falling = as_envelope(maps[0], "rising"), as_envelope(maps[1], "falling")
        return cls(given["p"], given["r"], rising, falling, given["p0"])

    @abstractmethod
    def _is_inverse(self) -> bool:
        """Tell whether the input is the output of the model."""

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        choices = {
            "rising": self.rising.weights.size,
            "falling": self.falling.weights.size,
            "inverse": int(self._is_inverse()),
        }
        return (Stage("two_envelope", tuple(self.parameters().values.tolist()), choices=choices),)

    def _require_room(self, r: float) -> None:
        """Refuse envelopes of which the one of falling input lies below a play's other edge."""
        at, gap = self.envelopes.narrowest()
        if not np.isfinite(at):
            side = "right" if at > 0.0 else "left"
            raise InputError(
                f"the envelopes cross far out on the {side}, for falling comes closer to rising "
                "beyond the last threshold with every unit; give both the same slope there"
            )
        slack = _ROUNDING * (abs(float(self.rising(np.array([at]))[0])) + r)
        if gap + 2.0 * r < -slack:
            raise InputError(
                f"the envelopes cross: at {at:.6g} falling is {-gap:.6g} below rising, more than "
                f"the 2 r = {2.0 * r:.6g} that the first play leaves between them; give r of "
                f"{-0.5 * gap:.6g} or more, or a higher envelope of falling input"
            )


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class TwoEnvelopePrandtlIshlinskii(_TwoEnvelope):
    """Plays between two envelopes: another map while the input rises than while it falls.

    ``z_i = max(up(u) - r_i, min(down(u) + r_i, z_i))``,
    ``y = p0 (up(u) + down(u)) / 2 + sum_i p_i z_i``, all z_i = 0 before the first sample.

    Parameters
    ----------
    p
        Shape (n,), >= 0, weights of the plays, output units per input unit.
    r
        Shape (n,), thresholds ``0 <= r_1 <= ... <= r_n``, input units.
    rising, falling
        The envelopes up and down, two-sided ``DeadZone`` maps that nowhere fall. With
        ``down(u) - up(u) + 2 r_1 >= 0`` for every u; both are 0 at 0, and a constant that sets them
        apart is part of r.
    p0
        >= 0, weight of the part without memory, the mean of the envelopes.

    Raises
    ------
    InputError
        If a weight is negative, thresholds are negative or unsorted, an envelope falls or is no
        two-sided dead-zone map, or the envelopes cross; the place is named.

    Notes
    -----
    M. Al Janaideh, S. Rakheja, C.-Y. Su, Smart Mater. Struct. 18 (2009) 045001 (the play between
    two envelopes), whose part without memory is ``p0 u``: the mean of the envelopes saturates as
    they do. With equal envelopes it is the ``GeneralizedPrandtlIshlinskii`` of them, to the bit.
    Loops may be asymmetric and saturate, and be wider at one end than at the other; minor loops
    between the same inputs stay congruent.

    Examples
    --------
    >>> up, down = DeadZone([1.0, -0.5], [0.0, 1.0]), DeadZone([1.0, -0.5], [0.0, -1.0])
    >>> model = TwoEnvelopePrandtlIshlinskii([0.5], [1.0], up, down, p0=1.0)
    >>> y = model([0.0, 2.0, -2.0, 1.0])
    >>> y.round(12)
    array([ 0.,  2., -2.,  1.])
    >>> model.inverse()(y).round(12)
    array([ 0.,  2., -2.,  1.])
    """

    kind = "two-envelope-prandtl-ishlinskii"

    def traits(self) -> Traits:
        """Give the traits of generalized plays with weights of one sign."""
        return Traits(
            memoryless=self.p.size == 0,
            # Sums of an envelope's weights of both signs rise up to rounding only.
            rate_independent=Degree.TO_ROUNDING,
            return_point_memory=True,
            congruent_loops=True,
            monotone=True,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give the play outputs before the first sample, zeros, shape (n,)."""
        return np.zeros(self.p.size)

    def exact_inverse(self) -> InverseTwoEnvelope:
        """Give the exact inverse, sample by sample: a search over the knots and a closed form.

        With K knots of both envelopes a sample takes at most ``log2(K) + 2`` evaluations of a
        branch, of n + 2 K terms each, and n + 1 divisions.

        Raises
        ------
        NotInvertibleError
            If p0 is 0, so that nothing moves at first after a turn, or both envelopes are flat at
            one place, which is named.
        """
        if self.p0 <= 0.0:
            raise NotInvertibleError(
                f"p0 is {self.p0:.6g}: without a part that has no memory the output rests while "
                "the input turns, and many inputs have one output; identify or give p0 > 0"
            )
        flat = self.envelopes.flat_from()
        if flat is not None:
            raise NotInvertibleError(
                f"both envelopes are flat from {flat[0]:.6g} to {flat[1]:.6g}: the output rests "
                "there while the input moves; give one of them a positive slope"
            )
        return InverseTwoEnvelope(self.p, self.r, self.rising, self.falling, self.p0)

    def lipschitz_constant(self) -> float:
        """Give the steepest slope of the mean and of either envelope, weighted."""
        pair = self.envelopes
        return float(self.p0 * pair.steepest_mean() + self.p.sum() * pair.steepest())

    def _is_inverse(self) -> bool:
        return False


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class InverseTwoEnvelope(_TwoEnvelope):
    """Inverse of plays between two envelopes; ``TwoEnvelopePrandtlIshlinskii.inverse()`` makes it.

    Parameters
    ----------
    p, r, rising, falling, p0
        As in ``TwoEnvelopePrandtlIshlinskii``, with p0 > 0 and a mean of the envelopes that is
        nowhere flat.

    Raises
    ------
    InputError
        As ``TwoEnvelopePrandtlIshlinskii``, and where that has no inverse.

    Examples
    --------
    >>> line = DeadZone([1.0], [0.0])
    >>> TwoEnvelopePrandtlIshlinskii([1.0], [1.0], line, line, p0=1.0).inverse()([0.5, 3.0, 2.5])
    array([0.5, 2. , 1.5])
    """

    kind = "inverse-two-envelope-prandtl-ishlinskii"

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        rising: DeadZone,
        falling: DeadZone,
        p0: float = 0.0,
    ) -> None:
        super().__init__(p, r, rising, falling, p0)
        if self.p0 <= 0.0 or self.envelopes.flat_from() is not None:
            raise InputError(
                f"p0 is {self.p0:.6g} and the envelopes' mean "
                f"{'rises' if self.envelopes.flat_from() is None else 'is flat somewhere'}; an "
                "inverse needs p0 > 0 and a mean that rises everywhere"
            )

    def traits(self) -> Traits:
        """Give the traits of what undoes plays."""
        return Traits(
            memoryless=self.p.size == 0,
            rate_independent=Degree.TO_ROUNDING,
            return_point_memory=True,
            congruent_loops=False,
            monotone=True,
            invertible=True,
        )

    def initial_state(self) -> Array:
        """Give play outputs, last output and input, all 0, and the slope there, shape (n + 3,)."""
        slope = self.p0 * self.envelopes.mean_slope_at_zero()
        return np.concatenate([np.zeros(self.p.size + 2), [slope]])

    def exact_inverse(self) -> TwoEnvelopePrandtlIshlinskii:
        """Give the plays."""
        return TwoEnvelopePrandtlIshlinskii(self.p, self.r, self.rising, self.falling, self.p0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the constants, which are those of the model."""
        return super().parameter_scales(output_scale, input_scale)

    def lipschitz_constant(self) -> float:
        """Give infinity: what plays have taken from a way adds up at turns."""
        return float("inf")

    def _is_inverse(self) -> bool:
        return True
