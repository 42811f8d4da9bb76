"""The rate-dependent Prandtl-Ishlinskii model and its explicit, approximate inverse."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants, one_record, refuse_overflow
from hyst.checks.numbers import as_number, as_sample_time
from hyst.checks.thresholds import as_weights_and_thresholds, require_memory
from hyst.errors import NotInvertibleError
from hyst.models.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.models.rate_curve import RateCurve
from hyst.models.rate_preview import MOST_PLANNED, RateDependentPreview
from hyst.operators.base import Operator
from hyst.operators.cumulative_weights import cumulative, rounding_of_cumulative
from hyst.operators.inequalities import Inequalities, of_bounds, of_plays, side_by_side
from hyst.operators.parameters import Parameters, as_parameter_vector, parameters_of_plays
from hyst.operators.portrait import Portrait
from hyst.operators.registry import delayed, entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@register
@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class RateDependentPrandtlIshlinskii(Operator):
    """Prandtl-Ishlinskii model whose thresholds grow with the rate of its input.

        y_k = p0 u_k + sum_i p_i z_i,   z_i: play of threshold r_i + g(|u_k - u_{k-1}| / dt)

    with ``g(x) = beta x``, or any ``RateCurve``. The rate of the very first sample is 0, as if the
    input had rested at it; plays are where ``z0`` says.

    Parameters
    ----------
    p
        Shape (n,), weights of the plays, output units per input unit, any sign.
    r
        Shape (n,), thresholds at rest ``0 <= r_1 <= ... <= r_n``, input units.
    beta
        Widening of every threshold per rate of the input, >= 0, seconds; or a ``RateCurve``.
    dt
        Sample time, > 0, seconds.
    p0
        Weight of the input itself, output units per input unit.
    z0
        Shape (n,), play outputs before the first sample, input units, neighbours no further apart
        than their thresholds (S4 eq. 8); zeros if left out.

    Raises
    ------
    InputError
        If lengths differ, thresholds are negative or unsorted (their distances are what must not
        shrink), beta is negative, dt is not positive, neighbours of ``z0`` are too far apart, or a
        constant is not finite.

    Notes
    -----
    S4 eqs. 4, 6, 19, 24 and 34-38. Its state is the play outputs, the previous input, and 1 once
    there is a previous input. It has no exact inverse unless beta is 0: see
    ``explicit_inverse`` and ``hyst.compensation.invert_trajectory``.

    Examples
    --------
    >>> model = RateDependentPrandtlIshlinskii([1.0], [1.0], beta=0.01, dt=0.1, p0=0.5)
    >>> model([0.0, 10.0, 10.0, 0.0])
    array([ 0., 13., 14.,  2.])
    """

    p: Array
    r: Array
    beta: float
    sample_time: float
    p0: float
    z0: Array
    rate_curve: RateCurve

    kind = "rate-dependent-prandtl-ishlinskii"

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        beta: float | RateCurve,
        dt: float,
        p0: float = 0.0,
        z0: ArrayLike | None = None,
    ) -> None:
        weights, thresholds = as_weights_and_thresholds(p, r)
        curve = beta if isinstance(beta, RateCurve) else RateCurve(beta)
        memory = as_constants(np.zeros(weights.size) if z0 is None else z0, "z0")
        require_memory(memory, thresholds)
        object.__setattr__(self, "p", weights)
        object.__setattr__(self, "r", thresholds)
        object.__setattr__(self, "beta", curve.beta)
        object.__setattr__(self, "sample_time", as_sample_time(dt))
        object.__setattr__(self, "p0", as_number(p0, "p0"))
        object.__setattr__(self, "z0", as_constants(memory + 0.0, "z0"))
        object.__setattr__(self, "rate_curve", curve)

    @property
    def dt(self) -> float:
        """The sample time, seconds."""
        return self.sample_time

    def __repr__(self) -> str:
        curve = self.beta if self.rate_curve.is_linear else self.rate_curve
        return (
            f"RateDependentPrandtlIshlinskii(p={self.p!r}, r={self.r!r}, beta={curve!r}, "
            f"dt={self.dt!r}, p0={self.p0!r}, z0={self.z0!r})"
        )

    def at_sample_time(self, dt: float) -> RateDependentPrandtlIshlinskii:
        """Give the same model for records of another sample time: rates are in seconds."""
        if dt == self.dt:
            return self
        return RateDependentPrandtlIshlinskii(self.p, self.r, self.rate_curve, dt, self.p0, self.z0)

    def at_rest(self) -> PrandtlIshlinskii:
        """Give the rate-independent model that this one becomes at low rates (S4 eq. 26).

        Returns
        -------
        PrandtlIshlinskii
        """
        return PrandtlIshlinskii(self.p, self.r, self.p0, self.z0)

    def thresholds(self, u: ArrayLike) -> Array:
        """Give the thresholds that an input causes, for every sample.

        Parameters
        ----------
        u
            Shape (N,), finite, input units.

        Returns
        -------
        numpy.ndarray
            Shape (N, n), input units; the first row is at rest.

        Raises
        ------
        InputError
            If ``u`` is not one record of finite numbers.
        """
        signal = one_record(u)
        widening = self.rate_curve(np.diff(signal, prepend=signal[0]) / self.dt)
        return np.asarray(widening[:, None] + self.r)

    def sample_equation_slope(self) -> float:
        """Give the least slope of the output over the sample's own input, output per input unit.

        ``p0 + (1 - g'/dt) sum_i max(p_i, 0)`` with g' the steepest slope of the rate curve. Where
        it is not positive, one sample can ask for an output that several inputs give, and the
        exact solution sample by sample chatters between fast and slow.

        Returns
        -------
        float
        """
        ratio = self.rate_curve.steepest() / self.dt
        rising = float(np.maximum(self.p, 0.0).sum())
        return self.p0 + (1.0 - ratio) * rising if rising else self.p0

    def traits(self) -> Traits:
        """Give the traits; with a rate that counts none of those of plays is left."""
        plain = self.rate_curve.is_zero or self.p.size == 0
        return Traits(
            memoryless=self.p.size == 0,
            rate_independent=Degree.EXACTLY if plain else Degree.NO,
            return_point_memory=plain,
            congruent_loops=plain,
            monotone=lambda: plain and self.at_rest().traits().monotone,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give the initial play outputs and that there is no previous input, shape (n + 2,)."""
        return np.concatenate([self.z0, np.zeros(2)])

    def exact_inverse(self) -> Operator:
        """Give the exact inverse where there is one: for beta = 0.

        Raises
        ------
        NotInvertibleError
            If beta is not 0: the thresholds follow the rate of the drive, which is what an inverse
            has yet to find. If beta is 0, as for ``PrandtlIshlinskii``.
        """
        if not self.rate_curve.is_zero:
            raise NotInvertibleError(
                f"beta is {self.beta:.6g}: the thresholds follow the rate of the drive, which an "
                "inverse does not know before it has found the drive; use inverse(preview=20), "
                "hyst.compensation.invert_trajectory, or explicit_inverse() and its error"
            )
        return self.at_rest().inverse()

    def preview_range(self) -> tuple[int, int]:
        """Give 1 to 60 samples, or none for beta = 0.

        Raises
        ------
        NotInvertibleError
            If p0 or a cumulative weight is not positive.
        """
        if self.rate_curve.is_zero:
            return super().preview_range()
        self.explicit_inverse()
        return 1, MOST_PLANNED

    def preview_inverse(self, samples: int) -> Operator:
        """Give commands planned ahead, which is no exact inverse, unless beta is 0.

        Raises
        ------
        NotInvertibleError
            If p0 or a cumulative weight is not positive, or the preview is 0.
        """
        if self.rate_curve.is_zero:
            return super().preview_inverse(samples)
        if samples == 0:
            raise NotInvertibleError(
                f"beta is {self.beta:.6g}: an inverse has to know at least 1 of the next samples, "
                "better 20; without a preview there is explicit_inverse() and its error"
            )
        used = min(samples, MOST_PLANNED)
        inverse = RateDependentPreview(self, used)
        return inverse if used == samples else delayed(inverse, samples - used)

    def explicit_inverse(self) -> RateDependentPrandtlIshlinskii:
        """Give the explicit inverse: exact only where both see the same thresholds over time.

        With ``c_j = p0 + p_1 + .. + p_j``: weights ``1/p0`` and ``1/c_j - 1/c_{j-1}``, thresholds
        ``s_j = s_{j-1} + c_{j-1} (r_j - r_{j-1})``, rate curve ``p0 g``, memory
        ``d_j = d_{j-1} + c_{j-1} (x_j - x_{j-1})`` of the distances from the input. It takes the
        rate of the reference for that of the drive, so it leaves an error; simulate it.

        Returns
        -------
        RateDependentPrandtlIshlinskii
            A causal operator from wanted output to drive.

        Raises
        ------
        NotInvertibleError
            If p0 or a cumulative weight is not positive, or a constant overflows.

        Notes
        -----
        S4 eqs. 12-16; eq. 16 must start with ``y_1 = a0 x_1``, as eq. 18 does.
        """
        slopes = cumulative(self.p0, self.p)
        wrong = np.flatnonzero(slopes <= rounding_of_cumulative(self.p0, self.p))
        if wrong.size:
            j = int(wrong[0])
            which = "p0" if j == 0 else f"the cumulative weight p0 + p[1] + .. + p[{j}]"
            raise NotInvertibleError(
                f"{which} is {slopes[j]:.6g}: the output would not rise with the input; "
                "identify or give weights whose sums from p0 on are positive"
            )
        with np.errstate(all="ignore"):
            weights = -(self.p / slopes[1:]) / slopes[:-1]
            thresholds = np.cumsum(slopes[:-1] * np.diff(self.r, prepend=0.0))
            beyond = np.cumsum((self.p * self.z0)[::-1])[::-1] - self.p * self.z0
            memory = slopes[1:] * self.z0 + beyond
            g0 = 1.0 / np.float64(self.p0)
        refuse_overflow(g0, weights, thresholds, memory)
        return RateDependentPrandtlIshlinskii(
            weights, thresholds, self.rate_curve.scaled(self.p0), self.dt, float(g0), memory
        )

    def causal_inverse(self, state: Array) -> tuple[Operator, Array]:
        """Give the explicit inverse and its memory: that of the distances, and the last output."""
        inverse, n = self.explicit_inverse(), self.p.size
        z, slopes = state[:n], cumulative(self.p0, self.p)[1:]
        beyond = np.cumsum((self.p * z)[::-1])[::-1] - self.p * z
        last = self.p0 * state[n] + float(self.p @ z)
        return inverse, np.concatenate([slopes * z + beyond, [last, state[n + 1]]])

    def parameters(self) -> Parameters:
        """Give p0, the weights, the thresholds, then beta and what else the rate curve has."""
        plays = parameters_of_plays(self.p0, self.p, self.r)
        rate = self.rate_curve.parameters()
        return Parameters(
            values=np.concatenate([plays.values, rate.values]),
            names=plays.names + rate.names,
            lower=np.concatenate([plays.lower, rate.lower]),
            upper=np.concatenate([plays.upper, rate.upper]),
        )

    def inequalities(self) -> Inequalities:
        """Give radii that do not fall, cumulative weights above 0, and the rate curve's bounds."""
        rate = self.rate_curve.parameters()
        plays = of_plays(self.p0, self.p)
        return side_by_side([plays, of_bounds(rate)])

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the vector with radii that do not fall."""
        n = self.p.size
        nearest = theta.copy()
        nearest[n + 1 : 2 * n + 1] = np.maximum.accumulate(theta[n + 1 : 2 * n + 1])
        return nearest

    def with_parameters(self, theta: Sequence[float] | Array) -> RateDependentPrandtlIshlinskii:
        """Give a model with other constants and the same sample time, knees and initial memory."""
        n = self.p.size
        vector = as_parameter_vector(theta, 1 + 2 * n + len(self.rate_curve.parameters()))
        curve = self.rate_curve.with_parameters(vector[2 * n + 1 :])
        p, r = vector[1 : n + 1], vector[n + 1 : 2 * n + 1]
        return RateDependentPrandtlIshlinskii(p, r, curve, self.dt, float(vector[0]), self.z0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of p0, p, r and the rate curve's coefficients."""
        n, curve = self.p.size, self.rate_curve
        plays = np.repeat([output_scale / input_scale, input_scale], [n + 1, n])
        powers = input_scale ** -np.arange(1.0, curve.powers.size + 1.0)
        return np.concatenate([plays, [1.0], powers, np.ones(curve.slopes.size)])

    def in_units(self, input_scale: float, output_scale: float) -> RateDependentPrandtlIshlinskii:
        """Give the model in other units, knees and memory too."""
        n, curve = self.p.size, self.rate_curve
        scales = self.parameter_scales(input_scale, output_scale)
        plays = scales[: 2 * n + 1] * self.parameters().values[: 2 * n + 1]
        powers = scales[2 * n + 2 : 2 * n + 2 + curve.powers.size] * curve.powers
        widened = RateCurve(curve.beta, powers, curve.slopes, curve.knees * input_scale)
        return RateDependentPrandtlIshlinskii(
            plays[1 : n + 1],
            plays[n + 1 :],
            widened,
            self.dt,
            float(plays[0]),
            self.z0 * input_scale,
        )

    def portrait(self) -> Portrait:
        """Show the plays at rest."""
        return self.at_rest().portrait()

    def lipschitz_constant(self) -> float:
        """Give ``|p0| + sum |p_i| (1 + 2 g'/dt)``, g' the largest slope of g in size."""
        size = float(np.abs(self.p).sum())
        widening = 2.0 * self.rate_curve.lipschitz_constant() / self.dt
        return abs(self.p0) + size * (1.0 + widening) if size else abs(self.p0)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, constants and, where there is one, the initial memory."""
        memory = {"z0": self.z0.tolist()} if self.z0.any() else {}
        return {
            "kind": self.kind,
            "p0": self.p0,
            "p": self.p.tolist(),
            "r": self.r.tolist(),
            **self.rate_curve.to_dict(),
            "dt": self.dt,
            **memory,
        }

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> RateDependentPrandtlIshlinskii:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        further = ("powers", "slopes", "knees")
        given = entries(data, required=("p", "r", "p0", "beta", "dt"), optional=("z0", *further))
        curve = RateCurve(given.pop("beta"), **{key: given.pop(key, ()) for key in further})
        return cls(beta=curve, **given)

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        curve = self.rate_curve
        plays = (self.p0, *self.p.tolist(), *self.r.tolist())
        growth = (curve.beta, *curve.powers.tolist(), *curve.slopes.tolist())
        return (
            Stage(
                "rate_dependent_pi",
                plays + growth,
                fixed={"knees": tuple(curve.knees.tolist())},
                choices={"plays": self.p.size, "powers": curve.powers.size},
                dt=self.dt,
            ),
        )
