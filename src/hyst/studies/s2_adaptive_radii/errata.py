"""What is wrong in print, and how it shows."""

from __future__ import annotations

import numpy as np

from hyst.models import PrandtlIshlinskii
from hyst.report.table import Table, number
from hyst.studies.s2_adaptive_radii.measured_piezo import MAJOR, MINOR, drive, misses
from hyst.studies.s2_adaptive_radii.paper import (
    PIEZO_RANGE,
    SEVEN_WEIGHTS,
    P,
    fixed_radii,
)

_SLIPS = (
    ("case I-1", "Delta v = v(t) - v(t_k)", "v(t) - v(t_k-1), the last reversal"),
    ("eq. 17, row 3", "p_1 and p_2 times the error of r_1", "p_2 times that of r_2"),
    ("eqs. 21, 23", "sgn(Delta v e phi)", "sgn(Delta v) e phi"),
    ("eq. 21, boundary i", "projection along grad g_1", "along grad g_i"),
    ("eqs. 21, 23, gains differ", "g g' / g' g, g = grad g_i", "Lambda g g' / g' Lambda g"),
    ("fig. 2", "r_3 = 1 in the caption", "1.5, as in the text"),
    ("fig. 3", "unknown radii of fig. 3", "of fig. 2"),
    ("secs. I, III, V", "lemmas, propositions 3.1 and 3.2", "1 and 2"),
    ("prop. 2, remark 3", "a range above 2 r_n suffices", "not with minor loops, see above"),
    ("fig. 2, 10 dB", "radii converge", "with the slope before noise, see above"),
)


def errata() -> Table:
    """List what is wrong in print; what is computed is computed here or in the tables above.

    Returns
    -------
    Table
    """
    reach, major, minor = _seven()
    found = (
        (
            "eq. 23, several boundaries",
            "rests otherwise",
            f"{_ways_out()} of {2 * P.size + 2} directions lead off r = 0",
        ),
        ("sec. V-C, r_n = 1 V", "n plays", f"n - 1: the last moves {_last_moves()} V of 2"),
        ("sec. V-C, weights of n = 7", f"{PIEZO_RANGE:g} um measured", f"give {reach} um"),
        ("", "optimal", f"miss the four plays by {major}, {minor} um"),
    )
    return Table("Errata", ("where", "printed", "should be"), (*_SLIPS, *found))


def _ways_out() -> int:
    """Count regimes and signs of the error for which all radii may leave 0 by condition (c)."""
    plays = np.arange(P.size)
    count = 0
    for on in range(P.size + 1):
        phi = np.where(plays < on, P, -P)
        for sign in (1.0, -1.0):
            count += bool((np.diff(sign * phi, prepend=0.0) > 0.0).all())
    return count


def _last_moves() -> str:
    z = PrandtlIshlinskii([1.0], [1.0])(drive(MAJOR))
    return number(float(np.ptp(z[drive([0.0, 2.0]).size :])))


def _seven() -> tuple[str, str, str]:
    """Give the range of the printed seven plays, and by how much they miss the four, um."""
    model = PrandtlIshlinskii(SEVEN_WEIGHTS[1:], fixed_radii(7), float(SEVEN_WEIGHTS[0]))
    reach = float(np.ptp(model(drive(MAJOR))[drive([0.0, 2.0, 0.0]).size :]))
    return number(reach), number(misses(model, MAJOR), 3), number(misses(model, MINOR), 3)
