"""Frequency responses of the loop that a sampled block closes, for looking at."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.frequency_responses import LoopResponses
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.certificate import plant_of_block, stable_weight
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.tracking_controller import TrackingController

Array = NDArray[np.float64]


def sampled_responses(
    block: TrackingController,
    plant: Any,
    Wu: Any,
    Wp: Any = 0.0,
    *,
    delay: float = 0.0,
    true_plant: Any = None,
) -> LoopResponses:
    """Compute the responses of S1 Fig. 5 for the block as it runs, up to half the sample rate.

    Parameters
    ----------
    block, plant, Wu, Wp, delay
        As in ``sampled_certificate``.
    true_plant
        The plant that ``S`` and ``S_without`` are of; the nominal one if left out.

    Returns
    -------
    LoopResponses
        ``Wu_T`` with all that folds down, ``left`` what the observer leaves of a disturbance.

    Raises
    ------
    InputError
        As ``sampled_certificate``.
    """
    loop = BlockLoop(block, plant_of_block(plant, block, delay))
    weights = stable_weight(Wu, "Wu"), stable_weight(Wp, "Wp")
    w = loop.grid(*weights)
    own = loop.at(w)
    true = (
        loop if true_plant is None else BlockLoop(block, plant_of_block(true_plant, block, delay))
    )
    z = np.exp(1j * w * loop.dt)
    P = true.plant.system.response(z)[:, 0, 0]
    K, alone = (-each.response(z)[:, 0, 0] for each in (loop.feedback, loop.controller))
    with np.errstate(divide="ignore"):
        return LoopResponses(
            w=w,
            left=np.abs(own.E),
            Q=np.abs(1.0 - own.E),
            Wp_inverse=1.0 / np.abs(weight_response(weights[1], w)),
            Wu_T=folded_uncertainty(loop.plant, weights[0], w) * np.abs(own.N),
            S=np.abs(P / (1.0 + K * P)),
            S_without=np.abs(P / (1.0 + alone * P)),
        )
