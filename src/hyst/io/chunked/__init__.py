"""Records read in chunks, with the checks of those that are read as a whole."""

from __future__ import annotations

from hyst.io.chunked.opening import open_record
from hyst.io.chunked.record_file import RecordFile

__all__ = ["RecordFile", "open_record"]


def __dir__() -> list[str]:
    return __all__
