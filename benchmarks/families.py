"""All families of the registry on all measured records, in one table.

Printed for each data set: training error, error on records no fit has seen, number of constants
of the model, time of a sample in a run of it, time of the fit, and the verdict, or
why a family refuses the records. ``--write`` puts the table into docs/families.md; ``--family a,b``
and ``--data x,y`` take some only, ``--limit S`` is the time a fit may take.
"""

from __future__ import annotations

import argparse
import multiprocessing
import re
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

import hyst
from benchmarks.fit_speed import unit_told
from benchmarks.measured_tasks import Task, tasks

PAGE = Path(__file__).resolve().parents[1] / "docs" / "families.md"
BEGIN = "<!-- table: python -m benchmarks families --write -->"
END = "<!-- end of table -->"

LIMIT = 120.0
"""Seconds of a fit."""


@dataclass(frozen=True)
class Entry:
    """One family on one data set.

    Parameters
    ----------
    family
        Its name.
    seconds
        Of a processor for the fit.
    training, other
        Errors in percent; other is None where nothing else was recorded.
    constants
        Of the model, those that were held included.
    nanoseconds
        Of a sample, in a run over the training record.
    told
        The level of the verdict, or why there is no model.
    """

    family: str
    seconds: float
    training: float | None = None
    other: float | None = None
    constants: int = 0
    nanoseconds: float = 0.0
    told: str = ""


def main() -> None:
    """Print a table for each data set, and write all of them if asked to."""
    asked = _asked()
    _load_what_is_slow()
    print(unit_told())
    rows: list[tuple[Task, list[Entry]]] = []
    notes: list[str] = []
    for task in tasks():
        if isinstance(task, str):
            print(task, flush=True)
            notes.append(task)
        elif not asked.data or task.name in asked.data.split(","):
            print(f"{task.name}: {task.split}", flush=True)
            rows.append((task, [_shown(each) for each in _entries(task, asked)]))
    if asked.write:
        page = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(with_table(page, as_markdown(rows, notes)), encoding="utf-8")


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks families")
    parser.add_argument("benchmarks", nargs="*")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--family", default="")
    parser.add_argument("--data", default="")
    parser.add_argument("--limit", type=float, default=LIMIT)
    return parser.parse_args(sys.argv[1:])


def _load_what_is_slow() -> None:
    """Identify something, so that no fit is charged for what is imported on first use."""
    u = np.sin(np.linspace(0.0, 30.0, 300))
    hyst.identify(hyst.Record(u, hyst.Play(0.3)(u), 1.0), family="pi,rdpi", delay="auto")


def _entries(task: Task, asked: argparse.Namespace) -> Iterator[Entry]:
    names = asked.family.split(",") if asked.family else ["auto", *hyst.families]
    return (within(asked.limit, name, task) for name in names)


def within(limit: float, name: str, task: Task) -> Entry:
    """Identify in a process of its own, which is ended when its time is over."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_send, args=(sender, name, task))
    process.start()
    sender.close()
    entry = Entry(name, limit, told=f"stopped after {limit:.0f} s")
    try:
        if receiver.poll(limit):
            entry = receiver.recv()
    except EOFError:
        entry = Entry(name, limit, told="the process died")
    if process.is_alive() and entry.told.startswith("stopped"):
        process.terminate()
    process.join()
    return entry


def _send(sender: Connection, name: str, task: Task) -> None:
    sender.send(entry_of(name, task))


def entry_of(name: str, task: Task) -> Entry:
    """Identify a family from the records of a task, and judge it."""
    training, judge = task.training, task.judge
    start = time.process_time()
    try:
        found = hyst.identify(training, family=name, allow_unconverged=True, **task.options)
    except hyst.HystError as error:
        return Entry(name, time.process_time() - start, told=f"refused: {error}")
    except Exception as error:  # a defect, which is to be seen beside what works
        return Entry(name, time.process_time() - start, told=f"failed: {error!r}")
    seconds = time.process_time() - start
    told = found.verdict.level
    if found.family != name:
        told += f", {found.family}"
    if found.status != "converged":
        told += f", {found.status}"
    other = None
    if judge is not None:
        try:
            other = judge(found)
        except hyst.HystError as error:
            told += f"; not judged: {error}"
    training_error = found.metrics["training"].rms_percent
    count = len(found.model.parameters())
    return Entry(name, seconds, training_error, other, count, _time_of(found, training[0]), told)


def _time_of(found: hyst.Identified, record: hyst.Record) -> float:
    model, times = found.model.at_sample_time(record.dt), []
    for _ in range(7):
        start = time.process_time()
        for _ in range(5):
            model(record.u)
        times.append((time.process_time() - start) / 5)
    return 1e9 * float(np.min(times)) / len(record)


def _shown(entry: Entry) -> Entry:
    print(
        "  " + "  ".join(cell.rjust(12) for cell in _cells(entry)[:6]), f" {entry.told}", flush=True
    )
    return entry


def _cells(entry: Entry) -> list[str]:
    if entry.training is None:
        return [entry.family, "-", "-", "-", "-", f"{entry.seconds:.1f}", _cell(entry.told)]
    return [
        entry.family,
        f"{entry.training:.2f}",
        "-" if entry.other is None else f"{entry.other:.2f}",
        str(entry.constants),
        f"{entry.nanoseconds:.1f}",
        f"{entry.seconds:.1f}",
        _cell(entry.told),
    ]


def _cell(text: str) -> str:
    """Give a text for a cell: what is wrong, without what to do about it."""
    return text.partition("; ")[0].replace("|", "/")


def as_markdown(rows: Sequence[tuple[Task, Sequence[Entry]]], notes: Sequence[str]) -> str:
    """Give errors on unseen records of all families in one table, then everything by data set."""
    names = list(dict.fromkeys(entry.family for _, entries in rows for entry in entries))
    lines = ["Training error -> error on what no fit has seen, percent of the output's range:", ""]
    lines.append(_line(["family", *(task.name for task, _ in rows)]))
    lines.append(_line(["---"] + ["---:"] * len(rows)))
    for name in names:
        cells = [_summary(name, entries) for _, entries in rows]
        lines.append(_line([f"`{name}`", *cells]))
    for task, entries in rows:
        lines += ["", f"**{task.name}**: {task.split}.", ""]
        header = ["family", "training, %", "other, %", "constants", "ns a sample", "fit, s", "told"]
        lines += [_line(header), _line(["---"] + ["---:"] * 5 + ["---"])]
        for each in entries:
            first, *cells = _cells(each)
            lines.append(_line([f"`{first}`", *cells]))
    lines += [f"\n{each}." for each in notes]
    return "\n".join(lines)


def _summary(name: str, entries: Sequence[Entry]) -> str:
    entry = next((each for each in entries if each.family == name), None)
    if entry is None or entry.training is None:
        return "-" if entry is None else entry.told.split(":")[0].split(" ")[0]
    if entry.other is None:
        return f"{entry.training:.2f}"
    others = [each.other for each in entries if each.other is not None]
    best = entry.other == min(others)
    told = f"{entry.training:.2f} -> {entry.other:.2f}"
    return f"**{told}**" if best else told


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
