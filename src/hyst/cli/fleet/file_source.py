"""A device whose record is in a file that is read where it is fitted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import hyst


@dataclass(frozen=True)
class FileSource:
    """One device, a ``MeasurementSource`` of ``hyst.fleet``.

    Parameters
    ----------
    identifier
        Of the device.
    file
        Path of its record, absolute, so that a worker elsewhere finds it.
    how
        Arguments of ``hyst.read_record``.
    limits
        Of this device alone.
    """

    identifier: str
    file: str
    how: Mapping[str, Any]
    limits: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)

    def load(self) -> hyst.Record:
        """Read the record."""
        return hyst.read_record(self.file, **self.how)

    def fingerprint(self) -> str:
        """Give a text that changes with the file, by size and time, and with how it is read."""
        told = Path(self.file).stat()
        return f"{told.st_size} {told.st_mtime_ns} {self.file} {sorted(self.how.items())!r}"
