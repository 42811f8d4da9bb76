"""Records read in chunks, with the checks of those that are read as a whole."""

from __future__ import annotations

from hyst.io.chunked.opening import open_record, reads_in_chunks
from hyst.io.chunked.record_file import RecordFile

__all__ = ["RecordFile", "open_record", "reads_in_chunks"]


def __dir__() -> list[str]:
    return __all__
