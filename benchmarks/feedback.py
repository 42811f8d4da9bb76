"""Designed feedback and feedforward on stages of one resonance: stability, Ms, tracking."""

from __future__ import annotations

import itertools
import time
from typing import Any

import numpy as np

import hyst
from hyst.control import (
    TrackingController,
    closed_loop_poles,
    compare_loops,
    design_controller,
    loop_margins,
    reference_feedforward,
    simulate_closed_loop,
)

DT = 1e-4
HYSTERESIS = hyst.PrandtlIshlinskii([0.1, 0.08, 0.05, 0.05], [1.0, 2.0, 4.0, 8.0], 0.5)
PI = ([0.02, 150.0], [1.0, 0.0])
STAGE_HZ, STAGE_DAMPING = 500.0, 0.05


def main() -> None:
    print_designs()
    print_tracking()
    print_comparison()


def stage(hertz: float, damping: float) -> tuple[list[float], list[float]]:
    w = 2.0 * np.pi * hertz
    return [w * w], [1.0, 2.0 * damping * w, w * w]


def sine(hertz: float) -> np.ndarray:
    return 10.0 * np.sin(2.0 * np.pi * hertz * np.arange(round(1.0 / DT)) * DT)


def percent(reference: np.ndarray, controller: Any, delay: float, **options: Any) -> float:
    """Rms tracking error in percent of the amplitude, around the 500 Hz stage."""
    given = {"inverse": HYSTERESIS.inverse(), "feedforward": None, "noise": 0.0, **options}
    block = TrackingController.from_continuous(
        controller, DT, inverse=given["inverse"], feedforward=given["feedforward"]
    )
    loop = simulate_closed_loop(
        reference, DT, plant=stage(STAGE_HZ, STAGE_DAMPING), controller=block,
        hysteresis=HYSTERESIS, delay=delay, noise=given["noise"], settle=0.3,
    )  # fmt: skip
    return 10.0 * loop.rms_error


def print_designs() -> None:
    """Stages, dampings, delays: what is designed, and the worst over 21 resonances within 5 %."""
    print("designed at 10 kHz, Ms <= 1.5 with the resonance off by up to 5 %")
    print(
        "   Hz  damping  delay  kind notches      ki  reduces to  worst Ms  max |z|  error at Hz/50"
    )
    worst_peak = worst_radius = spent = count = 0.0
    for hertz, damping, late in itertools.product(
        (100.0, 500.0, 2000.0), (0.01, 0.05, 0.3), (0.0, 1.0, 2.0)
    ):
        delay = late * DT
        begin = time.process_time()
        design = design_controller(stage(hertz, damping), dt=DT, delay=delay)
        spent, count = spent + time.process_time() - begin, count + 1.0
        block = TrackingController.from_continuous(design, DT)
        peak = radius = 0.0
        for factor in np.linspace(0.95, 1.05, 21):
            moved = stage(factor * hertz, damping)
            radius = max(radius, np.abs(closed_loop_poles(moved, block, delay=delay)).max())
            if round(20.0 * (factor - 0.95) / 0.1) % 3 == 0:
                peak = max(peak, loop_margins(moved, block, delay=delay).peak_sensitivity)
        fed = TrackingController.from_continuous(
            design, DT, inverse=HYSTERESIS.inverse(), feedforward=True
        )
        reference = sine(hertz / 50.0)
        loop = simulate_closed_loop(
            reference, DT, plant=stage(hertz, damping), controller=fed, hysteresis=HYSTERESIS,
            delay=delay, settle=0.5,
        )  # fmt: skip
        worst_peak, worst_radius = max(worst_peak, peak), max(worst_radius, radius)
        print(
            f"{hertz:5.0f} {damping:8.2f} {late:6.0f} {design.kind:>5s} {len(design.notches):7d} "
            f"{design.ki:7.1f} {design.margins.rejection / 2.0 / np.pi:8.1f} Hz {peak:9.3f} "
            f"{radius:8.4f} {10.0 * loop.rms_error:12.3f} %",
            flush=True,
        )
    print(f"worst of all: Ms {worst_peak:.4f}, |z| {worst_radius:.5f}; {spent / count:.2f} s each")


def print_tracking() -> None:
    """The stage of 500 Hz, damping 0.05, 10 um: rms error in percent of the amplitude."""
    plant = stage(STAGE_HZ, STAGE_DAMPING)
    print("\n500 Hz, damping 0.05, 10 kHz: rms error, percent of the amplitude of 10 um")
    print("                                              10 Hz   20 Hz   50 Hz")
    inexact = hyst.Affine(0.9) @ HYSTERESIS.inverse()
    cases: list[tuple[str, float, dict[str, Any]]] = [
        ("", 0.0, {}),
        (", 1 sample late", DT, {}),
        (", noise 0.05 um", 0.0, {"noise": 0.05}),
        (", 0.9 of the inverse", 0.0, {"inverse": inexact}),
    ]
    for words, delay, options in cases:
        designed = design_controller(plant, dt=DT, delay=delay)
        second = reference_feedforward(plant, DT, delay, 2)
        loops: dict[str, tuple[Any, Any]] = {
            "PI": (PI, None),
            "PI, static": (PI, True),
            "PI, order 2": (PI, second),
            "none, static": (0.0, True),
            "designed": (designed, None),
            "designed, static": (designed, True),
            "designed, order 2": (designed, second),
        }
        for name, (C, F) in loops.items():
            found = [
                percent(sine(f), C, delay, feedforward=F, **options) for f in (10.0, 20.0, 50.0)
            ]
            print(f"{name + words:44s}" + "".join(f"{each:8.3f}" for each in found))


def print_comparison() -> None:
    """What inverse, feedback and feedforward are worth there, with noise."""
    plant = stage(STAGE_HZ, STAGE_DAMPING)
    print("\n10 Hz, 10 um, noise 0.05 um, designed controller")
    found = compare_loops(
        sine(10.0), DT, plant=plant, controller=design_controller(plant, dt=DT),
        hysteresis=HYSTERESIS, noise=0.05, settle=0.3,
    )  # fmt: skip
    print(found.summary())
