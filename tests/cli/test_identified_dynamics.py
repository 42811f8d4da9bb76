"""hyst identify with dynamics: resonances on the screen, the frequency response as files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from command_runs import Run, write_csv

import hyst


def test_resonances_are_printed_and_the_response_is_written(run: Run, folder: Path) -> None:
    dt, w = 1e-3, 2.0 * np.pi * 80.0
    G = hyst.LinearDynamics.from_continuous([w * w], [1.0, 0.3 * w, w * w], dt)
    u = hyst.signals.multisine(dt, 2000, amplitude=10.0).u
    y = (G @ hyst.PrandtlIshlinskii([0.5], [1.5], 1.0))(u)
    y = y + 0.02 * np.random.default_rng(0).normal(size=y.size)
    data = write_csv(folder / "data.csv", "t [s],u [V],y [um]", np.arange(u.size) * dt, u, y)
    ended = run(
        *("identify", data, "--input", "u", "--output", "y", "--time", "t", "--state-order", 2),
        *("--family", "hammerstein", "--hysteresis", "pi", "--plays", 1, "-o", "out"),
    )
    assert ended.code == 0, ended.err
    lines = ended.out.splitlines()
    begin = next(k for k, line in enumerate(lines) if line.startswith("Poles and zeros of G"))
    name, frequency, _, error, unit, *_ = lines[begin + 2].split()
    assert (name, unit) == ("resonance", "Hz")
    # Four standard errors: one run in some thousands fails with other seeds.
    assert abs(float(frequency) - 80.0) < 4.0 * float(error) < 0.1
    written = {path.name for path in (folder / "out").iterdir()}
    assert {"dynamics.png", "frequency_response.csv"} <= written
    table = np.genfromtxt(folder / "out" / "frequency_response.csv", delimiter=",", names=True)
    peak = table["frequency_Hz"][table["gain"].argmax()]
    # The gain is largest at sqrt(1 - 2 * 0.15^2) of 80 Hz, by hand; points lie 0.5 % apart.
    assert abs(peak - 78.18) < 0.6
