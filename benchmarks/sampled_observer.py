"""What a design in discrete time buys over sampling the one in continuous time.

    python -m benchmarks sampled_observer

For the paper's example at 0.1 and 0.8 ms, a stage of 200 Hz at 10 kHz and one of 500 Hz at 10 kHz
with a delay of 1.5 samples, each block certified as it runs: the stacked norm, a |K S| with all
aliases (below 1: stable for every plant within Wu), |Wp E| (below 1: what Wp asks for), the
observer's noise gain, v per white noise of the sensor, and seconds of processor time.
"""

from __future__ import annotations

import math
import time
from typing import Any, NamedTuple

from hyst.control import (
    DisturbanceObserver,
    TrackingController,
    design_disturbance_observer,
    sampled_certificate,
)
from hyst.errors import HystError

OMEGA = 2.0 * math.pi * 90.0
MODE = 2.0 * math.pi * 500.0


class Case(NamedTuple):
    """A loop: plant, controller, Wu, Wp, sample time and delay."""

    name: str
    plant: Any
    controller: Any
    Wu: Any
    Wp: Any
    dt: float
    delay: float


PAPER = (
    ([OMEGA**2], [1.0, 1.6 * OMEGA, OMEGA**2]),
    ([4.0, 8.0], [1.0, 0.0]),
    ([-1.0, -960.0, 0.0], [1.0, 960.0, 2400.0**2]),
    ([0.5, 64.0 * math.pi], [1.0, 0.2]),
)
SLOW_WP = ([0.5, 94.25], [1.0, 0.1])
CASES = (
    Case("S1, 0.1 ms", *PAPER, 1e-4, 0.0),
    Case("S1, 0.1 ms, half a sample late", *PAPER, 1e-4, 5e-5),
    Case("S1, 0.8 ms", *PAPER, 8e-4, 0.0),
    Case(
        "200 Hz, 0.1 ms",
        ([1579136.7], [1.0, 75.398, 1579136.7]),
        ([20.0], [1.0, 0.0]),
        ([3.9789e-4, 0.02], [3.9789e-5, 1.0]),
        SLOW_WP,
        1e-4,
        0.0,
    ),
    Case(
        "500 Hz, 0.1 ms, 1.5 samples late",
        ([MODE**2], [1.0, 0.06 * MODE, MODE**2]),
        ([60.0], [1.0, 0.0]),
        ([4e-4, 0.02], [4e-5, 1.0]),
        SLOW_WP,
        1e-4,
        1.5e-4,
    ),
)

WAYS: dict[str, dict[str, Any]] = {
    "least norm, sampled": {"flat": 0.0},
    "continuous, sampled": {},
    "one more order, sampled": {"order": "auto"},
    "discrete": {"dt": True},
    "discrete, order auto": {"dt": True, "order": "auto"},
}


def designed(case: Case, options: dict[str, Any]) -> DisturbanceObserver:
    """Design in one of the ways."""
    given = dict(options)
    if given.pop("dt", False):
        given |= {"dt": case.dt, "delay": case.delay}
    return design_disturbance_observer(case.plant, case.controller, case.Wu, case.Wp, **given)


def row(case: Case, name: str, design: DisturbanceObserver | None, seconds: float) -> str:
    """Certify the block of a design, and give its row."""
    block = TrackingController.from_continuous(case.controller, case.dt, observer=design)
    c = sampled_certificate(block, case.plant, case.Wu, case.Wp, delay=case.delay)
    gain = "" if design is None else f"{design.certificate.observer_noise_gain:.3g}"
    states = "" if design is None else f"{design.observer.order}"
    return (
        f"{name:26s} {states:>6s} {c.stacked_norm:8.4g} {c.uncertainty_norm:8.4f} "
        f"{c.performance_norm:8.4g} {gain:>9s} {c.noise_rms:9.3g} {seconds:6.2f}"
    )


def main() -> None:
    for case in CASES:
        print(f"{case.name}")
        print(f"{'':26s} {'states':>6s} {'stack':>8s} {'a|KS|':>8s} {'Wp E':>8s} "
              f"{'Q/P':>9s} {'v rms':>9s} {'s':>6s}")  # fmt: skip
        print(row(case, "no observer", None, 0.0))
        for name, options in WAYS.items():
            begin = time.process_time()
            try:
                design = designed(case, options)
            except HystError as reason:
                print(f"{name:26s} {reason}")
                continue
            print(row(case, name, design, time.process_time() - begin), flush=True)
        print()


if __name__ == "__main__":
    main()
