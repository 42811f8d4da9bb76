"""The Prandtl-Ishlinskii model and its exact inverse."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, refuse_overflow
from hyst.checks.numbers import as_number
from hyst.checks.thresholds import as_weights_and_thresholds
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.base import Operator
from hyst.operators.cumulative_weights import cumulative, rounding_of_cumulative
from hyst.operators.inequalities import Inequalities, of_plays
from hyst.operators.parameters import Parameters, as_parameter_vector, parameters_of_plays
from hyst.operators.portrait import Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@register
@final
@dataclass(frozen=True, eq=False, init=False)
class PrandtlIshlinskii(Operator):
    """Prandtl-Ishlinskii model: ``y = p0 u + sum_i p_i F_i[u]``, F_i the play of threshold r_i.

    Parameters
    ----------
    p
        Shape (n,), weights of the plays, output units per input unit, any sign.
    r
        Shape (n,), thresholds ``0 <= r_1 <= ... <= r_n``, input units.
    p0
        Weight of the input itself, output units per input unit.
    z0
        Shape (n,), play outputs before the first sample, input units; zeros (no memory) if left
        out.

    Raises
    ------
    InputError
        If lengths differ, thresholds are negative or unsorted, or a constant is not finite.

    Notes
    -----
    S1 eq. 4, S4 eq. 1.

    Examples
    --------
    >>> model = PrandtlIshlinskii(p=[0.5, 0.25], r=[0.1, 0.4], p0=1.0)
    >>> u = [0.0, 1.0, 0.2, 0.6]
    >>> bool(abs(model.inverse()(model(u)) - u).max() < 1e-15)
    True
    """

    p: Array
    r: Array
    p0: float
    z0: Array

    kind = "prandtl-ishlinskii"

    def __init__(
        self, p: ArrayLike, r: ArrayLike, p0: float = 0.0, z0: ArrayLike | None = None
    ) -> None:
        weights, thresholds = as_weights_and_thresholds(p, r)
        memory = as_constants(np.zeros(weights.size) if z0 is None else z0, "z0")
        if memory.size != weights.size:
            raise InputError(
                f"z0 has {memory.size} entries; give one for each of {weights.size} plays"
            )
        object.__setattr__(self, "p", weights)
        object.__setattr__(self, "r", thresholds)
        object.__setattr__(self, "p0", as_number(p0, "p0"))
        # -0.0 becomes 0.0, since a dictionary leaves out a memory of zeros.
        object.__setattr__(self, "z0", as_constants(memory + 0.0, "z0"))

    def traits(self) -> Traits:
        """Give the traits of a superposition of plays."""
        return Traits(
            memoryless=self.p.size == 0,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=True,
            monotone=self._is_monotone,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give the initial play outputs, shape (n,)."""
        return self.z0.copy()

    def exact_inverse(self) -> PrandtlIshlinskii:
        """Give the exact inverse, again a Prandtl-Ishlinskii model.

        With ``c_j = p0 + p_1 + .. + p_j``: weights ``g0 = 1/p0``, ``g_j = -p_j / (c_j c_{j-1})``,
        thresholds ``s_j = s_{j-1} + c_{j-1} (r_j - r_{j-1})``, memory
        ``c_j z_j + sum_{i>j} p_i z_i``. A play of threshold 0 is the input itself and counts as
        part of p0; plays of one threshold count as one.

        Raises
        ------
        NotInvertibleError
            If p0 is not positive, a cumulative weight c_j is not positive (the weight is named) or
            zero to rounding, the initial memory is none that an input could have left, or a
            constant of the inverse overflows.

        Notes
        -----
        S1 eqs. 7-8, S4 eqs. 14-16 (eq. 16 must start with y1 = a0 x1).
        """
        self._require_invertible()
        p0, p, r, z = self._merged()
        slopes = cumulative(p0, p)
        with np.errstate(all="ignore"):
            weights = -(p / slopes[1:]) / slopes[:-1]
            thresholds = np.cumsum(slopes[:-1] * np.diff(r, prepend=0.0))
            beyond = np.concatenate([np.cumsum((p * z)[:0:-1])[::-1], np.zeros(min(p.size, 1))])
            memory = slopes[1:] * z + beyond
            g0 = 1.0 / np.float64(p0)
        refuse_overflow(g0, weights, thresholds, memory)
        return PrandtlIshlinskii(weights, thresholds, float(g0), memory)

    def initial_loading_curve(self, u: ArrayLike) -> Array:
        """Give the output while the input first rises from 0 without memory.

        Parameters
        ----------
        u
            Inputs >= 0.

        Returns
        -------
        numpy.ndarray
            ``f(u) = p0 u + sum_i p_i max(u - r_i, 0)``, in the shape of ``u``.
        """
        rising = np.asarray(u, dtype=np.float64)
        return self.p0 * rising + np.maximum(rising[..., None] - self.r, 0.0) @ self.p

    def parameters(self) -> Parameters:
        """Give p0, the weights, then the thresholds."""
        return parameters_of_plays(self.p0, self.p, self.r)

    def inequalities(self) -> Inequalities:
        """Give radii that do not fall and cumulative weights above 0."""
        return of_plays(self.p0, self.p)

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with radii that do not fall."""
        n = self.p.size
        nearest = theta.copy()
        nearest[n + 1 : 2 * n + 1] = np.maximum.accumulate(theta[n + 1 : 2 * n + 1])
        return nearest

    def with_parameters(self, theta: Sequence[float] | Array) -> PrandtlIshlinskii:
        """Give a model with other weights and thresholds and the same initial memory."""
        n = self.p.size
        vector = as_parameter_vector(theta, 1 + 2 * n)
        return PrandtlIshlinskii(vector[1 : n + 1], vector[n + 1 :], float(vector[0]), self.z0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of p0, p and r."""
        n = self.p.size
        return np.repeat([output_scale / input_scale, input_scale], [n + 1, n])

    def in_units(self, input_scale: float, output_scale: float) -> PrandtlIshlinskii:
        """Give the model in other units, its memory too."""
        ratio = output_scale / input_scale
        return PrandtlIshlinskii(
            self.p * ratio, self.r * input_scale, self.p0 * ratio, self.z0 * input_scale
        )

    def portrait(self) -> Portrait:
        """Show the weights over the radii, and the loading curve they make."""
        curve = self.initial_loading_curve
        return Portrait(("weights", "curve"), curve, self.p, self.r, self.p0)

    def lipschitz_constant(self) -> float:
        """Give the sum of the absolute weights."""
        return float(cumulative(abs(self.p0), np.abs(self.p))[-1])

    def to_dict(self) -> dict[str, Any]:
        """Give kind, weights, thresholds and, where there is one, the initial memory."""
        memory = {"z0": self.z0.tolist()} if self.z0.any() else {}
        return {
            "kind": self.kind,
            "p0": self.p0,
            "p": self.p.tolist(),
            "r": self.r.tolist(),
            **memory,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> PrandtlIshlinskii:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, required=("p", "r", "p0"), optional=("z0",)))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("pi", (self.p0, *self.p.tolist(), *self.r.tolist())),)

    def _merged(self) -> tuple[float, Array, Array, Array]:
        """Linear part, weights, thresholds and memory with plays of one threshold taken together.

        A play of threshold 0 is the input itself, whatever its memory, and joins the linear part.
        """
        r, first, place = np.unique(self.r, return_index=True, return_inverse=True)
        p = np.zeros(r.size)
        with np.errstate(over="ignore"):
            np.add.at(p, place, self.p)
        linear = int(r.size > 0 and r[0] == 0.0)
        p0 = self.p0 + float(p[:linear].sum())
        return p0, p[linear:], r[linear:], self.z0[first][linear:]

    def _is_monotone(self) -> bool:
        if self.p0 >= 0.0 and not (self.p < 0.0).any():
            return True
        p0, p, _, _ = self._merged()
        return bool(cumulative(p0, p).min() >= 0.0) and self._has_admissible_memory()

    def _has_admissible_memory(self) -> bool:
        """Neighbouring plays differ by no more than their thresholds."""
        r, z = self.r[self.r > 0.0], self.z0[self.r > 0.0]
        with np.errstate(over="ignore"):
            # What rounding may add to a memory that an earlier run has left.
            slack = 1e-12 * (np.abs(z).max(initial=0.0) + np.abs(r).max(initial=0.0))
            return bool((np.abs(np.diff(z)) <= np.diff(r) + slack).all())

    def _require_invertible(self) -> None:
        p0, p, r, _ = self._merged()
        linear = int((self.r == 0.0).sum())
        if p0 <= rounding_of_cumulative(self.p0, self.p[:linear])[-1]:
            what = "p0" if linear == 0 else f"the linear part p0 + p[1] + .. + p[{linear}]"
            raise NotInvertibleError(
                f"{what} is {p0:.6g}: without a positive linear part the output rests while the "
                "input turns; identify or give p0 > 0"
            )
        slopes = cumulative(p0, p)
        refuse_overflow(slopes)
        wrong = np.flatnonzero(slopes <= rounding_of_cumulative(p0, p))
        if wrong.size:
            j = int(wrong[0])
            last = int(np.flatnonzero(self.r == r[j - 1])[-1]) + 1
            raise NotInvertibleError(
                f"the cumulative weight p0 + p[1] + .. + p[{last}] is {slopes[j]:.6g}: beyond "
                f"threshold r[{last}] = {r[j - 1]:.6g} the output would not rise with the input; "
                f"p[{last}] = {self.p[last - 1]:.6g} is too small"
            )
        if not self._has_admissible_memory():
            raise NotInvertibleError(
                "z0 is no memory that an input could have left (neighbouring plays differ by more "
                "than their thresholds); give an admissible z0"
            )
