"""The section on noise and distortion of periodic records."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.cli import main

N, PERIODS, SIGMA = 500, 6, 0.02


def record(seed: int, bend: float) -> hyst.Record:
    u = hyst.signals.multisine(
        1e-3, N, rms=1.0, lines="odd", band=(1.0, 200.0), periods=PERIODS, seed=seed
    ).u
    noise = SIGMA * np.random.default_rng(seed).normal(size=u.size)
    return hyst.Record(u, 2.0 * u + bend * u**2 + noise, 1e-3, "drive", "position", "V", "um")


def medians(records: list[hyst.Record]) -> dict[str, float]:
    (section,) = hyst.report.distortion_sections(records, N)
    assert section.png.startswith(b"\x89PNG")
    return {f"{name}, {lines}": float(value) for name, lines, value in section.table.rows}


def test_gain_noise_and_even_distortion_are_told_in_units() -> None:
    told = medians([record(0, 0.1)])
    gain, noise, even, odd, floor = told.values()
    names = list(told)
    assert names[0] == "gain of driven lines [um/V], 50"
    # Lines are 2 Hz apart up to 250 Hz, odd ones up to 200 Hz driven: 124 even ones are silent, not
    # counting half the sample rate, which is odd or even as N/2 is, and 74 or 75 odd ones.
    assert names[2].startswith("output at silent even lines [um], 12")
    assert names[3].startswith("output at silent odd lines [um], 7")
    # Noise of an amplitude from N samples and five periods: its standard deviation of the complex
    # line is 2 sigma / sqrt(5 N); four periods' worth of
    # freedom scatter a median of 200 by a tenth.
    amplitude = 2.0 * SIGMA / np.sqrt(5 * N)
    assert floor == pytest.approx(amplitude, rel=0.1)
    # 50 lines of rms 1 have an amplitude of 0.2 each.
    assert noise == pytest.approx(amplitude / 0.2, rel=0.15)
    assert gain == pytest.approx(2.0, rel=3.0 * noise)
    # 0.1 u^2 has a standard deviation of 0.1 sqrt 2, spread over the even lines up to twice 200 Hz.
    assert even == pytest.approx(0.02, rel=0.6)
    assert even > 10.0 * floor
    assert odd < 3.0 * floor


def test_several_realisations_tell_distortion_at_driven_lines() -> None:
    odd = [
        hyst.Record(each.u, each.y + 0.05 * each.u**3, 1e-3)
        for each in (record(seed, 0.0) for seed in range(4))
    ]
    assert "by distortion, one realisation, 50" in medians(odd)
    assert not any(name.startswith("by distortion") for name in medians(odd[:1]))


def test_without_enough_periods_there_is_no_section() -> None:
    one = record(0, 0.0)
    assert hyst.report.distortion_sections([one], None) == ()
    assert hyst.report.distortion_sections([one.slice(0, 3 * N - 1)], N) == ()


def test_the_report_of_the_command_line_has_it(tmp_path: Path) -> None:
    data, out = str(tmp_path / "data.csv"), tmp_path / "out"
    u = hyst.signals.multisine(1e-3, N, rms=1.0, lines="odd", periods=PERIODS).u
    lag = hyst.LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], 1e-3)
    y = lag(u + 0.1 * u**2) + SIGMA * np.random.default_rng(0).normal(size=u.size)
    hyst.io.write_columns(data, ["drive [V]", "position [um]"], (u, y))
    words = ["identify", data, "--input", "drive", "--output", "position", "--rate", "1000"]
    words += ["--family", "hammerstein", "--hysteresis", "linear", "--period", str(N)]
    # A line before dynamics is told unfit: the square it leaves out is seen in the even lines.
    assert main([*words, "-o", str(out)]) == 3
    assert "output at silent even lines [um]" in (out / "report.html").read_text("utf-8")
    assert "Noise and distortion, line by line" in (out / "report.html").read_text("utf-8")
    assert (out / "distortion.png").exists()
