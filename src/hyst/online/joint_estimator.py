"""Weights, radii, offset and maps, estimated together while the system runs."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.errors import InputError
from hyst.online.checks import (
    finite_or_none,
    given_or,
    patience_in_samples,
    positive,
    samples_of,
)
from hyst.online.excitation import Excitation, watch
from hyst.online.parts import take_apart
from hyst.online.prior import covariance_of, factors, start_covariance
from hyst.online.saving import restored_state, save_estimator
from hyst.online.start import check_saved, checked_start
from hyst.online.trajectory import Trajectory
from hyst.operators import Operator
from hyst.operators.registry import operator_from_dict
from hyst.signals import Record
from hyst.signals.vector import finite_vector

Array = NDArray[np.float64]

_GROUPS = ("p0", "p", "r", "offset", "front", "back")
_LINEAR_TERMS = ("front[1]", "back[1]")
# Places of the scalars in the state, as joint_estimator.h has them.
_ERROR, _VARIANCE, _NOISE, _UPDATES, _SKIPPED, _REFUSED, _RANGES = 0, 1, 2, 5, 6, 7, 8
_NOISE_SAMPLES = 150.0


@final
class JointEstimator:
    """Estimate a Prandtl-Ishlinskii model sample by sample: recursive prediction error method.

    With theta the parameters, ``e = y - model(u)`` and ``psi = dy/dtheta`` along the estimate's own
    memory: ``theta += P psi e / (psi' P psi + noise)``, P the covariance of an extended Kalman
    filter with forgetting. After every sample the model can be inverted: the estimate is projected
    onto ``p0 >= least_slope``, cumulative weights within ``[least_slope, most_slope]`` and ``0 <=
    r_1 <= .. <= r_n <= most_radius``. A sample that is not finite is skipped and counted.

    Parameters
    ----------
    model
        Where to start: ``PrandtlIshlinskii``, or the generalized or modified model of dead-zone
        maps, with a gain and offset at either end. A ``p0`` below ``least_slope`` starts from
        there.
    dt
        Sample time, seconds; 1 counts times in samples.
    memory
        Seconds over which the past is forgotten while the input moves; infinite for constants that
        do not drift.
    radius_spread, weight_spread
        How far off the start is believed to be: standard errors of the gaps between radii and of
        the weights over their values. They are also what variances never exceed.
    noise
        Standard deviation of the output's noise to start from; it is estimated. Left out: half the
        height of the widest loop, ``sum(|p| r)``.
    held
        What not to estimate: names of parameters (``"p[2]"``) or of groups (``"p0"``, ``"p"``,
        ``"r"``, ``"offset"``, ``"front"``, ``"back"``). Maps are held unless ``estimate_maps``;
        their linear term always is, since the weights already have their scale.
    estimate_maps
        Whether the weights of the dead-zone maps are estimated.
    least_slope, most_slope
        Bounds of the cumulative weights; a millionth and a thousand times their sum if left out.
    most_radius
        Upper bound of the radii, input units of the plays; a thousand times the largest if left
        out.
    patience
        Seconds after which a play that has not gone from one envelope to the other is frozen;
        ``memory`` if that is finite, else 10,000 samples.

    Raises
    ------
    InputError
        If the model is built otherwise, bounds contradict each other or the start, or a number is
        out of range.
    NotInvertibleError
        If the start cannot be inverted, for another reason than a small p0.

    Notes
    -----
    S2 sec. VI names this as future work. Ljung and Söderström, Theory and Practice of Recursive
    Identification (1983), ch. 3; Bierman, Factorization Methods (1977), ch. V.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> truth = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    >>> u = 4.0 * np.sin(np.arange(2000) / 20.0)
    >>> estimator = JointEstimator(PrandtlIshlinskii(p=[0.7], r=[1.4], p0=0.8))
    >>> for u_k, y_k in zip(u, truth(u)):
    ...     _ = estimator.update(u_k, y_k)
    >>> estimator.model.stages[0].r.round(4)
    array([1.])
    """

    def __init__(
        self,
        model: Operator,
        *,
        dt: float = 1.0,
        memory: float = math.inf,
        radius_spread: float = 0.5,
        weight_spread: float = 0.3,
        noise: float | None = None,
        held: Iterable[str] = (),
        estimate_maps: bool = False,
        least_slope: float | None = None,
        most_slope: float | None = None,
        most_radius: float | None = None,
        patience: float | None = None,
    ) -> None:
        self._parts = take_apart(model)
        self.dt = positive(dt, "dt", "the time between samples in seconds")
        theta = self._parts.theta()
        total = float(np.abs(theta[: 1 + self._parts.pi.p.size]).sum())
        radius = float(self._parts.pi.r[-1]) if self._parts.pi.r.size else 1.0
        loop = float(np.abs(self._parts.pi.p) @ self._parts.pi.r)
        patience_samples = patience_in_samples(patience, memory, self.dt)
        self.settings: dict[str, Any] = {
            "model": model.to_dict(),
            "dt": self.dt,
            "memory": finite_or_none(positive(memory, "memory", "seconds, or infinity", True)),
            "radius_spread": positive(radius_spread, "radius_spread", "a share"),
            "weight_spread": positive(weight_spread, "weight_spread", "a share"),
            "noise": positive((loop or total) if noise is None else noise, "noise", "a deviation"),
            "held": sorted(held),
            "estimate_maps": bool(estimate_maps),
            "least_slope": positive(given_or(least_slope, 1e-6 * total), "least_slope", "a slope"),
            "most_slope": positive(given_or(most_slope, 1e3 * total), "most_slope", "a slope"),
            "most_radius": positive(
                given_or(most_radius, 1e3 * radius or 1.0), "most_radius", "a radius"
            ),
            "patience": patience_samples * self.dt,
        }
        self._theta_at_start = checked_start(self._parts, theta, self.settings)
        prior = self._prior(self._theta_at_start)
        self._core = self._new_core(np.diag(prior), patience_samples)
        self._at = self._core.places()
        self.state = np.zeros(self._at["length"])
        self._begin(prior)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the m parameters."""
        return self._parts.names()

    @property
    def parameters(self) -> Array:
        """The estimate, shape (m,); the offset in output units of the plays."""
        return self.state[self._at["theta"] : self._at["d"]].copy()

    @property
    def covariance(self) -> Array:
        """Covariance of the estimate, shape (m, m)."""
        d, u = self._at["d"], self._at["u"]
        return covariance_of(self.state[d:u], self.state[u : self._at["z"]])

    @property
    def standard_errors(self) -> Array:
        """Standard errors of the estimate, shape (m,); 0 for what is held."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def model(self) -> Operator:
        """The estimate as a model, with the memory that the input has left."""
        z = self.state[self._at["z"] : self._at["side"]]
        return self._parts.assemble(self.parameters, z)

    @property
    def error(self) -> float:
        """Measured less predicted output of the last sample used, output units."""
        return float(self.state[_ERROR]) * self._parts.after.gain

    @property
    def noise(self) -> float:
        """Estimated standard deviation of the output's noise, output units."""
        return math.sqrt(float(self.state[_NOISE])) * abs(self._parts.after.gain)

    @property
    def counts(self) -> dict[str, int]:
        """Samples used, skipped as not finite, and refused because of an overflow."""
        places = {"used": _UPDATES, "skipped": _SKIPPED, "refused": _REFUSED}
        return {name: int(self.state[place]) for name, place in places.items()}

    @property
    def excitation(self) -> Excitation:
        """What the recent input tells about the radii, what is frozen, and why."""
        n, theta, at = self._parts.pi.p.size, self.parameters, self._at
        age = self.state[at["age"] : at["home"]]
        return watch(
            float(theta[0]),
            theta[1 : n + 1],
            theta[n + 1 : 2 * n + 1],
            age,
            self.settings["patience"] / self.dt,
            float(
                self.state[_RANGES : _RANGES + 4].max() - self.state[_RANGES : _RANGES + 4].min()
            ),
        )

    def update(self, u: float, y: float) -> bool:
        """Take in one sample.

        Parameters
        ----------
        u, y
            Input and measured output; one that is not finite is skipped and counted.

        Returns
        -------
        bool
            Whether the sample was used.
        """
        before, after = self._parts.before, self._parts.after
        v = float(u) if before is None else before.gain * float(u) + before.offset
        return self._core.step(self.state, v, float(y) / after.gain) == 0

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
            If the sample time is another one, or ``every`` is not a whole number above 0.
        """
        u, y = samples_of(record, self.dt)
        if not isinstance(every, int) or every < 1:
            raise InputError(f"every is {every!r}; give a whole number of samples, 1 or more")
        before, after = self._parts.before, self._parts.after
        v = u if before is None else before.gain * u + before.offset
        rows, m = u.size // every, self._at["m"]
        theta, variance, error = np.empty((rows, m)), np.empty((rows, m)), np.empty(u.size)
        self._core.run(self.state, v, y / after.gain, every, theta, variance, error)
        time = np.asarray(self.dt * (np.arange(1, rows + 1) * every - 1.0))
        errors = np.sqrt(np.maximum(variance, 0.0))
        return Trajectory(time, self.names, theta, errors, error * after.gain)

    def follow(self, u: ArrayLike) -> None:
        """Let the memory follow inputs whose outputs were not measured; learns nothing.

        Parameters
        ----------
        u
            Shape (N,), what the actuator has passed, finite.

        Raises
        ------
        InputError
            If it is not a finite vector.
        """
        before = self._parts.before
        for u_k in finite_vector(u, "u").tolist():
            v = u_k if before is None else before.gain * u_k + before.offset
            self._core.follow(self.state, v)

    def command(self, y_ref: float) -> float:
        """Give the input for which the present estimate predicts a wanted output; learns nothing.

        Parameters
        ----------
        y_ref
            Wanted output; NaN gives NaN.

        Returns
        -------
        float
        """
        before, after = self._parts.before, self._parts.after
        v = self._core.command(self.state, float(y_ref) / after.gain)
        return v if before is None else (v - before.offset) / before.gain

    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and widen all variances again.

        Parameters
        ----------
        model
            Parameters to go on from, of a model like the one at the start; those if left out.
        """
        at = self._at
        kept = self.state.copy()
        if model is not None:
            self._theta_at_start = checked_start(
                self._parts, take_apart(model).theta(), self.settings
            )
        self._begin(self._prior(self._theta_at_start))
        for first, last in ((3, 13), (at["side"], at["psi"])):
            self.state[first:last] = kept[first:last]
        self._core.remember(self.state)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write settings and state, every double exact; ``load_estimator`` continues from them.

        Parameters
        ----------
        path
            The file to create or replace.
        """
        state = self.state.copy()
        scratch = state[self._at["psi"] :]
        # A refused sample leaves NaN there; the next one overwrites it before reading.
        scratch[~np.isfinite(scratch)] = 0.0
        save_estimator(path, "joint", self.settings, state)

    @classmethod
    def restore(cls, settings: dict[str, Any], state: list[float]) -> JointEstimator:
        """Rebuild an estimator from what ``save`` wrote.

        Parameters
        ----------
        settings, state
            As in the file.

        Raises
        ------
        InputError
            If the state does not fit the settings, or holds an inadmissible estimate.
        """
        given = dict(settings)
        memory = given.pop("memory")
        model = operator_from_dict(given.pop("model"))
        estimator = cls(model, memory=math.inf if memory is None else memory, **given)
        restored_state(estimator.state, state)
        check_saved(estimator._parts, estimator.parameters, estimator.settings)
        return estimator

    def _prior(self, theta: Array) -> Array:
        settings = self.settings
        spreads = settings["radius_spread"], settings["weight_spread"]
        return start_covariance(
            theta, self._parts.pi.p.size, *spreads, settings["noise"], ~self._is_held()
        )

    def _is_held(self) -> NDArray[np.bool_]:
        wanted, names = self.settings["held"], self.names
        unknown = [each for each in wanted if each not in names and each not in _GROUPS]
        if unknown:
            raise InputError(
                f"held names {unknown[0]!r}; there are {', '.join(names)} and the groups "
                f"{', '.join(_GROUPS)}"
            )
        maps = () if self.settings["estimate_maps"] else ("front", "back")
        groups = {*wanted, *maps}
        return np.array(
            [
                name in groups or name.partition("[")[0] in groups or name in _LINEAR_TERMS
                for name in names
            ]
        )

    def _new_core(self, limit: Array, patience: float) -> _engine.JointEstimation:
        parts, settings = self._parts, self.settings
        maps = [[] if m is None else m.thresholds.tolist() for m in (parts.front, parts.back)]
        core = _engine.JointEstimation(parts.pi.p.size, limit.tolist(), maps[0], maps[1], 1e-6, 1e6)
        core.set_bounds(settings["least_slope"], settings["most_slope"], settings["most_radius"])
        memory = settings["memory"]
        forgetting = 0.0 if memory is None else min(self.dt / memory, 0.5)
        least_noise = (1e-10 * settings["noise"]) ** 2
        core.set_memory(forgetting, _NOISE_SAMPLES, least_noise, 1e-14, patience)
        return core

    def _begin(self, prior: Array) -> None:
        at = self._at
        self.state[at["theta"] : at["d"]] = self._theta_at_start
        self.state[at["z"] : at["side"]] = self._parts.pi.z0
        self._core.start(self.state, self.settings["noise"] ** 2)
        d, u = factors(prior)
        self.state[at["d"] : at["u"]] = d
        self.state[at["u"] : at["z"]] = u
