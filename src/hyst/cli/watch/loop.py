"""The loop of a watch: wait, read, report, log, save."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import FrameType
from typing import Any

import hyst
from hyst.cli.console import note
from hyst.cli.watch.log import Log, LogFiles
from hyst.cli.watch.report import Report, json_of, json_of_event, line_of, line_of_event, report_of
from hyst.cli.watch.session import Session
from hyst.cli.watch.sources import Source
from hyst.online.alarms import AlarmEvent
from hyst.online.watch.window import Window

_PAUSE = 0.05
_SAVED_EVERY = 60.0


@dataclass(frozen=True)
class Waiting:
    """How long a watch waits for what.

    Parameters
    ----------
    for_file
        Seconds for a file that is not there.
    silence
        Seconds without a line after which there is an alarm.
    until
        Seconds after which the watch ends; None for never.
    at_end
        Whether it ends where the file ends.
    """

    for_file: float
    silence: float
    until: float | None
    at_end: bool


class Loop:
    """Watch until the source, the time or the user ends it.

    Parameters
    ----------
    source, session, waiting
        What is read, what takes it in, and how long to wait.
    files
        Where the log goes; None for none.
    goes_on
        Whether the log goes on.
    as_json
        Whether lines are of JSON.
    """

    def __init__(
        self,
        source: Source,
        session: Session,
        waiting: Waiting,
        files: LogFiles | None,
        goes_on: bool,
        as_json: bool,
    ) -> None:
        self._source, self._session, self._waiting = source, session, waiting
        self._files, self._goes_on, self._as_json = files, goes_on, as_json
        self._log: Log | None = None
        self._windows: list[Window] = []
        self._saved = time.monotonic()
        self._is_silent = False

    @property
    def active(self) -> tuple[str, ...]:
        """Names of the alarms that are on."""
        watcher = self._session.watcher
        return () if watcher is None else watcher.alarms.active

    def run(self, stop: threading.Event) -> None:
        """Watch.

        Parameters
        ----------
        stop
            Ends it cleanly when it is set.

        Raises
        ------
        InputError
            If the file does not come, or cannot be watched.
        """
        try:
            self._watch(stop)
        except BrokenPipeError:
            # Whoever read the lines has gone; what was learnt is kept all the same.
            sys.stdout = open(os.devnull, "w")  # noqa: SIM115
        finally:
            self._source.close()
            if self._log is not None:
                self._log.close()
        self._save()

    def _watch(self, stop: threading.Event) -> None:
        began = heard = time.monotonic()
        until = self._waiting.until
        while not stop.is_set():
            piece = self._source.read()
            now = time.monotonic()
            if piece is not None:
                self._take(self._session.feed(piece))
                heard = now if piece.data else heard
            elif self._source.is_over or (self._waiting.at_end and self._source.is_there):
                break
            else:
                self._look_at_silence(now - heard, now - began)
                stop.wait(_PAUSE)
            if until is not None and now - began >= until:
                break
        self._take(self._session.finish(), is_last=True)

    def _look_at_silence(self, silent: float, since_start: float) -> None:
        waiting, watcher = self._waiting, self._session.watcher
        if not self._source.is_there and since_start >= waiting.for_file:
            raise hyst.InputError(
                f"{self._session.rows.source} did not come within {waiting.for_file:.6g} s; check "
                "its name, or wait longer with --wait"
            )
        if watcher is not None:
            self._tell(watcher.silence(silent, waiting.silence))

    def _take(self, windows: list[Window], is_last: bool = False) -> None:
        """Report windows, so many together as --every asks for."""
        session = self._session
        if session.watcher is None:
            return
        self._begin_log()
        if windows:
            self._tell(session.watcher.silence(0.0, self._waiting.silence))
        together = session.windows_in(session.plan.every)
        for window in windows:
            self._tell(window.events)
            self._windows.append(window)
            if len(self._windows) >= together:
                self._report()
        if is_last and self._windows:
            self._report()

    def _report(self) -> None:
        assert self._session.watcher is not None
        report = report_of(self._windows, self._session.watcher.allowed_error)
        self._windows = []
        if self._log is not None:
            self._log.report(report)
        self._print(self._line(report))
        if time.monotonic() - self._saved > _SAVED_EVERY:
            self._save()

    def _line(self, report: Report) -> str:
        unit = self._session.plan.model.description.output_unit
        return json_of(report) if self._as_json else line_of(report, unit)

    def _tell(self, events: tuple[AlarmEvent, ...]) -> None:
        for event in events:
            if self._log is not None:
                self._log.event(event)
            self._print(json_of_event(event) if self._as_json else line_of_event(event))
            first = self._session.rows.first_unreadable
            if event.starts and event.name == "unreadable lines" and first is not None:
                note(f"the first line that cannot be read is line {first[0]}: {first[1]!r}")

    def _print(self, line: str) -> None:
        print(line, flush=True)

    def _begin_log(self) -> None:
        watcher = self._session.watcher
        if self._files is not None and self._log is None and watcher is not None:
            self._log = Log(self._files, watcher.estimator.names, self._goes_on)

    def _save(self) -> None:
        """Save estimator and model, each whole or not at all."""
        watcher = self._session.watcher
        if self._files is None or watcher is None:
            return
        self._saved = time.monotonic()
        try:
            watcher.estimator.save(self._files.estimator)
            watcher.estimator.model.save(self._files.model)
        except hyst.HystError as error:
            note(str(error))


@contextlib.contextmanager
def ended_by_signals() -> Iterator[threading.Event]:
    """Give an event that Ctrl-C or a request to end sets; a second Ctrl-C ends at once."""
    stop = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield stop
        return

    def end(number: int, frame: FrameType | None) -> None:
        stop.set()
        signal.signal(number, before[number])

    numbers = (signal.SIGINT, signal.SIGTERM)
    before: dict[int, Any] = {number: signal.getsignal(number) for number in numbers}
    handler: Callable[[int, FrameType | None], None] = end
    for number in numbers:
        signal.signal(number, handler)
    try:
        yield stop
    finally:
        for number in numbers:
            signal.signal(number, before[number])
