"""Figure of simulated loops: how they track, their errors and their drives."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.control import ClosedLoop
from hyst.errors import InputError
from hyst.report.canvas import FAINT, MEASURED, MODELLED, SECOND, blank, drawn, with_unit

Array = NDArray[np.float64]

_COLOURS = (MODELLED, SECOND, "#047857", "#7c3aed", "#db2777", "#0e7490")
# More points than pixels only cost time.
_MOST_POINTS = 8000


@drawn
def draw_closed_loops(
    loops: Mapping[str, ClosedLoop],
    heading: str = "",
    output: tuple[str, str] = ("y", ""),
    drive: tuple[str, str] = ("u", ""),
) -> Figure:
    """Draw loops that follow one reference: over time, y against r, errors and drives.

    Parameters
    ----------
    loops
        By label, one to six.
    heading
        Line above the figure; empty for none.
    output, drive
        Name and unit of output and drive.

    Returns
    -------
    bytes
        PNG. A loop that diverged is drawn until it leaves the axes, and its label tells when.

    Raises
    ------
    InputError
        If there is no loop, or more than six.
    """
    if not 1 <= len(loops) <= len(_COLOURS):
        raise InputError(f"there are {len(loops)} loops; give one to {len(_COLOURS)}")
    figure, (over_time, against, errors, drives) = blank(2, 2, 10.0, 7.0)
    longest = max(loops.values(), key=lambda loop: loop.r.size)
    every = _stride(longest)
    over_time.plot(
        longest.t[every], longest.r[every], color=MEASURED, linewidth=3.0, alpha=0.5, label="r"
    )
    for (label, loop), colour in zip(loops.items(), _COLOURS, strict=False):
        every = _stride(loop)
        t, settled = loop.t[every], loop.t[every] >= loop.settle
        over_time.plot(t, loop.y[every], color=colour, linewidth=1.0, label=_told(label, loop))
        against.plot(loop.r[every][settled], loop.y[every][settled], color=colour, linewidth=1.0)
        errors.plot(t, loop.e[every], color=colour, linewidth=1.0)
        drives.plot(t, loop.u[every], color=colour, linewidth=1.0)
    over_time.set_title("Reference and output")
    over_time.set_ylabel(with_unit(*output))
    against.set_title("Output against reference")
    against.set_xlabel(with_unit("r", output[1]))
    against.set_ylabel(with_unit(*output))
    errors.axhline(0.0, color=FAINT, zorder=0)
    errors.set_title("Tracking error r - y")
    errors.set_ylabel(with_unit("e", output[1]))
    drives.set_title("Drive")
    drives.set_ylabel(with_unit(*drive))
    for axes in (over_time, errors, drives):
        axes.set_xlabel("time [s]")
        axes.margins(x=0.01)
    if any(loop.diverged_at is not None for loop in loops.values()):
        reach = 1.5 * float(np.abs(longest.r).max()) or 1.0
        for axes in (over_time, against, errors):
            axes.set_ylim(-reach, reach)
        steady = [loop.u for loop in loops.values() if loop.diverged_at is None and loop.u.size]
        most = max((float(np.abs(u).max()) for u in steady), default=reach)
        drives.set_ylim(-1.2 * most or None, 1.2 * most or None)
    figure.legend(loc="outside lower center", ncols=2)
    if heading:
        figure.suptitle(heading)
    return figure


def _stride(loop: ClosedLoop) -> slice:
    return slice(None, None, max(1, loop.r.size // _MOST_POINTS))


def _told(label: str, loop: ClosedLoop) -> str:
    if loop.diverged_at is not None:
        return f"{label}: diverges at {loop.diverged_at:.3g} s"
    return f"{label}: rms {loop.rms_error:.4g}"
