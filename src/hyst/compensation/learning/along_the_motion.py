"""A model and its inverse along a whole motion, within the limits of the input.

What the model is told to give after a limit has acted is what it gives for the limited command, so
that nothing is learnt, or added up, of what the drive cannot do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.invert import invert_trajectory
from hyst.compensation.suited_methods import methods_for
from hyst.errors import NotInvertibleError
from hyst.operators import Operator

Array = NDArray[np.float64]

_PREFERRED = ("exact", "noncausal", "trajectory", "preview", "sample-exact", "explicit")


@dataclass(frozen=True, eq=False)
class Made:
    """A command.

    Parameters
    ----------
    u
        Shape (N,), input units.
    held
        Samples at an end of the range or at the largest rate.
    notes
        Of the inversion.
    """

    u: Array
    held: int
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class AlongTheMotion:
    """A model, how it is inverted, and the limits of its input.

    Parameters
    ----------
    model
        Invertible by ``method``.
    method
        One of ``METHODS``.
    input_range
        Lowest and highest input; None for none.
    step
        Largest change of the input from sample to sample; infinite for none.
    rate_limit
        The same per second; None for none.
    """

    model: Operator
    method: str
    input_range: tuple[float, float] | None
    step: float
    rate_limit: float | None

    def output(self, u: Array, past: Array | None) -> Array:
        """Give what the model makes of a command, shape (N,).

        Parameters
        ----------
        u
            The command, shape (N,).
        past
            Inputs it has passed before, shape (M,); None for none.
        """
        state = None if past is None else self.model.run(past)[1]
        return self.model.run(u, state)[0]

    def command(self, v: Array, past: Array | None, despite_verdict: bool = True) -> Made:
        """Give the command for which the model gives v, or as near as limits allow.

        Parameters
        ----------
        v
            Wanted of the model, shape (N,).
        past
            Inputs it has passed before, shape (M,); None for none.
        despite_verdict
            As of ``invert_trajectory``.
        """
        if self.method == "exact" and self.rate_limit is not None:
            return self._sample_by_sample(v, past)
        own = self.method in ("preview", "trajectory")
        done = invert_trajectory(
            self.model,
            v,
            self.method,
            input_range=self.input_range,
            outside="clip",
            history=past,
            rate_limit=self.rate_limit if own else None,
            despite_verdict=despite_verdict,
            allow_unconverged=True,
        )
        if self.rate_limit is None or own:
            return Made(done.u, done.clipped, done.notes)
        u, slowed = _slowed(done.u, self.step, None if past is None else float(past[-1]))
        return Made(u, done.clipped + slowed, done.notes)

    def _sample_by_sample(self, v: Array, past: Array | None) -> Made:
        """Hold every input within its range and rate; both memories follow what is held."""
        inverse = self.model.inverse()
        state, own = None, None
        if past is not None:
            y, state = self.model.run(past)
            own = inverse.run(y)[1]
        forward, backward = self.model.stepper(state), inverse.stepper(own)
        low, high = self.input_range or (-np.inf, np.inf)
        last = None if past is None else float(past[-1])
        u, held = np.empty(v.size), 0
        for k, wanted in enumerate(v.tolist()):
            before = backward.state.copy()
            asked = backward(wanted)
            given = min(max(asked, low), high)
            if last is not None:
                given = min(max(given, last - self.step), last + self.step)
            y_k = forward(given)
            if given != asked:
                held += abs(given - asked) > _ROUNDING * max(abs(asked), self.step)
                backward.state[:] = before
                backward(y_k)
            u[k] = last = given
        return Made(u, held, ())


_ROUNDING = 1e-12


def _slowed(u: Array, step: float, last: float | None) -> tuple[Array, int]:
    """Hold the rate of a command; how many samples that has changed."""
    given = np.empty(u.size)
    at = float(u[0]) if last is None else last
    for k, asked in enumerate(u.tolist()):
        at = min(max(asked, at - step), at + step)
        given[k] = at
    return given, int(np.count_nonzero(given != u))


def suited_method(model: Operator) -> str:
    """Choose how a model is inverted.

    Parameters
    ----------
    model
        Any operator.

    Raises
    ------
    NotInvertibleError
        If there is no way.
    """
    own = methods_for(model)
    if not own:
        model.inverse()  # says why, where there is a reason
        raise NotInvertibleError(
            "the model has no inverse by any method, so that there is nothing to learn through; "
            "identify a family that can be inverted"
        )
    return next(each for each in _PREFERRED if each in own)
