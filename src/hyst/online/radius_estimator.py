"""Radii of plays whose weights are known, estimated while the system runs."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import one_each
from hyst.checks.numbers import as_not_negative, as_positive, as_sample_time, given_or
from hyst.errors import InputError
from hyst.models import PrandtlIshlinskii
from hyst.online.checks import memory_from, memory_or_none, sample, samples_of
from hyst.online.estimator_file import Saved, check_saved_radii, restored_state
from hyst.online.joint.excitation import Excitation, watch
from hyst.online.joint.prior import covariance_of
from hyst.online.trajectory import Trajectory
from hyst.operators import ModelDescription
from hyst.signals import Record

Array = NDArray[np.float64]

# Places of the scalars in the state, as radius_estimator.h has them.
_ERROR, _SLOPE, _REGIME, _UPDATES, _SKIPPED = 0, 1, 2, 3, 4
_TOLERANCES = {"gradient": 1.0, "least-squares": 0.25}


@final
class RadiusEstimator(Saved):
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

    Raises
    ------
    InputError
        If lengths differ, a weight is negative, radii are not ascending, the gain is so large that
        the gradient would diverge (``dt sum(gain p^2) >= 2``), or a number is out of range.

    Notes
    -----
    S2 eqs. 17-26, NOTES on the collapse of its 18 cases in ``docs/online.md``. The regime comes
    from the measured slope, which noise hides: see ``JointEstimator`` for one that needs no slope.

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
    ) -> None:
        start = PrandtlIshlinskii(p, r, p0, z0)
        n = start.p.size
        if (start.p < 0.0).any():
            worst = int(np.argmin(start.p))
            raise InputError(
                f"p[{worst + 1}] is {start.p[worst]:.6g}; slopes tell regimes apart only where "
                "every weight is positive, so use the joint estimator"
            )
        self.description = ModelDescription()
        """What the numbers of its model mean."""
        self.dt = as_sample_time(dt)
        gains = one_each(gain, n, "gain", "play")
        if (gains < 0.0).any():
            raise InputError(f"gain has the entry {gains.min():.6g}; give gains of at least 0")
        largest = float(start.r[-1]) if n else 0.0
        bound = 1e3 * largest or 1e9 if most_radius is None else most_radius
        if as_positive(bound, "most_radius", "a radius") < largest:
            raise InputError(
                f"most_radius is {bound:.6g}, but the start has r[{n}] = {largest:.6g}; raise the "
                "bound or start below it"
            )
        self._settings: dict[str, Any] = {
            "p": start.p.tolist(),
            "r": start.r.tolist(),
            "gain": gains.tolist(),
            "dt": self.dt,
            "p0": start.p0,
            "method": method,
            "memory": memory_or_none(memory),
            "filter_time": as_not_negative(filter_time, "filter_time"),
            "dead_time": as_not_negative(dead_time, "dead_time"),
            "dead_band": as_not_negative(dead_band, "dead_band"),
            "tolerance": _tolerance(tolerance, method),
            "most_radius": float(bound),
            "z0": start.z0.tolist(),
        }
        self._p, self._p0 = start.p, start.p0
        self._core = self._new_core(gains)
        self._at = self._core.places()
        self.state = np.zeros(self._at["length"])
        self.state[self._at["r"] : self._at["r"] + n] = start.r
        self._core.start(self.state, start.z0)

    @property
    def radii(self) -> Array:
        """The estimate, shape (n,)."""
        first = self._at["r"]
        return self.state[first : first + self._p.size].copy()

    @property
    def model(self) -> PrandtlIshlinskii:
        """The estimate as a model, without memory."""
        return PrandtlIshlinskii(self._p, self.radii, self._p0).with_description(self.description)

    @property
    def standard_errors(self) -> Array:
        """Shape (n,): in units of the noise's deviation; NaN for the gradient."""
        if self._settings["method"] == "gradient":
            return np.full(self._p.size, np.nan)
        d, u, n = self._at["d"], self._at["u"], self._p.size
        return np.sqrt(
            np.diag(covariance_of(self.state[d:u], self.state[u : u + n * (n - 1) // 2]))
        )

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
        """Samples used, and samples skipped because they were not finite or led to an overflow."""
        return {"used": int(self.state[_UPDATES]), "skipped": int(self.state[_SKIPPED])}

    def excitation(self, patience: float, swing: float) -> Excitation:
        """Say what the recent input tells about the radii.

        Parameters
        ----------
        patience
            Seconds after which a play that has not gone to its other envelope counts as frozen.
        swing
            Range of the recent input.

        Returns
        -------
        Excitation

        Raises
        ------
        InputError
            If ``patience`` is not a number above 0, or ``swing`` not one of at least 0.
        """
        patience = as_positive(patience, "patience", "seconds, or infinity", infinite=True)
        swing = as_not_negative(swing, "swing")
        age = self.state[self._at["age"] : self._at["d"]]
        return watch(self._p0, self._p, self.radii, age, patience / self.dt, swing)

    def update(self, u: float, y: float) -> bool:
        """Take in one sample.

        Parameters
        ----------
        u, y
            Input and measured output; one that is not finite is skipped and counted.

        Returns
        -------
        bool
            Whether the radii were updated: not at the first sample, not during dead time, not where
            the slope fits no regime.
        """
        return self._core.step(self.state, *sample(u, y))

    def run(self, record: Record, every: int = 1) -> Trajectory:
        """Take in a whole record.

        Parameters
        ----------
        record
            Of the estimator's sample time.
        every
            Keep the estimate after every so many samples.

        Returns
        -------
        Trajectory

        Raises
        ------
        InputError
            If it is no record or its sample time is another one, or ``every`` is not a whole number
            above 0.
        """
        u, y, time = samples_of(record, self.dt, every)
        n = self._p.size
        r, error = np.empty((time.size, n)), np.empty(u.size)
        self._core.run(self.state, u, y, every, r, error)
        names = tuple(f"r[{i}]" for i in range(1, n + 1))
        return Trajectory(time, names, r, np.full(r.shape, np.nan), error)

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""
        return dict(self._settings), self.state.copy()

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> RadiusEstimator:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        given = dict(settings)
        estimator = cls(memory=memory_from(given), **given)
        restored_state(estimator.state, state)
        check_saved_radii(estimator.radii, estimator._settings["most_radius"])
        return estimator

    def _new_core(self, gains: Array) -> _engine.RadiusEstimation:
        settings = self._settings
        is_gradient = settings["method"] == "gradient"
        if not is_gradient and settings["method"] != "least-squares":
            raise InputError(
                f"method is {settings['method']!r}; choose 'gradient' or 'least-squares'"
            )
        speed = self.dt * float(gains @ self._p**2)
        if is_gradient and speed >= 2.0:
            raise InputError(
                f"dt sum(gain p^2) is {speed:.6g}, at which the gradient diverges; keep it below 2"
            )
        core = _engine.RadiusEstimation(
            self._p0, self._p.tolist(), (gains * self.dt).tolist(), gains.tolist()
        )
        memory = settings["memory"]
        kept = 1.0 if memory is None else max(1.0 - self.dt / memory, 0.5)
        core.set_method(not is_gradient, kept**-0.5, settings["most_radius"])
        filter_time = settings["filter_time"]
        core.set_slope_filter(
            math.exp(-self.dt / filter_time) if filter_time > 0.0 else 0.0,
            round(settings["dead_time"] / self.dt),
            settings["dead_band"],
            settings["tolerance"],
        )
        return core


def _tolerance(given: float | None, method: str) -> float:
    share = given_or(given, _TOLERANCES.get(method, 1.0))
    return as_positive(share, "tolerance", "a share", most=1.0)
