"""Is SAFE true? Random specs of observers, their sampled blocks, and plants that may break them.

    python -m benchmarks safe_blocks

For each of 200 random stages (order 2 to 4, sample times from far too slow to fast, delays of
computation up to two samples, reduced or exact inverses) an observer is designed and its block
certified; then 100 plants within Wu are tried on each, the first of them directed, the others drawn
at random, and of those that come closest the loop is simulated, hysteresis and inverse included.
Prints
- how many blocks are called safe, and how many of these any plant broke (there must be none),
- of those refused, for how many a plant was found that breaks them, and for how many there was one
  or the margin is below 1 (at least 0.9 of them asked).

HYST_SAFE_SPECS and HYST_SAFE_PLANTS shorten it.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import hyst
from hyst.control import (
    TrackingController,
    design_disturbance_observer,
    sampled_certificate,
    simulate_closed_loop,
    stress,
    try_block,
)
from hyst.errors import HystError


@dataclass(frozen=True)
class Spec:
    """One random spec: what a user could have written."""

    plant: tuple[list[float], list[float]]
    controller: tuple[list[float], list[float]]
    Wu: tuple[list[float], list[float]]
    Wp: tuple[list[float], list[float]]
    dt: float
    delay: float
    hysteresis: hyst.Operator
    inverse: hyst.Operator


def random_specs(seed: int) -> Iterator[Spec]:
    """Draw specs without end."""
    rng = np.random.default_rng(seed)
    while True:
        f0 = 10.0 ** rng.uniform(1.5, 3.0)
        w0, damping = 2.0 * np.pi * f0, 10.0 ** rng.uniform(-1.7, 0.0)
        num, den = [w0**2], [1.0, 2.0 * damping * w0, w0**2]
        if rng.uniform() < 0.4:
            w1, z1 = w0 * rng.uniform(1.5, 6.0), 10.0 ** rng.uniform(-1.5, 0.0)
            num = list(np.polymul(num, [w1**2]))
            den = list(np.polymul(den, [1.0, 2.0 * z1 * w1, w1**2]))
        ki = w0 * min(damping, 0.5) * rng.uniform(0.1, 0.8)
        controller = ([rng.uniform(0.0, 0.2), ki], [1.0, 0.0])
        # Small at rest, up to some times 1 above a corner.
        low, high = 10.0 ** rng.uniform(-2.0, -0.7), 10.0 ** rng.uniform(-0.3, 0.7)
        corner = w0 * rng.uniform(1.0, 6.0)
        Wu = ([high / corner, low], [1.0 / corner, 1.0])
        band = w0 * rng.uniform(0.01, 0.3)
        Wp = ([0.5, band], [1.0, 1e-3 * band])
        dt = 1.0 / (f0 * 10.0 ** rng.uniform(0.7, 2.0))
        delay = dt * rng.choice([0.0, rng.uniform(0.0, 2.0)])
        r = np.sort(rng.uniform(0.5, 9.0, 5))
        stage = hyst.PrandtlIshlinskii(rng.uniform(0.02, 0.15, 5), r, rng.uniform(0.5, 1.0))
        exact = stage.inverse()
        inverse = exact if rng.uniform() < 0.5 else hyst.Affine(rng.uniform(0.6, 1.0)) @ exact
        yield Spec((num, den), controller, Wu, Wp, dt, delay, stage, inverse)


def judged(spec: Spec, plants: int, discrete: bool, seed: int) -> tuple[bool, bool, float]:
    """Give whether the block is called safe, whether a plant broke it, and its margin."""
    late = {"dt": spec.dt, "delay": spec.delay} if discrete else {"starts": 8}
    design = design_disturbance_observer(
        spec.plant, spec.controller, spec.Wu, spec.Wp, method="descent", **late
    )
    block = TrackingController.from_continuous(
        spec.controller, spec.dt, observer=design, inverse=spec.inverse
    )
    certificate = sampled_certificate(block, spec.plant, spec.Wu, spec.Wp, delay=spec.delay)
    t = np.arange(3000) * spec.dt
    reference = 8.0 * np.sin(2.0 * np.pi * t * 3.0 / t[-1])
    tried = try_block(
        block, reference, plant=spec.plant, Wu=spec.Wu, hysteresis=spec.hysteresis,
        delay=spec.delay,
    )  # fmt: skip
    safe = certificate.robustly_stable and tried.judgement.standing != "not safe"
    broken = False
    for slope in {1.0, *tried.judgement.met}:
        found = stress(block, spec.plant, spec.Wu, plants, delay=spec.delay, slope=slope, seed=seed)
        broken |= not found.holds
        if safe:
            loop = simulate_closed_loop(
                reference, spec.dt, plant=found.worst, controller=block,
                hysteresis=spec.hysteresis, delay=spec.delay,
            )  # fmt: skip
            broken |= loop.diverged_at is not None
    return safe, broken, certificate.robust_stability_margin


def counted(discrete: bool, specs: int, plants: int) -> str:
    """Judge all specs, and say how many were right."""
    safe = wrong = refused = found = broken_or_below = 0
    start = time.process_time()
    for seed, spec in zip(range(specs), random_specs(19), strict=False):
        try:
            is_safe, broken, margin = judged(spec, plants, discrete, seed)
        except HystError:
            continue
        safe += is_safe
        wrong += is_safe and broken
        refused += not is_safe
        found += not is_safe and broken
        broken_or_below += not is_safe and (broken or margin < 1.0)
    took = time.process_time() - start
    return (
        f"{safe} safe, {wrong} of them broken; {refused} refused, {found} of them broken, "
        f"{broken_or_below} broken or with a margin below 1; {specs - safe - refused} specs "
        f"refused as input; {took:.0f} s"
    )


def main() -> None:
    """Print both tables."""
    specs = int(os.environ.get("HYST_SAFE_SPECS", "200"))
    plants = int(os.environ.get("HYST_SAFE_PLANTS", "100"))
    print(f"{specs} specs, {plants} plants each")
    print("continuous design, sampled:", counted(False, specs, plants))
    print("designed in discrete time: ", counted(True, specs, plants))


if __name__ == "__main__":
    main()
