"""Unpack files that were packed with gzip."""

from __future__ import annotations

import io
import zlib
from gzip import GzipFile

from hyst.errors import InputError

SUFFIX = ".gz"
_MARK = b"\x1f\x8b"
# A few bytes can be packed zeros without end.
_LARGEST = 1 << 32
_CHUNK = 1 << 24


def is_compressed(head: bytes) -> bool:
    """Tell whether a file begins as those of gzip do."""
    return head.startswith(_MARK)


def decompress(data: bytes, source: str) -> bytes:
    """Unpack a file.

    Parameters
    ----------
    data
        Its content.
    source
        Name of the file, for messages.

    Returns
    -------
    bytes
        What was packed.

    Raises
    ------
    InputError
        If the file is damaged or breaks off, or holds nothing, or more than 4 GiB.

    Examples
    --------
    >>> import gzip
    >>> decompress(gzip.compress(b"1,2"), "a.csv.gz")
    b'1,2'
    """
    parts: list[bytes] = []
    size = 0
    try:
        with GzipFile(fileobj=io.BytesIO(data)) as file:
            while part := file.read(_CHUNK):
                parts.append(part)
                size += len(part)
                if size > _LARGEST:
                    raise InputError(f"{source} holds more than 4 GiB; unpack and shorten it first")
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(
            f"{source} is damaged or breaks off ({type(error).__name__}); pack it again"
        ) from error
    if not size:
        raise InputError(f"{source} is empty; give a file with columns of numbers")
    return b"".join(parts)
