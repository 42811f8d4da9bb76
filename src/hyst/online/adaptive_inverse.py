"""An inverse that follows the estimate, and a guard that knows a model to fall back to."""

from __future__ import annotations

import math
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_not_negative, as_positive
from hyst.errors import InputError
from hyst.online.checks import sample
from hyst.online.estimator import Estimator
from hyst.online.estimator_file import Saved, restored_state
from hyst.online.guard_window import GuardWindow
from hyst.online.judgement import Judgement, judged
from hyst.operators import ModelDescription, Operator
from hyst.operators.registry import operator_from_dict
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]

# Share of the mean square of the output below which errors are not worth a judgement.
_NEGLIGIBLE = 1e-6
# Files of before there were several kinds have this one.
_FIRST_KIND = "joint"


@final
class AdaptiveInverse(Saved):
    """Compensate with the inverse of the running estimate, whichever estimator it is of.

    ``command(y_ref)`` solves ``model(u) = y_ref`` with the parameters and the memory the estimator
    has at that moment. So the memory of the inverse always belongs to its parameters, and a command
    jumps for no other reason than what has been learnt.

    The guard compares, window by window, how well the estimate and the last good model predict the
    output. Where the estimate does worse by the factor ``margin``, or where both do worse than ever
    by that factor and learning does not help, commands come from the last good model and the
    estimator starts anew from it. Where the estimate does as well as the good model and about as
    well as ever, it is trusted again and becomes the last good model; but where its errors follow
    each other, so that they cannot be noise, it must do better by ``margin`` for that.

    Parameters
    ----------
    estimator
        Started from a model that may serve as the first good one.
    window
        Seconds over which errors are compared, at least a period of what is tracked. Left out: the
        period of the motion, as its turns tell it, or as many of them as have 50 samples; 10,000
        samples if it has not turned twice by then. ``status`` tells which.
    margin
        Ratio of the mean square errors at which the guard falls back, above 1.
    despite_verdict
        Give commands also where the estimator started from a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If a number is out of range, ``estimator`` is no estimator of a whole model, or started from
        a model whose verdict is ``unfit``.
    NotInvertibleError
        If the model has no exact inverse that answers at once.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.online import JointEstimator
    >>> plant = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0).stepper()
    >>> inverse = AdaptiveInverse(JointEstimator(PrandtlIshlinskii([0.7], [1.4], 0.8)), window=400)
    >>> for k in range(2000):
    ...     y_ref = 4.0 * math.sin(k / 30.0)
    ...     u = inverse.command(y_ref)
    ...     y = plant(u)
    ...     inverse.update(u, y)
    >>> abs(y - y_ref) < 1e-3
    True
    """

    kind: ClassVar[str] = "inverse"

    def __init__(
        self,
        estimator: Estimator,
        window: float | None = None,
        margin: float = 4.0,
        *,
        despite_verdict: bool = False,
    ) -> None:
        if not isinstance(estimator, Estimator):
            raise InputError(
                f"estimator is a {type(estimator).__name__}; give a JointEstimator, a "
                "ScaleEstimator or another hyst.online.Estimator"
            )
        refuse_if_unfit(estimator.description.verdict, "no command is given", despite_verdict)
        self.estimator = estimator
        self._window = GuardWindow(window, estimator.dt)
        self._margin = as_positive(margin, "margin", "a ratio above 1")
        if self._margin <= 1.0:
            raise InputError(f"margin is {margin!r}; give a ratio above 1")
        estimator.command(0.0)  # refuses what has no inverse before anything rests on it
        self._good = estimator.model
        self._fallback = estimator.frozen()
        self._powers = [0.0, 0.0, 0.0]
        self._samples = 0
        self._usual = math.inf
        self._y_ref: float | None = None
        self.trusts_estimate = True
        """Whether commands come from the estimate, or from the last good model."""
        self.fallbacks = 0
        """How many windows the guard has rejected."""
        self.doubts = 0
        """How many windows in a row the estimate's errors could not be noise."""
        self.error = 0.0
        """Measured output less that of the model commands came from, of the last sample used."""
        self.judgement: Judgement | None = None
        """What the last window has told; None before one has ended."""

    @property
    def description(self) -> ModelDescription:
        """What the numbers of its models mean; that of its estimator."""
        return self.estimator.description

    @description.setter
    def description(self, description: ModelDescription) -> None:
        self.estimator.description = description

    @property
    def model(self) -> Operator:
        """The model commands come from, with its memory if its constants can say it."""
        return self._source().model.with_description(self.description)

    @property
    def good_model(self) -> Operator:
        """The last good model, with the memory it was taken with."""
        return self._good.with_description(self.description)

    @property
    def window(self) -> float | None:
        """Seconds over which errors are compared; None while no period has been seen."""
        return self._window.seconds

    @property
    def status(self) -> str:
        """Where commands come from, why, and what there is to doubt, in a sentence.

        All its numbers are those of the last window that has ended.
        """
        if self.judgement is None:
            source = "the estimate" if self.trusts_estimate else "the last good model"
            return f"commands come from {source}; nothing is judged yet; {self._window}"
        return f"{self.judgement}; {self._window}"

    def command(self, y_ref: float) -> float:
        """Give the input for a wanted output.

        Parameters
        ----------
        y_ref
            Wanted output; NaN gives NaN, as may one that no input gives.

        Returns
        -------
        float
        """
        u = self._source().command(y_ref)
        if math.isfinite(y_ref):
            self._y_ref = float(y_ref)
        return u

    def update(self, u: float, y: float) -> None:
        """Learn from the input that was applied and the output that was measured.

        Parameters
        ----------
        u, y
            The sample; one that is not finite is skipped, but the memory follows the input.
        """
        u, y = sample(u, y)
        self._window.watch.see(u if self._y_ref is None else self._y_ref)
        # Both of them whatever the other says, or their memories would no longer be of one input.
        is_used = [each.update(u, y) for each in (self._fallback, self.estimator)]
        if not all(is_used):
            if math.isfinite(u) and not math.isfinite(y):
                self.follow([u])
            return
        self.error = self._source().error
        values = (self.estimator.error, self._fallback.error, y)
        self._powers = [power + value**2 for power, value in zip(self._powers, values, strict=True)]
        self._samples += 1
        if self._samples >= self._window.samples:
            adaptive, good, output = (power / self._samples for power in self._powers)
            self._judge(adaptive, good, _NEGLIGIBLE * output)
            self._powers, self._samples = [0.0, 0.0, 0.0], 0

    def follow(self, u: ArrayLike) -> None:
        """Let the memories follow inputs whose outputs were not measured; learns nothing.

        Parameters
        ----------
        u
            Shape (N,), what the actuator has passed, finite.

        Raises
        ------
        InputError
            If it is not a finite vector.
        """
        for each in (self._fallback, self.estimator):
            each.follow(u)

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the inverse."""
        parts = {}
        for name, each in (("estimator", self.estimator), ("fallback", self._fallback)):
            settings, state = each.saved()
            parts[name] = {"kind": each.kind, "settings": settings, "state": state.tolist()}
        usual = None if math.isinf(self._usual) else self._usual
        judgement = None if self.judgement is None else self.judgement.to_dict()
        settings = {"window": self._window.given, "margin": self._margin, "usual": usual}
        settings |= {"good": self._good.to_dict(), "motion": self._window.saved(), **parts}
        settings |= {"judgement": judgement, "y_ref": self._y_ref}
        counts = [self._samples, float(self.trusts_estimate), self.fallbacks, self.doubts]
        return settings, np.array([*self._powers, *counts])

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> AdaptiveInverse:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        inverse = cls(
            _estimator_from(settings["estimator"]), settings["window"], settings["margin"]
        )
        inverse._fallback = _estimator_from(settings["fallback"])
        inverse._good = operator_from_dict(settings["good"])
        inverse._fallback.restart(inverse._good)  # refuses what cannot be inverted
        inverse._fallback = _estimator_from(settings["fallback"])
        usual = settings["usual"]
        inverse._usual = (
            math.inf if usual is None else as_not_negative(usual, "usual", "a mean square")
        )
        numbers = np.zeros(7)
        restored_state(numbers, state)
        if (numbers < 0.0).any() or numbers[4] not in (0.0, 1.0):
            raise InputError("the saved guard has counts out of range; save the inverse again")
        inverse._powers = numbers[:3].tolist()
        inverse._samples, trusts, inverse.fallbacks, inverse.doubts = (
            int(each) for each in numbers[3:]
        )
        inverse.trusts_estimate = bool(trusts)
        # Files of before have none of these: their guard judges anew from its next window on.
        inverse._y_ref = settings.get("y_ref")
        if settings.get("motion") is not None:
            inverse._window.restored(settings["motion"])
        if settings.get("judgement") is not None:
            inverse.judgement = Judgement.from_dict(settings["judgement"])
            if inverse.judgement.trusted != inverse.trusts_estimate:
                raise InputError("the saved judgement contradicts the guard; save it again")
        return inverse

    def _source(self) -> Estimator:
        return self.estimator if self.trusts_estimate else self._fallback

    def _judge(self, adaptive: float, good: float, negligible: float) -> None:
        """Mean squares of a window: both models' errors, and what is too small to matter."""
        is_worse = adaptive > self._margin * (good + negligible)
        is_unusual = adaptive > self._margin * (self._usual + negligible)
        is_doubtful = not self.estimator.innovation.consistent
        self.doubts = self.doubts + 1 if is_doubtful else 0
        usual, seconds = self._usual, self._samples * self.estimator.dt
        # A sensor that died or was turned round asks for what no plant does: on its bound an
        # estimate is no better for leaving less.
        bound = self.estimator.at_bound
        is_rejected = is_worse or bool(bound) or (is_unusual and adaptive > good / self._margin)
        if is_rejected:
            self.trusts_estimate = False
            self.fallbacks += 1
            self.estimator.restart(self._good)
        elif adaptive <= good + negligible and not is_unusual:
            self.trusts_estimate = True
            self._usual = adaptive
            if not is_doubtful or adaptive < max(good / self._margin, negligible):
                self._good = self.estimator.model
                self._fallback.restart(self._good)
        outcome = self.trusts_estimate, is_rejected
        self.judgement = judged(seconds, (adaptive, good), usual, outcome, self.doubts, bound)


def _estimator_from(saved: dict[str, Any]) -> Estimator:
    kind = Saved.kinds[saved.get("kind", _FIRST_KIND)]
    estimator = kind.restore(saved["settings"], saved["state"])
    if not isinstance(estimator, Estimator):
        raise InputError(f"the saved guard has the estimator {kind.kind!r}; save the inverse again")
    return estimator
