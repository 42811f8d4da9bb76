"""A block as python-control wants it: one sample as a function of state and inputs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.models import Scheduled
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators import Operator

Array = NDArray[np.float64]

# From state and inputs to outputs and the next state; neither argument is changed.
Sample: TypeAlias = Callable[[Array, Array], tuple[Array, Array]]


@dataclass(frozen=True)
class SampledBlock:
    """One sample of a block, free of a memory of its own.

    Parameters
    ----------
    name
        What it is called where the user gives no name.
    dt
        Sample time, s, or None if any will do.
    inputs, outputs
        Names of the signals.
    start
        State before the first sample.
    sample
        The step.
    """

    name: str
    dt: float | None
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    start: Array
    sample: Sample


def sampled_block(block: Any, watch: bool) -> SampledBlock:
    """Read an operator, a scheduled model or its inverse, or a TrackingController.

    Parameters
    ----------
    block
        One of these.
    watch
        Whether what it can tell beside its output is an output too.

    Raises
    ------
    InputError
        If it is something else.
    """
    if isinstance(block, Operator):
        return _of_operator(block)
    if isinstance(block, Scheduled | ScheduledInverse):
        return _of_scheduled(block, watch)
    if isinstance(block, TrackingController):
        return _of_controller(block, watch)
    raise InputError(
        f"the block is {type(block).__name__}; give an operator of hyst, a Scheduled model or a "
        "TrackingController (a linear system has as_control() or to_control() of its own)"
    )


def _of_operator(operator: Operator) -> SampledBlock:
    def sample(state: Array, given: Array) -> tuple[Array, Array]:
        return operator.run(given, state)

    start = operator.initial_state()
    return SampledBlock(_word(operator.kind), operator.dt, ("u",), ("y",), start, sample)


def _of_scheduled(model: Scheduled | ScheduledInverse, watch: bool) -> SampledBlock:
    """Tell beside y where constants are held because s is outside the schedule: 1, else 0."""

    def sample(state: Array, given: Array) -> tuple[Array, Array]:
        y, following, held = model.run(given[:1], given[1:], state)
        return np.append(y, float(held)) if watch else y, following

    dt = model.scheduled.dt if isinstance(model, ScheduledInverse) else model.dt
    names, outputs = ("u", "s"), ("y", "outside") if watch else ("y",)
    return SampledBlock(_word(model.kind), dt, names, outputs, model.initial_state(), sample)


def _of_controller(block: TrackingController, watch: bool) -> SampledBlock:
    """Beside u, tell the v that belongs to it, and the estimate where it is known."""
    watched = {"v": block.applied} if watch else {}
    if watch and block.E is not None and block.F is not None:
        watched["d_hat"] = block.estimate

    def sample(state: Array, given: Array) -> tuple[Array, Array]:
        reference, output = given[:1], given[1:]
        u, following = block.run(reference, output, state)
        told = [each(reference, output, state) for each in watched.values()]
        return np.concatenate([u, *told]), following

    names, outputs = ("y_ref", "y"), ("u", *watched)
    return SampledBlock("controller", block.dt, names, outputs, block.initial_state(), sample)


def _word(kind: str) -> str:
    # python-control reads a minus in front of a name as a sign, and words with one are no names.
    return kind.replace("-", "_")
