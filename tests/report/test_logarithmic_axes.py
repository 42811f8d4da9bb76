"""Logarithmic axes of figures are labelled with numbers people can read."""

from __future__ import annotations

from matplotlib.figure import Figure

from hyst.report.canvas import blank, drawn


def _labels(low: float, high: float) -> list[str]:
    figures: list[Figure] = []

    @drawn
    def draw() -> Figure:
        figure, (axes,) = blank(1, 1, 5.0, 4.0)
        axes.loglog([low, high], [low, high], label="price in $ or in $")
        figures.append(figure)
        return figure

    assert draw().startswith(b"\x89PNG")
    (axes,) = figures[0].axes
    ticks = [*axes.get_xticklabels(which="both"), *axes.get_yticklabels(which="both")]
    return [tick.get_text() for tick in ticks if tick.get_text()]


def test_decades_are_labelled_with_numbers() -> None:
    labels = _labels(1e-3, 1e3)
    assert {"0.01", "1", "100"} <= set(labels)
    assert not [label for label in labels if "$" in label]


def test_less_than_a_decade_is_labelled_too() -> None:
    labels = _labels(0.04, 0.15)
    assert {"0.06", "0.1"} <= set(labels)
    assert not [label for label in labels if "$" in label]
