"""Laws of the widening over the rate as tables whose straight pieces all miss by as much.

A piece of length d between points of a curve misses it by up to ``e = |g''| d^2 / 8``, so knees are
dense in proportion to the root of ``|g''|``. The laws are concave and pieces would lie below them,
by 2/3 e in the mean: all points but the one at rest are lifted by that, so that a law that is found
as a table is not found too small.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError

Array = NDArray[np.float64]

PIECES = 24

RATIONAL, EXPONENTIAL = "rational", "exponential"
FORMS = (RATIONAL, EXPONENTIAL)


def require_form(form: str) -> str:
    """Give the form of a saturating law, or refuse what is none.

    Parameters
    ----------
    form
        ``"rational"`` or ``"exponential"``.

    Raises
    ------
    InputError
        If it is another word.
    """
    if form not in FORMS:
        raise InputError(f"form is {form!r}; choose one of {', '.join(FORMS)}")
    return form


def square_root_table() -> tuple[Array, Array]:
    """Give rates from 0 to 1 and their lifted roots, shape (PIECES + 1,) each."""
    share = np.arange(PIECES + 1.0) / PIECES
    # e = (root' - root)^2 / (4 (root' + root)), here (1 / PIECES)^2 / 2.
    lift = 1.0 / (3.0 * PIECES**2)
    return np.square(np.square(share)), np.square(share) + lift * (share > 0.0)


def saturating_table(end: float, form: str) -> tuple[Array, Array]:
    """Give rates from 0 to ``end`` and the lifted law of slope 1 and limit 1 at them.

    Parameters
    ----------
    end
        Last rate, > 0.
    form
        ``"rational"``: ``x / (1 + x)``; ``"exponential"``: ``1 - exp(-x)``.

    Returns
    -------
    tuple of numpy.ndarray
        Shape (PIECES + 1,) each.
    """
    share = np.arange(PIECES + 1.0) / PIECES
    # The integral of the root of |g''| grows evenly from knee to knee.
    if form == RATIONAL:
        reached = 1.0 - 1.0 / np.sqrt(1.0 + end)
        x, bent = 1.0 / np.square(1.0 - share * reached) - 1.0, np.sqrt(8.0) * reached
    else:
        reached = -np.expm1(-0.5 * end)
        x, bent = np.append(-2.0 * np.log1p(-share[:-1] * reached), end), 2.0 * reached
    x[-1] = end
    lift = (bent / PIECES) ** 2 / 12.0
    return x, saturating_law(x, form) + lift * (share > 0.0)


def saturating_law(x: Array, form: str) -> Array:
    """Give the saturating law of slope 1 and limit 1.

    Parameters
    ----------
    x
        Rates over the rate of the law, >= 0.
    form
        As of ``saturating_table``.
    """
    return x / (1.0 + x) if form == RATIONAL else -np.expm1(-x)


def saturating_law_slope(x: Array, form: str) -> Array:
    """Give the slope of ``saturating_law``.

    Parameters
    ----------
    x, form
        As of ``saturating_law``.
    """
    return 1.0 / np.square(1.0 + x) if form == RATIONAL else np.exp(-x)
