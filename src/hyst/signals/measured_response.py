"""A measured frequency response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class MeasuredResponse:
    """Output over input at some frequencies, as an analyser measures it.

    Parameters
    ----------
    frequency
        Shape (m,), Hz, >= 0; put into ascending order.
    response
        Shape (m,), complex, output units per input unit.

    Raises
    ------
    InputError
        If the shapes differ, a value is not finite, a frequency is negative or given twice, or
        all values are 0.

    Examples
    --------
    >>> measured = MeasuredResponse([20.0, 10.0], [0.5 - 0.5j, 1.0 + 0.0j])
    >>> measured.frequency.tolist(), measured.response[0]
    ([10.0, 20.0], np.complex128(1+0j))
    """

    frequency: Array
    response: NDArray[np.complex128]

    def __init__(self, frequency: ArrayLike, response: ArrayLike) -> None:
        try:
            f = np.array(frequency, dtype=np.float64).reshape(-1)
            values = np.array(response, dtype=np.complex128).reshape(-1)
        except (TypeError, ValueError):
            raise InputError(
                "frequency or response is no list of numbers; give frequencies in Hz and complex "
                "values of output over input"
            ) from None
        if f.size != values.size or not f.size:
            raise InputError(
                f"there are {f.size} frequencies and {values.size} values; give one for each"
            )
        for name, good in (("frequency", np.isfinite(f)), ("response", np.isfinite(values))):
            if not good.all():
                raise InputError(f"{name} {int(np.argmin(good))} is not finite; leave it out")
        order = np.argsort(f, kind="stable")
        f, values = f[order], values[order]
        if f[0] < 0.0:
            raise InputError(f"a frequency is {f[0]:.6g} Hz; give those from 0 up")
        twice = np.flatnonzero(np.diff(f) == 0.0)
        if twice.size:
            raise InputError(f"the frequency {f[twice[0]]:.6g} Hz is given twice; leave one out")
        if not values.any():
            raise InputError("all values of the response are 0; check what was measured")
        f.setflags(write=False)
        values.setflags(write=False)
        object.__setattr__(self, "frequency", f)
        object.__setattr__(self, "response", values)

    def __repr__(self) -> str:
        f = self.frequency
        return f"<MeasuredResponse of {f.size} frequencies from {f[0]:.6g} to {f[-1]:.6g} Hz>"
