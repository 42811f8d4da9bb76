"""Radii of plays whose weights are known, estimated while the system runs."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_not_negative, as_positive, as_reading, as_sample_time
from hyst.models import PrandtlIshlinskii
from hyst.online.checks import memory_from, sample, samples_of
from hyst.online.estimator import Estimator
from hyst.online.estimator_file import check_saved_radii, restored_state
from hyst.online.joint.excitation import Excitation, watch
from hyst.online.joint.innovation import Innovation
from hyst.online.joint.prior import covariance_of
from hyst.online.knowledge import Knowledge, knowledge_from
from hyst.online.radius.radius_core import (
    checked_settings,
    memory_of,
    new_core,
    radii_of,
    reasons_of,
)
from hyst.online.radius.told_regimes import one_told, told_of
from hyst.online.trajectory import Trajectory
from hyst.operators import Affine, ModelDescription, Operator
from hyst.signals import Record

Array = NDArray[np.float64]

# Places of the scalars in the state, as radius_estimator.h has them.
_ERROR, _SLOPE, _REGIME, _UPDATES, _SKIPPED, _SQUARES, _PRODUCTS, _TOLD = range(8)
_KEPT = slice(8, 19)  # memory of the input and of the slope filter


@final
class RadiusEstimator(Estimator):
    """Estimate the radii of plays of known weights: the law of S2 as one linear regression.

    ``phi' r = s (sum_envelope p u + sum_interior p u_m - y)`` with s the direction of the input,
    u_m the input at the last reversal, ``phi_i = p_i`` for plays on their envelope and ``-p_i``
    inside. The measured slope says which are which: it is ``p0 + p_1 + .. + p_k`` when the first k
    plays are on their envelopes. Gradient: ``dr/dt = gain phi e``; or recursive least squares.
    Either is projected onto ``0 <= r_1 <= .. <= r_n``, the gradient in the metric of its gains.

    Parameters
    ----------
    p
        Shape (n,), weights, at least 0; a play of weight 0 is moved by the order of radii alone. n
        may be 0.
    r
        Shape (n,), radii to start from, ``0 <= r_1 <= ... <= r_n``.
    gain
        Of the gradient, per second: one number or one for each play; the gradient leaves a radius
        of gain 0 where it is. For least squares, the variance of the start in units of the noise's;
        large for a start that is a guess.
    dt
        Sample time, seconds.
    p0
        Weight of the input itself.
    method
        ``"gradient"`` (the paper) or ``"least-squares"``.
    memory
        Seconds over which least squares forgets; infinite for constants that do not drift.
    filter_time
        The slope is the regression of y on u since the last reversal, the past counting less by the
        factor e in this time, seconds; 0 for the difference of two samples, which is exact without
        noise.
    dead_time
        Seconds after a reversal without an update.
    dead_band
        By how much the input must go back for a reversal, input units.
    tolerance
        An update is left out while the slope is farther than this share of half the distance
        between two slopes of the model from the nearest; 1 takes all. Left out: 1 for the gradient,
        which is the paper's, and 0.25 for least squares, to which a sample that straddles two
        regimes does more harm than good.
    most_radius
        Upper bound of the radii, input units.
    z0
        Shape (n,), memory before the first sample; zeros if left out.
    offset
        Of the output, known: it is taken off before the plays are compared with it.

    Raises
    ------
    InputError
        If lengths differ, a weight is negative, radii are not ascending, the gain is so large that
        the gradient would diverge (``dt sum(gain p^2) >= 2``), or a number is out of range.

    Notes
    -----
    S2 eqs. 17-26, NOTES on the collapse of its 18 cases in ``docs/online.md``. The regime comes
    from the measured slope, which noise hides; whoever knows slope or regime better tells it to
    ``update`` or ``run``. See ``JointEstimator`` for one that needs no slope. The gradient has no
    standard errors, so its ``knowledge`` says that nothing is known; least squares has some where
    every regime was told.

    Examples
    --------
    >>> truth = PrandtlIshlinskii(p=[1.0], r=[2.0])
    >>> u = 9.0 * np.sin(np.arange(2000) / 100.0)
    >>> estimator = RadiusEstimator(p=[1.0], r=[0.5], gain=10.0, dt=0.01)
    >>> for u_k, y_k in zip(u, truth(u)):
    ...     _ = estimator.update(u_k, y_k)
    >>> estimator.model.r.round(3)
    array([2.])
    """

    kind: ClassVar[str] = "radius"

    def __init__(
        self,
        p: ArrayLike,
        r: ArrayLike,
        gain: ArrayLike,
        dt: float,
        *,
        p0: float = 0.0,
        method: Literal["gradient", "least-squares"] = "gradient",
        memory: float = math.inf,
        filter_time: float = 0.0,
        dead_time: float = 0.0,
        dead_band: float = 0.0,
        tolerance: float | None = None,
        most_radius: float | None = None,
        z0: ArrayLike | None = None,
        offset: float = 0.0,
    ) -> None:
        start = PrandtlIshlinskii(p, r, p0, z0)
        self.description = ModelDescription()
        """What the numbers of its models mean."""
        self.dt = as_sample_time(dt)
        given = {
            "dt": self.dt,
            "gain": gain,
            "method": method,
            "memory": memory,
            "filter_time": filter_time,
            "dead_time": dead_time,
            "dead_band": dead_band,
            "tolerance": tolerance,
            "most_radius": most_radius,
            "offset": offset,
        }
        self.settings = checked_settings(start, given)
        """What it was made from, as in its file."""
        self._p, self._p0 = start.p, start.p0
        self._core = new_core(self.settings)
        self._at = self._core.places()
        self.state = np.zeros(self._at["length"])
        self._begin(start.r)

    def _begin(self, r: Array) -> None:
        first = self._at["r"]
        self.state[first : first + r.size] = r
        self._core.start(self.state, np.array(self.settings["z0"]))

    @property
    def knows_regimes(self) -> bool:
        """Whether every regime was told, so that none may be wrong by noise in the slope."""
        return bool(self.state[_TOLD] == self.state[_UPDATES])

    def _memory(self) -> Array:
        return memory_of(self.state, self._at, self.radii)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the radii, ``r[1]`` and so on."""
        return tuple(f"r[{i}]" for i in range(1, self._p.size + 1))

    @property
    def parameters(self) -> Array:
        """The estimate, shape (n,); the same as ``radii``."""
        return self.radii

    @property
    def radii(self) -> Array:
        """The estimate, shape (n,)."""
        first = self._at["r"]
        return self.state[first : first + self._p.size].copy()

    @property
    def model(self) -> Operator:
        """The estimate as a model, with the memory that the input has left."""
        plays = PrandtlIshlinskii(
            self._p, self.radii, self._p0, memory_of(self.state, self._at, self.radii)
        )
        offset = self.settings["offset"]
        whole = plays if offset == 0.0 else Affine(1.0, offset) @ plays
        return whole.with_description(self.description)

    @property
    def covariance(self) -> Array:
        """Shape (n, n), by ``noise``; NaN by the gradient and where regimes were measured."""
        n = self._p.size
        if self.settings["method"] == "gradient" or not self.knows_regimes:
            return np.full((n, n), np.nan)
        d, u = self._at["d"], self._at["u"]
        shape = covariance_of(self.state[d:u], self.state[u : u + n * (n - 1) // 2])
        return np.asarray(self.noise**2 * shape)

    @property
    def noise(self) -> float:
        """Root mean square of the last errors (some 150), output units."""
        return math.sqrt(float(self.state[_SQUARES]))

    @property
    def innovation(self) -> Innovation:
        """What the estimate leaves unexplained, and whether that can be noise."""
        square = float(self.state[_SQUARES])
        share = float(self.state[_PRODUCTS]) / square if square > 0.0 else 0.0
        height = 2.0 * float(self._p @ self.radii)
        return Innovation(math.sqrt(square), float(np.clip(share, -1.0, 1.0)), height)

    @property
    def knowledge(self) -> Knowledge:
        """What is known of each radius: nothing by the gradient, bands by least squares."""
        sides = self.state[self._at["side"] : self._at["age"]]
        how = self.settings["method"], not self.knows_regimes
        reasons = reasons_of(self.names, self._p, sides, *how)
        doubt = () if self.innovation.consistent else (f"bands do not hold: {self.innovation}",)
        return knowledge_from(self.names, self.radii, self.standard_errors, reasons, doubts=doubt)

    @property
    def error(self) -> float:
        """Measured less predicted output of the last sample used."""
        return float(self.state[_ERROR])

    @property
    def slope(self) -> float:
        """The filtered slope."""
        return float(self.state[_SLOPE])

    @property
    def regime(self) -> int | None:
        """How many plays the slope says are on their envelopes; None if it fits no regime."""
        return None if self.state[_REGIME] < 0.0 else int(self.state[_REGIME])

    @property
    def counts(self) -> dict[str, int]:
        """Samples ``"used"``, and ``"skipped"`` as not finite or for an overflow."""
        used, skipped = int(self.state[_UPDATES]), int(self.state[_SKIPPED])
        return {"used": used, "skipped": skipped, "refused": 0}

    def excitation(self, patience: float, swing: float) -> Excitation:
        """Say what the recent input tells about the radii.

        Parameters
        ----------
        patience
            Seconds, above 0, after which a play that has not gone to its other envelope is frozen.
        swing
            Range of the recent input, at least 0.

        Returns
        -------
        Excitation
        """
        patience = as_positive(patience, "patience", "seconds, or infinity", infinite=True)
        swing = as_not_negative(swing, "swing")
        age = self.state[self._at["age"] : self._at["d"]]
        return watch(self._p0, self._p, self.radii, age, patience / self.dt, swing)

    def update(
        self, u: float, y: float, slope: float | None = None, regime: float | None = None
    ) -> bool:
        """Take in one sample.

        Parameters
        ----------
        u, y
            Input and measured output; one that is not finite is skipped and counted.
        slope
            dy/du at this sample, where somebody knows it better than two noisy samples tell it; NaN
            where nobody does.
        regime
            Or how many plays are on their envelopes, 0 to n.

        Returns
        -------
        bool
            Whether the radii were updated: not at the first sample, not during dead time, not where
            the slope fits no regime or is told to be unknown while the input moves.

        Raises
        ------
        InputError
            If both are given, or the regime is no whole number from 0 to n.
        """
        u, y = sample(u, y)
        y -= self.settings["offset"]
        if (told := one_told(slope, regime, self._p.size)) is None:
            return self._core.step(self.state, u, y)
        return self._core.step_told(self.state, u, y, *told)

    def run(
        self,
        record: Record,
        every: int = 1,
        *,
        slopes: ArrayLike | None = None,
        regimes: ArrayLike | None = None,
    ) -> Trajectory:
        """Take in a whole record.

        Parameters
        ----------
        record
            Of the estimator's sample time.
        every
            Keep the estimate after every so many samples.
        slopes, regimes
            Shape (N,), one of them as in ``update``; the slope is measured if left out.

        Raises
        ------
        InputError
            If it is no record of this sample time, or slopes or regimes do not fit it.
        """
        u, y, time = samples_of(record, self.dt, every)
        is_slope, told = told_of(slopes, regimes, u.size, self._p.size) or (False, np.empty(0))
        r, error = np.empty((time.size, self._p.size)), np.empty(u.size)
        y, errors = y - self.settings["offset"], np.full(r.shape, np.nan)
        # Standard errors are computed between rows; where there are none, in one go.
        has_errors = self.settings["method"] == "least-squares" and told.size > 0
        rows = every if has_errors else max(u.size, 1)
        for k, first in enumerate(range(0, u.size, rows)):
            part, kept = slice(first, first + rows), slice(k, k + 1) if has_errors else slice(None)
            now = (u[part], y[part], every, r[kept], error[part], is_slope, told[part])
            self._core.run(self.state, *now)
            errors[kept] = self.standard_errors if has_errors else np.nan
        return Trajectory(time, self.names, r, errors, error)

    def follow(self, u: ArrayLike) -> None:
        """Let the memory follow inputs ``u``, shape (N,), whose outputs were not measured."""
        self._core.follow(self.state, finite_vector(u, "u"))

    def command(self, y_ref: float) -> float:
        """Give the input for which the present estimate predicts the output ``y_ref``.

        Raises
        ------
        NotInvertibleError
            If ``p0`` is 0, so that the output rests after a reversal.
        """
        wanted = as_reading(y_ref, "y_ref")
        return wanted if math.isnan(wanted) else float(self.model.inverse().stepper()(wanted))

    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and begin again.

        Parameters
        ----------
        model
            Radii to go on from, of a model of the same weights; those at the start if left out.

        Raises
        ------
        InputError
            If it has other weights or another offset, or a radius above ``most_radius``.
        """
        kept = self.state.copy()
        self._begin(
            np.array(self.settings["r"]) if model is None else radii_of(model, self.settings)
        )
        for part in (_KEPT, slice(self._at["home"], self._at["d"])):
            self.state[part] = kept[part]

    def frozen(self) -> RadiusEstimator:
        """Give an estimator that starts from this estimate and its memory and learns nothing."""
        given = dict(self.settings)
        given |= {
            "r": self.radii,
            "z0": memory_of(self.state, self._at, self.radii),
            "gain": 0.0,
            "method": "gradient",
        }
        frozen = type(self)(memory=memory_from(given), **given)
        frozen.description = self.description
        return frozen

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""
        return dict(self.settings), self.state.copy()

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> RadiusEstimator:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        given = dict(settings)
        estimator = cls(memory=memory_from(given), **given)
        restored_state(estimator.state, state)
        check_saved_radii(estimator.radii, estimator.settings["most_radius"])
        return estimator
