"""Look over the texts of an HDF5 file before its library does, which can loop over them for ever.

Texts of variable length are kept in collections of objects one after the other. The free space at
the end of a collection is an object with number 0; the library goes on by its size, and does not
end where a damaged file says that it is 0.
"""

from __future__ import annotations

import mmap
import struct
from pathlib import Path

_MARK = b"GCOL\x01\x00\x00\x00"
_HEAD = 16


def has_endless_heap(path: Path) -> bool:
    """Tell whether a collection of texts in an HDF5 file has free space of no size.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    bool

    Source
    ------
    The HDF Group, "HDF5 File Format Specification", III.E: Global Heap.
    """
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        place = data.find(_MARK)
        while place >= 0:
            if _is_endless(data, place):
                return True
            place = data.find(_MARK, place + 1)
    return False


def _is_endless(data: mmap.mmap, place: int) -> bool:
    end = min(len(data), place + struct.unpack("<Q", data[place + 8 : place + 16].ljust(8))[0])
    at = place + _HEAD
    while at + _HEAD <= end:
        number, _, _, size = struct.unpack_from("<HHIQ", data, at)
        if number == 0:
            return bool(size == 0)
        at += _HEAD + size + -size % 8
    return False
