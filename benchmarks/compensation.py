"""Tracking of a stage of no model's class, once each family of the registry has compensated it.

The stage is Bouc-Wen hysteresis with a mode at 800 Hz behind it (``benchmarks.resonant_stage``),
its sensor has 0.02 um of noise. Each family is identified from its records alone and makes the
command of a wanted path at 5 and at 80 Hz, by which the stage is driven: rms and largest error in
percent of the stroke, once two periods are over. Before, the stage has passed its whole range
twice, from 0 V to 100 V and back, which the command knows. ``--write`` puts the tables into
docs/compensation_of_a_resonant_stage.md; ``--family a,b`` takes some families only.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.resonant_stage import RATE, largest_error, stage

Array = NDArray[np.float64]

PAGE = Path(__file__).resolve().parents[1] / "docs" / "compensation_of_a_resonant_stage.md"
BEGIN = "<!-- table: python -m benchmarks compensation --write -->"
END = "<!-- end of table -->"

DT = 1.0 / RATE
NOISE = 0.02
"""Of the sensor, um rms: 0.05 % of the stage's range."""
FREQUENCIES = (5.0, 80.0)
ORDER = ("noncausal", "preview", "exact")
"""The first of them that a model has makes the command."""


@dataclass(frozen=True)
class Entry:
    """One family from one set of records.

    Parameters
    ----------
    family
        Its name, and that of what is in front of dynamics.
    seconds
        Of a processor, for the fit.
    told
        Level of the verdict, or why there is no model or no command.
    training
        What the model leaves of the records, percent of their range.
    method
        Of the command.
    errors
        Rms and largest error of tracking for each frequency, percent of the stroke.
    """

    family: str
    seconds: float
    told: str
    training: float | None = None
    method: str = "-"
    errors: tuple[tuple[float, float], ...] = ()


def main() -> None:
    """Print the tables, and write them into the page if asked to."""
    asked = _asked()
    chosen = asked.family.split(",") if asked.family else list(hyst.families)
    drive = 50.0 - 50.0 * np.cos(2.0 * np.pi * 80.0 * DT * np.arange(300))
    text = [f"Fine steps and Radau's method at 1e-11 differ by {largest_error(drive):.0e} um."]
    for title, records, around in _sets():
        print(title, flush=True)
        tried = _around(chosen) if around else [(each, {}) for each in chosen]
        entries = [_shown(entry_of(name, records, **options)) for name, options in tried]
        text += ["", f"**{title}**", "", *as_markdown(entries)]
    if asked.write:
        page = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(with_table(page, "\n".join(text)), encoding="utf-8")


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks compensation")
    parser.add_argument("benchmarks", nargs="*")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--family", default="")
    return parser.parse_args(sys.argv[1:])


def _around(chosen: Sequence[str]) -> list[tuple[str, dict[str, str]]]:
    """Name hammerstein around every family that can be in front of it."""
    front = [each for each in hyst.families.inner("hammerstein") if each in chosen]
    return [("hammerstein", {"hysteresis": each}) for each in front]


def _sets() -> Iterator[tuple[str, list[hyst.Record], bool]]:
    """Give titles, records, and whether they are for hysteresis with dynamics."""
    drives = {f: shrinking(f, n) for f, n in ((5.0, 10), (20.0, 12), (80.0, 16))}
    wide = hyst.signals.multisine(DT, 8000, amplitude=50.0, offset=50.0, seed=1).u
    slow, middle, fast, broad = (measured(u, k) for k, u in enumerate((*drives.values(), wide)))
    yield "One record: loops that shrink, 5 Hz", [slow], False
    yield "Three records: loops that shrink, 5, 20 and 80 Hz", [slow, middle, fast], False
    title = "Three records: loops that shrink, 5 and 80 Hz, and a multisine to 4 kHz"
    yield title, [slow, fast, broad], True


def shrinking(frequency: float, periods: int) -> Array:
    """Give three loops from 0 to 100 V, then loops around 50 V that shrink to 15 V."""
    t = DT * np.arange(round(periods * RATE / frequency))
    size = np.interp(frequency * t, [0.0, 3.0, periods], [1.0, 1.0, 0.15])
    return 50.0 - 50.0 * np.cos(2.0 * np.pi * frequency * t) * size


def measured(u: Array, seed: int) -> hyst.Record:
    """Give what the sensor tells of the stage."""
    noise = NOISE * np.random.default_rng(seed).normal(size=u.size)
    return hyst.Record(u, stage(u) + noise, DT)


def wanted(frequency: float) -> Array:
    """Give eight periods whose strokes change from 40 to 16 um and back."""
    t = DT * np.arange(round(8.0 * RATE / frequency))
    size = 14.0 + 6.0 * np.cos(2.0 * np.pi * frequency * t / 6.0)
    return 30.0 - size * np.cos(2.0 * np.pi * frequency * t)


def warm_up() -> Array:
    """Give two loops over the whole range at 5 Hz, from 0 V to 0 V."""
    return 50.0 - 50.0 * np.cos(2.0 * np.pi * 5.0 * DT * np.arange(round(0.4 * RATE) + 1))


def entry_of(family: str, records: Sequence[hyst.Record], **options: str) -> Entry:
    """Identify a family, and drive the stage by its commands."""
    name = " around ".join([family, *options.values()])
    start = time.process_time()
    try:
        found = hyst.identify(records, family=family, allow_unconverged=True, **options)
    except hyst.HystError as error:
        return Entry(name, time.process_time() - start, f"refused: {error}")
    seconds = time.process_time() - start
    left = found.metrics["training"].rms_percent
    has = hyst.compensation.methods_for(found.model)
    method = next((each for each in ORDER if each in has), None)
    told = found.verdict.level
    if method is None:
        return Entry(name, seconds, f"{told}; no command: {_why_none(found.model)}", left)
    try:
        errors = tuple(tracked(found.model, method, each) for each in FREQUENCIES)
    except hyst.HystError as error:
        return Entry(name, seconds, f"{told}; no command: {error}", left, method)
    return Entry(name, seconds, told, left, method, errors)


def _why_none(model: hyst.Operator) -> str:
    try:
        model.inverse()
    except hyst.NotInvertibleError as error:
        return str(error)
    return "no method of compensation is made for it"


def tracked(model: hyst.Operator, method: str, frequency: float) -> tuple[float, float]:
    """Give rms and largest error of the stage, percent of the stroke, after two periods."""
    y_ref, past = wanted(frequency), warm_up()
    done = hyst.compensation.invert_trajectory(model, y_ref, method, history=past)
    reached = stage(np.concatenate([past, done.u]))[past.size :]
    error = (reached - y_ref)[round(2.0 * RATE / frequency) :]
    stroke = float(np.ptp(y_ref))
    return (
        100.0 * float(np.sqrt(np.mean(error**2))) / stroke,
        100.0 * float(np.abs(error).max()) / stroke,
    )


def _shown(entry: Entry) -> Entry:
    print("  " + "  ".join(cell.rjust(12) for cell in _cells(entry)), flush=True)
    return entry


def _cells(entry: Entry) -> list[str]:
    left = "-" if entry.training is None else f"{entry.training:.2f}"
    errors = [f"{rms:.2f} ({most:.2f})" for rms, most in entry.errors] or ["-"] * len(FREQUENCIES)
    seconds = f"{entry.seconds:.1f}"
    return [entry.family, left, entry.method, *errors, seconds, _short(entry.told)]


def _short(told: str) -> str:
    """Give a text for a cell: what is wrong, without what to do about it."""
    level, _, why = told.partition("; no command: ")
    if why and level == "unfit":
        return "unfit, so no command"
    said = f"{level}; no command: {why.partition('; ')[0]}" if why else level.partition("; ")[0]
    return said.replace("|", "/")


def as_markdown(entries: Sequence[Entry]) -> list[str]:
    """Give the lines of a table."""
    heads = [f"{each:.0f} Hz, %" for each in FREQUENCIES]
    header = ["family", "left of the records, %", "command", *heads, "fit, s", "told"]
    lines = [_line(header), _line(["---", "---:", "---", *["---:"] * len(heads), "---:", "---"])]
    for each in entries:
        first, *cells = _cells(each)
        lines.append(_line([f"`{first}`", *cells]))
    return lines


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def with_table(page: str, table: str) -> str:
    """Replace what stands between the markers."""
    pattern = f"{re.escape(BEGIN)}\n.*?{re.escape(END)}"
    if not re.search(pattern, page, re.DOTALL):
        raise ValueError(f"the page has no {BEGIN} .. {END}")
    return re.sub(pattern, lambda _: f"{BEGIN}\n{table}\n{END}", page, flags=re.DOTALL)


if __name__ == "__main__":
    main()
