"""Closed loops: time of a step, and how errors fall with dt.

Prints, for one machine and one run of the repaired example of S1 (two-mode plant, PI controller,
printed observer, 10 plays, inverse at 0.7),
- nanoseconds a step with the controller in continuous time and as a target runs it, and ratios to
  the same equations in a NumPy loop, compiled by numba, and in python-control, by hand and as
  ``closed_loop_system`` joins them there; matrices and reference are made anew by hyst and numba,
- the step of the TrackingController from Python,
- outputs over dt against the finest, with either controller.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.signal
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, ratio, report, spread
from hyst.control import TrackingController, closed_loop_system, simulate_closed_loop

Array = NDArray[np.float64]

W1, W2 = 2.0 * np.pi * 90.0, 2400.0
PLANT = (
    np.array([(W1 * W2) ** 2]),
    np.polymul([1.0, 1.6 * W1, W1**2], [1.0, 0.4 * W2, W2**2]),
)
CONTROLLER = ([4.0, 8.0], [1.0, 0.0])
L = np.array([-117.381, 0.197, 17113.1])
NOMINAL = np.array([[-1.6 * W1, -(W1**2), 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
OBSERVER = (
    NOMINAL - np.outer(L, [0.0, W1**2, 0.0]),
    np.column_stack([[1.0, 0.0, 0.0], L]),
    np.array([[0.0, 0.0, 1.0]]),
    np.zeros((1, 2)),
)
P = np.array([0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7])
HYSTERESIS = hyst.PrandtlIshlinskii(P, np.arange(4.0, 41.0, 4.0), 0.1)
EXACT = HYSTERESIS.inverse()
INVERSE = hyst.Affine(0.7) @ EXACT
DT = 2e-5


def main() -> None:
    """Print both tables."""
    print_times()
    print_convergence()


def reference(samples: int, dt: float) -> Array:
    t = np.arange(samples) * dt
    return np.asarray(18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t))


def simulated(samples: int, dt: float, controller: Any = CONTROLLER) -> Array:
    given = {"plant": PLANT, "controller": controller, "hysteresis": HYSTERESIS}
    if not isinstance(controller, TrackingController):
        given |= {"observer": OBSERVER, "inverse": INVERSE}
    return simulate_closed_loop(reference(samples, dt), dt, **given).y


def print_times() -> None:
    """Print nanoseconds a step, and ratios."""
    many, few = 200_000, 4_000
    sampled = TrackingController.from_continuous(CONTROLLER, DT, observer=OBSERVER, inverse=INVERSE)
    begin = time.perf_counter()
    simulated(1_000_000, DT)
    print(f"a million steps, observer and all: {time.perf_counter() - begin:.2f} s")
    joint = joint_matrices(DT)
    steps = {"hyst": many, "hyst, sampled controller": many, "NumPy loop": few}
    works: dict[str, Callable[[], object]] = {
        "hyst": lambda: simulated(many, DT),
        "hyst, sampled controller": lambda: simulated(many, DT, sampled),
        "NumPy loop": lambda: loop_with_vectors(*joint, reference(few, DT)),
    }
    if importlib.util.find_spec("numba") is not None:
        import numba

        compiled = numba.njit(plain_loop)
        constants = (EXACT.p0, EXACT.p, EXACT.r, HYSTERESIS.p0, HYSTERESIS.p, HYSTERESIS.r)
        works["numba"] = lambda: compiled(*joint_matrices(DT), reference(many, DT), *constants)
        steps["numba"] = many
    times = interleaved(works, seconds=6.0)
    print("                            ns a step   over hyst")
    for name, each in times.items():
        over = ratio(times, name, "hyst") * steps["hyst"] / steps[name]
        if name != "hyst":
            report(f"{name} over hyst, a step", over, spread=spread(times, name, "hyst"))
        print(f"{name:26s} {1e9 * np.median(each) / steps[name]:10.0f} {over:11.2f}")
    print_control(1e9 * float(np.median(times["hyst"])) / many)
    step = sampled.stepper()
    begin = time.perf_counter()
    for value in reference(many, DT).tolist():
        step(value, 0.0)
    print(f"step(y_ref, y) from Python: {1e9 * (time.perf_counter() - begin) / many:.0f} ns")


def print_convergence() -> None:
    """Print differences to the finest loop."""
    finest, seconds = 1.25e-6, 0.5
    best = simulated(round(seconds / finest), finest)
    print("largest difference of y to dt = 1.25 us, half a second, output up to 31")
    print("  dt [us]   continuous   tustin      zoh")
    for dt in (8e-5, 4e-5, 2e-5, 1e-5, 5e-6):
        wanted, samples = best[:: round(dt / finest)], round(seconds / dt)
        controllers = [CONTROLLER] + [
            TrackingController.from_continuous(
                CONTROLLER, dt, observer=OBSERVER, inverse=INVERSE, method=method
            )
            for method in ("tustin", "zoh")
        ]
        gaps = [np.abs(simulated(samples, dt, each) - wanted).max() for each in controllers]
        print(f"  {1e6 * dt:7.2f} {gaps[0]:12.2e} {gaps[1]:8.2e} {gaps[2]:8.2e}")


def joint_matrices(dt: float) -> tuple[Array, Array, Array, Array]:
    """Controller, plant and observer by hand: x+ = A x + B [r, w], v and y of x, v of r."""
    a, b, c, _ = scipy.signal.tf2ss(*PLANT)
    A, B = np.zeros((8, 8)), np.zeros((8, 2))
    A[0, 1:5], B[0, 0] = -c[0], 1.0
    A[1:5, 1:5], B[1:5, 1] = a, b[:, 0]
    v, y = np.zeros(8), np.zeros(8)
    v[0], v[1:5], v[7], y[1:5] = 8.0, -4.0 * c[0], -1.0, c[0]
    A[5:, 5:], A[5:, 1:5] = OBSERVER[0], np.outer(L, c[0])
    A[5:] += np.outer(OBSERVER[1][:, 0], v)
    B[5:, 0] = 4.0 * OBSERVER[1][:, 0]
    held = scipy.signal.cont2discrete((A, B, v[None], np.zeros((1, 2))), dt)
    return held[0], held[1], v, y


def loop_with_vectors(A: Array, B: Array, v_of_x: Array, y_of_x: Array, r: Array) -> Array:
    x, z, memory = np.zeros(8), np.zeros(10), np.zeros(10)
    y = np.empty_like(r)
    for k in range(r.size):
        y[k] = y_of_x @ x
        v = v_of_x @ x + 4.0 * r[k]
        z = np.maximum(v - EXACT.r, np.minimum(v + EXACT.r, z))
        u = 0.7 * (EXACT.p0 * v + EXACT.p @ z)
        memory = np.maximum(u - HYSTERESIS.r, np.minimum(u + HYSTERESIS.r, memory))
        eta = HYSTERESIS.p0 * u + HYSTERESIS.p @ memory
        x = A @ x + B @ np.array([r[k], eta])
    return y


def plain_loop(
    A: Array,
    B: Array,
    v_of_x: Array,
    y_of_x: Array,
    r: Array,
    g0: float,
    g: Array,
    s: Array,
    p0: float,
    p: Array,
    radii: Array,
) -> Array:
    """What numba compiles."""
    n = A.shape[0]
    x, after, z, memory = np.zeros(n), np.zeros(n), np.zeros(g.size), np.zeros(p.size)
    y = np.empty_like(r)
    for k in range(r.size):
        v, total = 4.0 * r[k], 0.0
        for j in range(n):
            v += v_of_x[j] * x[j]
            total += y_of_x[j] * x[j]
        y[k] = total
        u = g0 * v
        for i in range(g.size):
            z[i] = max(v - s[i], min(v + s[i], z[i]))
            u += g[i] * z[i]
        u *= 0.7
        eta = p0 * u
        for i in range(p.size):
            memory[i] = max(u - radii[i], min(u + radii[i], memory[i]))
            eta += p[i] * memory[i]
        for i in range(n):
            total = B[i, 0] * r[k] + B[i, 1] * eta
            for j in range(n):
                total += A[i, j] * x[j]
            after[i] = total
        for i in range(n):
            x[i] = after[i]
    return y


def print_control(ours: float) -> None:
    """Print the time of python-control's simulation of the same equations, where installed."""
    if importlib.util.find_spec("control") is None:
        return
    import control

    A, B, v_of_x, y_of_x = joint_matrices(DT)

    def drive(x: Array, r: float) -> tuple[Array, float, Array, float]:
        v = v_of_x @ x[:8] + 4.0 * r
        z = np.maximum(v - EXACT.r, np.minimum(v + EXACT.r, x[8:18]))
        u = 0.7 * (EXACT.p0 * v + EXACT.p @ z)
        memory = np.maximum(u - HYSTERESIS.r, np.minimum(u + HYSTERESIS.r, x[18:]))
        return z, u, memory, HYSTERESIS.p0 * u + HYSTERESIS.p @ memory

    def update(t: float, x: Array, r: Array, params: Any) -> Array:
        z, _, memory, eta = drive(x, r[0])
        return np.concatenate([A @ x[:8] + B @ np.array([r[0], eta]), z, memory])

    def output(t: float, x: Array, r: Array, params: Any) -> Array:
        return np.atleast_1d(y_of_x @ x[:8])

    loop = control.nlsys(update, output, states=28, inputs=1, outputs=1, dt=DT)
    samples = 5_000
    r, t = reference(samples, DT), np.arange(samples) * DT
    begin = time.process_time()
    y = control.input_output_response(loop, t, r).outputs
    a_step = 1e9 * (time.process_time() - begin) / samples
    print(f"{'python-control':26s} {a_step:10.0f} {a_step / ours:11.2f}")
    assert np.abs(y - simulated(samples, DT)).max() < 1e-6
    block = TrackingController.from_continuous(CONTROLLER, DT, observer=OBSERVER, inverse=INVERSE)
    joined = closed_loop_system(block, plant=PLANT, hysteresis=HYSTERESIS)
    begin = time.process_time()
    y = control.input_output_response(joined, t, [r, 0.0, 0.0]).outputs[0]
    a_step = 1e9 * (time.process_time() - begin) / samples
    print(f"{'closed_loop_system':26s} {a_step:10.0f} {a_step / ours:11.2f}")
    assert np.array_equal(y, simulated(samples, DT, block))
