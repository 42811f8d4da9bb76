"""The FORC diagram: density of relays over coercive and bias field, of a model or a measurement."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.models import Preisach
from hyst.report.canvas import blank, drawn, with_unit
from hyst.signals import ForcDensity

Array = NDArray[np.float64]

COLOURS = "RdBu_r"
_SCALE = (1.03, 0.075, 0.05, 0.85)  # left, bottom, width and height, shares of the panel


@drawn
def draw_forc_diagram(
    sources: Sequence[tuple[str, Preisach | ForcDensity]], input_unit: str = ""
) -> Figure:
    """Draw densities of relays beside each other, in one scale of colours.

    Parameters
    ----------
    sources
        Heading and what to draw: a model, or a density of ``hyst.signals.forc_density``.
    input_unit
        Of the thresholds.

    Returns
    -------
    bytes
        PNG.

    Raises
    ------
    InputError
        If there is nothing to draw, or something else than relays or their density.

    Examples
    --------
    >>> picture = draw_forc_diagram([("a model", Preisach([[1.0]], [-1.0, 1.0]))])
    >>> picture[1:4]
    b'PNG'
    """
    if not sources:
        raise InputError("there is no density to draw; give (heading, model or density) pairs")
    figure, axes = blank(len(sources), 1, 5.2 * len(sources), 4.2)
    maps = [(heading, *_edges_and_density(each)) for heading, each in sources]
    known = [np.abs(density[np.isfinite(density)]) for _, _, density in maps]
    largest = max(float(np.quantile(each, 0.998)) if each.size else 0.0 for each in known)
    for free, (heading, edges, density) in zip(axes, maps, strict=True):
        draw_density(free, edges, density, input_unit, largest)
        free.set_title(heading)
    return figure


def draw_density(
    axes: Axes, edges: Array, density: Array, input_unit: str, largest: float | None = None
) -> None:
    """Draw one density over coercive field (alpha - beta) / 2 and bias (alpha + beta) / 2.

    Parameters
    ----------
    axes
        Where to.
    edges
        Shape (n + 1,), of the cells along both thresholds, input units.
    density
        Shape (n, n), rows for alpha and columns for beta; NaN is left white.
    input_unit
        Of the thresholds.
    largest
        End of the scale of colours; the density's own largest if left out.
    """
    alpha, beta = np.meshgrid(edges, edges, indexing="ij")
    known = np.abs(density[np.isfinite(density)])
    end = (float(known.max(initial=0.0)) if largest is None else largest) or 1.0
    drawn_map = axes.pcolormesh(
        (alpha - beta) / 2.0,
        (alpha + beta) / 2.0,
        np.ma.masked_invalid(density),
        cmap=COLOURS,
        norm=TwoSlopeNorm(0.0, -end, end),
        shading="flat",
        rasterized=True,
    )
    half = 0.5 * (edges[-1] - edges[0])
    axes.set_xlim(0.0, half)
    axes.set_ylim(edges[0], edges[-1])
    axes.grid(visible=False)
    axes.set_title("Density of the relays")
    axes.set_xlabel(with_unit("coercive field (\u03b1 - \u03b2)/2", input_unit))
    axes.set_ylabel(with_unit("bias (\u03b1 + \u03b2)/2", input_unit))
    bar = axes.figure.colorbar(drawn_map, cax=axes.inset_axes(_SCALE))
    # Negative densities are the noise of a measurement: no model has them.
    bar.ax.set_ylim(min(0.0, float(np.nanmin(density, initial=0.0))) if known.size else 0.0, end)


def _edges_and_density(source: Preisach | ForcDensity) -> tuple[Array, Array]:
    if isinstance(source, Preisach):
        portrait = source.portrait()
        return portrait.thresholds, portrait.density
    if not isinstance(source, ForcDensity):
        raise InputError(
            f"a {type(source).__name__} has no density of relays; give a hyst.Preisach, as the "
            "relays of a fit are, or what hyst.signals.forc_density gives"
        )
    step = np.diff(source.alpha)[0]
    return np.append(source.alpha - 0.5 * step, source.alpha[-1] + 0.5 * step), source.density
