"""A record, and the panels that what is made of it has."""

from __future__ import annotations

import numpy as np

import hyst

K = np.arange(1200.0)
U = 75.0 + 60.0 * np.sin(2.0 * np.pi * K / 200.0) * np.exp(-K / 2000.0)
STAGE = hyst.PrandtlIshlinskii([0.2, 0.1], [5.0, 15.0], p0=0.4)
RECORD = hyst.Record(
    U, STAGE(U) + np.random.default_rng(3).normal(0.0, 0.1, U.size), 1e-3,
    input_name="$d$ <b>", output_name="stroke", input_unit="V", output_unit="um",
)  # fmt: skip
PANELS = {
    "record": ("loop", "input", "output"),
    "found": (
        "loop", "hysteresis", "output", "strokes", "band", "residual", "residual-input",
        "distribution", "autocorrelation", "memory",
    ),
    "comparison": ("loops", "hysteresis", "errors"),
    "model": ("loop", "weights", "curve"),
}  # fmt: skip
