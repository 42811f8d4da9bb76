"""How large the lines of a drive are over frequency, before limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.errors import InputError

Array = NDArray[np.float64]

SPECTRA = ("flat", "pink")


def line_sizes(frequency: Array, spectrum: str, corner: float | None) -> Array:
    """Give the sizes of lines: all alike, or of equal power in each octave.

    Parameters
    ----------
    frequency
        Shape (m,), Hz, above 0, ascending.
    spectrum
        ``"flat"``: amplitudes alike; ``"pink"``: power falls as 1/f, amplitude as its root.
    corner
        Frequency from which amplitudes fall as 1/f beyond that, Hz; none for None.

    Returns
    -------
    numpy.ndarray
        Shape (m,), the largest 1.

    Raises
    ------
    InputError
        If there is no such spectrum, or the corner is not above 0.
    """
    if spectrum not in SPECTRA:
        raise InputError(f"spectrum is {spectrum!r}; choose one of {', '.join(SPECTRA)}")
    sizes = np.ones(frequency.size) if spectrum == "flat" else np.sqrt(frequency[0] / frequency)
    if corner is not None:
        sizes = sizes * np.minimum(1.0, as_positive(corner, "corner", "Hz") / frequency)
    return np.asarray(sizes / sizes.max())
