"""`hyst watch`: false alarms, detection, lines per second through standard input, memory.

Undisturbed actuators are random plays with noise, driven by sines, triangles, sums of sines and
held levels. Each is identified from a first record, and then watched with the model found for some
minutes of its own time; printed is how many alarms of which name that gives, and after how many
seconds a gain that drifts, or jumps by 10 %, is told.

`--soak SECONDS` feeds lines with faults among them for so long, and prints how the memory of the
process grows.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.online.choice import estimator_for
from hyst.online.watch.limits import Limits
from hyst.online.watch.sample_clock import SampleClock
from hyst.online.watch.watcher import Watcher
from hyst.online.watch.window import Window

Array = NDArray[np.float64]

DT, SECONDS, RUNS = 1e-3, 120.0, 40
DRIVES = ("sine", "triangle", "sum", "stairs")
PROGRAM = "import sys; from hyst.cli import main; sys.exit(main(sys.argv[1:]))"


def main() -> None:
    if "--soak" in sys.argv:
        soak(float(sys.argv[sys.argv.index("--soak") + 1]))
        return
    alarms()
    lines_per_second()


@dataclass(frozen=True)
class Actuator:
    """Random plays, the noise of their sensor, and the model a first record gives."""

    plays: hyst.PrandtlIshlinskii
    noise: float
    model: hyst.operators.Operator


def actuator(rng: np.random.Generator, kind: str) -> Actuator:
    count = int(rng.integers(2, 6))
    radii = np.sort(rng.uniform(0.1, 2.4, count))
    plays = hyst.PrandtlIshlinskii(rng.uniform(0.1, 0.6, count), radii, 1.0)
    u = drive(rng, kind, 8.0)
    y = plays(u)
    noise = float(np.ptp(y)) * 10.0 ** rng.uniform(-3.5, -2.0)
    record = hyst.Record(u, y + rng.normal(0.0, noise, u.size), DT)
    return Actuator(plays, noise, hyst.identify(record, family="pi").model)


def drive(rng: np.random.Generator, kind: str, seconds: float) -> Array:
    """Give an input within 3 to either side that reaches both ends."""
    t = np.arange(round(seconds / DT)) * DT
    turns = rng.uniform(0.5, 5.0) * t + rng.uniform()
    if kind == "sine":
        return 3.0 * np.sin(2.0 * np.pi * turns)
    if kind == "triangle":
        return 3.0 * (4.0 * np.abs(turns % 1.0 - 0.5) - 1.0)
    if kind == "sum":
        parts = [np.sin(2.0 * np.pi * (k * turns + rng.uniform())) for k in (1, 2, 3)]
        u = np.sum(parts, axis=0)
        return np.asarray(6.0 * (u - u.min()) / np.ptp(u) - 3.0)
    levels = np.round(6.0 * (4.0 * np.abs(turns % 1.0 - 0.5) - 1.0)) / 6.0
    return np.asarray(3.0 * levels)


def watch(each: Actuator, u: Array, y: Array, only: str) -> list[Window]:
    chosen = ["scale", "offset"] if only else []
    estimator = estimator_for(each.model, dt=DT, memory=60.0, spread=0.1, only=chosen)
    watcher = Watcher(estimator, each.model, 1000, Limits())
    nothing = np.full(u.size, np.nan)
    slots = SampleClock(DT, False).take(u, y, nothing, np.isfinite(nothing))
    return [*watcher.take(slots), *watcher.finish()]


def alarms() -> None:
    for only in ("", "scale"):
        told: Counter[str] = Counter()
        missed, waits = 0, {"drift of 20 % in 60 s": [], "step of 10 %": []}
        for run in range(RUNS):
            rng = np.random.default_rng(run)
            kind = DRIVES[run % len(DRIVES)]
            each = actuator(rng, kind)
            u = drive(rng, kind, SECONDS)
            true, noise = each.plays(u), rng.normal(0.0, each.noise, u.size)
            for window in watch(each, u, true + noise, only):
                told.update(event.name for event in window.events if event.starts)
            t = np.arange(u.size) * DT
            gains = (1.0 + 0.2 * np.clip((t - 30.0) / 60.0, 0.0, 1.0), 1.0 + 0.1 * (t > 30.0))
            for gain, found in zip(gains, waits.values(), strict=True):
                times = _starts(watch(each, u, gain * true + noise, only), ("drift", "model error"))
                found.append(min(times, default=np.inf) - 30.0)
                missed += not times
        hours = RUNS * SECONDS / 3600.0
        what = "scale and offset" if only else "all constants"
        listed = ", ".join(f"{name} {count}" for name, count in told.items()) or "none"
        print(f"{what}: alarms in {hours:.2f} h of {RUNS} undisturbed actuators: {listed}")
        for name, found in waits.items():
            middle, worst = np.median(found), np.max(found)
            print(f"{what}: {name} told after {middle:.1f} s (median), {worst:.1f} s (worst)")
        print(f"{what}: never told {missed} of {2 * RUNS}\n")


def _starts(windows: list[Window], names: tuple[str, ...]) -> list[float]:
    return [
        event.time
        for window in windows
        for event in window.events
        if event.starts and event.name in names
    ]


def lines_per_second() -> None:
    count = 1_000_000
    rng = np.random.default_rng(0)
    each = actuator(rng, "sine")
    u = drive(rng, "sine", count * DT)
    y = each.plays(u) + rng.normal(0.0, each.noise, u.size)
    rows = [f"{k * DT:.3f},{a:.6f},{b:.6f}\n" for k, (a, b) in enumerate(zip(u, y, strict=True))]
    dirty = [row if k % 100 else "not a row\n" for k, row in enumerate(rows[: count // 5])]
    stamped = [
        f"2026-11-29 10:{k // 60000:02d}:{k // 1000 % 60:02d}.{k % 1000:03d},{row.split(',', 1)[1]}"
        for k, row in enumerate(rows[: count // 5])
    ]
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.json"
        each.model.save(model)
        for name, lines, only in (
            ("all constants", rows, []),
            ("scale and offset", rows, ["--only", "scale,offset"]),
            ("1 % of lines broken", dirty, []),
            ("dates and times of day", stamped, []),
        ):
            seconds = _piped(model, "".join(["t,u,y\n", *lines]).encode(), only, 1 << 16)
            print(f"{name}: {len(lines) / seconds:,.0f} lines/s")
        few = rows[: count // 10]
        seconds = _piped(model, "".join(["t,u,y\n", *few]).encode(), [], 64)
        print(f"written 64 bytes at a time: {len(few) / seconds:,.0f} lines/s")


def _piped(model: Path, text: bytes, options: list[str], piece: int) -> float:
    """Give the seconds a watch takes for a text on its standard input, without its own start."""
    process = _started(model, options)
    assert process.stdin is not None
    head = text.index(b"\n", 2000) + 1
    process.stdin.write(text[:head])
    process.stdin.flush()
    time.sleep(2.0)
    begin = time.perf_counter()
    for k in range(head, len(text), piece):
        process.stdin.write(text[k : k + piece])
        process.stdin.flush()
    process.stdin.close()
    process.wait()
    return time.perf_counter() - begin


def _started(model: Path, options: list[str]) -> subprocess.Popen[bytes]:
    how = ["watch", str(model), "-", "--input", "u", "--output", "y", "--time", "t", *options]
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM, *how],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(Path(hyst.__file__).parents[1])},
    )


def soak(seconds: float) -> None:
    """Feed lines as fast as they are taken, with gaps and faults among them."""
    rng = np.random.default_rng(0)
    each = actuator(rng, "sine")
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.json"
        each.model.save(model)
        process = _started(model, ["--log", str(Path(folder) / "log"), "--every", "60"])
        assert process.stdin is not None
        process.stdin.write(b"t,u,y\n")
        first, sent, told = time.perf_counter(), 0, 0.0
        sizes: list[float] = []
        while time.perf_counter() - first < seconds:
            process.stdin.write(_faulty(rng, each, sent))
            sent += 10_000
            if time.perf_counter() - told > max(seconds / 10.0, 1.0):
                told = time.perf_counter()
                sizes.append(_resident(process.pid))
                print(f"{sent:,} lines, {sent * DT / 3600.0:.2f} h at 1 kHz: {sizes[-1]:.1f} MB")
        process.stdin.close()
        process.wait()
        log = sum(file.stat().st_size for file in (Path(folder) / "log").iterdir())
    print(f"memory grew by {sizes[-1] - sizes[len(sizes) // 3]:.1f} MB; log {log / 1e6:.1f} MB")


def _faulty(rng: np.random.Generator, each: Actuator, start: int) -> bytes:
    """Give 10,000 lines: a gap, broken lines, values that are none, a clock that jumps at times."""
    t = (np.arange(10_000) + start) * DT
    u = 3.0 * np.sin(2.0 * np.pi * 2.0 * t)
    y = each.plays(u) + rng.normal(0.0, each.noise, u.size)
    rows = [f"{a:.3f},{b:.6f},{c:.6f}" for a, b, c in zip(t, u, y, strict=True)]
    for k in rng.integers(0, 10_000, 5):
        rows[k] = rng.choice(["torn,", "1,nan,2", "overflow", "9e99,0,1", "# note"])
    if rng.uniform() < 0.3:
        first = int(rng.integers(0, 9000))
        del rows[first : first + int(rng.integers(1, 900))]
    return ("\n".join(rows) + "\n").encode()


def _resident(process: int) -> float:
    """Give the memory a process holds, MB; NaN where the system does not tell."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except OSError:
        return float("nan")
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
