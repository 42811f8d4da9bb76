"""A loop that starts at rest where the reference begins, and not where all states are 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

from hyst.control.closed_loop import ClosedLoop
from hyst.control.feedback.loop_plant import static_gain
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError, SolverError
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

_AT_ONE = 1e-12  # of I - A, over its size, below which it is singular: an integrator
_KEPT = 1e-7  # what a resting state may move, over its own size
_WIDENINGS = 60


@dataclass(frozen=True, eq=False)
class SettledStart:
    """Where a loop rests with a constant reference.

    Parameters
    ----------
    block
        The controller, its ``x0`` such that it rests.
    v, w, y
        What it wants of the hysteresis, what that gives, and the output, all constant.
    """

    block: TrackingController
    v: float
    w: float
    y: float

    def hysteresis(self, true: Operator | None) -> Operator:
        """Give the hysteresis as the plant in deviations from rest meets it."""
        moved = Affine(1.0, -self.w)
        return moved if true is None else moved @ true

    def at_rest_again(self, loop: ClosedLoop) -> ClosedLoop:
        """Give a loop that was simulated in deviations of the plant its own values."""
        return replace(loop, y=loop.y + self.y, eta=loop.eta + self.w, noise=loop.noise - self.y)


def simulate_settled(
    simulate: Callable[..., ClosedLoop],
    reference: Array,
    dt: float,
    controller: Any,
    plant: Any,
    hysteresis: Operator | None,
    noise: Array,
    delay: float,
    **options: Any,
) -> ClosedLoop:
    """Simulate a loop that has come to rest at the first value of the reference.

    The plant is simulated in deviations from its rest, all else as it is.

    Parameters
    ----------
    simulate
        ``simulate_closed_loop``, which starts at rest with the plant's states at 0.
    reference, dt, controller, plant, hysteresis, noise, delay, options
        Its arguments.

    Returns
    -------
    ClosedLoop

    Raises
    ------
    InputError
        If the controller is no TrackingController, or as ``settled_start``.
    """
    if not isinstance(controller, TrackingController):
        raise InputError(
            "start='settled' is for blocks as they run; give a TrackingController as controller"
        )
    met = sampled_plant(plant, dt, delay)
    begun = settled_start(controller, met, hysteresis, float(reference[0]))
    loop = simulate(
        reference, dt, plant=met, controller=begun.block, hysteresis=begun.hysteresis(hysteresis),
        noise=noise + begun.y, delay=met.delay, **options,
    )  # fmt: skip
    return begun.at_rest_again(loop)


def settled_start(
    block: TrackingController, plant: SampledPlant, hysteresis: Operator | None, reference: float
) -> SettledStart:
    """Find where the loop rests: ``x = A x + B [r, y], v = C x + D [r, y], y = P(0) h(v)``.

    h is hysteresis after inverse from their initial states, in one step to v. With an integrator
    ``y = r``; else what the block's static gains make of it.

    Parameters
    ----------
    block
        The controller.
    plant
        As the block samples it.
    hysteresis
        The true one, or None.
    reference
        Its constant value r.

    Returns
    -------
    SettledStart

    Raises
    ------
    InputError
        If the plant has no static gain, or the loop no place to rest, for the hysteresis does not
        reach the reference.
    """
    gain = static_gain(plant.system)
    if gain == 0.0 or not np.isfinite(gain):
        raise InputError(
            f"the plant's static gain is {gain:g}, so it does not rest; give start='rest'"
        )

    def drive(v: float) -> float:
        return v if block.inverse is None else float(block.inverse(np.array([v]))[0])

    def given(v: float) -> float:
        """Give w for v."""
        u = drive(v)
        return u if hysteresis is None else float(hysteresis(np.array([u]))[0])

    if _integrates(block):
        wanted = reference / gain
        v = _root(lambda v: given(v) - wanted, wanted, reference)
    else:
        of_r, of_y = _static_gains(block)
        # Over what v would miss if hysteresis and inverse cancelled, so that v is found to rounding
        # of its own size however large the static gain of the loop is.
        wanted, loop = of_r * reference, of_y * gain
        share = 1.0 - loop if loop != 1.0 else 1.0
        v = _root(lambda v: (v - wanted - loop * given(v)) / share, wanted / share, reference)
    w, u = given(v), drive(v)
    if block.limits is not None and not block.limits[0] <= u <= block.limits[1]:
        raise InputError(
            f"the loop rests at a reference of {reference:.6g} with a drive of {u:.6g}, beyond the "
            "limits of the drive; begin within its range, or give start='rest'"
        )
    x0 = _resting_state(block, np.array([reference, gain * w]), v)
    return SettledStart(_with_start(block, x0, u), v, w, gain * w)


def _integrates(block: TrackingController) -> bool:
    """Tell integrators from slow leaks, whose poles may lie as near to 1 as rounding moves two."""
    if block.order == 0:
        return False
    scaled = scipy.linalg.matrix_balance(block.A, permute=False)[0]
    sizes = scipy.linalg.svdvals(np.eye(block.order) - scaled)
    return bool(sizes[-1] <= _AT_ONE * max(1.0, float(sizes[0])))


def _static_gains(block: TrackingController) -> tuple[float, float]:
    if block.order == 0:
        return float(block.D[0]), float(block.D[1])
    at_rest = np.linalg.solve(np.eye(block.order) - block.A, block.B)
    r, y = (block.C @ at_rest + block.D).tolist()
    return r, y


def _root(value: Any, guess: float, reference: float) -> float:
    """Bracket a root around the guess and find it."""
    missed = value(guess)
    if missed == 0.0:
        return guess
    reach = 0.1 * max(abs(guess), abs(missed))
    for _ in range(_WIDENINGS):
        low, high = guess - reach, guess + reach
        ends = value(low), value(high)
        if np.isfinite(ends).all() and ends[0] * ends[1] <= 0.0:
            return float(scipy.optimize.brentq(value, low, high, xtol=1e-15 * reach, rtol=1e-15))
        reach *= 2.0
    raise InputError(
        f"the loop does not come to rest at a reference of {reference:.6g}, which the hysteresis "
        "does not reach; begin within its range, or give start='rest'"
    )


def _resting_state(block: TrackingController, given: Array, v: float) -> Array:
    """Give the smallest state that stays and gives v."""
    if block.order == 0:
        return np.zeros(0)
    # Rows of equal size, or the one that moves in small steps would hardly count.
    rows = np.vstack([block.A - np.eye(block.order), block.C])
    wanted = np.append(-block.B @ given, v - float(block.D @ given))
    sizes = np.abs(rows).max(axis=1)
    # A row of rounding stays one: made equal, it would count as much as v.
    sizes[np.append(sizes[:-1] <= _AT_ONE, sizes[-1] == 0.0)] = 1.0
    columns = np.abs(rows / sizes[:, None]).max(axis=0)
    columns[columns == 0.0] = 1.0
    x0 = np.linalg.lstsq(rows / sizes[:, None] / columns, wanted / sizes, rcond=1e-13)[0] / columns
    size = np.append(np.abs(block.B) @ np.abs(given), abs(v) + np.abs(block.D) @ np.abs(given))
    if (np.abs(rows @ x0 - wanted) > _KEPT * (size + np.abs(rows) @ np.abs(x0))).any():
        raise SolverError(
            "the block has no state in which it rests at the start of the reference; give "
            "start='rest'"
        )
    return np.asarray(x0)


def _with_start(block: TrackingController, x0: Array, u0: float) -> TrackingController:
    return TrackingController.from_dict({**block.to_dict(), "x0": x0.tolist(), "u0": u0})
