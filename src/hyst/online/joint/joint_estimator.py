"""Weights, radii, offset and maps, estimated together while the system runs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive, as_reading, as_sample_time
from hyst.online.checks import (
    memory_from,
    memory_or_none,
    names_of,
    patience_in_samples,
    sample,
    samples_of,
)
from hyst.online.estimator import Estimator
from hyst.online.estimator_file import check_saved, restored_state
from hyst.online.joint.bands.found import Found
from hyst.online.joint.bands.known import knowledge_of
from hyst.online.joint.bands.of_core import clear_scratch, found_of, take_over
from hyst.online.joint.bands.samples import fold_again, folded_in
from hyst.online.joint.excitation import Excitation, excitation_of
from hyst.online.joint.innovation import Innovation, innovation_of
from hyst.online.joint.joint_core import GROUPS, new_core, prior_of, search_cells
from hyst.online.joint.parts import take_apart
from hyst.online.joint.prior import covariance_of, factors
from hyst.online.joint.start import checked_start, complete_scales
from hyst.online.knowledge import Knowledge
from hyst.online.trajectory import Trajectory
from hyst.operators import Operator
from hyst.operators.registry import operator_from_dict
from hyst.signals import Record

Array = NDArray[np.float64]

# Places of the scalars in the state, as joint_estimator.h has them.
_ERROR, _VARIANCE, _NOISE, _UPDATES, _SKIPPED, _REFUSED = 0, 1, 2, 5, 6, 7
# Ranges of the input; and what is known of the input altogether, which a restart keeps.
_RANGES, _KEPT = slice(8, 12), (3, 13)
_BOUNDS = ("least_slope", "most_slope", "most_radius")


@final
class JointEstimator(Estimator):
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
    search
        Whether other estimates are tried beside this one, which may be in a false minimum: started
        from the weights of many plays of fixed radii, and taken over once their errors are smaller
        beyond doubt. Not done where p0, a weight or a radius is held, or a weight is negative.

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
    >>> estimator.model.parts[0].r.round(4)
    array([1.])
    """

    kind: ClassVar[str] = "joint"

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
        search: bool = True,
    ) -> None:
        self._parts = take_apart(model)
        self.description = model.description.of_estimate()
        """What the numbers of its model mean; those of the start, as far as they still hold."""
        self.dt = as_sample_time(dt)
        self.settings: dict[str, Any] = {
            "model": model.to_dict(),
            "dt": self.dt,
            "memory": memory_or_none(memory),
            "radius_spread": as_positive(radius_spread, "radius_spread", "a share"),
            "weight_spread": as_positive(weight_spread, "weight_spread", "a share"),
            "noise": noise,
            "held": names_of(held, (*self.names, *GROUPS)),
            "estimate_maps": bool(estimate_maps),
            "least_slope": least_slope,
            "most_slope": most_slope,
            "most_radius": most_radius,
            "patience": patience_in_samples(patience, memory, self.dt) * self.dt,
            "search": bool(search),
        }
        theta = self._parts.theta()
        complete_scales(self.settings, theta, self._parts.pi.p.size)
        self._theta_at_start = checked_start(self._parts, theta, self.settings)
        prior = prior_of(self._parts, self._theta_at_start, self.settings)
        limit = np.diag(prior)
        self._cells = search_cells(self._parts, self._theta_at_start, limit, self.settings)
        # Public, for exports take its constants and the places in its state.
        self.core = new_core(self._parts, limit, self._cells, self.settings)
        self._at = self.core.places()
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
    def model(self) -> Operator:
        """The estimate as a model, with the memory that the input has left."""
        z = self.state[self._at["z"] : self._at["side"]]
        return self._parts.assemble(self.parameters, z).with_description(self.description)

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
        age = self.state[self._at["age"] : self._at["home"]]
        swing = float(np.ptp(self.state[_RANGES]))
        return excitation_of(self.parameters, age, self.settings["patience"] / self.dt, swing)

    @property
    def innovation(self) -> Innovation:
        """What the estimate leaves unexplained, and whether that can be noise."""
        n, theta = self._parts.pi.p.size, self.parameters
        height = 2.0 * float(np.abs(theta[1 : n + 1]) @ theta[n + 1 : 2 * n + 1])
        return innovation_of(self.core, self.state, height, abs(self._parts.after.gain))

    @property
    def knowledge(self) -> Knowledge:
        """What is known of each parameter, from all samples; takes up to a second."""
        return knowledge_of(self.names, self.parameters, self._found())

    def refine(self) -> bool:
        """Take the estimate to the least squares over all that was measured, if they are better.

        Least squares start from the estimate and from the best radii on a grid, so that a false
        minimum is left; takes up to a second.

        Returns
        -------
        bool
            Whether the estimate was replaced: where the chi-square of all samples falls by 1.
        """
        found = self._found()
        return found is not None and take_over(self.core, self.state, found, self._theta_at_start)

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
        u, y = sample(u, y)
        return self.core.step(self.state, self._plays_input(u), y / self._parts.after.gain) == 0

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
        gain, shape = self._parts.after.gain, (time.size, self._at["m"])
        theta, variance, error = np.empty(shape), np.empty(shape), np.empty(u.size)
        self.core.run(self.state, self._plays_input(u), y / gain, every, theta, variance, error)
        errors = np.sqrt(np.maximum(variance, 0.0))
        return Trajectory(time, self.names, theta, errors, error * gain)

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
        for v in self._plays_input(finite_vector(u, "u")).tolist():
            self.core.follow(self.state, v)

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
        v = self.core.command(self.state, as_reading(y_ref, "y_ref") / after.gain)
        return v if before is None else (v - before.offset) / before.gain

    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and widen all variances again.

        Parameters
        ----------
        model
            Parameters to go on from, of a model like the one at the start; those if left out.

        Raises
        ------
        InputError
            If it has other stages, thresholds or gains, or starts out of bounds.
        """
        at = self._at
        kept = self.state.copy()
        if model is not None:
            theta = take_apart(model).theta_for(self._parts)
            self._theta_at_start = checked_start(self._parts, theta, self.settings)
        self._begin(prior_of(self._parts, self._theta_at_start, self.settings))
        cells = (at["cell_memory"], at["points"])
        for first, last in (_KEPT, (at["side"], at["psi"]), cells):
            self.state[first:last] = kept[first:last]
        self.core.remember(self.state)
        self.core.unfold()

    def frozen(self) -> JointEstimator:
        """Give an estimator that starts from this estimate and its memory and learns nothing."""
        bounds = {name: self.settings[name] for name in _BOUNDS}
        return JointEstimator(self.model, dt=self.dt, held=GROUPS, **bounds)

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""
        state = self.state.copy()
        clear_scratch(state, self._at)
        start, rows = self._theta_at_start.tolist(), folded_in(self.core)
        return {**self.settings, "start": start, "folded": rows}, state

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> JointEstimator:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        given = dict(settings)
        model, start = operator_from_dict(given.pop("model")), given.pop("start", None)
        rows = given.pop("folded", None)
        estimator = cls(model, memory=memory_from(given), **given)
        if start is not None:
            theta = finite_vector(start, "start")
            estimator._theta_at_start = checked_start(estimator._parts, theta, estimator.settings)
        restored_state(estimator.state, state)
        check_saved(estimator._parts, estimator.settings, estimator.state, estimator._at)
        # Files of earlier versions have none; it then knows only what comes from here on.
        if rows is not None:
            fold_again(estimator.core, rows)
        return estimator

    def _found(self) -> Found | None:
        return found_of(self.core, self._parts, self.parameters, self.settings)

    def _plays_input(self, u: Any) -> Any:
        before = self._parts.before
        return u if before is None else before.gain * u + before.offset

    def _begin(self, prior: Array) -> None:
        at = self._at
        self.state[at["theta"] : at["d"]] = self._theta_at_start
        self.state[at["z"] : at["side"]] = self._parts.pi.z0
        self.core.start(self.state, self.settings["noise"] ** 2)
        if self._cells is not None:
            memory = self._cells.memory_from(self._parts.pi.r, self._parts.pi.z0)
            self.state[at["cell_memory"] : at["points"]] = memory
        d, u = factors(prior)
        self.state[at["d"] : at["u"]] = d
        self.state[at["u"] : at["z"]] = u
