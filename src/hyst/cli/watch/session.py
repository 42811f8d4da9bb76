"""From bytes to windows: a watch without its waiting, files and words."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.arguments import require_same_unit
from hyst.cli.driver_option import refuse_codes, says_codes
from hyst.cli.watch.sources import Piece
from hyst.io.growing import GrowingRows, Rows, joined
from hyst.online.estimator import Estimator
from hyst.online.knowledge import Knowledge
from hyst.online.watch.delay_line import DelayLine
from hyst.online.watch.limits import Limits
from hyst.online.watch.sample_clock import SampleClock, sample_time_of
from hyst.online.watch.watcher import Watcher
from hyst.online.watch.window import Window

# Rows by which the sample time is found.
_ROWS = 50
_FEWEST_IN_A_WINDOW = 20
_LONGEST_WINDOW = 1.0
# Bands cost as much as some hundred samples.
_FEWEST_TOLD = 250
_RARELY = 10.0
_STAMPS_ROUNDED = 1e-2


@dataclass(frozen=True, eq=False)
class Plan:
    """What is to be watched, and how.

    Parameters
    ----------
    model
        What the actuator is compared with.
    make
        Gives the estimator for a sample time.
    dt
        Sample time, s, where it is known before the first row.
    has_stamps
        Whether rows carry their time.
    every
        Seconds between reports.
    limits
        What is too much.
    knows_memory
        Whether the actuator stands as the model does.
    start
        Shape (m,), parameters that drift is counted from, if not those of the estimator.
    """

    model: hyst.operators.Operator
    make: Callable[[float], Estimator]
    dt: float | None
    has_stamps: bool
    every: float
    limits: Limits
    knows_memory: bool
    start: NDArray[np.float64] | None = None


class Session:
    """Take in pieces of a source and give windows.

    Parameters
    ----------
    plan
        What is watched.
    rows
        Reads the bytes.
    say
        Where notes go.
    """

    def __init__(self, plan: Plan, rows: GrowingRows, say: Callable[[str], None]) -> None:
        self.plan, self.rows = plan, rows
        self.watcher: Watcher | None = None
        """The watch, once the sample time is known."""
        self.dt = math.nan
        """Sample time, s."""
        self._say = say
        self._waiting: list[Rows] = []
        self._is_told = False
        self._told: set[str] = set()
        self._asks_again = 0.0

    def feed(self, piece: Piece) -> list[Window]:
        """Take in a piece."""
        windows = []
        if piece.begins_file:
            windows = self._take(self.rows.restart())
            self._is_told = False
            self._say("another file begins; how the input went until then is not known")
            if self.watcher is not None:
                self._clock.break_off()
        return [*windows, *self._take(self.rows.feed(piece.data))]

    def finish(self) -> list[Window]:
        """Take what is left as the end."""
        windows = self._take(self.rows.finish(), is_last=True)
        return [*windows, *(self.watcher.finish() if self.watcher is not None else [])]

    def windows_in(self, seconds: float) -> int:
        """Give how many windows go into some seconds, at least 1."""
        return max(1, round(seconds / (self._samples * self.dt)))

    def _take(self, rows: Rows, is_last: bool = False) -> list[Window]:
        if self.rows.head is not None and not self._is_told:
            self._tell_head()
        if self.watcher is None:
            self._waiting.append(rows)
            count = sum(each.size for each in self._waiting)
            if count == 0 or (self.plan.has_stamps and count < _ROWS and not is_last):
                return []
            rows, self._waiting = joined(self._waiting), []
            self._start(rows)
        if not rows.size:
            return []
        assert self.watcher is not None
        slots = self._clock.take(rows.u, rows.y, rows.time, rows.unreadable)
        return self.watcher.take(self._delay.take(slots))

    def _ask(self, estimator: Estimator) -> Knowledge | None:
        """Ask what the estimator knows, which must not take more than a tenth of the file's time.

        Of the file's, for what is told of a file must not depend on how fast it is read.
        """
        at = 0.0 if self.watcher is None else self.watcher.time
        if at < self._asks_again:
            return None
        begin = time.monotonic()
        knowledge = estimator.knowledge
        self._asks_again = at + _RARELY * (time.monotonic() - begin)
        return knowledge

    def _tell_head(self) -> None:
        head, about = self.rows.head, self.plan.model.description
        assert head is not None
        self._is_told = True
        for place, unit, what in zip(
            head.columns, (about.input_unit, about.output_unit), ("input", "output"), strict=False
        ):
            if what == "input" and says_codes(head.names[place], head.units[place]):
                refuse_codes(about.driver, self.rows.source)
            require_same_unit(head.units[place], unit, f"the {what} of {self.rows.source}")
        for sentence in head.notes:
            if sentence not in self._told:
                self._told.add(sentence)
                self._say(f"{self.rows.source}: {sentence}")

    def _start(self, rows: Rows) -> None:
        """Make the estimator and all that needs the sample time."""
        plan, resolution = self.plan, 0.0
        dt = plan.dt
        if plan.has_stamps:
            found, resolution = sample_time_of(rows.time)
            if dt is not None and abs(found - dt) > _STAMPS_ROUNDED * dt:
                raise hyst.InputError(
                    f"the stamps of {self.rows.source} are {found:.6g} s apart, and the model or "
                    f"estimator holds for {dt:.6g} s; record at its rate, or identify anew"
                )
            dt = found if dt is None else dt
        assert dt is not None
        self.dt = dt
        window = min(plan.every, _LONGEST_WINDOW)
        self._samples = max(_FEWEST_IN_A_WINDOW, round(window / dt))
        self._clock = SampleClock(dt, plan.has_stamps, resolution)
        self._delay = DelayLine(plan.model.description.delay)
        self.watcher = Watcher(
            plan.make(dt),
            plan.model,
            self._samples,
            plan.limits,
            knows_memory=plan.knows_memory,
            start=plan.start,
            ask=self._ask,
            told_every=max(self.windows_in(plan.every), -(-_FEWEST_TOLD // self._samples)),
        )
