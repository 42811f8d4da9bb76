"""The command of a model whose output turns: sample by sample the nearest input that does it.

From the memory of every sample the output is looked up over the whole range of the input, and of
the inputs at which it is the wanted one the nearest is taken: so the command stays on its branch as
long as that reaches the reference. Where none does, the input that comes closest is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.exact import range_of_input
from hyst.compensation.result import Compensation
from hyst.errors import InputError
from hyst.models import Butterfly
from hyst.operators import Operator
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

_POINTS = 256
"""Of the range of the input, looked up for every sample."""

_PARTS = 16
"""Into which an interval is cut when it is looked into."""

_ROUNDS = 12
"""Of cutting: 16^-12 of an interval is below the last digit of an input."""

_NO_CLOSER = 1e-9
"""Of what the output misses: a closer look that gains no more is the last."""

_OUT_OF_REACH = 1e-6
"""Of the reach of the output: by what a reference may be missed without being out of reach."""


def turns(model: Operator) -> bool:
    """Tell whether a model holds a butterfly and knows no time.

    Parameters
    ----------
    model
        Any operator.
    """
    return model.dt is None and any(isinstance(leaf, Butterfly) for leaf in leaves_of(model))


def drive_to_nearest(
    model: Operator,
    y_ref: ArrayLike,
    input_range: tuple[float, float] | None,
    clip: bool,
    history: ArrayLike | None,
) -> Compensation:
    """Find for every sample the nearest input that gives the wanted output.

    Parameters
    ----------
    model, y_ref, input_range, history
        As in ``invert_trajectory``; the range is needed.
    clip
        Whether a reference out of reach is followed as closely as the range allows.

    Returns
    -------
    Compensation

    Raises
    ------
    InputError
        If there is no range, or a reference is out of reach.

    Examples
    --------
    >>> from hyst.models import Butterfly, PrandtlIshlinskii
    >>> strain = Butterfly(PrandtlIshlinskii([1.0], [0.25]), [[0, 0, 1.0], [0, 0, 0], [0, 0, 0]])
    >>> done = drive_to_nearest(strain, [0.0, 0.25, 0.5625], (0.0, 1.0), False, None)
    >>> done.u.round(9)
    array([0.  , 0.75, 1.  ])
    """
    reference = finite_vector(y_ref, "y_ref")
    if input_range is None:
        raise InputError(
            "the output turns with the input, so that inputs must be looked for in a range; give "
            "the lowest and the highest input allowed (input_range, --limits)"
        )
    low, high = range_of_input(input_range)
    state, u0 = _start(model, history, low, high)
    memory, u, left = state.copy(), np.empty(reference.size), 0
    held = 0
    for k, wanted in enumerate(reference.tolist()):
        look = _Look(model, memory, wanted, low, high)
        found = look.nearest(u0)
        if not found.reached and not clip:
            raise InputError(_out_of_reach(k, wanted, look, found))
        held += not found.reached
        left += found.leaves_branch
        u[k] = u0 = found.u
        _, memory = model.run(u[k : k + 1], memory)
    y_predicted, _ = model.run(u, state)
    notes = () if not left else (_about_jumps(left, float(np.abs(np.diff(u)).max(initial=0.0))),)
    return Compensation(u, reference, y_predicted, "trajectory", held, notes=notes)


@dataclass(frozen=True)
class _Found:
    """The input taken for one sample."""

    u: float
    reached: bool
    leaves_branch: bool


@dataclass(frozen=True, eq=False)
class _Look:
    """The output over the input, from one memory, beside the wanted one."""

    model: Operator
    memory: Array
    wanted: float
    low: float
    high: float

    def nearest(self, u0: float) -> _Found:
        """Give the input nearest to u0 that reaches the wanted output, or comes closest."""
        points = np.unique(np.append(np.linspace(self.low, self.high, _POINTS + 1), u0))
        error = self._error(points)
        places = _crossings(error)
        if not places.size:
            points, error = self._closest(points, error)
            places = _crossings(error)
        if not places.size:
            at = int(np.argmin(np.abs(error)))
            reached = bool(abs(error[at]) <= _OUT_OF_REACH * max(self.span(), abs(self.wanted)))
            return _Found(float(points[at]), reached, False)
        at = _nearest_place(points, places, u0)
        u = self._within(float(points[at]), float(points[at + 1]), u0)
        return _Found(u, True, self._leaves_branch(u0, u))

    def span(self) -> float:
        """Give how far the output reaches from here."""
        return float(np.ptp(self._error(np.linspace(self.low, self.high, _POINTS + 1))))

    def reach(self) -> tuple[float, float]:
        """Give the lowest and the highest output from here."""
        y = self._error(np.linspace(self.low, self.high, _POINTS + 1)) + self.wanted
        return float(y.min()), float(y.max())

    def _error(self, points: Array) -> Array:
        memories = np.tile(self.memory, (points.size, 1))
        y, _ = self.model.run(points[:, None], memories)
        return y[:, 0] - self.wanted

    def _closest(self, points: Array, error: Array) -> tuple[Array, Array]:
        """Look closer at where the output comes closest, until it is reached or no closer."""
        for _ in range(_ROUNDS):
            at = int(np.argmin(np.abs(error)))
            ends = points[max(at - 1, 0)], points[min(at + 1, points.size - 1)]
            closer = np.unique(np.append(np.linspace(*ends, _PARTS + 1), points[at]))
            missed = self._error(closer)
            if np.abs(missed).min() > (1.0 - _NO_CLOSER) * abs(error[at]):
                break
            points, error = closer, missed
            if _crossings(error).size:
                break
        return points, error

    def _within(self, a: float, b: float, u0: float) -> float:
        """Find the wanted output between two inputs on either side of it."""
        for _ in range(_ROUNDS):
            points = np.unique(np.linspace(a, b, _PARTS + 1))
            error = self._error(points)
            places = _crossings(error)
            if not places.size or points.size < 3:
                break
            at = _nearest_place(points, places, u0)
            a, b = float(points[at]), float(points[at + 1])
        ends = np.array([a, b])
        return float(ends[int(np.argmin(np.abs(self._error(ends))))])

    def _leaves_branch(self, u0: float, u: float) -> bool:
        """Tell whether the output turns between two inputs."""
        y = self._error(np.linspace(u0, u, _PARTS + 1))
        steps, least = np.diff(y), 1e-6 * max(float(np.ptp(y)), abs(self.wanted) * 1e-9)
        return bool((steps > least).any() and (steps < -least).any())


def _crossings(error: Array) -> NDArray[np.intp]:
    """Give the places after which an error changes its sign, or is nothing."""
    sign = np.sign(error)
    return np.flatnonzero(sign[:-1] * sign[1:] <= 0.0)


def _nearest_place(points: Array, places: NDArray[np.intp], u0: float) -> int:
    a, b = points[places], points[places + 1]
    distance = np.maximum(np.maximum(a - u0, u0 - b), 0.0)
    return int(places[int(np.argmin(distance))])


def _start(
    model: Operator, history: ArrayLike | None, low: float, high: float
) -> tuple[Array, float]:
    """Give the memory before the first sample, and the input it was left at."""
    if history is None:
        return model.initial_state(), min(max(0.0, low), high)
    passed = finite_vector(history, "history")
    return model.run(passed)[1], min(max(float(passed[-1]), low), high)


def _out_of_reach(k: int, wanted: float, look: _Look, found: _Found) -> str:
    least, most = look.reach()
    return (
        f"y_ref[{k}] is {wanted:.6g}, but from the memory it has there the output reaches "
        f"{least:.6g} to {most:.6g} with an input of {look.low:.6g} to {look.high:.6g}; change the "
        "reference or the range, or follow it as closely as possible with outside='clip'"
    )


def _about_jumps(count: int, largest: float) -> str:
    return (
        f"the branch the command was on does not reach the reference at {count} "
        f"{'sample' if count == 1 else 'samples'}, where the command passes a turn of the output; "
        f"its largest step is {largest:.4g}: keep the range on one side of the turn to avoid that"
    )
