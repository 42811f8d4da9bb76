"""What models are to learn from measured records, and what they are judged on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
"""Measured records, kept beside the repository and not inside it."""

LAPS = 3
SHRINKING_LAPS = 15


@dataclass(frozen=True, eq=False)
class Task:
    """One set of measured records.

    Parameters
    ----------
    name
        Of the records.
    split
        What is trained on, what is judged, and why so.
    training
        Records to identify from.
    judge
        Gives the error on what no fit has seen, in percent; None where there is nothing else.
    options
        Of every fit.
    """

    name: str
    split: str
    training: tuple[hyst.Record, ...]
    judge: Callable[[hyst.Identified], float] | None
    options: dict[str, Any] = field(default_factory=dict)


Source = tuple[str, Callable[[Path], Iterator[Task]]]


def tasks(folder: Path = DATA) -> Iterator[Task | str]:
    """Give the tasks, and for data that are not there a sentence."""
    for name, read in SOURCES:
        if (folder / name).is_dir():
            yield from read(folder / name)
        else:
            yield f"{name} is left out, for there is no folder {folder / name}"


def _piezo(folder: Path) -> Iterator[Task]:
    record = hyst.read_record(folder / "Model_Vi_Do.dat", input=0, output=4, rate=200)
    yield _halves(
        "piezo",
        record,
        "first half of a 1 Hz sine of one amplitude -> second half: creep and zero move on; there "
        "is no other record",
    )


def _dampers(folder: Path) -> Iterator[Task]:
    series = {
        "A": ("A.1", "A.5", "of the same current: another run, zero and spectrum of displacement"),
        "B": ("B.1", "B.5", "of the same current, two thirds of the amplitude"),
    }
    for name, (first, second, why) in series.items():
        training, other = (
            hyst.read_record(
                folder / f"ensaio.{each}.mat", input="dist", output="forc", rate=100, repair=True
            )
            for each in (first, second)
        )
        split = f"record {first} -> record {second}, {why}"
        yield Task(f"damper {name}", split, (training,), _on(other))


def _seals(folder: Path) -> Iterator[Task]:
    for pressure in ("3bar", "7bar"):
        record = hyst.read_record(
            folder / f"O-ring_{pressure}.csv",
            input=4,
            output=6,
            time=0,
            time_unit="ms",
            repair=True,
            longest_gap=300,
        )
        yield _halves(
            f"seal {pressure}",
            record,
            "first half of equal strokes -> second half: at another pressure friction is another",
        )


def _magnets(folder: Path) -> Iterator[Task]:
    for name in ("MnZn_ferrite", "MnZn_HP_ferrite", "M130_27s", "amorf"):
        h, b = _columns(folder, "H", name), _columns(folder, "B", name)
        order = np.argsort(np.ptp(h, axis=0))[::-1]
        for count, which in ((1, "largest loop"), (2, "two largest loops")):
            if count == 1 or order.size > count:
                yield _of_loops(name, which, h[:, order], b[:, order], count)


def _of_loops(name: str, which: str, h: Array, b: Array, count: int) -> Task:
    """Train on the largest loops and judge by the others; one turn of each was measured."""
    records = tuple(
        # There is no time, so a second stands for a step, and a delay means nothing.
        hyst.Record(np.tile(h[:, k], LAPS), np.tile(b[:, k], LAPS), dt=1.0)
        for k in range(count)
    )
    left = h.shape[1] - count
    if not left:
        return Task(name, "one loop, and no other to judge by", records, None, {"delay": 0})
    loops = "one nested loop" if left == 1 else f"{left} nested ones"
    split = (
        f"{which} -> {loops}, after laps of the largest that shrink to its size; percent of the "
        "largest loop, each loop with its own zero, which a coil does not tell"
    )
    label = name if count == 1 else f"{name} {count} loops"
    return Task(label, split, records, _on_nested(h, b, count), {"delay": 0})


SOURCES: tuple[Source, ...] = (
    ("piezo-dbo", _piezo),
    ("mr-damper", _dampers),
    ("pneumatic-seal", _seals),
    ("magnetic-bh", _magnets),
)


def _halves(name: str, record: hyst.Record, split: str) -> Task:
    middle = len(record) // 2
    other = record.slice(middle, len(record))
    return Task(name, split, (record.slice(0, middle),), _on(other))


def _on(record: hyst.Record) -> Callable[[hyst.Identified], float]:
    """Judge by a record, as ``hyst compare`` does."""
    return lambda found: hyst.compare(found, record)[found.family].metrics.rms_percent


def _on_nested(h: Array, b: Array, count: int) -> Callable[[hyst.Identified], float]:
    def judge(found: hyst.Identified) -> float:
        squares = []
        for each in range(count, h.shape[1]):
            shares = np.linspace(1.0, np.ptp(h[:, each]) / np.ptp(h[:, 0]), SHRINKING_LAPS)
            way = np.concatenate([share * h[:, 0] for share in shares])
            drive = np.concatenate([h[:, 0], way, h[:, each], h[:, each]])
            left = found.model(drive)[-len(h) :] - b[:, each]
            squares.append(np.var(left))
        return 100.0 * float(np.sqrt(np.mean(squares)) / np.ptp(b[:, 0]))

    return judge


def _columns(folder: Path, signal: str, name: str) -> Array:
    table = hyst.io.read_table(folder / f"{signal}_{name}.mat")
    return np.column_stack(table.columns)
