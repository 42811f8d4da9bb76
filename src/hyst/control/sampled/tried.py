"""A block tried in the loop: simulated as it runs, with and without noise, and judged."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from hyst.control.closed_loop import ClosedLoop
from hyst.control.closed_loop_simulation import simulate_closed_loop
from hyst.control.sampled.judged import LoopJudgement, judge_loop
from hyst.control.tracking_controller import TrackingController
from hyst.operators import Operator


@final
@dataclass(frozen=True, eq=False)
class TriedLoop:
    """What came of a block in the loop, and what is known of its safety.

    Parameters
    ----------
    block
        What ran.
    loop
        Its signals, with the noise.
    judgement
        Proven, simulated or not safe.
    noise_in_drive
        Standard deviation of what the noise alone makes of the drive; 0 without noise.
    noise_jitter
        That of its change from one sample to the next.
    """

    block: TrackingController
    loop: ClosedLoop
    judgement: LoopJudgement
    noise_in_drive: float
    noise_jitter: float


def try_block(
    block: TrackingController,
    reference: ArrayLike,
    *,
    plant: Any,
    Wu: Any = 0.0,
    hysteresis: Operator | None = None,
    true_plant: Any = None,
    noise: float = 0.0,
    delay: float = 0.0,
    slope_error: float = 0.0,
    **options: Any,
) -> TriedLoop:
    """Simulate a block as it runs, and judge it.

    Parameters
    ----------
    block
        The block.
    reference
        Wanted output at the block's samples, shape (N,).
    plant, Wu
        Nominal plant and its uncertainty, which the judgement is of.
    hysteresis
        The true one.
    true_plant
        What is simulated; the nominal one if left out.
    noise
        Standard deviation of the sensor's noise at a sample.
    slope_error
        As in ``judge_loop``.
    delay, options
        As in ``simulate_closed_loop``: disturbance, seed, settle and so on.

    Returns
    -------
    TriedLoop

    Raises
    ------
    InputError
        As ``simulate_closed_loop`` and ``sampled_certificate``.

    Examples
    --------
    >>> block = TrackingController.from_continuous(([20.0], [1.0, 0.0]), dt=1e-3)
    >>> found = try_block(block, np.ones(300), plant=([4e5], [1.0, 40.0, 4e5]), noise=0.01)
    >>> found.judgement.standing, 0.0 < found.noise_jitter < 0.01
    ('proven', True)
    """
    true = plant if true_plant is None else true_plant

    def run(spread: float) -> ClosedLoop:
        return simulate_closed_loop(
            reference, block.dt, plant=true, controller=block, hysteresis=hysteresis,
            noise=spread, delay=delay, **options,
        )  # fmt: skip

    loop = run(noise)
    judgement = judge_loop(block, plant, Wu, hysteresis, loop, delay=delay, slope_error=slope_error)
    in_drive, jitter = (0.0, 0.0) if noise == 0.0 else _of_noise(loop, run(0.0))
    return TriedLoop(block, loop, judgement, in_drive, jitter)


def _of_noise(noisy: ClosedLoop, quiet: ClosedLoop) -> tuple[float, float]:
    if noisy.diverged_at is not None or quiet.diverged_at is not None:
        return math.inf, math.inf
    more = (noisy.u - quiet.u)[noisy.t >= noisy.settle]
    return float(more.std()), float(np.diff(more).std()) if more.size > 1 else 0.0
