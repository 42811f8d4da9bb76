"""Scale and offset of any model's output, estimated while the system runs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive, as_reading, as_sample_time
from hyst.errors import InputError
from hyst.online.checks import (
    memory_from,
    memory_or_none,
    names_of,
    patience_in_samples,
    sample,
    samples_of,
)
from hyst.online.estimator import Estimator
from hyst.online.estimator_file import restored_state
from hyst.online.joint.innovation import Innovation
from hyst.online.knowledge import Knowledge
from hyst.online.scale.affine_of import affine_of
from hyst.online.scale.followed import Followed
from hyst.online.scale.scale_knowledge import (
    ScaleSums,
    bound_of,
    innovation_of,
    knowledge_of,
    refuse_state,
)
from hyst.online.trajectory import Trajectory
from hyst.operators import Affine, Operator
from hyst.operators.registry import compose, operator_from_dict
from hyst.signals import Record

Array = NDArray[np.float64]

_NAMES = ("scale", "offset")
_PATIENCE_SHARE = 0.05


@final
class ScaleEstimator(Estimator):
    """Estimate scale and offset of the output of any model: least squares with forgetting.

    ``y = scale model(u) + offset + noise``. The shape of the loop, its memory, its dynamics stay
    the model's; what drifts most in an actuator, its gain and its zero, is followed with two
    numbers. So it costs next to nothing, needs no derivative, and can be inverted whenever the
    model can: the scale keeps the sign of the start and stays within bounds. A sample that is not
    finite is skipped and counted.

    Parameters
    ----------
    model
        Any operator, an identified one of any family.
    dt
        Sample time, seconds; that of the model if left out, and 1, which counts times in samples,
        if that has none.
    memory
        Seconds over which the past is forgotten; infinite for constants that do not drift. While
        the actuator rests only the offset is forgotten.
    spread
        How far off the model's scale is believed to be: 0.3 is 30 percent. What samples say counts
        as much as they know it better.
    held
        What not to estimate, ``"scale"`` or ``"offset"``.
    least, most
        Bounds of the scale over its start's.

    Raises
    ------
    InputError
        If the model is no operator or for another sample time, or a number is out of range.

    Notes
    -----
    Standard errors follow from what is left unexplained. Where that is no noise but follows itself,
    because the shape is not the plant's or constants drift faster than is forgotten, they are
    widened by what sums over successive samples scatter more than noise does, and ``knowledge``
    says so. Recursive residuals: Brown, Durbin and Evans, J. R. Stat. Soc. B 37 (1975) 149-192.

    Examples
    --------
    >>> from hyst.models import BoucWen
    >>> model = BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
    >>> u = 8.0 * np.sin(np.arange(3000) / 50.0)
    >>> y = 1.3 * model(u) + 0.5
    >>> estimator = ScaleEstimator(model)
    >>> for u_k, y_k in zip(u, y):
    ...     _ = estimator.update(u_k, y_k)
    >>> estimator.parameters.round(6)
    array([1.3, 0.5])
    >>> u_next = estimator.command(2.0)
    >>> float(estimator.model.stepper(estimator.memory)(u_next).__round__(9))
    2.0
    """

    kind: ClassVar[str] = "scale"

    def __init__(
        self,
        model: Operator,
        *,
        dt: float | None = None,
        memory: float = math.inf,
        spread: float = 0.3,
        held: Iterable[str] = (),
        least: float = 0.05,
        most: float = 20.0,
    ) -> None:
        if not isinstance(model, Operator):
            raise InputError(
                f"model is a {type(model).__name__}; give an operator, which takes one input"
            )
        own = 1.0 if model.dt is None else model.dt
        self.dt = as_sample_time(own if dt is None else dt)
        model.require_sample_time(self.dt, "the estimator")
        self.description = model.description.of_estimate()
        """What the numbers of its model mean; those of the start, as far as they still hold."""
        self.settings: dict[str, Any] = {
            "model": model.to_dict(),
            "dt": self.dt,
            "memory": memory_or_none(memory),
            "spread": as_positive(spread, "spread", "a share"),
            "held": names_of(held, _NAMES),
            "least": as_positive(least, "least", "a share of the start"),
            "most": as_positive(most, "most", "a multiple of the start"),
        }
        if not self.settings["least"] < 1.0 < self.settings["most"]:
            raise InputError(
                f"least is {least:.6g} and most {most:.6g}; give a share below 1 and a multiple "
                "above it"
            )
        self._followed = Followed(model)
        # Public, for exports take its constants and the places in its state.
        self.core = self._new_core(memory)
        self._at = self.core.places()
        self.state = np.zeros(self._at["length"])
        self.core.start(self.state, 1.0, 0.0)

    @property
    def names(self) -> tuple[str, ...]:
        """``scale`` and ``offset``."""
        return _NAMES

    @property
    def parameters(self) -> Array:
        """The estimate, shape (2,): scale, a pure number, and offset in output units."""
        return self.state[[self._at["scale"], self._at["offset"]]]

    @property
    def covariance(self) -> Array:
        """Covariance of the estimate, shape (2, 2); infinite for an offset without a sample."""
        sums = self._sums
        of_both = -sums.mean_w * sums.variance
        if "offset" in self.settings["held"]:
            return np.array([[sums.variance, 0.0], [0.0, 0.0]])
        of_offset = sums.mean_variance + sums.mean_w**2 * sums.variance
        if sums.noise_samples == 0:
            of_both, of_offset = 0.0, math.inf
        return np.array([[sums.variance, of_both], [of_both, of_offset]])

    @property
    def model(self) -> Operator:
        """The estimate as a model; what the input has left in it is ``memory``."""
        scale, offset = self.parameters.tolist()
        return compose((self._followed.model, Affine(scale, offset))).with_description(
            self.description
        )

    @property
    def memory(self) -> Array:
        """The state from which ``model`` goes on where the input has left it, a copy."""
        return self._followed.model_memory

    @property
    def error(self) -> float:
        """Measured less predicted output of the last sample used, output units."""
        return float(self.state[self._at["error"]])

    @property
    def noise(self) -> float:
        """Estimated standard deviation of the output's noise, output units."""
        return math.sqrt(self._sums.noise)

    @property
    def counts(self) -> dict[str, int]:
        """Samples used, skipped as not finite, and refused because of an overflow."""
        return {name: int(self.state[self._at[name]]) for name in ("used", "skipped", "refused")}

    @property
    def innovation(self) -> Innovation:
        """What the estimate leaves unexplained, and whether that can be noise."""
        return innovation_of(self._sums, float(self.parameters[0]), self.settings)

    @property
    def at_bound(self) -> str:
        """Which bound the scale is on; empty if it is on none."""
        return bound_of(self._sums, float(self.parameters[0]), self.settings)

    @property
    def knowledge(self) -> Knowledge:
        """What is known of scale and offset: a band, or why one is not determined."""
        return knowledge_of(self._sums, self.parameters, self.standard_errors, self.settings)

    def update(self, u: float, y: float) -> bool:
        """Take in one sample.

        Parameters
        ----------
        u, y
            Input and measured output; one that is not finite is skipped and counted. Where only
            the output is missing, let the memory ``follow`` the input.

        Returns
        -------
        bool
            Whether the sample was used.
        """
        u, y = sample(u, y)
        if not (math.isfinite(u) and math.isfinite(y)):
            return self.core.step(self.state, u, y) == 0
        w = self._followed.step(u)
        if math.isnan(w):
            self.state[self._at["refused"]] += 1.0
            return False
        return self.core.step(self.state, w, y) == 0

    def run(self, record: Record, every: int = 1) -> Trajectory:
        """Take in a whole record; as ``update`` for every sample, with the same bits.

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
        w = self._followed.run(u)
        shape = (time.size, 2)
        theta, variance, error = np.empty(shape), np.empty(shape), np.empty(u.size)
        self.core.run(self.state, w, y, every, theta, variance, error)
        lost = float(np.isnan(w).sum())  # the model overflowed there, which the core cannot know
        self.state[self._at["refused"]] += lost
        self.state[self._at["skipped"]] -= lost
        variance[:, [name in self.settings["held"] for name in _NAMES]] = 0.0
        return Trajectory(time, _NAMES, theta, np.sqrt(variance), error)

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
        self._followed.run(finite_vector(u, "u"))

    def command(self, y_ref: float) -> float:
        """Give the input for which the present estimate predicts a wanted output; learns nothing.

        Parameters
        ----------
        y_ref
            Wanted output; NaN gives NaN, as one that no input gives.

        Returns
        -------
        float

        Raises
        ------
        NotInvertibleError
            If the model has no exact inverse that answers at once.
        """
        scale, offset = self.parameters.tolist()
        return self._followed.input_for((as_reading(y_ref, "y_ref") - offset) / scale)

    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and believe the start anew.

        Parameters
        ----------
        model
            The model it started from, with or without another scale and offset to go on from, as
            ``estimator.model`` gives it; the start so far if left out.

        Raises
        ------
        InputError
            If it is another model, or its scale is 0.
        """
        start = self.state[[self._at["start"], self._at["start_offset"]]].tolist()
        if model is not None:
            start = affine_of(model, self._followed.model)
        self.core.start(self.state, *start)

    def frozen(self) -> ScaleEstimator:
        """Give an estimator that starts from this estimate and its memory and learns nothing."""
        other = ScaleEstimator(self._followed.model, dt=self.dt, held=_NAMES)
        other.description = self.description
        other._followed.memory = self._followed.memory
        other.core.start(other.state, *self.parameters.tolist())
        return other

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""
        return dict(self.settings), np.concatenate([self.state, self._followed.memory])

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> ScaleEstimator:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        given = dict(settings)
        model = operator_from_dict(given.pop("model"))
        estimator = cls(model, memory=memory_from(given), **given)
        whole = np.zeros(estimator.state.size + estimator._followed.length)
        restored_state(whole, state)
        estimator.state[:] = whole[: estimator.state.size]
        refuse_state(estimator.state, estimator._at, estimator.settings)
        estimator._followed.memory = whole[estimator.state.size :]
        return estimator

    @property
    def _sums(self) -> ScaleSums:
        return ScaleSums.of(self.state, self._at)

    def _new_core(self, memory: float) -> _engine.ScaleEstimation:
        settings = self.settings
        forgetting = min(self.dt / memory, 0.5) if math.isfinite(memory) else 0.0
        patience = round(_PATIENCE_SHARE * patience_in_samples(None, memory, self.dt))
        return _engine.ScaleEstimation(
            forgetting,
            float(patience),
            settings["spread"],
            settings["least"],
            settings["most"],
            "scale" in settings["held"],
            "offset" in settings["held"],
        )
