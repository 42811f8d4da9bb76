"""Draw the figure of docs/closed_loop.md: `python docs/figures/draw_closed_loop.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import hyst
from hyst.control import simulate_closed_loop
from hyst.report import draw_closed_loops

HERE = Path(__file__).resolve().parent
DT = 2e-5
W1, W2 = 2.0 * np.pi * 90.0, 2400.0


def draw() -> None:
    """Simulate the loops of the page and draw them."""
    t = np.arange(150_000) * DT
    r = 18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t)
    p = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
    stage = hyst.PrandtlIshlinskii(p, np.arange(4.0, 41.0, 4.0), 0.1)
    # S1 eq. 46 with the printed gain.
    L = np.array([-117.381, 0.197, 17113.1])
    A = np.array([[-1.6 * W1, -(W1**2), 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    A -= np.outer(L, [0.0, W1**2, 0.0])
    observer = (A, np.column_stack([[1.0, 0.0, 0.0], L]), [[0.0, 0.0, 1.0]], np.zeros((1, 2)))
    exact = stage.inverse()
    inexact = hyst.Affine(0.7) @ exact
    cases = {
        "exact inverse": ([4.0, 8.0], exact, None),
        "0.7 of it": ([4.0, 8.0], inexact, None),
        "0.7 of it, observer": ([4.0, 8.0], inexact, observer),
        "no inverse": ([4.0, 8.0], None, None),
        "C = 8 + 4/s, exact inverse": ([8.0, 4.0], exact, None),
    }
    loops = {
        label: simulate_closed_loop(
            r,
            DT,
            plant=([(W1 * W2) ** 2], np.polymul([1, 1.6 * W1, W1**2], [1, 0.4 * W2, W2**2])),
            controller=(gains, [1.0, 0.0]),
            hysteresis=stage,
            inverse=inverse,
            observer=watching,
            settle=1.0,
        )
        for label, (gains, inverse, watching) in cases.items()
    }
    figure = draw_closed_loops(loops, "Example of S1 with C = 4 + 8/s", ("y", "um"), ("u", "V"))
    (HERE / "closed-loop.png").write_bytes(figure)


if __name__ == "__main__":
    draw()
