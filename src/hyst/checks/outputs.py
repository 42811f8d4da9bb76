"""Checks of arrays that outputs are written into."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]


def as_output(out: Any, signal: Array, name: str = "u") -> Array:
    """Check an array that outputs are to be written into.

    Parameters
    ----------
    out
        A writeable, C-contiguous float64 array in the shape of the signal; the signal itself, or
        one that shares no memory with it.
    signal
        What ``as_signal`` gave.
    name
        What messages call the signal.

    Returns
    -------
    numpy.ndarray
        ``out`` itself.

    Raises
    ------
    InputError
        If it is anything else: nothing is converted, for then the caller would not see the output.

    Examples
    --------
    >>> as_output(np.empty(2), np.array([1.0, 2.0])).shape
    (2,)
    """
    if not isinstance(out, np.ndarray) or np.ma.isMaskedArray(out):
        raise InputError(f"out is of type {type(out).__name__}; give a NumPy array of float64")
    if out.dtype != np.float64 or not out.dtype.isnative:
        raise InputError(f"out has dtype {out.dtype}; give float64, the output is not converted")
    if out.shape != signal.shape:
        raise InputError(f"out has shape {out.shape}; give that of {name}, {signal.shape}")
    if not out.flags.c_contiguous or not out.flags.aligned:
        raise InputError("out is not contiguous; give an array in C order, no slice with steps")
    if not out.flags.writeable:
        raise InputError("out is read-only; give an array that may be written to")
    if np.may_share_memory(out, signal) and out.ctypes.data != signal.ctypes.data:
        raise InputError(
            f"out shares a part of its memory with {name}; give {name} itself, or an array apart "
            "from it"
        )
    return out
