"""The log of a watch: one line for each report and each alarm, whole at every moment."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TextIO

import hyst
from hyst._files import require_folder
from hyst.cli.watch.report import Report, bands_of
from hyst.online.alarms import AlarmEvent

_COUNTS = "samples", "learnt", "samples lost", "unreadable lines", "no number", "clock", "overflow"


@dataclass(frozen=True)
class LogFiles:
    """Where a watch writes.

    Parameters
    ----------
    log, alarms, estimator, model
        Lines of reports, lines of alarms, and what is saved now and then and at the end.
    """

    log: Path
    alarms: Path
    estimator: Path
    model: Path

    def all(self) -> tuple[Path, ...]:
        """Give the four."""
        return self.log, self.alarms, self.estimator, self.model


def log_files(path: Path) -> LogFiles:
    """Give the files of a log: those in a folder, or a table and three files named after it.

    Raises
    ------
    InputError
        If there is a file in the place of a folder.
    """
    if path.suffix.casefold() == ".csv":
        require_folder(path.parent)
        names = (path.with_suffix(each) for each in (".alarms.csv", ".estimator.json", ".json"))
        return LogFiles(path, *names)
    require_folder(path)
    names = (path / each for each in ("log.csv", "alarms.csv", "estimator.json", "model.json"))
    return LogFiles(*names)


class Log:
    """Tables that are written line by line.

    Parameters
    ----------
    files
        Where.
    parameters
        Names of what is estimated.
    goes_on
        Whether lines are added to those of an earlier watch.

    Raises
    ------
    InputError
        If a log that goes on has other columns.
    """

    def __init__(self, files: LogFiles, parameters: Sequence[str], goes_on: bool) -> None:
        self.files = files
        bands = (f"{name}{end}" for name in parameters for end in ("", " low", " high"))
        errors = ("error", "model error", "allowed error", "noise", "as noise")
        columns = ("time [s]", "clock", *errors, *bands, *_COUNTS, "paused", "alarms")
        self._log = _opened(files.log, columns, goes_on)
        events = ("time [s]", "clock", "alarm", "event", "value", "sentence")
        self._alarms = _opened(files.alarms, events, goes_on)

    def report(self, report: Report) -> None:
        """Write a report."""
        last = report.window
        bands = [
            number
            for value, low, high, is_known in zip(last.parameters, *bands_of(last), strict=True)
            for number in (value, *((low, high) if is_known else (math.nan, math.nan)))
        ]
        errors = (report.error, report.model_error, report.allowed, last.noise)
        cells = [
            _number(last.time),
            _clock(),
            *map(_number, errors),
            str(int(last.is_consistent)),
            *map(_number, bands),
            *(str(last.counts[name]) for name in _COUNTS),
            last.paused,
            "; ".join(last.active),
        ]
        self._log.write(_line(cells))

    def event(self, event: AlarmEvent) -> None:
        """Write the start or end of an alarm."""
        what = "start" if event.starts else "end"
        cells = [_number(event.time), _clock(), event.name, what, _number(event.value)]
        self._alarms.write(_line([*cells, event.sentence]))

    def close(self) -> None:
        """End the tables."""
        self._log.close()
        self._alarms.close()


def _opened(path: Path, columns: Sequence[str], goes_on: bool) -> TextIO:
    """Open a table, with its header unless it goes on."""
    path.parent.mkdir(parents=True, exist_ok=True)
    header = _line(list(columns))
    is_there = goes_on and path.exists() and path.stat().st_size > 0
    if is_there:
        with path.open(encoding="utf-8", newline="") as file:
            if file.readline() != header:
                raise hyst.InputError(
                    f"{path} has other columns than this watch; give another --log"
                )
    # Line buffered: what was written is whole lines, whenever the power goes.
    file = path.open("a" if is_there else "w", encoding="utf-8", newline="", buffering=1)
    if not is_there:
        file.write(header)
    return file


def _line(cells: list[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()


def _number(value: float) -> str:
    return "" if math.isnan(value) else repr(float(value))


def _clock() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
