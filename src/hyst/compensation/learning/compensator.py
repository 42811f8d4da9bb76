"""Learning a command from repetitions of one motion."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_not_negative, as_positive, as_sample_time
from hyst.compensation.exact import range_of_input
from hyst.compensation.learning.along_the_motion import AlongTheMotion, suited_method
from hyst.compensation.learning.contraction import Contraction, given_slopes
from hyst.compensation.learning.learnt import Learnt
from hyst.compensation.learning.measured_output import (
    as_measured,
    as_reference,
    delay_or_refusal,
    refuse_at_rest,
    refuse_reversed,
)
from hyst.compensation.learning.repeated_motion import SAVED_AS_THEY_ARE, RepeatedMotion
from hyst.compensation.learning.repetition import Repetition
from hyst.compensation.learning.spikes import without_spikes
from hyst.compensation.learning.states import (
    status_of,
)
from hyst.errors import InputError
from hyst.operators import ModelDescription, Operator, operator_from_dict
from hyst.operators.model_file import LEARNING as LEARNING_FILE
from hyst.operators.model_file import write_file
from hyst.operators.verdict import refuse_if_unfit
from hyst.signals import Record

Array = NDArray[np.float64]


@final
class LearningCompensator(RepeatedMotion):
    """Iterative learning through a model's inverse, for a reference that is repeated.

        v[0] = y_ref,   u[k] = M^-1(v[k]),   v[k+1] = M(u[k]) + Q G^-1 (y_ref - y[k])

    M is the model, u[k] what was applied, y[k] what was measured, G the linear part of the plant
    behind the model's inverse (delay, modes, gain), which is learnt from the repetitions, and Q a
    filter without phase that passes what repeats. As M(u[k]) is of what was applied, nothing is
    added up at a limit. After the first, each repetition corrects what the model misses, whatever
    its turning points, if the slopes of the plant behind the model's inverse allow it
    (``contraction``).

    Parameters
    ----------
    model
        An operator with an inverse by some method of ``invert_trajectory``.
    y_ref
        Wanted output, shape (N,), output units.
    input_range
        Lowest and highest input; commands are held within.
    dt
        Sample time, s; the model's own if left out. Needed for ``rate_limit``.
    rate_limit
        Largest rate of the input, input units per second.
    periodic
        False: every repetition begins from rest, with the same ``history``. True: in the state that
        the one before has left.
    noise
        Rms of what does not repeat in a measured output; estimated if left out.
    history
        Inputs that the actuator passes before a repetition, shape (M,); before the first one only
        if ``periodic``.
    slopes
        Least and largest slope of the plant behind the model's inverse, if they are known.
    despite_verdict
        Make commands also of a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If an argument cannot be used.
    NotInvertibleError
        If there is no way from an output to a command.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> plant = PrandtlIshlinskii([0.6], [1.1], p0=0.9)
    >>> y_ref = 3.0 - 3.0 * np.cos(np.linspace(0.0, 4.0 * np.pi, 400))
    >>> learning = LearningCompensator(model, y_ref)
    >>> for _ in range(4):
    ...     command = learning.update(plant(learning.command))
    >>> errors = [each.error_rms for each in learning.history]
    >>> errors[3] < 0.1 * errors[0]
    True
    """

    def __init__(
        self,
        model: Operator,
        y_ref: ArrayLike,
        input_range: tuple[float, float] | None = None,
        *,
        dt: float | None = None,
        rate_limit: float | None = None,
        periodic: bool = False,
        noise: float | None = None,
        history: ArrayLike | None = None,
        slopes: tuple[float, float] | None = None,
        despite_verdict: bool = False,
    ) -> None:
        if not isinstance(model, Operator):
            raise InputError(f"model is {type(model).__name__}; give an operator")
        refuse_if_unfit(model.description.verdict, "no command is made", despite_verdict)
        own = model.dt if dt is None else as_sample_time(dt)
        if own is not None:
            model = model.at_sample_time(own)
        self._dt = own
        limits = None if input_range is None else range_of_input(input_range)
        rate = None if rate_limit is None else as_positive(rate_limit, "rate_limit")
        if rate is not None and own is None:
            raise InputError("a rate limit needs the sample time; give dt")
        step = math.inf if rate is None or own is None else rate * own
        self._along = AlongTheMotion(model, suited_method(model), limits, step, rate)
        self._periodic = bool(periodic)
        self._given_noise = None if noise is None else as_not_negative(noise, "noise")
        self._before = None if history is None else finite_vector(history, "history")
        self._given = None if slopes is None else given_slopes(slopes)
        self._learnt = Learnt()
        self._begin(as_reference(y_ref))

    @property
    def model(self) -> Operator:
        """The model whose inverse is used."""
        return self._along.model

    @property
    def y_ref(self) -> Array:
        """Wanted output, shape (N,)."""
        return self._y_ref

    @property
    def dt(self) -> float | None:
        """Sample time, s, if known."""
        return self._dt

    @property
    def command(self) -> Array:
        """The command of the next repetition, shape (N,), input units."""
        return self._command

    @property
    def history(self) -> tuple[Repetition, ...]:
        """All repetitions of this reference that were measured."""
        return tuple(self._history)

    @property
    def best(self) -> Repetition | None:
        """The repetition of the least error since the plant last changed; None before the first."""
        return None if self._best is None else self._history[self._best.number - 1]

    @property
    def state(self) -> str:
        """``"learning"``, ``"at the noise"``, ``"settled"`` or ``"diverged"``."""
        return self._state

    @property
    def noise(self) -> float | None:
        """Rms of what does not repeat, output units; None if not known yet."""
        return self._noise

    @property
    def contraction(self) -> Contraction:
        """Whether an error shrinks from repetition to repetition, and by how much."""
        return self._contraction

    @property
    def status(self) -> str:
        """How learning stands, in one sentence."""
        best = None if self._best is None else self._best.number
        return status_of(self._state, self._history, best, self._held)

    def reset(self, y_ref: ArrayLike | None = None, *, forget: bool = False) -> Array:
        """Begin with another reference, or anew; what is known of the plant is kept.

        Parameters
        ----------
        y_ref
            Wanted output, shape (N,); the present one if left out.
        forget
            Whether the linear part of the plant is forgotten, too, as after a repair.

        Returns
        -------
        numpy.ndarray
            The first command.
        """
        wanted = self._y_ref if y_ref is None else as_reference(y_ref)
        self._learnt = Learnt() if forget else self._learnt.without_pairs()
        self._begin(wanted)
        return self._command

    def update(self, y_measured: ArrayLike | Record, u_applied: ArrayLike | None = None) -> Array:
        """Learn from a repetition of ``command``.

        Parameters
        ----------
        y_measured
            Output, shape (N,), or a ``Record`` whose input is what was applied.
        u_applied
            Input that was applied, shape (N,), where it was not the command.

        Returns
        -------
        numpy.ndarray
            The next command, shape (N,).

        Raises
        ------
        InputError
            If lengths or sample times differ, a sample is not finite, the output does not move, or
            it is shifted against what was to be expected; nothing is learnt then.
        """
        measured = as_measured(y_measured, u_applied, self._command, self._dt)
        v = self._along.output(measured.u, self._past)
        expected = self._expected(v)
        clean = without_spikes(measured.y, expected)
        measured = replace(measured, y=clean.y)
        noise = self._noise_of(measured)
        refuse_at_rest(measured.y, self._y_ref, measured.u, noise)
        late = self._learnt.linear.delay
        if self._is_foreseen(v):
            late += delay_or_refusal(expected, measured.y, noise, bool(self._history))
        if not late and not self._history:
            refuse_reversed(measured.y, expected)
        notes = clean.notes
        trial, told = self._trial(measured, v, expected)
        notes += told
        self._noise = noise
        self._next(trial, measured, late, notes)
        return self._command

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write all of it, every double exact; ``hyst.load`` goes on where it stopped.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        write_file(path, LEARNING_FILE, {"learning": self.to_dict()}, self.model.description)

    def to_dict(self) -> dict[str, Any]:
        """Give all of it as plain numbers, lists and text."""
        along = self._along
        return {
            "model": along.model.to_dict(),
            "settings": {
                "input_range": None if along.input_range is None else list(along.input_range),
                "dt": self._dt,
                "rate_limit": along.rate_limit,
                "periodic": self._periodic,
                "noise": self._given_noise,
                "history": None if self._before is None else self._before.tolist(),
                "slopes": None if self._given is None else list(self._given.slopes),
            },
            "y_ref": self._y_ref.tolist(),
            "learnt": self._learnt.to_dict(),
            "history": [each.to_dict() for each in self._history],
            "trials": [each.to_dict() for each in self._trials],
            "best": None if self._best is None else self._best.to_dict(),
            "last": None if self._last is None else self._last.to_dict(),
            "past": None if self._past is None else self._past.tolist(),
            "command": self._command.tolist(),
            "contraction": self._contraction.to_dict(),
            **{name: getattr(self, f"_{name}") for name in SAVED_AS_THEY_ARE},
        }

    @classmethod
    def from_dict(
        cls, data: dict[str, Any], description: ModelDescription | None = None
    ) -> LearningCompensator:
        """Rebuild it from ``to_dict()``.

        Parameters
        ----------
        data
            What it gave, or the same read from a file.
        description
            What the model's numbers mean.

        Raises
        ------
        InputError
            If an entry is missing or not allowed.
        """
        try:
            model = operator_from_dict(data["model"])
            if description is not None:
                model = model.with_description(description)
            own = cls(model, data["y_ref"], **data["settings"], despite_verdict=True)
            own._take(data)
        except InputError:
            raise
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise InputError(f"the learning is damaged ({error}); save it again") from None
        return own
