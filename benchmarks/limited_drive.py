"""A loop whose drive is limited: how long it takes to come back, and what the limits cost.

The repaired example of S1 (two-mode plant, 10 plays, printed observer), its drive limited to +-35.
The reference steps to 45, which is out of reach, and after 2 s back to 10. Prints, by controller
and inverse, with the observer,
- seconds from the step back until the error stays below 0.5: of the block without limits behind an
  amplifier that clips, of the block with limits, also with a rate of 2000 a second, and of a loop
  that was never limited, whose reference stops at what can be reached;
- the largest estimate of the observer, without and with limits;
- nanoseconds a step, and the ratio to the block without limits.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.closed_loop import CONTROLLER, EXACT, HYSTERESIS, OBSERVER, PLANT
from benchmarks.timing import interleaved, ratio, report_times
from hyst.control import ClosedLoop, TrackingController, simulate_closed_loop

Array = NDArray[np.float64]

DT, BACK, LIMITS = 1e-4, 2.5, (-35.0, 35.0)
T = np.arange(round(4.5 / DT)) * DT
FAR = np.where(T < 0.5, 0.0, np.where(T < BACK, 45.0, 10.0))
NEAR = np.minimum(FAR, float(HYSTERESIS([0.0, 35.0])[-1]))
CLIPPING = hyst.DeadZone([1.0, -1.0, -1.0], [0.0, 35.0, -35.0])
FED_FORWARD = "4 + 8/s of the error, and the reference"
CONTROLLERS: dict[str, Any] = {
    "4 + 8/s": CONTROLLER,
    "4 + 8/s, with feedforward": FED_FORWARD,
    "1 + 200/s": ([1.0, 200.0], [1.0, 0.0]),
    "60/s": ([60.0], [1.0, 0.0]),
    "0.5 + 60/s + 0.001 s, filtered": ([1.1e-3, 0.512, 60.0], [2e-4, 1.0, 0.0]),
}
INVERSES = {"exact": EXACT, "0.7 of it": hyst.Affine(0.7) @ EXACT}


def main() -> None:
    """Print the table, and the cost of a step."""
    heads = ("C", "inverse", "wound up", "limits", "and rate", "never", "d_hat wound", "d_hat")
    print(f"{heads[0]:31s} {heads[1]:9s} " + " ".join(f"{each:>11s}" for each in heads[2:]))
    for name, controller in CONTROLLERS.items():
        for called, inverse in INVERSES.items():
            row = _row(functools.partial(_block, controller, inverse))
            print(f"{name:31s} {called:9s} " + " ".join(f"{each:11.4g}" for each in row))
    _print_cost()


def _row(make: Callable[..., TrackingController]) -> list[float]:
    free, limited = make(), make(limits=LIMITS)
    slow = make(limits=LIMITS, rate=2e3)
    wound = _loop(free, FAR, HYSTERESIS @ CLIPPING)
    held, moved, never = _loop(limited, FAR), _loop(slow, FAR), _loop(free, NEAR)
    times = [_recovery(each) for each in (wound, held, moved, never)]
    return [*times, float(np.abs(wound.d_hat).max()), float(np.abs(held.d_hat).max())]


def _block(controller: Any, inverse: hyst.Operator, **limits: Any) -> TrackingController:
    if controller is FED_FORWARD:
        controller, limits = CONTROLLER, limits | {"feedforward": True}
    return TrackingController.from_continuous(
        controller, DT, observer=OBSERVER, inverse=inverse, **limits
    )


def _loop(
    block: TrackingController, r: Array, hysteresis: hyst.Operator = HYSTERESIS
) -> ClosedLoop:
    return simulate_closed_loop(r, DT, plant=PLANT, controller=block, hysteresis=hysteresis)


def _recovery(done: ClosedLoop) -> float:
    far = np.flatnonzero(np.abs(done.e[round(BACK / DT) :]) > 0.5)
    return float((far[-1] + 1) * DT) if far.size else 0.0


def _print_cost() -> None:
    rng = np.random.default_rng(0)
    y_ref, y = 30.0 * np.sin(np.arange(100_000) * 0.01), rng.normal(0.0, 0.1, 100_000)
    blocks = {
        "without limits": _block(CONTROLLER, EXACT),
        "limits that are not met": _block(CONTROLLER, EXACT, limits=(-1e9, 1e9)),
        "limits met at most samples": _block(CONTROLLER, EXACT, limits=LIMITS),
    }
    works = {name: functools.partial(each.run, y_ref, y) for name, each in blocks.items()}
    times = interleaved(works)
    for name, of_run in times.items():
        step = 1e9 * float(np.median(of_run)) / y.size
        over = ratio(times, name, "without limits")
        if name != "without limits":
            report_times(f"{name}, over without", times, name, "without limits", better="smaller")
        print(f"{name:31s} {step:7.1f} ns a step, {over:.2f} times")


if __name__ == "__main__":
    main()
