"""Figures of the study on robust tracking, numbered as in the paper."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.control import ClosedLoop, DisturbanceObserver, InverseComparison, LinearSystem
from hyst.control.frequency_responses import loop_responses
from hyst.operators import Affine, Operator
from hyst.report.observer.figures import draw_observer_bode, error_panel, output_panel
from hyst.report.panels import Panel, draw_panels

Array = NDArray[np.float64]


def draw_all(
    design: DisturbanceObserver,
    true_plant: LinearSystem,
    r: Array,
    models: tuple[Operator, Operator],
    loops: tuple[InverseComparison, InverseComparison],
) -> dict[str, bytes]:
    """Draw Figs. 5 and 7 to 12.

    Parameters
    ----------
    design
        The observer.
    true_plant
        The two-mode plant.
    r
        Reference for the figures without a loop, shape (N,).
    models
        The plays alone, and behind an envelope.
    loops
        The loop around each.

    Returns
    -------
    dict
        PNG by file name.
    """
    responses = loop_responses(design, true_plant)
    (plays, generalized), (loop_of_plays, generalized_loop) = models, loops
    return {
        "s1-fig-5.png": draw_observer_bode(responses, "Fig. 5, C = 4 + 8/s, best gain"),
        "s1-fig-7.png": _open_loop(r, plays),
        "s1-fig-8.png": _exact_and_none(loop_of_plays, "Fig. 8, PI model"),
        "s1-fig-9.png": _scaled(loop_of_plays),
        "s1-fig-10.png": _generalized(r, generalized),
        "s1-fig-11.png": _generalized_loops(generalized_loop),
        "s1-fig-12.png": _all_factors(generalized_loop),
    }


def _loop(title: str, x: Array, y: Array) -> Panel:
    return Panel(title, "reference", "", {"": (x, y)})


def _open_loop(r: Array, model: Operator) -> bytes:
    inverse = model.inverse()
    panels = (_loop("G[r]", r, model(r)), _loop("Inverse of G, applied to r", r, inverse(r)))
    return draw_panels(panels, 2, "Fig. 7, PI model")


def _exact_and_none(found: InverseComparison, heading: str) -> bytes:
    panels = [
        output_panel(f"inverse: {name}", {"": found.observed[name]}) for name in ("exact", "none")
    ]
    panels += [error_panel(f"inverse: {name}", _both(found, name)) for name in ("exact", "none")]
    return draw_panels(panels, 2, heading)


def _scaled(found: InverseComparison) -> bytes:
    panels = [
        output_panel(f"{name} of the inverse", {"": found.observed[name]})
        for name in ("0.9", "0.5")
    ]
    panels += [
        error_panel(f"{name} of the inverse", _both(found, name)) for name in ("0.9", "0.5", "0.7")
    ]
    exact = {"0.7, with observer": found.observed["0.7"], "exact": found.without["exact"]}
    panels.append(error_panel("0.7 with the observer, and exact without", exact))
    return draw_panels(panels, 2, "Fig. 9, PI model")


def _generalized(r: Array, model: Operator) -> bytes:
    t = np.arange(r.size) * 2.0 / r.size
    exact = model.inverse()
    ends = {f"{k:g}": model((Affine(k) @ exact)(r)) for k in (1.0, 0.9, 0.8, 0.7)}
    panels = (
        _loop("H[r]", r, model(r)),
        _loop("Inverse of H, applied to r", r, exact(r)),
        Panel("H after its scaled inverse", "reference", "", {k: (r, y) for k, y in ends.items()}),
        Panel("Its error", "time [s]", "", {k: (t, r - y) for k, y in ends.items()}),
    )
    return draw_panels(panels, 2, "Fig. 10, generalized PI model")


def _generalized_loops(found: InverseComparison) -> bytes:
    panels = [
        output_panel(f"inverse: {name}", {"": found.observed[name]}) for name in ("exact", "none")
    ]
    panels += [
        error_panel(f"inverse: {name}", _both(found, name))
        for name in ("exact", "none", "0.95", "0.7")
    ]
    return draw_panels(panels, 2, "Fig. 11, generalized PI model")


def _all_factors(found: InverseComparison) -> bytes:
    panels = [
        output_panel(f"inverse: {name}", _both(found, name))
        for name in ("exact", "0.9", "0.8", "0.7", "0.4", "0.1")
    ]
    return draw_panels(panels, 3, "Fig. 12, generalized PI model")


def _both(found: InverseComparison, name: str) -> dict[str, ClosedLoop]:
    return {"without observer": found.without[name], "with it": found.observed[name]}
