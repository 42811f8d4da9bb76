"""All constants of a model of any family, estimated together while the system runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive, as_reading, as_sample_time, whole_number
from hyst.errors import InputError, NotInvertibleError
from hyst.online.checks import memory_from, memory_or_none, names_of, sample
from hyst.online.estimator import Estimator
from hyst.online.knowledge import Knowledge
from hyst.online.model.bands import known_of
from hyst.online.model.commands import Commands, refusal_of
from hyst.online.model.course import Course
from hyst.online.model.model_innovation import ModelInnovation
from hyst.online.model.saved_course import course_of, numbers_of
from hyst.operators import Operator
from hyst.operators.registry import operator_from_dict

Array = NDArray[np.float64]

_WINDOW = 2000
_BLOCKS = 8


@final
class ModelEstimator(Estimator):
    """Estimate all constants of a model of any family: recursive prediction errors in blocks.

    After every block of samples the squares of ``y - model(u)`` over a window of the last samples,
    of what left the window before, and of ``(theta - theta_start) / spread`` are made smaller
    together, by Gauss-Newton steps with the derivative of the kernel itself. The memory before the
    window is carried with its derivatives along the whole past, so that it moves with the
    constants. Every step is projected onto the family's inequalities in the metric of the
    covariance, and shortened or refused where its end has no inverse.

    Parameters
    ----------
    model
        Where to start: any operator whose stages have an exact inverse, or a causal one as
        rate-dependent plays.
    dt
        Sample time, seconds; that of the model if it has one, else 1, which counts in samples.
    memory
        Seconds over which the past is forgotten, in directions the input drives; infinite for
        constants that do not drift.
    spread
        How far off the start is believed to be: standard errors over values. What the data do not
        determine stays where it was.
    spreads
        Standard errors of single constants by name, in their own units; needed where a start of 0
        tells no size.
    held
        Names of constants that are not estimated, besides those that cannot be: thresholds at 0,
        and weights that repeat a scale another stage has.
    noise
        Standard deviation of the output's noise to start from; it is estimated. Left out: the
        first errors tell.
    window
        Seconds whose samples are kept and fitted anew with every block: at least two turns of the
        input; 2000 samples, or the memory if that is less.
    block
        Samples after which the estimate changes; an eighth of the window.
    search
        Whether estimates from other starts are tried while errors cannot be noise.

    Raises
    ------
    InputError
        If a number is out of range or a name unknown.
    NotInvertibleError
        If the start cannot be inverted.

    Notes
    -----
    Ljung and Söderström, Theory and Practice of Recursive Identification (1983), ch. 3. There is
    no C export: ``JointEstimator`` and ``ScaleEstimator`` have one.

    Examples
    --------
    >>> from hyst.models import RambergOsgood
    >>> truth = RambergOsgood(1.0, 0.5, 1.2)
    >>> u = 3.0 * np.sin(np.arange(3000) / 40.0)
    >>> estimator = ModelEstimator(RambergOsgood(1.3, 0.35, 1.0))
    >>> for u_k, y_k in zip(u, truth(u)):
    ...     _ = estimator.update(u_k, y_k)
    >>> estimator.parameters.round(4)
    array([1. , 0.5, 1.2])
    """

    kind: ClassVar[str] = "model"

    def __init__(
        self,
        model: Operator,
        *,
        dt: float | None = None,
        memory: float = math.inf,
        spread: float = 1.0,
        spreads: Mapping[str, float] | None = None,
        held: Iterable[str] = (),
        noise: float | None = None,
        window: float | None = None,
        block: int | None = None,
        search: bool = True,
    ) -> None:
        if not isinstance(model, Operator):
            raise InputError(f"model is a {type(model).__name__}; give an operator")
        self.dt = as_sample_time(dt if dt is not None else model.dt or 1.0)
        model.require_sample_time(self.dt, "the estimator")
        why = refusal_of(model)
        if why:
            raise NotInvertibleError(f"the estimation cannot start: {why}")
        self.description = model.description.of_estimate()
        """What the numbers of its model mean; those of the start, as far as they still hold."""
        names = model.parameters().names
        self.settings: dict[str, Any] = {
            "model": model.to_dict(),
            "dt": self.dt,
            "memory": memory_or_none(memory),
            "spread": as_positive(spread, "spread", "a share"),
            "spreads": _checked_spreads(spreads or {}, names),
            "held": names_of(held, names),
            "noise": None if noise is None else as_positive(noise, "noise", "output units"),
            **_window_of(window, block, memory, self.dt),
            "search": bool(search),
        }
        self._course = Course(model, self.settings)
        self._commands: tuple[Operator, Commands] | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the m constants, those of the model."""
        return self._course.names

    @property
    def parameters(self) -> Array:
        """The estimate, shape (m,)."""
        return self._course.theta.copy()

    @property
    def held(self) -> tuple[str, ...]:
        """Names of what is not estimated: asked for, fixed, or the scale of another stage."""
        return self._course.held

    @property
    def covariance(self) -> Array:
        """Covariance of the estimate, shape (m, m), as linear theory gives it; 0 for what is held.

        That of the start stands where nothing else is known.
        """
        return self._course.covariance()

    @property
    def model(self) -> Operator:
        """The estimate as a model, which begins with the memory the start began with.

        ``memory`` is what the input has left: ``model.run(u, memory)`` goes on from there.
        """
        return self._course.model.with_description(self.description)

    @property
    def memory(self) -> Array:
        """State of the model after the last sample, shape (n,)."""
        return self._course.memory.copy()

    @property
    def error(self) -> float:
        """Measured less predicted output of the last sample used, output units."""
        return self._course.error

    @property
    def noise(self) -> float:
        """Estimated standard deviation of the output's noise, output units."""
        return math.sqrt(self._course.variance)

    @property
    def counts(self) -> dict[str, int]:
        """Samples used, skipped as not finite, refused for an overflow; and steps of the estimate.

        ``"refused steps"`` led to no inverse and were shortened, or not made at all.
        """
        return dict(self._course.counts)

    @property
    def innovation(self) -> ModelInnovation:
        """What the estimate leaves unexplained along the window, and whether that can be noise."""
        return self._course.innovation()

    @property
    def knowledge(self) -> Knowledge:
        """A band of each constant by the squares themselves, or why it is not determined.

        The band goes, along the direction in which the others give way, as far as the squares rise
        by four variances of the noise, at least two standard errors.
        """
        return known_of(self._course)

    @property
    def inverse_error(self) -> float:
        """How far outputs are off at most of which the estimate were true, root mean square.

        0 where the inverse is exact; where a stage has a causal inverse only, what its commands for
        the last 500 predicted outputs would give, less these. Output units.
        """
        is_exact = self._course.model.is_invertible()
        return 0.0 if is_exact else self._course.error_of_commands()

    def update(self, u: float, y: float) -> bool:
        """Take in one sample; every so many the estimate changes.

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
        is_used = self._course.take(u, y)
        if is_used:
            self._passed(u)
        return is_used

    def follow(self, u: ArrayLike) -> None:
        """Let the memory follow inputs whose outputs were not measured; learns nothing."""
        for each in finite_vector(u, "u").tolist():
            self._course.take(each, math.nan, counted=False)
            self._passed(each)

    def command(self, y_ref: float) -> float:
        """Give the input for which the present estimate predicts a wanted output; learns nothing.

        Exact to rounding where the model has an exact inverse. Else its causal inverse steps, begun
        from the estimate's memory whenever the estimate changes or another input was applied than
        it commanded, and ``inverse_error`` says how inexact that is.

        Parameters
        ----------
        y_ref
            Wanted output; NaN gives NaN.

        Returns
        -------
        float
        """
        wanted = as_reading(y_ref, "y_ref")
        if not math.isfinite(wanted):
            return math.nan
        return self._solved().input_for(wanted, self._course.memory, self._course.last_input)

    def restart(self, model: Operator | None = None) -> None:
        """Forget what was learnt, keep the memory of the input, and widen all variances again.

        Parameters
        ----------
        model
            Constants to go on from, of a model like the one at the start; those if left out.

        Raises
        ------
        InputError
            If it has other constants, or they are not allowed.
        NotInvertibleError
            If it cannot be inverted.
        """
        theta = self._course.theta_start
        if model is not None:
            if not isinstance(model, Operator) or model.parameters().names != self.names:
                raise InputError(
                    "the model has other constants than the one at the start; give one that "
                    "differs in their values alone"
                )
            theta = model.parameters().values
        self._course.restart(theta)

    def frozen(self) -> Self:
        """Give an estimator that starts from this estimate and its memory and learns nothing."""
        given = {**self.settings, "held": self.names}
        given.pop("model")
        other = type(self)(self._course.model, memory=memory_from(given), **given)
        other.description = self.description
        other._course.goes_on_from(self._course)
        return other

    def saved(self) -> tuple[dict[str, Any], Array]:
        """Give settings and state, from which ``restore`` rebuilds the estimator."""
        return dict(self.settings), numbers_of(self._course)

    @classmethod
    def restore(cls, settings: dict[str, Any], state: ArrayLike) -> ModelEstimator:
        """Rebuild it from what ``saved`` gave, or the same read from a file."""
        given = dict(settings)
        model = operator_from_dict(given.pop("model"))
        estimator = cls(model, memory=memory_from(given), **given)
        course_of(estimator._course, state)
        return estimator

    def _solved(self) -> Commands:
        model = self._course.model
        if self._commands is None or self._commands[0] is not model:
            self._commands = (model, Commands(model, self._course.memory))
        return self._commands[1]

    def _passed(self, u: float) -> None:
        if self._commands is not None and self._commands[0] is self._course.model:
            self._commands[1].passed(u, self._course.memory)


def _checked_spreads(spreads: Mapping[str, float], names: tuple[str, ...]) -> dict[str, float]:
    names_of(list(spreads), names)
    return {name: as_positive(each, f"spreads[{name!r}]") for name, each in spreads.items()}


def _window_of(window: float | None, block: int | None, memory: float, dt: float) -> dict[str, Any]:
    """Give the settings of the window, in seconds and samples: whole blocks."""
    if window is None:
        usual = min(_WINDOW, memory / dt) if math.isfinite(memory) else _WINDOW
        samples = max(round(usual), 10 * _BLOCKS)
    else:
        samples = max(round(as_positive(window, "window", "seconds") / dt), 2)
    step = samples // _BLOCKS if block is None else whole_number(block, "block", 1, more=" samples")
    step = min(max(step, 1), samples)
    blocks = -(-samples // step)
    return {"window": blocks * step * dt, "block": step}
