"""Whether a loop that was simulated is proven safe, only simulated, or not safe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, final

import numpy as np

from hyst.compensation import slope_range
from hyst.control.closed_loop import ClosedLoop
from hyst.control.sampled.certificate import plant_of_block
from hyst.control.sampled.slopes import sampled_slope_failing, sampled_slope_proof
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.operators import Affine, Operator

Standing: TypeAlias = Literal["proven", "simulated", "not safe"]


@final
@dataclass(frozen=True)
class LoopJudgement:
    """What is known of the stability of a loop.

    Parameters
    ----------
    standing
        ``"proven"`` for every plant within Wu and all slopes of hysteresis after inverse;
        ``"simulated"``, without a proof; or ``"not safe"``.
    reason
        Why, in words.
    slopes
        Least and largest slope that hysteresis after inverse can have; None if not known.
    met
        Those it had in the simulation.
    proof
        What has to be below 1, of ``sampled_slope_proof``; None if the slopes are not known.
    failing
        A slope met at which some plant within Wu is unstable; None if there is none.
    """

    standing: Standing
    reason: str
    slopes: tuple[float, float] | None
    met: tuple[float, float]
    proof: float | None
    failing: float | None


def judge_loop(
    block: TrackingController,
    plant: Any,
    Wu: Any,
    hysteresis: Operator | None,
    loop: ClosedLoop,
    *,
    delay: float = 0.0,
    slope_error: float = 0.0,
) -> LoopJudgement:
    """Judge a sampled loop: by proof where there is one, by what it met where not.

    Parameters
    ----------
    block
        What ran, with its inverse.
    plant, Wu, delay
        As in ``sampled_certificate``.
    hysteresis
        The true one; None if there is none.
    loop
        What came of the simulation. What is proven holds for |v| up to the largest in it.
    slope_error
        By how much, of itself, the slope of the true hysteresis may be off that of the model: then
        no inverse of the model is exact.

    Returns
    -------
    LoopJudgement

    Raises
    ------
    InputError
        As ``sampled_certificate``.

    Examples
    --------
    >>> from hyst.control import simulate_closed_loop
    >>> block = TrackingController.from_continuous(([20.0], [1.0, 0.0]), dt=1e-3)
    >>> stage = ([4e5], [1.0, 40.0, 4e5])
    >>> loop = simulate_closed_loop(np.ones(100), 1e-3, plant=stage, controller=block)
    >>> judge_loop(block, stage, 0.3, None, loop).standing
    'proven'
    """
    late = plant_of_block(plant, block, delay)
    slopes, met = _slopes(block, hysteresis, loop), _off(slopes_met(loop), slope_error)
    slopes = None if slopes is None else _off(slopes, slope_error)
    if loop.diverged_at is not None:
        said = f"diverges at {loop.diverged_at:.4g} s"
        return LoopJudgement("not safe", said, slopes, met, None, None)
    proof = None if slopes is None else sampled_slope_proof(block, late, slopes, Wu)[0]
    if proof is not None and proof < 1.0:
        if limits_met(block, loop):
            said = "not proven while the drive meets its limits, as it did"
            return LoopJudgement("simulated", said, slopes, met, proof, None)
        return LoopJudgement("proven", f"{proof:.3g} < 1", slopes, met, proof, None)
    failing = sampled_slope_failing(block, late, met, Wu)
    if failing is not None:
        said = f"at a slope of {failing:.3g}, which it met, a plant within Wu is unstable"
        return LoopJudgement("not safe", said, slopes, met, proof, failing)
    why = "slopes are not known" if proof is None else f"{proof:.3g} is not below 1"
    return LoopJudgement("simulated", f"not proven: {why}", slopes, met, proof, None)


def limits_met(block: TrackingController, loop: ClosedLoop) -> bool:
    """Tell whether the drive met the block's own limits, or was held for no drive belongs to v.

    Parameters
    ----------
    block
        What ran.
    loop
        What came of it.
    """
    if loop.held:
        return True
    low, high = (-np.inf, np.inf) if block.limits is None else block.limits
    if loop.u.size and (loop.u.min() <= low or loop.u.max() >= high):
        return True
    if block.rate is None:
        return False
    # A difference of two drives is known to the rounding of both.
    most = block.rate * block.dt - 1e-12 * float(np.abs(loop.u).max(initial=0.0))
    return bool((np.abs(np.diff(loop.u)) >= most).any())


def slopes_met(loop: ClosedLoop) -> tuple[float, float]:
    """Give least and largest slope of hysteresis after inverse while v moved; 1, 1 if it did not.

    Parameters
    ----------
    loop
        A simulated loop.

    Returns
    -------
    tuple of float
    """
    step = np.diff(loop.v)
    # Where v nearly rests, at a turn, a quotient of differences is rounding.
    moving = np.abs(step) > 1e-3 * np.abs(step).max(initial=0.0)
    if not moving.any():
        return 1.0, 1.0
    slopes = np.diff(loop.eta)[moving] / step[moving]
    return float(slopes.min()), float(slopes.max())


def _off(slopes: tuple[float, float], error: float) -> tuple[float, float]:
    """Widen slopes by a relative error; what falls widens the other way."""
    less, more = max(1.0 - error, 0.0), 1.0 + error
    low, high = slopes
    return low * (less if low >= 0.0 else more), high * (more if high >= 0.0 else less)


def _slopes(
    block: TrackingController, hysteresis: Operator | None, loop: ClosedLoop
) -> tuple[float, float] | None:
    """Slopes that hysteresis after inverse may have; None where nothing is known of them."""
    if hysteresis is None and block.inverse is None:
        return 1.0, 1.0
    true = Affine(1.0) if hysteresis is None else hysteresis
    inverse = Affine(1.0) if block.inverse is None else block.inverse
    if true.is_invertible() and true.inverse() == inverse:
        return 1.0, 1.0
    reach = float(np.abs(loop.v).max(initial=0.0))
    if reach == 0.0:
        return None
    try:
        return slope_range(true, inverse, reach)
    except InputError:
        return None
