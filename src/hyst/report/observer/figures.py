"""Figures of a loop with a disturbance observer: over frequency and over time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from hyst.control.closed_loop import ClosedLoop
from hyst.control.frequency_responses import LoopResponses
from hyst.report.panels import Panel, draw_panels

_HZ = "frequency [Hz]"
# A filter that falls for ever must not squeeze the rest.
_LOWEST = 1e-3


def draw_observer_bode(found: LoopResponses, heading: str) -> bytes:
    """Draw what is rejected, what it does to the loop, and what it costs in robustness.

    Parameters
    ----------
    found
        Responses, as ``loop_responses`` gives them.
    heading
        Line above the figure.

    Returns
    -------
    bytes
        PNG, in the manner of S1 Fig. 5.
    """
    f = found.w / (2.0 * np.pi)
    rejected = {
        "|1 - Q|": (f, found.left),
        "1 / |Wp|": (f, found.Wp_inverse),
        "|Q|": (f, found.Q),
    }
    sensitivity = {"with the observer": (f, found.S), "without": (f, found.S_without)}
    uncertain = {"|Wu T|": (f, found.Wu_T)}
    return draw_panels(
        (
            Panel("Left of a disturbance", _HZ, "", rejected, True, lowest=_LOWEST),
            Panel("Output over disturbance", _HZ, "", sensitivity, True, lowest=_LOWEST),
            Panel("|Wu T|: stable below 1", _HZ, "", uncertain, True, 1.0, _LOWEST),
        ),
        3,
        heading,
    )


def output_panel(title: str, loops: Mapping[str, ClosedLoop]) -> Panel:
    """Give the panel of output over reference, after the start that metrics leave out.

    Parameters
    ----------
    title
        Of the panel.
    loops
        By label.

    Returns
    -------
    Panel
    """
    lines = {}
    for label, each in loops.items():
        after = each.t >= each.settle
        lines[label] = each.r[after], each.y[after]
    return Panel(title, "reference", "output", lines)


def error_panel(title: str, loops: Mapping[str, ClosedLoop]) -> Panel:
    """Give the panel of the tracking error over time.

    Parameters
    ----------
    title
        Of the panel.
    loops
        By label.

    Returns
    -------
    Panel
    """
    lines = {label: (each.t, each.e) for label, each in loops.items()}
    return Panel(title, "time [s]", "reference - output", lines, limit=0.0)
