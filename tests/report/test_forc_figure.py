"""The FORC diagram shows what is dense where it is dense."""

from __future__ import annotations

import io

import matplotlib.image
import numpy as np
import pytest

import hyst
from hyst.report import draw_forc_diagram
from hyst.signals import ForcDensity


def picture(source: hyst.Preisach | ForcDensity) -> np.ndarray:
    return matplotlib.image.imread(io.BytesIO(draw_forc_diagram([("one", source)])), format="png")


def redness(pixels: np.ndarray) -> np.ndarray:
    return pixels[:, :, 0] - pixels[:, :, 2]


def test_a_dense_cell_is_where_its_thresholds_are() -> None:
    """Cells of coercive field 0.25 or 0.75 with the mass: the red is left or right in the plot."""
    places = []
    for row, column in ((2, 1), (3, 0)):
        weights = np.zeros((4, 4))
        weights[row, column] = 1.0
        pixels = redness(picture(hyst.Preisach(weights, np.linspace(-1.0, 1.0, 5))))
        inside = pixels[:, : int(0.75 * pixels.shape[1])]  # without the bar of colours
        places.append(np.argwhere(inside > 0.2)[:, 1].mean() / pixels.shape[1])
    assert places[0] + 0.15 < places[1]


def test_a_measured_density_and_a_model_are_drawn_alike() -> None:
    edges = np.linspace(-1.0, 1.0, 11)
    weights = np.tril(np.random.default_rng(1).random((10, 10)))
    model = hyst.Preisach(weights, edges)
    middles = (edges[1:] + edges[:-1]) / 2.0
    measured = ForcDensity(middles, middles, model.portrait().density)
    # The same densities on the same cells; what rounding moves is less than a shade in 255.
    np.testing.assert_allclose(picture(model), picture(measured), atol=0.02)


def test_what_has_no_density_is_refused_or_left_white() -> None:
    with pytest.raises(hyst.InputError, match="no density to draw"):
        draw_forc_diagram([])
    with pytest.raises(hyst.InputError, match="Composition has no density"):
        draw_forc_diagram([("fit", hyst.Affine(1.0, 0.0) @ hyst.Preisach([[1.0]], [-1.0, 1.0]))])  # type: ignore[list-item]
    grid = np.linspace(-1.0, 1.0, 4)
    white = picture(ForcDensity(grid, grid, np.full((4, 4), np.nan)))
    assert redness(white[:, : white.shape[1] // 2]).max() <= 1e-6
